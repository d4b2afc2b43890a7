"""Calling what users bring: whatever goes wrong in it is an error of ours that names it."""

import inspect
from typing import Any

from laglab_control.errors import PluginError, PluginFailedError, StampError
from laglab_control.plugins.finding import Maker
from laglab_control.plugins.wording import failure, one_line


def made(name: str, maker: Maker, *told: object, **options: object) -> object:
    """What `maker` makes of what it is told. Raises PluginError when it fails."""
    try:
        return maker(*told, **options)
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # it is a stranger's
        raise PluginError(f"{name} cannot be made: {failure(error)}") from error


def refuse_misfit(name: str, brought: object, method: str, *parameters: str) -> None:
    """Raises PluginError unless `brought` has the method, and it takes so many parameters."""
    try:
        function = getattr(brought, method, None)
    except Exception as error:
        raise PluginError(f"{name}.{method}: {one_line(error)}") from error
    wanted = f"{method}({', '.join(parameters)})"
    if not callable(function):
        raise PluginError(f"{name} has no method {wanted}")
    try:
        inspect.signature(function).bind(*parameters)
    except TypeError as error:
        raise PluginError(f"{name}.{method} must be {wanted}: {error}") from None
    except ValueError:
        return  # it is not written in Python: time will tell


def called(name: str, brought: object, method: str, *told: object) -> Any:
    """What a method of `brought` answers. Raises PluginFailedError, and StampError as it comes."""
    try:
        return getattr(brought, method)(*told)
    except (StampError, KeyboardInterrupt):
        raise  # as an estimator must; and nobody's fault
    except PluginFailedError as error:  # in our own words already
        raise PluginFailedError(f"{name}.{method}: {error}") from error
    except BaseException as error:  # SystemExit too: no stranger is to end the whole program
        raise PluginFailedError(f"{name}.{method}: {failure(error)}") from error


class at_tick:  # a context manager of a function takes four times as long, at every tick
    """Any PluginFailedError from within names the tick."""

    __slots__ = ("_tick",)

    def __init__(self, tick: int) -> None:
        self._tick = tick

    def __enter__(self) -> None:
        pass

    def __exit__(self, _: object, error: BaseException | None, trace: object) -> None:
        if isinstance(error, PluginFailedError):
            raise PluginFailedError(f"tick {self._tick}: {error}") from error
