"""The items of MAVLink's framing, the same for both sides."""

from dataclasses import replace

from laglab_conformance.forge import Forged
from laglab_conformance.items import Item, accepted, refused
from laglab_conformance.session import DoesNotApplyError, Session
from laglab_protocol import (
    Command,
    End,
    Estimate,
    Measurement,
    Refusal,
    Signer,
    Tick,
    layout_of,
    signing_time,
)

OF_THE_LOOP = (Command, End, Estimate, Measurement, Tick)
UNKNOWN_ID = 59_999
UNKNOWN_FLAG = 0x40
GARBAGE = bytes(range(1, 60))
FALSE_START = b"\xfd\xff"
STRANGER = 77
MAVLINK_1 = bytes.fromhex("fe0900c8be000000000006080004035353")
"""A heartbeat as MAVLink 1 would send it; whatever its CRC, it is not for us."""


def _stray(session: Session, forged: Forged) -> bytes:
    """A frame whose message nobody knows, then the stimulus."""
    other = replace(forged, message_id=UNKNOWN_ID, payload=b"\1\2\3", sequence=0)
    return other.raw + forged.raw if session.signer is None else forged.raw


def _cut(session: Session, forged: Forged) -> bytes:
    """A datagram that lost its end; the stimulus comes in the next one."""
    session.endpoint.send(forged.raw[:-4])
    return session.forged().raw


def _stranger(_: Session, forged: Forged) -> bytes:
    return replace(forged, system=STRANGER).raw


def _other_part(_: Session, forged: Forged) -> bytes:
    return replace(forged, component=STRANGER).raw


def _only_frames(session: Session) -> str | None:
    counters = session.receiver.counters
    noise = counters.noise - session.noise_before
    if not noise or _badly_signed(session):
        return None  # what is not signed as it should be is another item's
    bad = {each.name: count for each, count in counters.refused.items()}
    return f"{noise} bytes in no frame {bad or ''}"


def _badly_signed(session: Session) -> dict[str, int]:
    counts = session.receiver.counters.refused
    reasons = (Refusal.UNSIGNED, Refusal.BAD_SIGNATURE, Refusal.REPLAYED, Refusal.NO_KEY)
    return {each.name: counts[each] for each in reasons if each in counts}


def _numbered(session: Session) -> str | None:
    counters = session.receiver.counters
    lost = counters.lost.get(session.peer, 0), counters.late.get(session.peer, 0)
    return f"{lost[0]} numbers left out, {lost[1]} out of order" if any(lost) else None


def _itself(session: Session) -> str | None:
    """Others who speak on the line are no fault; but nobody takes the loop's messages from them."""
    for frame in session.heard:
        speaker = frame.system, frame.component
        if isinstance(frame.message, OF_THE_LOOP) and speaker != session.peer:
            told = layout_of(frame.message).name
            return f"{told} of system {speaker[0]}, component {speaker[1]}: not {session.peer}"
    return None


def _trimmed(session: Session) -> str | None:
    for frame in session.heard:
        payload = frame.raw[10 : 10 + frame.raw[1]]
        if len(payload) > 1 and payload[-1] == 0:
            return f"{layout_of(frame.message).name} ends in zeros that need not travel"
    return None


RECEIVING: list[Item[Session]] = [
    Item("framing", "an ordinary frame is taken", accepted(lambda _, forged: forged.raw)),
    Item(
        "framing",
        "garbage before a frame costs nothing",
        accepted(lambda _, forged: GARBAGE + forged.raw),
    ),
    Item(
        "framing",
        "a false start before a frame costs nothing",
        accepted(lambda _, forged: FALSE_START + forged.raw + GARBAGE * 5),
        mandatory=False,  # pymavlink's own parser passes over what it hides
    ),
    Item("framing", "a frame cut short does not eat the next", accepted(_cut)),
    Item("framing", "an unknown message is passed over", accepted(_stray)),
    Item(
        "crc",
        "a corrupted frame is refused",
        refused(lambda _, forged: replace(forged, crc_flip=0x0100).raw),
    ),
    Item(
        "crc",
        "another definition of the message is refused",
        refused(lambda _, forged: replace(forged, crc_extra=bytes([forged.crc_extra[0] ^ 1])).raw),
    ),
    Item(
        "truncation",
        "untrimmed payloads are taken",
        accepted(lambda session, forged: forged.untrimmed(session.stimulus()).raw),
    ),
    Item(
        "truncation",
        "longer payloads of later versions are taken",
        accepted(
            lambda session, forged: (
                replace(forged, payload=forged.untrimmed(session.stimulus()).payload + b"\5\6").raw
            )
        ),
    ),
    Item(
        "versions",
        "unknown incompatibility flags are refused",
        refused(
            lambda _, forged: (
                replace(forged, incompatibility=forged.incompatibility | UNKNOWN_FLAG).raw
            )
        ),
    ),
    Item(
        "versions",
        "unknown compatibility flags are taken",
        accepted(lambda _, forged: replace(forged, compatibility=UNKNOWN_FLAG).raw),
    ),
    Item("versions", "MAVLink 1 does no harm", accepted(lambda _, forged: MAVLINK_1 + forged.raw)),
    Item("sender", "another system is not obeyed", refused(_stranger)),
    Item("sender", "another component of the system is not obeyed", refused(_other_part)),
]

SENDING: list[Item[Session]] = [
    Item("framing", "it sends nothing but frames", _only_frames),
    Item("sender", "it speaks as who it is", _itself),
    Item("sequence", "it numbers its frames one by one", _numbered),
    Item("truncation", "it leaves trailing zeros at home", _trimmed),
]


def _key(session: Session) -> bytes:
    if session.key is None:
        raise DoesNotApplyError("no key given")
    return session.key


def _unsigned(session: Session, forged: Forged) -> bytes:
    _key(session)
    return replace(forged, signer=None, incompatibility=0).raw


def _signed_with(session: Session, forged: Forged, key: bytes, at: int) -> bytes:
    stream = (0, session.system, session.component)
    return replace(forged, signer=Signer(key, stream, clock=lambda: at)).raw


def _wrong_key(session: Session, forged: Forged) -> bytes:
    """Stamped far in the future too, so that one who believes it refuses us from then on."""
    _key(session)
    return _signed_with(session, forged, bytes(32), signing_time() + 10**9)


def _old(session: Session, forged: Forged) -> bytes:
    return _signed_with(session, forged, _key(session), signing_time() - 10**5 * 30)


def _signs(session: Session) -> str | None:
    bad = _badly_signed(session)
    if session.key is None and bad:
        return f"not so that it can be checked: {bad}: give the kit its --key"
    _key(session)
    return f"not so: {bad}" if bad else None


SIGNING: list[Item[Session]] = [
    Item("signing", "unsigned frames are refused", refused(_unsigned)),
    Item("signing", "frames signed with another key are refused", refused(_wrong_key)),
    Item("signing", "old timestamps are refused", refused(_old)),
    Item("signing", "it signs what it sends", _signs),
]
