"""`sssgen show SCENE`: its geometry, lights, material and medium."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from sssgen.cli.layout import wrap
from sssgen.material.material_loading import examples
from sssgen.scene.example_scenes import all_scenes, summary
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.paths import posix
from sssgen.support.text_files import refuse_folder

if TYPE_CHECKING:
    from sssgen.scene.scene import Light


MEASURED = ("medium", "inlay", "environment")
"""The sections with physical data."""

names = all_scenes
"""The example scenes, to draw and to measure."""


def describe(name: str) -> dict[str, Any]:
    """Everything about an example scene, or about that of a .toml file. Raises SssgenError."""
    from sssgen.scene.scene import DistanceTexture
    from sssgen.scene.scene_loading import load

    scenes = all_scenes()
    if not name.endswith(".toml") and name not in scenes:
        refuse_folder(name, (".toml",), "scene.toml")
        hint = did_you_mean(name, scenes) or f"give a path that ends in .toml, or one of: {', '.join(scenes)}"
        raise failure(f"unknown scene '{name}'", hint)
    path = scenes.get(name, name)
    scene = load(path)
    return {
        "name": name,
        "title": scene.title,
        "summary": summary(path),
        "material": scene.material,
        "material_file": posix(examples().get(scene.material, scene.material)) if scene.material else "",
        "size": list(scene.size),
        "samples": scene.samples,
        "time": scene.time,
        "geometry": scene.document.data.get("geometry"),
        "bodies": [posix(path) for path in scene.bodies],
        "camera": {
            "position": list(scene.camera.position),
            "target": list(scene.camera.target),
            "field_of_view": scene.camera.field_of_view,
        },
        "lights": [_light(light) for light in scene.lights],
        "background": [list(color) for color in scene.background],
        "ambient": list(scene.ambient),
        **{key: scene.measured.get(key) for key in MEASURED},
        "parameters": dict(scene.parameters),
        "textures": {
            name: "distances of the geometry" if isinstance(texture, DistanceTexture) else posix(texture.file)
            for name, texture in scene.textures.items()
        },
        "file": posix(path),
    }


def _light(light: Light) -> dict[str, Any]:
    key, place = ("position", light.position) if light.position is not None else ("direction", light.direction)
    return {key: list(place or ()), "color": list(light.color)}


def lines(facts: Mapping[str, Any], width: int) -> list[str]:
    """The facts as text."""
    columns, rows = facts["size"]
    camera = facts["camera"]
    text = [f"{facts['name']} (scene)" + (f": {facts['title']}" if facts["title"] else "")]
    text += [*wrap(facts["summary"], width, "  ", "  "), ""]
    if facts["bodies"]:
        text += [
            f"bodies: {len(facts['bodies'])}, each with its own material",
            *(f"  {path}" for path in facts["bodies"]),
        ]
    else:
        text.append(f"material: {facts['material_file'] or 'none: the scene describes what is measured'}")
        geometry = facts["geometry"]
        shape = _table(geometry) if geometry else "none: the material marches rays"
        text += wrap(f"geometry: {shape}", width, "", "  ")
    for key in MEASURED:
        if facts[key] is not None:
            text += wrap(f"{key}: {_table(facts[key])}", width, "", "  ")
    text.append(f"lights: {len(facts['lights']) or 'none'}")
    for light in facts["lights"]:
        where = f"at {_value(light['position'])}" if "position" in light else f"from {_value(light['direction'])}"
        text.append(f"  {where}, color {_value(light['color'])}")
    text.append(
        f"camera: at {_value(camera['position'])}, towards {_value(camera['target'])}, {camera['field_of_view']:g}°"
    )
    text.append(
        f"picture: {columns} × {rows} pixels, {facts['samples']} × {facts['samples']} samples, at {facts['time']:g} s"
    )
    for key in ("parameters", "textures"):
        if facts[key]:
            text += ["", f"{key} of the material:"]
            text += [line for name, value in facts[key].items() for line in _entry(name, value, width)]
    return [*text, "", f"file: {facts['file']}"]


def _entry(name: str, value: object, width: int) -> list[str]:
    return wrap(f"{name}: {_value(value)}", width, "  ", "      ")


def _table(content: Mapping[str, Any]) -> str:
    return ", ".join(str(value) if key == "kind" else f"{key} {_value(value)}" for key, value in content.items())


def _value(value: object) -> str:
    if isinstance(value, Mapping):
        return f"{{ {_table(value)} }}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(_value(part) for part in value)}]"
    return f"{value:g}" if isinstance(value, float) else str(value)
