"""The bench measures what it says; that it is fast is for the bench to show, not for a test."""

from contextlib import ExitStack

from laglab.bench import run
from laglab.bench.codec import bench


def test_every_codec_is_measured_at_everything() -> None:
    with ExitStack() as stack:
        report = run(bench(stack), 2, lambda _: None)

    (result,) = report.results
    assert [(timing.case, timing.name) for timing in result.timings] == [
        (case, name)
        for case in ("encode", "decode", "encode signed", "decode signed")
        for name in ("ours", "pymavlink", "mavgen's C")
    ]
    assert all(timing.fastest > 0 for timing in result.timings)
