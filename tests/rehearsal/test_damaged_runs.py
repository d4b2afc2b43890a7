"""A run one of whose files is no longer what it was: a line names it, or a picture is made."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import laglab
from laglab.errors import NoRunError
from laglab.results.columns import joined
from laglab.results.shadows import shadow_pieces

COMPARE = ("compare", "run", "--out", "both.png")
FIGURE = ("figure", "run", "--out", "again.png")
REPORT = ("report", "run", "--out", "run.html")
EXPORT = ("export", "run", "--format", "csv", "--out", "exported")
ANIMATE = ("animate", "run", "--out", "run.gif")
REPLAY = ("replay", "run/robot.tlog", "--estimator", "popf")
REPEAT = ("run", "run/scenario.toml", "--timeline", "run/link.csv", "--transport", "inline")
READ_BY = {
    "scenario.toml": (COMPARE, FIGURE, REPLAY, REPEAT),
    "summary.json": (COMPARE,),
    "trace.csv": (COMPARE, FIGURE, REPORT, EXPORT, ANIMATE, REPLAY),
    "link.csv": (REPEAT,),
    "robot.tlog": (REPLAY,),
    "shadow-ekf.csv": (COMPARE,),
    "arrivals.csv": (COMPARE, FIGURE),
    "claims.csv": (FIGURE,),
}
JUNK = {
    "empty": b"",
    "binary": bytes(range(256)) * 20,
    "a long line": b"1" * 200_000,
    "nested": b'{"x": ' + b"[" * 100_000,
    "nested TOML": b"x = " + b"[" * 3000,
}
GOOD_AS_FAR_AS_IT_GOES = {
    ("scenario.toml", "empty"): (REPEAT,),
    ("trace.csv", "half"): (REPLAY,),
    ("link.csv", "half"): (REPEAT,),
    ("robot.tlog", "half"): (REPLAY,),
}
"""An empty scenario that somebody names runs by default; a record that was cut off is that of a
shorter run, but where there is a summary of the whole one."""
DAMAGES = [*JUNK, "a folder", "half", "huge numbers"]


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("whole") / "run"
    laglab.run("lab-radio", {"duration": 0.3, "estimator.compare": ["ekf"]}, out=folder)
    assert {each.name for each in folder.iterdir()} >= READ_BY.keys()
    return folder


@pytest.fixture
def copied(whole: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """In the current folder, to be damaged."""
    monkeypatch.chdir(tmp_path)
    return Path(shutil.copytree(whole, "run"))


def damage(path: Path, how: str) -> None:
    data = path.read_bytes()
    path.unlink()
    match how:
        case "a folder":
            path.mkdir()
        case "half":
            path.write_bytes(data[: len(data) // 2])
        case "huge numbers":
            path.write_bytes(data.replace(b"1", b"1e308"))
        case _:
            path.write_bytes(JUNK[how])


@pytest.mark.parametrize("how", DAMAGES)
@pytest.mark.parametrize("name", READ_BY)
def test_a_damaged_file_is_told_in_a_line(
    name: str, how: str, copied: Path, ended: Callable[..., Any]
) -> None:
    damage(copied / name, how)
    for arguments in READ_BY[name]:
        code, _, errors = ended(*arguments)
        good = arguments in GOOD_AS_FAR_AS_IT_GOES.get((name, how), ())
        assert code == (0 if good else 2), errors
        if code:
            assert len(errors.splitlines()) == 1, errors
            assert "run/" in errors
            assert len(errors) < 400


@pytest.mark.parametrize("number", ["1e308", "1.7e308"])
@pytest.mark.parametrize("command", [COMPARE, FIGURE, ANIMATE])
def test_numbers_that_no_picture_has_room_for_are_told_in_a_line(
    command: tuple[str, ...], number: str, copied: Path, ended: Callable[..., Any]
) -> None:
    trace = copied / "trace.csv"
    header, *rows = trace.read_text("utf-8").splitlines()
    for row in (8, 9):
        cells = rows[row].split(",")
        rows[row] = ",".join([*cells[:2], number, f"-{number}", *cells[4:]])
    trace.write_text("\n".join([header, *rows, ""]), "utf-8")
    code, _, errors = ended(*command)
    assert code == 4, errors
    assert len(errors.splitlines()) == 1
    assert "cannot be drawn" in errors


@pytest.mark.parametrize(
    ("said", "instead", "told"),
    [
        ('kind = "delayed-ekf"', 'kind = "popf"', "estimator.kind is popf, but delayed-ekf ran"),
        ("command_delay = 10", "command_delay = 1", "link.command_delay is 1, but 10 ran"),
        ("seed = 1", "seed = 7", "seed is 7, but 1 ran"),
    ],
)
def test_a_scenario_that_is_not_the_one_that_ran_is_told(
    said: str, instead: str, told: str, copied: Path
) -> None:
    path = copied / "scenario.toml"
    text = path.read_text("utf-8")
    path.write_text(text.replace(said, instead), "utf-8")
    with pytest.raises(laglab.LaglabError, match=told):
        laglab.open_run(copied)
    path.write_text(text.replace('name = "lab-radio"', 'name = "mine"'), "utf-8")
    assert laglab.open_run(copied).scenario.name == "mine"


@pytest.mark.parametrize("how", ["empty", "binary", "a folder", "gone"])
def test_in_python_a_damaged_trace_is_an_error_of_ours(how: str, copied: Path) -> None:
    if how == "gone":
        (copied / "trace.csv").unlink()
    else:
        damage(copied / "trace.csv", how)
    run = laglab.open_run(copied)
    with pytest.raises(laglab.LaglabError, match=r"trace\.csv"):
        _ = run.trace
    with pytest.raises(laglab.LaglabError, match=r"trace\.csv"):
        next(run.pieces())


def test_a_table_that_is_not_there_is_named_once(tmp_path: Path) -> None:
    with pytest.raises(NoRunError, match=r"none\.csv cannot be read: No such file or directory$"):
        joined(shadow_pieces(tmp_path / "none.csv"))
