"""What was measured, as a table."""

import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from laglab.link.measured import Array, Flow, Measured, bursts
from laglab.tables import plain_table

SHARES = (0.5, 0.9, 0.99)
NONE = "-"


def table_of(measured: Measured, title: str = "") -> Table:
    """A column each way: frames, losses, order, and the delays' quantiles."""
    seconds = measured.interval * max(len(flow.delay) for _, flow in measured.flows)
    heading = title or f"A frame each way every {1e3 * measured.interval:g} ms, {seconds:.3g} s"
    table = plain_table("", title=heading)
    for direction, _ in measured.flows:
        table.add_column(f"{direction}s", justify="right")
    columns = [_column(flow) for _, flow in measured.flows]
    for name in columns[0]:
        table.add_row(Text(name), *(column[name] for column in columns))
    return table


def print_measured(measured: Measured, console: Console, title: str = "") -> None:
    """The table, and what is to be said of the figures."""
    console.print(table_of(measured, title))
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
