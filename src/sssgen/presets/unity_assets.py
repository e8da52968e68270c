"""The Assets folder of a Unity project with URP: a folder for the preset, and one for the scripts that all share.

Unity refers to a file by the GUID in the `.meta` file beside it. Here a GUID is the hash of the file's place: it stays
the same when a project is written again.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from sssgen.interchange.material_writer import SURROUNDINGS
from sssgen.pipeline.compiler import Compiled
from sssgen.presets.bound_textures import BoundTexture
from sssgen.presets.preset_stages import RESPONSE
from sssgen.presets.project_templates import Files, render
from sssgen.presets.request import Request
from sssgen.scene.mesh_files import FileContent
from sssgen.support.diagnostics import failure
from sssgen.support.paths import posix
from sssgen.targets import registry
from sssgen.targets.javascript_runtime import runtime_text
from sssgen.targets.texture_import import import_settings

MODEL = "body.obj"
_SHARED = "Sssgen"
_TEMPLATES = "unity-urp"
_IMPORTERS = {
    ".cs": "MonoImporter", ".shader": "ShaderImporter", ".mat": "NativeFormatImporter", ".bytes": "TextScriptImporter",
    ".json": "TextScriptImporter",
}  # fmt: skip
"""Ending of a file → what imports it"""


def guid_of(place: str) -> str:
    """The GUID of a file at a place in the folder, such as `wax/wax.mat`."""
    return hashlib.md5(f"sssgen {place}".encode(), usedforsecurity=False).hexdigest()


def files(request: Request, compiled: Compiled, values: Mapping[str, Any], folder: str) -> Files:
    """The files of the folder beside those of the material, which are in `folder` already. Raises SssgenError where its
    bake is missing."""
    own = _own_files(request, compiled, values, folder)
    pictures = {request.folder + texture.file: texture.settings for texture in values["textures"]}
    pictures[request.folder + SURROUNDINGS] = import_settings(srgb=True)
    result: Files = {f"{request.folder}{name}": content for name, content in own.items()} | _scripts()
    result |= {
        f"{name}.meta": _render("texture.meta", guid=guid_of(name), settings=pictures[name]) for name in pictures
    }
    model = request.folder + MODEL
    result[f"{model}.meta"] = _render("model.meta", guid=guid_of(model))
    for name in list(result):
        if (importer := _IMPORTERS.get(os.path.splitext(name)[1])) is not None:
            result[f"{name}.meta"] = _render("asset.meta", guid=guid_of(name), importer=importer)
    return result


def _render(file: str, **values: object) -> str:
    return render(f"{_TEMPLATES}/{file}", **values)


def _scripts() -> Files:
    """The scripts that all presets share."""
    target = registry.load("unity-urp")
    runtimes = [file for file in target.files["shader"] if file.name.endswith(".cs")]
    return {
        **{f"{_SHARED}/{file.name}": runtime_text(file.sources, target.folder) for file in runtimes},
        f"{_SHARED}/SssgenOrbit.cs": _render("SssgenOrbit.cs"),
        f"{_SHARED}/Editor/SssgenScene.cs": _render("SssgenScene.cs"),
    }


def _own_files(request: Request, compiled: Compiled, values: Mapping[str, Any], folder: str) -> Files:
    """The files in the preset's folder."""
    name, mesh = request.name, request.mesh
    shader = f"{name}.unity-urp.shader"
    result: Files = {file: text for file, text in compiled.files.items() if not file.endswith(".cs")}
    guids = {"model": MODEL, "material": f"{name}.mat", "surroundings": SURROUNDINGS, "bake": "", "facts": ""}
    if request.baked:
        guids |= {"bake": os.path.splitext(RESPONSE)[0] + ".bytes", "facts": f"{RESPONSE}.json"}
        result |= _bake(os.path.join(folder, request.folder), guids["bake"])
    textures: list[BoundTexture] = values["textures"]
    class_name = "".join(word.capitalize() for word in name.split("_")) + "Scene"
    known = {key: guid_of(request.folder + file) if file else "" for key, file in guids.items()}
    longest = float(np.subtract(mesh.high, mesh.low).max())
    scene = {**values, "class_name": class_name, "guids": known, "longest": round(longest, 6)}
    pictures = [(texture.name, guid_of(request.folder + texture.file)) for texture in textures]
    material = {"name": name, "shader": guid_of(request.folder + shader), "pictures": pictures}
    return result | {
        MODEL: obj_text(mesh.content),
        f"{name}.mat": _render("material.mat", **material),
        f"Editor/{class_name}.cs": _render("Scene.cs", **scene),
        "README.md": render("README.md", **values),
    }


def _bake(folder: str, name: str) -> Files:
    """The baked light, under the name with which Unity reads it, and its JSON."""
    path = os.path.join(folder, RESPONSE)
    try:
        with open(path, "rb") as data, open(f"{path}.json", "rb") as facts:
            return {name: data.read(), f"{RESPONSE}.json": facts.read()}
    except OSError as error:
        raise failure(f"cannot read the bake: {error.strerror}", "write the project again", posix(path)) from None


def obj_text(mesh: FileContent) -> str:
    """The triangles as a Wavefront .obj, which Unity reads without a package. Its importer negates x."""
    rows = [f"v {x:.7g} {y:.7g} {z:.7g}" for x, y, z in mesh.vertices]
    if mesh.uv is not None:
        rows += [f"vt {u:.7g} {v:.7g}" for u, v in mesh.uv]
    if mesh.normals is not None:
        rows += [f"vn {x:.6f} {y:.6f} {z:.6f}" for x, y, z in mesh.normals]
    corner = {(False, False): "{0}", (True, False): "{0}/{0}", (False, True): "{0}//{0}", (True, True): "{0}/{0}/{0}"}[
        mesh.uv is not None, mesh.normals is not None
    ]
    rows += ["f " + " ".join(corner.format(index + 1) for index in face) for face in mesh.faces.tolist()]
    return "\n".join(["# made by sssgen", "o body", *rows]) + "\n"
