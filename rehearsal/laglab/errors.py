"""What the user can be told on the command line, each with its exit code."""


class LaglabError(Exception):
    """Base of every error of a rehearsal; its text is one line that says what to do."""

    exit_code = 1


class ScenarioError(LaglabError):
    """A scenario cannot be found, read or believed; the text names the field."""

    exit_code = 2


class MissingExtraError(LaglabError):
    """Something is not installed here; the text names the extra that brings it."""

    exit_code = 2


class RunError(LaglabError):
    """A run was cut short: a process or the link died."""

    exit_code = 4
