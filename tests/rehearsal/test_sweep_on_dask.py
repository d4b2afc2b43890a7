"""Studies on a dask.distributed cluster, any part of which may be killed at any moment."""

import json
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from .studying import (
    CELLS,
    SEEDS,
    SHORT,
    SMALL,
    Contents,
    contents,
    nothing_again,
    undisturbed,
    wait_for_cells,
    write_deadly_study,
)

Start = Callable[..., "subprocess.Popen[str]"]
SWEEP = ("-m", "laglab", "sweep", "small.toml", *SHORT, "--out", "out", "--scheduler")


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> Contents:
    path = tmp_path_factory.mktemp("expected") / "small.toml"
    path.write_text(SMALL)
    return undisturbed(path)


class Cluster:
    """A scheduler and workers on this machine, started and ended one by one."""

    def __init__(self, start: Start, folder: Path) -> None:
        self._start = start
        self._folder = folder
        self._started = 0

    def scheduler(self) -> tuple["subprocess.Popen[str]", str]:
        """And the address at which it is."""
        self._started += 1
        told = self._folder / f"scheduler-{self._started}.json"
        program = ("-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0")
        process = self._program(*program, "--no-dashboard", "--scheduler-file", str(told))
        return process, str(json.loads(self._read(told))["address"])

    def worker(self, address: str) -> "subprocess.Popen[str]":
        """One, of one thread."""
        program = ("-m", "distributed.cli.dask_worker", address, "--host", "127.0.0.1")
        here = ("--local-directory", str(self._folder))
        return self._program(*program, *here, "--no-dashboard", "--no-nanny", "--nthreads", "1")

    def sweep(self, address: str, *by: str) -> "subprocess.Popen[str]":
        """The client, started by a program if told one."""
        return self._start(*by, sys.executable, *SWEEP, address)

    def _program(self, *arguments: str) -> "subprocess.Popen[str]":
        """What it logs goes nowhere, so that it never waits for a reader."""
        quiet = ("sh", "-c", 'exec "$@" >/dev/null 2>&1', "sh", sys.executable)
        return self._start(*quiet, *arguments)

    def _read(self, path: Path) -> str:
        deadline = time.monotonic() + 30
        while time.monotonic() < deadline:
            if path.exists() and (text := path.read_text()):
                return text
            time.sleep(0.05)
        raise AssertionError("no scheduler")


@pytest.fixture
def cluster(start_program: Start, tmp_path: Path) -> Cluster:
    (tmp_path / "small.toml").write_text(SMALL)
    return Cluster(start_program, tmp_path)


def said(process: "subprocess.Popen[str]", code: int, patience: float = 80.0) -> tuple[str, str]:
    """On both outputs, up to its end with this exit code."""
    output, errors = process.communicate(timeout=patience)
    assert process.returncode == code, errors
    assert "Traceback" not in errors
    return output, errors


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_whatever_is_killed_nothing_is_lost_or_done_twice(
    cluster: Cluster, tmp_path: Path, expected: Contents
) -> None:
    """A worker, whose work another does; then the client; then the scheduler; then none."""
    rng, out = random.Random(14), tmp_path / "out"
    scheduler, address = cluster.scheduler()
    first, second = cluster.worker(address), cluster.worker(address)

    client = cluster.sweep(address)
    wait_for_cells(out, 1)
    time.sleep(rng.uniform(0.0, 0.1))
    first.kill()
    wait_for_cells(out, 3)
    time.sleep(rng.uniform(0.0, 0.1))
    client.kill()
    client.communicate(timeout=10)
    drop_half_written(out)
    had = len(contents(out))
    assert 3 <= had < CELLS

    with nothing_again(out):
        client = cluster.sweep(address)
        wait_for_cells(out, had + 2)
        scheduler.kill()
        _, errors = said(client, 4)
    lines = errors.splitlines()
    assert len(lines) == 1
    assert "what is done is kept, and the same command goes on from there" in lines[0]
    had = len(contents(out))
    assert had < CELLS

    second.kill()
    _, address = cluster.scheduler()
    cluster.worker(address)
    with nothing_again(out):
        output, errors = said(cluster.sweep(address), 0)
    assert not errors
    assert f"{SEEDS * had} of them had been made before" in output
    assert contents(out) == expected


def drop_half_written(out: Path) -> None:
    for half in (out / "cells").glob(".*.new"):
        half.unlink()


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_a_cluster_of_our_own_ends_with_us(
    cluster: Cluster, tmp_path: Path, expected: Contents
) -> None:
    """Ctrl-C in a terminal goes to all that it started."""
    client = cluster.sweep("local", "setsid")
    wait_for_cells(tmp_path / "out", 2)
    os.killpg(client.pid, signal.SIGINT)
    _, errors = said(client, 130)
    kept, last = errors.splitlines()
    assert "runs are kept" in kept
    assert last == "laglab: interrupted"
    output, errors = said(cluster.sweep("local"), 0)
    assert not errors
    assert f"{CELLS * SEEDS} runs" in output
    assert contents(tmp_path / "out") == expected


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_a_run_that_kills_its_worker_costs_the_others_nothing(
    start_program: Start, tmp_path: Path
) -> None:
    """As without a cluster; dask, too, gives it up at the third, and takes seconds for each."""
    write_deadly_study(tmp_path)
    where = ("--scheduler", "local", "--workers", "2", "--out", "out")
    swept = start_program(sys.executable, "-m", "laglab", "sweep", "mortal.toml", *where)
    _, errors = said(swept, 4, patience=240)
    assert "options.at = 10: Attempted to run task" in errors
    assert "on 3 different workers" in errors
    assert "and 1 more such" in errors
    assert len(contents(tmp_path / "out")) == 2


def test_a_scheduler_that_is_not_there_is_one_line(cluster: Cluster, tmp_path: Path) -> None:
    for address in ("tcp://127.0.0.1:1", "nonsense"):
        _, errors = said(cluster.sweep(address), 2)
        assert errors.startswith(f"laglab: --scheduler {address}: ")
        assert len(errors.splitlines()) == 1
    assert not (tmp_path / "out").exists()
