"""Reads glTF and GLB files: all materials of a file as neutral records, with their triangles."""

from __future__ import annotations

from dataclasses import replace

from sssgen.interchange.gltf_buffers import Buffers
from sssgen.interchange.gltf_container import open_file
from sssgen.interchange.gltf_json import JsonElement
from sssgen.interchange.gltf_materials import EXTENSIONS, MaterialReader, default_material
from sssgen.interchange.gltf_meshes import join_parts, meshes
from sssgen.interchange.gltf_textures import Textures
from sssgen.interchange.imported_material import ImportedMaterial, check_name
from sssgen.interchange.mapping_report import Report, short_text
from sssgen.scene.mesh_files import FileContent

_OTHER_EXTENSIONS = ("KHR_texture_transform", "EXT_texture_webp", "KHR_mesh_quantization")
_HARMLESS_EXTENSIONS = (
    "KHR_materials_iridescence",
    "KHR_materials_anisotropy",
    "KHR_materials_dispersion",
    "KHR_materials_variants",
    "KHR_lights_punctual",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "KHR_animation_pointer",
    "KHR_node_visibility",
    "MSFT_lod",
)
"""Extensions that a file may require: without them it is still read rightly, except for what the report names."""
_DECODED = {
    **dict.fromkeys(
        ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"),
        "write it without compression: npx @gltf-transform/cli copy FILE.glb plain.glb",
    ),
    "KHR_texture_basisu": "write its KTX2 pictures as PNG: npx @gltf-transform/cli ktxdecompress FILE.glb plain.glb",
}
"""Extension of compressed data → what to do."""
_MOTIONS = {"animations": "a material does not move", "skins": "the mesh is taken in its rest pose"}


def read(path: str, report: Report, name: str = "", top: str = "") -> list[ImportedMaterial]:
    """The materials of a glTF file that its scene shows, and those that no mesh uses.

    With `name`, that material alone. Buffers and pictures lie in the folder `top`, by default that of the file. Adds to
    the report what is left out. Raises SssgenError, whose message has the JSON path of the element, for a file that is
    faulty or needs an extension that is not read.
    """
    container = open_file(path, top)
    root = container.root
    _check_extensions(root)
    buffers = Buffers(container)
    textures = Textures(buffers, report)
    elements = root.objects("materials")
    check_name(name, [element.text("name") for element in elements], root.file)
    for key, reason in _MOTIONS.items():
        if root.items(key):
            report.add_omission(f"/{key}", len(root.items(key)), reason)
    parts = meshes(buffers, report)
    result = []
    for index, element in enumerate(elements):
        if name in ("", element.text("name"), str(index)):
            mesh, scale, spread = join_parts(parts[index]) if index in parts else (None, 1.0, 0.0)
            material = MaterialReader(element, textures, report, scale).read()
            if spread > 1e-3 and "thickness" in material.elements:
                became = f"the mean scale {scale:.4g} of its nodes"
                report.add_approximation(
                    f"{element.path} at nodes of different scales", spread, became, f"{spread:.1%}"
                )
            if mesh is not None and mesh.color is not None:
                report.add_mapping(f"{element.path}: COLOR_0", "colours of vertices", "a factor of the base colour")
            result.append(_with_mesh(material, mesh))
    if -1 in parts and not name:
        result.append(_with_mesh(default_material(root.file), join_parts(parts[-1])[0]))
    if not result:
        raise root.fault("the file has neither materials nor triangles")
    return result


def _with_mesh(material: ImportedMaterial, mesh: FileContent | None) -> ImportedMaterial:
    colored = mesh is not None and mesh.color is not None
    return material._replace(model=replace(material.model, vertex_colors=colored), mesh=mesh)


def _check_extensions(root: JsonElement) -> None:
    supported = {*EXTENSIONS, *_OTHER_EXTENSIONS, *_HARMLESS_EXTENSIONS}
    for element in root.items("extensionsRequired"):
        if not isinstance(element.value, str):
            raise element.fault(f"a string is needed, not {short_text(element.value)}")
        if element.value not in supported:
            hint = _DECODED.get(
                element.value, "export the file without this extension: it says that it is wrong without it"
            )
            raise element.fault(f"the file requires '{element.value[:60]}', which is not read", hint)
