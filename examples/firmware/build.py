"""Build the firmware for this computer: `python build.py [FOLDER]`, into build/ otherwise.

CFLAGS in the environment are added to our own.
"""

import os
import shlex
import subprocess
from argparse import ArgumentParser
from pathlib import Path

from laglab_fmu import c_compiler
from laglab_protocol.dialect.mavgen import dialect_path, generate

HERE = Path(__file__).parent
STRICT = ("-std=c99", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Werror")


def build(folder: Path) -> Path:
    """mavgen's headers and the firmware into `folder`; returns the program."""
    generate(dialect_path(), "C", folder / "include")
    program = folder / "firmware"
    sources = sorted(HERE.glob("*.c"))
    flags = [*STRICT, *shlex.split(os.environ.get("CFLAGS", "")), "-isystem", folder / "include"]
    command = [*c_compiler(), *flags, *sources, "-lm", "-o", program]
    subprocess.run(command, check=True)
    return program


if __name__ == "__main__":
    parser = ArgumentParser(description="Build the firmware for this computer.")
    parser.add_argument("folder", nargs="?", type=Path, default=HERE / "build")
    print(build(parser.parse_args().folder))
