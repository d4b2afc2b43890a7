"""What is said of frames that are not taken: the link, the reason, and how to mend it."""

import pytest

from laglab_protocol import Listener, Receiver, Refusals, Sender, Tick, open_endpoint
from laglab_protocol.refusals import OVERTAKEN
from laglab_protocol.signing.signature import MINUTE, Signer, Verifier, signing_time

KEY, OTHER_KEY, STREAM = bytes(range(32)), bytes(32), (0, 1, 1)


def in_2050() -> int:
    return signing_time() + 24 * 365 * 24 * 60 * MINUTE


@pytest.mark.parametrize(
    ("signer", "verifier", "frames", "said"),
    [
        (None, Verifier(KEY), 1, "not signed: give the sender the same --key"),
        (Signer(OTHER_KEY, STREAM), Verifier(KEY), 1, "not signed with this key"),
        (Signer(KEY, STREAM), None, 1, "there is no key here"),
        (Signer(KEY, STREAM, clock=in_2050), Verifier(KEY), 1, "set the clocks of both machines"),
        (Signer(KEY, STREAM, clock=lambda: 1), Verifier(KEY), OVERTAKEN, "over a minute ago"),
    ],
)
def test_each_reason_is_told_once(
    signer: Signer | None, verifier: Verifier | None, frames: int, said: str
) -> None:
    """As soon as it cannot be chance: what one frame says, or several that came too late."""
    sender, refusals = Sender(1, 1, signer), Refusals(now=0.0)
    with (
        open_endpoint("udpin://127.0.0.1:0") as ours,
        open_endpoint(ours.name.replace("udpin", "udpout")) as theirs,
    ):
        listener = Listener(ours, Receiver(verifier))
        for _ in range(frames):
            assert list(refusals.news([listener], now=5.0)) == []
            theirs.send(sender.frame(Tick(0, 0)))
            assert listener.listen(1.0) == []
        assert list(refusals.news([listener], now=5.5)) == [], "it is not time to look again"
        (line,) = refusals.news([listener], now=7.0)
        assert line.startswith(ours.name)
        assert said in line
        assert f"{frames} frame" in line
        assert list(refusals.news([listener], now=9.0)) == []
