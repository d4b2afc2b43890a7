"""An FMU is an archive: what lies in it, and how it is built."""

from laglab_fmu.archive.contents import c_files

__all__ = ["c_files"]
