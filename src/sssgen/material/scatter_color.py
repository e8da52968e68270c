"""The single-scattering albedo of a thick medium from its colour, and back: artists choose the colour, light transport
needs the albedo."""

from __future__ import annotations

import math
from collections.abc import Sequence

_BACK_SCATTERING = 0.225
"""Fitted to adding-doubling for g from -0.9 to 0."""


def albedo_of_multiscatter(color: Sequence[float], anisotropy: float = 0.0) -> tuple[float, ...]:
    """The single-scattering albedo for a multi-scatter colour, each component 0 to 1.

    Kulla and Conty, Revisiting Physically Based Shading at Imageworks, SIGGRAPH 2017 course, as in glTF's draft
    KHR_materials_volume_scatter: s = 4.09712 + 4.20863 c - sqrt(9.59217 + 41.6808 c + 17.7126 c^2), albedo = 1 - s^2.
    With an anisotropy g, as in the draft KHR_materials_scatter: (1 - s^2) / (1 - g s^2), the similarity relation.
    """
    squares = [absorbing_root(part) ** 2 for part in color]
    return tuple(min(max((1.0 - square) / (1.0 - anisotropy * square), 0.0), 1.0) for square in squares)


def albedo_of_color(color: float, anisotropy: float = 0.0) -> float:
    """The single-scattering albedo of a thick medium that reflects the share `color` of diffuse light, 0 to 1.

    The boundary is matched. `anisotropy` is the mean cosine of the phase function of Henyey and Greenstein. The error
    of the reflected share is at most 0.006 for an anisotropy from -0.9 to 0.95. Light along the normal is reflected
    less than diffuse light.

    Source: OpenPBR Surface 1.1, Subsurface, which has the inverse of van de Hulst's approximation of the spherical
    albedo. For negative anisotropies, where it reflects too much, the colour is lowered first.
    """
    c = min(max(color, 0.0), 1.0)
    if anisotropy < 0.0:
        c -= _BACK_SCATTERING * anisotropy * anisotropy * c * (1.0 - c) ** 2
    return albedo_of_multiscatter([c], anisotropy)[0]


def absorbing_root(color: float) -> float:
    """The root of the absorbed share, s of the equation above, of a medium with isotropic scattering."""
    return 4.09712 + 4.20863 * color - math.sqrt(9.59217 + 41.6808 * color + 17.7126 * color * color)


def multiscatter_of_albedo(albedo: Sequence[float], anisotropy: float = 0.0) -> tuple[float, ...]:
    """The colour for which `albedo_of_multiscatter` returns these albedos."""
    return tuple(_color_of(part, anisotropy) for part in albedo)


def _color_of(albedo: float, anisotropy: float) -> float:
    s = math.sqrt(max(0.0, (1.0 - albedo) / (1.0 - anisotropy * albedo)))
    low, high = 0.0, 1.0
    for _ in range(60):  # the albedo grows with the colour
        middle = 0.5 * (low + high)
        if absorbing_root(middle) > s:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)
