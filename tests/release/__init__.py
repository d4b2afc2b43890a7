"""Tests of a release: slow, they build one."""
