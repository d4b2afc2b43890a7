"""What several commands take: with one name and one help text."""

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from laglab.errors import ScenarioError
from laglab.results.figures import Width

RunArgument = Annotated[Path, typer.Argument(metavar="DIR", help="What a run left.")]
RunsArgument = Annotated[list[Path], typer.Argument(metavar="DIR...", help="What runs left.")]
PictureOption = Annotated[
    Path, typer.Option("--out", metavar="FILE", help="The picture: PNG, PDF, SVG and others.")
]
WidthOption = Annotated[
    Width,
    typer.Option(help="As wide as one column of a journal's page (3.3 in) or as two (7 in)."),
]
SeedsOption = Annotated[int, typer.Option(min=1, max=10_000, help="Runs of each.")]
WorkersOption = Annotated[int, typer.Option(min=0, max=1024, help="Processes; 0: one a core.")]

KeyOption = Annotated[
    Path | None,
    typer.Option("--key", metavar="FILE", help="Sign every frame; `laglab protocol keygen`."),
]
PlantOption = Annotated[
    str | None,
    typer.Option(
        metavar="URL",
        help="The real robot's link, such as serial:///dev/ttyX:BAUD: its clock sets the pace.",
    ),
]
PlantKeyOption = Annotated[
    Path | None,
    typer.Option(
        "--plant-key", metavar="FILE", help="Sign every frame on the real robot's link, too."
    ),
]


def _folder(told: str) -> Path:
    """An empty name would be the current directory: a variable that is not set, most likely."""
    if not told:
        raise typer.BadParameter("an empty name; the current directory is called .")
    return Path(told)


OutOption = Annotated[
    Path | None,
    typer.Option(
        "--out",
        metavar="DIR",
        parser=_folder,
        help="Where the results go; runs/SCENARIO otherwise.",
    ),
]
ForceOption = Annotated[
    bool, typer.Option("--force", help="Take the place of another run's results in --out.")
]
ReportOption = Annotated[
    bool, typer.Option("--report", help="Leave report.html, too; `laglab report` says what it is.")
]


def some_of(option: str, metavar: str, meant: str, names: Sequence[str]) -> Any:
    """An option that names some of them."""
    return typer.Option(
        option,
        metavar=metavar,
        help=f"{meant}; may be repeated: {', '.join(names)}.",
        autocompletion=lambda: list(names),
    )


def chosen(option: str, named: Sequence[str] | None, known: Iterable[str]) -> list[str]:
    """Those named, each once; all that are known where none is. Raises ScenarioError."""
    names = list(known)
    for name in named or ():
        if name not in names:
            raise ScenarioError(f"{option}: {name!r} is not one of {', '.join(names)}")
    return list(dict.fromkeys(named)) if named else names


def checked(option: str, check: Callable[[str], str], name: str) -> str:
    """The name as `check` gives it. Raises ScenarioError where `check` raises ValueError."""
    try:
        return check(name)
    except ValueError as error:
        raise ScenarioError(f"{option}: {error}") from None
