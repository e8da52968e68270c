"""The places that a scene's view shows, with all that a chain reads there. Arrays have their lanes last.

One ray a pixel, through its centre: the reference follows the very same rays, so that nothing differs but the light.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from sssgen.harness.backends import Array
from sssgen.harness.scenes.placed import Bools
from sssgen.lab.scene.measured_scene import MeasuredScene
from sssgen.support.diagnostics import failure

GRAZING = 1e-3
"""The cosine between ray and normal below which a place is not measured."""


@dataclass(frozen=True, eq=False)
class Points:
    """What a view shows."""

    valid: Bools
    """(height, width), row 0 at the bottom: the pixels that are measured, n of them"""
    inputs: dict[str, Array]
    """P, N, V, T, B, P_object, N_object, V_object: (3, n); uv: (2, n); time"""
    model: Array
    """Object space to world space, (4, 4)"""
    origin: Array
    """(3,): the eye"""

    @property
    def count(self) -> int:
        """n"""
        return int(self.inputs["P"].shape[1])

    def light(self, direction: tuple[float, float, float]) -> dict[str, Array]:
        """L, L_object and light_color of a white light from afar: (3, n)."""
        towards = np.array(direction)[:, None]
        turned = np.linalg.inv(self.model)[:3, :3] @ towards
        turned /= np.linalg.norm(turned)
        shape = (3, self.count)
        return {
            "L": np.broadcast_to(towards, shape),
            "L_object": np.broadcast_to(turned, shape),
            "light_color": np.ones(shape),
        }

    def picture(self, values: Array, background: float = 0.0) -> Array:
        """Values (k, n) as a picture (height, width, k), row 0 at the top."""
        whole = np.full((*self.valid.shape, len(values)), background)
        whole[self.valid] = np.asarray(values).T
        return whole[::-1]

    def some(self, most: int) -> Array:
        """At most so many lanes, spread evenly: the same in every run."""
        return np.unique(np.linspace(0, self.count - 1, min(most, self.count)).astype(int))


@lru_cache(64)
def points(scene: MeasuredScene) -> Points:
    """The places of a scene. Raises SssgenError for geometry that cannot be read, or seen."""
    width, height = scene.size
    origin, directions = scene.camera.rays(width, height)
    hits = scene.geometry.hits(origin, directions)
    keep = hits.hit & (np.abs(np.einsum("nc,nc->n", hits.normal, directions)) > GRAZING)
    if not keep.any():
        raise failure(f"the camera of '{scene.name}' sees nothing of its body", "turn it: [camera] target = […]")
    place, normal, ray = hits.position[keep].T, hits.normal[keep].T, directions[keep].T
    tangent, uv = hits.tangent[keep].T, hits.uv[keep].T
    model = scene.geometry.to_world()
    inwards = scene.geometry.to_object()
    turn = inwards[:3, :3] * scene.geometry.scale
    inputs = {
        "P": place, "N": normal, "V": -ray, "T": tangent[:3], "B": np.cross(normal.T, tangent[:3].T).T * tangent[3],
        "P_object": inwards[:3, :3] @ place + inwards[:3, 3:], "N_object": turn @ normal, "V_object": turn @ -ray,
        "uv": uv, "time": np.zeros(1),
    }  # fmt: skip
    return Points(keep.reshape(height, width), inputs, model, origin)
