"""Lights with an area that shine through a sheet, in an engine's page, against the integral over the area."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import sssgen
from engine_cases import HEAD
from shadow_cases import EYE, Body, scaled, sheet, view_projection
from sssgen.run.backends import Array
from sssgen.run.backends.engine_page import EngineDrawing, EnginePage
from sssgen.run.render import page_values

SIZE = (96, 72)
SIDES = (1.2, 0.8)
RADIANCE = 4.0
FRONT = Body(sheet().vertices[4:8], np.array([[0, 1, 2], [0, 2, 3]]), sheet().model @ scaled(0.5, np.zeros(3)))
CENTRE = FRONT.model[:3, :3] @ [0.0, 0.0, 0.05]
N = np.linalg.inv(FRONT.model[:3, :3])[2]
N /= np.linalg.norm(N)
THROUGH = HEAD.format("translucency") + (
    "vec3 made(world_direction N, world_direction L, float light_nearness) "
    "{ float cosine = dot(N, L); return vec3(1.0, abs(cosine), light_nearness * (2.0 + cosine)); }\n"
)
"""Red has all light, green that on the sheet, blue one that depends on direction and distance."""
NOTHING = HEAD.format("translucency") + "vec3 made() { return vec3(0.0); }\n"
LARGEST = {1.0: 0.05, 2.0: 0.005, 4.0: 0.002}
"""Distance from the sheet in lengths of the longer side → the largest error, relative to the brightest light. One point
in place of four is wrong by 24, 6 and 2 %."""


class Lamp(NamedTuple):
    """A rectangle of light, or an ellipse in it, which shines along the -z of its matrix."""

    model: Array
    shape: str = "rectangle"

    def stage(self, **others: Any) -> Mapping[str, Any]:
        """Its part of a plan's stage."""
        area = {"model": self.model.T.ravel().tolist(), "size": SIDES, "radiance": RADIANCE, "shape": self.shape}
        return {"area": {**area, **others}}

    def light(self, P: Array, two_sided: bool) -> Array:
        """What `THROUGH` has of it at points (3, n): a sum over small parts of its area."""
        x, y, area = _parts(self.shape)
        parts = self.model @ np.stack([SIDES[0] * x, SIDES[1] * y, 0.0 * x, 1.0 + 0.0 * x])
        ways = parts[:3, :, None] - P[:, None, :]
        distance = np.linalg.norm(ways, axis=0)
        L = ways / distance
        facing = np.einsum("i,ijk->jk", self.model[:3, 2], L)
        facing = np.abs(facing) if two_sided else np.maximum(facing, 0.0)
        light = RADIANCE / np.pi * area * SIDES[0] * SIDES[1] / x.size * facing / distance**2
        if self.shape == "sphere":  # PlayCanvas's own fall
            light = RADIANCE * 0.5 * max(SIDES) / (distance**2 + 0.5 * max(SIDES))
        cosine = np.einsum("i,ijk->jk", N, L)
        shown = [light, light * np.abs(cosine), light / distance * (2.0 + cosine)]
        result: Array = np.stack([part.sum(axis=0) for part in shown], -1)
        return result


def _parts(shape: str, count: int = 48) -> tuple[Array, Array, float]:
    """The centres of equal parts of a shape in a square of the side 1, and its area."""
    first, second = (one.ravel() for one in np.meshgrid(*2 * [(np.arange(count) + 0.5) / count]))
    if shape == "rectangle":
        return first - 0.5, second - 0.5, 1.0
    if shape == "sphere":
        return np.zeros(1), np.zeros(1), 1.0
    radius, angle = 0.5 * np.sqrt(first), 2.0 * np.pi * second
    return radius * np.cos(angle), radius * np.sin(angle), 0.25 * np.pi


def lamp(distance: float, behind: bool = True, turned: bool = False, shape: str = "rectangle") -> Lamp:
    """A lamp so far from the sheet, behind or before it, that does not quite face it; `turned` away from it."""
    towards = np.array([0.4, 0.35, -0.8 if behind else 0.8])
    z = towards + np.array([0.2, -0.1, 0.0])
    z /= -np.linalg.norm(z) if turned else np.linalg.norm(z)
    x = np.cross([0.3, 1.0, 0.2], z)
    x /= np.linalg.norm(x)
    model = np.eye(4)
    model[:3, :3] = np.stack([x, np.cross(z, x), z], -1)
    model[:3, 3] = CENTRE + towards / np.linalg.norm(towards) * distance * max(SIDES)
    return Lamp(model, shape)


class Scene(NamedTuple):
    """The sheet in an engine's page, made of a technique."""

    page: EnginePage
    modules: Mapping[str, str]
    properties: Mapping[str, Any]

    def picture(self, stage: Mapping[str, Any]) -> Array:
        drawing = EngineDrawing(
            self.modules, SIZE, FRONT.vertices.astype(np.float32), FRONT.triangles, view_projection(), EYE,
            FRONT.model, np.zeros((0, 4)), np.zeros((0, 3)), properties={**self.properties, "stage": stage},
        )  # fmt: skip
        return self.page.draw(drawing)

    def light(self, stage: Mapping[str, Any]) -> tuple[Array, Array]:
        """The light of each seen pixel, (n, 3), and its place, (3, n)."""
        picture = self.picture(stage)
        seen = picture[..., 3] > 0.5
        assert seen.sum() > 100
        return picture[seen][:, :3], _places(seen)


def _places(seen: Array) -> Array:
    """The points of the sheet in the seen pixels."""
    height, width = seen.shape
    x, y = np.meshgrid((np.arange(width) + 0.5) / width * 2.0 - 1.0, (np.arange(height) + 0.5) / height * 2.0 - 1.0)
    far = np.linalg.inv(view_projection()) @ np.stack([x[seen], y[seen], 0.5 + 0.0 * x[seen], 1.0 + 0.0 * x[seen]])
    eye = np.array(EYE)
    ways = far[:3] / far[3] - eye[:, None]
    result: Array = eye[:, None] + ways * (N @ (CENTRE - eye)) / (N @ ways)
    return result


def modules_of(text: str, target: str, folder: Path) -> Mapping[str, str]:
    (folder / "made.sss").write_text(text, "utf-8")
    path = folder / "m.toml"
    path.write_text('[material]\nname = "m"\n[translucency]\ntechnique = "./made.sss"\n', "utf-8")
    return page_values.modules_of(sssgen.compile(str(path), target))


def check_area_light(
    page: EnginePage, target: str, black: Mapping[str, Any], white: Mapping[str, Any], folder: Path,
    two_sided: bool = False, shape: str = "rectangle", **stage: Any,
) -> dict[float, float]:  # fmt: skip
    """What comes through of a lamp is its integral, and as much as the engine reflects. The errors by distance."""
    through = Scene(page, modules_of(THROUGH, target, folder), black)
    white_sheet = Scene(page, modules_of(NOTHING, target, folder), white)
    errors = {}
    for distance, largest in LARGEST.items():
        picture, P = through.light({**lamp(distance, shape=shape).stage(), **stage})
        expected = lamp(distance, shape=shape).light(P, two_sided)
        errors[distance] = float((np.abs(picture - expected) / expected.max(axis=0)).max())
        assert errors[distance] < largest
    for turned in (False, True):
        one = lamp(2.0, behind=False, turned=turned, shape=shape)
        picture, P = through.light({**one.stage(), **stage})
        reflected, _ = white_sheet.light({**one.stage(), **stage})
        assert (picture[:, 1].max() > 0.05) == (two_sided or not turned)
        assert np.abs(picture - one.light(P, two_sided)).max() <= LARGEST[2.0] * picture.max()
        assert np.abs(picture[:, 1] - reflected[:, 1]).max() <= 0.01 * reflected.max()
    return errors


def check_shadow_of_area_light(page: EnginePage, target: str, black: Mapping[str, Any], folder: Path) -> None:
    """A wall before the lamp takes the light; the sheet takes nothing from itself."""
    scene, one = Scene(page, modules_of(THROUGH, target, folder), black), lamp(2.0)
    wall = one.model @ np.diag([3.0, 3.0, 0.05, 1.0])
    wall[:3, 3] = 0.6 * CENTRE + 0.4 * one.model[:3, 3]
    free, own, dark = (
        scene.picture(stage)
        for stage in (
            one.stage(),
            {**one.stage(shadows=True), "shadows": True},
            {**one.stage(shadows=True), "shadows": True, "walls": [wall.T.ravel().tolist()]},
        )
    )
    seen = free[..., 3] > 0.5
    assert np.abs(own - free).max() < 1.0 / 255.0 and free[seen][:, 0].min() > 0.05
    assert dark[seen][:, 0].sum() < 0.1 * free[seen][:, 0].sum()
