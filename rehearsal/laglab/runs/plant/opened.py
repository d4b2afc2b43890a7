"""What opening a plant gives."""

from dataclasses import dataclass

from laglab_gateway import Plant


@dataclass(frozen=True)
class OpenPlant:
    """A plant at tick 0, until the context that gave it ends."""

    plant: Plant
    placeable: bool = True
    """Whether somebody can put it elsewhere."""
    warnings: tuple[str, ...] = ()
    """What a person must not overlook."""
