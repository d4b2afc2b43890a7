"""A measurement that is interrupted, or whose line is unplugged: what was measured is kept."""

import contextlib
import signal
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from laglab.link.measured import read_measured
from laglab.link.probing import echo as answer
from laglab_protocol import ROBOT_COMPONENT, ROBOT_SYSTEM, Codec, Frame, Listener, open_endpoint

Start = Callable[..., "subprocess.Popen[str]"]
ENOUGH = 100
"""Frames."""


class OverError(Exception):
    """An echo has nothing more to do."""


class Counting(Listener):
    """Calls `then` at every turn after enough frames have come."""

    heard = 0
    then: Callable[[], None]

    def listen(self, timeout: float) -> list[Frame]:
        frames = super().listen(timeout)
        self.heard += len(frames)
        self.then()
        return frames


@contextlib.contextmanager
def echo(url: str) -> Iterator[Counting]:
    with (
        Codec(ROBOT_SYSTEM, ROBOT_COMPONENT) as codec,
        open_endpoint(url) as link,
        contextlib.suppress(OverError),
    ):
        listener = Counting(link, codec.receiver)
        yield listener
        answer(listener, codec, lambda _: None)


def assert_kept(folder: Path, said: str) -> None:
    assert "A frame each way every 10 ms" in said
    assert said.endswith("link.csv\n")
    measured = read_measured(folder / "link.csv", 0.01)
    command, measurement = measured.command, measured.measurement
    assert 10 < len(command.delay) == len(measurement.delay) < 10_000
    for _, flow in measured.flows:
        assert flow.lost.mean() < 0.5


@pytest.mark.parametrize(
    "name",
    ["SIGINT", *(pytest.param(name, marks=pytest.mark.slow) for name in ("SIGTERM", "SIGHUP"))],
)
def test_an_interrupt_keeps_what_was_measured(start: Start, tmp_path: Path, name: str) -> None:
    once = iter([signal.Signals[name]])

    def interrupt() -> None:
        if listener.heard >= ENOUGH:
            for number in once:
                probe.send_signal(number)
        if probe.poll() is not None:
            raise OverError

    with echo("udpin://127.0.0.1:0") as listener:
        url = listener.link.name.replace("udpin", "udpout")
        probe = start("link", "probe", url, "--duration", "86400")
        listener.then = interrupt
    said, errors = probe.communicate(timeout=20)
    assert (probe.returncode, errors) == (130, "laglab: interrupted\n")
    assert_kept(tmp_path, said)


def test_a_line_that_is_unplugged_keeps_what_was_measured(start: Start, tmp_path: Path) -> None:
    def unplug() -> None:
        if listener.heard >= ENOUGH or probe.poll() is not None:
            raise OverError

    with echo(f"pty://{tmp_path}/port") as listener:
        probe = start("link", "probe", "serial://port:230400", "--wait", "30")
        listener.then = unplug
    said, errors = probe.communicate(timeout=20)
    assert probe.returncode == 4
    (line,) = errors.splitlines()
    assert line.startswith("laglab: serial://port:230400: the far end is gone")
    assert_kept(tmp_path, said)


def test_an_echo_that_is_started_again_ends_the_measurement(start: Start, tmp_path: Path) -> None:
    """It numbers its frames anew: a gap in them would be where none was."""

    def begin_again() -> None:
        if listener.heard >= ENOUGH:
            listener.then = end
            raise OverError

    def end() -> None:
        if probe.poll() is not None:
            raise OverError

    with Codec(ROBOT_SYSTEM, ROBOT_COMPONENT) as codec, open_endpoint("udpin://127.0.0.1:0") as at:
        listener = Counting(at, codec.receiver)
        listener.then = begin_again
        probe = start("link", "probe", at.name.replace("udpin", "udpout"), "--duration", "30")
        for _ in range(2):
            with contextlib.suppress(OverError):
                answer(listener, codec, lambda _: None)
    said, errors = probe.communicate(timeout=20)
    assert probe.returncode == 4
    assert "what answers there was started again" in errors
    assert_kept(tmp_path, said)
    assert len(read_measured(tmp_path / "link.csv", 0.01).command.delay) <= ENOUGH


def test_before_anybody_answers_there_is_nothing_to_keep(start: Start, tmp_path: Path) -> None:
    with open_endpoint("udpin://127.0.0.1:0") as silent:
        url = silent.name.replace("udpin", "udpout")
        probe = start("link", "probe", url, "--wait", "3600")
        while not silent.receive(1.0):
            assert probe.poll() is None
        probe.send_signal(signal.SIGINT)
        said, errors = probe.communicate(timeout=20)
    assert (probe.returncode, said, errors) == (130, "", "laglab: interrupted\n")
    assert not (tmp_path / "link.csv").exists()
