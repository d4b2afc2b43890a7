"""The parameters of the robot's side, and MAVLink's protocol to read and set them.

All travel as MAV_PARAM_TYPE_REAL32: of the integer types, clients disagree on the bytes.
"""

import math
import struct
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import lru_cache

from laglab_gateway.drive import Safety
from laglab_protocol import (
    Frame,
    Message,
    ParamError,
    ParamRequestList,
    ParamRequestRead,
    ParamSet,
    ParamValue,
)
from laglab_protocol.dialect.generated import laglab as mavlink

NAME_SIZE = 16
NOT_PERMITTED: int = mavlink.MAV_PARAM_ERROR_PERMISSION_DENIED
BY_NAME = -1
"""The index in a request that names its parameter."""


@dataclass(frozen=True)
class Parameter:
    """One number. Settable ones stay within their limits."""

    name: str
    value: float
    settable: bool = False
    minimum: float = -math.inf
    maximum: float = math.inf

    def refuses(self, value: float) -> int | None:
        """Why `value` may not be set, as a MAV_PARAM_ERROR; None when it may."""
        if not self.settable:
            return int(mavlink.MAV_PARAM_ERROR_READ_ONLY)
        fits = math.isfinite(value) and self.minimum <= value <= self.maximum
        if not fits:
            return int(mavlink.MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE)
        return None


class ParameterTable:
    """The table, in a fixed order: `parameters["V_MAX"]` is the value now."""

    def __init__(self, parameters: Iterable[Parameter]) -> None:
        self._table = {parameter.name: parameter for parameter in parameters}
        assert all(len(name) <= NAME_SIZE for name in self._table)

    def __getitem__(self, name: str) -> float:
        return self._table[name].value

    def answer(self, frame: Frame, trusted: bool = True) -> list[Message]:
        """What to say to a request; nothing to anything else. Only the `trusted` may set."""
        match frame.message:
            case ParamRequestList():
                return [self._value(name) for name in self._table]
            case ParamRequestRead(index, _, _, name):
                return self._read(frame, index, name)
            case ParamSet(value, _, _, name):
                return self._set(frame, name, value, trusted)
        return []

    def _find(self, index: int, name: bytes) -> str | None:
        names = list(self._table)
        if index == BY_NAME:
            text = name.split(b"\0")[0].decode("ascii", errors="replace")
            return text if text in self._table else None
        return names[index] if 0 <= index < len(names) else None

    def _read(self, frame: Frame, index: int, name: bytes) -> list[Message]:
        found = self._find(index, name)
        if found is None:
            return [_error(frame, index, name, mavlink.MAV_PARAM_ERROR_DOES_NOT_EXIST)]
        return [self._value(found)]

    def _set(self, frame: Frame, name: bytes, value: float, trusted: bool) -> list[Message]:
        """Answered with the value that holds now, so that a refusal shows in old clients too."""
        found = self._find(BY_NAME, name)
        if found is None:
            return [_error(frame, BY_NAME, name, mavlink.MAV_PARAM_ERROR_DOES_NOT_EXIST)]
        refused = self._table[found].refuses(value) if trusted else NOT_PERMITTED
        if refused is not None:
            return [_error(frame, BY_NAME, name, refused), self._value(found)]
        self._table[found] = replace(self._table[found], value=value)
        return [self._value(found)]

    def _value(self, name: str) -> ParamValue:
        return ParamValue(
            param_value=_to_float32(self._table[name].value),
            param_count=len(self._table),
            param_index=list(self._table).index(name),
            param_id=name.encode("ascii"),
            param_type=mavlink.MAV_PARAM_TYPE_REAL32,
        )


def standard_parameters(
    command_delay: int,
    measurement_delay: int,
    safety: Safety,
    others: Iterable[Parameter] = (),
) -> ParameterTable:
    """What every gateway has: delays [ticks], limits [m/s, rad/s] (0: none), link timeout [s]."""
    v_limit, omega_limit = safety.v_limit or 0.0, safety.omega_limit or 0.0
    return ParameterTable(
        [
            Parameter("DELAY_N", command_delay),
            Parameter("DELAY_M", measurement_delay),
            Parameter("V_MAX", v_limit, settable=True, minimum=0.0, maximum=100.0),
            Parameter("OMEGA_MAX", omega_limit, settable=True, minimum=0.0, maximum=100.0),
            Parameter("LINK_TIMEOUT", safety.link_timeout, True, minimum=0.05, maximum=60.0),
            *others,
        ]
    )


def safety_now(parameters: ParameterTable, ramp: float) -> Safety:
    """The limits and times as they are set now; the ramp [s] is no parameter."""
    v_limit, omega_limit = parameters["V_MAX"], parameters["OMEGA_MAX"]
    return _safety(v_limit or None, omega_limit or None, parameters["LINK_TIMEOUT"], ramp)


@lru_cache
def _safety(
    v_limit: float | None, omega_limit: float | None, timeout: float, ramp: float
) -> Safety:
    """Checked once, then kept: asked for at every tick, it changes when a parameter is set."""
    return Safety(v_limit, omega_limit, timeout, ramp)


def _to_float32(value: float) -> float:
    """The nearest number that travels in four bytes; what is too large travels as infinity."""
    try:
        nearest: float = struct.unpack("<f", struct.pack("<f", value))[0]
    except OverflowError:
        return math.copysign(math.inf, value)
    return nearest


def _error(frame: Frame, index: int, name: bytes, error: int) -> ParamError:
    return ParamError(index, frame.system, frame.component, name, error)
