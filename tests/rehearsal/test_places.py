"""Where results cannot go: one line, exit 2, before anything runs, and nothing is touched."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import laglab
from laglab.errors import PlaceError, ResultsError
from laglab.files import file_place, whole_file, write_whole
from laglab.results.place import place

Refused = Callable[..., str]
LONG_NAME = "x" * 300
NO_FOLDERS = ["file", "file/below", "/proc/none", LONG_NAME]
NO_FILES = ["folder", "file/below", "none/below", "/proc/none", LONG_NAME]
"""Not even root can write there."""

INTO_A_FOLDER = {
    "run": ("run", "fig6", "--out"),
    "gateway": ("gateway", "fig6", "--endpoint", "udpin://127.0.0.1:0", "--out"),
    "controller": ("controller", "fig6", "--endpoint", "udpin://127.0.0.1:0", "--out"),
    "replay": ("replay", "run/robot.tlog", "--estimator", "popf", "--out"),
    "fmu": ("fmu", "build", "--out"),
    "generate": ("protocol", "generate"),
}
PICTURES = {
    "compare": ("compare", "run", "--out"),
    "consistency": ("consistency", "--out"),
    "trust": ("trust", "--out"),
}
INTO_A_FILE = {
    "conform": ("conform", "udpin://127.0.0.1:0", "--side", "robot", "--junit"),
    "bench": ("bench", "filter", "--json"),
    "keygen": ("protocol", "keygen"),
}


@pytest.fixture(scope="module")
def a_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What a run left."""
    folder = tmp_path_factory.mktemp("whole") / "run"
    laglab.run("fig6", {"duration": 0.1}, out=folder)
    return folder


@pytest.fixture(autouse=True)
def here(tmp_path: Path, a_run: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A file, an empty folder, and what a run left."""
    monkeypatch.chdir(tmp_path)
    Path("file").write_text("kept")
    Path("folder").mkdir()
    shutil.copytree(a_run, "run")
    return tmp_path


@pytest.fixture
def in_vain(refused: Refused) -> Refused:
    """The one line that is said, and nothing was done."""

    def call(*arguments: str) -> str:
        before = sorted(Path.cwd().rglob("*"))
        line = refused(*arguments)
        assert sorted(Path.cwd().rglob("*")) == before
        assert Path("file").read_text() == "kept"
        return line

    return call


@pytest.mark.parametrize("place", NO_FOLDERS)
@pytest.mark.parametrize("command", INTO_A_FOLDER)
def test_no_folder_can_be_there(command: str, place: str, in_vain: Refused) -> None:
    assert place in in_vain(*INTO_A_FOLDER[command], place)


@pytest.mark.parametrize("place", NO_FILES)
@pytest.mark.parametrize("command", INTO_A_FILE)
def test_no_file_can_be_there(command: str, place: str, in_vain: Refused) -> None:
    assert place in in_vain(*INTO_A_FILE[command], place)


@pytest.mark.parametrize("place", NO_FILES)
@pytest.mark.parametrize("command", PICTURES)
def test_no_picture_can_be_there(command: str, place: str, in_vain: Refused) -> None:
    Path("folder.png").mkdir()
    assert f"{place}.png" in in_vain(*PICTURES[command], f"{place}.png")


@pytest.mark.parametrize("name", ["picture", "picture.xyz", ".png", "", "/dev/null"])
@pytest.mark.parametrize("command", PICTURES)
def test_a_picture_of_no_known_kind(command: str, name: str, in_vain: Refused) -> None:
    assert "its name must end in one of" in in_vain(*PICTURES[command], name)


@pytest.mark.parametrize("command", ["run", "gateway", "controller"])
def test_another_runs_results_are_taken_only_by_force(command: str, in_vain: Refused) -> None:
    before = Path("run/trace.csv").read_bytes()
    line = in_vain(*INTO_A_FOLDER[command], "run")
    assert "another run's results are there already" in line
    assert "--force" in line
    assert Path("run/trace.csv").read_bytes() == before


def test_force_leaves_nothing_of_the_other_run(ended: Callable[..., Any]) -> None:
    shadow, notes = Path("run/shadow-ekf.csv"), Path("run/notes.txt")
    shadow.write_text("of the other run")
    notes.write_text("somebody's own")
    options = ("--duration", "0.2", "--transport", "inline", "--out", "run", "--force")
    assert ended("run", "fig6", *options).code == 0
    assert not shadow.exists()
    assert notes.read_text() == "somebody's own"


def test_what_cannot_be_removed_is_not_forced(in_vain: Refused) -> None:
    Path("folder/trace.csv").mkdir()
    line = in_vain("run", "fig6", "--out", "folder", "--force")
    assert line.startswith("laglab: cannot write into folder: ")


@pytest.mark.parametrize(
    ("name", "folder"), [("../../evil", "..-..-evil"), ("a b", "a-b"), ("HERE/evil", None)]
)
def test_the_name_of_a_scenario_is_no_path(
    name: str, folder: str | None, here: Path, ended: Callable[..., Any]
) -> None:
    name = name.replace("HERE", str(here))
    folder = folder or name.replace("/", "-")
    Path("own.toml").write_text(f'name = "{name}"\nduration = 0.1\n')
    assert ended("run", "own.toml", "--transport", "inline").code == 0
    assert [path.name for path in Path("runs").iterdir()] == [folder]
    assert not [*here.rglob("evil"), *here.parent.glob("evil")]


def test_a_name_of_a_scenario_that_is_too_long_for_a_folder_is_said(refused: Refused) -> None:
    Path("own.toml").write_text(f'name = "{LONG_NAME}"\nduration = 0.1\n')
    assert "File name too long" in refused("run", "own.toml", "--transport", "inline")
    assert not Path("runs").exists()
    assert "File name too long" in refused("run", "fig6", "--out", f"a/b/{LONG_NAME}")
    assert not Path("a").exists()


@pytest.mark.parametrize(
    ("name", "begins"), [("x.pdf", b"%PDF"), ("x.svg", b"<?xml"), ("x.PNG", b"\x89PNG")]
)
def test_the_kind_of_a_picture_is_that_of_its_name(
    name: str, begins: bytes, ended: Callable[..., Any]
) -> None:
    assert ended("compare", "run", "run", "--out", name).code == 0
    assert Path(name).read_bytes().startswith(begins)


@pytest.mark.parametrize("broken_by", [KeyboardInterrupt, OSError("no room")])
def test_what_was_there_stays_until_the_new_is_whole(broken_by: BaseException) -> None:
    def broken() -> None:
        with whole_file(Path("old")) as file:
            file.write(b"half of the n")
            raise broken_by

    Path("old").write_text("of before")
    with pytest.raises((KeyboardInterrupt, ResultsError)):
        broken()
    assert Path("old").read_text() == "of before"
    write_whole(Path("old"), b"new")
    assert Path("old").read_text() == "new"
    assert not list(Path().glob("*.new")) + list(Path().glob(".*.new"))


def test_a_link_to_a_place_where_nothing_is_yet_stays() -> None:
    Path("link.png").symlink_to("target.png")
    file_place("--out", Path("link.png"))
    assert Path("link.png").is_symlink()


def test_an_unset_variable_names_no_place(in_vain: Refused) -> None:
    assert "--out" in in_vain("run", "fig6", "--out", "")


def test_a_run_that_could_not_begin_blocks_no_place(ended: Callable[..., Any]) -> None:
    port = "serial:///dev/none:115200"
    for _ in range(2):
        code, _, errors = ended("run", "lab", "--plant", port, "--out", "unbegun")
        assert code == 2
        assert "no such port /dev/none" in errors
    assert not Path("unbegun").exists()


def test_what_had_no_room_blocks_no_place(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(path: Path, *_: object, **__: object) -> None:
        path.touch()
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_text", full)
    with pytest.raises(PlaceError, match="No space left on device"):
        place(laglab.load("fig6"), Path("new"))
    assert not list(Path("new").iterdir())
