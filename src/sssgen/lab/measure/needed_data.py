"""What a measured chain requires on a scene, and the bytes of its baked textures there."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from sssgen.ir.nodes import Uniform
from sssgen.ir.types import Sampler
from sssgen.lab.measure import fluence_inputs
from sssgen.lab.measure.scene_inputs import of_scene
from sssgen.material import requirements
from sssgen.material.model import TechniqueUse
from sssgen.scene.measured.measured_scene import MeasuredScene

MAP_SIDE = 512
"""Width and height of a baked map in texels, the default of `sssgen bake`; measured maps are ideal and have no size."""


class NeededData(NamedTuple):
    """The requirements of a chain, named as in attributes, and the bytes of the textures that are baked for it."""

    requires: tuple[str, ...] = ()
    bytes: int = 0


def needed_data(stages: Sequence[TechniqueUse], scene: MeasuredScene) -> NeededData:
    """What the stages of a chain need on a scene. A texture that several stages read counts once."""
    textures = requirements.baked_textures(stages)
    size = sum(requirements.texel_bytes(uniform) * _texels(uniform, scene) for uniform in textures)
    return NeededData(requirements.requirements(stages), size)


def _texels(uniform: Uniform, scene: MeasuredScene) -> int:
    """The texels of a baked texture: a volume's as the scene has it."""
    assert isinstance(uniform.type, Sampler)
    if texels := fluence_inputs.texels(uniform.name, scene):
        return texels
    if uniform.type.dim != "3D":
        return MAP_SIDE * MAP_SIDE
    return math.prod(of_scene(scene).textures[uniform.name].size())
