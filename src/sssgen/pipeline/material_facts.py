"""The properties of a material for which a target's descriptor may have variants."""

from __future__ import annotations

from sssgen.ir.nodes import Uniform
from sssgen.material.chain_assembly import RAYS
from sssgen.material.model import Material
from sssgen.material.requirements import read_uniforms


def facts_of(material: Material) -> set[str]:
    """Those of `targets.descriptor.FACTS` that a material has."""
    rays = _reads_rays(material)
    screen = rays or material.makes_rays
    facts = {material.shading, material.alpha_mode, "screen" if screen else "mesh"}
    facts |= {"two_sided"} if material.two_sided else set()
    facts |= (
        {"placed"} if any(_is_placed(uniform) for use in material.stages for uniform in read_uniforms(use)) else set()
    )
    return facts | ({"picture"} if screen and not rays else set())


def _is_placed(uniform: Uniform) -> bool:
    return ("placed", ()) in uniform.hints


def _reads_rays(material: Material) -> bool:
    """Whether a technique reads the eye's ray before another one has made it."""
    written: set[str] = set()
    for stage in material.stages:
        params = stage.technique.function.params
        if any(param.name in RAYS - written and param.direction != "out" for param in params):
            return True
        written |= {param.name for param in params if param.direction != "in"}
    return False
