"""An FMU of model exchange, integrated by FMPy's CVode: what co-simulation would do inside.

The order of the calls is that of FMPy's own `simulate_fmu`, a communication step at a time.
"""

from collections.abc import Callable
from ctypes import Array, c_double
from typing import Any

from laglab_fmu.errors import CallError
from laglab_fmu.foreign.file import FmuFile
from laglab_fmu.foreign.steps import SAME, tolerance

ASKS_TO_END = "it asks to end the simulation"


class _HeldInput:
    """What FMPy's solver asks for inputs: they do not change within a step."""

    def apply(self, _time: float) -> None:
        """Nothing to do."""


class Integrator:
    """Moves `fmu`, which is in event mode, in solver steps of at most `longest` [s]."""

    def __init__(self, fmu: Any, file: FmuFile, longest: float) -> None:
        self._fmu, description = fmu, file.description
        self._completes = bool(description.modelExchange.needsCompletedIntegratorStep)
        self._is_3 = description.fmiMajorVersion == 3
        self._problem: Exception | None = None
        self._next_event: float | None = None
        self._update(0.0)
        self._solver = self._make_solver(file, longest)

    def _make_solver(self, file: FmuFile, longest: float) -> Any:
        from fmpy.sundials import CVodeSolver  # loads the library

        fmu, description = self._fmu, file.description
        get_dx = fmu.getContinuousStateDerivatives if self._is_3 else fmu.getDerivatives
        return CVodeSolver(
            nx=description.numberOfContinuousStates,
            nz=description.numberOfEventIndicators,
            get_x=self._guarded(fmu.getContinuousStates),
            set_x=self._guarded(fmu.setContinuousStates),
            get_dx=self._guarded(get_dx),
            get_z=self._guarded(fmu.getEventIndicators),
            get_nominals=self._guarded(fmu.getNominalsOfContinuousStates),
            set_time=self._guarded(fmu.setTime),
            input=_HeldInput(),
            startTime=0.0,
            maxStep=longest,
            relativeTolerance=tolerance(file),
        )

    def _guarded(self, call: Callable[..., object]) -> Callable[..., object]:
        """The solver calls from C, through which no exception passes: the first one is kept."""

        def guarded(*arguments: "float | int | Array[c_double]") -> None:
            if self._problem is None:
                try:
                    call(*arguments)
                except Exception as error:
                    self._problem = error

        return guarded

    def step(self, time: float, end: float, write: Callable[[], None] | None) -> None:
        """Moves from `time` to `end` [s]; `write` sets the inputs, None when they are as before.

        Raises CallError, and FMICallException.
        """
        if write is not None:
            self._fmu.enterEventMode()
            write()
            self._update(time)
            self._solver.reset(time)
        enough = end - SAME * (end - time)
        while time < enough:
            event = self._next_event
            target = end if event is None or event > enough else max(event, time)
            found = self._advance(time, target)
            time = found[1]
            if found[0] or (event is not None and time >= event):
                self._fmu.enterEventMode()
                self._update(time)
                self._solver.reset(time)

    def _advance(self, time: float, target: float) -> tuple[bool, float]:
        """Moves on, to `target` at most: whether there is an event, and the time reached [s]."""
        if target <= time:
            return True, time
        try:
            state_event, _, time = self._solver.step(time, target)
        except RuntimeError as error:
            raise self._problem or CallError(str(error)) from error
        if self._problem is not None:
            raise self._problem
        self._fmu.setTime(time)
        if not self._completes:
            return bool(state_event), time
        step_event, ends = self._fmu.completedIntegratorStep()
        if ends:
            raise CallError(ASKS_TO_END)
        return bool(state_event or step_event), time

    def _update(self, time: float) -> None:
        """Updates the discrete states until they rest; then time is continuous again."""
        needed = True
        while needed:
            update = self._fmu.updateDiscreteStates if self._is_3 else self._fmu.newDiscreteStates
            needed, ends, _, _, is_defined, event = update()
            if ends:
                raise CallError(ASKS_TO_END)
            self._next_event = event if is_defined and event > time else None
        self._fmu.enterContinuousTimeMode()
