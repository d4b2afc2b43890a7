"""The conformance kit on parsers that others wrote: which of its items a robot with each passes."""

from laglab.selftest.table import SelfTest, self_test

__all__ = ["SelfTest", "self_test"]
