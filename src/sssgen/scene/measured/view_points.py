"""The surface points that a scene's camera sees, with the inputs of a chain. Arrays have their lanes last.

There is one ray per pixel, through its centre. The reference uses the same rays, so that only the light differs.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from sssgen.scene.arrays import Array, Bools
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.scene import Light
from sssgen.support.diagnostics import failure

GRAZING = 1e-3
"""The cosine between ray and normal below which a point is not measured."""


@dataclass(frozen=True, eq=False)
class Points:
    """The visible points."""

    valid: Bools
    """(height, width), row 0 at the bottom: the n measured pixels"""
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

    def towards(self, light: Light) -> tuple[Array, Array]:
        """The unit directions towards a light, (3, n), and its distances, (n,): infinite for a directional light."""
        if light.position is None:
            assert light.direction is not None
            return np.broadcast_to(np.array(light.direction)[:, None], (3, self.count)), np.full(self.count, np.inf)
        way = np.array(light.position)[:, None] - self.inputs["P"]
        distance = np.maximum(np.linalg.norm(way, axis=0), 1e-12)
        return way / distance, distance

    def light(self, light: Light) -> dict[str, Array]:
        """L, L_object and light_color (3, n) of a white light of irradiance 1 at each point; light_nearness (n,)."""
        towards, distance = self.towards(light)
        in_object = np.linalg.inv(self.model)[:3, :3] @ towards
        in_object /= np.linalg.norm(in_object, axis=0)
        colors = np.ones((3, self.count))
        return {"L": towards, "L_object": in_object, "light_color": colors, "light_nearness": 1.0 / distance}

    def picture(self, values: Array, background: float = 0.0) -> Array:
        """Values (k, n) as a picture (height, width, k), row 0 at the top."""
        picture = np.full((*self.valid.shape, len(values)), background)
        picture[self.valid] = np.asarray(values).T
        return picture[::-1]


@lru_cache(64)
def points(scene: MeasuredScene) -> Points:
    """The visible points of a scene. Raises SssgenError for geometry that is unreadable or out of view."""
    width, height = scene.size
    origin, directions = scene.camera.rays(width, height)
    hits = scene.geometry.hits(origin, directions)
    keep = hits.hit & (np.abs(np.einsum("nc,nc->n", hits.normal, directions)) > GRAZING)
    if not keep.any():
        raise failure(
            f"the camera of '{scene.name}' does not see its body", "change its direction: [camera] target = […]"
        )
    position, normal, ray = hits.position[keep].T, hits.normal[keep].T, directions[keep].T
    tangent, uv = hits.tangent[keep].T, hits.uv[keep].T
    model = scene.geometry.to_world()
    to_object = scene.geometry.to_object()
    rotation = to_object[:3, :3] * scene.geometry.scale
    x, y = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    screen = np.stack([x.ravel(), y.ravel()], axis=1)
    inputs = {
        "P": position, "N": normal, "V": -ray, "T": tangent[:3], "B": np.cross(normal.T, tangent[:3].T).T * tangent[3],
        "P_object": to_object[:3, :3] @ position + to_object[:3, 3:],
        "N_object": rotation @ normal, "V_object": rotation @ -ray,
        "screen_uv": screen[keep].T,
        "eye_distance": np.linalg.norm(position - origin[:, None], axis=0),
        "uv": uv, "time": np.zeros(1),
    }  # fmt: skip
    return Points(keep.reshape(height, width), inputs, model, origin)
