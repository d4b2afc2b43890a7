"""A run in other programs' formats: they read back what it holds."""

import csv
import io
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet
import pytest
import scipy.io

import laglab
from laglab.errors import PlaceError
from laglab.export import export
from laglab.export.csv_files import write_csv
from laglab.export.formats import FORMATS
from laglab.export.tables import Table, tables
from laglab.results.meaning import FILES, Column, tick_columns
from laglab.results.run import Run
from laglab.results.shadows import COLUMNS
from laglab_gateway import ROWS, TRACE_FILE, TraceRow

Exported = Callable[..., Path]
Refused = Callable[..., str]

DOCS = Path(__file__).parents[2] / "docs"
SHADOW = "popf-exact"
SHADOW_FILE = f"shadow-{SHADOW}.csv"


@pytest.fixture(scope="module")
def a_run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """With all that a run can leave but a clock: losses, delays, and a filter that shadows it."""
    folder = tmp_path_factory.mktemp("runs") / "radio"
    changes = {"duration": 2.0, "estimator.compare": [SHADOW], "link.command.loss": 0.2}
    return laglab.run("lab-radio", changes, out=folder)


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def exported(ended: Callable[..., Any]) -> Exported:
    """By the command."""

    def call(run: Run, *options: str) -> Path:
        assert ended("export", run.directory, "--format", *options).code == 0
        return Path.cwd()

    return call


def known(run: Run) -> dict[str, Any]:
    """All columns of its ticks."""
    claims = {name: column for name, column in run.claims.items() if name.startswith("p_")}
    (shadow,) = (piece for piece in run.shadow_pieces(SHADOW) if len(piece["tick"]))
    assert (shadow["tick"] == run.trace["tick"]).all()
    beside = {f"{name}_{SHADOW}": shadow[name] for name in COLUMNS[1:]}
    nothing = np.full(len(run.trace["tick"]), np.nan)
    return dict(run.trace) | claims | beside | {"lateness": nothing, "answer": nothing}


def assert_equal(read: dict[str, Any], expected: dict[str, Any]) -> None:
    assert read.keys() == expected.keys()
    for name, column in expected.items():
        np.testing.assert_array_equal(read[name], column, name)


def test_csv_reads_back(exported: Exported, a_run: Run) -> None:
    folder = exported(a_run, "csv") / "radio-csv"
    with (folder / "ticks.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert rows[7]["tick"] == "7"
    assert list(rows[0]) == [column.name for column in tick_columns([SHADOW])]
    read = {name: [float(row[name] or "nan") for row in rows] for name in rows[0]}
    assert_equal(read, known(a_run))
    for name in ("link.csv", "arrivals.csv"):
        assert a_run.directory
        assert (folder / name).read_text() == (a_run.directory / name).read_text()


def test_parquet_reads_back_and_says_its_units(exported: Exported, a_run: Run) -> None:
    folder = exported(a_run, "parquet") / "radio-parquet"
    ticks = pyarrow.parquet.read_table(folder / "ticks.parquet")
    assert_equal({name: ticks[name].to_numpy() for name in ticks.column_names}, known(a_run))
    for column in tick_columns([SHADOW]):
        about = ticks.schema.field(column.name).metadata
        assert about[b"unit"].decode() == column.unit
        assert about[b"description"].decode() == column.sentence
    assert ticks["answer"].null_count == len(ticks)
    assert ticks.schema.metadata[b"scenario"].decode() == a_run.scenario.to_toml()
    for name, expected in (("link", a_run.link), ("arrivals", a_run.arrivals)):
        read = pyarrow.parquet.read_table(folder / f"{name}.parquet").to_pydict()
        assert_equal(read, dict(expected))


def test_mat_reads_back_and_says_its_units(exported: Exported, a_run: Run) -> None:
    exported(a_run, "mat")
    read = scipy.io.loadmat("radio.mat", squeeze_me=True, struct_as_record=False)
    expected = {name.replace("-", "_"): column for name, column in known(a_run).items()}
    assert_equal(vars(read["ticks"]) | {"_fieldnames": 0}, expected | {"_fieldnames": 0})
    assert read["link"].fate.tolist() == a_run.link["fate"].tolist()
    assert read["units"].ticks.p_xt_popf_exact == "m rad"
    assert read["scenario"] == a_run.scenario.to_toml()


def test_a_filter_may_be_called_anything_in_a_mat_file(monkeypatch: pytest.MonkeyPatch) -> None:
    """MATLAB's names are ASCII and short: none is refused, and none takes another's place."""
    long = "a_filter_whose_name_is_much_longer_than_matlab_lets_a_name_be"
    kinds = [f"{long}:One", f"{long}:Two", "named:Schätzer", "named:S_a", "named_S:a"]
    for kind in kinds:
        module, _, name = kind.partition(":")
        with Path(f"{module}.py").open("a", encoding="utf-8") as file:
            file.write(f"from laglab_control.estimators.paper.ekf import Ekf as {name}\n")
    monkeypatch.syspath_prepend(Path.cwd())
    run = laglab.run("lab", {"duration": 0.1, "estimator.compare": kinds})
    read = scipy.io.loadmat(export(run, "mat"), squeeze_me=True, struct_as_record=False)
    ticks, units = read["ticks"]._fieldnames, read["units"].ticks._fieldnames
    assert ticks == units
    assert len(ticks) == len(tick_columns(kinds))
    assert {"x_named_Sch_tzer", "x_named_S_a", "x_named_S_a_2"} < set(ticks)


@pytest.mark.parametrize("name", FORMATS)
def test_the_same_run_gives_the_same_bytes(
    exported: Exported, name: str, a_run: Run, tmp_path: Path
) -> None:
    ending = FORMATS[name].ending  # type: ignore[index]
    contents = []
    for _ in range(2):
        place = exported(a_run, name, "--force") / f"radio{ending}"
        files = sorted(place.iterdir()) if place.is_dir() else [place]
        contents.append([path.read_bytes() for path in files])
    assert contents[0] == contents[1]
    assert {each.name for each in tmp_path.iterdir()} == {f"radio{ending}"}


@pytest.mark.parametrize("name", FORMATS)
def test_what_is_there_is_kept(exported: Exported, name: str, a_run: Run, refused: Refused) -> None:
    form = FORMATS[name]  # type: ignore[index]
    place = Path(f"radio{form.ending}")
    place = place / form.files[0] if form.files else place
    place.parent.mkdir(exist_ok=True)
    place.write_text("kept")
    line = refused("export", a_run.directory, "--format", name)
    assert line == f"laglab: {place} is there already: say another --out, or --force"
    assert place.read_text() == "kept"
    exported(a_run, name, "--force")
    assert place.read_bytes() != b"kept"


def test_a_runs_own_tables_are_kept_whatever_is_said(a_run: Run, refused: Refused) -> None:
    assert a_run.directory
    before = (a_run.directory / "arrivals.csv").read_bytes()
    line = refused(
        "export", a_run.directory, "--format", "csv", "--out", a_run.directory, "--force"
    )
    assert "a run's results are there: take another folder" in line
    assert (a_run.directory / "arrivals.csv").read_bytes() == before
    assert not (a_run.directory / "ticks.csv").exists()


def test_what_cannot_be_is_a_line(a_run: Run, refused: Refused) -> None:
    Path("empty").mkdir()
    assert "empty/summary.json" in refused("export", "empty", "--format", "csv")
    assert "'xlsx' is not one of 'csv'" in refused("export", a_run.directory, "--format", "xlsx")
    for name, place in (("csv", "empty/file/below"), ("mcap", "empty"), ("mat", "/proc/none")):
        Path("empty/file").write_text("")
        options = ("--format", name, "--out", place)
        assert place in refused("export", a_run.directory, *options)


@pytest.mark.parametrize("damage", [("tick", "tock"), ("1", "1e308")])
@pytest.mark.parametrize("file", ["trace.csv", "claims.csv", "arrivals.csv", SHADOW_FILE])
def test_a_damaged_table_is_told_in_a_line(
    file: str, damage: tuple[str, str], a_run: Run, refused: Refused
) -> None:
    assert a_run.directory
    shutil.copytree(a_run.directory, "run")
    Path("run", file).write_text((a_run.directory / file).read_text().replace(*damage))
    for name in ("csv", "mcap"):
        assert "run" in refused("export", "run", "--format", name)
    assert not Path("run.mcap").exists()


def test_from_python_a_text_says_where_and_an_unknown_format_is_refused(a_run: Run) -> None:
    assert export(a_run, "csv", "there") == Path("there")
    assert (Path("there") / "ticks.csv").is_file()
    with pytest.raises(PlaceError, match=r"format: take one of csv, .*, not 'xlsx'"):
        export(a_run, "xlsx")  # type: ignore[arg-type]


def test_tables_without_a_row_have_their_columns() -> None:
    """Before any message came; in memory, without a filter."""
    run = laglab.run("fig5", {"duration": 0.03})
    folder = export(run, "csv")
    assert (folder / "arrivals.csv").read_text() == "direction,tick,arrived,time,refused\n"
    assert (folder / "ticks.csv").read_text().splitlines()[1].endswith("," * 8)
    link = pyarrow.parquet.read_table(export(run, "parquet") / "link.parquet")
    assert (len(link), link["tick"].type, link["fate"].type) == (0, "int64", "string")
    read = scipy.io.loadmat(export(run, "mat"), struct_as_record=False, squeeze_me=True)
    assert len(read["ticks"].x) == 4
    assert np.isnan(read["ticks"].p_xx).all()
    assert read["arrivals"].tick.size == 0


def test_a_column_is_called_what_it_is_called() -> None:
    """Not what its name would be as a number: somebody's filter may be called Drive2."""
    name, file = "x_drive2", io.BytesIO()
    column = Column(name, "m", "Where it is.")
    write_csv(Table("ticks", [column], [{name: np.array([1e-7])}], "run"), file)
    assert file.getvalue() == b"x_drive2\n1e-07\n"


def test_of_a_run_on_the_wall_clock_each_tick_has_its_lateness() -> None:
    run = laglab.run("lab", {"pace": "realtime", "speed": 20.0, "duration": 0.5})
    late = run.timing["tick"].astype(int)
    assert len(late) > 40
    (ticks,) = tables(run).ticks.pieces
    for name in ("lateness", "answer"):
        np.testing.assert_array_equal(ticks[name][late], run.timing[name])


def test_the_columns_are_those_of_the_files() -> None:
    rows = {TRACE_FILE: TraceRow._fields} | {name: kind._fields for name, kind in ROWS.items()}
    names = {name: tuple(each.name for each in columns) for name, columns in FILES.items()}
    assert names == rows | {"shadow-NAME.csv": COLUMNS}
