"""What is to be checked: found by its name, and known by its methods."""

from collections.abc import Iterator, Mapping
from typing import Literal

from laglab.errors import ScenarioError
from laglab.runs.plant.brought import METHODS as OF_PLANTS
from laglab.scenario.tables.plant import SHIPPED as PLANTS
from laglab_control import ESTIMATORS, LAWS, find_plugin, is_module_class
from laglab_control.estimators import METHODS as OF_ESTIMATORS
from laglab_control.plugins import Group, Maker, plugin_names

Kind = Literal["estimator", "law", "plant"]
KINDS: Mapping[Kind, Group] = {
    "estimator": "laglab.estimators",
    "law": "laglab.laws",
    "plant": "laglab.plants",
}
METHODS: Mapping[Kind, tuple[str, ...]] = {
    "estimator": tuple(OF_ESTIMATORS),
    "law": ("drive",),
    "plant": tuple(OF_PLANTS),
}
SHIPPED: Mapping[Kind, tuple[str, ...]] = {
    "estimator": tuple(ESTIMATORS),
    "law": tuple(LAWS),
    "plant": tuple(PLANTS),
}


def kind_of(name: str, told: Kind | None) -> Kind:
    """As told, or by where it is known and which methods it has.

    Raises ScenarioError and PluginError.
    """
    found = [told] if told else list(_by_name(name))
    if len(found) == 1:
        return found[0]
    if is_module_class(name):
        maker = find_plugin("laglab.estimators", name)
        found = [kind for kind in METHODS if any(hasattr(maker, each) for each in METHODS[kind])]
    if len(found) == 1:
        return found[0]
    if not (found or is_module_class(name)):
        raise ScenarioError(f"no estimator, law or plant {name!r}: take one of {_known()}")
    what = "several things" if found else "none of the three by its methods"
    raise ScenarioError(f"{name} is {what}: say which, with --as {'|'.join(KINDS)}")


def _known() -> str:
    """All names."""
    names = [name for names in SHIPPED.values() for name in names]
    plugins = [name for group in KINDS.values() for name in plugin_names(group)]
    return ", ".join((*names, *plugins, "or module:Class"))


def _by_name(name: str) -> Iterator[Kind]:
    if is_module_class(name):
        return
    for kind, group in KINDS.items():
        if name in SHIPPED[kind] or name in plugin_names(group):
            yield kind


def maker_of(kind: Kind, name: str) -> Maker:
    """Raises PluginError."""
    return find_plugin(KINDS[kind], name, SHIPPED[kind])
