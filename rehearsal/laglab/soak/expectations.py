"""What is expected of every turn: each expectation has a name, and says what is not so."""

from collections.abc import Callable, Iterator, Mapping

from laglab.soak.played import Part, Played
from laglab_gateway import ROWS

COMPLETED, KNOWN_BEFORE, DIVERGED, BROKE, INTERRUPTED = 0, 2, 3, 4, 130
"""Exit codes, as docs/reference/errors.md lists them."""
KILLED = -9
OVER = frozenset({COMPLETED, DIVERGED})

MOST_MEMORY = 256 << 20
"""[bytes] Of a side, whatever it does."""
MOST_GROWTH = 4 << 20
"""[bytes] In the later half of a run, whose windows of the past are full by then."""
FILLING = 24 << 20
"""[bytes] What these windows may take besides."""
FULL_AFTER = 5_000
"""Ticks."""
FEWEST_SAMPLES = 8
"""Fewer do not tell growth."""
MOST_DESCRIPTORS = 32


def exit_codes(played: Played) -> Iterator[str]:
    """As docs/reference/errors.md lists them."""
    for part in played.parts:
        allowed = _allowed(played, part)
        if part.exit_code not in allowed:
            yield f"the {part.side} ended with {part.exit_code}, not {sorted(allowed)}"
    codes = {part.exit_code for part in played.parts}
    if played.struck is None and len(codes) > 1:
        yield f"the sides ended with different exit codes, {sorted(codes)}"


def _allowed(played: Played, part: Part) -> frozenset[int]:
    blow, struck = played.turn.blow, played.struck
    if part.dismissed:
        return frozenset({INTERRUPTED})
    if blow is None or struck is None:
        return OVER
    if part is struck:
        return OVER | {KILLED if part.signal == "SIGKILL" else INTERRUPTED}
    if blow.again:
        return OVER
    codes = OVER | {BROKE if blow.signal == "SIGKILL" else INTERRUPTED}
    never_met = played.turn.transport == "serial" and not part.met
    return codes | {KNOWN_BEFORE} if never_met else codes


def no_traceback(played: Played) -> Iterator[str]:
    """Nor anything else that Python says when something was forgotten."""
    for part in played.parts:
        for sign in ("Traceback", "Exception ignored", "Warning:", "Fatal Python error"):
            if sign in part.said:
                yield f"the {part.side} said {sign!r}"


def ends_by_itself(played: Played) -> Iterator[str]:
    """Only who never met the other side, which a signal has ended, may wait for it for ever."""
    for part in played.parts:
        if part.dismissed and (part.met or played.struck is None):
            yield f"the {part.side} did not end"


def has_a_verdict(played: Played) -> Iterator[str]:
    """Where nobody was struck."""
    if played.struck is None:
        for part in played.parts:
            if not part.verdict:
                yield f"the {part.side} left no verdict"


def files_are_whole(played: Played) -> Iterator[str]:
    """At whatever moment a side ended."""
    for part in played.parts:
        for fault in part.faults:
            yield f"the {part.side}: {fault}"


def same_trace_as_inline(played: Played) -> Iterator[str]:
    """In lock-step; strangers change nothing."""
    if played.trace_fault:
        yield played.trace_fault


def memory_has_a_bound(played: Played) -> Iterator[str]:
    """Of every side."""
    for part in played.parts:
        if part.most_memory > MOST_MEMORY:
            yield f"the {part.side} took {part.most_memory >> 20} MB"


def nothing_grows(played: Played) -> Iterator[str]:
    """Neither memory nor descriptors, in the later half of a run."""
    for part in played.parts:
        half = len(part.samples) // 2
        if half < FEWEST_SAMPLES // 2:
            continue
        early, late = part.samples[:half], part.samples[half:]
        grown = max(s.memory for s in late) - max(s.memory for s in early)
        if grown > MOST_GROWTH + (FILLING if part.ticks < 2 * FULL_AFTER else 0):
            yield f"the {part.side}'s memory grew by {grown >> 10} kB"
        opened = max(s.descriptors for s in late) - max(s.descriptors for s in early)
        if opened > len(ROWS):  # a file is opened when there is something to write into it
            yield f"the {part.side} has {opened} more descriptors open"


def descriptors_have_a_bound(played: Played) -> Iterator[str]:
    """Of every side; ours are what they were."""
    for part in played.parts:
        most = max((sample.descriptors for sample in part.samples), default=0)
        if most > MOST_DESCRIPTORS:
            yield f"the {part.side} had {most} descriptors open"
    before, after = played.descriptors
    if after > before:
        yield f"the soak itself has {after - before} more descriptors open"


def nothing_runs_on(played: Played) -> Iterator[str]:
    """No child, nor a child's child."""
    if played.running:
        yield f"{len(played.running)} processes go on running"


def nothing_is_left_behind(played: Played) -> Iterator[str]:
    """No temporary file, no link of a port; who was killed had no time to take them away."""
    for part in played.parts:
        if part.left and part.signal != "SIGKILL":
            yield f"the {part.side} left {', '.join(part.left)}"
    gateways = [part for part in played.parts if part.side == "gateway"]
    if played.left and gateways[-1].signal != "SIGKILL":
        yield f"left: {', '.join(played.left)}"


Expectation = Callable[[Played], Iterator[str]]

EXPECTATIONS: Mapping[str, Expectation] = {
    "exit codes are those of the situation": exit_codes,
    "no traceback": no_traceback,
    "every side ends by itself": ends_by_itself,
    "a run that nobody ends has a verdict": has_a_verdict,
    "files are whole and readable": files_are_whole,
    "in lock-step the trace is the one inline": same_trace_as_inline,
    "memory stays below its bound": memory_has_a_bound,
    "nothing grows": nothing_grows,
    "descriptors stay below their bound": descriptors_have_a_bound,
    "no process goes on": nothing_runs_on,
    "nothing is left behind": nothing_is_left_behind,
}


def failures(played: Played) -> dict[str, list[str]]:
    """By the name of the expectation; empty where all is as expected."""
    said = {name: list(expectation(played)) for name, expectation in EXPECTATIONS.items()}
    return {name: problems for name, problems in said.items() if problems}
