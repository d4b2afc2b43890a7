"""What the user can be told on the command line, each with its exit code."""


class LaglabError(Exception):
    """Base of every error of a rehearsal; its text is one line that says what to do."""

    exit_code = 1


class ScenarioError(LaglabError):
    """A scenario cannot be found, read or believed; the text names the field."""

    exit_code = 2


class StudyError(LaglabError):
    """A study cannot be found, read or run as it is; the text names the key."""

    exit_code = 2


class MissingExtraError(LaglabError):
    """Something is not installed here; the text names the extra that brings it."""

    exit_code = 2


class UnsupportedSystemError(LaglabError):
    """The operating system lacks what is needed; the text says what."""

    exit_code = 2


class ResultsError(LaglabError):
    """What a run left cannot be read, or cannot be written; the text names the file."""

    exit_code = 4


class UndrawableError(ResultsError):
    """There is no picture, such as of numbers that are too large; the text says why."""


class NoRunError(ResultsError):
    """What is to be read is no run's; the text names the file."""

    exit_code = 2


class PlaceError(LaglabError):
    """Results cannot go where they are to go; nothing has run yet."""

    exit_code = 2


class LiveError(LaglabError):
    """The live page cannot be where it is to be; nothing has run yet."""

    exit_code = 2


class RefusedError(LaglabError):
    """A side refused to begin; the text says why."""

    exit_code = 2


class RunError(LaglabError):
    """A run was cut short: a process or the link died."""

    exit_code = 4


class WorkerDiedError(RunError):
    """Whoever did a job died of it, each time."""
