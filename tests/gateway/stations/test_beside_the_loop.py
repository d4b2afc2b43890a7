"""Whatever ground stations ask, on the loop's own link or on theirs, the run is the same."""

from laglab.runs.inline import InlineLink
from laglab.runs.plant import FmuPlant
from laglab_control import StationConfig
from laglab_fmu import Robot, RobotParameters
from laglab_gateway import (
    Gateway,
    GatewayConfig,
    MemoryRecorder,
    Safety,
    Services,
    Surroundings,
    Watch,
    Watcher,
    csv_lines,
    serve_lockstep,
    standard_parameters,
)
from laglab_protocol import (
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    Listener,
    Receiver,
    Sender,
    frames_in,
    open_endpoint,
)
from laglab_station import Station

from .table import Row, table
from .test_table import encoded


def number_of(row: Row) -> float | str | None:
    """Which command it is, if it is one."""
    return row.request.fields.get("command")


PARAMETERS = RobotParameters(start=(-3.0, -3.0, 0.0), noise=True, seed=4)
TICKS = 60
CHANGES = {"PARAM_SET", 400, 185, 52100}
ROWS = [row for row in table() if CHANGES.isdisjoint([row.request.name, number_of(row)])]
QUESTIONS = [encoded(row.request) for row in ROWS]
UNANSWERED = [encoded(row.request) for row in ROWS if not row.answers]


def trace(asking: bool) -> bytes:
    """Of a run that is watched; with everything asked at every tick, on both links."""
    with (
        Robot.open(3, PARAMETERS) as robot,
        open_endpoint("udpin://127.0.0.1:0") as ours,
        open_endpoint(ours.name.replace("udpin", "udpout")) as theirs,
    ):
        services = Services(standard_parameters(2, 3, Safety()))
        config = GatewayConfig(2, 3, TICKS, PARAMETERS.sample_time)
        gateway = Gateway(FmuPlant(robot, PARAMETERS), config, services=services)

        def ask(_: int) -> None:
            for question in QUESTIONS if asking else ():
                assert gateway.hear(frames_in(question)) or question in UNANSWERED
                theirs.send(question)

        watcher = Watcher(Listener(ours, Receiver()), Sender(ROBOT_SYSTEM, ROBOT_COMPONENT))
        station = Station(StationConfig(command_delay=2, initial_estimate=PARAMETERS.start))
        recorder = MemoryRecorder()
        link = Listener(InlineLink(station, Receiver()), Receiver())
        watch = Watch(services, [watcher])
        serve_lockstep(gateway, Surroundings(link, recorder, watch=watch, progress=ask))
        assert (theirs.receive(0.0) != b"") is asking
    return csv_lines(recorder.rows)


def test_the_trace_is_the_same_byte_for_byte() -> None:
    assert trace(asking=True) == trace(asking=False)
