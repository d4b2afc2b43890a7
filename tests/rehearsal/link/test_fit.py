"""A link is fitted: what is made by known numbers gives them back, and figures hold."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import laglab
from laglab.link.advice import suggestions
from laglab.link.fitting import (
    choices,
    delay_in_ticks,
    distance,
    fit,
    fit_delays,
    fit_losses,
    simulated,
    suggested,
)
from laglab.link.fitting.delays import CLOSE, distance_to
from laglab.link.link_table import Bounds, FittedLink, link_toml
from laglab.link.measured import Flow, MeasuredLink, bursts, read_measured, write_link_log
from laglab.link.told import overtaken
from laglab.scenario import load
from laglab_gateway import Burst, ExtraDelay, Impairments

Said = Refused = Callable[..., str]
Ended = Callable[..., tuple[int, str, str]]
TS = 0.01
NONE = Flow(np.empty(0), np.empty(0), 100)
UP = Impairments(
    ExtraDelay("table", quantiles=(0.0, 0.002, 0.004, 0.02, 0.05), correlation=0.9),
    burst=Burst(0.01, 0.2),
)
DOWN = Impairments(ExtraDelay("normal", 0.03, 0.004), loss=0.02)


def measured(frames: int = 20_000) -> MeasuredLink:
    """As if both had been probed; the fixed delays are 2.3 and 3 ticks."""
    flows = (simulated(UP, 0.023, NONE, TS), simulated(DOWN, 0.03, NONE, TS))
    return MeasuredLink(*(Flow(f.sent[:frames], f.delay[:frames], f.size) for f in flows), TS)


MEASURED = measured()


@pytest.fixture
def said(tmp_path: Path, ended: Ended, monkeypatch: pytest.MonkeyPatch) -> Said:
    """What a command says, in a folder of its own and 80 columns; it ends well."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")

    def call(*arguments: str) -> str:
        code, out, err = ended(*arguments)
        assert code == 0, err
        return out

    return call


def lost_by(burst: Burst, loss: float = 0.0, frames: int = 200_000) -> np.ndarray:
    like = Flow(np.empty(0), np.empty(frames), 10)
    return simulated(Impairments(loss=loss, burst=burst), 0.0, like, TS).lost


@pytest.mark.parametrize("burst", [Burst(0.01, 0.2), Burst(0.02, 0.1, 0.0, 0.5)])
def test_bursts_give_back_the_chain_that_made_them(burst: Burst) -> None:
    fitted = fit_losses(lost_by(burst))
    assert fitted.loss == 0
    assert fitted.burst is not None
    for name in ("good_to_bad", "bad_to_good", "loss_good", "loss_bad"):
        assert getattr(fitted.burst, name) == pytest.approx(getattr(burst, name), rel=0.25), name


def test_losses_each_by_itself_are_no_bursts() -> None:
    fitted = fit_losses(lost_by(Burst(), loss=0.05))
    assert fitted == (pytest.approx(0.05, rel=0.1), None)
    assert fit_losses(np.zeros(9, bool)) == (0.0, None)
    assert fit_losses(np.ones(9, bool)) == (1.0, None)
    assert fit_losses(np.empty(0, bool)) == (0.0, None)


def test_one_outage_is_a_burst() -> None:
    lost = np.zeros(2000, bool)
    lost[700:750] = True
    burst = fit_losses(lost).burst
    assert burst is not None
    assert 1 / burst.bad_to_good == pytest.approx(50, rel=0.1)


@pytest.mark.parametrize(
    ("distribution", "mean", "spread"),
    [("uniform", 0.02, 0.01), ("normal", 0.05, 0.01), ("exponential", 0.02, 0.0)],
)
@pytest.mark.parametrize("correlation", [0.0, 0.8])
def test_distributions_give_themselves_back(
    distribution: Any, mean: float, spread: float, correlation: float
) -> None:
    link = Impairments(ExtraDelay(distribution, mean, spread, correlation=correlation))
    fitted = fit_delays(simulated(link, 0.0, NONE, TS).delay)
    assert fitted is not None
    assert fitted.distribution in (distribution, "table"), "a table where chance says so"
    assert fitted.at(0.5) == pytest.approx(link.extra_delay.at(0.5), rel=0.1)  # type: ignore[union-attr]
    assert fitted.correlation == pytest.approx(correlation, abs=0.05)


def test_what_does_not_scatter_is_constant_or_nothing() -> None:
    assert fit_delays(np.full(9, 0.004)) == ExtraDelay("constant", 0.004)
    assert fit_delays(np.zeros(9)) is None
    assert fit_delays(np.full(9, np.nan)) is None


def test_what_takes_few_values_is_judged_where_they_are() -> None:
    """Delays in whole ticks do."""
    came = np.repeat([0.0, 0.01, 0.02], [300, 600, 100])
    fitted = fit_delays(came)
    assert fitted is not None
    assert distance_to(came, fitted) < CLOSE / 2
    assert distance_to(came, ExtraDelay("exponential", 0.008)) == pytest.approx(0.413, abs=0.001)


def test_two_values_are_a_table_and_equal_ones_do_not_wander() -> None:
    rng = np.random.default_rng(1)
    fitted = fit_delays(np.where(rng.random(4000) < 0.7, 0.01, 0.02))
    assert fitted is not None
    assert fitted.distribution == "table"
    assert fitted.at(0.5) == pytest.approx(0.01)
    assert fitted.at(0.9) == pytest.approx(0.02)
    assert fitted.correlation == 0


def test_the_fitted_link_does_what_was_measured() -> None:
    found = fit(MEASURED, 0.01)
    assert (found.link.command_delay, found.link.measurement_delay) == (2, 4)
    assert max(found.distances) < 0.03
    for (_, was), (_, made) in zip(found.measured.flows, found.made.flows, strict=True):
        assert made.lost.mean() == pytest.approx(was.lost.mean(), rel=0.25)
        assert np.mean(bursts(made.lost)) == pytest.approx(np.mean(bursts(was.lost)), rel=0.2)
        assert overtaken(made) == pytest.approx(overtaken(was), abs=0.03)
        for share in (0.5, 0.9, 0.99):
            at = [np.quantile(flow.delivered, share) for flow in (was, made)]
            assert at[1] == pytest.approx(at[0], rel=0.05)


LINK = Path("link.toml")


def test_a_poor_fit_is_told() -> None:
    drift = 0.02 + 0.02 * np.arange(900.0) / 900  # one slow rise: no stationary link does that
    found = fit(MeasuredLink(Flow(TS * np.arange(900.0), drift, 9), NONE, TS), 0.01)
    assert max(found.distances) > 0.15
    assert "a poor one" in " ".join(suggestions(found, LINK, "again"))
    assert "a poor one" not in " ".join(suggestions(fit(MEASURED, 0.01), LINK, "again"))


def test_what_many_frames_share_is_judged_as_finely_as_it_is_written() -> None:
    """A line of limited bandwidth delays most frames by the same 29/7200 s."""
    delay = np.where(np.random.default_rng(2).random(900) < 0.6, 29 / 7200, 0.011)
    found = fit(MeasuredLink(Flow(TS * np.arange(900.0), delay, 9), NONE, TS), 0.01)
    assert max(found.distances) < 0.05


def test_bounds_are_the_least_that_keep_their_word() -> None:
    for late in (0.1, 0.01, 0.001, 0.0):
        choice = suggested(MEASURED, late)
        for (_, flow), bound, told in zip(MEASURED.flows, choice.bounds, choice.late, strict=True):
            ticks = delay_in_ticks(flow, TS)
            assert np.mean(ticks > bound) == pytest.approx(told)
            assert told <= late < np.mean(ticks > bound - 1)
    kept = choices(MEASURED)
    totals = [choice.total for choice in kept]
    assert totals == sorted(totals)
    assert len(set(totals)) >= 3
    assert kept[-1].late == (0.0, 0.0)
    lost = tuple(flow.lost.mean() for _, flow in MEASURED.flows)
    assert kept[-1].unused == pytest.approx(lost)


def test_a_frame_that_comes_at_a_tick_is_there_at_it() -> None:
    flow = Flow(np.zeros(4), np.array([0.0, 0.03, 0.0301, np.nan]), 9)
    assert delay_in_ticks(flow, TS).tolist() == [0, 3, 4]


def test_the_distance_of_two_samples() -> None:
    assert distance(np.array([1.0, 2.0]), np.array([1.0, 2.0])) == 0
    assert distance(np.array([1.0, 2.0]), np.array([3.0])) == 1
    assert distance(np.array([]), np.array([3.0])) == 0


def test_a_link_as_a_file_reads_back(tmp_path: Path) -> None:
    (tmp_path / "link.toml").write_text(link_toml(FittedLink(3, 4, UP, DOWN, Bounds(5, 6))))
    link = load(str(tmp_path / "link.toml")).link
    assert (link.command_delay, link.measurement_delay) == (3, 4)
    assert (link.command, link.measurement) == (UP, DOWN)
    assert (link.playout.command, link.playout.measurement) == (5, 6)


def test_fitted_rehearsed_and_replayed(said: Said, tmp_path: Path) -> None:
    write_link_log(measured(600), tmp_path / "link.csv")
    told = " ".join(said("link", "fit", "--figure", "link.png").split())
    assert "distance of the delays (KS)" in told
    assert "Without play-out: n = 3, m = 6" in told
    assert "link.playout = { command = 7, measurement = 7 }" in told
    assert (tmp_path / "link.png").read_bytes().startswith(b"\x89PNG")
    inline = ("--transport", "inline", "--duration", "1")
    said("run", "link.toml", *inline)
    rehearsed = read_measured(tmp_path / "runs" / "link" / "link.csv", TS)
    assert len(rehearsed.command.delay) == 101
    said(*very_frames(told), *inline, "--out", "again")
    again = read_measured(tmp_path / "again" / "link.csv", TS)
    np.testing.assert_array_equal(again.command.delay, MEASURED.command.delay[:101].round(7))


def very_frames(told: str) -> list[str]:
    """The command that a fit tells for rehearsing on the frames themselves, without its name."""
    command = " ".join(told.split()).split("on the very frames: laglab ")[1].split(". ")[0]
    return command.removesuffix(".").split()


def test_a_runs_own_link_is_fitted_and_replayed(said: Said, tmp_path: Path) -> None:
    """Its file leaves the fixed delays out."""
    said("run", "lab-radio", "--transport", "inline", "--duration", "4", "--out", "first")
    told = said("link", "fit", "first/link.csv", "-n", "10", "-m", "20", "--out", "2.toml")
    link = load("2.toml").link
    assert (link.command_delay, link.measurement_delay) == (10, 20)
    command = very_frames(told)
    command[1] = "lab-radio"
    said(*command, "--transport", "inline", "--duration", "4", "--out", "again")
    first, again = (laglab.open_run(tmp_path / name) for name in ("first", "again"))
    np.testing.assert_array_equal(first.trace["x"], again.trace["x"])


def test_ticks_are_as_long_as_the_measurements(said: Said, tmp_path: Path) -> None:
    flow = Flow(0.04 * np.arange(50.0), np.full(50, 0.08), 100)
    write_link_log(MeasuredLink(flow, flow, 0.04), tmp_path / "link.csv")
    command = very_frames(said("link", "fit", "--interval", "0.04"))
    assert command[-2:] == ["--set", "sample_time=0.04"]
    said(*command, "--transport", "inline", "--duration", "2", "--out", "again")
    assert laglab.open_run(tmp_path / "again").scenario.sample_time == 0.04
    fitted = load(str(tmp_path / "link.toml"))
    assert fitted.link.command_delay * fitted.sample_time == pytest.approx(0.08)


@pytest.mark.parametrize(
    ("delay", "options", "said"),
    [
        (900.0, (), "link.command_delay: must be below 65535, not 90000"),
        (0.01, ("--figure", "x.nope"), "--figure x.nope: its name must end in one of"),
        (0.01, ("--figure", "no/x.png"), "--figure no/x.png: cannot write there"),
        (None, (), "no frames in it"),
    ],
)
def test_what_cannot_be_fitted_or_drawn_is_one_line(
    delay: float | None,
    options: tuple[str, ...],
    said: str,
    refused: Refused,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    flow = Flow(TS * np.arange(9.0), np.full(9, delay), 100) if delay else NONE
    write_link_log(MeasuredLink(flow, flow, TS), tmp_path / "link.csv")
    assert said in refused("link", "fit", *options)
    assert not (tmp_path / "link.toml").exists()


def test_tables_stay_within_80_columns(said: Said, tmp_path: Path) -> None:
    write_link_log(measured(600), tmp_path / "link.csv")
    lines = said("link", "fit").splitlines()
    assert max(map(len, lines)) <= 80
    assert not any("…" in line for line in lines)


BAD = {
    "nothing.csv": (None, "not a readable link log"),
    "other.csv": ("a,b\n1,2\n", "not a link log: expected the columns"),
    "empty.csv": ("direction,tick,frame,copy,size,fate,extra\n", "no frames in it"),
}


@pytest.mark.parametrize("name", BAD)
def test_what_cannot_be_fitted_is_one_line(name: str, tmp_path: Path, refused: Refused) -> None:
    text, said = BAD[name]
    if text is not None:
        (tmp_path / name).write_text(text)
    assert said in refused("link", "fit", tmp_path / name, "--out", tmp_path / "link.toml")


def test_one_direction_alone_can_be_fitted() -> None:
    flow = Flow(TS * np.arange(50.0), np.full(50, 0.012), 75)
    found = fit(MeasuredLink(NONE, flow, TS), 0.01)
    assert found.link == FittedLink(
        0, 1, Impairments(), Impairments(ExtraDelay("constant", 0.002)), Bounds(0, 2)
    )
    dead = fit(MeasuredLink(Flow(flow.sent, np.full(50, math.nan), 75), flow, TS), 0.01)
    assert dead.link.command == Impairments(loss=1.0)
