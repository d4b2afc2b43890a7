"""An FMU is an archive: what lies in it, and how it is built."""
