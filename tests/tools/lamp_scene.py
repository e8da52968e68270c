"""The parts of the scene that the tests of rendering draw, and the difference of two pictures."""

from __future__ import annotations

import numpy as np

from folders import EXAMPLES
from sssgen.run.render.scene_render import RenderedPicture

LAMP = """
[[light]]
position = [0.6, 0.6, -1.6]
color = [2.4, 2.2, 1.9]
[[light]]
direction = [1, 2, 2]
color = [1, 1, 1]
"""
BALL = '[geometry]\nkind = "ball"\nrotation = [20, 30, 40]\nposition = [0.1, 0, 0]\nscale = 0.9\n'
RIBS = f'[textures]\nthickness_texture = "{(EXAMPLES / "paper_lantern/textures/thickness.png").as_posix()}"\n'
"""The map without which the paper lantern is not drawn."""
SIZE = (48, 36)


def largest_difference(a: RenderedPicture, b: RenderedPicture) -> float:
    """The largest difference in 1/255."""
    return float(255.0 * np.abs(a.encoded - b.encoded).max())
