"""A map of names, proposed from what an FMU calls its variables."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from laglab_fmu.foreign import REAL, FmuFile, size

Words = frozenset[str]
LEFT, RIGHT = Words({"left", "l", "links"}), Words({"right", "r", "rechts"})
TURNING = Words(
    {"omega", "yaw", "angular", "turn", "turning", "rotation", "steering", "w", "rate", "psidot"}
)
AHEAD = Words(
    {"v", "vel", "velocity", "speed", "surge", "linear", "forward", "ahead", "throttle", "vx", "u"}
)
AXES = {
    "x": Words({"x", "east", "posx", "px", "easting", "xpos"}),
    "y": Words({"y", "north", "posy", "py", "northing", "ypos"}),
    "theta": Words(
        {"theta", "heading", "psi", "yaw", "phi", "orientation", "th", "angle", "compass", "course"}
    ),
}
MEASURED = Words(
    {"meas", "measured", "sensor", "gps", "imu", "noisy", "compass", "gnss", "odometry"}
)
AT_START = Words({"start", "0", "init", "initial", "ic"})
SPEEDS = Words({"dot", "der", "vel", "velocity", "speed", "rate", "noise", "variance", "error"})
POSES = Words({"pose", "state", "position", "pos", "q", "configuration"})
COMMANDS = Words({"command", "cmd", "twist", "input", "u", "velocity", "speeds", "control"})


class Candidate(NamedTuple):
    """A number in the FMU that could be mapped."""

    name: str
    causality: str
    words: Words
    start: bool
    """Whether it has a start value that can be set."""


@dataclass(frozen=True)
class Proposal:
    """Ours → theirs; what is not found is not there."""

    inputs: Mapping[str, str] = field(default_factory=dict)
    outputs: Mapping[str, str] = field(default_factory=dict)
    start: Mapping[str, str] = field(default_factory=dict)

    def fields(self) -> dict[str, Any]:
        """The keys of `[plant]`."""
        tables = {"inputs": self.inputs, "outputs": self.outputs, "start": self.start}
        return {name: dict(table) for name, table in tables.items() if table}

    def roles(self) -> dict[str, str]:
        """Their name → what it is for, such as `outputs.x`."""
        tables = ("inputs", self.inputs), ("outputs", self.outputs), ("start", self.start)
        return {
            theirs: f"{table}.{ours}" for table, names in tables for ours, theirs in names.items()
        }


def proposed(file: FmuFile) -> Proposal:
    """By names and causality."""
    all_of_them = list(candidates(file))
    inputs = [each for each in all_of_them if each.causality == "input"]
    outputs = [each for each in all_of_them if each.causality == "output"]
    parameters = [each for each in all_of_them if each.start and each.causality != "input"]
    pose = _axes(outputs, lambda each: not each.words & (MEASURED | SPEEDS))
    if len(pose) < 3:
        pose = _axes(outputs, lambda each: not each.words & SPEEDS) or pose
    measured = _axes(outputs, lambda each: bool(each.words & MEASURED) and not each.words & SPEEDS)
    if len(pose) < 3:
        pose, measured = _in_a_row(outputs, POSES, ("x", "y", "theta")), {}
    if len(measured) == 3 and not set(measured.values()) & set(pose.values()):
        pose |= {f"{axis}_meas": name for axis, name in measured.items()}
    start = _axes(parameters, lambda each: bool(each.words & AT_START) and not each.words & SPEEDS)
    return Proposal(_commands(inputs), pose, start)


def candidates(file: FmuFile) -> Iterator[Candidate]:
    """Every number that the FMU has, elements of arrays one by one."""
    for variable in file.description.modelVariables:
        if variable.type not in REAL or variable.causality == "independent":
            continue
        settable = variable.causality == "parameter" or variable.initial == "exact"
        told = variable.causality or "local", words(variable.name), settable
        if not variable.shape:
            yield Candidate(variable.name, *told)
            continue
        for i in range(size(variable)):
            yield Candidate(f"{variable.name}[{i}]", *told)


def words(name: str) -> Words:
    """A name's parts: `drive.cmdLeft_0` is drive, cmd, left, 0."""
    apart = re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Za-z])(?=\d)", " ", name)
    return Words(part.lower() for part in re.split(r"[^A-Za-z0-9]+", apart) if part)


def _axes(some: Sequence[Candidate], fits: Callable[[Candidate], bool]) -> dict[str, str]:
    """The first of each axis, those of the fewest words first."""
    ordered = sorted(filter(fits, some), key=lambda each: len(each.words))
    found = {
        axis: next((each.name for each in ordered if each.words & known), None)
        for axis, known in AXES.items()
    }
    return {axis: name for axis, name in found.items() if name is not None}


def _commands(inputs: Sequence[Candidate]) -> dict[str, str]:
    """Wheel speeds, or body speeds; else the two that there are, if they are an array."""
    left = [each.name for each in inputs if each.words & LEFT and not each.words & RIGHT]
    right = [each.name for each in inputs if each.words & RIGHT and not each.words & LEFT]
    if left and right:
        return {"omega_left": left[0], "omega_right": right[0]}
    turning = [each.name for each in inputs if each.words & TURNING]
    ahead = [each.name for each in inputs if each.words & AHEAD and each.name not in turning]
    if ahead and turning:
        return {"v": ahead[0], "omega": turning[0]}
    return _in_a_row(inputs, COMMANDS, ("v", "omega"))


def _in_a_row(some: Sequence[Candidate], known: Words, roles: Sequence[str]) -> dict[str, str]:
    """The first elements of an array of such a name."""
    elements = [each.name for each in some if each.words & known and each.name.endswith("]")]
    return dict(zip(roles, elements, strict=False)) if len(elements) >= len(roles) else {}
