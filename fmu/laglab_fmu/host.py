"""The compiler of this machine.

Imports nothing of ours: the build hook asks before anything is installed.
"""

import os
import shlex
import shutil


def host_compiler() -> list[str] | None:
    """Command of the host's C compiler: $CC, else cc, gcc or clang on the PATH; None without."""
    candidates = [os.environ["CC"]] if os.environ.get("CC") else ["cc", "gcc", "clang"]
    for candidate in candidates:
        words = shlex.split(candidate)
        if shutil.which(words[0]):
            return words
    return None
