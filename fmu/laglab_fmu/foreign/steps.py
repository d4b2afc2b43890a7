"""How an FMU steps: by any step, or by one of its own."""

from laglab_fmu.errors import FmuFileError
from laglab_fmu.foreign.file import FmuFile

SAME = 1e-9
"""Times and steps that differ by less than this part of a step are the same."""


def substeps(file: FmuFile, sample_time: float) -> int:
    """Into how many of its own steps an FMU cuts a sample [s]; 1 where it can do any step.

    Raises FmuFileError: a sample is no whole number of them.
    """
    own = own_step(file)
    if own is None:
        return 1
    parts = round(sample_time / own)
    if parts < 1 or abs(parts * own - sample_time) > SAME * sample_time:
        raise FmuFileError(
            f"{file.path}: it steps by {own:g} s and no other: sample_time must be a multiple of "
            f"that, not {sample_time:g}"
        )
    return parts


def own_step(file: FmuFile) -> float | None:
    """[s] The only step that an FMU can do; None: any."""
    offered = file.description.coSimulation
    if offered is None:
        return None
    if offered.fixedInternalStepSize is not None:
        return float(offered.fixedInternalStepSize)
    experiment = file.description.defaultExperiment
    if offered.canHandleVariableCommunicationStepSize or file.version == 3 or experiment is None:
        return None
    return float(experiment.stepSize) if experiment.stepSize else None
