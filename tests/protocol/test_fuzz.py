"""What is fuzzed on demand still runs, and takes a little of whatever comes."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from .fuzz_targets import TARGETS


@pytest.mark.parametrize("name", TARGETS)
@settings(max_examples=30)
@given(data=st.binary(max_size=2000))
def test_it_takes_a_little_of_whatever_comes(name: str, data: bytes) -> None:
    TARGETS[name](data)
