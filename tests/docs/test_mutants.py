"""The mutants of a file: each is Python, and differs from it in one place."""

import ast
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MUTATE = runpy.run_path(str(ROOT / "tests" / "mutate.py"))


@pytest.mark.parametrize("part", MUTATE["PARTS"])
def test_a_part_is_all_of_its_folder_and_its_tests_are_there(part: str) -> None:
    files, tests = MUTATE["chosen"](part)
    folder = ROOT / MUTATE["PARTS"][part].files.split("*")[0]
    assert files == sorted(folder.rglob("*.py"))
    assert all((ROOT / test).exists() for test in tests)


def test_each_mutant_is_another_program() -> None:
    file = ROOT / "gateway" / "laglab_gateway" / "link" / "fates.py"
    made = list(MUTATE["mutants"](file))
    original = ast.unparse(ast.parse(file.read_text(encoding="utf-8")))
    assert len(made) > 10
    for mutant in made:
        ast.parse(mutant.text)
        assert mutant.text != original
        before, after = original.splitlines(), mutant.text.splitlines()
        assert sum(one != other for one, other in zip(before, after, strict=True)) == 1
