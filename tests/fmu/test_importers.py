"""Other people's importers: Ecos runs every FMU, libcosim FMI 2.0, which is all that it knows."""

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from laglab_fmu import Robot, RobotParameters

HERE = Path(__file__).parent
TICKS = 30
CASES = [
    ("ecospy", "importer_ecos.py", "Robot2"),
    ("ecospy", "importer_ecos.py", "Robot3"),
    ("ecospy", "importer_ecos.py", "Fleet3"),
    ("libcosimpy", "importer_libcosim.py", "Robot2"),
]


@pytest.mark.parametrize(("package", "program", "name"), CASES)
def test_it_gets_the_bits_of_our_stepper(
    fmus: dict[str, Path], tmp_path: Path, package: str, program: str, name: str
) -> None:
    """In a process of their own: they are native code, and leave what they extract in TMPDIR."""
    if find_spec(package) is None:
        pytest.skip(f"{package} has no wheel for this machine")
    # Ecos needs TBB, whose package puts it where no library is looked for
    surroundings = {"TMPDIR": str(tmp_path), "LD_LIBRARY_PATH": str(Path(sys.prefix, "lib"))}
    done = subprocess.run(
        [sys.executable, str(HERE / program), str(fmus[name]), str(TICKS)],
        env=os.environ | surroundings,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    [line] = [line for line in done.stdout.splitlines() if line.startswith("outputs ")]
    with Robot.open(3, RobotParameters(start=(0.0, 0.0, 0.4), seed=6)) as robot:
        for _ in range(TICKS):
            reading = robot.step(4.0, 9.0)
    assert tuple(map(float.fromhex, line.split()[1:])) == reading
