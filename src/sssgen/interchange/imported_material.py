"""A material that a reader has read, and the notes about what became of its parts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from sssgen.interchange.mapping_report import Report
from sssgen.interchange.surface_model import SurfaceModel
from sssgen.scene.arrays import Array
from sssgen.scene.mesh_files import FileContent
from sssgen.support.diagnostics import did_you_mean, failure

BAKED_SET = 2
"""The number of a set of texture coordinates, beside the two of the file."""


class Element(NamedTuple):
    """An element of the source file that gives a field of the model its value."""

    path: str
    """In the file, such as /materials/0/extensions/KHR_materials_ior/ior"""
    value: object


class ImportedMaterial(NamedTuple):
    """One material of a file."""

    model: SurfaceModel
    elements: Mapping[str, Sequence[Element]]
    """Field of `SurfaceModel` → the elements that it comes from. `material_writer` reports them as mapped, or as
    approximated where the techniques cannot express the field. What a reader itself leaves out or approximates, it
    reports itself."""
    mesh: FileContent | None = None
    """The triangles with this material, in metres and world space; None for a format without meshes"""
    baked_uv: Array | None = None
    """(v, 2): the texture coordinates of the set BAKED_SET, of a texture that was baked for the mesh"""


def check_name(name: str, names: Sequence[str], file: str) -> None:
    """Raises SssgenError where a file has no material with this name or number; '' stands for all."""
    if name and name not in names and name not in map(str, range(len(names))):
        listed = f"materials: {', '.join(filter(None, names))[:300] or 'without names'}, or a number from 0"
        hint = did_you_mean(name, filter(None, names)) or listed if names else "it has none: leave --material out"
        raise failure(f"the file has no material '{name}'", hint, file)


class Notes:
    """What a material cannot express, by the field of its model."""

    def __init__(self) -> None:
        self.by_field: dict[str, tuple[str, str]] = {}

    def add_approximation(self, field: str, became: str, error: str = "") -> None:
        """Notes that a field is approximated; the first note of a field is kept."""
        self.by_field.setdefault(field, (became, error))


def report_fields(imported: ImportedMaterial, notes: Notes, report: Report) -> None:
    """Adds a row for each element of the material, and for each note of a field that no element gives."""
    for field, elements in imported.elements.items():
        for element in elements:
            if field in notes.by_field:
                report.add_approximation(element.path, element.value, *notes.by_field[field])
            else:
                report.add_mapping(element.path, element.value, field.replace("_", " "))
    for field in notes.by_field.keys() - imported.elements.keys():
        report.add_approximation(
            f"{imported.model.name}: {field.replace('_', ' ')}", "not in the file", *notes.by_field[field]
        )
