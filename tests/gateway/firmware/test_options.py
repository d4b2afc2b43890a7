"""The firmware's own command line."""

import subprocess
from pathlib import Path

import pytest

from laglab_protocol import KeyFileError, read_key


@pytest.mark.parametrize(
    "told",
    [
        ("--playout", "x"),
        ("--playout", "1.5"),
        ("--playout", "-3"),
        ("--playout", "99999999999"),
        ("--speed", "4x"),
        ("--speed", "nan"),
        ("--speed", ""),
    ],
)
def test_what_is_no_number_in_range_is_refused(firmware: Path, told: tuple[str, str]) -> None:
    done = subprocess.run(
        [firmware, *told, "port"], capture_output=True, text=True, check=False, timeout=10
    )
    assert done.returncode == 2
    assert done.stderr.startswith("usage: ")


@pytest.mark.parametrize(
    "text",
    ["ab" * 31 + "a", "ab" * 32 + "cd", "0x" * 64, "+a" * 32, "a b " * 32, "", "ab" * 31 + "a\n"],
)
def test_a_key_is_refused_here_that_laglab_would_refuse(
    firmware: Path, tmp_path: Path, text: str
) -> None:
    key = tmp_path / "robot.key"
    key.write_text(text)
    key.chmod(0o600)
    with pytest.raises(KeyFileError, match="is no key"):
        read_key(key)
    done = subprocess.run(
        [firmware, "--key", key, "port"], capture_output=True, text=True, check=False, timeout=10
    )
    assert done.returncode == 2
    assert done.stderr == f"{key}: it is no key: it must hold 64 hexadecimal digits\n"
