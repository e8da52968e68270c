"""Textures that a program draws for each frame: what the hint `drawn` may name, and how the program draws it."""

from __future__ import annotations

BACK_FACES, LIGHT, DISTANT, LAYERS = "back_faces", "light_depth", "distant_light_depth", "distant_light_layers"

_OF_LIGHT = (
    "draw the translucent body alone from the light{}, with a depth test that keeps the nearest, into a float texture; "
    "each texel is the distance of the first surface from the light's plane in world units (not the value of the depth "
    "buffer), and more than any of the body's where there is none"
)

DRAWN = {
    BACK_FACES: "draw the translucent body alone with its front faces culled and a depth test that keeps the nearest, "
    "into a float texture that covers the screen; each texel is the distance from the eye (not the depth), and 0 where "
    "there is no back face",
    LIGHT: _OF_LIGHT.format(""),
    DISTANT: _OF_LIGHT.format(", which must be far away"),
    LAYERS: "draw the translucent body alone from the light, which must be far away, three times into a float texture: "
    "red has the nearest front face, green the nearest back face, blue the nearest front face behind that back face "
    "(discard the fragments in front of it); each is the distance from the light's plane in world units, and more than "
    "any of the body's where there is none",
}
"""What a texture shows → how the program draws it, as a sentence after the texture's name. A matrix with the same hint
is the view in which the texture is drawn."""

DISTANT_VIEWS = (DISTANT, LAYERS)
"""What is drawn in the view of a light from afar."""

LIGHT_VIEWS = (LIGHT, *DISTANT_VIEWS)
