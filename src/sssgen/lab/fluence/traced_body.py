"""A scene's body as light tracing needs it, in object space; the last ones are kept."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from sssgen.lab.fluence.photons import Body, Medium, Tracer
from sssgen.lab.fluence.projection import Projection, inside_shares
from sssgen.lab.fluence.voxels import Grid
from sssgen.scene.geometry_mesh import mesh_of
from sssgen.scene.measured import scene_body
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.support.diagnostics import failure

PARTS = 4
"""The points along each axis of a voxel at which the body's distance is evaluated."""


def grid_in_box(scene: MeasuredScene, voxels: int) -> Grid:
    """The grid that fills the box of the body's distance texture."""
    texture = scene_body.distance_texture(scene.geometry)
    low, high = np.array(texture.box_min), np.array(texture.box_max)
    x, y, z = np.maximum(np.rint(voxels * (high - low) / (high - low).max()).astype(int), 1)
    return Grid(low, high, (int(x), int(y), int(z)))


@lru_cache(4)
def projection_of(scene: MeasuredScene, voxels: int) -> Projection:
    """How values inside a scene's body become texels. Raises SssgenError for a body without an inside."""
    grid = grid_in_box(scene, voxels)
    cell = float(((grid.high - grid.low) / np.array(grid.shape)).mean()) / PARTS
    distances = scene.geometry.distance(grid.centres(PARTS).reshape(-1, 3))
    projection = Projection(grid, inside_shares(distances, cell).reshape(grid.voxels, -1))
    if not projection.counting.any() or not (distances < 0.0).any():
        raise failure("no voxel is inside the body", "use more voxels, or close the mesh")
    return projection


@lru_cache(4)
def tracer(scene: MeasuredScene, voxels: int) -> Tracer:
    """The tracer of a scene's body."""
    vertices, faces = mesh_of(scene.geometry)
    to_object = scene.geometry.to_object()
    body = Body(vertices @ to_object[:3, :3].T + to_object[:3, 3], faces)
    return Tracer(body, grid_in_box(scene, voxels))


def medium_of(scene: MeasuredScene, channel: int) -> Medium:
    """The scene's medium in one channel."""
    assert scene.medium is not None
    # a unit of object space is `scale` units of the world, in which the medium is given
    extinction = scene.medium.extinction[channel] * scene.geometry.scale
    return Medium(extinction, scene.medium.albedo[channel], scene.medium.anisotropy, scene.medium.ior)
