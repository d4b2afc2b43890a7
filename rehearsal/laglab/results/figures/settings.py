"""matplotlib with settings of our own, whatever the user's are."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from contextvars import ContextVar

import numpy as np

from laglab.errors import UndrawableError

BACKEND = "MPLBACKEND"
FILES = ("pdf.", "pgf.", "ps.", "savefig.", "svg.")
"""How the names of the settings begin that say how a file is written, not how a picture looks."""
_within: ContextVar[bool] = ContextVar("_within", default=False)


def load() -> None:
    """Have matplotlib loaded. It refuses a backend that it does not know, though we draw on none of
    the user's. Raises UndrawableError: it cannot read the user's settings."""
    if "matplotlib" in sys.modules:
        return
    wanted = os.environ.pop(BACKEND, None)
    try:
        import matplotlib
    except ValueError as error:
        raise UndrawableError(f"matplotlib cannot read its matplotlibrc: {error}") from error
    finally:
        if wanted is not None:
            os.environ[BACKEND] = wanted
    if wanted:
        with suppress(ValueError):
            matplotlib.rcParams["backend"] = wanted


@contextmanager
def plain(more: Mapping[str, object] | None = None) -> Iterator[None]:
    """Whatever is drawn or written within looks as matplotlib has it, but for these settings.
    Numbers too large for an axis are told when the figure is saved, not by numpy."""
    with _settings(), np.errstate(over="ignore", invalid="ignore"), warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing from font")  # a box stands for it
        from matplotlib import rcParams

        rcParams.update(more or {})  # type: ignore[arg-type]
        outer = _within.set(True)
        try:
            yield
        finally:
            _within.reset(outer)


@contextmanager
def drawn() -> Iterator[None]:
    """What is drawn within when others show or write it looks as matplotlib has it, too: only how
    a file is written is theirs to say. Where `plain` says how all looks, it stays so."""
    if _within.get():
        yield
        return
    with _settings(but=FILES):
        yield


@contextmanager
def _settings(but: tuple[str, ...] = ()) -> Iterator[None]:
    """matplotlib's own but those that begin so; the backend is no matter of looks."""
    load()
    from matplotlib import rc_context, rcParamsDefault

    kept = ("backend", *but)
    with rc_context({k: v for k, v in rcParamsDefault.items() if not k.startswith(kept)}):
        yield
