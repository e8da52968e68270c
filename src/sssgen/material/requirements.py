"""What a technique requires besides its parameters: a bake, the light's depth map, back faces, a rigid body.

Most of it follows from declarations: a texture that `holds` a quantity or has `texel_bytes` is baked; a volume is baked
for a rigid mesh, but one whose light the engine computes for a rest pose; a distance function describes a rigid body;
`drawn` names a picture that the engine draws. A technique states the rest: `requires: fixed-light`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from sssgen.ir.baked_textures import is_baked, is_volume
from sssgen.ir.frame_passes import (
    BACK_FACES,
    EYE_LAYERS,
    FRAME_PASSES,
    INNER_LIGHT,
    LIGHT_VIEWS,
    MATT,
    VOLUMES,
    pass_name,
)
from sssgen.ir.nodes import Function, Module, Uniform
from sssgen.ir.types import Sampler
from sssgen.material import attributes
from sssgen.material.attributes import REQUIREMENTS, Attributes, Bake
from sssgen.material.model import TechniqueUse
from sssgen.material.slots import needs
from sssgen.support.diagnostics import SssgenError

DESCRIPTIONS = {
    "bake": "a texture that is baked from the body",
    "depth-map": "the light's depth map",
    "depth-layers": "a depth map with further layers",
    "back-faces": "a picture of the body's back faces",
    "eye-layers": "a picture of what lies behind them",
    "matt-light": "a picture of what the body would reflect if it were white",
    "inner-light": "a volume of the light inside the body",
    "rest-pose": "a rigid mesh, or a skinned one where the engine knows its rest pose",
    "rigid": "a rigid mesh",
    "fixed-light": "a light that does not move relative to the body",
}
"""The requirements, for people."""
_DISTANCES, _LIGHT = ("depth-map", "depth-layers", "back-faces", "eye-layers"), ("matt-light",)
_INSIDE = ("inner-light",)
"""Pictures that are drawn for each frame."""
TEXEL_BYTES = 4
"""The bytes of a baked texel without the hint `texel_bytes`: four channels of 8 bits."""


def requirements(uses: Iterable[TechniqueUse]) -> tuple[str, ...]:
    """What the techniques of a material require, with the functions that are bound to them; in a fixed order."""
    required: set[str] = set()
    for use in uses:
        for module, function in _functions(use):
            required.update(_attributes(function).requires)
            textures = [uniform for uniform in _uniforms_read(module, function) if isinstance(uniform.type, Sampler)]
            volumes = [pass_name(texture) for texture in textures if is_volume(texture)]
            slots = needs(module, function)[1]
            for texture in textures:
                required.update(needed_for(pass_name(texture)))
            required.update({"bake"} if any(map(is_baked, textures)) else ())
            required.update("rest-pose" if name in VOLUMES else "rigid" for name in volumes)
            required.update({"rigid"} if any(map(_is_distance, slots)) else ())
    return tuple(name for name in REQUIREMENTS if name in required)


def needed_for(name: str) -> tuple[str, ...]:
    """The requirements of a pass; '' has none."""
    if name in LIGHT_VIEWS:
        return ("depth-map", "depth-layers") if len(FRAME_PASSES[name].layers) > 1 else ("depth-map",)
    eye = ("back-faces",)
    own = {BACK_FACES: eye, EYE_LAYERS: (*eye, "eye-layers"), MATT: ("matt-light",), INNER_LIGHT: ("inner-light",)}
    return own.get(name, ())


def describe(
    uses: Sequence[TechniqueUse], drawers: Sequence[str] = (), drawers_of_light: Sequence[str] = (),
    drawers_inside: Sequence[str] = (),
) -> list[str]:  # fmt: skip
    """The requirements of a material in words, with the names of the baked textures and of the body.

    `drawers` draw its passes, where the user's program does not, `drawers_of_light` those that show light, and
    `drawers_inside` those that compute a volume.
    """
    required = requirements(uses)
    words = {name: DESCRIPTIONS[name] for name in required}
    if "bake" in words:
        words["bake"] += f" ({', '.join(texture.name for texture in baked_textures(uses))})"
    if own := bodies(uses):
        words["rigid"] = f"the body that it is made for ({', '.join(own)}), as on another mesh its light is wrong"
    for kinds, drawing in ((_LIGHT, drawers_of_light), (_INSIDE, drawers_inside), (_DISTANCES, drawers)):
        by = f" (drawn {', '.join(f'by {drawer}' for drawer in drawing)})" if drawing else ""
        words.update({name: words[name] + by for name in required if name in kinds})
    return list(words.values())


def bodies(uses: Iterable[TechniqueUse]) -> list[str]:
    """The distance functions that a material is bound to, each once: it is right on these bodies only.

    A function that reads a volume is left out: it describes the body that the volume was baked from.
    """
    functions = [
        binding.function.name
        for use in uses
        for binding in use.bindings.values()
        if _is_distance(binding.function) and not any(map(is_volume, _uniforms_read(binding.module, binding.function)))
    ]
    return list(dict.fromkeys(functions))


def baked_textures(uses: Iterable[TechniqueUse]) -> list[Uniform]:
    """The baked textures that the techniques read, each once."""
    read = [uniform for use in uses for uniform in read_uniforms(use)]
    return list({uniform.name: uniform for uniform in read if is_baked(uniform)}.values())


class BakedFunction(NamedTuple):
    """A function of a stage that reads baked textures."""

    stage: TechniqueUse
    name: str
    textures: tuple[Uniform, ...]
    bake: Bake | None
    """What makes the textures"""


def baked_functions(uses: Iterable[TechniqueUse]) -> list[BakedFunction]:
    """The functions of the stages that read baked textures, those bound to slots among them."""
    return [
        BakedFunction(use, function.name, textures, _attributes(function).bake)
        for use in uses
        for module, function in _functions(use)
        if (textures := tuple(filter(is_baked, _uniforms_read(module, function))))
    ]


class NeededTextures(NamedTuple):
    """Textures of a stage without which a picture is wrong."""

    stage: TechniqueUse
    names: tuple[str, ...]
    function: BakedFunction | None
    """The function that reads them, baked from the body; None for a picture that the stage names"""


def needed_textures(uses: Sequence[TechniqueUse]) -> list[NeededTextures]:
    """Those that are baked, then the other pictures that stages name. All other textures are optional."""
    functions = baked_functions(uses)
    baked = {(function.stage.technique.name, texture.name) for function in functions for texture in function.textures}
    pictures = [(use, name) for use in uses for name in use.textures if (use.technique.name, name) not in baked]
    return [
        *(NeededTextures(one.stage, tuple(texture.name for texture in one.textures), one) for one in functions),
        *(NeededTextures(use, (name,), None) for use, name in pictures),
    ]


def read_uniforms(use: TechniqueUse) -> Iterator[Uniform]:
    """The parameters and textures that a technique reads, itself and in the functions that are bound to its slots."""
    for module, function in _functions(use):
        yield from _uniforms_read(module, function)


def texel_bytes(uniform: Uniform) -> int:
    """The bytes of a texel of a baked texture."""
    return int(float(dict(uniform.hints).get("texel_bytes", (TEXEL_BYTES,))[0]))


def _is_distance(slot: Function) -> bool:
    """Whether a slot takes the body as a distance function: a number at a position."""
    return len(slot.params) == 1 and not slot.quantity


def _functions(use: TechniqueUse) -> Iterator[tuple[Module, Function]]:
    yield use.technique.module, use.technique.function
    for binding in use.bindings.values():
        yield binding.module, binding.function


def _uniforms_read(module: Module, function: Function) -> Iterator[Uniform]:
    names = needs(module, function)[0]
    return (uniform for uniform in module.uniforms if uniform.name in names)


def _attributes(function: Function) -> Attributes:
    """The attributes of a function; a user's distance function needs none at all."""
    try:
        return attributes.read_attributes(attributes.sections(function.doc), "")
    except SssgenError:
        return Attributes()
