"""A rover for other people's programs to find: `python rover.py URL`.

The whole robot's side with its station inside, disarmed, watched at URL; until SIGTERM.
"""

import sys
import time

from laglab.runs.inline import InlineLink
from laglab.runs.plant import FmuPlant
from laglab_control import Law, StationConfig
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
from laglab_protocol import ROBOT_COMPONENT, ROBOT_SYSTEM, Listener, Receiver, Sender, open_endpoint
from laglab_station import Station

START = (-3.0, -2.0, 0.0)
PARAMETERS = RobotParameters(start=START, noise=False)
FOREVER = 10**9


def station() -> Station:
    law = Law(v_max=1.0, omega_max=1.7, goal_tolerance=0.03)
    return Station(StationConfig(estimator="raw", law=law, initial_estimate=START))


def _breathe(_: int) -> None:
    """Five times real time, and room for others."""
    time.sleep(0.002)


def main(url: str) -> None:
    services = Services(standard_parameters(0, 0, Safety()), armed=False)
    config = GatewayConfig(0, 0, FOREVER, PARAMETERS.sample_time)
    with Robot.open(3, PARAMETERS) as robot, open_endpoint(url) as endpoint:
        gateway = Gateway(FmuPlant(robot, PARAMETERS), config, services=services)
        sender = Sender(ROBOT_SYSTEM, ROBOT_COMPONENT)
        watch = Watch(services, [Watcher(Listener(endpoint, Receiver()), sender)])
        listener = Listener(InlineLink(station(), Receiver()), Receiver())
        serve_lockstep(gateway, Surroundings(listener, watch=watch, progress=_breathe))


if __name__ == "__main__":
    main(sys.argv[1])
