"""The examples with other people's filters: in the loop, as good as ours, and short."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

EXAMPLES = Path(__file__).parents[2] / "controller" / "examples"
MOST_LINES = 60


def laglab(folder, *arguments):
    return subprocess.run(
        [sys.executable, "-m", "laglab", *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(EXAMPLES), "PYTHONDONTWRITEBYTECODE": "1"},
        check=False,
        capture_output=True,
        text=True,
        timeout=100,
    )


@pytest.mark.timeout(120)
@pytest.mark.parametrize("name", ["filterpy_ukf:Ukf", "stonesoup_ekf:StoneSoupEkf"])
def test_it_drives_the_robot_beside_our_own_filter(tmp_path, name):
    path = EXAMPLES / f"{name.split(':')[0]}.py"
    assert len(path.read_text().splitlines()) <= MOST_LINES
    filters = ("--estimator", name, "--estimator", "delayed-ekf")
    done = laglab(tmp_path, "run", "lab", *filters, "--duration", "1", "--out", "run")
    assert done.returncode == 0, done.stderr
    trace = np.genfromtxt(tmp_path / "run" / "trace.csv", delimiter=",", names=True)
    ours = np.genfromtxt(tmp_path / "run" / "shadow-delayed-ekf.csv", delimiter=",", names=True)
    for axis in ("x", "y", "theta"):
        assert np.abs(trace[f"{axis}_est"] - ours[axis]).max() < 2e-4


@pytest.mark.slow
@pytest.mark.timeout(240)
@pytest.mark.parametrize("name", ["filterpy_ukf:Ukf", "stonesoup_ekf:StoneSoupEkf"])
def test_it_keeps_the_interface(tmp_path, name):
    checked = laglab(tmp_path, "check", name)
    assert checked.returncode == 0, checked.stdout
