"""Timelines: what the link does when, told by hand (TOML) or recorded by a run (`link.csv`)."""

import tomllib
from pathlib import Path
from typing import Any

from laglab.errors import ScenarioError


def read_timeline(reference: str) -> dict[str, Any]:
    """The fields of a scenario's `link` that the file stands for; checked with the scenario.

    Raises:
        ScenarioError: the file cannot be read, or holds anything but `[[event]]` tables.
    """
    path = Path(reference)
    if path.suffix == ".csv":
        return {"replay": str(path.resolve())}
    try:
        fields = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ScenarioError(f"--timeline {reference}: not a readable TOML file: {error}") from None
    if set(fields) != {"event"}:
        raise ScenarioError(
            f"--timeline {reference}: a timeline is a list of [[event]] tables, and nothing else"
        )
    return fields
