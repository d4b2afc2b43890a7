"""Small packages to begin with: a filter, a law or a plant of one's own."""

from laglab.new.making import Made, make_package

__all__ = ["Made", "make_package"]
