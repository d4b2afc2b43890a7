"""When an unfinished frame is given up, on a clock of the test's own."""

from laglab_protocol import Link, Listener, Receiver, Sender, Tick
from laglab_protocol.listener import STREAM_SILENCE

FALSE_START = bytes.fromhex("fdff000000010184cb00")
"""It claims 255 bytes of a message that there is."""


class Line(Link):
    """One end of a link that gives what it is told to."""

    name = "line"

    def __init__(self, datagrams: bool) -> None:
        self.datagrams = datagrams
        self.inbox: list[bytes] = []

    def fileno(self) -> int:
        return -1

    def send(self, data: bytes, to: object = None) -> None: ...

    def receive(self, _: float) -> bytes:
        return self.inbox.pop(0) if self.inbox else b""


def test_on_a_stream_only_a_real_silence_gives_a_false_start_up() -> None:
    time = 0.0
    line = Line(datagrams=False)
    listener = Listener(line, Receiver(), now=lambda: time)
    frame = Sender(1, 1).frame(Tick(7, 0))
    line.inbox = [FALSE_START + frame]
    assert listener.listen(0.0) == []
    time = 0.9 * STREAM_SILENCE
    assert listener.listen(0.0) == []
    line.inbox = [b"?"]
    assert listener.listen(0.0) == []
    time += 0.9 * STREAM_SILENCE
    assert listener.listen(0.0) == []
    time += 0.2 * STREAM_SILENCE
    (found,) = listener.listen(0.0)
    assert found.message == Tick(7, 0)


def test_what_came_while_one_waited_for_the_processor_is_no_silence() -> None:
    time = 0.0

    class Late(Line):
        def receive(self, timeout: float) -> bytes:
            nonlocal time
            time += timeout + 3.0 * STREAM_SILENCE
            return super().receive(timeout)

    line = Late(datagrams=False)
    listener = Listener(line, Receiver(), now=lambda: time)
    frame = Sender(1, 1).frame(Tick(7, 0))
    line.inbox = [frame[:9]]
    assert listener.listen(0.01) == []
    assert listener.listen(0.01) == []
    line.inbox = [frame[9:]]
    assert [each.message for each in listener.listen(0.01)] == [Tick(7, 0)]


def test_who_judges_the_far_end_waits_longer_for_the_rest_of_a_frame() -> None:
    """A cable that was busy for a moment is no fault of the peer's."""
    time = 0.0
    line = Line(datagrams=False)
    listener = Listener(line, Receiver(), now=lambda: time, silence=0.4)
    frame = Sender(1, 1).frame(Tick(7, 0))
    line.inbox = [frame[:9]]
    assert listener.listen(0.0) == []
    time = 0.39
    assert listener.listen(0.0) == []
    line.inbox = [frame[9:]]
    assert [each.message for each in listener.listen(0.0)] == [Tick(7, 0)]


def test_a_datagram_is_a_unit() -> None:
    line = Line(datagrams=True)
    listener = Listener(line, Receiver())
    sender = Sender(1, 1)
    line.inbox = [sender.frame(Tick(1, 0))[:-3], FALSE_START + sender.frame(Tick(2, 0))]
    assert listener.listen(0.0) == []
    assert [frame.message for frame in listener.listen(0.0)] == [Tick(2, 0)]


def test_what_was_said_before_is_forgotten() -> None:
    line = Line(datagrams=False)
    listener = Listener(line, Receiver())
    frame = Sender(1, 1).frame(Tick(3, 0))
    line.inbox = [frame, frame[:9]]
    listener.forget()
    line.inbox = [frame]
    assert len(listener.listen(0.0)) == 1
