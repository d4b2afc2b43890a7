"""The link: two directions, each late by a fixed number of ticks, and what it does besides."""
