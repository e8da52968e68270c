"""A picture with what it shows."""

from __future__ import annotations

from typing import NamedTuple

from sssgen.run.backends import Array


class Picture(NamedTuple):
    """A picture of a technique's page."""

    colors: Array
    """(height, width, 3), sRGB"""
    caption: str
    """Without a dot at its end."""
