"""What a filter may have besides what it must: wrong answers are told, as all others are."""

from collections.abc import Callable

import pytest

from laglab.check import checked
from laglab.runs import rehearse
from laglab.scenario import load
from laglab_gateway import MemoryRecorder

Ended = Callable[..., tuple[int, str, str]]

INLINE = ("run", "lab", "--duration", "1", "--transport", "inline", "--out", "run")
INNOVATIONS = (
    *("Two", "One", "Four", "Lists", "Column"),
    *("Variances", "Keyed", "Nan", "Single", "Torn", "Once"),
)
INNOVATION = "must answer None, or a finite array z - h(x) (3,) and its S (3, 3), not "


@pytest.mark.usefixtures("brought")
@pytest.mark.parametrize("name", INNOVATIONS)
def test_under_a_guard_an_innovation_that_is_none_ends_the_run(name: str) -> None:
    told = {"estimator.kind": f"optional:{name}", "duration": 1.0}
    recorder = MemoryRecorder()
    ending = rehearse.rehearse_inline(load("lab", told), recorder)
    assert ending.exit_code == 4
    assert ending.problem.startswith(f"tick 40: optional:{name}.innovation {INNOVATION}")
    assert 41 <= len(recorder.rows) <= 42


@pytest.mark.usefixtures("brought")
def test_beside_the_loop_it_costs_the_run_nothing(ended: Ended) -> None:
    code, _, stderr = ended(*INLINE, "--set", 'estimator.compare=["optional:Two"]')
    assert code == 0, stderr
    assert f"warning: tick 40: optional:Two.innovation {INNOVATION}" in stderr


@pytest.mark.usefixtures("brought")
@pytest.mark.parametrize("name", INNOVATIONS)
def test_the_check_finds_it(name: str) -> None:
    (failed,) = checked("estimator", f"optional:{name}")
    assert failed[:2] == ("interface", "no")
    assert f"{name}.innovation {INNOVATION}" in failed.said
