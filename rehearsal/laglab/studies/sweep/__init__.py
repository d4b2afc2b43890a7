"""Studies: a scenario over a grid of its keys and over seeds, run by run, as a table.

`Study` describes one, its `Cell`s are what is computed, `sweep` has them computed, and what there
is of them in a folder is a `StudyResult`.
"""
