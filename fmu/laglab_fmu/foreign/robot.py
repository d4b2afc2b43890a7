"""Somebody's robot, stepped a sample at a time."""

import math
from collections.abc import Sequence
from contextlib import ExitStack, suppress
from functools import partial
from typing import Any, Self

from fmpy.fmi1 import FMICallException

from laglab_fmu.errors import CallError
from laglab_fmu.foreign.exchange import ASKS_TO_END, Integrator
from laglab_fmu.foreign.file import FmuFile
from laglab_fmu.foreign.instance import LastLines, initialize, instance
from laglab_fmu.foreign.start_values import check, parameter_values, start_values
from laglab_fmu.foreign.steps import substeps
from laglab_fmu.foreign.values import Reader, Writer
from laglab_fmu.foreign.wiring import Wiring, input_elements, output_elements

FATAL = 4
STATUS = ("ok", "warning", "discard", "error", "fatal", "pending")
SAID = 3
"""So many of the log's last lines are told when a call fails."""


class ForeignRobot:
    """An FMU, its inputs held from sample to sample: `with ForeignRobot(...) as robot:`."""

    def __init__(
        self, file: FmuFile, wiring: Wiring, sample_time: float, start: Sequence[float] = ()
    ) -> None:
        """Puts the robot at its start.

        Args:
            sample_time: [s].
            start: the values of what the wiring's `start` names, in that order.

        Raises:
            FmuFileError: it cannot be used so, or does not start.
            CallError: it refuses a value.
        """
        check(file, wiring, sample_time)
        self._file, self._wiring, self._sample_time = file, wiring, sample_time
        self._substeps = substeps(file, sample_time)
        self.log = LastLines()
        self._runs = False
        with ExitStack() as stack:
            self._fmu: Any = stack.enter_context(instance(file, self.log))
            elements = output_elements(file, wiring.outputs)
            self._names = [element.name for element in elements]
            self._reader = Reader(self._fmu, file.version, elements)
            inputs, told = input_elements(file, wiring.inputs), parameter_values(file, wiring)
            self._writer = Writer(self._fmu, file.version, inputs, told)
            self._begin(start)
            self._stack = stack.pop_all()

    def _begin(self, start: Sequence[float]) -> None:
        values = start_values(self._file, self._wiring, start)
        self._tick = 0
        self._told: Sequence[float] = ()
        try:
            initialize(self._file, self._fmu, values)
            self._integrator = None
            if self._file.interface() == "model exchange":
                self._integrator = Integrator(self._fmu, self._file, self._sample_time)
            self._runs = True
            self.outputs = self._read()
        except (FMICallException, CallError) as error:
            raise self._failed(error) from error

    def step(self, inputs: Sequence[float]) -> tuple[float, ...]:
        """Moves for one sample time with these inputs, and reads the outputs.

        Raises:
            CallError: the FMU failed; names the call and the variables.
        """
        time = self._tick * self._sample_time
        before, self._told = self._told, inputs
        try:
            if self._integrator is None:
                self._writer.write(inputs)
                self._step(time)
            else:
                new = None if inputs == before else partial(self._writer.write, inputs)
                self._integrator.step(time, (self._tick + 1) * self._sample_time, new)
            self._tick += 1
            self.outputs = self._read()
        except (FMICallException, CallError) as error:
            raise self._failed(error) from error
        return self.outputs

    def _step(self, time: float) -> None:
        part = self._sample_time / self._substeps
        for i in range(self._substeps):
            ends = self._fmu.doStep(time + i * part, part)
            if ends and ends[1]:
                raise CallError(ASKS_TO_END)
            if ends and ends[2]:
                raise CallError(f"fmi3DoStep returned early, at {ends[3]:g} s")

    def _read(self) -> tuple[float, ...]:
        numbers = self._reader.read()
        for name, number in zip(self._names, numbers, strict=True):
            if not math.isfinite(number):
                raise CallError(f"{name} is {number}")
        return numbers

    def restart(self, start: Sequence[float]) -> None:
        """Begins again, from another start.

        Raises:
            CallError: the FMU cannot, or refuses a value.
        """
        try:
            self._fmu.reset()
        except FMICallException as error:
            raise self._failed(error) from error
        self._begin(start)

    def _failed(self, error: Exception) -> CallError:
        self._runs = False
        if isinstance(error, FMICallException):
            if error.status == FATAL:  # no other call is allowed any more
                self._fmu.freeInstance = self._fmu.freeLibrary
            which = {**self._reader.variables, **self._writer.variables}.get(error.function)
            of = f" of {which}" if which else ""
            status = STATUS[error.status] if error.status < len(STATUS) else error.status
            said = f"{error.function}{of} failed ({status})"
        else:
            said = str(error)
        logged = list(self.log.lines)[-SAID:] or ["it logged nothing"]
        said = "; ".join((said + self._inputs(), *filter(None, logged)))
        return CallError(f"{self._file.path.name}: tick {self._tick}: {said}")

    def _inputs(self) -> str:
        """What it was told last, by its own names."""
        pairs = zip(self._wiring.inputs.values(), self._told, strict=False)
        told = ", ".join(f"{name}={number:g}" for name, number in pairs)
        return f", inputs {told}" if told else ""

    def close(self) -> None:
        """Ends and frees the instance, removes the extracted files. Twice does no harm."""
        if self._runs:
            self._runs = False
            with suppress(FMICallException):
                self._fmu.terminate()
        self._stack.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
