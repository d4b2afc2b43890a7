"""What the robot's side refuses, whoever makes it, and that the refusal names the field."""

import pickle
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from laglab_gateway import (
    Burst,
    ConfigError,
    Event,
    ExtraDelay,
    GatewayConfig,
    GatewayError,
    Impairments,
    Safety,
)

NAN, INF = float("nan"), float("inf")


def gateway_config(**other: Any) -> GatewayConfig:
    right = {"command_delay": 1, "measurement_delay": 2, "last_tick": 3, "sample_time": 0.01}
    return GatewayConfig(**{**right, **other})


WRONG: list[tuple[Callable[..., object], str, list[object], str]] = [
    (Impairments, "loss", [7, -0.1, NAN, INF, "0.1", True], "must be "),
    (Impairments, "reorder_by", [-1.0, NAN], "must be "),
    (Impairments, "bandwidth", [0, -1.0, INF], "must be "),
    (Impairments, "queue", [0, 1.5, -1], "must be "),
    (
        Impairments,
        "outages",
        [[[1.0]], [[0.0, 1.0, 2.0]], [[-1.0, 1.0]], 3],
        "must be a list of [start, ",
    ),
    (Impairments, "burst", [3, "much"], "must be a table, not "),
    (Burst, "good_to_bad", [7, -0.1], "must be "),
    (ExtraDelay, "mean", [-0.1, NAN], "must be "),
    (ExtraDelay, "distribution", ["gamma"], "must be 'constant', 'uniform', 'normal', "),
    (Event, "at", [-1.0, INF], "must be "),
    (Event, "duration", [0.0, -1.0, NAN], "must be "),
    (Event, "direction", ["up"], "must be 'command', 'measurement' or 'both', not 'up'"),
    (Safety, "v_limit", [0.0, -1.0, NAN], "must be "),
    (Safety, "link_timeout", [-1.0, INF, None], "must be "),
    (gateway_config, "command_delay", [-1, 1.5, NAN, None], "must be "),
    (gateway_config, "measurement_delay", [-1], "must be 0 or more, not -1"),
    (gateway_config, "last_tick", [-1, INF], "must be "),
    (gateway_config, "sample_time", [0.0, -0.01, NAN, INF, "fast"], "must be "),
    (gateway_config, "safety", [0.5], "must be a table, not 0.5"),
]


@pytest.mark.parametrize(
    ("make", "field", "value", "said"),
    [(make, field, value, said) for make, field, values, said in WRONG for value in values],
)
def test_what_cannot_be(make: Callable[..., object], field: str, value: object, said: str) -> None:
    with pytest.raises(ConfigError) as refused:
        make(**{field: value})
    assert str(refused.value).startswith(f"{field}: {said}")
    assert len(str(refused.value)) < 200
    assert isinstance(refused.value, GatewayError)


def test_by_position_the_field_is_named_too() -> None:
    with pytest.raises(ConfigError, match=r"^omega_limit: must be above 0, not -3"):
        Safety(2.0, -3.0)


def test_what_is_left_out_is_named() -> None:
    with pytest.raises(ConfigError, match=r"^measurement_delay: field required"):
        GatewayConfig(1)  # type: ignore[call-arg]


def test_nothing_is_added_and_nothing_is_changed_for_the_worse() -> None:
    with pytest.raises(ConfigError, match=r"^fog: unexpected keyword argument"):
        Impairments(fog=1.0)  # type: ignore[call-arg]
    with pytest.raises(ConfigError, match=r"^loss: must be 1 or less, not 7"):
        replace(Impairments(), loss=7)


def test_what_can_be_is_a_plain_value() -> None:
    event = Event(1.0, INF, Impairments(outages=((0.0, 1),), burst=Burst(0.1, 0.2)))  # type: ignore[arg-type]
    assert event == pickle.loads(pickle.dumps(event)) == replace(event, at=1)
    assert hash(event) == hash(replace(event))
    assert gateway_config(last_tick=None).last_tick is None
