"""Where results cannot go: one line, exit 2, before anything runs, and nothing is touched."""

import shutil
from pathlib import Path

import pytest

from laglab.command import main
from laglab.errors import ResultsError
from laglab.files import file_place, whole_file, write_whole

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
    options = ("--duration", "0.1", "--transport", "inline", "--out", str(folder))
    with pytest.raises(SystemExit):
        main(["run", "fig6", *options])
    return folder


@pytest.fixture(autouse=True)
def here(tmp_path: Path, a_run: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A file, an empty folder, and what a run left."""
    monkeypatch.chdir(tmp_path)
    Path("file").write_text("kept")
    Path("folder").mkdir()
    shutil.copytree(a_run, "run")
    return tmp_path


def refused(arguments: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> str:
    """The one line that is said, and nothing was done."""
    before = sorted(Path.cwd().rglob("*"))
    capsys.readouterr()
    with pytest.raises(SystemExit) as ended:
        main([*arguments])
    said = capsys.readouterr()
    assert (ended.value.code, said.out) == (2, "")
    assert sorted(Path.cwd().rglob("*")) == before
    assert Path("file").read_text() == "kept"
    (line,) = said.err.splitlines()
    assert line.startswith("laglab: ")
    return line


@pytest.mark.parametrize("place", NO_FOLDERS)
@pytest.mark.parametrize("command", INTO_A_FOLDER)
def test_no_folder_can_be_there(
    command: str, place: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert place in refused((*INTO_A_FOLDER[command], place), capsys)


@pytest.mark.parametrize("place", NO_FILES)
@pytest.mark.parametrize("command", INTO_A_FILE)
def test_no_file_can_be_there(command: str, place: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert place in refused((*INTO_A_FILE[command], place), capsys)


@pytest.mark.parametrize("place", NO_FILES)
@pytest.mark.parametrize("command", PICTURES)
def test_no_picture_can_be_there(
    command: str, place: str, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("folder.png").mkdir()
    assert f"{place}.png" in refused((*PICTURES[command], f"{place}.png"), capsys)


@pytest.mark.parametrize("name", ["picture", "picture.xyz", ".png", "", "/dev/null"])
@pytest.mark.parametrize("command", PICTURES)
def test_a_picture_of_no_known_kind(
    command: str, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert "its name must end in one of" in refused((*PICTURES[command], name), capsys)


@pytest.mark.parametrize("command", ["run", "gateway", "controller"])
def test_another_runs_results_are_taken_only_by_force(
    command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    before = Path("run/trace.csv").read_bytes()
    line = refused((*INTO_A_FOLDER[command], "run"), capsys)
    assert "another run's results are there already" in line
    assert "--force" in line
    assert Path("run/trace.csv").read_bytes() == before


def test_force_leaves_nothing_of_the_other_run() -> None:
    shadow, notes = Path("run/shadow-ekf.csv"), Path("run/notes.txt")
    shadow.write_text("of the other run")
    notes.write_text("somebody's own")
    options = ("--duration", "0.2", "--transport", "inline", "--out", "run", "--force")
    with pytest.raises(SystemExit) as ended:
        main(["run", "fig6", *options])
    assert ended.value.code == 0
    assert not shadow.exists()
    assert notes.read_text() == "somebody's own"


def test_what_cannot_be_removed_is_not_forced(capsys: pytest.CaptureFixture[str]) -> None:
    Path("folder/trace.csv").mkdir()
    line = refused(("run", "fig6", "--out", "folder", "--force"), capsys)
    assert line.startswith("laglab: cannot write into folder: ")


@pytest.mark.parametrize("name", ["../../evil", "/tmp/evil", "a b", "x" * 300])
def test_the_name_of_a_scenario_is_no_path(
    name: str, here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("own.toml").write_text(f'name = "{name}"\nduration = 0.1\n')
    with pytest.raises(SystemExit) as ended:
        main(["run", "own.toml", "--transport", "inline"])
    assert ended.value.code == (2 if len(name) > 255 else 0)
    assert "Traceback" not in capsys.readouterr().err
    assert all(path.parent == here / "runs" for path in here.glob("runs/*"))
    assert not (here.parent / "evil").exists()


@pytest.mark.parametrize(
    ("name", "begins"), [("x.pdf", b"%PDF"), ("x.svg", b"<?xml"), ("x.PNG", b"\x89PNG")]
)
def test_the_kind_of_a_picture_is_that_of_its_name(name: str, begins: bytes) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["compare", "run", "run", "--out", name])
    assert ended.value.code == 0
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
