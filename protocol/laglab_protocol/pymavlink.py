"""pymavlink's own programs with our dialect: `python -m laglab_protocol.pymavlink mavlogdump LOG`.

The first argument is the name of one of pymavlink's tools, or the path of a program made with
pymavlink, such as mavproxy.py; the others are passed on, and `--dialect=laglab` with them.
"""

import os
import runpy
import shutil
import sys
from importlib.util import find_spec
from pathlib import Path

from laglab_protocol.dialect.mavgen import offer_to_pymavlink


def main(arguments: list[str]) -> None:
    """Run the program in this process, as if it had been called itself."""
    if not arguments:
        sys.exit(__doc__)
    os.environ["MAVLINK20"] = "1"  # read by pymavlink when it is imported
    program, *rest = arguments
    sys.argv = [Path(program).name, "--dialect=laglab", *rest]
    offer_to_pymavlink()
    if Path(program).suffix == ".py":
        path = program if Path(program).is_file() else shutil.which(program)
        if path is None:
            sys.exit(f"{program}: no such program here, nor on the PATH")
        runpy.run_path(path, run_name="__main__")
    elif program.isidentifier() and find_spec(tool := f"pymavlink.tools.{program}"):
        runpy.run_module(tool, run_name="__main__")
    else:
        sys.exit(f"{program}: no tool of pymavlink's, nor a path that ends in .py")


if __name__ == "__main__":
    main(sys.argv[1:])
