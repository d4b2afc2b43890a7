"""Commands that make runs, or a part of one."""
