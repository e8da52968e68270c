"""What the demo of the first page shows beside the playground's own files: presets, their texts, thumbnails, commands.

Everything that it shows at first is emitted here; the compiler is loaded when a visitor edits the material.
"""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import NamedTuple

from PIL import Image

from packed_file import write_packed
from sssgen.material.material_loading import load_material
from sssgen.pipeline.compiler import all_targets, compile
from sssgen.presets.engines import ENGINES
from sssgen.presets.preset import presets
from sssgen.support.diagnostics import SssgenError
from starts import PRESET, Start, write_start

PICTURES = Path(__file__).parents[2] / "presets"
FIRST = "honey"
TARGETS = {
    "threejs": "three.js", "godot": "Godot", "unity-urp": "Unity URP", "unity-shadergraph": "Shader Graph",
    "unreal": "Unreal", "babylonjs": "Babylon.js", "playcanvas": "PlayCanvas", "bevy": "Bevy", "metal": "Metal",
    "wgsl": "WGSL", "hlsl": "HLSL", "glsl-330": "GLSL",
}  # fmt: skip
"""The targets of the demo, and their names on its tabs."""
_MOUSE = (100, 12, 308, 220)
"""The part of a preset's picture that has the mouse's head, in pixels: left, top, right, bottom."""
_THUMBNAIL = (132, 132)


class Shown(NamedTuple):
    """A preset in the row of thumbnails."""

    name: str
    title: str
    doc: str
    thumbnail: str
    picture: str
    """What is shown where WebGL is missing; the paths are relative to the playground's folder."""


def shown_presets() -> list[Shown]:
    """The presets in the order of their table."""
    return [
        Shown(name, row.title, row.doc, f"demo/{name}_small.webp", f"demo/{name}.webp")
        for name, row in presets().items()
    ]


def command(preset: str, target: str) -> str:
    """What a visitor types to have the preset in an engine: on a mesh of their own, or as a shader."""
    if target in ENGINES:
        return f"sssgen use {preset} mesh.obj --target {target} -o out" + " --open" * ENGINES[target].is_page
    return f"sssgen new my_{preset} --from {preset}\nsssgen emit my_{preset}.toml --target {target} -o out"


def write_demo(folder: Path, starts: dict[str, Start]) -> None:
    """Writes demo/ and the starts of the presets into the playground's folder, and demo/demo.json, which lists them."""
    rows = []
    for shown in shown_presets():
        start = starts[PRESET + shown.name]
        write_start(folder, PRESET + shown.name, start)
        texts = _texts(start.source)
        write_packed(folder / "demo" / f"{shown.name}.json", json.dumps(texts).encode())
        _write_pictures(folder, shown)
        scene = tomllib.loads(Path(start.source).with_name("scene.toml").read_text(encoding="utf-8"))
        commands = {target: command(shown.name, target) for target in texts}
        rows.append(shown._asdict() | {"surroundings": scene["environment"]["intensity"], "commands": commands})
    listed = {"first": FIRST, "presets": rows}
    (folder / "demo" / "demo.json").write_text(json.dumps(listed), encoding="utf-8")


def _texts(path: str) -> dict[str, dict[str, str]]:
    """Target → the emitted files that are the material's own; a target that cannot express it is left out."""
    material = load_material(path)
    texts = {}
    for target in TARGETS:
        assert target in all_targets()
        try:
            files = compile(material, target).files
        except SssgenError:
            continue
        texts[target] = main_file(files)
    return texts


def main_file(files: dict[str, str]) -> dict[str, str]:
    """The file that has the material's functions: the first that is no vertex shader."""
    name = next(name for name in files if not name.endswith(".vert"))
    return {name: files[name]}


def _write_pictures(folder: Path, shown: Shown) -> None:
    with Image.open(PICTURES / f"{shown.name}.png") as picture:
        (folder / "demo").mkdir(exist_ok=True)
        picture.convert("RGB").save(folder / shown.picture, quality=90)
        picture.convert("RGB").crop(_MOUSE).resize(_THUMBNAIL).save(folder / shown.thumbnail, quality=82)
