"""The trace file: numbers that read back to the same double, errors that name the file."""

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from laglab_gateway import FileRecorder, TraceError, TraceRow, read_trace, trace_pieces

doubles = st.floats(allow_nan=False)


@given(numbers=st.lists(doubles, min_size=14, max_size=14))
def test_every_double_reads_back_the_same(
    numbers: list[float], tmp_path_factory: pytest.TempPathFactory
) -> None:
    directory = tmp_path_factory.mktemp("trace")
    recorder = FileRecorder(directory)
    recorder.row(TraceRow(0, *numbers))
    recorder.close()
    trace = read_trace(directory / "trace.csv")
    assert [trace[name][0] for name in TraceRow._fields] == [0, *numbers]


def test_an_estimate_that_is_not_there_is_an_empty_cell(tmp_path: Path) -> None:
    recorder = FileRecorder(tmp_path)
    recorder.row(TraceRow(0, *[1.0] * 7, None, None, None, *[1.0] * 4))
    recorder.close()
    assert "1.0,,,,1.0" in (tmp_path / "trace.csv").read_text()
    assert math.isnan(read_trace(tmp_path / "trace.csv")["x_est"][0])


@pytest.mark.parametrize("text", ["", "a,b\n1,2\n", ",".join(TraceRow._fields) + "\n", "\0\xff"])
def test_what_is_no_trace_is_refused_by_name(tmp_path: Path, text: str) -> None:
    path = tmp_path / "other.csv"
    path.write_text(text)
    with pytest.raises(TraceError, match=r"other\.csv"):
        read_trace(path)


def test_only_the_last_row_may_be_cut_short(tmp_path: Path) -> None:
    """Wherever the pieces end in which it is read."""
    path, width = tmp_path / "trace.csv", len(TraceRow._fields)
    lines = [",".join([str(tick)] * width) for tick in range(20)]
    for cut, by, whole in ((9, 9, False), (19, 9, True), (19, 1, True)):
        told = [line if tick != cut else line[:-by] for tick, line in enumerate(lines)]
        path.write_text("\n".join([",".join(TraceRow._fields), *told]))
        for rows in (7, 10, 19, 20):
            if whole:
                assert sum(len(piece["tick"]) for piece in trace_pieces(path, rows)) == 19
            else:
                with pytest.raises(TraceError, match="another number of columns"):
                    list(trace_pieces(path, rows))


def test_a_directory_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(TraceError, match="cannot record into"):
        FileRecorder(tmp_path / "file")
