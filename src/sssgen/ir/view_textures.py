"""Textures that a program draws for each frame: what the hint `drawn` may name, and how the program draws it."""

from __future__ import annotations

BACK_FACES, LIGHT, DISTANT, LAYERS = "back_faces", "light_depth", "distant_light_depth", "distant_light_layers"
SHADOW = "shadow_depth"
IRRADIANCE, REFLECTIONS = "irradiance", "reflections"

_OF_LIGHT = (
    "draw {} from the {}, with a depth test that keeps the nearest, into a float texture; "
    "each texel is the distance of the first surface from the light's plane in world units (not the value of the depth "
    "buffer), and more than any of {} where there is none"
)

VIEW_TEXTURES = {
    BACK_FACES: "draw the translucent body alone with its front faces culled and a depth test that keeps the nearest, "
    "into a float texture that covers the screen; each texel is the distance from the eye (not the depth), and 0 where "
    "there is no back face",
    LIGHT: _OF_LIGHT.format("the translucent body alone", "light", "the body's"),
    DISTANT: _OF_LIGHT.format("the translucent body alone", "light, which must be far away", "the body's"),
    SHADOW: _OF_LIGHT.format("all that casts a shadow", "first light", "these"),
    IRRADIANCE: "draw the light of the surroundings into a cube map in world space; each texel is the mean over the "
    "hemisphere around its direction, weighted with the cosine",
    REFLECTIONS: "draw the light of the surroundings into a cube map with levels, in world space; level 0 is the light "
    "itself, level i of n the mean that a mirror of roughness i / n shows from the front",
    LAYERS: "draw the translucent body alone from the light, which must be far away, three times into a float texture: "
    "red has the nearest front face, green the nearest back face, blue the nearest front face behind that back face "
    "(discard the fragments in front of it); each is the distance from the light's plane in world units, and more than "
    "any of the body's where there is none",
}
"""What a texture shows → how the program draws it, as a sentence after the texture's name. A matrix with the same hint
is the view in which the texture is drawn, a number its size."""

CUBES = (IRRADIANCE, REFLECTIONS)
"""What is drawn into a cube map."""

DISTANT_VIEWS = (DISTANT, LAYERS)
"""What is drawn in the view of a light from afar."""

LIGHT_VIEWS = (LIGHT, SHADOW, *DISTANT_VIEWS)
