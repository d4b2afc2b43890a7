"""What was measured, as a table."""

from collections.abc import Sequence

import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from laglab.link.fitting import Fit, choices
from laglab.link.measured import Array, Flow, MeasuredLink, bursts
from laglab.tables import plain_table
from laglab_control import DelayMargin

SHARES = (0.5, 0.9, 0.99)
NONE = "-"
NOT_FITTED = ("frames", "size [byte]")


def table_of(measured: MeasuredLink) -> Table:
    """A column each way: frames, losses, order, and the delays' quantiles."""
    seconds = measured.interval * max(len(flow.delay) for _, flow in measured.flows)
    heading = f"A frame each way every {1e3 * measured.interval:g} ms, {seconds:.3g} s"
    table = plain_table("", title=heading)
    for direction, _ in measured.flows:
        table.add_column(f"{direction}s", justify="right")
    columns = [_column(flow) for _, flow in measured.flows]
    for name in columns[0]:
        table.add_row(Text(name), *(column[name] for column in columns))
    return table


def print_measured(measured: MeasuredLink, console: Console) -> None:
    """The table, and what is to be said of the figures."""
    console.print(table_of(measured))
    for note in measured.notes:
        console.print(note, highlight=False, markup=False)


def _column(flow: Flow) -> dict[str, str]:
    lost, came = flow.lost, flow.delivered
    runs = bursts(lost)
    column = {
        "frames": str(len(lost)),
        "size [byte]": str(flow.size) if len(lost) else NONE,
        "lost [%]": f"{100 * lost.mean():.3g}" if len(lost) else NONE,
        "lost in a row, mean": f"{np.mean(runs):.3g}" if runs else NONE,
        "lost in a row, most": str(max(runs)) if runs else NONE,
        "overtaken [%]": f"{100 * overtaken(flow):.3g}" if len(came) else NONE,
        "delay, least [ms]": _ms(came, 0.0),
    }
    column |= {f"delay, {100 * share:g} % [ms]": _ms(came, share) for share in SHARES}
    return column | {"delay, most [ms]": _ms(came, 1.0)}


def overtaken(flow: Flow) -> float:
    """The share of frames that came after one that was sent later."""
    came = ~flow.lost
    arrived = flow.sent[came] + flow.delay[came]
    if not len(arrived):
        return 0.0
    soonest_later = np.minimum.accumulate(arrived[::-1])[::-1]
    return float(np.mean(arrived[:-1] > soonest_later[1:])) if len(arrived) > 1 else 0.0


def _ms(delays: Array, share: float) -> str:
    return f"{1e3 * np.quantile(delays, share):.3g}" if len(delays) else NONE


def fit_table(fit: Fit) -> Table:
    """What was measured beside what the fit makes."""
    table = plain_table("", title="Measured, and what the fitted link does")
    for direction, _ in fit.measured.flows:
        table.add_column(f"{direction}s", justify="right")
        table.add_column("fitted", justify="right")
    pairs = zip(fit.measured.flows, fit.made.flows, strict=True)
    columns = [_column(flow) for pair in pairs for _, flow in pair]
    for name in columns[0]:
        if name not in NOT_FITTED:
            table.add_row(Text(name), *(column[name] for column in columns))
    distances = [cell for each in fit.distances for cell in ("", f"{each:.3g}")]
    table.add_row("distance of the delays (KS)", *distances)
    return table


def choices_table(fit: Fit, margin: DelayMargin | None) -> Table:
    """What each pair of bounds costs; `margin` is None for a law of which none is known."""
    table = plain_table(title="Play-out: later bounds, fewer frames late, longer delays")
    for heading in ("", "n", "m", "late [%]", "lost or late [%]", "n + m", "[ms]", "to the margin"):
        table.add_column(Text(heading), justify="right")
    for choice in choices(fit.measured):
        table.add_row(
            "*" if choice.bounds == fit.bounds.bounds else "",
            *map(str, choice.bounds),
            _percents(choice.late),
            _percents(choice.unused),
            str(choice.total),
            f"{1e3 * choice.total * fit.measured.interval:.0f}",
            " ".join(f"{each - choice.total:+d}" for each in margin or () if each is not None),
        )
    return table


def _percents(shares: Sequence[float]) -> str:
    return ", ".join(f"{100 * share:.2g}" for share in shares)
