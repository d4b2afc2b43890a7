"""Units and declared types of the variables."""

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Unit:
    """A unit in powers of SI base units, and one to show it in: (name, how many make one)."""

    name: str
    powers: tuple[tuple[str, int], ...]
    display: tuple[str, float] | None = None


@dataclass(frozen=True)
class DeclaredType:
    name: str
    quantity: str
    unit: str
    description: str


DEGREE = 180 / math.pi

UNITS = (
    Unit("m", (("m", 1),), ("mm", 1000.0)),
    Unit("s", (("s", 1),), ("ms", 1000.0)),
    Unit("rad", (("rad", 1),), ("deg", DEGREE)),
    Unit("m/s", (("m", 1), ("s", -1)), ("km/h", 3.6)),
    Unit("rad/s", (("rad", 1), ("s", -1)), ("rev/min", 60 * DEGREE / 360)),
    Unit("m2", (("m", 2),), ("cm2", 1e4)),
    Unit("rad2", (("rad", 2),), ("deg2", DEGREE**2)),
    Unit("m2/s2", (("m", 2), ("s", -2)), ("cm2/s2", 1e4)),
    Unit("rad2/s2", (("rad", 2), ("s", -2)), ("deg2/s2", DEGREE**2)),
    Unit("1", (), ("%", 100.0)),
)

TYPES = (
    DeclaredType("Position", "Length", "m", "Coordinate in the plane"),
    DeclaredType("Length", "Length", "m", "Dimension of the robot"),
    DeclaredType(
        "Heading", "Angle", "rad", "Direction, counter-clockwise from the x axis, not wrapped"
    ),
    DeclaredType("Speed", "Velocity", "m/s", "Speed along the heading"),
    DeclaredType("AngularSpeed", "AngularVelocity", "rad/s", "Speed of a turn, counter-clockwise"),
    DeclaredType("Duration", "Time", "s", "Length of time"),
    DeclaredType("PositionVariance", "Area", "m2", "Variance of a position"),
    DeclaredType("HeadingVariance", "AngleVariance", "rad2", "Variance of a heading"),
    DeclaredType(
        "SpeedVariance", "AngularVelocityVariance", "rad2/s2", "Variance of a wheel speed"
    ),
    DeclaredType("BodySpeedVariance", "VelocityVariance", "m2/s2", "Variance of a speed"),
    DeclaredType("Ratio", "DimensionlessRatio", "1", "Part of a whole"),
)
