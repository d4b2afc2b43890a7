"""A cell, and what becomes of it, wherever that is computed: a pure function, without files.

`cell.Cell` is a point of the grid with some of the seeds; `tasks.done` computes a `Task` of some,
`ways` says how, and about how long that takes. Nothing is listed here: to describe a study needs no
pyarrow.
"""
