"""Many runs at once over links that lose, delay at random, reorder and fall silent are the runs one
by one."""

import csv

import numpy as np
import pytest

import laglab
from laglab.results.numbers import has_converged
from laglab.runs.inline import InlineLink
from laglab.scenario import both_ways, load
from laglab.studies.many import run_many, schedule_of, why_one_by_one
from laglab_control.batch.impaired import IMPAIRED

from .many_kept import furthest, kept

SHARP = 1e-9


JITTER = {"distribution": "exponential", "mean": 0.01}
LINKS = {
    "losses and jitter": both_ways(loss=0.05, extra_delay=JITTER),
    "much jitter": both_ways(extra_delay={"distribution": "exponential", "mean": 0.05}),
    "bursts": both_ways(burst={"good_to_bad": 0.05, "bad_to_good": 0.2}),
    "reordered and twice": both_ways(reorder=0.2, duplicate=0.1),
    "an outage": {"link.event": [{"at": 0.8, "duration": 1.2, "link": {"loss": 1.0}}]},
    "commands lost for a while": {
        "link.event": [
            {"at": 1.0, "duration": 0.7, "direction": "command", "link": {"loss": 0.9}},
        ]
    },
    "without delay": {
        **both_ways(loss=0.1, extra_delay=JITTER),
        "link.command_delay": 0,
        "link.measurement_delay": 0,
    },
}
GUARDED, FREE = {"estimator.guard": True}, {"estimator.guard": False}
STATIONS = {
    "delayed-ekf": GUARDED,
    "popf": {**GUARDED, "estimator.initial_covariance": 1e-4},
    "popf-printed": {**FREE, "estimator.initial_covariance": 1e-4},
    "ekf": FREE,
    "raw": FREE,
}
NOISY = [(link, "delayed-ekf") for link in LINKS]
NOISY += [(link, "popf") for link in LINKS if link not in ("bursts", "much jitter")]
NOISY += [("losses and jitter", "popf-printed"), ("bursts", "ekf"), ("an outage", "raw")]
QUIET = [("losses and jitter", "delayed-ekf"), ("bursts", "popf"), ("an outage", "ekf")]


def station(kind, link, **others):
    """`lab` with that filter over that link."""
    return load("lab", {"estimator.kind": kind, **STATIONS[kind], **LINKS[link], **others})


@pytest.mark.parametrize(("link", "kind"), NOISY)
def test_with_noise_over_the_first_seconds(link, kind):
    """Of the second of two robots, which have schedules of their own."""
    scenarios = [station(kind, link, seed=seed, duration=3.0) for seed in (1, 2)]
    many = kept(scenarios)
    assert furthest(many, 1, laglab.run(scenarios[1])) < SHARP


def test_each_filter_that_there_is_is_tried():
    assert {kind for _, kind in NOISY} == set(IMPAIRED)


def test_one_that_there_is_for_ideal_links_alone_runs_one_by_one_over_others(monkeypatch):
    monkeypatch.delitem(IMPAIRED, "ekf")
    over_both = [{}, LINKS["bursts"]]
    whys = [why_one_by_one(load("lab", {"estimator.kind": "ekf", **link})) for link in over_both]
    assert whys == [None, "there is no ekf for many robots on such a link"]


def test_other_robots_are_no_exception():
    car = {"plant.kind": "car", "plant.parameters.steering_time_constant": 0.3, **FREE}
    scenario = station("delayed-ekf", "losses and jitter", **car, duration=3.0)
    assert furthest(kept([scenario]), 0, laglab.run(scenario)) < SHARP


@pytest.mark.parametrize(("link", "kind"), QUIET)
def test_without_noise_over_the_whole_run(link, kind):
    scenario = station(kind, link, noise=False, duration=6.0)
    many = kept([scenario])
    assert furthest(many, 0, laglab.run(scenario)) < SHARP


@pytest.mark.parametrize(("link", "kind"), [("bursts", "delayed-ekf"), ("an outage", "popf")])
def test_the_verdicts_are_the_same(link, kind):
    """And the first seconds; some arrive, others are still under way."""
    scenarios = [
        station(kind, link, seed=seed, start=start, duration=9.0)
        for seed, start in ((3, [-3.0, -3.0, 0.0]), (4, [-8.0, 2.0, 1.0]))
    ]
    many, verdicts = kept(scenarios), []
    for robot, scenario in enumerate(scenarios):
        run = laglab.run(scenario)
        assert furthest(many, robot, run, last=300) < SHARP
        ends = dict(zip(("x", "y", "theta"), many.truth[:, :, robot], strict=True))
        verdicts.append(has_converged({**run.trace, **ends}, scenario.goal))
        assert verdicts[-1] == run.summary.converged
    assert verdicts == [True, False]


def test_answers_that_come_again_change_nothing(monkeypatch):
    """What they ask the robot to recall goes over the link once."""
    scenario = station("delayed-ekf", "losses and jitter", duration=2.0)
    said_once, send = laglab.run(scenario), InlineLink.send

    def twice(link, data, to=None):
        there = len(link._inbox)
        send(link, data, to)
        link._inbox += link._inbox[there:]

    monkeypatch.setattr(InlineLink, "send", twice)
    said_twice = laglab.run(scenario)
    assert said_twice.link["tick"].tolist() == said_once.link["tick"].tolist()
    assert furthest(kept([scenario]), 0, said_twice) < SHARP


def test_they_diverge_at_the_same_tick():
    prior = {"estimator.initial_covariance": 0.05, "duration": 3.0}
    scenarios = [load("fig8", {**LINKS["bursts"], **prior, "seed": seed}) for seed in (1, 2)]
    ends = run_many(scenarios, lambda _: None)
    assert ends.diverged.all()
    assert ends.last_tick.tolist() == [len(laglab.run(each).trace["x"]) - 1 for each in scenarios]


def test_a_guard_that_acts_makes_it_unsure():
    scenario = station("ekf", "losses and jitter", duration=2.0, **GUARDED)
    assert laglab.run(scenario).alarms
    assert run_many([scenario], lambda _: None).unsure.all()


def test_what_was_recorded_of_a_link_happens_again(tmp_path):
    first = station("delayed-ekf", "losses and jitter", duration=2.0)
    done, log = laglab.run(first), tmp_path / "link.csv"
    with log.open("w", newline="") as file:
        csv.writer(file).writerows([done.link.keys(), *zip(*done.link.values(), strict=True)])
    again = load("lab", {"link.replay": str(log), "seed": 9, "duration": 2.0})
    assert furthest(kept([again]), 0, laglab.run(again)) < SHARP


def test_a_failsafe_that_never_waits_is_one_too():
    scenario = load("lab", {"safety.link_timeout": 0.0, "duration": 1.0})
    assert furthest(kept([scenario]), 0, laglab.run(scenario)) < SHARP


def test_one_schedule_serves_all_who_have_the_same_link():
    schedule = schedule_of(station("delayed-ekf", "bursts", duration=1.0))
    assert schedule_of(station("popf", "bursts", duration=1.0, start=[1.0, 2.0, 0.0])) is schedule
    assert schedule_of(station("popf", "bursts", duration=1.0, seed=2)) is not schedule


@pytest.mark.parametrize(
    ("overrides", "reason"),
    [
        ({"estimator.kind": "popf-exact"}, "popf-exact"),
        ({"estimator.kind": "calibrating-ekf"}, "calibrating-ekf"),
        ({"plant.event": [{"at": 1.0, "place": [0.0, 0.0, 0.0]}]}, "plant.event"),
        ({"duration": np.inf}, "duration"),
        ({"pace": "realtime"}, "pace"),
        ({"link.command.bit_error_rate": 1e-5}, "bytes"),
        ({"link.event": [{"at": 1.0, "link": {"bandwidth": 9600}}]}, "bytes"),
        ({"link.measurement_delay": 2100}, "remembers"),
        ({"link.command_delay": 1024}, "remembers"),
    ],
)
def test_what_must_run_one_by_one_says_why(overrides, reason):
    assert why_one_by_one(load("lab")) is None
    assert reason in why_one_by_one(load("lab", overrides))
