"""When an unfinished frame is given up, on a clock of the test's own."""

from laglab_protocol import Silence
from laglab_protocol.endpoints.silence import STREAM_SILENCE


def test_on_a_stream_only_a_real_silence_ends_a_frame() -> None:
    time = 0.0
    silence = Silence(datagrams=False, now=lambda: time)
    assert not silence.after(b"half a fr")
    time = 0.9 * STREAM_SILENCE
    assert not silence.after(b"")
    assert not silence.after(b"ame")
    time += 0.9 * STREAM_SILENCE
    assert not silence.after(b"")
    time += 0.2 * STREAM_SILENCE
    assert silence.after(b"")


def test_a_datagram_is_a_unit() -> None:
    assert Silence(datagrams=True).after(b"half a fr")
