"""The same seed gives the same trace, byte for byte, whatever lies between the two sides."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from laglab.runs.rehearse import Transport
from laglab.runs.whole import run_into
from laglab.scenario import Scenario, load
from laglab_protocol import Tick, read_tlog

Start = Callable[..., "subprocess.Popen[str]"]

SCENARIOS: dict[str, dict[str, object]] = {
    "fig5": {},
    "fig8": {"seed": 7},
    "lab": {"duration": 3.0},
    "fig4": {"noise": True},
}


def trace(folder: Path, scenario: Scenario, transport: Transport = "inline") -> bytes:
    where = folder / transport
    where.mkdir(parents=True)
    ending = run_into(where, scenario, transport, lambda *_: None)
    assert ending.exit_code == 0, ending.problem
    return (where / "trace.csv").read_bytes()


@pytest.mark.parametrize(("name", "keys"), SCENARIOS.items())
def test_inline_udp_and_serial_agree(tmp_path: Path, name: str, keys: dict[str, object]) -> None:
    scenario = load(name, keys)
    inline, udp, serial = (trace(tmp_path, scenario, way) for way in ("inline", "udp", "serial"))
    assert udp == inline
    assert serial == inline


@pytest.mark.parametrize("key", ["plant.fmi", "seed"])
def test_another_fmi_changes_nothing_and_another_seed_all(tmp_path: Path, key: str) -> None:
    two, three = (trace(tmp_path / str(to), load("fig8", {key: to})) for to in (2, 3))
    assert (two == three) == (key == "plant.fmi")


def test_lost_datagrams_change_nothing(
    start: Start,
    start_program: Start,
    listening_port: Callable[["subprocess.Popen[str]"], str],
    tmp_path: Path,
) -> None:
    options = ("lab", "--duration", "0.6")
    calm = trace(tmp_path, load("lab", {"duration": 0.6}))
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
