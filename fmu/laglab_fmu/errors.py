"""What can go wrong with the FMU: one tree."""


class FmuError(Exception):
    """Base of this component's errors: what happened, to what, and what to do."""


class BuildError(FmuError):
    """The FMU could not be built."""


class CompilerNotFoundError(BuildError):
    """There is neither a C compiler nor ziglang."""


class FmuNotBuiltError(FmuError):
    """The FMU file is not where the installation should have put it."""


class FmuFileError(FmuError):
    """Somebody's FMU cannot be used here, or not so; names the file and what is in the way."""


class WiringError(FmuFileError):
    """A name in a `Wiring` is of no variable, or of one that does not do; the text begins with the
    key in it."""


class CallError(FmuError):
    """The FMU refused a call; carries what it logged."""
