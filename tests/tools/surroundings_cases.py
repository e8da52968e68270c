"""Light of the surroundings that comes through, in an engine's page: a ball under light from above."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

import sssgen
from engine_cases import HEAD
from shadow_cases import EYE, LEVEL, SIZE, ball, view_projection
from sssgen.run.backends import Array
from sssgen.run.backends.engine_page import EngineDrawing, EnginePage
from sssgen.run.render import page_values

BOTH_SIDES = HEAD.format("translucency") + (
    "vec3 made(world_direction L) { return vec3(0.0); }\n"
    "vec3 made_surroundings(vec3 irradiance, vec3 irradiance_behind) "
    "{ return vec3(irradiance.r, irradiance_behind.g, 0.0); }\n"
)
"""Red has the light in front of the surface, green the one behind it."""


def check_surroundings(page: EnginePage, target: str, properties: Mapping[str, Any], kinds: Mapping[str, float],
                       folder: Path) -> None:  # fmt: skip
    """`kinds` are those of the page's stage, with the largest error: each is (1 + y) / 2 on a white matte surface."""
    (folder / "made.sss").write_text(BOTH_SIDES, "utf-8")
    path = folder / "m.toml"
    path.write_text('[material]\nname = "m"\n[translucency]\ntechnique = "./made.sss"\n', "utf-8")
    modules = page_values.modules_of(sssgen.compile(str(path), target))
    body = ball()

    def picture(ambient: Any = (), **stage: Any) -> Array:
        drawing = EngineDrawing(
            modules, SIZE, body.vertices.astype(np.float32), body.triangles, view_projection(), EYE, body.model,
            np.zeros((0, 4)), np.zeros((0, 3)), ambient=ambient, properties={**properties, "stage": stage},
        )  # fmt: skip
        return page.draw(drawing)

    uniform = picture((0.25, 0.5, 1.0))
    seen = uniform[..., 3] > 0.5
    assert seen.sum() > 200 and np.abs(uniform[seen][:, :3] - (0.25, 0.5, 0.0)).max() < LEVEL
    up = normals(seen)[1]
    for kind, error in kinds.items():
        front, behind = picture(around=kind)[seen][:, :2].T
        assert np.abs(front - (0.5 + 0.5 * up)).max() < error, kind
        assert np.abs(behind - (0.5 - 0.5 * up)).max() < error, kind


def normals(seen: Array) -> Array:
    """The ball's normals in the seen pixels, (3, n)."""
    height, width = seen.shape
    x, y = np.meshgrid((np.arange(width) + 0.5) / width * 2.0 - 1.0, (np.arange(height) + 0.5) / height * 2.0 - 1.0)
    inverse = np.linalg.inv(view_projection())
    far = np.einsum("ij,jhw->ihw", inverse, np.stack([x, y, np.full_like(x, 0.5), np.ones_like(x)]))
    ways = (far[:3] / far[3]).transpose(1, 2, 0)[seen] - EYE
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    along = ways @ np.array(EYE)
    length = -along - np.sqrt(np.maximum(along**2 - np.dot(EYE, EYE) + 0.7**2, 0.0))
    result: Array = (EYE + ways * length[:, None]).T / 0.7
    return result
