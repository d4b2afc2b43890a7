"""Cross-building with ziglang, and which binary a machine loads."""

import hashlib
import platform as this_platform
import struct
import subprocess
import zipfile
from pathlib import Path

import pytest

from laglab_fmu import BuildError, build_fmus
from laglab_fmu.archive.contents import c_files, fmi_headers
from laglab_fmu.archive.mach_o import commands, signed
from laglab_fmu.compiler import FLAGS, PLATFORMS, Platform, host_platform, zig_compiler

BY_FOLDER = {platform.fmi3_folder: platform for platform in PLATFORMS}
WINDOWS = [platform for platform in PLATFORMS if platform.system == "windows"]
LINKED = [platform for platform in PLATFORMS if platform not in WINDOWS]


def machine_of(library: bytes) -> tuple[str, int]:
    """File format and its number for the processor."""
    if library.startswith(b"\x7fELF"):
        return "ELF", struct.unpack_from("<H", library, 18)[0]
    if library.startswith(b"\xcf\xfa\xed\xfe"):
        return "Mach-O", struct.unpack_from("<I", library, 4)[0]
    assert library.startswith(b"MZ")
    header = struct.unpack_from("<I", library, 0x3C)[0]
    return "PE", struct.unpack_from("<H", library, header + 4)[0]


def parts_of(library: bytes) -> list[bytes]:
    """What a universal library holds."""
    magic, count = struct.unpack_from(">II", library)
    assert magic == 0xCAFEBABE
    places = [struct.unpack_from(">II", library, 8 + 20 * i + 8) for i in range(count)]
    return [library[offset : offset + size] for offset, size in places]


def check_signature(library: bytes) -> int:
    """Recomputes the hash of every page; returns the flags, of which 2 is ad hoc."""
    [place] = [place for command, place in commands(library) if command == 0x1D]
    offset, size = struct.unpack_from("<II", library, place + 8)
    assert len(library) == offset + size
    magic, length, _, _, start = struct.unpack_from(">5I", library, offset)
    assert magic == 0xFADE0CC0
    assert length <= size
    directory = library[offset + start :]
    magic, _, _, flags, hashes, _, _, count, limit = struct.unpack_from(">9I", directory)
    assert magic == 0xFADE0C02
    assert limit == offset
    page = 1 << directory[39]
    for i in range(count):
        code = library[i * page : min((i + 1) * page, limit)]
        assert directory[hashes + 32 * i :][:32] == hashlib.sha256(code).digest()
    assert count == -(-limit // page)
    return int(flags)


MACHINES = {
    "x86_64-linux": ("ELF", 62),
    "aarch64-linux": ("ELF", 183),
    "x86_64-windows": ("PE", 0x8664),
    "aarch64-windows": ("PE", 0xAA64),
    "x86_64-darwin": ("Mach-O", 0x01000007),
    "aarch64-darwin": ("Mach-O", 0x0100000C),
}


MACS = [MACHINES["x86_64-darwin"], MACHINES["aarch64-darwin"]]


def test_the_platforms_are_those() -> None:
    assert set(BY_FOLDER) == set(MACHINES)


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_one_fmu_carries_several_platforms_twice_the_same(tmp_path: Path) -> None:
    first, again = (build_fmus(tmp_path / name, LINKED) for name in ("first", "again"))
    for one, other in zip(first, again, strict=True):
        assert one.read_bytes() == other.read_bytes()
        with zipfile.ZipFile(one) as archive:
            for platform in LINKED:
                old = one.stem.endswith("2")
                folder = platform.fmi2_folder if old else platform.fmi3_folder
                library = archive.read(f"binaries/{folder}/{one.stem[:-1]}{platform.suffix}")
                if platform.system == "darwin":
                    parts = parts_of(library)
                    assert [machine_of(part) for part in parts] == MACS
                    assert all(check_signature(part) & 2 for part in parts)
                    continue
                assert machine_of(library) == MACHINES[platform.fmi3_folder]
                if platform.system == "linux":
                    newer = [f"GLIBC_2.{minor}\0".encode() for minor in range(18, 60)]
                    assert not any(version in library for version in newer)


@pytest.mark.slow
@pytest.mark.parametrize("windows", WINDOWS, ids=lambda platform: platform.fmi3_folder)
def test_the_sources_compile_for_windows(tmp_path: Path, windows: Platform) -> None:
    """To link for Windows, ziglang first builds that platform's C library, which takes minutes."""
    for name, text in c_files().items():
        (tmp_path / name).write_bytes(text)
    names = sorted(path.name for path in tmp_path.glob("*.c"))
    for name in names:
        command = [*zig_compiler(windows), *FLAGS, "-isystem", str(fmi_headers()), "-c", name]
        subprocess.run(command, check=True, cwd=tmp_path)
        assert (
            struct.unpack_from("<H", next(tmp_path.glob(f"{name[:-2]}.o*")).read_bytes())[0]
            == (MACHINES[windows.fmi3_folder][1])
        )


@pytest.mark.parametrize(
    ("system", "machine", "folder"),
    [
        ("Linux", "x86_64", "x86_64-linux"),
        ("Linux", "aarch64", "aarch64-linux"),
        ("Windows", "AMD64", "x86_64-windows"),
        ("Windows", "ARM64", "aarch64-windows"),
        ("Darwin", "x86_64", "x86_64-darwin"),
        ("Darwin", "arm64", "aarch64-darwin"),
    ],
)
def test_each_machine_finds_its_own(
    monkeypatch: pytest.MonkeyPatch, system: str, machine: str, folder: str
) -> None:
    monkeypatch.setattr(this_platform, "system", lambda: system)
    monkeypatch.setattr(this_platform, "machine", lambda: machine)
    assert host_platform() == BY_FOLDER[folder]


def test_an_unknown_machine_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(this_platform, "machine", lambda: "riscv64")
    with pytest.raises(BuildError, match="riscv64"):
        host_platform()


def test_fmi_2_folders_tell_processors_apart() -> None:
    folders = [platform.fmi2_folder for platform in PLATFORMS]
    assert folders[:3] == ["linux64", "aarch64-linux", "win64"]
    assert folders[3:] == ["aarch64-windows", "darwin64", "aarch64-darwin"]


def test_what_is_no_library_for_macos_is_not_signed() -> None:
    with pytest.raises(BuildError, match="not a 64-bit Mach-O"):
        signed(b"\x7fELF".ljust(64), "Robot")
