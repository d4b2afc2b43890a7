"""What is on disk when a run ends in the middle of a tick."""

from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from laglab.runs.plant import FmuPlant
from laglab_fmu import Robot, RobotParameters
from laglab_gateway import (
    DIRECTIONS,
    TLOG_FILE,
    TRACE_FILE,
    Direction,
    Fates,
    FileRecorder,
    Gateway,
    GatewayConfig,
    Impairments,
    LinkRow,
    RandomFates,
    Recorder,
    Surroundings,
    TraceError,
    TraceRow,
    read_link_log,
    serve_lockstep,
)
from laglab_gateway.record import files
from laglab_gateway.record.trace import read_trace
from laglab_protocol import (
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_HEARTBEAT,
    STATION_SYSTEM,
    Command,
    End,
    EndpointError,
    EndReason,
    Link,
    Listener,
    Receiver,
    Sender,
    Tick,
)

BREAKS_AT = 7


class BreakingLink(Link):
    """A station that answers at once, until the link to it breaks while a tick is sent."""

    name = "breaking"
    datagrams = True

    def __init__(self) -> None:
        self._sender, self._receiver = Sender(STATION_SYSTEM, STATION_COMPONENT), Receiver()
        self._waiting = self._sender.frame(STATION_HEARTBEAT)
        self.ended: list[EndReason] = []

    def fileno(self) -> int:
        return -1

    def send(self, data: bytes, _: object = None) -> None:
        for frame in self._receiver.receive(data):
            if isinstance(frame.message, End):
                self.ended.append(frame.message.reason)
            if isinstance(frame.message, Tick):
                tick = frame.message.tick
                if tick == BREAKS_AT:
                    raise EndpointError("the cable is out")
                command = Command(0.0, 0.0, tick, ROBOT_SYSTEM, ROBOT_COMPONENT, 0)
                self._waiting = self._sender.frame(command)

    def receive(self, _: float) -> bytes:
        waiting, self._waiting = self._waiting, b""
        return waiting


def test_a_link_that_breaks_leaves_the_trace_and_what_the_link_did_up_to_the_same_tick(
    tmp_path: Path,
) -> None:
    fates: dict[Direction, Fates] = {
        direction: RandomFates(Impairments(duplicate=0.5), [], np.random.default_rng(1))
        for direction in DIRECTIONS
    }
    parameters = RobotParameters()
    with Robot.open(3, parameters) as robot, closing(FileRecorder(tmp_path)) as recorder:
        gateway = Gateway(FmuPlant(robot, parameters), GatewayConfig(0, 0, 100, 0.01), fates)
        with pytest.raises(EndpointError):
            serve_lockstep(gateway, Surroundings(Listener(BreakingLink(), Receiver()), recorder))

    whole = set(range(BREAKS_AT))
    assert set(read_trace(tmp_path / "trace.csv")["tick"]) == whole
    for rows in read_link_log(tmp_path / "link.csv").values():
        assert {row.tick for row in rows} == whole


class FullDisk(Recorder):
    """No room for the tick before the link breaks."""

    def row(self, row: TraceRow) -> None:
        if row.tick == BREAKS_AT - 1:
            raise TraceError("cannot record trace.csv: no room")


def test_a_recorder_that_fails_too_hides_no_cause_and_leaves_nobody_untold() -> None:
    link, parameters = BreakingLink(), RobotParameters()
    with Robot.open(3, parameters) as robot:
        gateway = Gateway(FmuPlant(robot, parameters), GatewayConfig(0, 0, 100, 0.01))
        with pytest.raises(EndpointError, match="the cable is out"):
            serve_lockstep(gateway, Surroundings(Listener(link, Receiver()), FullDisk()))
    assert set(link.ended) == {EndReason.FAILED}


@pytest.mark.parametrize(("pause", "written"), [(0.0, [1, 2, 3, 4]), (3600.0, [1, 1, 1, 4])])
def test_ticks_that_follow_each_other_fast_are_written_together(
    pause: float, written: list[int], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(files, "PAUSE", pause)
    monkeypatch.setattr(files, "TOGETHER", 3)
    there: list[int] = []
    with closing(FileRecorder(tmp_path)) as recorder:
        for tick in range(4):
            recorder.row(TraceRow(tick, *[0.0] * 14))
            recorder.flush()
            there.append(len(read_trace(tmp_path / "trace.csv")["tick"]))
    assert there == written
    assert read_trace(tmp_path / "trace.csv")["tick"].tolist() == [0, 1, 2, 3]


def test_what_another_run_had_to_say_does_not_stay(tmp_path: Path) -> None:
    with closing(FileRecorder(tmp_path)) as recorder:
        recorder.link([LinkRow("command", 0, 0, 0, 35, "lost", 0.0)])
    assert (tmp_path / files.LINK_FILE).exists()
    FileRecorder(tmp_path).close()
    assert {path.name for path in tmp_path.iterdir()} == {TRACE_FILE, TLOG_FILE}
