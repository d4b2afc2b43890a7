"""What the kit makes of the frames of a robot that came, and of those that did not."""

import pytest

from laglab_conformance.freerunning import FreeRunningSession
from laglab_conformance.session import Waits
from laglab_conformance.stamps import STAMPED
from laglab_protocol import Measurement, Sender, Tick, frames_in, open_endpoint

COUNTS = next(item for item in STAMPED if item.name == "the tick counts its measurements")


@pytest.mark.parametrize(
    ("lost", "announced", "wrong"),
    [
        ((), 1, False),
        ((), 2, True),
        (("measurement", 3), 1, False),
        (("measurement", 3), 3, True),
    ],
)
def test_a_frame_that_the_line_lost_is_not_the_robots_fault(
    lost: tuple[str, int], announced: int, wrong: bool
) -> None:
    robot = Sender(1, 1)
    with open_endpoint("udpin://127.0.0.1:0") as endpoint:
        session = FreeRunningSession(endpoint, Waits(), None)
        for k in range(6):
            sample = robot.frame(Measurement(0.0, 0.0, 0.0, 0.0, 0.0, k, k - 1))
            count = announced if k == 3 else 1
            said = [] if ("measurement", k) == lost else [sample]
            for at, raw in enumerate([*said, robot.frame(Tick(k, count))]):
                session.heard += frames_in(raw)
                session.heard_at.append(k + 0.1 * at)
        assert (COUNTS.check(session) is not None) == wrong
