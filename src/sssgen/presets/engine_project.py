"""A project of an engine that shows a preset on a mesh: its material, shaders, mesh, scene and page.

The files of an engine are the templates of `templates/projects/TARGET/`, with those of `page/` where a browser shows
them; those beside the folders are for all engines.
"""

from __future__ import annotations

import json
import os

from sssgen.interchange.gltf_writer import export
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.material_writer import SURROUNDINGS
from sssgen.ir.frame_passes import BEHIND
from sssgen.material.material_loading import parse_material
from sssgen.material.model import Material
from sssgen.material.shell_stages import with_shell
from sssgen.pipeline.compiler import compile
from sssgen.presets import unity_assets, webgpu_page
from sssgen.presets.bound_textures import bound_textures
from sssgen.presets.preset_stages import preset_material
from sssgen.presets.project_templates import Files, folder_names, render
from sssgen.presets.request import MESH, REST, Request, shared_values
from sssgen.run.web_library import NETWORK, library, network_import_map
from sssgen.support.diagnostics import SssgenError
from sssgen.support.paths import place

_MODULES = "./node_modules"
_IMPORTS = {
    "babylonjs": {name: f"{_MODULES}/{name}" for name in ("@babylonjs/core/", "@babylonjs/loaders/")},
    "playcanvas": {"playcanvas": f"{_MODULES}/playcanvas/build/playcanvas.mjs"},
}
"""Target → what its page imports from the packages of npm beside it"""


def material_files(request: Request) -> Files:
    """The material, the mesh and the scene, which `sssgen render`, `preview` and `bake` read."""
    mesh = request.mesh
    material = preset_material(
        request.preset, request.quality, request.name, mesh.size, request.kept, request.keeps_color
    )
    with open(os.path.join(place("examples"), "surroundings", "textures", "studio.png"), "rb") as file:
        picture = file.read()
    scene = render("scene.toml", **shared_values(request))
    files: Files = {f"{request.name}.toml": material.text, MESH: mesh.glb, "scene.toml": scene, SURROUNDINGS: picture}
    return _in_folder(request, files | dict(material.files))


def engine_files(request: Request, folder: str) -> Files:
    """The shaders and the project around them. The material and its bakes are in `folder` already.

    Raises SssgenError where the target cannot express the material.
    """
    path = os.path.join(folder, request.folder, f"{request.name}.toml")
    with open(path, encoding="utf-8") as file:
        material = parse_material(file.read(), path)
    if request.target == "gltf":
        return _gltf_files(request, material)
    engine, target = request.engine, request.engine.shader or request.target
    compiled = compile(with_shell(material, engine.shell) if engine.shell else material, target)
    values = shared_values(request) | {
        "passes": f"{request.name}_passes.gd" in compiled.files,
        "textures": bound_textures(material, compiled.reflection),
        "shows_scene": any(drawn["name"] == BEHIND for drawn in compiled.reflection["passes"]),
    }
    if engine.has_folders:
        return unity_assets.files(request, compiled, values, folder)
    files: Files = dict(compiled.files) | ({REST: request.rest} if request.rest else {})
    if request.target == "webgpu":
        files |= webgpu_page.files(engine)
        values |= {"air": webgpu_page.AIR, "glow": webgpu_page.glow()}
    if engine.is_page:
        values["package"] = engine.package
        import_map, libraries = _import_map(request.target)
        values |= {"import_map": import_map, "network": NETWORK if NETWORK in import_map else ""}
        files |= libraries
    for name, template in _templates(request).items():
        files[name] = render(template, **values)
    return files


def _templates(request: Request) -> dict[str, str]:
    """File → its template."""
    folders = [*(["page"] if request.engine.is_page else []), request.target]
    return {"README.md": "README.md"} | {
        name: f"{folder}/{name}" for folder in folders for name in folder_names(folder)
    }


def _in_folder(request: Request, files: Files) -> Files:
    return {f"{request.folder}{name}": content for name, content in files.items()}


def _gltf_files(request: Request, material: Material) -> Files:
    """A .glb with the extensions of Khronos, and the report about what they can say of the material."""
    name, report = f"{request.name}.glb", Report(request.name)
    files: Files = dict(export(material, request.mesh.content, name, report))
    return files | {"report.md": report.markdown(), "README.md": render("README.md", **shared_values(request))}


def _import_map(target: str) -> tuple[str, Files]:
    """The import map of a page, or '', and the files of the engine that it names.

    Without the bundle of three.js and without npm there are none: a browser then loads them from the network.
    """
    if target in _IMPORTS:
        return json.dumps({"imports": _IMPORTS[target]}, indent=2), {}
    if target != "threejs":
        return "", {}
    try:
        web = library()
    except SssgenError:
        return network_import_map(), {}
    return web.import_map(), {f"library/{name}": source.read_bytes() for name, source in web.files.items()}
