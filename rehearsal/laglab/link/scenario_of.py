"""A scenario on the link that was fitted."""

import tomlkit

from laglab.link.link_table import FittedLink, link_table
from laglab.scenario import Scenario, changed


def scenario_toml(scenario: Scenario, link: FittedLink) -> str:
    """The scenario as a file, its `[link]` this one; it is called as the file is.

    Raises ScenarioError: no scenario may have this link, such as one whose delay is too long.
    """
    changed(scenario, {"link": link_table(link).unwrap()})
    document = tomlkit.parse(scenario.to_toml())
    del document["name"]
    document["link"] = link_table(link)
    return tomlkit.dumps(document)
