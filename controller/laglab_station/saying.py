"""What the controller's answer is in messages."""

from collections.abc import Sequence

import numpy as np
from msgspec.structs import replace

from laglab_control import Control
from laglab_protocol import Command, CommandLong, Estimate, Message, Planned
from laglab_protocol.dialect.generated import laglab as mavlink

UNCLAIMED = np.full((3, 3), np.nan)


def said(
    tick: int,
    control: Control,
    robot: tuple[int, int],
    asks: Sequence[Message],
    estimates: bool,
) -> list[Message]:
    """The answer to this robot's tick; the command closes it, and says how many went before.
    `estimates`: whether there is an estimate to report."""
    before = [*asks, *(_estimate(tick, control) if estimates else ())]
    v, omega, _ = control.drive
    if control.plan:
        return [*before, *_planned(Command(v, omega, tick, *robot, len(before)), control)]
    return [*before, Command(v, omega, tick, *robot, estimates=len(before))]


def _planned(command: Command, control: Control) -> list[Message]:
    """What is to follow it, and the command."""
    in_force = command.tick + control.flight.command_delay
    following = tuple((v, omega) for v, omega, _ in control.plan)
    frames = Planned(command, in_force, following).frames()
    return [*frames, replace(command, plan=len(following))]


def _estimate(tick: int, control: Control) -> list[Estimate]:
    """The report of the estimate, once there is one; with what is claimed for it, if anything."""
    pose, P = control.pose, control.P
    if pose is None:
        return []
    x, y, theta = pose.tolist()
    (xx, xy, xt), (_, yy, yt), (_, _, tt) = (UNCLAIMED if P is None else P).tolist()
    return [Estimate(x, y, theta, xx, xy, xt, yy, yt, tt, tick)]


def emergency_stop_for(system: int, component: int) -> CommandLong:
    """What has this robot stand still for good."""
    rest = (0.0,) * 6
    return CommandLong(1.0, *rest, mavlink.MAV_CMD_DO_FLIGHTTERMINATION, system, component, 0)
