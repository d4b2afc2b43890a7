"""Traces of mahimahi's: when there was room for so many bytes, each a line."""

from pathlib import Path

import numpy as np
import pytest

from laglab.link.errors import LinkFileError
from laglab.link.importing.mahimahi import waited

from .measured import HOW, imported


def test_a_trace_of_mahimahis_lets_frames_wait_for_their_turn(tmp_path: Path) -> None:
    # Every 30 ms one opportunity: three frames of 121 bytes go together.
    measured = imported(tmp_path, "30\n")
    np.testing.assert_allclose(measured.command.delay[1:7], [0.02, 0.01, 0.0] * 2, atol=1e-9)
    assert measured.command.sent[-1] > 9.9
    assert "how long they then travel comes on top" in measured.notes[0]


def test_frames_that_do_not_fit_wait_for_the_next_opportunity() -> None:
    # Of two frames of 1000 bytes the second's second half goes with the next one.
    crossed = waited([10, 20], np.array([0.0, 0.0, 0.0]), 1000)
    np.testing.assert_allclose(crossed, [0.01, 0.02, 0.02])
    # What nobody uses is lost; then the trace begins again.
    np.testing.assert_allclose(waited([10, 20], np.array([0.015, 0.021]), 100), [0.02, 0.03])


def test_each_direction_may_have_a_trace_of_its_own(tmp_path: Path) -> None:
    (tmp_path / "down").write_text("10\n")
    measured = imported(tmp_path, "20\n40\n", HOW._replace(back=tmp_path / "down"))
    assert measured.command.delay[1] == pytest.approx(0.01)
    assert np.abs(measured.measurement.delay[1:]).max() < 1e-9


@pytest.mark.parametrize("text", [None, "soon", "3\n2\n"])
def test_a_bad_trace_for_the_way_back_is_named(tmp_path: Path, text: str | None) -> None:
    back = tmp_path / "down"
    if text is not None:
        back.write_text(text)
    with pytest.raises(LinkFileError, match=r"--back .*down: no mahimahi trace"):
        imported(tmp_path, "20\n", HOW._replace(back=back))
