"""What is kept of a run: trace, frames, the link's doings, timing, and what the stamps tell."""
