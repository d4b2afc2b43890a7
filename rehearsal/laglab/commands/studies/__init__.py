"""Commands that make many runs, and say what they say together."""
