"""The formats: what each needs, where it goes, and how it is written.

What writes a format is loaded when it is asked for: each has libraries of its own.
"""

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Literal, NamedTuple

from laglab.errors import PlaceError
from laglab.export.csv_files import write_csv
from laglab.export.tables import Tables, tables
from laglab.extras import BAGS, MATLAB, PARQUET, Need, require
from laglab.files import file_place, folder_place, whole_file, write_whole
from laglab.results.run import Run
from laglab.results.summary import SUMMARY_FILE

FormatName = Literal["csv", "parquet", "mat", "mcap", "ros2bag"]
BAG = "run.mcap"
METADATA = "metadata.yaml"


class Format(NamedTuple):
    """How a run is written in it."""

    ending: str
    """What is added to the name of the run's folder."""
    files: tuple[str, ...]
    """Those that it leaves in a folder; none: it is one file."""
    need: Need | None
    write: Callable[[Run, Path], None]


def export(run: Run, name: FormatName, out: str | Path | None = None, force: bool = False) -> Path:
    """Write the run to `out`, or here under the name of its folder; says where that is.

    What is there already is replaced only with `force`.

    Raises:
        MissingExtraError: what writes the format is not installed.
        PlaceError: it cannot go there, or there is no such format.
        NoRunError: the run's files are damaged.
        ResultsError: there is no room for it.
    """
    if name not in FORMATS:
        raise PlaceError(f"format: take one of {', '.join(FORMATS)}, not {name!r}")
    chosen = FORMATS[name]
    if chosen.need:
        require(chosen.need)
    place = _place(chosen, Path(out or _named(run) + chosen.ending), force)
    try:
        chosen.write(run, place)
    except BaseException:
        if chosen.files:
            with suppress(OSError):
                place.rmdir()  # nothing was written, if that can be
        raise
    return place


def _named(run: Run) -> str:
    return run.directory.resolve().name if run.directory else run.scenario.name


def _place(chosen: Format, place: Path, force: bool) -> Path:
    if chosen.files and (place / SUMMARY_FILE).exists():  # some of its files have the same names
        raise PlaceError(f"--out {place}: a run's results are there: take another folder")
    taken = [place / file for file in chosen.files] if chosen.files else [place]
    if not force and (there := [path for path in taken if path.is_file()]):
        raise PlaceError(f"{there[0]} is there already: say another --out, or --force")
    return folder_place("--out", place) if chosen.files else file_place("--out", place)


def _write_csv(run: Run, folder: Path) -> None:
    for table in tables(run):
        with whole_file(folder / f"{table.name}.csv") as file:
            write_csv(table, file)


def _write_parquet(run: Run, folder: Path) -> None:
    from laglab.export.parquet import write_parquet

    for table in tables(run):
        with whole_file(folder / f"{table.name}.parquet") as file:
            write_parquet(table, run, file)


def _write_mat(run: Run, path: Path) -> None:
    from laglab.export.mat import write_mat

    with whole_file(path) as file:
        write_mat(run, file)


def _write_mcap(run: Run, path: Path) -> None:
    from laglab.export.ros.mcap_file import write_mcap

    with whole_file(path) as file:
        write_mcap(run, file)


def _write_bag(run: Run, folder: Path) -> None:
    from laglab.export.ros.bag import metadata
    from laglab.export.ros.mcap_file import write_mcap

    with whole_file(folder / BAG) as file:
        written = write_mcap(run, file)
    write_whole(folder / METADATA, metadata(written, BAG))


FORMATS: dict[FormatName, Format] = {
    "csv": Format("-csv", tuple(f"{table}.csv" for table in Tables._fields), None, _write_csv),
    "parquet": Format(
        "-parquet", tuple(f"{table}.parquet" for table in Tables._fields), PARQUET, _write_parquet
    ),
    "mat": Format(".mat", (), MATLAB, _write_mat),
    "mcap": Format(".mcap", (), BAGS, _write_mcap),
    "ros2bag": Format("-ros2bag", (BAG, METADATA), BAGS, _write_bag),
}
