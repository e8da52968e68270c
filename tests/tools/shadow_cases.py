"""Shadows of light that comes through, in an engine's page: bodies that pass half of all light on, and walls."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple, Protocol

import numpy as np
import pytest

import sssgen
from engine_cases import HEAD
from sssgen.run.backends import Array
from sssgen.run.backends.backend_interface import ATTRIBUTES, VERTEX_SIZE
from sssgen.run.backends.engine_page import EngineDrawing
from sssgen.run.render import page_values
from sssgen.support.diagnostics import SssgenError

LEVEL = 1.0 / 255.0
LAMP = np.array([0.6, 0.8, -3.0])
"""Behind the bodies, which the camera sees from the other side."""
LAMPS: Mapping[str, Mapping[str, Any]] = {
    "direction": {}, "cascades": {"cascades": True}, "spot": {"spot": 1.2}, "point": {},
}  # fmt: skip
"""Kind → its part of the stage."""
DIRECTIONS = ("direction", "cascades")
LEFT, RIGHT = np.array([-0.9, 0.0, 0.0]), np.array([0.9, 0.0, 0.0])
EYE = (0.0, 0.0, 5.0)
SIZE = (64, 48)
HALF = HEAD.format("translucency") + "vec3 made() { return vec3(0.5); }\n"


class Body(NamedTuple):
    """A mesh with its place."""

    vertices: Array
    triangles: Array
    model: Array = np.eye(4)


def sheet() -> Body:
    """A thin box of two layers, turned against the camera and stretched."""
    corners = np.array([[x, y, z] for z in (-0.05, 0.05) for y in (-0.5, 0.5) for x in (-0.5, 0.5)])
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    points = np.concatenate([corners[list(face)] for face in faces])
    normals = np.repeat(np.array([[0, 0, -1], [0, 0, 1], [0, -1, 0], [0, 1, 0], [-1, 0, 0], [1, 0, 0]]), 4, axis=0)
    first = 4 * np.arange(6)[:, None, None]
    turned = _turned(0.4, (2, 0)) @ np.diag([1.6, 1.2, 0.8, 1.0])
    return Body(_vertices(points, normals), (first + np.array([[0, 1, 2], [0, 2, 3]])).reshape(-1, 3), turned)


def ball(radius: float = 0.7) -> Body:
    """A ball about the origin."""
    columns, rows = 48, 24
    u, v = np.meshgrid(2.0 * np.pi * np.arange(columns + 1) / columns, np.pi * np.arange(rows + 1) / rows)
    normals = np.stack([np.sin(v) * np.sin(u), np.cos(v), np.sin(v) * np.cos(u)], -1).reshape(-1, 3)
    row, column = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    first = (row * (columns + 1) + column).reshape(-1, 1)
    quads = [[0, columns + 1, 1], [1, columns + 1, columns + 2]]
    return Body(_vertices(radius * normals, normals), (first[..., None] + np.array(quads)).reshape(-1, 3))


def wall(place: Array, size: float) -> list[float]:
    """The matrix of a wall that faces the lamp, by columns."""
    z = LAMP / np.linalg.norm(LAMP)
    x = np.cross([0.0, 1.0, 0.0], z)
    x /= np.linalg.norm(x)
    matrix = np.eye(4)
    matrix[:3, :3] = np.stack([size * x, size * np.cross(z, x), 0.05 * z], -1)
    matrix[:3, 3] = place
    return _by_columns(matrix)


def scaled(size: float, place: Array) -> Array:
    """The matrix of a size and a place."""
    matrix = np.diag([size, size, size, 1.0])
    matrix[:3, 3] = place
    return matrix


class Page(Protocol):
    """What draws in an engine."""

    def draw(self, drawing: EngineDrawing) -> Array: ...


class Scene(NamedTuple):
    """The lights of one kind in an engine's page, and what the bodies are made of."""

    page: Page
    modules: Mapping[str, str]
    properties: Mapping[str, Any]
    lamp: str

    def light(self, body: Body, **stage: Any) -> Array:
        """What comes through, of one channel; NaN where there is no body."""
        vertices = body.vertices.astype(np.float32)
        place = np.array([[*LAMP, 0.0 if self.lamp in DIRECTIONS else 1.0]])
        strength = 1.0 if self.lamp in DIRECTIONS else float(LAMP @ LAMP)
        drawing = EngineDrawing(
            self.modules, SIZE, vertices, body.triangles, view_projection(), EYE, body.model, place,
            np.full((1, 3), strength), properties={**self.properties, "stage": {**LAMPS[self.lamp], **stage}},
        )  # fmt: skip
        picture = self.page.draw(drawing)
        return np.where(picture[..., 3] > 0.5, picture[..., 0], np.nan)


def modules_of(target: str, folder: Path) -> Mapping[str, str]:
    """The modules of a material that passes half of all light on."""
    (folder / "made.sss").write_text(HALF, "utf-8")
    path = folder / "m.toml"
    path.write_text('[material]\nname = "m"\n[translucency]\ntechnique = "./made.sss"\n', "utf-8")
    return page_values.modules_of(sssgen.compile(str(path), target))


def change(first: Array, second: Array, seen: Array) -> float:
    """The largest change of a picture, where a body is seen."""
    return float(np.abs(first - second)[seen].max())


def check_shadows(scene: Scene) -> None:
    """What light that comes through owes to shadows."""
    check_wall(scene)
    check_convex(scene)
    check_two_bodies(scene)


def check_absence(scene: Scene, sought: str, said: str) -> None:
    """An engine without a text that the runtime seeks is an error that names it: here the runtime seeks another one."""
    modules = {name: text.replace(sought, f"{sought}_ABSENT") for name, text in scene.modules.items()}
    with pytest.raises(SssgenError, match=said):
        scene._replace(modules=modules).light(sheet())


def check_wall(scene: Scene) -> float:
    """A wall before the lamp takes the light; one elsewhere takes nothing. The share that it takes."""
    body = sheet()
    free = scene.light(body)
    seen = np.isfinite(free)
    assert seen.sum() > 200 and np.nanmean(free) > 0.05
    assert change(scene.light(body, shadows=True), free, seen) < LEVEL
    beside = wall(0.6 * LAMP + [-2.5, 1.0, 0.0], 1.0)
    assert change(scene.light(body, shadows=True, walls=[beside]), free, seen) < LEVEL
    dark = scene.light(body, shadows=True, walls=[wall(0.4 * LAMP, 3.0)])
    taken = 1.0 - np.mean(dark[seen]) / np.mean(free[seen])
    assert taken > 0.9
    return float(taken)


def check_convex(scene: Scene) -> float:
    """A ball in its own shadow passes on what it passes on without shadows. The largest change."""
    body = ball()
    free, shadowed = scene.light(body), scene.light(body, shadows=True)
    seen = np.isfinite(free)
    assert seen.sum() > 200 and np.nanmin(free) > 0.05
    changed = change(shadowed, free, seen)
    assert changed < LEVEL
    return changed


def check_two_bodies(scene: Scene) -> None:
    """Two balls with one material: each has its own box and scale, and a wall close to one takes its light alone."""
    small = ball(0.175)._replace(model=scaled(2.0, LEFT))
    _check_pair(scene, small, copies=[{"size": 4.0, "model": _by_columns(scaled(1.0, RIGHT))}])
    _check_pair(scene, ball(), instances=[_by_columns(scaled(0.5, LEFT)), _by_columns(scaled(1.0, RIGHT))])


def _check_pair(scene: Scene, body: Body, **stage: Any) -> None:
    free = scene.light(body, **stage)
    seen = np.isfinite(free)
    left = seen & (np.arange(SIZE[0]) < SIZE[0] / 2 - 3)
    right = seen & ~left
    assert left.sum() > 40 and right.sum() > 100
    assert change(scene.light(body, shadows=True, **stage), free, seen) < LEVEL
    towards = LAMP if scene.lamp in DIRECTIONS else LAMP - LEFT
    near = wall(LEFT + 0.7 * towards / np.linalg.norm(towards), 0.9)
    dark = scene.light(body, shadows=True, walls=[near], **stage)
    assert np.mean(dark[left]) < 0.1 * np.mean(free[left])
    assert change(dark, free, right) < LEVEL


def _vertices(points: Array, normals: Array) -> Array:
    vertices = np.zeros((len(points), VERTEX_SIZE))
    for name, values in (("position", points), ("normal", normals), ("color", 1.0)):
        first, size = ATTRIBUTES[name]
        vertices[:, first : first + size] = values
    return vertices


def _turned(angle: float, axes: tuple[int, int]) -> Array:
    a, b = axes
    turn = np.eye(4)
    turn[a, a] = turn[b, b] = np.cos(angle)
    turn[b, a], turn[a, b] = np.sin(angle), -np.sin(angle)
    return turn


def view_projection() -> Array:
    near, far, slope = 0.5, 20.0, 2.5
    projection = np.array(
        [
            [slope * SIZE[1] / SIZE[0], 0, 0, 0],
            [0, slope, 0, 0],
            [0, 0, (far + near) / (near - far), 2 * far * near / (near - far)],
            [0, 0, -1, 0],
        ]
    )
    view = np.eye(4)
    view[:3, 3] = -np.asarray(EYE)
    return projection @ view


def _by_columns(matrix: Array) -> list[float]:
    listed: list[float] = matrix.T.ravel().tolist()
    return listed
