"""Writes changed parameters back to a material's or a scene's TOML file; comments and order are kept.

What the scene sets is saved in the scene, and all else in the material. A material that comes with sssgen is not
changed: where the scene is a person's own, the scene gets its changes.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from sssgen.material.model import Material
from sssgen.scene.bake_advice import is_scene
from sssgen.scene.scene import Scene
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


def save_to_material(material: Material, changes: Mapping[tuple[str, str], Sequence[float] | str]) -> None:
    """Writes (technique, parameter or texture) → value into the material's file.

    It is written at every stage of that technique that sets it, or, where none does, at its first stage; one that a
    stage fixes keeps `fixed`. Raises SssgenError for a file that cannot be read or written, or a stage that is gone.
    """
    document = _parse(material.file)
    stages = [(stage.technique.role, stage.technique.name) for stage in material.stages]
    for (technique, parameter), value in changes.items():
        tables = [
            table
            for role in dict.fromkeys(role for role, name in stages if name == technique)
            for table in _stages(document, role)
            if os.path.splitext(os.path.basename(str(table.get("technique"))))[0] == technique
        ]
        if not tables:
            raise failure(f"the file has no stage of '{technique}' any more", "reload the page", posix(material.file))
        chosen = [table for table in tables if parameter in table] or tables[:1]
        for table in chosen:
            old = table.get(parameter)
            if isinstance(old, dict) and "value" in old:
                old["value"] = _value(value)
            else:
                table[parameter] = _value(value)
    _write(material.file, document)


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
