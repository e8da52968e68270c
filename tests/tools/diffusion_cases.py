"""A material whose light spreads on the screen, its scene for NumPy, and a lamp with a wall before a ball."""

from __future__ import annotations

import numpy as np

PLAIN = """
[material]
name = "skin"

[[surface]]
technique = "base_color"
tint = [0.8, 0.6, 0.5, 1.0]

# no highlight
[[surface]]
technique = "specular_level"
dielectric_specular = 0.0
"""
"""A body without light that spreads."""
SPREAD = """
[[surface]]
technique = "screen_diffusion"
spread_length = [{}]
"""
"""The stage that spreads it; to fill in: three lengths."""
MATERIAL = """
[material]
name = "skin"

[[surface]]
technique = "base_color"
tint = [0.8, 0.6, 0.5, 1.0]

[[surface]]
technique = "screen_diffusion"
spread_length = [0.06, 0.03, 0.02]
"""
SCENE = """
material = "skin.toml"

[geometry]
kind = "torus"
major = 0.8
minor = 0.35
rotation = [65, 0, 0]

[camera]
position = [0.2, 0.5, 4.0]

# along the axis of the ring: the part that faces the light has no shadow
[[light]]
direction = [0.0, 0.42261826, 0.90630779]
color = [0.9, 0.8, 0.7]
"""
WAY = np.array([0.8, 0.3, 0.52]) / np.linalg.norm([0.8, 0.3, 0.52])
"""Towards a lamp beside the camera."""


def wall() -> list[float]:
    """The matrix of a wall between the lamp and half of the ball, by columns."""
    across = np.cross([0.0, 1.0, 0.0], WAY) / np.hypot(WAY[0], WAY[2])
    matrix = np.eye(4)
    matrix[:3, :3] = np.stack([across, np.cross(WAY, across), 0.05 * WAY], axis=1)
    matrix[:3, 3] = 2.0 * WAY + [0.0, 0.7, 0.0]
    return [float(number) for number in matrix.T.ravel()]
