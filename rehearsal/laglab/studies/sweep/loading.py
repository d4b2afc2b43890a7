"""Studies from TOML: shipped ones, a user's, and what a folder of results says of its own."""

from collections.abc import Iterator, Sequence
from importlib import resources
from pathlib import Path
from typing import Annotated, Any

import tomlkit
from pydantic import Field, ValidationError, model_validator

from laglab.errors import StudyError
from laglab.scenario import Overrides, Scenario, changed, load, shipped_names
from laglab.scenario.loading import made_of
from laglab.scenario.model import FILES, plain
from laglab.scenario.paths import anchored
from laglab.scenario.tables.table import Table
from laglab.scenario.toml import parsed, read_by_name, shipped_in
from laglab.studies.sweep.study import MOST_SEED, Study
from laglab_control import FAR
from laglab_gateway.values import Positive, Whole, saying, wording

SHIPPED = resources.files("laglab.studies.sweep") / "shipped"
Seed = Annotated[Whole, Field(ge=0, lt=MOST_SEED)]
Seeds = Annotated[
    Annotated[Whole, Field(ge=1, lt=2**31)] | Annotated[list[Seed], Field(min_length=1)],
    saying(
        "a number of seeds, 1 or more, or a list of seeds, each whole, 0 or more and below 2^31"
    ),
]


class _Start(Table):
    radius: Annotated[Positive, Field(le=FAR)]


class _File(Table):
    """What may stand in a study's file."""

    scenario: Annotated[str | dict[str, object], saying("a name, a file or a table")]
    description: str = ""
    seeds: Seeds = 1
    grid: dict[str, object] = Field(default_factory=dict)
    start: _Start | None = None
    also: list[str] = Field(default_factory=list)
    origin: str = ""

    @model_validator(mode="before")
    @classmethod
    def _has_a_scenario(cls, fields: Any) -> Any:
        if isinstance(fields, dict) and "scenario" not in fields:
            raise ValueError(
                "scenario: must be there: a shipped scenario's name, a file or a table"
            )
        return fields


def load_study(
    reference: str, overrides: Overrides | None = None, seeds: int | None = None
) -> Study:
    """By its shipped name, or by a path to a TOML file; `overrides` beat the scenario, `seeds` the
    study's own. Raises: StudyError, ScenarioError.
    """
    text, path = read_by_name(reference, SHIPPED, "study", StudyError)
    study, _ = study_of(text, reference, path, overrides or {}, seeds)
    return study


def study_of(
    text: str,
    called: str,
    path: Path,
    overrides: Overrides | None = None,
    seeds: int | None = None,
) -> tuple[Study, str]:
    """What TOML says, and the origin of the cells if it names one. Raises as `load_study`."""
    try:
        file = _File.model_validate(parsed(text))
        return _made(file, path, overrides or {}, seeds), file.origin
    except ValidationError as error:
        problem = error.errors()[0]
        place = ".".join(str(part) for part in problem["loc"] if isinstance(part, str))
        unknown = problem["type"] == "extra_forbidden"
        of = _Start if "start" in problem["loc"] else _File
        known = ", ".join(name for name in of.model_fields if name != "origin")
        said = f"unknown key; known here: {known}" if unknown else wording(problem)
        raise StudyError(f"{called}: {place}: {said}" if place else f"{called}: {said}") from None
    except StudyError as error:
        raise StudyError(f"{called}: {error}") from None
    except ValueError as error:
        raise StudyError(f"{called}: not a readable TOML file: {error}") from None


def _made(file: _File, path: Path, overrides: Overrides, seeds: int | None) -> Study:
    grid = {key: _anchored(key, values, path.parent) for key, values in _axes(file.grid)}
    chosen = file.seeds if seeds is None else seeds
    _refuse_what_varies([*grid, "seed", *(["start"] if file.start else [])], overrides)
    return Study(
        scenario=changed(_base(file, path), overrides),
        seeds=range(1, chosen + 1) if isinstance(chosen, int) else tuple(chosen),
        grid=grid,
        radius=file.start.radius if file.start else None,
        name=path.stem,
        description=file.description,
        also=tuple(file.also),
    )


def _refuse_what_varies(varied: Sequence[str], overrides: Overrides) -> None:
    """What every run of a study has of its own would beat it, unheard."""
    for key in overrides:
        if any(key == own or key.startswith(f"{own}.") for own in varied):
            raise StudyError(f"{key}: the study gives its runs their own: change it there")


def _base(file: _File, path: Path) -> Scenario:
    """A file is looked for beside the study's."""
    if not isinstance(file.scenario, str):
        return made_of({"name": path.stem} | file.scenario, path.parent)
    beside = path.parent / file.scenario
    shipped = file.scenario in shipped_names()
    return load(str(beside) if not shipped and beside.is_file() else file.scenario)


def _axes(table: dict[str, Any], above: str = "") -> Iterator[tuple[str, list[object]]]:
    """Dotted keys may be written as such, in quotation marks, or as tables."""
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _axes(value, f"{above}{key}.")
        elif isinstance(value, list):
            yield above + key, value
        else:
            raise StudyError(f"grid: {above}{key}: must be a list of values, not {value!r}")


def _anchored(key: str, values: list[object], folder: Path) -> list[object]:
    """Paths are relative to the study's file."""
    if key == "law.path":
        return [anchored(str(value), folder.resolve()) for value in values]
    if tuple(key.split(".")) in FILES:
        return [str((folder / str(value)).resolve()) for value in values]
    return values


def to_toml(study: Study, origin: str) -> str:
    """What `study_of` reads back to one with the same cells."""
    return tomlkit.dumps(plain({"origin": origin, **study.as_table()}))


def shipped_studies() -> dict[str, Study]:
    """The studies that come with the package, by name."""
    return {name: load_study(name) for name in shipped_study_names()}


def shipped_study_names() -> list[str]:
    """Of those that come with the package."""
    return shipped_in(SHIPPED)
