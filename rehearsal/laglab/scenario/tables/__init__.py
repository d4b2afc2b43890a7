"""The tables of a scenario, one a file; every key has a unit and a sentence, and a default."""
