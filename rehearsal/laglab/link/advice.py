"""What to take from a fit, in sentences."""

from collections.abc import Iterator
from pathlib import Path

from laglab.link.fitting import Fit
from laglab.scenario import load

FAR = 0.1
"""The Kolmogorov-Smirnov distance beyond which a fit is a poor one."""


def suggestions(fit: Fit, link: Path, replay: str) -> Iterator[str]:
    """n and m without play-out, bounds with it, and how to rehearse on what was measured: fitted in
    the file `link`, and frame by frame by the command `replay`."""
    yield (
        "* suggested; to the margin: ticks left of the delay margins, on the way to the goal and "
        "at it, that the law has where the station does not predict."
    )
    n, m = fit.usual
    yield f"Without play-out: n = {n}, m = {m}, what half of the frames take at most."
    bounds, (late_n, late_m) = fit.bounds.bounds, fit.bounds.late
    playout = f"{{ command = {bounds.command}, measurement = {bounds.measurement} }}"
    yield (
        f"With play-out: link.playout = {playout}: {100 * late_n:.2g} % of the commands and "
        f"{100 * late_m:.2g} % of the measurements that come are then too late."
    )
    if max(fit.distances) > FAR:
        yield (
            f"The fit is a poor one: its delays are {max(fit.distances):.2g} from those measured, "
            "which come in an order that no such link has: rather replay them."
        )
    yield f"Rehearse on the fitted link: laglab run {link}; on the very frames: {replay}."


def replaying(scenario: str, frames: Path, fixed: tuple[int, int], interval: float) -> str:
    """The command that lets happen to the scenario's frames what did to those in the file, which
    came `interval` [s] apart; `fixed` (n, m) [ticks] is what the file leaves out."""
    n, m = fixed
    command = f"laglab run {scenario} -n {n} -m {m} --timeline {frames}"
    is_usual = interval == load(scenario).sample_time
    return command if is_usual else f"{command} --set sample_time={interval:g}"
