"""What users bring, by name: `module:Class`, or an entry point of an installed distribution."""

import sys
from collections.abc import Iterator
from importlib import import_module
from importlib.machinery import ModuleSpec
from importlib.metadata import EntryPoint, entry_points
from importlib.util import find_spec
from pathlib import Path
from typing import Literal, NamedTuple, Protocol

from laglab_control.errors import PluginError
from laglab_control.plugins.wording import first_line, one_line, shown

HERE = ""
"""The current directory, in Python's search path: last, so that nothing there hides a library."""
Group = Literal["laglab.estimators", "laglab.laws", "laglab.plants"]
"""The entry points' groups."""


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


def plugin_names(group: Group) -> list[str]:
    """Those of the group's entry points."""
    return sorted(entry_points(group=group).names)


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


def _loaded(entry: EntryPoint, name: str) -> Maker:
    module, _, attribute = entry.value.partition(":")
    try:
        found: object = import_module(module)
        for part in attribute.split("."):
            found = getattr(found, part)
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # it is a stranger's
        file = module.endswith(".py")
        hint = f": name the module, {module.removesuffix('.py')}:{attribute}" if file else ""
        raise PluginError(f"{name}: {one_line(error)}{hint}") from error
    if not callable(found):
        raise PluginError(f"{name}: {entry.value} is no class, but {shown(found)}")
    return found


def _look_here() -> None:
    """A command's own search path does not have the current directory."""
    if HERE not in sys.path:
        sys.path.append(HERE)


def _singular(group: Group) -> str:
    return group.removeprefix("laglab.").removesuffix("s")
