"""A package of one module, made from a template that already runs."""

import keyword
import re
import shlex
import shutil
from collections.abc import Mapping
from importlib import resources
from importlib.util import find_spec
from pathlib import Path
from string import Template
from typing import NamedTuple

from laglab.check import KINDS, SHIPPED, Kind
from laglab.errors import PlaceError, ScenarioError
from laglab.files import write_whole

TEMPLATES = resources.files("laglab.new") / "templates"
RUNS: Mapping[Kind, str] = {
    "estimator": "laglab run lab --estimator {name}",
    "law": "laglab run lab --law {name}",
    "plant": "laglab run lab --set plant.kind={name}",
}

RUN_BY_SETUPTOOLS = "setup"
"""A module of that name is a script to it, that makes the package."""

NUMBERS = ("inf", "nan")
"""In TOML, and so behind `--set`, these words are."""


class Made(NamedTuple):
    """What was made."""

    folder: Path
    commands: tuple[str, ...]
    """That make use of it."""


def make_package(kind: Kind, name: str, parent: Path) -> Made:
    """A package in a new folder `parent/name`: a module, an entry point and a test.

    Raises ScenarioError for a name that cannot be a package's, or is taken; PlaceError where it
    cannot go.
    """
    module = _module(name)
    told = {
        "name": name,
        "module": module,
        "class_name": _class_name(module),
        "group": KINDS[kind],
        "kind": kind,
        "kind_with_article": f"an {kind}" if kind == "estimator" else f"a {kind}",
    }
    folder = parent / name
    files = {
        "pyproject.toml": "pyproject.toml",
        f"{module}.py": f"{kind}.py",
        f"test_{module}.py": "test.py",
    }
    try:
        folder.mkdir(parents=True)
    except OSError as error:
        raise PlaceError(f"{folder} cannot be made: {error.strerror}") from error
    try:
        for file, template in files.items():
            text = (TEMPLATES / f"{template}.template").read_text(encoding="utf-8")
            write_whole(folder / file, Template(text).substitute(told))
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)  # the next attempt is to find none
        raise
    use, spelled = RUNS[kind].format(name=name), shlex.quote(str(folder))
    commands = (f"pip install -e {spelled}", f"laglab check {name}", use, f"pytest {spelled}")
    return Made(folder, commands)


def _module(name: str) -> str:
    if not re.fullmatch(r"[a-z][a-z0-9]*([-_][a-z0-9]+)*", name):
        raise ScenarioError(
            f"{name}: a package's name is of small letters and digits, with - or _ between them"
        )
    if name in NUMBERS:
        raise ScenarioError(f"{name}: a scenario reads that as a number: take another one")
    if any(name in names for names in SHIPPED.values()):
        raise ScenarioError(f"{name}: laglab has something of that name already: take another one")
    module = name.replace("-", "_")
    words = any(map(keyword.iskeyword, (module, _class_name(module))))
    if words or module == RUN_BY_SETUPTOOLS or find_spec(module) is not None:
        raise ScenarioError(f"{name}: Python has something of that name already: take another one")
    return module


def _class_name(module: str) -> str:
    return "".join(part.capitalize() for part in module.split("_"))
