"""The robot's side of a rehearsal, from its scenario: a gateway, and its plant or a real robot."""

import math
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from laglab.errors import ScenarioError
from laglab.live import Controls
from laglab.runs.plant import OpenPlant, open_plant
from laglab.runs.staying import staying
from laglab.scenario import Scenario
from laglab_gateway import (
    DIRECTIONS,
    IDEAL,
    Direction,
    Fates,
    Gateway,
    GatewayConfig,
    Parameter,
    ParameterTable,
    RandomFates,
    RecordedFates,
    Relay,
    RobotSide,
    Served,
    Services,
    Surroundings,
    Timesyncing,
    UnplaceableError,
    Watch,
    Watcher,
    read_link_log,
    recorded_ticks,
    serve_lockstep,
    serve_realtime,
    serve_remote,
    served,
    standard_parameters,
)
from laglab_protocol import (
    EVERY_MESSAGE,
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_SYSTEM,
    Codec,
    Endpoint,
    KeyFileError,
    Listener,
    Sender,
    open_endpoint,
    read_key,
    refuse_open_door,
)


@dataclass(frozen=True)
class Setup:
    """What a run needs besides its scenario."""

    plant: str | None = None
    """The address of the real robot; None: the scenario's plant."""
    key: Path | None = None
    """The file of the key that signs every frame of the gateway and of those who speak to it."""
    armed: bool = True
    """Whether the robot may move before a ground station says so."""
    unsigned: bool = False
    """Whether strangers may reach the real robot's own link without its key, and those who watch
    need no key."""
    plant_key: Path | None = None
    """The file of the key that signs every frame on the real robot's own link."""
    live: str | None = None
    """How the loop calls the live page, if there is one."""
    last: ExitStack | None = None
    """From the end of the loop until this is closed an interrupt waits."""

    def check(self) -> None:
        """What can be known to be wrong before anything runs.

        Raises KeyFileError, and ScenarioError for a key without a real robot.
        """
        keys = [read_key(each) for each in (self.key, self.plant_key) if each is not None]
        if self.plant_key is not None and self.plant is None:
            raise ScenarioError("--plant-key: without --plant there is no robot's link to sign")
        if len(keys) > len(set(keys)):
            raise KeyFileError(
                f"{self.plant_key} is the key of the station's link: what is said there could be "
                "played to the robot: make its link another one (laglab protocol keygen)"
            )


def shown_parameters(scenario: Scenario) -> ParameterTable:
    """What a ground station reads: the gateway's own, the law's gains, the noise [SI units]."""
    noise = scenario.plant.measurement_variance if scenario.noise else (0.0, 0.0, 0.0)
    law = scenario.law
    gains = {"LAW_GAMMA": law.gamma, "LAW_LAMBDA": law.lambda_, "LAW_H": law.h}
    others = {
        **(gains if law.kind == "polar" else {}),
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
        wheel_radius=scenario.plant.wheel_radius,
        track=scenario.plant.track,
        command_playout=scenario.link.playout.command,
        measurement_playout=scenario.link.playout.measurement,
        plan=scenario.link.plan,
    )


def robot_services(
    scenario: Scenario, free_running: bool, placeable: bool = True, armed: bool = True
) -> Services:
    """What ground stations find; where time is simulated, no clocks are compared."""
    timesync = Timesyncing(time.monotonic_ns) if free_running else None
    return Services(shown_parameters(scenario), armed, timesync, placeable, scenario.origin)


def make_gateway(
    scenario: Scenario, opened: OpenPlant, sender: Sender | None = None, armed: bool = True
) -> Gateway:
    """The robot's side of a plant that is stepped."""
    free_running = scenario.pace == "realtime"
    services = robot_services(scenario, free_running, opened.placeable, armed)
    return Gateway(opened.plant, gateway_config(scenario), link_fates(scenario), services, sender)


def link_fates(scenario: Scenario) -> dict[Direction, Fates]:
    """What decides over the frames of each direction that is not ideal, seeded by the scenario."""
    if (log := scenario.link.replay) is not None:
        rows = read_link_log(log)
        ticks = recorded_ticks(*rows.values())
        return {direction: RecordedFates(told, ticks) for direction, told in rows.items()}
    fates: dict[Direction, Fates] = {}
    for number, direction in enumerate(DIRECTIONS):
        impairments = getattr(scenario.link, direction)
        events = [event for event in scenario.link.event if event.concerns(direction)]
        if impairments != IDEAL or events:
            rng = np.random.default_rng((scenario.seed, number))
            fates[direction] = RandomFates(impairments, events, rng)
    return fates


def wrapped_replay(scenario: Scenario) -> str | None:
    """Says in a line that a run is longer than what it replays; None where it is not."""
    if (log := scenario.link.replay) is None:
        return None
    recorded = len(recorded_ticks(*read_link_log(log).values()))
    ticks = math.inf if scenario.last_tick is None else scenario.last_tick + 1
    if not 0 < recorded < ticks:
        return None
    times = "again and again" if math.isinf(ticks) else f"{ticks / recorded:.3g} times"
    seconds = recorded * scenario.sample_time
    return f"{log} holds {seconds:g} s of a link: the run goes through it {times}"


@dataclass(frozen=True)
class OpenRobot:
    """The robot's side, ready to be served, until the context that gave it ends."""

    services: Services
    codec: Codec
    serve: Callable[[Surroundings], Served]
    so_far: Callable[[], Served]
    """What `serve` would give now: for when it raises."""
    unsigned: bool
    """Whether those who watch need no key."""
    has_key: bool
    """Whether who speaks can be told apart from strangers."""

    @property
    def controls(self) -> Controls:
        """What somebody at a live page can do."""
        arming = self.services.arming
        return Controls(arming.stop, lambda: arming.stopped)

    def watch(self, endpoints: Sequence[Endpoint]) -> Watch:
        """Those who look on, each spoken to by a sender and a receiver of its own."""
        return Watch(self.services, [self._watcher(endpoint) for endpoint in endpoints])

    def _watcher(self, endpoint: Endpoint) -> Watcher:
        need_no_key = EVERY_MESSAGE if self.unsigned else frozenset[str]()
        sender, receiver = self.codec.on_another_link(need_no_key)
        return Watcher(Listener(endpoint, receiver), sender, trusting=not self.has_key)


@contextmanager
def open_robot(scenario: Scenario, setup: Setup) -> Iterator[OpenRobot]:
    """The robot's side: of the scenario's plant, or of the real robot.

    Raises KeyFileError, ScenarioError; as `open_plant` does; of a real robot EndpointError.
    """
    setup.check()
    with Codec(ROBOT_SYSTEM, ROBOT_COMPONENT, setup.key) as codec, ExitStack() as stack:
        if setup.plant is None:
            with staying():
                plant = stack.enter_context(open_plant(scenario))
            gateway = make_gateway(scenario, plant, codec.sender, setup.armed)
            serve = partial(_serve_simulated, scenario, gateway, plant.warnings)
            yield _opened(gateway, codec, serve, setup)
        else:
            if scenario.plant.event:
                raise UnplaceableError(
                    f"plant.event: {setup.plant} is a real robot, which nobody can move from here: "
                    "leave the events out"
                )
            with (
                Codec(STATION_SYSTEM, STATION_COMPONENT, setup.plant_key) as line,
                open_endpoint(setup.plant) as robot,
            ):
                refuse_open_door(robot, setup.plant_key, setup.unsigned, "--plant-key")
                relay = _relay(scenario, codec.sender, line.sender, setup.armed)
                serve = partial(serve_remote, relay, Listener(robot, line.receiver))
                yield _opened(relay, codec, serve, setup)


def _opened(
    side: RobotSide, codec: Codec, serve: Callable[[Surroundings], Served], setup: Setup
) -> OpenRobot:
    return OpenRobot(
        services=side.services,
        codec=codec,
        serve=serve,
        so_far=partial(served, side),
        unsigned=setup.unsigned,
        has_key=setup.key is not None,
    )


def _serve_simulated(
    scenario: Scenario, gateway: Gateway, warnings: Sequence[str], around: Surroundings
) -> Served:
    """At the scenario's pace."""
    for text in warnings:
        around.warn(text)
    if scenario.pace == "lockstep":
        return serve_lockstep(gateway, around)
    return serve_realtime(gateway, around, scenario.sample_time / scenario.speed)


def _relay(scenario: Scenario, sender: Sender, to_robot: Sender, armed: bool) -> Relay:
    """The link in front of a real robot, at its own pace."""
    services = robot_services(scenario, free_running=True, placeable=False, armed=armed)
    return Relay(gateway_config(scenario), services, link_fates(scenario), sender, to_robot)
