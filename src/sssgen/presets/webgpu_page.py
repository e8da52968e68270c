"""The files of a page with WebGPU and no engine, beside its templates: surroundings, ground, and what draws them."""

from __future__ import annotations

import math
import os

from sssgen.bake.cube_dds import cube_bytes
from sssgen.interchange.material_writer import SURROUNDINGS
from sssgen.material.material_loading import parse_material
from sssgen.material.shell_stages import with_shell
from sssgen.pipeline.compiler import compile
from sssgen.presets.engines import Engine
from sssgen.presets.project_templates import Files, render
from sssgen.run.evaluate.evaluation import half
from sssgen.run.render.environment_maps import irradiance_map, reflection_map
from sssgen.scene.environment import Environment, digest
from sssgen.support.paths import place

AIR = [0.007, 0.0075, 0.0091, 1.0]
"""The linear colour of the page behind all bodies."""
_MODULES = ("geometry.js", "material.js")
"""The modules of the example page that this page has, too."""


def files(engine: Engine) -> Files:
    """The cube maps of the surroundings, the shader of the ground, and modules of the example page."""
    result: Files = _cubes()
    ground = parse_material(render("webgpu/ground.toml", glow=glow()), "ground.toml")
    shell = [option for option in engine.shell if not option.startswith("environment")]
    result |= compile(with_shell(ground, shell), "wgsl").files
    for name in _MODULES:
        with open(os.path.join(place("examples"), "webgpu_page", name), encoding="utf-8") as file:
            result[name] = file.read()
    return result


def _cubes() -> Files:
    path = os.path.join(place("examples"), "surroundings", "textures", "studio.png")
    environment = Environment((1.0, 1.0, 1.0), path, digest(path))
    name = os.path.splitext(SURROUNDINGS)[0]
    maps = {f"{name}.dds": reflection_map(environment), f"{name}_irradiance.dds": irradiance_map(environment)}
    return {file: cube_bytes(half(texture).levels) for file, texture in maps.items()}


def glow() -> list[float]:
    """The dark colour that the tone mapping turns into that of the air.

    It takes x - 6.25 x^2 off all components, where x is the least one (Khronos PBR Neutral Tone Mapper, below .08).
    """
    color = AIR[:3]
    least = math.sqrt(min(color) / 6.25)
    return [round(part + least - min(color), 6) for part in color]
