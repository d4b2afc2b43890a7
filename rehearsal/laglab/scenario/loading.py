"""Scenarios from files: read, put together with what beats the file, and checked."""

from collections.abc import Callable, Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from laglab.errors import ScenarioError
from laglab.scenario import paths
from laglab.scenario.model import FILES, Scenario
from laglab.scenario.overrides import Overrides, put
from laglab.scenario.toml import parsed, read_by_name, shipped_in

SHIPPED = resources.files("laglab.scenario") / "shipped"
SAYS_NOTHING = {"name", "description"}
"""A file that has no other keys does not say what is run."""


def load(
    reference: str, overrides: Overrides | None = None, tell: Callable[[str], None] | None = None
) -> Scenario:
    """A scenario by its shipped name or by a path to a TOML file; `overrides` beat the file.

    `tell` is told, in a line, what is run when the file says nothing of it. Raises ScenarioError:
    no such scenario, not TOML, or a key that cannot be.
    """
    fields, path = _read(reference)
    says_nothing = fields.keys() <= SAYS_NOTHING
    scenario = _made({"name": path.stem} | fields, overrides or {}, reference)
    if tell and says_nothing:
        tell(f"{reference} sets nothing, so it runs by default: {scenario.gist}")
    return scenario


def changed(scenario: Scenario, overrides: Overrides) -> Scenario:
    """The same with other values. Raises: ScenarioError, when one cannot be."""
    return _made(scenario.fields(), overrides, scenario.name)


def made_of(fields: dict[str, Any], folder: Path) -> Scenario:
    """From a table in somebody else's file, in `folder`. Raises: ScenarioError."""
    return _made(_anchored(fields, folder), {}, str(fields.get("name", "")))


def _made(fields: dict[str, Any], overrides: Overrides, called: str) -> Scenario:
    if not isinstance(overrides, Mapping):
        raise ScenarioError(f"overrides: must be keys with their values, not {overrides!r}")
    try:
        for key, value in overrides.items():
            put(fields, key, value)
        return Scenario.model_validate(fields)
    except ScenarioError as error:
        raise ScenarioError(f"{called}: {error}") from None
    except ValidationError as error:
        from laglab.scenario.problems import first_problem  # whoever is right does without

        raise ScenarioError(f"{called}: {first_problem(error)}") from None


def shipped() -> dict[str, Scenario]:
    """The scenarios that come with the package, by name."""
    return {name: load(name) for name in shipped_names()}


def shipped_names() -> list[str]:
    """The names of the scenarios that come with the package."""
    return shipped_in(SHIPPED)


def _read(reference: str) -> tuple[dict[str, Any], Path]:
    text, path = read_by_name(reference, SHIPPED, "scenario", ScenarioError)
    try:
        return _anchored(parsed(text), path.parent), path
    except ValueError as error:
        raise ScenarioError(f"{reference}: not a readable TOML file: {error}") from None


def _anchored(fields: dict[str, Any], folder: Path) -> dict[str, Any]:
    """The files that it names, relative to its folder, as ones that can be opened from here."""
    for table, key in FILES:
        match fields.get(table):
            case dict(keys) if isinstance(keys.get(key), str):
                keys[key] = str(folder / keys[key])
    match fields:
        case {"law": {"path": str(path)}}:
            fields["law"]["path"] = paths.anchored(path, folder)
    return fields
