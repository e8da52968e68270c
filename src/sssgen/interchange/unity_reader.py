"""Reads Unity's materials (.mat) and HDRP's diffusion profiles (.asset)."""

from __future__ import annotations

from collections.abc import Callable

from sssgen.interchange.diffusion_profile import read_profile
from sssgen.interchange.imported_material import Element, ImportedMaterial, check_name
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.surface_model import SurfaceModel
from sssgen.interchange.unity_material import UnityMaterial, constant, material_of
from sssgen.interchange.unity_project import UnityProject
from sssgen.interchange.unity_surfaces import high_definition_lit, universal_lit, unlit
from sssgen.support.paths import posix

_Reader = Callable[[UnityMaterial], SurfaceModel]
_BUILTIN = "0000000000000000f000000000000000"
_STANDARD, _STANDARD_SPECULAR = 46, 45
"""The file IDs of the shaders Standard and Standard (Specular setup) of the built-in pipeline."""

_SHADERS: dict[str, _Reader] = {
    "933532a4fcc9baf4fa0491de14d08ed7": universal_lit,
    "ee7e4c9a5f6364b688a332c67fc32cca": universal_lit,
    "8d2bb70cbf9db8d4da26e15b26e74248": universal_lit,
    "650dd9526735d5b46b79224bc6e94025": unlit,
    "6e4ae4064600d784cac1e41a9e6f2e59": high_definition_lit,
    "756bac9090102564582875f4c7e30202": high_definition_lit,
    "c4edd00ff2db5b24391a4fcb1762e459": unlit,
}
"""GUID → reader: URP's Lit, Complex Lit, Simple Lit and Unlit; HDRP's Lit, LitTessellation and Unlit."""
_NAMES = "Lit, Complex Lit, Simple Lit and Unlit of URP, Lit and Unlit of HDRP, and Standard"
_PROFILE_COLOR = (0.8, 0.8, 0.8)
"""The base colour of a profile that is imported without a material."""


def read(path: str, report: Report, name: str = "", top: str = "") -> list[ImportedMaterial]:
    """The material or the diffusion profile of a file; `name` is '' or that of the material.

    Textures, parents and profiles are searched in the project or, where it is given, in the folder `top`. Adds to the
    report what is left out. Raises SssgenError where the file is not Unity's, a type is wrong, or the shader unknown.
    """
    if path.lower().endswith(".asset"):
        imported = _profile(path, report)
    else:
        material = material_of(path, UnityProject(path, top), report)
        model = _reader_of(material)(material)
        material.check_complete()
        imported = ImportedMaterial(model, {field: parts for field, parts in material.elements.items() if parts})
    check_name(name, [imported.model.name], posix(path))
    return [imported]


def _reader_of(material: UnityMaterial) -> _Reader:
    guid, file_id = material.shader
    if guid in _SHADERS:
        return _SHADERS[guid]
    if guid == _BUILTIN and file_id in (_STANDARD, _STANDARD_SPECULAR):
        if file_id == _STANDARD_SPECULAR:
            material.keywords.add("_SPECULAR_SETUP")
        return universal_lit
    lit = high_definition_lit if material.has("_BaseColorMap") else universal_lit
    if material.has("_BaseColor") and (material.has("_BaseColorMap") or material.has("_BaseMap")):
        report_path = f"{material.name}/m_Shader"
        text = f"read by the names of its properties, as {_NAMES} have them"
        material.report.add_approximation(report_path, guid or file_id, text)
        return lit
    shader = material.body.mapping.get("m_Shader", material.body)
    raise shader.error(f"the shader {guid or file_id} is not read", f"read are {_NAMES}")


def _profile(path: str, report: Report) -> ImportedMaterial:
    """A diffusion profile as a body of its medium."""
    profile = read_profile(path)
    name = profile.name
    model = SurfaceModel(
        name,
        base_color=constant(*_PROFILE_COLOR),
        roughness=constant(0.5),
        ior=profile.ior,
        subsurface=constant(1.0),
        interior=profile.interior(_PROFILE_COLOR),
        thickness=constant(profile.thickness[1]),
    )
    distances = tuple(1e3 * part for part in profile.distance)
    report.add_approximation(
        f"{name}/profile/scatteringDistance", distances, "the medium of a base colour of 0.8, as the profile has none"
    )
    report.add_omission(f"{name}/profile/transmissionTint", profile.tint, "the colour follows from the medium")
    if profile.unit != 1.0:
        report.add_mapping(f"{name}/profile/worldScale", profile.unit, "nothing: lengths are metres")
    elements = {
        "ior": [Element(f"{name}/profile/ior", profile.ior)],
        "thickness": [Element(f"{name}/profile/thicknessRemap", tuple(1e3 * part for part in profile.thickness))],
    }
    return ImportedMaterial(model, elements)
