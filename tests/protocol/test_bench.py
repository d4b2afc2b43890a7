"""The bench measures what it says; that it is fast is for the bench to show, not for a test."""

from laglab.bench.codec import bench_codec


def test_every_row_is_measured() -> None:
    rows = bench_codec(rounds=2)

    assert [row.what for row in rows] == [
        "encode",
        "decode",
        "encode signed",
        "decode signed",
    ]
    assert all(min(row.ours_us, row.times_faster, row.c_us) > 0 for row in rows)
    assert "times faster" in str(rows[0])
