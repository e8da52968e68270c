"""The values that a shell passes to the assembled functions: their meaning and their space, for those who call them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple


class ChainInput(NamedTuple):
    """What a value is."""

    meaning: str
    space: str = ""
    """world, object, texture or screen; '' for what has no space."""


CHAIN_INPUTS: Mapping[str, ChainInput] = {
    "uv": ChainInput("the texture coordinate", "texture"),
    "P": ChainInput("the position of the surface point", "world"),
    "N": ChainInput("the unit normal; per light, with the normal map of the surface", "world"),
    "V": ChainInput("the unit direction towards the eye", "world"),
    "T": ChainInput("the unit tangent, in the direction of u", "world"),
    "B": ChainInput("the unit bitangent, in the direction of v", "world"),
    "L": ChainInput("the unit direction towards the light", "world"),
    "P_object": ChainInput("the position of the surface point", "object"),
    "N_object": ChainInput("the unit normal", "object"),
    "V_object": ChainInput("the unit direction towards the eye", "object"),
    "L_object": ChainInput("the unit direction towards the light", "object"),
    "screen_uv": ChainInput("the position on the screen, 0 to 1", "screen"),
    "eye_distance": ChainInput("the distance from the eye to the surface point"),
    "time": ChainInput("the time in seconds"),
    "light_color": ChainInput("the colour of the light where it arrives"),
    "light_nearness": ChainInput("1 / the distance to the light, 0 for a light from afar"),
    "ray_origin": ChainInput("the origin of the eye's ray", "world"),
    "ray_direction": ChainInput("the unit direction of the eye's ray", "world"),
    "uv2": ChainInput("the texture coordinate of the second set; 0 where the mesh has none", "texture"),
    "vertex_color": ChainInput("the linear colour and opacity of the vertices; white where the mesh has none"),
    "P_rest": ChainInput("the position of the surface point before bones have moved it", "world"),
    "N_rest": ChainInput("N, turned back by the rotation of the bones", "world"),
    "V_rest": ChainInput("V, turned back by the rotation of the bones", "world"),
    "irradiance": ChainInput("the light of the surroundings on a white matte surface that faces N"),
    "irradiance_behind": ChainInput("the same on one that faces -N"),
    "surface": ChainInput("the result of evaluate_surface"),
    "color": ChainInput("the final color"),
}

SHELL_INPUTS: Mapping[str, ChainInput] = {
    "camera_position": ChainInput("the position of the eye", "world"),
    "vertex_normal": ChainInput("the normal of the mesh, of any length", "world"),
    "vertex_tangent": ChainInput("the tangent of the mesh, of any length; w: the handedness, +1 or -1", "world"),
    "front_facing": ChainInput("whether this is a front face"),
    "ray": ChainInput("the direction of the eye's ray, of any length", "world"),
    "model": ChainInput("the matrix from object to world"),
    "inverse_model": ChainInput("its inverse"),
    "ambient_color": ChainInput("the uniform light from all around"),
    "light_count": ChainInput("the number of lights, at most 4"),
    "light_positions": ChainInput("w = 1: where a light is; w = 0: the direction towards it", "world"),
    "light_colors": ChainInput("the light that a white surface reflects which faces the light, at the distance 1"),
}
"""What the shells of targets without an engine read, in addition (`shells/fragment.sss`)."""
