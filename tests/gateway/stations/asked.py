"""What a rover was asked by somebody's program, beside the table of what may be asked."""

import json
from pathlib import Path
from typing import Any, NamedTuple

from .table import Row, table

UNADDRESSED = {"HEARTBEAT", "SYSTEM_TIME"}
"""What stations say to nobody in particular, and nobody answers."""


class Request(NamedTuple):
    """One message to the rover, and the names of the answers."""

    name: str
    fields: dict[str, Any]
    answers: list[str]

    def is_of(self, row: Row) -> bool:
        """Whether it is the request of this row."""
        return row.request.is_like(self.name, self.fields)


class Asked:
    """The record that `rover.py` keeps."""

    def __init__(self, log: Path) -> None:
        self._log = log

    @property
    def requests(self) -> list[Request]:
        """So far, in order."""
        lines = self._log.read_text(encoding="utf-8").splitlines()
        requests = [Request(**json.loads(line)) for line in lines]
        return [each for each in requests if each.name not in UNADDRESSED]

    def check_against_table(self, client: str) -> None:
        """All that `client` asked stands there as seen with it, and was answered as there; all that
        stands there as seen with it, and not only at times, was asked."""
        always = [row for row in table() if client in row.clients]
        rows = always + [row for row in table() if f"{client} at times" in row.clients]
        requests = self.requests
        for request in requests:
            row = next((row for row in rows if request.is_of(row)), None)
            assert row is not None, f"{client} asked {request}"
            kinds = list(dict.fromkeys(request.answers)) if row.many else request.answers
            assert kinds == [answer.name for answer in row.answers], (client, request)
        for row in always:
            assert any(request.is_of(row) for request in requests), f"{client} did not ask {row}"
