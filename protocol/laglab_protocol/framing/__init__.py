"""Frames: messages to bytes and back."""
