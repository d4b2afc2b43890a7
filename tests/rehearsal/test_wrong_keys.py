"""Keys that are none, found at once; and a far end that has another key, or none, named soon."""

import re
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from laglab_protocol import make_key

Start = Callable[..., "subprocess.Popen[str]"]
HERE = ("--endpoint", "udpin://127.0.0.1:0")
SIDES = {
    "run": ("run", "fig6"),
    "inline": ("run", "fig6", "--transport", "inline"),
    "serial": ("run", "fig6", "--transport", "serial"),
    "gateway": ("gateway", "fig6", *HERE),
    "controller": ("controller", "fig6", *HERE),
    "conform": ("conform", "udpin://127.0.0.1:0", "--side", "robot"),
}


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name, text, mode in (
        ("open", "ab" * 32, 0o644),
        ("short", "abcd", 0o600),
        ("text", "no key\n", 0o600),
        ("junk", "", 0o600),
        ("empty", "", 0o600),
    ):
        path = Path(name)
        path.write_text(text)
        path.chmod(mode)
    Path("junk").write_bytes(bytes(range(256)))
    Path("folder").mkdir(mode=0o700)


@pytest.mark.parametrize("key", ["none", "open", "short", "text", "junk", "empty", "folder"])
@pytest.mark.parametrize("side", SIDES)
def test_what_is_no_key_is_told_before_anything_runs(
    side: str, key: str, refused: Callable[..., str]
) -> None:
    assert key in refused(*SIDES[side], "--key", key)
    assert not Path("runs").exists()


@pytest.mark.parametrize(
    ("side", "listens", "calls", "why"),
    [
        ("gateway", ("--key", "ours"), ("--key", "theirs"), "not signed with this key"),
        ("gateway", ("--key", "ours"), (), "not signed: give the sender the same --key"),
        ("gateway", (), ("--key", "theirs"), "signed, and there is no key here"),
        ("controller", ("--key", "ours"), ("--key", "theirs"), "not signed with this key"),
    ],
)
def test_who_listens_soon_names_a_caller_with_another_key(
    side: str, listens: tuple[str, ...], calls: tuple[str, ...], why: str, start: Start
) -> None:
    make_key(Path("ours"))
    make_key(Path("theirs"))
    listener = start(side, "fig6", *HERE, *listens)
    assert listener.stderr is not None
    here = re.match(r"listening on udpin://(\S+): ", listener.stderr.readline())
    assert here
    other = "controller" if side == "gateway" else "gateway"
    caller = start(other, "fig6", "--endpoint", f"udpout://{here[1]}", *calls)
    warned = listener.stderr.readline()
    assert re.match(rf"warning: \S+: \d+ frames? refused: {why}", warned), warned
    for each in (caller, listener):
        each.send_signal(signal.SIGINT)
        each.communicate(timeout=20)
        assert each.returncode == 130
