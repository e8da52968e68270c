"""What a preset keeps of the material of a glTF file: relief and occlusion, and the detail of roughness and colour.

The detail is a picture's variation about its mean, so that the mean is that of the preset.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from sssgen.interchange import gltf_reader
from sssgen.interchange.gltf_container import SUFFIXES, open_file
from sssgen.interchange.gltf_meshes import Part, join_parts
from sssgen.interchange.gltf_rest import without_material
from sssgen.interchange.imported_material import ImportedMaterial
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.surface_model import Quantity, SurfaceModel
from sssgen.interchange.texels import mean_of
from sssgen.interchange.texture_composer import Coordinates, coordinates
from sssgen.scene.arrays import Array
from sssgen.scene.mesh_files import FileContent
from sssgen.support.diagnostics import failure
from sssgen.support.paths import posix

_FIELDS = ("normal", "occlusion", "roughness", "base_color", "opacity")
"""The fields of a record whose pictures can be kept."""
_WHITE = (1.0, 1.0, 1.0)
_DARKEST = 1e-3
"""The mean of a picture that is darker counts as this."""
OWN = "the preset has its own"
_NO_COORDINATES = "the mesh has no texture coordinates"


class GltfPart(NamedTuple):
    """The triangles of a glTF file that a preset is put on."""

    mesh: FileContent
    """In metres and world space; its texture coordinates are those of the pictures"""
    imported: ImportedMaterial | None
    """Their material, where it is one alone; its pictures have the mesh's first texture coordinates"""
    others: Sequence[str] = ()
    """The names of further materials: their triangles are in the mesh where no material was chosen, else in `rest`"""
    rest: bytes = b""
    """A .glb with the triangles of further materials, where one was chosen and there are others"""


def is_gltf(path: str) -> bool:
    """Whether a file has materials that are read."""
    return os.path.splitext(path)[1].lower() in SUFFIXES


def read_part(path: str, material: str, report: Report) -> GltfPart:
    """The triangles with a material of a glTF file, or all triangles where `material` is ''.

    The report gets what the reader leaves out. Raises SssgenError for a faulty file, and for a material that it lacks
    or that no triangle has.
    """
    imports = gltf_reader.read(path, report, material)
    names = [element.text("name") for element in open_file(path).root.objects("materials")]
    if names.count(material) > 1:
        numbers = [str(number) for number, name in enumerate(names) if name == material]
        hint = f"choose one by its number: --material {' or '.join(numbers)}"
        raise failure(f"{len(numbers)} materials are called '{material}'", hint, posix(path))
    drawn = [part for part in imports if part.mesh is not None]
    if material and not drawn:
        raise failure(f"no triangle has the material '{material}'", "choose another with --material", posix(path))
    if material:
        chosen = _placed(drawn[0], [name for name in names if name != drawn[0].model.name])
        return chosen._replace(rest=without_material(path, material))
    if not drawn:
        raise failure("the file holds no triangles", "", posix(path))
    if len(drawn) == 1:
        return _placed(drawn[0], ())
    meshes = [part.mesh for part in drawn if part.mesh is not None]
    joined, _, _ = join_parts([Part(mesh, 1.0) for mesh in meshes])
    return GltfPart(joined, None, [part.model.name for part in drawn])


def _placed(imported: ImportedMaterial, others: Sequence[str]) -> GltfPart:
    """A material with the texture coordinates that most of its pictures have as the first ones of its mesh; pictures
    with others are left out, as are all where the mesh has none."""
    mesh, model = imported.mesh, imported.model
    assert mesh is not None
    images = {field: image for field in _FIELDS if (image := getattr(model, field).image) is not None}
    counted = Counter(coordinates(image) for image in images.values())
    place = counted.most_common(1)[0][0] if counted else Coordinates()
    uv = (mesh.uv, mesh.uv2)[place.uv_set]
    changed = {}
    for field, image in images.items():
        quantity = getattr(model, field)
        fits = coordinates(image) == place and uv is not None
        moved = image._replace(uv_set=0, transform=Coordinates().transform) if fits else None
        changed[field] = quantity._replace(image=moved)
    uv = None if uv is None else _transformed(uv, place)
    kept = imported._replace(model=replace(model, **changed))
    return GltfPart(mesh._replace(uv=uv, uv2=None, color=None), kept, others)


def _transformed(uv: Array, place: Coordinates) -> Array:
    """Texture coordinates (v, 2) behind a transform, which the material then need not have."""
    tiling, offset, rotation = place.transform
    sine, cosine = np.sin(np.radians(rotation)), np.cos(np.radians(rotation))
    moved: Array = (uv * tiling) @ np.array([[cosine, sine], [-sine, cosine]]) + offset
    return moved


def with_pictures(model: SurfaceModel, kept: SurfaceModel, keeps_color: bool) -> SurfaceModel:
    """The record of a preset with the pictures that it keeps of a file's record."""
    changed: dict[str, object] = {"normal": kept.normal, "normal_down": kept.normal_down, "occlusion": kept.occlusion}
    if (image := kept.roughness.image) is not None:
        ratio = model.roughness.factor[0] / max(mean_of(Quantity((1.0,), image))[0], _DARKEST)
        changed["roughness"] = Quantity((1.0,), image._replace(scale=image.scale * ratio))
    if keeps_color:
        names = ["base_color", "diffuse_transmission_color", "transmission_tint"]
        quantities = {name: getattr(model, name) for name in names}
        changed |= {name: _varied(value, kept.base_color) for name, value in quantities.items() if value is not None}
        if kept.alpha_mode != "opaque":
            changed |= {"opacity": kept.opacity, "alpha_mode": kept.alpha_mode, "alpha_cutoff": kept.alpha_cutoff}
    return replace(model, **changed)  # type: ignore[arg-type]


def _varied(color: Quantity, kept: Quantity) -> Quantity:
    """A colour that varies as a picture does."""
    if kept.image is None:
        return color
    mean = mean_of(Quantity(_WHITE, kept.image))
    factor = tuple(part / max(middle, _DARKEST) for part, middle in zip(color.factor, mean, strict=True))
    return Quantity(factor, kept.image)


def report_kept(part: GltfPart, keeps_color: bool, report: Report) -> None:
    """Adds a row for each element of the file's material."""
    if part.imported is None:
        return
    model, elements = part.imported.model, part.imported.elements
    kept = {"normal", "normal_down", "occlusion"}
    of_roughness = {path for path, _ in elements.get("roughness", ())}
    if keeps_color and model.alpha_mode != "opaque":
        kept |= {"opacity", "alpha_mode", "alpha_cutoff"}
    for field, places in elements.items():
        for path, value in places:
            if field == "metalness" and path in of_roughness:  # a row of its own
                continue
            is_picture = path.endswith("Texture")
            if is_picture and field in _FIELDS and getattr(model, field).image is None:
                reason = "its texture coordinates are not those of the other pictures"
                report.add_omission(path, value, reason if part.mesh.uv is not None else _NO_COORDINATES)
            elif field in kept:
                report.add_mapping(path, value, field.replace("_", " "))
            elif is_picture and field == "roughness":
                report.add_approximation(path, value, "its variation about the preset's roughness")
            elif is_picture and field == "base_color" and keeps_color:
                report.add_approximation(path, value, "its variation about the preset's colour")
            elif is_picture and field == "base_color":
                report.add_omission(path, value, f"{OWN} colour; --keep-color keeps its detail, except in baked light")
            else:
                report.add_omission(path, value, OWN)
