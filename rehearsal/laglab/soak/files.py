"""The files that a side leaves: whole, readable, and no others."""

from collections.abc import Iterator
from pathlib import Path

from laglab.errors import LaglabError
from laglab.results.place import OURS
from laglab.results.run import open_run
from laglab.results.shadows import shadow_file
from laglab_control import ESTIMATORS
from laglab_gateway import ROWS, TLOG_FILE, TRACE_FILE, GatewayError
from laglab_protocol import TlogError, read_tlog

PAGE = 4096
"""[bytes] Where the system leaves off the write of a process that is killed meanwhile: who reads
such a file leaves the part out."""
TLOG_STAMP = 8
"""[bytes] Before each frame of a telemetry log."""


def faults_of(folder: Path, killed: bool) -> Iterator[str]:
    """What is not as it should be. Who was killed may have no results, but no torn files."""
    for name, fault in _torn(folder):
        if not (killed and _ends_with_a_page(folder / name)):
            yield fault
    if not killed:
        yield from _unreadable(folder)


def _ends_with_a_page(path: Path) -> bool:
    size = path.stat().st_size if path.exists() else 0
    return size > 0 and size % PAGE == 0


def _torn(folder: Path) -> Iterator[tuple[str, str]]:
    """Name and fault of each file that does not end where it should."""
    for name in (TRACE_FILE, *ROWS):
        path = folder / name
        if path.exists() and (fault := _torn_table(path)):
            yield name, f"{name}: {fault}"
    log = folder / TLOG_FILE
    try:
        told = sum(TLOG_STAMP + len(frame.raw) for _, frame in read_tlog(log))
        if told != log.stat().st_size:
            yield TLOG_FILE, f"{TLOG_FILE}: {log.stat().st_size - told} bytes are no record"
    except (TlogError, OSError) as error:
        yield TLOG_FILE, f"{TLOG_FILE}: {error}"


def _torn_table(path: Path) -> str:
    """What is torn; empty when every line is whole, and there is at least the head."""
    commas = set()
    line = b""
    with path.open("rb") as lines:
        for line in lines:
            commas.add(line.count(b","))
    if not line.endswith(b"\n"):
        return "its last line is torn"
    return "" if len(commas) == 1 else "its lines have different numbers of cells"


def _unreadable(folder: Path) -> Iterator[str]:
    try:
        run = open_run(folder)
        times, *_ = run.trace["time"], run.link, run.arrivals, run.claims, run.timing
        if (times[1:] <= times[:-1]).any():  # a robot that begins again counts its ticks anew
            yield "the times of its trace are not in order"
    except (LaglabError, GatewayError) as error:
        yield f"cannot be read: {error}"


def told_of(folder: Path) -> tuple[str, int]:
    """The verdict and the ticks of its summary; nothing when there is none."""
    try:
        summary = open_run(folder).summary
    except LaglabError:
        return "", 0
    return summary.verdict, summary.ticks


def left_in(folder: Path, temporary: Path) -> Iterator[str]:
    """What has no business to be there any more."""
    yield from (f"{temporary.name}/{path.name}" for path in temporary.iterdir())
    if folder.exists():
        ours = {*OURS, *(shadow_file(folder, name).name for name in ESTIMATORS)}
        others = [each.name for each in folder.iterdir() if each.name not in ours]
        yield from (f"{folder.name}/{name}" for name in others)
