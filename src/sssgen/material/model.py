"""The data of a material: a chain of techniques, described in TOML."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from sssgen.ir.nodes import Function, Module, Span
from sssgen.material.library import Technique

if TYPE_CHECKING:
    from pathlib import Path


class Binding(NamedTuple):
    """The function that a slot is bound to, and its module."""

    module: Module
    function: Function


class TechniqueUse(NamedTuple):
    """One technique of the chain, with its settings in the material."""

    technique: Technique
    values: dict[str, tuple[float, ...]]
    """Uniform (the technique's own name for it) → its default in this material."""
    fixed: frozenset[str]
    """The uniforms that become constants in the emitted text."""
    textures: dict[str, str]
    """Texture uniform → picture file, relative to the material, for renders and previews."""
    bindings: dict[str, Binding]
    """Slot name → the function bound to it."""
    span: Span
    """The position of the stage's `technique = …` line."""
    uv: str = "uv"
    """The set of texture coordinates that the technique reads, one of `UV_SETS`."""
    levels: tuple[int, ...] = ()
    """The levels of detail that it belongs to, sorted; () for all of them."""
    texture_spans: tuple[tuple[str, Span], ...] = ()
    """Texture uniform → the position of its file's name in the material."""


class Material(NamedTuple):
    """A checked material."""

    name: str
    title: str
    doc: str
    shading: str
    """lit or unlit"""
    stages: tuple[TechniqueUse, ...]
    """In the order they run (the roles' order, then the file's)."""
    file: str
    """The path of its file."""
    alpha_mode: str = "opaque"
    """opaque, mask or blend, as in glTF: how the engine uses the alpha that techniques write"""
    two_sided: bool = False
    """Whether back faces are drawn, too, and lit with the reversed normal"""
    surroundings: bool = True
    """Whether light of the surroundings comes through, where the techniques say how"""
    levels: int = 1
    """The number of levels of detail, of which a uniform chooses one; 1 to `MOST_LEVELS`"""

    @property
    def path(self) -> Path:
        """The path of its file, as a Path."""
        from pathlib import Path

        return Path(self.file)

    def at_level(self, level: int) -> Material:
        """The material with the stages of one level of detail alone."""
        stages = [stage._replace(levels=()) for stage in self.stages if not stage.levels or level in stage.levels]
        return self._replace(stages=tuple(stages), levels=1)

    @property
    def makes_rays(self) -> bool:
        """Whether a technique finds the surface along rays: then the material has no body, and fills a picture."""
        return any(stage.technique.role == "geometry" for stage in self.stages)


UV_SETS = ("uv", "uv2")
MOST_LEVELS = 8
SHADINGS = ("lit", "unlit")
ALPHA_MODES = ("opaque", "mask", "blend")

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}")
# Windows reserves these names for devices, with any suffix: no file can have them.
_DEVICES = {"con", "prn", "aux", "nul", *(f"{port}{n}" for port in ("com", "lpt") for n in range(1, 10))}


def wrong_name(name: str) -> tuple[str, str] | None:
    """The error message for a material's name and its hint; None for a valid name."""
    if not NAME.fullmatch(name):
        near = re.sub(r"\W+", "_", name, flags=re.ASCII).strip("_").lower()
        offer = f": '{near}'" if NAME.fullmatch(near) else ""
        rule = "a name is letters, digits and _, begins with a letter, and has at most 64 characters"
        return f"'{name[:80]}' cannot be a material's name", rule + offer
    if name.lower() in _DEVICES:
        return f"'{name}' cannot be a file's name", "Windows keeps this name for a device: choose another"
    return None
