"""Timelines: what the link does when, told by hand (TOML) or recorded by a run (`link.csv`)."""

from pathlib import Path

from laglab.errors import ScenarioError
from laglab.scenario.overrides import Overrides
from laglab.scenario.toml import parsed


def read_timeline(reference: str) -> Overrides:
    """The overrides that the file stands for; checked with the scenario.

    Raises:
        ScenarioError: the file cannot be read, or holds anything but `[[event]]` tables.
    """
    path = Path(reference)
    if path.suffix == ".csv":
        return {"link.replay": reference}
    try:
        fields = parsed(path.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise ScenarioError(f"--timeline {reference}: {error.strerror}") from None
    except ValueError as error:
        raise ScenarioError(
            f"--timeline {reference}: neither TOML ({error}) nor the link.csv of a run"
        ) from None
    if set(fields) != {"event"}:
        raise ScenarioError(
            f"--timeline {reference}: a timeline is a list of [[event]] tables, and nothing else"
        )
    return {"link.event": fields["event"], "link.replay": None}
