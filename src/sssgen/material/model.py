"""Materials: what they are, and how they are loaded. One is a chain of techniques, described in TOML."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from sssgen.ir.nodes import Function, Module, Span
from sssgen.material.library import Technique

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
