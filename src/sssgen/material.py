"""Materials: what they are, and how they are loaded. One is a chain of techniques, described in TOML."""

from __future__ import annotations

import os
import re
from typing import TYPE_CHECKING, NamedTuple

from .data import place, posix
from .diagnostics import did_you_mean, failure
from .ir.nodes import Function, Module, Span
from .lang.loader import read_text
from .library import Technique
from .watch import Kept, note, remembered

if TYPE_CHECKING:
    from pathlib import Path


class Binding(NamedTuple):
    """What a slot is bound to: a function and the module it lives in."""

    module: Module
    function: Function


class Stage(NamedTuple):
    """One technique of the chain, with what the material says of it."""

    technique: Technique
    values: dict[str, tuple[float, ...]]
    """Uniform (the technique's own name for it) → its default in this material."""
    fixed: frozenset[str]
    """The uniforms that are folded into the text."""
    textures: dict[str, str]
    """Texture uniform → picture file, relative to the material, that it suggests for renders and previews."""
    bindings: dict[str, Binding]
    """Slot name → the function bound to it."""
    span: Span
    """The place of the stage's `technique = …` line."""


class Material(NamedTuple):
    """A checked material."""

    name: str
    title: str
    doc: str
    shading: str
    """lit or unlit"""
    stages: tuple[Stage, ...]
    """In the order they run (the roles' order, then the file's)."""
    file: str
    """The path of its file."""
    alpha_mode: str = "opaque"
    """opaque, mask or blend, as in glTF: what the engine does with the alpha that techniques write"""

    @property
    def path(self) -> Path:
        """The path of its file, with all that a Path can do."""
        from pathlib import Path

        return Path(self.file)


SHADINGS = ("lit", "unlit")
ALPHA_MODES = ("opaque", "mask", "blend")

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}")
# Windows keeps these for devices, whatever follows the dot: no file can be called so.
_DEVICES = {"con", "prn", "aux", "nul", *(f"{port}{n}" for port in ("com", "lpt") for n in range(1, 10))}


def examples() -> dict[str, str]:
    """The example materials that come with the project, by name."""
    folder = place("examples")
    paths = {name: os.path.join(folder, name, f"{name}.toml") for name in sorted(os.listdir(folder))}
    return {name: path for name, path in paths.items() if os.path.isfile(path)}


_materials: dict[str, Kept] = {}


def load_material(path_or_name: str | os.PathLike[str]) -> Material:
    """The material of a TOML file, or of an example by its name.

    It is the same object as before where no file that it is made of has changed. Raises SssgenError with all that
    is wrong with it.
    """
    text = os.fspath(path_or_name)
    if not text.endswith(".toml") and "/" not in text and "\\" not in text and not os.path.isfile(text):
        note(text)
        path = os.path.join(place("examples"), text, f"{text}.toml")
        if not os.path.isfile(path):
            known = examples()
            beside = f"did you mean '{text}.toml'?" if os.path.isfile(f"{text}.toml") else ""
            others = f"give a path that ends in .toml, or one of: {', '.join(known)}"
            raise failure(f"unknown material '{text}'", beside or did_you_mean(text, known) or others)
        return _remembered(path, f"examples/{text}/{text}.toml")
    return _remembered(text, posix(text))


def _remembered(path: str, shown: str) -> Material:
    key = f"{os.path.abspath(path)}\0{shown}"
    return remembered(_materials, key, lambda: parse_material(read_text(path, shown), path, shown))


def parse_material(text: str, path: str | os.PathLike[str], shown: str = "") -> Material:
    """The material that a TOML text describes.

    Files that it names are looked for beside `path`; `shown` is its name in messages. Raises SssgenError with
    all that is wrong with it.
    """
    from .material_reader import read_material

    return read_material(text, os.fspath(path), shown or posix(path))


def wrong_name(name: str) -> tuple[str, str] | None:
    """What is wrong with a material's name, and what to do; None where nothing is."""
    if not _NAME.fullmatch(name):
        near = re.sub(r"\W+", "_", name, flags=re.ASCII).strip("_").lower()
        offer = f": '{near}'" if _NAME.fullmatch(near) else ""
        rule = "a name is letters, digits and _, begins with a letter, and has at most 64 characters"
        return f"'{name[:80]}' cannot be a material's name", rule + offer
    if name.lower() in _DEVICES:
        return f"'{name}' cannot be a file's name", "Windows keeps this name for a device: choose another"
    return None
