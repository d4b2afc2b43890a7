"""The same seed gives the same trace, byte for byte, whatever lies between the two sides."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from laglab_protocol import Tick, read_tlog

Start = Callable[..., "subprocess.Popen[str]"]
Laglab = Callable[..., subprocess.CompletedProcess[str]]

SCENARIOS = [("fig5",), ("fig8", "--seed", "7"), ("lab", "--duration", "3"), ("fig4", "--noise")]


def trace(laglab: Laglab, where: Path, *arguments: str) -> bytes:
    result = laglab("run", *arguments, "--out", str(where))
    assert result.returncode == 0, result.stderr
    return (where / "trace.csv").read_bytes()


@pytest.mark.parametrize("scenario", SCENARIOS, ids=lambda words: words[0])
def test_inline_udp_and_serial_agree(
    laglab: Laglab, tmp_path: Path, scenario: tuple[str, ...]
) -> None:
    traces = {
        transport: trace(laglab, tmp_path / transport, *scenario, "--transport", transport)
        for transport in ("inline", "udp", "serial")
    }
    assert traces["udp"] == traces["inline"]
    assert traces["serial"] == traces["inline"]


def test_fmi_2_and_3_agree(laglab: Laglab, tmp_path: Path) -> None:
    traces = [
        trace(laglab, tmp_path / fmi, "fig8", "--transport", "inline", "--fmi", fmi)
        for fmi in ("2", "3")
    ]
    assert traces[0] == traces[1]


def test_another_seed_gives_another_trace(laglab: Laglab, tmp_path: Path) -> None:
    traces = [
        trace(laglab, tmp_path / seed, "fig8", "--transport", "inline", "--seed", seed)
        for seed in ("1", "2")
    ]
    assert traces[0] != traces[1]


def test_lost_datagrams_change_nothing(
    start: Start,
    start_program: Start,
    listening_port: Callable[["subprocess.Popen[str]"], str],
    laglab: Laglab,
    tmp_path: Path,
) -> None:
    options = ("lab", "--duration", "0.6")
    calm = trace(laglab, tmp_path / "calm", *options, "--transport", "inline")
    gateway = start("gateway", *options, "--endpoint", "udpin://127.0.0.1:0", "--out", "lossy")
    port = listening_port(gateway)
    relay, loss = Path(__file__).with_name("relay.py"), 1 / 7
    start_program(sys.executable, relay, "127.0.0.2", port, "127.0.0.1", 0, 0, 0, loss)
    station = start("controller", *options, "--endpoint", f"udpout://127.0.0.2:{port}")
    assert gateway.wait(30) == 0
    station.wait(30)
    assert (tmp_path / "lossy" / "trace.csv").read_bytes() == calm
    frames = read_tlog(tmp_path / "lossy" / "robot.tlog")
    assert sum(isinstance(frame.message, Tick) for _, frame in frames) > 61 + 5  # again if lost
