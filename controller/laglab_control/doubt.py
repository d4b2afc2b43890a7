"""What is not known of the inputs, as a covariance: an estimator takes all of them for true.

Until an echo comes an input is only believed. It may have come into force a little earlier or later
than the commands usually do; when the echoes stop coming, the last one known may have been held all
the while, or the robot has stopped. By each the pose [m, m, rad] would differ by a vector d, for
which d d^T is claimed. A robot that has plans does as believed as long as they reach: what it
applies then is in all of them.
"""

import math
from typing import Generic, NamedTuple

import numpy as np

from laglab_control.angle import direction
from laglab_control.flight import Flight, believed_sum, sent_for
from laglab_control.model import Matrix, Vector
from laglab_control.motion import F
from laglab_control.robot import RobotModel

STOPS_AFTER = 0.5
"""[s] After so long without a command a robot may stop by itself."""
PATIENCE = 5
"""Ticks by which an echo may be late before its link counts as interrupted."""


class Missed(NamedTuple, Generic[F]):
    """What the robot would have done more if it had done as believed."""

    distance: F
    """[m], forward."""
    turn: F
    """[rad]."""
    length: F
    """[m] The way over which it would have turned so."""


def doubt(flight: Flight, robot: RobotModel, x: Vector) -> Matrix | None:
    """To be added to the covariance (3, 3) of the pose x (3,); None: all is as it usually is."""
    missed = _missed(flight, robot.sample_time)
    if not missed:
        return None
    cosine, sine = direction(float(x[2]))
    total = np.zeros((3, 3))
    for distance, turn, length in missed:
        aside = length / 2 * turn
        d = np.array((distance * cosine - aside * sine, distance * sine + aside * cosine, turn))
        total += np.outer(d, d)
    return total


def _missed(flight: Flight, Ts: float) -> list[Missed[float]]:
    told, planned = flight.told, flight.plans.horizon if flight.plans else 0
    if told.usual is None:
        return []
    believed = flight.tick - 1 - told.known
    missed: list[Missed[float]] = []
    if believed > told.usual + PATIENCE + planned:
        missed += (_held(flight, Ts, believed), _stopped(flight, Ts))
    elif told.spread and not planned and not flight.stands:
        missed.append(_shifted(flight, Ts, believed, told.spread))
    if len(told.missing) > planned:
        missed.append(_untold(flight, Ts))
    return missed


def _held(flight: Flight, Ts: float, believed: int) -> Missed[float]:
    """As if the last input known had been in force ever since."""
    v_sum, omega_sum = believed_sum(flight, flight.told.known + 1)
    v, omega = flight.told.in_force.tolist()
    return Missed(Ts * (v_sum - believed * v), Ts * (omega_sum - believed * omega), Ts * abs(v_sum))


def _stopped(flight: Flight, Ts: float) -> Missed[float]:
    """As if the robot had stopped by itself STOPS_AFTER later."""
    since = flight.told.known + 1 + round(STOPS_AFTER / Ts)
    if since >= flight.tick:
        return Missed(0.0, 0.0, 0.0)
    v_sum, omega_sum = believed_sum(flight, since)
    return Missed(Ts * v_sum, Ts * omega_sum, Ts * abs(v_sum))


def _shifted(flight: Flight, Ts: float, believed: int, spread: float) -> Missed[float]:
    """As if all commands had come into force `spread` ticks later."""
    if believed <= 0:
        return Missed(0.0, 0.0, 0.0)
    v, omega = flight.told.in_force.tolist()
    v_now, omega_now = sent_for(flight, flight.tick - 1).tolist()
    late = Ts * spread
    return Missed(late * (v_now - v), late * (omega_now - omega), Ts * believed * abs(v_now))


def _untold(flight: Flight, Ts: float) -> Missed[float]:
    """As if the last input known had been in force at all ticks of which nothing was told."""
    missing = flight.told.missing
    v, omega = flight.told.before.tolist()
    inputs = [sent_for(flight, tick).tolist() for tick in missing]
    distance = Ts * math.fsum(each[0] - v for each in inputs)
    turn = Ts * math.fsum(each[1] - omega for each in inputs)
    return Missed(distance, turn, Ts * len(missing) * abs(v))
