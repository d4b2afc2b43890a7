"""A rover for other people's programs to find: `python rover.py URL LOG`.

The whole robot's side with its station inside, disarmed, watched at URL; until SIGTERM. LOG has a
line of JSON for whatever it hears: name, fields, names of the answers.
"""

import json
import sys
import time
from pathlib import Path
from typing import TextIO

from msgspec.structs import asdict

from laglab.runs.inline import InlineLink
from laglab.runs.plant import FmuPlant
from laglab_control import PolarLaw, SpeedLimits, StationConfig
from laglab_fmu import Robot, RobotParameters
from laglab_gateway import (
    Gateway,
    GatewayConfig,
    Safety,
    Services,
    Surroundings,
    Watch,
    Watcher,
    serve_lockstep,
    standard_parameters,
)
from laglab_gateway.services import Asker, RobotState
from laglab_protocol import (
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    Frame,
    Listener,
    Message,
    Receiver,
    Sender,
    open_endpoint,
)
from laglab_protocol.messages.layout import layout_of
from laglab_station import Station

START = (-3.0, -2.0, 0.0)
PARAMETERS = RobotParameters(start=START, noise=False)
FOREVER = 10**9


def station() -> Station:
    law, limits = PolarLaw(goal_tolerance=0.03), SpeedLimits(v_max=1.0, omega_max=1.7)
    return Station(StationConfig(estimator="raw", law=law, limits=limits, initial_estimate=START))


class Listened(Services):
    """The rover's services, with a record."""

    def __init__(self, log: TextIO) -> None:
        super().__init__(standard_parameters(0, 0, Safety()), armed=False)
        self._log = log

    def answer(
        self, frame: Frame, state: RobotState, asker: Asker | None = None, trusted: bool = True
    ) -> list[Message]:
        answers = super().answer(frame, state, asker, trusted)
        line = {
            "name": layout_of(frame.message).name,
            "fields": {name: _plain(value) for name, value in asdict(frame.message).items()},
            "answers": [layout_of(answer).name for answer in answers],
        }
        self._log.write(json.dumps(line) + "\n")
        self._log.flush()
        return answers


def _plain(value: object) -> object:
    return value.decode(errors="replace") if isinstance(value, bytes) else value


def _breathe(_: int) -> None:
    """Five times real time, and room for others."""
    time.sleep(0.002)


def main(url: str, log: TextIO) -> None:
    services = Listened(log)
    config = GatewayConfig(0, 0, FOREVER, PARAMETERS.sample_time)
    with Robot.open(3, PARAMETERS) as robot, open_endpoint(url) as endpoint:
        gateway = Gateway(FmuPlant(robot, PARAMETERS), config, services=services)
        sender = Sender(ROBOT_SYSTEM, ROBOT_COMPONENT)
        watch = Watch(services, [Watcher(Listener(endpoint, Receiver()), sender)])
        listener = Listener(InlineLink(station(), Receiver()), Receiver())
        serve_lockstep(gateway, Surroundings(listener, watch=watch, progress=_breathe))


if __name__ == "__main__":
    with Path(sys.argv[2]).open("w", encoding="utf-8") as file:
        main(sys.argv[1], file)
