"""Every request of the table in docs/ground-stations.md gets the answer that stands there.

pymavlink encodes the requests and reads the answers, in ardupilotmega, the dialect of most ground
stations. So those that no registry has (QGroundControl, Mission Planner) are replayed.
"""

from collections import Counter
from itertools import groupby
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega

from laglab_gateway import Safety, Services, standard_parameters
from laglab_gateway.services import Asker, Pace, RobotState
from laglab_protocol import Sender, frames_in

from .table import Row, Said, table

TABLE = table()
STATE = RobotState(1_500_000, 3.0, 4.0, 0.0, 2.0, 0.5)
GCS = (255, 190)
BY_NAME = {each.msgname: each for each in ardupilotmega.mavlink_map.values()}


def encoded(request: Said) -> bytes:
    """To system and component 1; what is not said is 0."""
    made = BY_NAME[request.name]
    fields: dict[str, Any] = {}
    for name, kind, length in zip(made.fieldnames, made.fieldtypes, _lengths(made), strict=True):
        nothing = 1 if name.startswith("target_") and name != "target_network" else 0
        fields[name] = b"" if kind == "char" else [0] * length if length else nothing
    for field, value in request.fields.items():
        name, _, index = field.partition("[")
        if index:
            fields[name][int(index[:-1])] = int(value)
        elif isinstance(value, str):
            fields[name] = value.encode()
        else:
            fields[name] = value if isinstance(fields[name], float) else _whole(value)
    packed: bytes = made(**fields).pack(ardupilotmega.MAVLink(None, *GCS))
    return packed


def _lengths(made: Any) -> list[int]:
    """Of arrays, in the order of the names; 0 for a scalar or a text."""
    lengths = dict(zip(made.ordered_fieldnames, made.array_lengths, strict=True))
    return [lengths[name] for name in made.fieldnames]


def _whole(value: float | str) -> float | str:
    return int(value) if isinstance(value, float) and value.is_integer() else value


def answered(request: Said) -> list[tuple[str, dict[str, Any]]]:
    services = Services(standard_parameters(10, 20, Safety()), armed=False)
    reader = ardupilotmega.MAVLink(None)
    told = []
    for frame in frames_in(encoded(request)):
        for answer in services.answer(frame, STATE, Asker(pace=Pace())):
            (read,) = reader.parse_buffer(Sender(1, 1).frame(answer))
            fields = read.to_dict()
            told.append((fields.pop("mavpackettype"), fields))
    return told


@pytest.mark.parametrize("row", TABLE, ids=str)
def test_the_request_gets_the_answer_of_the_table(row: Row) -> None:
    told = answered(row.request)
    if row.many:
        told = [next(group) for _, group in groupby(told, key=lambda each: each[0])]
    assert [name for name, _ in told] == [answer.name for answer in row.answers]
    for answer, (name, fields) in zip(row.answers, told, strict=True):
        assert answer.is_like(name, fields), fields


def test_no_request_stands_there_twice() -> None:
    assert max(Counter(map(str, TABLE)).values()) == 1
