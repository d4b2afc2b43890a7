"""Names of what runs: shipped, of an installed plug-in, or `module:Class`.

`module:Class` is not looked for here: on two machines only one of them need have it.
"""

from collections.abc import Iterable
from functools import cache

from pydantic import WithJsonSchema

from laglab_control import ESTIMATORS, LAWS, is_module_class
from laglab_control.plugins import Group, plugin_names

_installed = cache(plugin_names)
"""Looked up once: a study asks as often as it has cells."""


def known(group: Group, name: str, shipped: Iterable[str]) -> str:
    """The name. Raises ValueError, listing those that there are, when it is none of them."""
    if name in shipped or is_module_class(name):
        return name
    if name in _installed(group):
        return name
    listed = ", ".join((*shipped, *_installed(group)))
    raise ValueError(f"must be one of {listed}, or module:Class, not {name!r}")


def known_estimator(name: str) -> str:
    """The name of an estimator. Raises ValueError."""
    return known("laglab.estimators", name, ESTIMATORS)


def known_law(name: str) -> str:
    """The name of a law. Raises ValueError."""
    return known("laglab.laws", name, LAWS)


def offered(names: Iterable[str], but: Iterable[str] = ()) -> WithJsonSchema:
    """For editors, which do not know what is installed: the shipped names, and any other `but`
    these."""
    other = {"type": "string", "not": {"enum": list(but)}} if but else {"type": "string"}
    return WithJsonSchema({"anyOf": [{"enum": list(names)}, other]})
