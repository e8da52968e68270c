"""The errata that no number shows, and why."""

from __future__ import annotations

from typing import NamedTuple


class Unshown(NamedTuple):
    """An erratum in words."""

    source: str
    said: str
    reason: str


UNSHOWN = (
    Unshown("Cheap SSS", "tap 0 is wasted", "it is 0 in every sum: the .38667 above is 29 taps over 30"),
    Unshown("Cheap SSS", "th knows no light", "it has no such parameter; `march_light` has one"),
    Unshown("Cheap SSS", "rays over the hemisphere are described without code", "there is nothing to run"),
    Unshown("Alisavakis", "the light's direction is called a position", "the text is wrong, its code is not"),
    Unshown("Alisavakis", "`fixed4` clips a bright colour", "a type of Unity's; everything here computes in float32"),
    Unshown(
        "Alisavakis", "the colour's alpha is added to the surface's", "the baseline leaves it out: light has no alpha"
    ),
    Unshown(
        "Alisavakis", "the light's colour is shadowed by the body itself", "the engine does it, before the technique"
    ),
    Unshown(
        "Alisavakis, Unity ice", "a bright map means thick in one, clear in the other", "here it is an error of types"
    ),
    Unshown("3D Distance Fields", '"convex" should read concave', "a word"),
    Unshown(
        "3D Distance Fields",
        "step counts, lengths and the transfer to light are not given",
        "nothing is said that is wrong",
    ),
    Unshown("Unity ice", "iceAmount is what covers the ice", "a name"),
    Unshown(
        "Subsurface Parallax", "`float2` is given three components", "it does not compile; the baseline has a vec3"
    ),
    Unshown(
        "Subsurface Parallax",
        "the text's refract(v, n, η) has the wrong sign",
        "its code, which the baseline is, has the right",
    ),
)
