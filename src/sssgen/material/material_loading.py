"""Loads materials: from a TOML file, from a TOML text, or an example by its name."""

from __future__ import annotations

import os

from sssgen.material.material_reader import read_material
from sssgen.material.model import Material
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.file_memo import CachedResult, note, remember
from sssgen.support.paths import PRESETS, place, posix, source_name
from sssgen.support.text_files import read_text, refuse_folder, refuse_other_kinds
from sssgen.support.toml_source import parse


def examples() -> dict[str, str]:
    """The example materials that come with the project, by name."""
    folder = place("examples")
    paths = {name: os.path.join(folder, name, f"{name}.toml") for name in sorted(os.listdir(folder))}
    return {name: path for name, path in paths.items() if os.path.isfile(path)}


def is_example(path: str, name: str) -> bool:
    """Whether a file is the example material of that name."""
    example = os.path.join(place("examples"), name, f"{name}.toml")
    return os.path.isfile(example) and os.path.samefile(path, example)


def preset_hint(name: str) -> str:
    """What to do with the name of a preset where a material is asked for; '' for another name."""
    if name not in parse(read_text(PRESETS, posix(PRESETS)), posix(PRESETS)).data:
        return ""
    return (
        f"'{name}' is a preset: `sssgen use {name} MESH -o DIR` puts it on a mesh, and `sssgen new my_{name} --from "
        f"{name}` writes its material"
    )


_materials: dict[str, CachedResult] = {}


def load_material(path_or_name: str | os.PathLike[str]) -> Material:
    """The material of a TOML file, or of an example by its name.

    The object is cached until a file that it depends on changes. Raises SssgenError with all errors of the material.
    """
    text = os.fspath(path_or_name)
    if not text.endswith(".toml") and "/" not in text and "\\" not in text and not os.path.isfile(text):
        note(text)
        path = os.path.join(place("examples"), text, f"{text}.toml")
        note(path)
        if not os.path.isfile(path):
            refuse_folder(text, (".toml",))
            names = examples()
            file_hint = f"did you mean '{text}.toml'?" if os.path.isfile(f"{text}.toml") else ""
            hint = f"give a path that ends in .toml, or one of: {', '.join(names)}"
            raise failure(
                f"unknown material '{text}'", file_hint or preset_hint(text) or did_you_mean(text, names) or hint
            )
        text = path
    refuse_other_kinds(text)
    key = f"{os.path.abspath(text)}\0{text}"
    return remember(_materials, key, lambda: parse_material(read_text(text, posix(text)), text))


def parse_material(text: str, path: str | os.PathLike[str]) -> Material:
    """The material that a TOML text describes.

    File names in it are relative to the folder of `path`. Raises SssgenError with all errors of the material.
    """
    return read_material(text, os.fspath(path), source_name(path))
