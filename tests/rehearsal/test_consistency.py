"""The claimed covariances against true errors."""

import math
from functools import partial

import numpy as np
import pytest

import laglab
from laglab.scenario import load
from laglab.studies.consistency import Sample, chi_square_bounds, consistencies, judged, samples
from laglab.studies.overhearing import Overhearing


@pytest.mark.parametrize(
    ("seeds", "low", "high"),
    # Quantiles 2.5 % and 97.5 % of chi-square with 3 N degrees, from printed tables, over N.
    [(10, 16.791 / 10, 46.979 / 10), (30, 65.647 / 30, 118.136 / 30)],
)
def test_bounds_are_those_of_the_tables(seeds, low, high):
    assert chi_square_bounds(seeds) == pytest.approx((low, high), rel=0.01)


def made_up(seed, scale):
    """A filter that claims P = I while its errors have variance scale^2."""
    error = np.random.default_rng(seed).normal(size=(50, 3)) * scale
    squared = (error**2).sum(axis=1)
    return Sample(error, np.ones((50, 3)), squared, squared, squared, squared > 0)


def consistency(*samples):
    (found,) = consistencies(
        ["made up"], ({"made up": each} for each in samples), last_tick=49, m=0
    )
    return found


@pytest.mark.parametrize(("scale", "consistent"), [(1.0, True), (1.3, False), (0.7, False)])
def test_too_sure_and_not_sure_enough_are_told_apart(scale, consistent):
    judged = consistency(*(made_up(seed, scale) for seed in range(100)))
    assert judged.consistent is consistent
    assert judged.nees.mean == pytest.approx(3 * scale**2, rel=0.05)
    assert np.sqrt(np.mean(judged.true**2)) == pytest.approx(scale, rel=0.02)
    if consistent:
        assert judged.nees.inside > 0.85


def test_a_diverged_seed_and_a_lost_covariance_are_counted():
    whole, cut = made_up(1, 1.0), made_up(2, 1.0)
    short = Sample(*(values[:20] for values in cut))
    indefinite = whole._replace(nees=np.where(np.arange(50) < 25, whole.nees, math.nan))
    judged = consistency(whole, short, indefinite)
    assert judged.diverged == 1
    assert judged.indefinite == pytest.approx(25 / 120)
    assert judged.nees.seeds.tolist() == [3] * 20 + [2] * 5 + [1] * 25
    assert judged.nees.values[22] == pytest.approx(np.mean([whole.nees[22], indefinite.nees[22]]))
    assert not judged.consistent


@pytest.mark.slow
def test_delayed_ekf_is_consistent_and_popf_and_ekf_are_too_sure():
    scenario = load("lab", {"duration": 2.0})
    names = ("ekf", "popf", "delayed-ekf")
    got = consistencies(names, samples(scenario, names, seeds=24, workers=2), 200, 20)
    ekf, popf, delayed = got
    assert [each.estimator for each in got] == list(names)
    assert delayed.consistent
    assert delayed.nis.inside > 0.9
    assert delayed.bounds[0] < delayed.nees_ahead.mean < delayed.bounds[1]
    assert delayed.of_runs.mean() == pytest.approx(delayed.nees.mean)
    for one in (popf, ekf):
        assert one.nees.mean > delayed.bounds[1]
        assert np.all(one.claimed[60] < one.true[60])


def test_the_command_leaves_table_and_picture(ended_here, tmp_path):
    short = ("--duration", "0.5", "--seeds", "3", "--workers", "1")
    code, out, errors = ended_here("consistency", "lab", *short)
    assert code == 0, errors
    for name in ("ekf", "popf", "popf-exact", "delayed-ekf"):
        assert name in out
    assert (tmp_path / "consistency.png").read_bytes().startswith(b"\x89PNG")


def test_a_filter_that_claims_nothing_cannot_be_judged(refused):
    said = refused("consistency", "lab", "--judge", "raw")
    assert "--judge: must not be 'raw', which estimates nothing" in said


@pytest.mark.parametrize(
    ("told", "why"),
    [
        (("--judge", "ekf", "--set", "link.measurement.loss=1.0"), "no measurement ever arrived"),
        (("--judge", "tue-predictor"), "tue-predictor claims nothing: there is nothing to judge"),
    ],
)
def test_what_cannot_be_judged_is_told_in_words(told, why, ended, tmp_path):
    short = ("--duration", "0.5", "--seeds", "2", "--workers", "1", "--out", tmp_path / "a.png")
    code, out, errors = ended("consistency", "lab", *short, *told)
    assert code == 0, errors
    assert f"warning: {why}" in out + errors
    assert "nan" not in out
    *_, lost, verdict = next(line for line in out.splitlines() if told[1] in line).split()
    assert (lost, verdict) == ("0", "-")


@pytest.mark.parametrize("scenario", ["lab", "lab-radio"])
def test_a_filter_beside_the_loop_hears_and_does_what_the_one_in_it_does(scenario):
    """So the loop's own filter, set beside itself, says the same at every tick."""
    said = {}
    overrides = {"duration": 4.5, "estimator.guard": False}
    overhearing = partial(Overhearing, others=("delayed-ekf",), said=said)
    laglab.run(scenario, overrides, controller=overhearing)
    beside, own = said["delayed-ekf"][0::2], said["delayed-ekf"][1::2]
    assert len(beside) == len(own) == 451
    for one, other in zip(beside, own, strict=True):
        for ours, theirs in zip(one, other, strict=True):
            np.testing.assert_array_equal(ours, theirs)


def test_the_prediction_is_judged_by_where_the_robot_was_when_it_counted():
    """Without noise, and told where the robot is, it is there n ticks later, and not before."""
    said = {}
    overhearing = partial(Overhearing, said=said)
    trace = laglab.run("fig6", {"estimator.kind": "delayed-ekf"}, controller=overhearing).trace
    pose = np.stack([trace[axis] for axis in ("x", "y", "theta")], axis=1)
    known = said["delayed-ekf"]
    for k in (30, 80, 130):
        assert np.abs(known[k].ahead - pose[k + 10]).max() < 1e-9
        assert np.abs(known[k].ahead - pose[k]).max() > 1e-3
    assert np.nanmax(judged(known, trace).nees_ahead) < 1e-6
