"""Depth maps: the distance from a light's plane to the first surface of a mesh."""

from __future__ import annotations

import numpy as np

from sssgen.bake import memory_check as memory
from sssgen.bake.bake_facts import DepthFacts
from sssgen.bake.bake_light import BakeLight
from sssgen.bake.voxel_distance import BLOCK
from sssgen.bake.voxel_grid import Array
from sssgen.jobs.executor import Progress
from sssgen.scene.mesh import Mesh
from sssgen.targets.texture_import import import_settings


def depth_map(
    path: str, light: BakeLight, size: tuple[int, int], progress: Progress = lambda *_: None
) -> tuple[Array, DepthFacts]:
    """The map of a mesh, (height, width), row 0 at the top, in units of the mesh; and the facts for its JSON.

    `size` is (width, height). Texels without a hit have a depth far behind the mesh. Raises SssgenError for a mesh
    that cannot be read, and for a light inside it.
    """
    width, height = size
    memory.check(width * height * 100.0, "use a smaller --size")
    mesh = Mesh(path=path)
    low, high = mesh.bounds()
    view = light.view(mesh.triangles.places, size)
    away = np.maximum(np.linalg.norm(view.origins - 0.5 * (low + high), axis=1) - np.linalg.norm(high - low), 0.0)
    starts = view.origins + away[:, None] * view.directions  # near the mesh, because Embree has 32-bit floats
    depth = np.empty(len(starts))
    for start in range(0, len(starts), BLOCK):
        part = slice(start, start + BLOCK)
        faces, t = mesh.rays.nearest(starts[part], view.directions[part])
        depth[part] = np.where(faces >= 0, (away[part] + t) * view.slopes[part], view.far)
        progress(min(start + BLOCK, len(starts)), len(starts), "depths")
    reached = depth[depth < view.far]
    facts: DepthFacts = {
        "kind": "depth", "holds": None, "light": light.facts(), "unit": "of the mesh",
        "formula": "texel = distance from the light's plane to the first surface",
        "range": [float(reached.min(initial=view.far)), float(reached.max(initial=0.0))], "nothing": view.far,
        "covered": round(len(reached) / len(depth), 6),
        "parameters": {"light_matrix": [float(value) for value in view.matrix.T.ravel()]},
        "import": import_settings(wrap="clamp", mipmaps=False),
    }  # fmt: skip
    return np.flipud(depth.reshape(height, width)), facts
