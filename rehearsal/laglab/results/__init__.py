"""What a run leaves, and everything that shows it."""
