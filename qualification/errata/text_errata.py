"""The errata that no number shows, and why."""

from __future__ import annotations

from typing import NamedTuple


class TextErratum(NamedTuple):
    """An erratum in words."""

    source: str
    claim: str
    reason: str


TEXT_ERRATA = (
    TextErratum(
        "Cheap SSS", "tap 0 is wasted", "it is 0 in every sum: the .38667 above is a sum of 29 taps, divided by 30"
    ),
    TextErratum("Cheap SSS", "th does not depend on the light", "it has no such parameter; `march_light` has one"),
    TextErratum("Cheap SSS", "rays over the hemisphere are described without code", "there is nothing to run"),
    TextErratum(
        "Alisavakis", "the light's direction is called a position", "only the text is wrong, the code is correct"
    ),
    TextErratum("Alisavakis", "`fixed4` clips a bright colour", "a type of Unity; everything here computes in float32"),
    TextErratum(
        "Alisavakis", "the colour's alpha is added to the surface's", "the baseline omits it: light has no alpha"
    ),
    TextErratum(
        "Alisavakis",
        "the light's colour is shadowed by the body itself",
        "the engine does this before it calls the technique",
    ),
    TextErratum(
        "Alisavakis, Unity ice",
        "a bright map means thick in one source, transparent in the other",
        "in `sssgen` this is a type error",
    ),
    TextErratum("3D Distance Fields", '"convex" should be "concave"', "only a word is wrong"),
    TextErratum(
        "3D Distance Fields",
        "the numbers and lengths of steps and the conversion to light are missing",
        "the text contains no error",
    ),
    TextErratum("Unity ice", "iceAmount is the amount of what covers the ice", "only a name is misleading"),
    TextErratum(
        "Subsurface Parallax",
        "a `float2` is assigned from three components",
        "it does not compile; the baseline has a vec3",
    ),
    TextErratum(
        "Subsurface Parallax",
        "the text's refract(v, n, η) has the wrong sign",
        "the code, which the baseline follows, is correct",
    ),
)

WITHOUT_ERRATA = {
    "gltf_thin_wall": "for sheets, where it is right; a body has a thickness",
    "hdrp_transmittance": "the integral of its profile behind a slab, as its source derives it",
    "openpbr_thin_wall": "for sheets, where it is right; a body has a thickness",
    "preintegrated_skin": "the integral of its source; it has no light through the body",
    "rtxcr_skin": "a path of two segments and a profile, as its source says",
    "skin_translucency": "the profile of skin, as its source says",
    "translucent_shadow_map": "the dipole of a half space, as its source says",
}
"""Baselines that do what their source says: the chart compares them, and there is nothing to correct. Name → why."""
