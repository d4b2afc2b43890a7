"""How an FMU steps: by any step, or by one of its own."""

import math

from laglab_fmu.errors import FmuFileError
from laglab_fmu.foreign.file import FmuFile

SAME = 1e-9
"""Times and steps that differ by less than this part of a step are the same."""
MOST_STEPS = 1_000_000
"""In a sample: more would take for ever."""
TOLERANCE = 1e-6
"""Relative, where an FMU of model exchange asks for none."""


def substeps(file: FmuFile, sample_time: float) -> int:
    """Into how many of its own steps an FMU cuts a sample [s]; 1 where it can do any step.

    Raises FmuFileError: a sample is no whole number of them, or one of too many.
    """
    own = own_step(file)
    if own is None:
        return 1
    if sample_time / MOST_STEPS > own:
        raise FmuFileError(
            f"{file.path}: it steps by {own:g} s and no other: of such steps a sample_time of "
            f"{sample_time:g} would have more than {MOST_STEPS}"
        )
    parts = round(sample_time / own)
    if parts < 1 or abs(parts * own - sample_time) > SAME * sample_time:
        raise FmuFileError(
            f"{file.path}: it steps by {own:g} s and no other: sample_time must be a multiple of "
            f"that, not {sample_time:g}"
        )
    return parts


def own_step(file: FmuFile) -> float | None:
    """[s] The only step that an FMU can do; None: any. Raises FmuFileError: it is none."""
    offered = file.description.coSimulation
    if offered is None:
        return None
    if offered.fixedInternalStepSize is not None:
        return _above_0(file, "fixedInternalStepSize", offered.fixedInternalStepSize)
    experiment = file.description.defaultExperiment
    if offered.canHandleVariableCommunicationStepSize or file.version == 3 or experiment is None:
        return None
    return _above_0(file, "stepSize", experiment.stepSize) if experiment.stepSize else None


def tolerance(file: FmuFile) -> float:
    """Relative, of whoever integrates the FMU. Raises FmuFileError: what it asks for is none."""
    experiment = file.description.defaultExperiment
    told = experiment.tolerance if experiment is not None else None
    return _above_0(file, "tolerance", told) if told else TOLERANCE


def _above_0(file: FmuFile, name: str, told: str | float) -> float:
    """What its description says there. Raises FmuFileError."""
    try:
        number = float(told)
    except ValueError:
        number = math.nan
    if not 0 < number < math.inf:
        raise FmuFileError(
            f"{file.path}: its modelDescription.xml: {name} must be a number above 0, not {told}"
        )
    return number
