"""What can go wrong when a link is measured."""

from laglab.errors import LaglabError


class LinkFileError(LaglabError):
    """A file tells nothing of a link that could be read; the text names it."""

    exit_code = 2


class LinkPlaceError(LaglabError):
    """A link cannot be measured from here; the text says from where."""

    exit_code = 2


class NobodyAnswersError(LaglabError):
    """Nothing comes from the far end."""

    exit_code = 4


class BegunAgainError(LaglabError):
    """The far end was started again while the link was measured."""

    exit_code = 4
