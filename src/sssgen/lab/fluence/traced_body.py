"""A scene's body as light tracing needs it, in object space; the last ones are kept."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from sssgen.lab.fluence.photons import Body, Medium, Tracer
from sssgen.lab.fluence.projection import Projection, inside_shares
from sssgen.lab.fluence.voxels import Grid
from sssgen.lab.reference.dielectric import Dielectric
from sssgen.scene.arrays import Array
from sssgen.scene.geometry_base import unit
from sssgen.scene.geometry_mesh import mesh_of
from sssgen.scene.measured import scene_body
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.support.diagnostics import failure

PARTS = 4
"""The points along each axis of a voxel at which the body's distance is evaluated."""
BUDGET = 4096
"""About so many voxels of a body have their own light, unless a count is given: the file of all lights has less than a
MiB, and the linear system of scattered light is solved in seconds."""
FEWEST, MOST = 12, 64
"""The least and the largest count along the longest side that is chosen."""


def grid_in_box(scene: MeasuredScene, voxels: int) -> Grid:
    """The grid that fills the box of the body's distance texture."""
    texture = scene_body.distance_texture(scene.geometry)
    low, high = np.array(texture.box_min), np.array(texture.box_max)
    x, y, z = np.maximum(np.rint(voxels * (high - low) / (high - low).max()).astype(int), 1)
    return Grid(low, high, (int(x), int(y), int(z)))


@lru_cache(16)
def fitting_voxels(scene: MeasuredScene) -> int:
    """The voxels along the longest side of the box with which the body has about BUDGET voxels. Raises SssgenError for
    an open mesh."""
    body = _body_of(scene)
    low, high = grid_in_box(scene, MOST)[:2]
    corners = body.vertices[body.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    volume = abs(float(np.einsum("fc,fc->", corners[:, 0], across))) / 6.0
    area = 0.5 * float(np.linalg.norm(across, axis=1).sum())
    for count in range(FEWEST, MOST):
        size = float((high - low).max()) / (count + 1)
        # a layer of voxels lies on the surface
        if volume + area * size > BUDGET * size**3:
            return count
    return MOST


@lru_cache(4)
def tracer(scene: MeasuredScene, voxels: int) -> Tracer:
    """The tracer of a scene's body."""
    return Tracer(_body_of(scene), grid_in_box(scene, voxels))


def _body_of(scene: MeasuredScene) -> Body:
    vertices, faces = mesh_of(scene.geometry)
    to_object = scene.geometry.to_object()
    return Body(vertices @ to_object[:3, :3].T + to_object[:3, 3], faces)


@lru_cache(4)
def projection_of(scene: MeasuredScene, voxels: int) -> Projection:
    """How values inside a scene's body become texels. Raises SssgenError for a body without an inside."""
    grid = grid_in_box(scene, voxels)
    cell = float(((grid.high - grid.low) / np.array(grid.shape)).mean()) / PARTS
    points = grid.centres(PARTS).reshape(-1, 3)
    distances = scene.geometry.distance(points)
    _move_inside(scene, tracer(scene, voxels), points, distances, cell)
    shape = grid.voxels, PARTS**3
    projection = Projection(grid, inside_shares(distances, cell).reshape(shape), points.reshape(*shape, 3))
    if not projection.counting.any() or not (distances < 0.0).any():
        raise failure("no voxel is inside the body", "make it thicker or close it, or use more voxels")
    return projection


def _move_inside(scene: MeasuredScene, rays: Tracer, points: Array, distances: Array, cell: float) -> None:
    """Moves points outside whose cell is partly inside onto the surface: nothing is reflected back to those outside."""
    near = np.flatnonzero(np.abs(distances) < cell)
    steps = 0.25 * cell * np.eye(3)
    slopes = [
        scene.geometry.distance(points[near] + step) - scene.geometry.distance(points[near] - step) for step in steps
    ]
    inward = -unit(np.stack(slopes, axis=1))
    hit, ahead, normal = rays.walls(points[near], inward)
    entering = np.einsum("nc,nc->n", inward[hit], normal) < 0.0
    moved = np.flatnonzero(hit)[entering]
    points[near[moved]] += (ahead[entering] + rays.step)[:, None] * inward[moved]


def medium_of(scene: MeasuredScene, channel: int) -> Medium:
    """The scene's medium in one channel."""
    assert scene.medium is not None
    # a unit of object space is `scale` units of the world, in which the medium is given
    extinction = scene.medium.extinction[channel] * scene.geometry.scale
    boundary = Dielectric(scene.medium.ior, scene.medium.roughness)
    return Medium(extinction, scene.medium.albedo[channel], scene.medium.anisotropy, boundary)
