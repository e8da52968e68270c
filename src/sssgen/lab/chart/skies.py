"""Three pictures of surroundings under which bodies are measured: a day's sky, a window, and two colours of light."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from sssgen.run.backends import Array

HEIGHT = 64
"""The rows of a picture; it has twice as many columns."""


def skies() -> Mapping[str, Array]:
    """Name → linear light, (64, 128, 3) in 0..1, equirectangular as `Environment` has it."""
    rows, columns = np.indices((HEIGHT, 2 * HEIGHT)).reshape(2, -1) + 0.5
    polar, around = np.pi * rows / HEIGHT, 2.0 * np.pi * (columns / (2 * HEIGHT) - 0.5)
    ways = np.stack([np.sin(polar) * np.cos(around), np.cos(polar), np.sin(polar) * np.sin(around)], axis=1)
    pictures = {"day": _day(ways), "window": _window(ways), "two colours": _two_colors(ways)}
    return {name: light.reshape(HEIGHT, 2 * HEIGHT, 3) for name, light in pictures.items()}


def _day(ways: Array) -> Array:
    """A sky that is brighter above, over a dark ground with a sharp horizon."""
    height = ways[:, 1:2]
    sky = np.array([0.35, 0.45, 0.6]) + np.clip(height, 0.0, 1.0) * np.array([0.55, 0.5, 0.4])
    light: Array = np.where(height > 0.0, sky, np.array([0.12, 0.1, 0.07]))
    return light


def _window(ways: Array) -> Array:
    """A dark room with a bright round window of soft edge, 50 degrees wide, at one side."""
    angle = np.degrees(np.arccos(np.clip(ways @ _unit(-0.8, 0.35, -0.5), -1.0, 1.0)))[:, None]
    share = _smooth((35.0 - angle) / 20.0)
    light: Array = 0.04 + share * np.array([0.96, 0.92, 0.85])
    return light


def _two_colors(ways: Array) -> Array:
    """Warm light from one side, and cold light from the other."""
    share = _smooth(0.5 + 0.8 * (ways @ _unit(0.9, 0.1, 0.4)))[:, None]
    light: Array = share * np.array([0.95, 0.45, 0.15]) + (1.0 - share) * np.array([0.08, 0.25, 0.8])
    return light


def _smooth(value: Array) -> Array:
    """0 below 0, 1 above 1, smooth between."""
    part = np.clip(value, 0.0, 1.0)
    smooth: Array = part * part * (3.0 - 2.0 * part)
    return smooth


def _unit(x: float, y: float, z: float) -> Array:
    way = np.array([x, y, z])
    return way / float(np.linalg.norm(way))
