"""What one component takes of another is what that one offers: a name in an `__all__`."""

import ast
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = {
    "laglab_fmu": "fmu",
    "laglab_protocol": "protocol",
    "laglab_conformance": "protocol",
    "laglab_gateway": "gateway",
    "laglab_control": "controller",
    "laglab_station": "controller",
    "laglab": "rehearsal",
}
GENERATED = "laglab_protocol.dialect.generated"
"""The whole dialect, as mavgen writes it."""


def taken_by(package: str) -> Iterator[tuple[Path, str, str]]:
    """File, module and name of all that is imported from other components."""
    for path in (ROOT / PACKAGES[package] / package).rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module:
                component = node.module.partition(".")[0]
                if component in PACKAGES and component != package:
                    for name in node.names:
                        yield path, node.module, name.name


@pytest.mark.parametrize(
    "package", ["laglab_conformance", "laglab_gateway", "laglab_station", "laglab"]
)
def test_only_what_is_offered_is_taken(package: str) -> None:
    taken = [each for each in taken_by(package) if each[1] != GENERATED]
    assert taken
    hidden = [
        f"{path.relative_to(ROOT)}: {module} does not offer {name}"
        for path, module, name in taken
        if name not in getattr(import_module(module), "__all__", ())
    ]
    assert not hidden


def test_all_that_is_offered_is_there() -> None:
    for package in PACKAGES:
        offered = import_module(package)
        assert not [name for name in offered.__all__ if not hasattr(offered, name)]


SAME_WORD = {"ConfigError", "Reading"}
"""Two things each, of one meaning, in components that know nothing of each other."""


def test_one_word_has_one_meaning() -> None:
    offered: dict[str, set[int]] = {}
    for package in PACKAGES:
        module = import_module(package)
        for name in module.__all__:
            offered.setdefault(name, set()).add(id(getattr(module, name)))
    assert {name for name, things in offered.items() if len(things) > 1} == SAME_WORD
