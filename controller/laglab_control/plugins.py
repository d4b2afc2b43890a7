"""What users bring, by name: `module:Class`, or an entry point of an installed distribution."""

import inspect
import sys
from collections.abc import Iterator
from importlib import import_module
from importlib.machinery import ModuleSpec
from importlib.metadata import EntryPoint, entry_points
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Literal, NamedTuple, Protocol

from laglab_control.errors import ControlError, StampError

SHOWN, LONGEST = 60, 400
"""[characters] At most so much of a wrong answer, and of an exception's text, is shown."""
HERE = ""
"""The current directory, in Python's search path: last, so that nothing there hides a library."""
Group = Literal["laglab.estimators", "laglab.laws", "laglab.plants"]
"""The entry points' groups."""


class PluginError(ControlError):
    """What was named cannot be had, or does not do what it must; the text names it."""


class PluginFailedError(PluginError):
    """It failed while it ran, or answered what it must not."""


class Maker(Protocol):
    """A class that a user brings, or a function that makes what one would."""

    def __call__(self, *told: object, **options: object) -> object:
        """The estimator, law or plant."""
        ...


class Plugin(NamedTuple):
    """An entry point, as it is listed."""

    name: str
    origin: str
    """The distribution that brought it, and its version."""
    description: str
    """The first line of its docstring, or why it cannot be loaded."""


def is_module_class(name: str) -> bool:
    """Whether a name is written as `module:Class`."""
    return ":" in name


def find_plugin(group: Group, name: str, shipped: tuple[str, ...] = ()) -> Maker:
    """What is called so: `module:Class`, or an entry point of the group.

    `shipped` are the names that are known without it, for the message. Raises PluginError: there
    is none, or it cannot be loaded.
    """
    if is_module_class(name):
        _look_here()
        return _loaded(EntryPoint(name, name, group), name)
    entries = {entry.name: entry for entry in entry_points(group=group)}
    if name not in entries:
        known = ", ".join((*shipped, *sorted(entries)))
        raise PluginError(f"no {_singular(group)} {name!r}: take one of {known}, or module:Class")
    return _loaded(entries[name], name)


def installed_plugins(group: Group) -> Iterator[Plugin]:
    """The entry points of the group, by name; what cannot be loaded is told, not raised."""
    for entry in sorted(entry_points(group=group), key=lambda entry: entry.name):
        origin = f"{entry.dist.name} {entry.dist.version}" if entry.dist else entry.value
        try:
            description = first_line(_loaded(entry, entry.name))
        except PluginError as error:
            description = str(error)
        yield Plugin(entry.name, origin, description)


def source_of(group: Group, name: str) -> Path | None:
    """The file of the module that a class comes from; None where none is found."""
    values = (
        [name]
        if is_module_class(name)
        else [entry.value for entry in entry_points(group=group) if entry.name == name]
    )
    for value in values:
        found = _spec_of(value.partition(":")[0])
        if found and found.origin and Path(found.origin).is_file():
            return Path(found.origin)
    return None


def _spec_of(module: str) -> ModuleSpec | None:
    """None where the package around it cannot be loaded, either: who loads it is told why."""
    _look_here()
    try:
        return find_spec(module)
    except KeyboardInterrupt:
        raise
    except BaseException:  # it is a stranger's
        return None


def made(name: str, maker: Maker, *told: object, **options: object) -> object:
    """What `maker` makes of what it is told. Raises PluginError when it fails."""
    try:
        return maker(*told, **options)
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # it is a stranger's
        raise PluginError(f"{name} cannot be made: {one_line(error)}") from error


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
    except BaseException as error:  # SystemExit too: no stranger is to end the whole program
        raise PluginFailedError(f"{name}.{method}: {one_line(error)}") from error


class at_tick:
    """Any PluginFailedError from within names the tick."""

    __slots__ = ("_tick",)

    def __init__(self, tick: int) -> None:
        self._tick = tick

    def __enter__(self) -> None:
        pass

    def __exit__(self, _: object, error: BaseException | None, trace: object) -> None:
        if isinstance(error, PluginFailedError):
            raise PluginFailedError(f"tick {self._tick}: {error}") from error


def one_line(error: BaseException) -> str:
    """Kind and text, as far as it can be told."""
    try:
        text = str(error)
    except Exception:  # a stranger's, too
        text = ""
    kind = type(error).__name__
    return _short(f"{kind}: {text}" if text else kind, LONGEST)


def shown(answer: object) -> str:
    """What was answered, in a line."""
    try:
        text = repr(answer)
    except Exception:
        text = f"an object of {type(answer).__name__}"
    return _short(text, SHOWN)


def _short(text: str, longest: int) -> str:
    """In one line, without what would control a terminal."""
    line = " ".join("".join(each if each.isprintable() else " " for each in text).split())
    return line if len(line) <= longest else f"{line[:longest]}..."


def first_line(made_by: object) -> str:
    """Of the docstring; nothing where there is none."""
    lines = (getattr(made_by, "__doc__", None) or "").strip().splitlines()
    return lines[0] if lines else ""


def _loaded(entry: EntryPoint, name: str) -> Maker:
    module, _, attribute = entry.value.partition(":")
    try:
        found: object = import_module(module)
        for part in attribute.split("."):
            found = getattr(found, part)
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # it is a stranger's
        raise PluginError(f"{name}: {one_line(error)}") from error
    if not callable(found):
        raise PluginError(f"{name}: {entry.value} is no class, but {shown(found)}")
    return found


def _look_here() -> None:
    """A command's own search path does not have the current directory."""
    if HERE not in sys.path:
        sys.path.append(HERE)


def _singular(group: Group) -> str:
    return group.removeprefix("laglab.").removesuffix("s")
