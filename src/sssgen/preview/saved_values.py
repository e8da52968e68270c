"""Writes changed parameters back to a material's or a scene's TOML file; comments and order are kept.

What the scene sets is saved in the scene, and all else in the material. A material that comes with sssgen is not
changed: where the scene is a person's own, the scene gets its changes.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from sssgen.material.library import Technique
from sssgen.material.medium_look import KEYS, REPLACED, medium_parameters
from sssgen.material.model import Material
from sssgen.material.roles import SECTIONS, allowed_roles
from sssgen.material.values import read_value
from sssgen.scene.bake_advice import is_scene
from sssgen.scene.scene import Light, Scene
from sssgen.support.diagnostics import failure
from sssgen.support.extras import need
from sssgen.support.file_writer import write_files
from sssgen.support.installed_files import copy_hint, is_installed
from sssgen.support.paths import posix
from sssgen.support.text_files import read_text
from sssgen.support.toml_source import Path, parse


def is_saved_in_scene(scene: Scene, material: Material, name: str) -> bool:
    """Whether a parameter or texture, by its name in the scene, is saved in the scene's file."""
    return name in scene.parameters or name in scene.textures or _scene_gets_all(scene, material)


def saves_where(scene: Scene, material: Material) -> dict[str, Any]:
    """What a page says about Save: `saves` is why nothing can be saved, or ''; `saved_in` names the files. It `copies`:
    it can be saved under another name."""
    scene_file, material_file, reason = posix(scene.document.reporter.file), posix(material.file), ""
    if _scene_gets_all(scene, material):
        files = f"{scene_file}; {material_file} comes with sssgen and stays as it is"
    elif is_installed(material.file):
        reason, files = f"{material_file} comes with sssgen and is not changed: {copy_hint(material.file)}.", "nothing"
    elif is_scene(scene, material) and (scene.parameters or scene.textures):
        files = f"{material_file}, and {scene_file} for what the scene sets"
    else:
        files = material_file
    return {"saves": reason, "saved_in": f"Save writes {files}.", "copies": True}


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
    look: str = ""
    """The key of the medium's look that is written, with this value, in place of the parameter"""


def save_to_material(material: Material, changes: Iterable[Change]) -> None:
    """Writes changes into the material's file.

    A value is written at every stage of its technique that sets the old one, or, where none does, at the first stage
    that sets none; one that a stage fixes keeps `fixed`. A parameter takes the line of the look that it replaces, and
    the reverse. Raises SssgenError for a file that cannot be read or written, or a stage that is gone.
    """
    document = parse_document(material.file)
    stages = [(section_of(stage.technique), stage.technique.name) for stage in material.stages]
    renamed: dict[tuple[str | int, ...], str] = {}
    for change in changes:
        tables = {
            path: table
            for section in dict.fromkeys(section for section, name in stages if name == change.technique)
            for path, table in stages_of(document, section).items()
            if os.path.splitext(os.path.basename(str(table.get("technique"))))[0] == change.technique
        }
        if not tables:
            message = f"the file has no stage of '{change.technique}' any more"
            raise failure(message, "reload the page", posix(material.file))
        for path, table in _changed_stages(tables, change).items():
            if name := _change_stage(table, change):
                renamed[*path, name] = change.look or change.parameter
    write_text(material.file, _with_keys(document.as_string(), renamed))


def _change_stage(table: Any, change: Change) -> str:
    """Writes a value into a stage; returns the key that it has there, if it is to be another one, or ''."""
    key = _key_in(table, change.parameter)
    wanted = change.look or change.parameter
    if change.look:
        for name in REPLACED[change.look][1:]:  # what follows from the look is not set apart from it
            table.pop(name, None)
    elif key in REPLACED:
        for name, numbers in medium_parameters(key, _components(table, key, key)).items():
            if name != change.parameter and name not in table:
                table[name] = _value(numbers)
    old = table.get(key or wanted)
    if isinstance(old, dict) and "value" in old:
        old["value"] = _value(change.value)
    else:
        table[key or wanted] = _value(change.value)
    return key if key != wanted else ""


def _changed_stages(tables: Mapping[Path, Any], change: Change) -> Mapping[Path, Any]:
    """The stages of a technique that get a new value."""
    having = {path: table for path, table in tables.items() if _key_in(table, change.parameter)}
    others = {path: tables[path] for path in [path for path in tables if path not in having][:1]}
    if change.old is None:
        return having or others
    same = {path: table for path, table in having.items() if _is_equal(table, change.parameter, change.old)}
    return same or others or having


def _key_in(table: Any, parameter: str) -> str:
    """The key that gives a parameter in a stage: its own name, or that of the medium's look; '' where none does."""
    keys = (parameter, *(key for key, names in REPLACED.items() if names[0] == parameter))
    return next((key for key in keys if key in table), "")


def _components(table: Any, key: str, parameter: str) -> list[float]:
    """The numbers of a parameter in a stage, under its own key or under one of the medium's look; [] for no numbers."""
    stored = table[key]
    raw = stored["value"] if isinstance(stored, dict) and "value" in stored else stored
    if key in KEYS:
        numbers = read_value(KEYS[key], _plain(raw))
        return list(numbers) if key == parameter else medium_parameters(key, numbers)[parameter]
    parts = raw if isinstance(raw, list) else [raw]
    return list(parts) if all(isinstance(part, (int, float)) for part in parts) else []


def _plain(item: Any) -> Any:
    """The value without its layout."""
    return item.unwrap() if hasattr(item, "unwrap") else item


def _is_equal(table: Any, parameter: str, numbers: Sequence[float]) -> bool:
    """Whether the value of a parameter in a stage is these numbers, in float32."""
    stored = _components(table, _key_in(table, parameter), parameter)
    return bool(np.array_equal(np.array(stored, np.float32), np.array(numbers, np.float32)))


def _with_keys(text: str, renamed: Mapping[Path, str]) -> str:
    """The text of a document in which some keys have another name; their lines stay where they are."""
    if not renamed:
        return text
    document, lines = parse(text, ""), text.splitlines(keepends=True)
    spans = sorted(((document.place(*path).key, name) for path, name in renamed.items()), reverse=True)
    for span, name in spans:  # from the end, so that the columns before stay
        line = lines[span.line - 1]
        lines[span.line - 1] = line[: span.column - 1] + name + line[span.end_column - 1 :]
    return "".join(lines)


def save_to_scene(path: str, changes: Mapping[str, Sequence[float] | str], section: str = "parameters") -> None:
    """Writes parameter or texture → value into that section of a scene's file. Raises SssgenError."""
    document = parse_document(path)
    table = document.setdefault(section, need("tomlkit", "tomlkit", "preview").table())
    for name, value in changes.items():
        old = table.get(name)
        if isinstance(value, str) and isinstance(old, dict) and "file" in old:
            old["file"] = value
        else:
            table[name] = _value(value)
    write_text(path, document.as_string())


def save_lights(path: str, lights: Sequence[Light]) -> None:
    """Writes the lights of a scene's file: those that it has get the new values, others are added or removed.

    Raises SssgenError.
    """
    tomlkit = need("tomlkit", "tomlkit", "preview")
    document = parse_document(path)
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
    write_text(path, document.as_string())


def parse_document(path: str) -> Any:
    """The document of a file, which keeps its layout. Raises SssgenError."""
    return need("tomlkit", "tomlkit", "preview").parse(read_text(path, posix(path)))


def section_of(technique: Technique) -> str:
    """The section of a technique's stages; '' for a technique that is bound to slots."""
    return next((section for section in SECTIONS if technique.role in allowed_roles(section)), "")


def stages_of(document: Any, section: str) -> dict[Path, Any]:
    """The tables of a section, one or an array of them, by their paths."""
    content = document.get(section)
    if isinstance(content, dict):
        return {(section,): content}
    return {(section, number): table for number, table in enumerate(content or ())}


def _value(numbers: Sequence[float] | str) -> Any:
    """A text, or the shortest decimal of float32 for each number."""
    if isinstance(numbers, str):
        return numbers
    short = [float(np.format_float_positional(np.float32(number), trim="0")) for number in numbers]
    return short if len(short) > 1 else short[0]


def write_text(path: str, text: str) -> None:
    """Writes a file, in its own folder. Raises SssgenError."""
    write_files(os.path.dirname(os.path.abspath(path)), {os.path.basename(path): text})
