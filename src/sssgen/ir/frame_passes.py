"""The passes that a material needs before it is drawn: each draws a picture that a texture with the hint `drawn` shows.

A material's passes follow from its textures, in the order of their declarations. The reflection lists them, and every
host executes this list: `sssgen render`, and the runtimes of engines.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from sssgen.ir.nodes import Uniform
from sssgen.ir.types import FLOAT, Array, Matrix, Sampler

BACK_FACES, LIGHT, DISTANT, LAYERS = "back_faces", "light_depth", "distant_light_depth", "distant_light_layers"
EYE_LAYERS, MATT = "eye_layers", "matt_light"
INNER_LIGHT = "inner_light"
LIGHT_LAYERS = "light_layers"
SHADOW, OCCLUDERS = "shadow_depth", "occluders"
IRRADIANCE, REFLECTIONS = "irradiance", "reflections"
BEHIND = "scene_behind"

FAR = 6.0e4
"""The distance beside the body in a picture of light: more than any of a body's, and it fits into half a float."""


class FramePass(NamedTuple):
    """A pass: what it draws, from where, and what a texel has."""

    of: str
    """body (the object alone), casters (all that casts a shadow), both (each in layers of its own) or surroundings (all
    but the object)"""
    seen_from: str
    """eye, light, distant light, first light, each light (the four brightest, in tiles of 2 × 2), each shadow (the
    same, of the lights that cast one), everywhere (a cube map), or inside (a volume that fills the body's box)"""
    layers: tuple[str, ...]
    """For each channel the surface whose distance it has: `entry 1` is the nearest front face, `exit 1` the nearest
    back face, `entry 2` the nearest front face behind `exit 1`, `other 1` the nearest face of a caster that is not the
    body. () for light"""
    empty: str
    """A texel without a surface: `0`, or `far`, which is more than any distance"""
    how: str
    """How a program draws it, as a sentence after the texture's name"""


_OF_LIGHT = (
    "draw {} from the {}, with a depth test that keeps the nearest, into a float texture; "
    "each texel is the distance of the first surface from the light's plane in world units (not the value of the depth "
    "buffer), and more than any of {} where there is none"
)

FRAME_PASSES = {
    BACK_FACES: FramePass(
        "body", "eye", ("exit 1",), "0",
        "draw the translucent body alone with its front faces culled and a depth test that keeps the nearest, "
        "into a float texture that covers the screen; each texel is the distance from the eye (not the depth), and 0 "
        "where there is no back face",
    ),
    EYE_LAYERS: FramePass(
        "body", "eye", ("exit 1", "entry 2", "exit 2"), "far",
        "draw the translucent body alone from the eye, three times into a float texture that covers the screen: red "
        "has the nearest back face, green the nearest front face behind that back face, blue the nearest back face "
        "behind that (discard the fragments in front of it); each is the distance from the eye (not the depth), and "
        "more than any of the body's where there is none",
    ),
    MATT: FramePass(
        "body", "eye", ("light", "light", "light", "entry 1"), "far",
        "draw the translucent body alone from the eye with a white matt material, in all its lights and shadows, into "
        "a float texture that covers the screen; each texel is the light that this reflects, and in alpha the "
        "distance from a plane across the view in world units (not the value of the depth "
        "buffer), and more than any of the body's where there is none",
    ),
    INNER_LIGHT: FramePass(
        "body", "inside", ("light",), "0",
        "compute the light inside the body from its bake, whenever a light, the surroundings or the body has moved, "
        "into a float volume that fills the bake's box: for each voxel the sum over the lights of the irradiance there "
        "times what the bake has for the light's direction, and the surroundings as spherical harmonics",
    ),
    LIGHT: FramePass(
        "body", "light", ("entry 1",), "far", _OF_LIGHT.format("the translucent body alone", "light", "the body's")
    ),
    DISTANT: FramePass(
        "body", "distant light", ("entry 1",), "far",
        _OF_LIGHT.format("the translucent body alone", "light, which must be far away", "the body's"),
    ),
    LIGHT_LAYERS: FramePass(
        "body", "each light", ("entry 1", "exit 1", "entry 2", "exit 2"), "far",
        "for each of the four lights that are brightest at the translucent body, draw this body alone from the light, "
        "four times into a tile of 2 x 2 of a float texture: red has the nearest front face, green the nearest back "
        "face, blue the nearest front face behind that back face, alpha the nearest back face behind that; each is the "
        "distance from the light's plane in world units, and more than any of the body's where there is none. The "
        "matrix of a light that there is not has zeros",
    ),
    SHADOW: FramePass(
        "casters", "first light", ("entry 1",), "far",
        _OF_LIGHT.format("all that casts a shadow", "first light", "these"),
    ),
    OCCLUDERS: FramePass(
        "both", "each shadow", ("entry 1", "other 1"), "far",
        "for each of the four lights with a shadow that are brightest at the translucent body, draw the bodies from "
        "the light into a tile of 2 x 2 of a float texture: red has the nearest front face of the translucent body, "
        "green the nearest face of all others that cast a shadow; each is the distance from the light's plane in "
        "world units, and more than any of the body's where there is none. The matrix of a light that there is not has "
        "zeros",
    ),
    IRRADIANCE: FramePass(
        "surroundings", "everywhere", (), "0",
        "draw the light of the surroundings into a cube map in world space; each texel is the mean over the "
        "hemisphere around its direction, weighted with the cosine",
    ),
    REFLECTIONS: FramePass(
        "surroundings", "everywhere", (), "0",
        "draw the light of the surroundings into a cube map with levels, in world space; level 0 is the light "
        "itself, level i of n the mean that a mirror of roughness i / n shows from the front",
    ),
    BEHIND: FramePass(
        "surroundings", "eye", (), "0",
        "draw the scene without the translucent body from the eye, linear and before tone mapping, into a square float "
        "texture with mipmaps",
    ),
    LAYERS: FramePass(
        "body", "distant light", ("entry 1", "exit 1", "entry 2"), "far",
        "draw the translucent body alone from the light, which must be far away, three times into a float texture: "
        "red has the nearest front face, green the nearest back face, blue the nearest front face behind that back "
        "face (discard the fragments in front of it); each is the distance from the light's plane in world units, and "
        "more than any of the body's where there is none",
    ),
}  # fmt: skip
"""The passes by the word of the hint `drawn`."""

EYE_PICTURES = (BACK_FACES, EYE_LAYERS)
"""Pictures of distances from the eye, in the places of the screen's pixels."""
CUBES = tuple(name for name, drawn in FRAME_PASSES.items() if drawn.seen_from == "everywhere")
"""What is drawn into a cube map."""
VOLUMES = tuple(name for name, drawn in FRAME_PASSES.items() if drawn.seen_from == "inside")
"""What is computed into a volume, from a bake: of the body's rest pose, so that techniques that read it take the place,
the normal and the view of that pose, where a target has them."""
DISTANT_VIEWS = tuple(name for name, drawn in FRAME_PASSES.items() if drawn.seen_from == "distant light")
"""What is drawn in the view of a light from afar."""
LIGHT_VIEWS = tuple(name for name, drawn in FRAME_PASSES.items() if drawn.seen_from.endswith("light"))
"""What is drawn in the view of a light."""


def shows_light(name: str) -> bool:
    """Whether a pass shows the light on the body, and not distances alone."""
    return "light" in FRAME_PASSES[name].layers


class PassUse(NamedTuple):
    """A pass of a material, with the uniforms that a host sets."""

    name: str
    texture: Uniform
    """The picture"""
    views: tuple[Uniform, ...]
    """For each light, or for the eye, the matrix from world space to the picture: (u w, v w, distance from the light's
    plane, or from one across the eye's view, w)"""
    lights: Uniform | None
    """What these lights are, where the pass says it: an array"""
    size: Uniform | None
    """The width of the picture in texels, or the last level of a picture with levels"""


def pass_name(uniform: Uniform) -> str:
    """The pass that a uniform belongs to; '' for none."""
    return str(dict(uniform.hints).get("drawn", ("",))[0])


def passes_of(uniforms: Iterable[Uniform]) -> list[PassUse]:
    """The passes that a program with these uniforms needs, in order."""
    drawn = [uniform for uniform in uniforms if pass_name(uniform)]
    uses: list[PassUse] = []
    for texture in (uniform for uniform in drawn if isinstance(uniform.type, Sampler)):
        name = pass_name(texture)
        own = [uniform for uniform in drawn if pass_name(uniform) == name]
        views = tuple(uniform for uniform in own if isinstance(uniform.type, Matrix))
        lights = next((uniform for uniform in own if isinstance(uniform.type, Array)), None)
        size = next((uniform for uniform in own if uniform.type == FLOAT), None)
        uses.append(PassUse(name, texture, views, lights, size))
    return uses
