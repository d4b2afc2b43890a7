"""The link you have: measured, imported, fitted; what a run then replays or rehearses on."""
