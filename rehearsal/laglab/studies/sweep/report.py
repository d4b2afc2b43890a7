"""What is said of a study at its end, and of a folder that has more than it."""

from collections.abc import Iterator

import pyarrow.compute as pc

from laglab.studies.sweep.folder import Folder
from laglab.studies.sweep.study import Study
from laglab.studies.sweep.work import Work
from laglab.tables import counted

MOST_NAMED = 3


def summary(study: Study, folder: Folder, work: Work) -> str:
    """How it went, in a few lines."""
    runs = converged = diverged = 0
    for table in folder.tables(study.cells(), ["converged", "diverged_tick"]):
        runs += table.num_rows
        converged += pc.sum(table["converged"]).as_py()
        diverged += table.num_rows - table["diverged_tick"].null_count
    share = f"{converged / runs:.1%}" if runs else "none"
    lines = [
        f"{study.name}: {counted(runs, 'run')}, {converged} converged ({share}), "
        f"{diverged} diverged"
    ]
    if kept := runs - work.runs:
        lines.append(f"{kept} of them had been made before")
    lines += [f"{count} made {way}" for way, count in work.ways.most_common()]
    return "\n".join([*lines, f"tables in {folder.cells}"])


def strangers_told(study: Study, folder: Folder) -> Iterator[str]:
    """A line, where there are cells that are no longer part of the study; they stay."""
    strangers = folder.strangers(study.cells())
    if not strangers:
        return
    named = [folder.place_of(path) for path in strangers[:MOST_NAMED]]
    more = ", ..." if len(strangers) > MOST_NAMED else ""
    count = "1 cell is" if len(strangers) == 1 else f"{len(strangers)} cells are"
    yield (
        f"laglab: {folder.path}: {count} no longer part of the study, which is another now, or the "
        f"code: they stay, and are left out: {'; '.join(named)}{more}"
    )
