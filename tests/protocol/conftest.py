"""Hypothesis for this component: no deadline per example, since CI's machines are shared."""

from hypothesis import settings

settings.register_profile("protocol", deadline=None, max_examples=60)
settings.load_profile("protocol")
