"""The robot's side of a rehearsal, from its scenario: a gateway, and the FMU or a real robot."""

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import laglab_fmu
from laglab.run.plant import FmuPlant
from laglab.scenario import Scenario
from laglab_gateway import (
    IDEAL,
    Direction,
    Fates,
    Gateway,
    GatewayConfig,
    Link,
    Outcome,
    Parameter,
    Parameters,
    Patience,
    RandomFates,
    RecordedFates,
    Recorder,
    Relay,
    Services,
    Timesyncing,
    Watch,
    Watcher,
    read_link_log,
    serve_lockstep,
    serve_realtime,
    serve_remote,
    standard_parameters,
)
from laglab_protocol import (
    EVERY_MESSAGE,
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    Codec,
    Endpoint,
    Receiver,
    Sender,
    open_endpoint,
    refuse_open_door,
)

NewLink = Callable[[], tuple[Sender, Receiver]]


@dataclass(frozen=True)
class Setup:
    """What a run needs besides its scenario."""

    plant: str | None = None
    """The address of the real robot; None: the FMU."""
    key: Path | None = None
    """The file of the key that signs every frame of the gateway and of those who speak to it."""
    armed: bool = True
    """Whether the robot may move before a ground station says so."""
    unsigned: bool = False
    """Whether strangers may reach the real robot's own link, which is never signed, and those
    who watch need no key."""


def robot_parameters(scenario: Scenario) -> laglab_fmu.RobotParameters:
    """The robot that the FMU simulates."""
    plant = scenario.plant
    return laglab_fmu.RobotParameters(
        wheel_radius=plant.wheel_radius,
        track=plant.track,
        sample_time=scenario.sample_time,
        wheel_noise_variance=plant.wheel_noise_variance,
        measurement_variance=plant.measurement_variance,
        start=scenario.start,
        seed=scenario.seed,
        noise=scenario.noise,
        integration=plant.integration,
        wheel_speed_max=plant.wheel_speed_max,
        motor_time_constant=plant.motor_time_constant,
        wheel_radius_error=plant.wheel_radius_error,
        track_error=plant.track_error,
        wheel_slip=plant.wheel_slip,
    )


def shown_parameters(scenario: Scenario) -> Parameters:
    """What a ground station reads: the gateway's own, the law's gains, the noise [SI units]."""
    noise = scenario.plant.measurement_variance if scenario.noise else (0.0, 0.0, 0.0)
    others = {
        "LAW_GAMMA": scenario.law.gamma,
        "LAW_LAMBDA": scenario.law.lambda_,
        "LAW_H": scenario.law.h,
        "NOISE_WHEEL": scenario.plant.wheel_noise_variance if scenario.noise else 0.0,
        **dict(zip(("NOISE_X", "NOISE_Y", "NOISE_THETA"), noise, strict=True)),
    }
    return standard_parameters(
        scenario.link.command_delay,
        scenario.link.measurement_delay,
        scenario.safety,
        [Parameter(name, value) for name, value in others.items()],
    )


def gateway_config(scenario: Scenario) -> GatewayConfig:
    """What the link and the robot's side do."""
    return GatewayConfig(
        command_delay=scenario.link.command_delay,
        measurement_delay=scenario.link.measurement_delay,
        last_tick=scenario.last_tick,
        sample_time=scenario.sample_time,
        safety=scenario.safety,
    )


def robot_services(
    scenario: Scenario, free_running: bool, placeable: bool = True, armed: bool = True
) -> Services:
    """What ground stations find; where time is simulated, no clocks are compared."""
    timesync = Timesyncing(time.monotonic_ns) if free_running else None
    return Services(shown_parameters(scenario), armed, timesync, placeable=placeable)


@contextmanager
def open_gateway(
    scenario: Scenario, codec: Codec | None = None, armed: bool = True
) -> Iterator[Gateway]:
    """The robot's side, its FMU loaded until the context ends; no codec: nothing is signed."""
    parameters = robot_parameters(scenario)
    with laglab_fmu.Robot.open(scenario.plant.fmi, parameters) as robot:
        plant = FmuPlant(robot, parameters)
        free_running = scenario.pace == "realtime"
        services = robot_services(scenario, free_running, armed=armed)
        yield Gateway(plant, gateway_config(scenario), link_fates(scenario), services, codec)


DIRECTIONS: tuple[Direction, ...] = ("command", "measurement")


def link_fates(scenario: Scenario) -> dict[Direction, Fates]:
    """What decides over the frames of each direction that is not ideal, seeded by the scenario."""
    if (log := scenario.link.replay) is not None:
        return {direction: RecordedFates(read_link_log(log, direction)) for direction in DIRECTIONS}
    fates: dict[Direction, Fates] = {}
    for number, direction in enumerate(DIRECTIONS):
        impairments = getattr(scenario.link, direction)
        events = [event for event in scenario.link.event if event.concerns(direction)]
        if impairments != IDEAL or events:
            rng = np.random.default_rng((scenario.seed, number))
            fates[direction] = RandomFates(impairments, events, rng)
    return fates


def serve(
    scenario: Scenario,
    gateway: Gateway,
    endpoint: Link,
    recorder: Recorder,
    patience: Patience,
    progress: Callable[[int], None],
    watchers: Sequence[Endpoint] = (),
    watch_link: NewLink | None = None,
) -> tuple[Outcome, dict[str, Any]]:
    """Run the robot's side at the scenario's pace: how it ended, and what the stamps tell.

    Each watcher is spoken to by a sender and a receiver of its own, which `watch_link` makes.
    """
    watch = _watch(gateway.services, watchers, watch_link)
    if scenario.pace == "lockstep":
        outcome = serve_lockstep(gateway, endpoint, recorder, patience, progress, watch)
        return outcome, {"link": gateway.audit.report()}
    period = scenario.sample_time / scenario.speed
    outcome, lateness = serve_realtime(
        gateway, endpoint, recorder, patience, progress, period, watch=watch
    )
    link = gateway.audit.report() | {"timesync": clock_audit(gateway.services)}
    return outcome, {"link": link, "timing": lateness.report()}


def _watch(services: Services, watchers: Sequence[Endpoint], watch_link: NewLink | None) -> Watch:
    new_link = watch_link or Codec(ROBOT_SYSTEM, ROBOT_COMPONENT).on_another_link
    return Watch(services, [Watcher(each, *new_link()) for each in watchers])


def clock_audit(services: Services) -> dict[str, float] | None:
    """What TIMESYNC found: the station's clock less ours, and the way there and back [s]."""
    timesync = services.timesync
    if timesync is None or not timesync.samples:
        return None
    offsets, round_trips = np.array(timesync.samples).T * 1e-9
    p50, p99 = np.percentile(round_trips, (50, 99))
    return {
        "offset_s": float(np.median(offsets)),
        "round_trip_p50_s": float(p50),
        "round_trip_p99_s": float(p99),
        "samples": len(offsets),
    }


def serve_real(
    scenario: Scenario,
    robot: Endpoint,
    codec: Codec,
    armed: bool,
    endpoint: Endpoint,
    recorder: Recorder,
    patience: Patience,
    progress: Callable[[int], None],
    watchers: Sequence[Endpoint] = (),
    watch_link: NewLink | None = None,
) -> tuple[Outcome, dict[str, Any]]:
    """Be the link in front of a real robot, at its own pace; as `serve`."""
    services = robot_services(scenario, free_running=True, placeable=False, armed=armed)
    relay = Relay(gateway_config(scenario), services, link_fates(scenario), codec)
    watch = _watch(services, watchers, watch_link)
    outcome = serve_remote(relay, robot, endpoint, recorder, patience, progress, watch)
    return outcome, {"link": relay.audit.report() | {"timesync": clock_audit(services)}}


Serve = Callable[..., tuple[Outcome, dict[str, Any]]]
"""`serve` or `serve_real`, given all but what is on the station's side."""


@contextmanager
def open_robot(scenario: Scenario, setup: Setup) -> Iterator[Serve]:
    """The robot's side: the FMU, or the real robot; open until the context ends."""
    with Codec(ROBOT_SYSTEM, ROBOT_COMPONENT, setup.key) as codec:
        need_no_key = EVERY_MESSAGE if setup.unsigned else frozenset[str]()
        watch_link = partial(codec.on_another_link, need_no_key)
        if setup.plant is None:
            with open_gateway(scenario, codec, setup.armed) as gateway:
                yield partial(serve, scenario, gateway, watch_link=watch_link)
        else:
            with open_endpoint(setup.plant) as robot:
                refuse_open_door(robot, None, setup.unsigned)
                yield partial(
                    serve_real, scenario, robot, codec, setup.armed, watch_link=watch_link
                )
