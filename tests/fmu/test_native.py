"""The C code by itself: under sanitizers, in a C host, compiled by a third party."""

import shutil
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest
from cmake import CMAKE_BIN_DIR
from fmpy import simulate_fmu
from fmpy.util import create_cmake_project

from laglab_fmu import BuildError, Robot, RobotParameters, c_compiler
from laglab_fmu.archive.contents import c_files, fmi_headers
from laglab_fmu.compiler import FLAGS, compile_library, host_compiler, host_platform
from laglab_fmu.models import ROBOT, token

HERE = Path(__file__).parent
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Werror"]
TICKS = 300


@pytest.fixture(scope="session")
def sources(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with all C files."""
    folder = tmp_path_factory.mktemp("sources")
    for name, text in c_files().items():
        (folder / name).write_bytes(text)
    return folder


def compile_program(sources: Path, program: Path, main: str, *arguments: str) -> None:
    command = [*c_compiler(), "-std=c99", *WARNINGS, "-ffp-contract=off", "-I", str(sources)]
    command += ["-isystem", str(fmi_headers()), str(HERE / main), "-o", str(program), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.fixture(scope="session")
def misuse(sources: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """All sources and misuse.c under the sanitizers that the compiler has."""
    program = tmp_path_factory.mktemp("misuse") / "misuse"
    kinds = "address,undefined,float-cast-overflow" if host_compiler() else "undefined"
    flags = ["-O1", "-g", f"-fsanitize={kinds}", "-fno-sanitize-recover=all"]
    compile_program(sources, program, "misuse.c", *flags, *map(str, sources.glob("*.c")), "-lm")
    return program


def test_every_build_takes_warnings_for_errors() -> None:
    assert set(WARNINGS) < set(FLAGS)


@pytest.mark.parametrize("seed", range(1, 5))
def test_random_calls_find_no_fault(misuse: Path, seed: int) -> None:
    done = subprocess.run(
        [str(misuse), str(seed), "100000"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


def test_the_sanitizers_are_awake(sources: Path, tmp_path: Path) -> None:
    """The same build finds a fault that is put in: a robot beyond the last one."""
    for source in sources.iterdir():
        shutil.copy(source, tmp_path)
    faulty = tmp_path / "values.c"
    text = faulty.read_text()
    assert "k < instance->robots; k++" in text
    faulty.write_text(text.replace("k < instance->robots; k++", "k <= instance->robots; k++"))
    program = tmp_path / "faulty"
    if not host_compiler():
        pytest.skip("ziglang has no address sanitizer")
    flags = ["-O1", "-fsanitize=address", *map(str, tmp_path.glob("*.c")), "-lm"]
    compile_program(tmp_path, program, "misuse.c", *flags)
    done = subprocess.run([str(program), "1", "1000"], capture_output=True, text=True, check=False)
    assert "AddressSanitizer: heap-" in done.stderr


@pytest.mark.skipif(host_platform().system == "windows", reason="host.c loads with dlopen")
@pytest.mark.parametrize("name", ["Robot2", "Robot3"])
def test_a_c_host_without_libm_gets_the_same_bits(
    sources: Path, extracted: dict[str, Path], tmp_path: Path, name: str
) -> None:
    platform = host_platform()
    folder = platform.fmi2_folder if name == "Robot2" else platform.fmi3_folder
    library = extracted[name] / "binaries" / folder / f"{ROBOT.name}{platform.suffix}"
    compile_program(sources, tmp_path / "host", "host.c", "-ldl")
    done = subprocess.run(
        [str(tmp_path / "host"), str(library), str(TICKS)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    with Robot.open(3, RobotParameters()) as robot:
        for _ in range(TICKS):
            reading = robot.step(4.0, 9.0)
    lines = [tuple(map(float.fromhex, line.split())) for line in done.stdout.splitlines()]
    assert lines == [reading[:3], reading[:3]]


@pytest.mark.parametrize("name", ROBOT.fmus)
def test_a_third_party_compiles_what_is_inside(
    extracted: dict[str, Path], tmp_path: Path, name: str
) -> None:
    """Only files out of the FMU, as its own lists say; the library loads and is this model's."""
    folder = extracted[name] / "sources"
    if name == "Robot2":
        model = ElementTree.parse(extracted[name] / "modelDescription.xml")
        listed = [file.get("name") for file in model.findall("CoSimulation/SourceFiles/File")]
        assert listed == [
            file.get("name") for file in model.findall("ModelExchange/SourceFiles/File")
        ]
    else:
        build = ElementTree.parse(folder / "buildDescription.xml")
        listed = [file.get("name") for file in build.findall(".//SourceFile")]
        assert [library.get("name") for library in build.findall(".//Library")] == ["m"]
    assert sorted(path.name for path in folder.glob("*.c")) == listed
    library = tmp_path / f"{ROBOT.name}{host_platform().suffix}"
    command = [*c_compiler(), "-std=c99", "-shared", "-fPIC", "-o", str(library)]
    subprocess.run([*command, *map(str, listed), "-lm"], check=True, cwd=folder)
    assert token(name).encode() in library.read_bytes()


@pytest.mark.skipif(
    not (host_compiler() and shutil.which("make")), reason="cmake brings neither compiler nor make"
)
@pytest.mark.parametrize("name", ROBOT.fmus)
def test_fmpy_s_cmake_project_compiles_and_packs_it_again(
    fmus: dict[str, Path], tmp_path: Path, name: str
) -> None:
    """FMPy defines CO_SIMULATION and the like as macros, and names the target by the identifier."""
    create_cmake_project(str(fmus[name]), str(tmp_path))
    shutil.rmtree(tmp_path / "binaries")
    for arguments in (["."], ["--build", "."]):
        command = [str(Path(CMAKE_BIN_DIR) / "cmake"), *arguments]
        done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
        assert done.returncode == 0, done.stdout + done.stderr
    result = simulate_fmu(str(tmp_path / f"{name[:-1]}.fmu"), stop_time=0.1)
    assert result["x_meas"][-1] != 0.0


def test_warnings_do_fail_a_build(tmp_path: Path) -> None:
    source = tmp_path / "unused.c"
    source.write_text("static int unused(void) { return 0; }\n")
    with pytest.raises(BuildError, match="unused"):
        compile_library(tmp_path, [source.name], "unused.so", c_compiler())
