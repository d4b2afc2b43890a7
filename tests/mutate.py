"""Mutation tests, on demand: does a test fail when the code is wrong?

    python tests/mutate.py estimators|queues|receiver|FILE [--sample 40] [--seed 1]

Changes one operator, comparison, number or condition at a time, in a copy of the repository, and
runs the tests of that part until one fails. What survives is printed: a test that is missing, or a
change that changes nothing, which a reader must tell apart.
"""

import argparse
import ast
import copy
import os
import random
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from itertools import count
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
SECONDS = count(1_000_000_000)
COMPONENTS = ("fmu", "protocol", "gateway", "controller", "rehearsal")


class Part(NamedTuple):
    """Files that are changed, and the tests that are to notice."""

    files: str
    tests: tuple[str, ...]


PARTS = {
    "estimators": Part(
        "controller/laglab_control/estimators/**/*.py",
        tuple(f"tests/controller/test_{name}.py" for name in (
            "by_hand", "forgetting", "backdated", "delayed", "calibrated", "estimators_stand",
            "linear", "exact", "errata", "sliding", "tue_predictor", "rewinding", "estimators",
            "known_facts", "calibrating",
        )),
    ),
    "queues": Part(
        "gateway/laglab_gateway/link/*.py",
        ("tests/gateway/link", "tests/gateway/test_core.py", "tests/gateway/test_any_peer.py"),
    ),
    "receiver": Part(
        "protocol/laglab_protocol/framing/*.py",
        tuple(f"tests/protocol/test_{name}.py" for name in (
            "receiver", "nested", "golden", "signing", "beside_pymavlink",
        )),
    ),
}  # fmt: skip

SWAPS: dict[type[ast.AST], type[ast.AST]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Add, ast.Div: ast.Mult, ast.MatMult: ast.Add,
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt,
    ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
    ast.In: ast.NotIn, ast.NotIn: ast.In, ast.And: ast.Or, ast.Or: ast.And,
    ast.USub: ast.UAdd,
}  # fmt: skip


CHANGED = (
    *(ast.BinOp, ast.BoolOp, ast.UnaryOp, ast.Compare),
    *(ast.Constant, ast.If, ast.IfExp, ast.While),
)


class Mutant(NamedTuple):
    """A file with one thing in it changed."""

    file: str
    line: int
    change: str
    text: str


def mutants(file: Path) -> Iterator[Mutant]:
    """All of a file."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    for i, place in enumerate(ast.walk(tree)):
        if not isinstance(place, CHANGED):
            continue
        changed = copy.deepcopy(tree)
        node = list(ast.walk(changed))[i]
        if (said := _change(node)) is not None:
            line = getattr(node, "lineno", 0)
            yield Mutant(str(file.relative_to(ROOT)), line, said, ast.unparse(changed))


def _change(node: ast.AST) -> str | None:
    """Changes a node of the tree: what was done to it, None if nothing is done to such."""
    before = ast.unparse(node)
    if isinstance(node, ast.BinOp | ast.BoolOp | ast.UnaryOp) and type(node.op) in SWAPS:
        node.op = SWAPS[type(node.op)]()  # type: ignore[assignment]
    elif isinstance(node, ast.Compare) and type(node.ops[0]) in SWAPS:
        node.ops[0] = SWAPS[type(node.ops[0])]()  # type: ignore[call-overload]
    elif isinstance(node, ast.Constant) and type(node.value) in (int, float, bool):
        node.value = not node.value if isinstance(node.value, bool) else node.value + 1
    elif isinstance(node, ast.If | ast.IfExp | ast.While):
        before = ast.unparse(node.test)
        node.test = ast.UnaryOp(ast.Not(), node.test)
        return f"{before}  →  not ({before})"
    else:
        return None
    return f"{before}  →  {ast.unparse(node)}"


def survives(mutant: Mutant, copy_of_all: Path, tests: tuple[str, ...]) -> bool:
    """Whether no test fails, or takes so long that something must be wrong."""
    file = copy_of_all / mutant.file
    original = file.read_text(encoding="utf-8")
    _write(file, mutant.text)
    try:
        return passes(copy_of_all, tests)
    finally:
        _write(file, original)


def _write(file: Path, text: str) -> None:
    """At a time of its own: compiled code is taken for a file's if size and second are the same."""
    file.write_text(text, encoding="utf-8")
    at = next(SECONDS)
    os.utime(file, (at, at))


def passes(folder: Path, tests: tuple[str, ...]) -> bool:
    """Runs the tests on the code in a folder, until one fails."""
    paths = os.pathsep.join(str(folder / component) for component in COMPONENTS)
    command = [sys.executable, "-B", "-m", "pytest", "-n0", "-x", "-q", "--timeout=60", *tests]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    environment = os.environ | {"PYTHONPATH": paths}
    done = subprocess.run(command, cwd=folder, env=environment, check=False, **quiet)
    return done.returncode == 0


def copied(folder: Path) -> Path:
    """The work tree as git sees it, and the FMUs that were built in it."""
    listed = subprocess.check_output(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, text=True
    )
    built = [str(path.relative_to(ROOT)) for path in ROOT.glob("fmu/laglab_fmu/*.fmu")]
    for name in [*listed.rstrip("\0").split("\0"), *built]:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, folder / name)
    return folder


def main() -> None:
    """Tries a part, and prints what survived."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("part", help=f"one of {', '.join(PARTS)}, or a file of one of them")
    parser.add_argument("--sample", type=int, default=40, help="how many mutants; 0: all")
    parser.add_argument("--seed", type=int, default=1, help="which")
    asked = parser.parse_args()
    files, tests = chosen(asked.part)
    every = [mutant for file in files for mutant in mutants(file)]
    random.Random(asked.seed).shuffle(every)
    tried = every[: asked.sample or None]
    with tempfile.TemporaryDirectory() as folder:
        place = copied(Path(folder, "copy"))
        if not passes(place, tests):
            sys.exit("the tests fail without any change: mend that first")
        survived = sum(told(mutant, survives(mutant, place, tests)) for mutant in tried)
    print(f"{len(tried) - survived} of {len(tried)} noticed, of {len(every)} that there are")


def chosen(part: str) -> tuple[list[Path], tuple[str, ...]]:
    """The files and tests of a part, or one of its files with the same tests."""
    if part in PARTS:
        return sorted(ROOT.glob(PARTS[part].files)), PARTS[part].tests
    file = Path(part).resolve()
    for known in PARTS.values():
        if file in ROOT.glob(known.files):
            return [file], known.tests
    sys.exit(f"{part}: take one of {', '.join(PARTS)}, or a file of one of them")


def told(mutant: Mutant, survived: bool) -> bool:
    """Prints a mutant that survived."""
    if survived:
        print(f"{mutant.file}:{mutant.line}: {mutant.change}", flush=True)
    return survived


if __name__ == "__main__":
    main()
