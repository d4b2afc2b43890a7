"""A rehearsal rig for robots controlled across a network."""


def __getattr__(name: str) -> str:
    """`__version__`, looked up in the installed distribution when somebody asks."""
    if name != "__version__":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib.metadata import version  # takes longer than all else here

    return version("laglab")
