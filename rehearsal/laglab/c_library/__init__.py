"""C of ours, compiled on the spot and loaded, to be held against what is not C."""

from laglab.c_library.compiling import c_library, new_folder

__all__ = ["c_library", "new_folder"]
