"""`laglab reproduce`: each claim of the paper, tried; and what docs/ says of them."""

import re
import shlex
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
import typer
from PIL import Image

from laglab.command import app_of
from laglab.studies.reproduce import CLAIMS, Verdict, entries, tried, write_report

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "reproduce.md").read_text(encoding="utf-8")
VERDICTS = dict(
    re.findall(r"^\| \[([\w-]+)\]\(#[\w-]+\) \| [^|]+ \| ([^|]+) \|$", PAGE, flags=re.M)
)
CHEAP = (
    *("kinematics", "delay", "prediction", "kalman", "noises", "misprint-innovation"),
    *("fig4", "fig5", "fig6", "ekf"),
)
ROUNDED = ("fig4", "fig6", "kalman", "prediction")
"""Whose numbers are rounding, which need not be the same everywhere."""
KILOBYTES = 1000
GREY_LEVELS = 0.01
"""Of 255, on average over a picture: rounding elsewhere moves less, a word that changed more."""


def test_the_page_has_every_claim_in_order():
    assert list(VERDICTS) == list(CLAIMS)
    for claim in CLAIMS.values():
        assert f"\n## {claim.name}\n" in PAGE
        assert f"`{claim.command}`" in PAGE
        assert " ".join(claim.says.split()) in " ".join(PAGE.split())
        assert any(claim.spelled(verdict) == VERDICTS[claim.name] for verdict in Verdict)


def test_the_page_says_plainly_what_does_not_hold():
    failed = {name for name, verdict in VERDICTS.items() if verdict == "does not hold"}
    assert {"kinematics", "misprint-innovation", "covariance", "prior-below-r"} <= failed
    assert VERDICTS["fig5"].startswith("holds with limits")


def test_the_page_and_its_pictures_are_small():
    pictures = list((ROOT / "docs" / "reproduce").iterdir())
    assert {f"reproduce/{picture.name}" for picture in pictures} == set(
        re.findall(r"\]\((reproduce/[^)]+)\)", PAGE)
    )
    total = len(PAGE.encode()) + sum(picture.stat().st_size for picture in pictures)
    assert total < 600 * KILOBYTES


@pytest.mark.parametrize("name", CHEAP)
def test_a_trial_comes_to_the_verdict_of_the_page(name):
    (entry,) = entries([tried(name)])
    assert entry.spelled == VERDICTS[name]
    if name not in ROUNDED:
        assert " ".join(entry.got.split()) in " ".join(PAGE.split())


@pytest.mark.parametrize("name", ["fig5", "fig6"])
def test_a_picture_is_the_one_that_is_drawn_today(name):
    kept = Image.open(BytesIO((ROOT / "docs" / "reproduce" / f"{name}.png").read_bytes()))
    drawn = Image.open(BytesIO(tried(name).evidence.picture))
    assert drawn.size == kept.size
    if drawn.info["Software"] == kept.info["Software"]:  # another matplotlib sets its text anew
        now, then = (np.asarray(each.convert("L"), float) for each in (drawn, kept))
        assert np.mean(np.abs(now - then)) < GREY_LEVELS


@pytest.mark.parametrize("claim", CLAIMS.values(), ids=CLAIMS)
def test_each_command_is_understood(claim):
    _, name, *arguments = shlex.split(claim.command)
    typer.main.get_command(app_of()).commands[name].make_context(name, arguments)


def test_a_verdict_follows_the_numbers_alone():
    fig5 = CLAIMS["fig5"]
    limited = {"fastest": 1e4, "rho": 0.01, "theta": 3.0, "omega": 1.7}
    assert fig5.verdict(limited) is Verdict.LIMITED
    assert fig5.verdict({**limited, "fastest": 2.0}) is Verdict.HOLDS
    assert fig5.verdict({**limited, "rho": 100.0}) is Verdict.FAILS


def test_the_page_needs_nothing_else(tmp_path):
    page, markdown = write_report([tried("fig4"), tried("kinematics")], tmp_path)
    text = page.read_text(encoding="utf-8")
    assert "data:image/png;base64," in text
    assert not re.search(r"(src|href)=\"(?!data:|#)", text)
    assert text.index('id="kinematics"') < text.index('id="fig4"')
    assert (tmp_path / "reproduce" / "fig4.png").read_bytes().startswith(b"\x89PNG")
    assert "](reproduce/fig4.png)" in markdown.read_text(encoding="utf-8")


def test_the_command_tries_what_it_is_told(tmp_path, ended):
    done = ended("reproduce", "--only", "kinematics", "--only", "fig4", "--out", tmp_path)
    assert done.code == 0
    assert "does not hold" in done.out
    assert (tmp_path / "reproduce.html").exists()


def test_a_claim_that_is_not_known_is_one_line(refused):
    assert "'nonsense' is not one of" in refused("reproduce", "--only", "nonsense")
