"""Writes imported materials: for each a folder with its material, textures, mesh and scene; and the report."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence

import numpy as np

from sssgen.interchange.imported_material import BAKED_SET, ImportedMaterial, Notes, report_fields
from sssgen.interchange.imported_view import ImportedView
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.mesh_glb import mesh_file
from sssgen.interchange.scene_text import ball_radius, scene_text, whole_scene_text
from sssgen.interchange.technique_choice import Choice, choose, world_unit
from sssgen.interchange.texture_composer import Coordinates
from sssgen.material.material_text import material_text
from sssgen.material.model import wrong_name
from sssgen.scene.mesh_distance import FLAT, volume_of
from sssgen.scene.mesh_files import FileContent
from sssgen.scene.mesh_repair import has_inside, welded
from sssgen.support.file_writer import check_unchanged, write_files
from sssgen.support.paths import place
from sssgen.support.progress import Progress, silent

_LONGEST_NAME = 48
"""Letters of a material's name; sssgen takes 64."""
WHOLE_SCENE = "scene.toml"
"""The scene that shows all bodies together."""
_OPEN_SHEET = 1e-4
"""The volume of an open mesh, over the cube of its size, up to which it is a sheet."""
_PLAIN = ImportedView()
SURROUNDINGS = "surroundings.png"
"""The picture of the surroundings that all scenes of an import share."""


class WrittenMaterial:
    """Where a material was written."""

    def __init__(self, name: str, folder: str, transmits: bool) -> None:
        self.name = name
        self.transmits = transmits
        self.material = f"{name}/{name}.toml"
        self.scene = f"{name}/scene.toml"
        self.folder = folder


def write_import(
    folder: str,
    materials: Sequence[ImportedMaterial],
    report: Report,
    view: ImportedView = _PLAIN,
    *,
    force: bool = False,
    progress: Progress = silent,
) -> list[WrittenMaterial]:
    """Writes the materials of a file to sub-folders of `folder`, all files atomically and together.

    Adds the rows of the materials' fields to the report, which is written as report.md and report.json. Raises
    SssgenError for a picture that cannot be read, where the system refuses, and, without `force`, where a file of a
    material is there already with another content: it may have been edited. `view` is that of the scene that shows all
    bodies together, which is written where any material has a mesh.
    """
    files: dict[str, str | bytes] = {}
    written: list[WrittenMaterial] = []
    names = identifiers([part.model.name for part in materials])
    chords = [4.0 / 3.0 * ball_radius(part.model) if part.mesh is None else mean_chord(part.mesh) for part in materials]
    metres = world_unit([(part.model, chord) for part, chord in zip(materials, chords, strict=True)])
    for done, (imported, name, chord) in enumerate(zip(materials, names, chords, strict=True)):
        progress(done, len(materials), name)
        notes = Notes()
        closed = imported.mesh is None or is_closed(imported.mesh)
        choice = choose(imported.model, notes, chord, closed, metres)
        report_fields(imported, notes, report)
        files |= {f"{name}/{path}": content for path, content in _material_files(imported, choice, name).items()}
        written.append(WrittenMaterial(name, folder, imported.model.transmits))
    with open(os.path.join(place("examples"), "surroundings", "textures", "room.png"), "rb") as file:
        files[SURROUNDINGS] = file.read()
    if meshes := [part.mesh for part in materials if part.mesh is not None]:
        shown = [part.scene for part, imported in zip(written, materials, strict=True) if imported.mesh is not None]
        files[WHOLE_SCENE] = whole_scene_text(report.source, shown, meshes, view, metres, SURROUNDINGS)
    reports: dict[str, str | bytes] = {"report.md": report.markdown(), "report.json": report.json_text()}
    if not force:
        imported_before = all(os.path.isfile(os.path.join(folder, name)) for name in reports)
        check_unchanged(folder, files if imported_before else files | reports)
    files |= reports
    write_files(folder, files)
    return written


def _material_files(imported: ImportedMaterial, choice: Choice, name: str) -> dict[str, str | bytes]:
    model = imported.model
    title = " ".join(re.findall(r"\w+", model.name)) or name
    doc = model.doc or f"Imported: {title}."
    files: dict[str, str | bytes] = {f"{name}.toml": material_text(name, choice.stages, title, doc, choice.settings)}
    files |= choice.files
    mesh = imported.mesh
    if mesh is not None:
        files["mesh.glb"] = mesh_file(_scene_mesh(imported, mesh, choice.coordinates))
    files["scene.toml"] = scene_text(model, choice, name, mesh, SURROUNDINGS)
    return files


def _scene_mesh(imported: ImportedMaterial, mesh: FileContent, coordinates: Sequence[Coordinates]) -> FileContent:
    """The mesh with the sets of texture coordinates that the material reads as `uv` and `uv2`."""
    sets = {0: mesh.uv, 1: mesh.uv2, BAKED_SET: imported.baked_uv}
    chosen = [sets.get(place.uv_set) for place in coordinates]
    return mesh._replace(uv=chosen[0], uv2=chosen[1] if len(chosen) > 1 else None)


def identifiers(names: Sequence[str]) -> list[str]:
    """Names of materials, all different: identifiers in lower case."""
    result: list[str] = []
    for name in names:
        words = re.sub(r"[^a-z0-9]+", "_", re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()).strip("_")
        base = words[:_LONGEST_NAME].strip("_") or "material"
        base = f"material_{base}" if wrong_name(base) else base
        unused, number = base, 2
        while unused in result:
            unused, number = f"{base}_{number}", number + 1
        result.append(unused)
    return result


def is_closed(mesh: FileContent) -> bool:
    """Whether the triangles have an inside; vertices at one place count as one."""
    return has_inside(welded(mesh.vertices, mesh.faces)[1][mesh.faces])


def mean_chord(mesh: FileContent) -> float:
    """The mean chord 4 V / S of a body (Cauchy), or a tenth of the size of an open sheet."""
    corners = mesh.vertices[mesh.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = 0.5 * float(np.linalg.norm(across, axis=1).sum())
    volume = abs(volume_of(mesh.vertices, mesh.faces))
    size = float(np.linalg.norm(np.ptp(mesh.vertices, axis=0)))
    least = FLAT if is_closed(mesh) else _OPEN_SHEET
    return 4.0 * volume / area if area > 0.0 and volume > least * size**3 else 0.1 * size
