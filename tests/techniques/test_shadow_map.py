"""The shadow map: the weights of its texels, its edges, and what is not on the map."""

from __future__ import annotations

import numpy as np

from oracle import Array, close, technique
from sssgen.targets.runtime.numpy_textures import Texture

SIZE = 8
LOOKING_DOWN = np.array([[0.5, 0.0, 0.0, 0.5], [0.0, 0.5, 0.0, 0.5], [0.0, 0.0, -1.0, 2.0], [0.0, 0.0, 0.0, 1.0]])
"""From z = 2 on the square from -1 to 1; the distance is 2 - z."""
UP = np.array([0.0, 0.0, 1.0])


def share(map_: Array, at: Array, bias: float = 0.0, matrix: Array = LOOKING_DOWN) -> Array:
    texture = Texture(map_[..., None], "linear", "clamp")
    result: Array = technique("shadow_map")(
        P=at, N=UP, shadow_depth_map=texture, shadow_matrix=matrix, shadow_bias=bias, shadow_map_texels=SIZE
    )
    return result


def test_the_edge_is_three_texels_wide_and_linear() -> None:
    """A caster over the left half: along x the share is that of the part of a box of three texels that is clear."""
    depth = np.full((SIZE, SIZE), 5.0)
    depth[:, : SIZE // 2] = 1.0
    x = np.linspace(-0.7, 0.7, 57)
    texels = x * SIZE / 2.0  # from the edge
    close(
        share(depth, np.stack([x, 0.1 + 0.0 * x, 0.0 * x], axis=1)), np.clip((texels + 1.5) / 3.0, 0.0, 1.0), atol=1e-12
    )


def test_the_bias_moves_along_the_normal() -> None:
    depth = np.full((SIZE, SIZE), 1.99)
    place = np.zeros((1, 3))
    close(share(depth, place), 0.0)
    close(share(depth, place, bias=0.02), 1.0)


def test_outside_of_the_map_and_behind_the_light_is_no_shadow() -> None:
    depth = np.zeros((SIZE, SIZE))
    close(share(depth, np.array([[0.0, 0.0, 0.0], [1.5, 0.0, 0.0], [0.0, -1.01, 0.0]])), [0.0, 1.0, 1.0])
    behind = LOOKING_DOWN.copy()
    behind[3] = [0.0, 0.0, -1.0, 0.0]  # a view of a light at z = 0
    close(share(depth, np.array([[0.0, 0.0, 0.5]]), matrix=behind), 1.0)
