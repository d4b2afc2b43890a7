"""The rim: who paces the ticks, and over which endpoints."""
