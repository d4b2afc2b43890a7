"""The pages in docs/ and the code agree: links, names, commands and equation numbers exist."""

import ast
import inspect
import pkgutil
import re
import shlex
import tokenize
from collections.abc import Iterator
from pathlib import Path
from typing import get_args

import pytest
import typer

import laglab
from laglab.command import app_of
from laglab.export.formats import FORMATS, FormatName
from laglab.live import spelled_out
from laglab.results.meaning import LINK
from laglab.results.shadows import COLUMNS
from laglab.studies.judged import Judgements
from laglab_control import ESTIMATORS, Erratum, PolarLaw, delay_margin
from laglab_control.estimators.paper.popf import delay_limit
from laglab_gateway import ROWS, FateKind, TraceRow
from laglab_gateway.drive import Rejection

ROOT = Path(__file__).parents[2]
COMPONENTS = ("fmu", "protocol", "gateway", "controller", "rehearsal", "examples", "tests", "docs")
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("[a-z]*/**/*.md")])
THEORY = (ROOT / "docs" / "theory.md").read_text(encoding="utf-8")
GLOSSARY = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")

EQUATION = re.compile(r"(?<![\w)\]])\((\d{1,2})\)")
CITED_PAGE = re.compile(r"\bdocs/[\w/-]+\.md")


def named(path: Path) -> str:
    return str(path.relative_to(ROOT))


def prose(page: Path) -> str:
    """The page without its blocks of code."""
    return re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)


def blocks(page: str) -> list[str]:
    return re.findall(r"^```\w*\n(.*?)^```", page, flags=re.M | re.S)


def anchors(page: Path) -> set[str]:
    """What a forge makes of the headings: lower case, hyphens, nothing but words."""
    headings = re.findall(r"^#+ (.*)$", prose(page), flags=re.M)
    return {re.sub(r"[^\w -]", "", each.lower()).replace(" ", "-") for each in headings}


def table(page: str, heading: str) -> list[list[str]]:
    """The cells of the first table below a heading, without its head."""
    found = re.search(r"(^\|.*\n)+", page[page.index(f"## {heading}\n") :], flags=re.M)
    assert found, f"no table below {heading}"
    return [[cell.strip() for cell in row[1:-1].split("|")] for row in found[0].splitlines()[2:]]


def comments(path: Path) -> Iterator[str]:
    """Docstrings and comments of a Python file."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            yield str(node.value.value)
    with path.open("rb") as file:
        for token in tokenize.tokenize(file.readline):
            if token.type == tokenize.COMMENT:
                yield token.string


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_links_lead_somewhere(page: Path) -> None:
    for link in re.findall(r"\]\(([^)\s]+)\)", prose(page)):
        if re.match(r"\w+:", link):
            continue
        place, _, anchor = link.partition("#")
        target = (page.parent / place).resolve() if place else page
        assert target.exists(), link
        assert not anchor or anchor in anchors(target), link


def sources(*patterns: str) -> list[Path]:
    folders = (ROOT / component for component in COMPONENTS)
    return [path for each in folders for pattern in patterns for path in each.rglob(pattern)]


def test_pages_that_the_code_cites_are_there() -> None:
    cited = {
        (named(path), page)
        for path in sources("*.py", "*.c", "*.h", "*.toml")
        for page in CITED_PAGE.findall(path.read_text(encoding="utf-8"))
    }
    assert len(cited) > 20
    assert not {(path, page) for path, page in cited if not (ROOT / page).exists()}


@pytest.mark.parametrize("page", ["CONTRIBUTING.md", "docs/architecture.md", "docs/releasing.md"])
def test_sources_that_a_page_for_maintainers_names_are_there(page: str) -> None:
    said = re.findall(r"`([\w/]+(?:\.(?:py|xml)|/))`", prose(ROOT / page))
    there = [f"/{named(each)}" for each in [*ROOT.glob("*/"), *sources("*.py", "*.xml", "*/")]]
    ends = tuple(f"/{each.rstrip('/')}" for each in said)
    assert not [end for end in ends if not any(each.endswith(end) for each in there)]
    assert ends


def test_every_fate_and_every_reason_for_not_following_a_command_is_told() -> None:
    ways = [each.value for each in (*FateKind, *Rejection)]
    page = (ROOT / "docs" / "reference" / "files.md").read_text(encoding="utf-8")
    assert not [each for each in ways if f"`{each}`" not in page]
    (fate,) = [column.sentence for column in LINK if column.name == "fate"]
    assert re.findall("`(.*?)`", fate) == list(FateKind)


def test_every_estimator_has_a_row_on_its_page_and_every_format_one_on_its() -> None:
    of_the_station = (ROOT / "controller" / "README.md").read_text(encoding="utf-8")
    first = of_the_station.split("\n## ")[0]
    assert re.findall(r"^\| `(.*?)` \|", first, flags=re.M) == list(ESTIMATORS)
    of_exports = (ROOT / "docs" / "export.md").read_text(encoding="utf-8").split("\n## ")[0]
    assert re.findall(r"^\| `(.*?)` \|", of_exports, flags=re.M) == list(FORMATS)
    assert get_args(FormatName) == tuple(FORMATS)


def test_the_arguments_of_a_run_are_those_of_the_code() -> None:
    page = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    told = re.search(r"^`laglab\.run\((.*?)\)`", page, flags=re.M | re.S)
    assert told
    names = [each.split("=")[0].strip() for each in told[1].split(",")]
    assert [name for name in names if name != "*"] == list(inspect.signature(laglab.run).parameters)


def test_the_equations_are_all_there_each_once() -> None:
    lines = [line for block in blocks(THEORY) for line in block.splitlines()]
    numbers = [int(found[1]) for line in lines if (found := re.search(r" \((\d+)\)$", line))]
    assert sorted(numbers) == list(range(1, 34))


@pytest.mark.parametrize("component", ["controller", "fmu", "rehearsal"])
def test_equations_that_the_code_cites_are_there(component: str) -> None:
    there = {int(number) for block in blocks(THEORY) for number in EQUATION.findall(block)}
    cited = {
        (named(path), int(number))
        for path in (ROOT / component).rglob("*.py")
        for text in comments(path)
        for number in EQUATION.findall(text)
    }
    assert cited
    assert not {(path, number) for path, number in cited if number not in there}


def test_every_switch_of_the_errata_is_in_their_table() -> None:
    rows = {row[0] for row in table(THEORY, "Errata")}
    assert {erratum.equation for erratum in Erratum} <= rows


def test_the_delay_limits_are_those_of_the_code() -> None:
    for m, largest in table(THEORY, "The delay limit of the gain"):
        assert f"{delay_limit(int(m)):.3f}" == largest


def test_the_delay_margins_are_those_of_the_code() -> None:
    for gains, *margins in table(THEORY, "The loop's delay margin"):
        lambda_, h, gamma = (float(gain) for gain in gains.split(","))
        law = PolarLaw(lambda_=lambda_, h=h, gamma=gamma, goal_tolerance=0.03)
        assert [int(margin) for margin in margins] == list(delay_margin(law, 0.01))


def test_each_word_has_one_meaning() -> None:
    words = re.findall(r"^\| ([^|]+) \| [A-Z]", GLOSSARY, flags=re.M)
    assert len(words) > 50
    assert len(words) == len(set(words))


GROUPS = ("laglab.estimators", "laglab.laws", "laglab.plants")
"""Of entry points: they look like modules, and are none."""


def names() -> list[str]:
    found = [re.findall(r"`(laglab(?:_\w+)?(?:\.\w+)*)`", prose(page)) for page in PAGES]
    said = {name for each in found for name in each if "_" in name or "." in name}
    return sorted(said - {"laglab.xml", *GROUPS})


@pytest.mark.parametrize("name", names())
def test_names_in_the_pages_exist(name: str) -> None:
    pkgutil.resolve_name(name)


def commands() -> list[str]:
    """Those in the text; those in blocks of their own are run (`test_blocks.py`)."""
    pages = [page for page in ROOT.glob("docs/**/*.md") if page.parent.name != "reference"]
    found = [re.findall(r"`laglab ([a-z][^`]*)`", prose(page)) for page in pages]
    return sorted({re.sub(r"\s+", " ", command) for each in found for command in each})


@pytest.mark.parametrize("command", commands())
def test_commands_in_the_pages_are_understood(command: str) -> None:
    """Read as typed, and not run: some of them take a minute."""
    group = typer.main.get_command(app_of())
    name, *arguments = shlex.split(command)
    found = group.commands[name]  # type: ignore[attr-defined]
    if arguments:
        found.make_context(name, spelled_out(arguments))


RUN_ELSEWHERE = {
    "docs/bring-your-own.md": "tests/docs/test_bring_your_own.py, beside the files of the page",
    "docs/rivals.md": "tests/rehearsal/test_rivals.py, with fewer seeds",
    "examples/firmware/README.md": "tests/gateway, on ports of its own",
}
"""Pages whose commands are indented lines, and what runs them."""


def test_commands_that_nobody_runs_are_no_indented_lines() -> None:
    """Which `test_blocks.py` passes over: in a block of their own they are run."""
    loose = {named(page) for page in PAGES if re.search(r"^(?: {4,}|\t)laglab ", prose(page), re.M)}
    assert loose == set(RUN_ELSEWHERE)
    assert all((ROOT / by.split(",")[0]).exists() for by in RUN_ELSEWHERE.values())


def test_every_column_of_a_run_s_files_is_documented() -> None:
    described: dict[str, set[str]] = {}
    page = (ROOT / "docs" / "reference" / "files.md").read_text("utf-8")
    file = ""
    for cells in table(page, "Columns"):
        file = cells[0].strip("`") or file
        described.setdefault(file, set()).update(re.findall("`(.*?)`", cells[1]))
    assert described.pop("trace.csv") == set(TraceRow._fields)
    assert described.pop("shadow-NAME.csv") == set(COLUMNS)
    assert described == {name: set(kind._fields) for name, kind in ROWS.items()}


def test_every_column_of_a_study_is_documented() -> None:
    page = (ROOT / "docs" / "studies.md").read_text(encoding="utf-8")
    _, *rows = table(page, "What it leaves")  # the grid's keys come first
    columns = [name for cells in rows for name in re.findall("`(.*?)`", cells[0])]
    start = ["seed", "start_x", "start_y", "start_theta"]
    assert sorted(columns) == sorted([*start, *Judgements._fields])
