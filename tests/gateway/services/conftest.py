"""A robot's services."""

import pytest

from laglab_gateway import Parameter, Safety, Services, standard_parameters


@pytest.fixture
def services() -> Services:
    others = [Parameter("LAW_GAMMA", 3.0), Parameter("TRIES", 2, True, 1, 9)]
    return Services(standard_parameters(10, 20, Safety(), others), armed=False)
