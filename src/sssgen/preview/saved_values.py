"""Writes changed parameters back to a material's or a scene's TOML file; comments and order are kept.

What the scene sets is saved in the scene, and all else in the material. A material that comes with sssgen is not
changed: where the scene is a person's own, the scene gets its changes.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from sssgen.material.model import Material
from sssgen.scene.bake_advice import is_scene
from sssgen.scene.scene import Light, Scene
from sssgen.support.diagnostics import failure
from sssgen.support.extras import need
from sssgen.support.file_writer import write_files
from sssgen.support.installed_files import copy_hint, is_installed
from sssgen.support.paths import posix
from sssgen.support.text_files import read_text


def is_saved_in_scene(scene: Scene, material: Material, name: str) -> bool:
    """Whether a parameter or texture, by its name in the scene, is saved in the scene's file."""
    return name in scene.parameters or name in scene.textures or _scene_gets_all(scene, material)


def saves_where(scene: Scene, material: Material) -> dict[str, str]:
    """What a page says about Save: `saves` is why nothing can be saved, or ''; `saved_in` names the files."""
    scene_file, material_file, reason = posix(scene.document.reporter.file), posix(material.file), ""
    if _scene_gets_all(scene, material):
        files = f"{scene_file}; {material_file} comes with sssgen and stays as it is"
    elif is_installed(material.file):
        reason, files = f"{material_file} comes with sssgen and is not changed: {copy_hint(material.file)}.", "nothing"
    elif is_scene(scene, material) and (scene.parameters or scene.textures):
        files = f"{material_file}, and {scene_file} for what the scene sets"
    else:
        files = material_file
    return {"saves": reason, "saved_in": f"Save writes {files}."}


def _scene_gets_all(scene: Scene, material: Material) -> bool:
    return is_installed(material.file) and not is_installed(scene.document.reporter.file)


class Change(NamedTuple):
    """A new value of a technique's parameter or texture."""

    technique: str
    parameter: str
    value: Sequence[float] | str
    old: Sequence[float] | None = None
    """The value that the material had: of stages with other values, such as those of another level of detail, none is
    changed. None for a texture, which all stages share"""


def save_to_material(material: Material, changes: Iterable[Change]) -> None:
    """Writes changes into the material's file.

    A value is written at every stage of its technique that sets the old one, or, where none does, at the first stage
    that sets none; one that a stage fixes keeps `fixed`. Raises SssgenError for a file that cannot be read or written,
    or a stage that is gone.
    """
    document = _parse(material.file)
    stages = [(stage.technique.role, stage.technique.name) for stage in material.stages]
    for change in changes:
        technique, parameter = change.technique, change.parameter
        tables = [
            table
            for role in dict.fromkeys(role for role, name in stages if name == technique)
            for table in _stages(document, role)
            if os.path.splitext(os.path.basename(str(table.get("technique"))))[0] == technique
        ]
        if not tables:
            raise failure(f"the file has no stage of '{technique}' any more", "reload the page", posix(material.file))
        for table in _changed_stages(tables, change):
            old = table.get(parameter)
            if isinstance(old, dict) and "value" in old:
                old["value"] = _value(change.value)
            else:
                table[parameter] = _value(change.value)
    _write(material.file, document)


def _changed_stages(tables: Sequence[Any], change: Change) -> Sequence[Any]:
    """The stages of a technique that get a new value."""
    having = [table for table in tables if change.parameter in table]
    others = [table for table in tables if change.parameter not in table]
    if change.old is None:
        return having or others[:1]
    same = [table for table in having if _is_equal(table[change.parameter], change.old)]
    return same or others[:1] or having


def _is_equal(stored: Any, numbers: Sequence[float]) -> bool:
    """Whether a value in a file is these numbers, in float32."""
    value = stored["value"] if isinstance(stored, dict) and "value" in stored else stored
    parts = value if isinstance(value, list) else [value]
    if len(parts) != len(numbers) or not all(isinstance(part, (int, float)) for part in parts):
        return False
    return bool(np.array_equal(np.array(parts, np.float32), np.array(numbers, np.float32)))


def save_to_scene(path: str, changes: Mapping[str, Sequence[float] | str], section: str = "parameters") -> None:
    """Writes parameter or texture → value into that section of a scene's file. Raises SssgenError."""
    document = _parse(path)
    table = document.setdefault(section, need("tomlkit", "tomlkit", "preview").table())
    for name, value in changes.items():
        old = table.get(name)
        if isinstance(value, str) and isinstance(old, dict) and "file" in old:
            old["file"] = value
        else:
            table[name] = _value(value)
    _write(path, document)


def save_lights(path: str, lights: Sequence[Light]) -> None:
    """Writes the lights of a scene's file: those that it has get the new values, others are added or removed.

    Raises SssgenError.
    """
    tomlkit = need("tomlkit", "tomlkit", "preview")
    document = _parse(path)
    tables = document.get("light")
    if not isinstance(tables, tomlkit.items.AoT):
        tables = document["light"] = tomlkit.aot()
    del tables[len(lights) :]
    for index, light in enumerate(lights):
        if index == len(tables):
            tables.append(tomlkit.table())
        key, other = ("direction", "position") if light.position is None else ("position", "direction")
        tables[index].pop(other, None)
        tables[index][key] = _value(light.position or light.direction or ())
        tables[index]["color"] = _value(light.color)
    if not lights:
        del document["light"]
    _write(path, document)


def _parse(path: str) -> Any:
    return need("tomlkit", "tomlkit", "preview").parse(read_text(path, posix(path)))


def _stages(document: Any, role: str) -> list[Any]:
    """The tables of a role: one, or an array of them."""
    content = document.get(role)
    return [content] if isinstance(content, dict) else list(content or ())


def _value(numbers: Sequence[float] | str) -> Any:
    """A text, or the shortest decimal of float32 for each number."""
    if isinstance(numbers, str):
        return numbers
    short = [float(np.format_float_positional(np.float32(number), trim="0")) for number in numbers]
    return short if len(short) > 1 else short[0]


def _write(path: str, document: Any) -> None:
    write_files(os.path.dirname(os.path.abspath(path)), {os.path.basename(path): document.as_string()})
