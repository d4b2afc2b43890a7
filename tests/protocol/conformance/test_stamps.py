"""What the kit makes of the frames of a robot that came, and of those that did not."""

import pytest

from laglab_conformance.freerunning import FreeRunningSession
from laglab_conformance.session import Waits
from laglab_conformance.stamps import STAMPED
from laglab_protocol import Measurement, Sender, Tick, frames_in, open_endpoint

COUNTS = next(item for item in STAMPED if item.name == "the tick counts its measurements")
TICKS = 60


@pytest.mark.parametrize(
    ("lost", "announced", "numbered", "wrong"),
    [
        ((), 1, True, False),
        ((), 2, True, True),
        ((), 2, False, True),
        ((3,), 1, True, False),
        ((3,), 3, True, True),
        ((3,), 1, False, True),
        (tuple(range(3, TICKS, 10)), 1, True, True),
    ],
)
def test_a_frame_that_the_line_lost_is_not_the_robots_fault(
    lost: tuple[int, ...], announced: int, numbered: bool, wrong: bool
) -> None:
    """As its number tells, if that is rare. At tick 3 the robot announces so many."""
    robot = Sender(1, 1)
    with open_endpoint("udpin://127.0.0.1:0") as endpoint:
        session = FreeRunningSession(endpoint, Waits(), None)
        for k in range(TICKS):
            sample = Measurement(0.0, 0.0, 0.0, 0.0, 0.0, k, k - 1)
            tick = Tick(k, announced if k == 3 else 1)
            for message, at in ((sample, k), (tick, k + 0.1)):
                raw = (robot if numbered else Sender(1, 1)).frame(message)
                if message is tick or k not in lost:
                    session.heard += frames_in(raw)
                    session.heard_at.append(at)
        assert (COUNTS.check(session) is not None) == wrong


def test_what_came_while_we_were_held_up_came_in_time() -> None:
    with open_endpoint("udpin://127.0.0.1:0") as endpoint:
        session = FreeRunningSession(endpoint, Waits(), None)
        with open_endpoint(endpoint.name.replace("udpin", "udpout")) as robot:
            for k in range(3):
                robot.send(Sender(1, 1).frame(Tick(k, 0)))
            robot.receive(0.05)
            found = session.listen(0.0, lambda frame: frame.message == Tick(2, 0))
            assert found is not None
            assert session.listen(0.0, lambda _: True) is None
