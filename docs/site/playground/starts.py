"""What the playground begins with: presets, examples, a new material, plain GLSL; and the pieces of their pictures.

What needs NumPy is computed here, once: the bodies, the textures, the values of the scenes. In the browser only text is
made, and the part of a picture's head that follows from it.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
from pathlib import Path
from typing import Any, NamedTuple

from body_piece import packed_body
from packed_file import write_packed
from playground_session import texture_files
from preset_starts import preset_files
from sssgen.material.material_loading import examples, load_material
from sssgen.pipeline.compiler import compile
from sssgen.preview.bodies import SHAPES, packed_triangles
from sssgen.preview.emitted_head import PARTS, TARGET, emitted_head
from sssgen.preview.flat_picture import raymarched_picture
from sssgen.preview.picture import Choices, Picture, picture_of
from sssgen.scene.preview_scene import scene_of
from sssgen.scene.scene import Scene
from sssgen.support.diagnostics import SssgenError
from sssgen.support.file_memo import noted_files
from sssgen.support.toml_source import parse

PRESET = "preset_"
"""What the names of presets begin with here: an example may have the same name."""
OWN = Path(__file__).with_name("starts")
"""Beginnings that are no examples: a material, and a file of plain GLSL."""


class Start(NamedTuple):
    """A beginning: the files that one edits, and the data that the compiler reads beside them."""

    title: str
    main: str
    """The material's or the GLSL file."""
    files: dict[str, str]
    data: dict[str, str]
    source: str
    """What `scene_of` takes; '' for plain GLSL, which has no scene."""
    preset: str = ""
    """The preset that it shows on the mouse"""


def all_starts() -> dict[str, Start]:
    """Every start by its name, which is that of its folder in the browser."""
    return {**_of_presets(), **{name: _of_example(name, Path(path)) for name, path in examples().items()}, **_own()}


def _of_presets() -> dict[str, Start]:
    found = {}
    for preset, path in preset_files().items():
        text = _text(path)
        start = Start(_title(text, path.name), path.name, {path.name: text}, {}, str(path), preset)
        found[f"{PRESET}{preset}"] = start
    return found


def _of_example(name: str, path: Path) -> Start:
    texts = {file.name: _text(file) for file in sorted(path.parent.iterdir()) if file.suffix in (".toml", ".sss")}
    files = {file: text for file, text in texts.items() if file == path.name or file.endswith(".sss")}
    data = {file.relative_to(path.parent).as_posix(): _text(file) for file in path.parent.rglob("*.json")}
    main = {path.name: files.pop(path.name)}
    return Start(_title(main[path.name], path.name), path.name, main | files, data, name)


def _own() -> dict[str, Start]:
    found = {}
    for folder in sorted(path for path in OWN.iterdir() if path.is_dir()):
        files = {path.name: _text(path) for path in sorted(folder.iterdir())}
        main, material = (
            (f"{folder.name}.toml", True) if f"{folder.name}.toml" in files else (f"{folder.name}.glsl", False)
        )
        title = _title(files[main], main) if material else "Plain GLSL"
        found[folder.name] = Start(title, main, files, {}, str(folder / main) if material else "")
    return found


def _title(text: str, file: str) -> str:
    material = parse(text, file).data["material"]
    return str(material.get("title") or material["name"])


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def write_start(folder: Path, name: str, start: Start) -> None:
    """Writes starts/NAME.json.gz, and the pieces that it names into pieces/; that of a preset has its `head`, too."""
    record: dict[str, Any] = {"name": name, "title": start.title, "main": start.main, "files": start.files}
    record |= {"scenes": {}, "body_files": [], "texture_files": {}}
    if start.source:
        record |= _scenes(folder, scene_of(start.source), start)
    write_packed(folder / "starts" / f"{name}.json", json.dumps(record).encode())


def _scenes(folder: Path, scene: Scene, start: Start) -> dict[str, Any]:
    """The scene on its own body and on each shape, and which files of the start these depend on."""
    material = load_material(scene.material)
    if material.makes_rays:
        return {"scenes": {"": _scene(folder, raymarched_picture(scene, material, Choices()), scene.parameters)}}
    scenes = {"": _scene(folder, picture_of(scene, material, Choices()), scene.parameters)}
    for shape in () if start.preset else SHAPES:
        with contextlib.suppress(SssgenError):  # what is baked for a body is for no other one
            scenes[shape] = _scene(folder, picture_of(scene, material, Choices(shape)), scene.parameters)
    assert scene.geometry is not None
    with noted_files() as read:
        packed_triangles(scene.geometry)
    body_files = {Path(file).name for file in read} & {file for file in start.files if file.endswith(".sss")}
    compiled = compile(material, TARGET, standalone=True)
    textures = texture_files(material, compiled)
    record = {"scenes": scenes, "body_files": sorted(body_files), "texture_files": textures}
    if start.preset:  # it is drawn before Python is loaded
        values = scenes[""]["values"]
        record["head"] = {**emitted_head(material, compiled, values, scene.parameters), "texture_files": textures}
    return record


def _scene(folder: Path, picture: Picture, in_scene: Any) -> dict[str, Any]:
    """What the browser cannot compute of a picture."""
    head, pieces = picture.head, dict(picture.pieces)
    kept = {key: value for key, value in head.items() if key not in PARTS}
    if "flat" in head:
        kept["flat"] = {key: head["flat"][key] for key in ("start", "plays")}
    else:
        kept["body"] = _piece(folder, packed_body(pieces.pop(head["body"])))
    names = {digest: _piece(folder, data) for digest, data in pieces.items()}
    texels = {}
    for texture in head["textures"]:
        if "texels" in texture:
            levels = [{**level, "data": names[level["data"]]} for level in texture["texels"]["levels"]]
            texels[texture["source_name"]] = {**texture["texels"], "levels": levels}
    return {
        "head": kept,
        "texels": texels,
        "values": {name: [*map(float, value)] for name, value in picture.values.items()},
        "in_scene": list(in_scene),
    }


def _piece(folder: Path, data: bytes) -> str:
    name = hashlib.sha256(data).hexdigest()[:32]
    if not (folder / "pieces" / f"{name}.gz").exists():
        write_packed(folder / "pieces" / name, data)
    return name
