"""node-mavlink, which encodes and decodes by itself: it asks, and reads the answers."""

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from .asked import Asked

CLIENT = Path(__file__).parent / "node_client.mjs"


@pytest.fixture
def client(tmp_path: Path) -> Path:
    """The program, beside the package that it needs."""
    npm = shutil.which("npm")
    if npm is None or shutil.which("node") is None:
        pytest.skip("node and npm are not installed")
    try:
        subprocess.run(
            [npm, "install", "--silent", "--ignore-scripts", "node-mavlink@2.3.0"],
            cwd=tmp_path,
            check=True,
            capture_output=True,
            timeout=120,
        )
    except subprocess.SubprocessError as error:
        pytest.skip(f"node-mavlink is not to be had here: {error}")
    return Path(shutil.copy(CLIENT, tmp_path))


@pytest.mark.slow
@pytest.mark.timeout(200)
def test_node_mavlink_asks_and_reads_the_answers(port: int, client: Path, rover: Asked) -> None:
    done = subprocess.run(
        ["node", client, str(port)], capture_output=True, text=True, check=False, timeout=60
    )
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)

    assert told["type"] == 10
    assert (told["latitude"] // 1000, told["longitude"] // 1000) == (210379, 1057819)
    assert told["version"] == told["oldVersion"] > 0
    assert told["home"] == 210380000
    assert told["parameters"] == 5
    assert (told["mission"], told["fence"], told["rally"]) == (0, 1, 2)
    assert (told["other"], told["stream"]) == (3, 0)
    rover.check_against_table("node-mavlink")
