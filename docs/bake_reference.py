"""The exact thickness at the points that a scene's camera sees: the reference of the pictures in docs/bake.py."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from sssgen.bake.atlas import fill_map
from sssgen.bake.bake_facts import BakeFacts
from sssgen.bake.baked_files import write_picture
from sssgen.lab.reference.inside_lengths import thickness
from sssgen.scene.geometry import Mesh
from sssgen.scene.inside_intervals import intervals
from sssgen.scene.light_view import point_view
from sssgen.scene.scene import Scene
from sssgen.scene.scene_loading import load
from sssgen.targets.texture_import import import_settings

SIZE = 1024
"""Texels along a side of the map."""
STEPS = 24
"""The number of points on a view ray inside the body at which the path of the light is measured."""


def write(scene_file: Path, name: str, deep: bool) -> Path:
    """Writes a copy of a scene with the exact thickness in place of the technique's; returns its path.

    The thickness is the length inside the body from the visible point towards the first light. With `deep` it is the
    mean, over the points of the view ray inside the body, of the path from the light to the point and on to the eye, as
    in march_distance_texture.
    """
    scene, folder = load(scene_file), scene_file.parent
    mesh, towards = scene.geometry, scene.lights[0].direction
    assert isinstance(mesh, Mesh) and towards is not None
    outwards = mesh.to_world()
    corners = mesh.triangles.places @ outwards[:3, :3].T + outwards[:3, 3]
    view = point_view(corners, np.array(scene.camera.position), (SIZE, SIZE))
    inwards = mesh.to_object()
    met, t = mesh.rays.nearest(view.origins @ inwards[:3, :3].T + inwards[:3, 3], view.directions @ inwards[:3, :3].T)
    hit = met >= 0
    places = view.origins[hit] + t[hit, None] * view.directions[hit]
    light = np.broadcast_to(np.array(towards), places.shape).copy()
    lengths = _deep(mesh, places, view.directions[hit], light) if deep else thickness(mesh, places, light)
    values = np.zeros(len(met))
    values[hit] = lengths / lengths.max()
    facts: BakeFacts = {
        "kind": "exact", "holds": "thickness",
        "parameters": {
            "exact_factor": float(lengths.max()), "camera_matrix": [float(number) for number in view.matrix.T.ravel()]
        },
        "import": import_settings(wrap="clamp", mipmaps=False),
    }  # fmt: skip
    # texels outside of the body are filled from inside, so that filters do not darken its edge
    rows = np.arange(SIZE * SIZE).reshape(SIZE, SIZE)[::-1].ravel()  # rows of the view go up, those of a picture down
    texels = np.flatnonzero(hit[rows])
    picture = fill_map(values[rows][texels], texels, (SIZE, SIZE))
    write_picture(str(folder / f"{name}.exr"), picture, facts)
    return _scene_file(scene, scene_file, name)


def _deep(mesh: Mesh, places: Any, ways: Any, light: Any) -> Any:
    """The mean length of the light's path in the body, from the light to a point and on along the view ray."""
    inwards = mesh.to_object()
    local, along = places @ inwards[:3, :3].T + inwards[:3, 3], ways @ inwards[:3, :3].T * mesh.scale
    parts = intervals(mesh, local, along) * mesh.scale
    lengths = parts[..., 1] - parts[..., 0]
    visible = lengths.sum(axis=1)
    before = np.cumsum(lengths, axis=1) - lengths
    total = np.zeros(len(places))
    for step in range(STEPS):
        inside = (step + 0.5) / STEPS * visible
        last = np.maximum((before <= inside[:, None]).sum(axis=1) - 1, 0)
        rows = np.arange(len(places))
        way = parts[rows, last, 0] + inside - before[rows, last]
        total += inside + thickness(mesh, places + way[:, None] * ways, light)
    mean = total / STEPS
    return np.where(visible > 1e-6, mean, thickness(mesh, places, light))


def _scene_file(scene: Scene, scene_file: Path, name: str) -> Path:
    """Writes the scene and its material with the exact technique."""
    folder = scene_file.parent
    material = (folder / Path(scene.material).name).read_text(encoding="utf-8")
    head, _, rest = material.partition("[thickness]")
    after = rest[rest.index("[translucency]") :]
    own = f'{head}[thickness]\ntechnique = "exact_thickness.sss"\n\n{after}'
    (folder / "wax_exact.toml").write_text(own, encoding="utf-8")
    text = scene_file.read_text(encoding="utf-8")
    text = text[: text.index("[textures]")] + f'[textures]\nexact_map = "{name}.exr"\n'
    text = text.replace(f'"{Path(scene.material).name}"', '"wax_exact.toml"')
    path = folder / f"{name}.toml"
    path.write_text(text, encoding="utf-8")
    return path
