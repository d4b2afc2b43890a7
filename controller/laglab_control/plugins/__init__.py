"""Plug-ins: what users bring is found by its name, made, and called as strangers' code is."""

from laglab_control.plugins.calling import at_tick, called, made, refuse_misfit
from laglab_control.plugins.finding import (
    Group,
    Maker,
    Plugin,
    find_plugin,
    installed_plugins,
    is_module_class,
    plugin_names,
    source_of,
)
from laglab_control.plugins.wording import first_line, in_one_line, one_line, shown

__all__ = [
    "Group",
    "Maker",
    "Plugin",
    "at_tick",
    "called",
    "find_plugin",
    "first_line",
    "in_one_line",
    "installed_plugins",
    "is_module_class",
    "made",
    "one_line",
    "plugin_names",
    "refuse_misfit",
    "shown",
    "source_of",
]
