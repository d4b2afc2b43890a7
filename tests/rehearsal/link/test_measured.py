"""What link.csv says of a tick, where it has more than a frame or a copy of it."""

from pathlib import Path

import numpy as np
import pytest

import laglab
from laglab.link.fitting import fit_losses
from laglab.link.measured import read_measured

TS = 0.01


def test_what_goes_beside_a_frame_does_not_make_up_for_it(tmp_path: Path) -> None:
    """A robot that tells what was not heard sends that beside its measurement."""
    loss = {"link.measurement.loss": 0.4, "duration": 20.0}
    rows = laglab.run("lab", loss, out=tmp_path / "run").link
    assert rows["frame"].max() > 0
    flow = read_measured(tmp_path / "run" / "link.csv", TS).measurement
    first = rows["frame"] == 0
    np.testing.assert_array_equal(flow.lost, rows["fate"][first] == "lost")
    assert flow.size == rows["size"][first].max()
    assert fit_losses(flow.lost).loss == pytest.approx(0.4, abs=0.03)


def test_of_a_frames_copies_the_first_that_came_counts(tmp_path: Path) -> None:
    log = tmp_path / "link.csv"
    fates = [("lost", 0.0, 0.0), ("delivered", 0.03, 0.02)]
    rows = [
        f"command,{tick},0,{copy},34,{fate},{extra}\n"
        for tick, (fate, *extras) in enumerate(fates)
        for copy, extra in enumerate(extras)
    ]
    log.write_text("direction,tick,frame,copy,size,fate,extra\n" + "".join(rows))
    np.testing.assert_array_equal(read_measured(log, TS).command.delay, [np.nan, 0.02])
