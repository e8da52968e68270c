"""The ready materials on the mouse of the examples: the files that `sssgen use` writes for each."""

from __future__ import annotations

import functools
from pathlib import Path

from sssgen.presets.engine_project import material_files
from sssgen.presets.preset import Preset, presets
from sssgen.presets.preset_stages import BodySize
from sssgen.presets.request import Request
from sssgen.presets.used_mesh import UsedMesh, used_mesh
from sssgen.scene.geometry_mesh import mesh_of
from sssgen.scene.measured import measured_scene
from sssgen.support.file_writer import write_files
from sssgen.support.paths import folder


def preset_files() -> dict[str, Path]:
    """The name of a preset → the material's file, with the mesh and the scene beside it in the build folder."""
    found = {}
    for preset in presets().values():
        place = Path(folder("build"), "presets_on_mouse", preset.name)
        command = f"sssgen use {preset.name} mouse.obj -o out"
        request = Request(preset, _mesh(preset), "threejs", "good", preset.keeps_color, command)
        write_files(str(place), material_files(request))
        found[preset.name] = place / f"{preset.name}.toml"
    return found


def _mesh(preset: Preset) -> UsedMesh:
    """The mouse, in the size that the preset assumes of a mesh."""
    mesh = _mouse()
    return mesh._replace(size=BodySize(mesh.size.unit_mm * preset.size_mm, mesh.size.mean_chord))


@functools.cache
def _mouse() -> UsedMesh:
    """The mouse, 1 mm large."""
    vertices, faces = mesh_of(measured_scene.load("mouse").geometry)
    lines = [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in vertices]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
    path = Path(folder("build"), "presets_on_mouse", "mouse.obj")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return used_mesh(str(path), 1.0)
