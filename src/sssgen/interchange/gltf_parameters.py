"""The parameters of a material by glTF's names for them, as techniques declare these with `alias`."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import NamedTuple

from sssgen.ir.types import Sampler
from sssgen.material.model import Material, TechniqueUse

TRANSFORM_PARAMETERS = ("uv_tiling", "uv_offset", "uv_rotation")
"""The parameters of a transform of texture coordinates."""


class Parameter(NamedTuple):
    """A value of a stage."""

    value: tuple[float, ...]
    stage: int


class Texture(NamedTuple):
    """A texture with a picture."""

    file: str
    """The picture's path"""
    uv: str
    """`uv` or `uv2`"""
    stage: int


class Parameters:
    """The values and textures of a material's stages, by alias and by their own names; the first of a name counts."""

    def __init__(self, material: Material) -> None:
        self.values: dict[str, Parameter] = {}
        self.textures: dict[str, Texture] = {}
        self.transforms: dict[str, dict[str, tuple[float, ...]]] = {}
        """Set of texture coordinates → the values of `TRANSFORM_PARAMETERS`"""
        self._stages: dict[str, set[int]] = {}
        """Name → the stages that have it"""
        self.used_stages: set[int] = set()
        """The stages that were asked for"""
        folder = os.path.dirname(material.file)
        for number, stage in enumerate(material.stages):
            own = {name: value for name, value, _ in _values(stage)}
            if set(TRANSFORM_PARAMETERS) <= own.keys():
                self.transforms[stage.uv] = {name: own[name] for name in TRANSFORM_PARAMETERS}
                self.used_stages.add(number)
            for name, value, aliases in _values(stage):
                for known in (name, *aliases):
                    self._stages.setdefault(known, set()).add(number)
                    self.values.setdefault(known, Parameter(value, number))
            for uniform in stage.technique.uniforms:
                if (file := stage.textures.get(uniform.name)) is not None:
                    texture = Texture(os.path.join(folder, file), stage.uv, number)
                    for known in (uniform.name, *_aliases(dict(uniform.hints))):
                        self.textures.setdefault(known, texture)

    def value(self, name: str, components: int = 1) -> tuple[float, ...] | None:
        """A value by its name or alias, or None where no stage has it with this number of components."""
        parameter = self.values.get(name)
        if parameter is None or len(parameter.value) != components:
            return None
        self.used_stages |= self._stages[name]
        return parameter.value

    def texture(self, *names: str) -> Texture | None:
        """A texture by one of its names."""
        for name in names:
            if name in self.textures:
                self.used_stages.add(self.textures[name].stage)
                return self.textures[name]
        return None


def _values(stage: TechniqueUse) -> Iterator[tuple[str, tuple[float, ...], tuple[str, ...]]]:
    """The name, the value and the aliases of each parameter of a stage and of what is bound to its slots."""
    bound = [uniform for binding in stage.bindings.values() for uniform in binding.module.uniforms]
    for uniform in (*stage.technique.uniforms, *bound):
        if not isinstance(uniform.type, Sampler):
            yield uniform.name, stage.values.get(uniform.name, uniform.default), _aliases(dict(uniform.hints))


def _aliases(hints: dict[str, tuple[float | str, ...]]) -> tuple[str, ...]:
    return tuple(str(name) for name in hints.get("alias", ()))
