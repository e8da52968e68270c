"""The mesh's own thickness, baked for a material whose file leaves it at a constant."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from sssgen.bake.bake_facts import ThicknessFacts
from sssgen.bake.texture_unwrap import unwrap_mesh
from sssgen.bake.thickness_map import Request, thickness_map
from sssgen.interchange.imported_material import BAKED_SET, ImportedMaterial
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.mesh_glb import mesh_file
from sssgen.interchange.surface_model import Image, Picture, Quantity
from sssgen.scene.arrays import Array
from sssgen.scene.mesh import Mesh, Triangles
from sssgen.scene.mesh_files import FileContent
from sssgen.scene.pictures.images import png_bytes
from sssgen.support.diagnostics import SssgenError
from sssgen.support.progress import Progress, silent

SIDE, RAYS = 256, 128
"""Texels along a side of the map, and rays per texel."""


OPTION = "--bake"
"""The value of the report's rows about what was not baked."""


def bake_materials(
    materials: Sequence[ImportedMaterial], report: Report, progress: Progress = silent
) -> list[ImportedMaterial]:
    """The materials with the thicknesses of their meshes; the report says where it has no effect, and why."""
    before = len(report.rows)
    result = [bake_thickness(material, report, progress) for material in materials]
    if all(old is new for old, new in zip(materials, result, strict=True)) and len(report.rows) == before:
        report.add_omission("the materials", OPTION, "none has a medium that light enters, a volume or a subsurface")
    return result


def bake_thickness(imported: ImportedMaterial, report: Report, progress: Progress = silent) -> ImportedMaterial:
    """The material with the thickness of its mesh, in texture coordinates of their own.

    It stays as it is without a medium, and where nothing is transmitted. Without a mesh, with a texture of the
    thickness in the file, and for an open sheet, which has no thickness, the report says so.
    """
    model, mesh = imported.model, imported.mesh
    if model.interior is None or not model.transmits:
        return imported
    if mesh is None or model.thickness.image is not None:
        reason = "the material has no mesh" if mesh is None else "the thickness in the file is a texture"
        report.add_omission(f"{model.name}: thickness", OPTION, reason)
        return imported
    elements = imported.elements.get("thickness", ())
    path = elements[0].path if elements else f"{model.name}: thickness"
    value = elements[0].value if elements else "none"
    try:
        baked, picture, facts = _bake(mesh, progress)
    except SssgenError as error:
        report.add_omission(path, OPTION, f"{error.diagnostics[0].message}; the thickness stays as it is in the file")
        return imported
    error_of_mean = facts["error"]["mean_standard_error"]
    became = f"the mesh's own, baked: 0 to {facts['range'][1]:.4g} m, mean {facts['mean']:.4g} m"
    report.add_approximation(path, value, became, f"{error_of_mean:.2g} m, the mean error of the lengths")
    image = Image(Picture("baked thickness", picture), "r", uv_set=BAKED_SET, wrap="clamp")
    return imported._replace(
        model=replace(model, thickness=Quantity((facts["range"][1],), image), thin_walled=False),
        elements={field: rows for field, rows in imported.elements.items() if field != "thickness"},
        mesh=baked[0],
        baked_uv=baked[1],
    )


def _bake(mesh: FileContent, progress: Progress) -> tuple[tuple[FileContent, Array], bytes, ThicknessFacts]:
    """The mesh with a vertex for each corner, its new texture coordinates, the map as a PNG file, and its facts."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "mesh.glb")
        triangles = Mesh(path=path, data=mesh_file(mesh)).triangles
        uv = unwrap_mesh(triangles, progress)
        corners = _split_corners(triangles)
        with open(path, "wb") as file:
            file.write(mesh_file(corners._replace(uv=uv.reshape(-1, 2), uv2=None)))
        baked = thickness_map(path, (SIDE, SIDE), Request(rays=RAYS), processes=0, progress=progress)
    return (corners, uv.reshape(-1, 2)), png_bytes(baked.values, bits=16), baked.facts


def _split_corners(triangles: Triangles) -> FileContent:
    """The triangles with a vertex for each corner."""
    count = len(triangles.corners)

    def flat(values: Array | None) -> Array | None:
        return None if values is None else values.reshape(3 * count, -1)

    return FileContent(
        triangles.places[triangles.corners].reshape(-1, 3),
        np.arange(3 * count).reshape(-1, 3),
        flat(triangles.uv),
        flat(triangles.uv2),
        flat(triangles.color),
        flat(triangles.corner_normals(np.arange(count))),
    )
