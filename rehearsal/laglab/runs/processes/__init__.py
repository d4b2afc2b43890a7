"""Functions of ours in processes of their own: a child, its orders, its answers.

Nothing is listed here: `python -m laglab.runs.processes.child` is to load itself but once.
"""
