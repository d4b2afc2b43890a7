"""A robot that somebody moves by hand, as the scenario has it."""

from collections.abc import Sequence

from laglab.scenario.tables.plant import PlantEvent
from laglab_gateway import Plant, Reading, first_tick


class MovedByHand:
    """A plant that is put elsewhere when it is time."""

    def __init__(self, plant: Plant, events: Sequence[PlantEvent], sample_time: float) -> None:
        self._plant = plant
        self._tick = 0
        self._due: dict[int, list[PlantEvent]] = {}
        for event in events:
            self._due.setdefault(first_tick(event.at, sample_time), []).append(event)
        self._move()

    def read(self) -> Reading:
        """The robot at this tick, moved already."""
        return self._plant.read()

    def step(self, v: float, omega: float) -> None:
        """One tick, at whose end somebody may move the robot."""
        self._plant.step(v, omega)
        self._tick += 1
        self._move()

    def place(self, x: float, y: float, theta: float) -> None:
        """The plant's own."""
        self._plant.place(x, y, theta)

    def _move(self) -> None:
        for event in self._due.pop(self._tick, ()):
            if event.place is not None:
                self._plant.place(*event.place)
            elif event.by is not None:
                pose = self._plant.read()[:3]
                x, y, theta = (there + by for there, by in zip(pose, event.by, strict=True))
                self._plant.place(x, y, theta)
