"""The examples and the code in the component's README run, and say what they should."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from laglab_control import Controller, StationConfig
from laglab_protocol import Command, Measurement, Sender, Tick, tlog_record

COMPONENT = Path(__file__).parents[2] / "controller"


def run(*arguments):
    ended = subprocess.run(
        [sys.executable, "-W", "error", *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert ended.returncode == 0, ended.stderr
    return ended.stdout


def test_linear_system_beside_the_textbook_filter():
    printed = run(COMPONENT / "examples" / "linear.py")
    rms = {
        name.strip(): float(x) for name, x in re.findall(r"^(.+?) {2,}([\d.]+) m$", printed, re.M)
    }
    assert rms["textbook, no delay"] < rms["delayed-ekf"] < rms["ekf"]
    assert rms["delayed-ekf"] <= min(rms["popf"], rms["popf-exact"])
    difference = float(re.search(r"differ by (\S+)", printed)[1])
    assert difference < 1e-12


@pytest.fixture
def log(tmp_path):
    """A short session: the robot drives, commands take 2 ticks, measurements come 3 ticks late."""
    robot, station = Sender(1, 1), Sender(200, 190)
    controller = Controller(StationConfig(initial_estimate=(-1.0, 0.0, 0.0)))
    model, x, control = controller.config.model, controller.config.initial_estimate, None
    path, past, sent = tmp_path / "robot.tlog", [], []
    with path.open("wb") as file:
        for k in range(100):
            control = controller.advance(control) if control else controller.start()
            control = controller.answer(control, [])
            force = (sent[k - 3], k - 3) if k >= 3 else ((0.0, 0.0), -1)
            past.append(Measurement(*x, *force[0], k, force[1]))
            batch = past[k - 3 : k - 2] if k >= 3 else []
            sent.append(control.drive[:2])
            for message in [*batch, Tick(k, len(batch))]:
                file.write(tlog_record(k * 10_000, robot.frame(message)))
            command = Command(*sent[k], k, 1, 1, 0)
            file.write(tlog_record(k * 10_000, station.frame(command)))
            u = sent[k - 2] if k >= 2 else (0.0, 0.0)
            x = model.f(x, np.array(u))
    return path


def test_recorded_data(log):
    printed = run(COMPONENT / "examples" / "from_a_log.py", log)
    assert [line.split()[0] for line in printed.splitlines()] == ["ekf", "popf", "delayed-ekf"]


def test_the_ten_lines_of_the_readme(tmp_path):
    (code,) = re.findall(r"```python\n(.*?)```", (COMPONENT / "README.md").read_text(), re.S)
    script = tmp_path / "readme.py"
    script.write_text(code)
    tick, x = run(script).split()[:2]
    assert int(tick) == 99
    assert float(x.strip("[]")) == pytest.approx(99.0, abs=0.5)
