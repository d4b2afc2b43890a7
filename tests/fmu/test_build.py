"""What a build makes."""

import hashlib
import zipfile
from pathlib import Path

import pytest
from fmpy import read_model_description

from laglab_fmu import (
    BuildError,
    CompilerNotFoundError,
    RobotParameters,
    build_fmus,
    c_compiler,
)
from laglab_fmu import compiler as compiler_module
from laglab_fmu.archive import contents


def test_twice_the_same_bytes(fmus: dict[str, Path], tmp_path: Path) -> None:
    for path in build_fmus(tmp_path / "again"):
        assert (
            hashlib.sha256(path.read_bytes()).digest()
            == hashlib.sha256(fmus[path.stem].read_bytes()).digest()
        )


def test_the_library_asks_for_libm(fmus: dict[str, Path]) -> None:
    with zipfile.ZipFile(fmus["Robot3"]) as archive:
        binary = next(name for name in archive.namelist() if name.startswith("binaries/"))
        if binary.endswith(".so"):
            assert b"libm.so.6" in archive.read(binary)


def test_both_versions_tell_the_same_of_every_variable(fmus: dict[str, Path]) -> None:
    two, three = (read_model_description(str(fmus[name])) for name in ("Robot2", "Robot3"))

    def table(model: object) -> list[tuple[object, ...]]:
        return [
            (v.name, v.valueReference, v.causality, v.variability, v.start, v.min, v.max, v.nominal)
            for v in model.modelVariables  # type: ignore[attr-defined]
            if v.name != "time"
        ]

    assert table(two) == table(three)


@pytest.mark.parametrize("name", ["Robot2", "Robot3"])
def test_a_robot_left_alone_has_the_default_parameters(fmus: dict[str, Path], name: str) -> None:
    variables = read_model_description(str(fmus[name])).modelVariables
    starts = {v.name: v.start for v in variables if v.variability == "fixed"}
    truth = {"true": 1.0, "false": 0.0}
    told = {key: truth[start] if start in truth else float(start) for key, start in starts.items()}
    assert told == RobotParameters().by_name()


def test_the_compiler_is_the_one_asked_for_and_ziglang_the_last(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    for name in ("gcc", "other"):
        (tmp_path / name).touch(mode=0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("CC", "other -m64")
    assert c_compiler() == ["other", "-m64"]
    monkeypatch.setenv("CC", " ")
    assert c_compiler() == ["gcc"]
    for none_at_all in ("another -m64", 'other "-m64'):
        monkeypatch.setenv("CC", none_at_all)
        with pytest.raises(CompilerNotFoundError, match=r"CC=.*correct or unset it"):
            c_compiler()
    monkeypatch.delenv("CC")
    monkeypatch.setenv("PATH", str(tmp_path / "empty"))
    assert c_compiler()[1:4] == ["-m", "ziglang", "cc"]


def test_without_any_compiler_it_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(compiler_module, "find_spec", lambda _: None)
    with pytest.raises(CompilerNotFoundError, match="pip install ziglang"):
        build_fmus(tmp_path)


def test_a_failing_compiler_is_quoted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    source = tmp_path / "src"
    source.mkdir()
    (source / "robot.c").write_text("int broken(void) { return undeclared; }\n")
    monkeypatch.setattr(contents, "own_files", lambda folder: tmp_path / folder)
    with pytest.raises(BuildError, match="undeclared"):
        build_fmus(tmp_path / "out")
    assert not (tmp_path / "out").exists()
