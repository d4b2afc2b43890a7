"""The mutants of a file: each is Python, and differs from it in one place."""

import ast
import runpy
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_each_mutant_is_another_program() -> None:
    mutants = runpy.run_path(str(ROOT / "tests" / "mutate.py"))["mutants"]
    file = ROOT / "gateway" / "laglab_gateway" / "link" / "fates.py"
    made = list(mutants(file))
    original = ast.unparse(ast.parse(file.read_text(encoding="utf-8")))
    assert len(made) > 10
    for mutant in made:
        ast.parse(mutant.text)
        assert mutant.text != original
        before, after = original.splitlines(), mutant.text.splitlines()
        assert sum(one != other for one, other in zip(before, after, strict=True)) == 1
