"""The same seed gives the same trace, byte for byte, whatever lies between the two sides."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

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
