"""The medium behind a colour: artists choose what a thick body reflects, light transport needs an albedo."""

from __future__ import annotations

from sssgen.interchange.scatter_color import albedo_of_multiscatter
from sssgen.interchange.surface_model import extinction_of_color, medium
from sssgen.scene.measured.media import Medium

LEAST_RADIUS = 1e-6
"""A shorter mean free path, in metres, counts as this."""
MOST_ANISOTROPY = 0.95
"""The largest mean cosine that a medium keeps: beyond it the phase function is a line."""
_BACK_SCATTERING = 0.225
"""Fitted to adding-doubling for g from -0.9 to 0."""


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


def subsurface_medium(color: tuple[float, ...], radius: tuple[float, ...], anisotropy: float = 0.0) -> Medium:
    """The medium of OpenPBR's and standard_surface's subsurface: its colour, and its mean free paths in metres."""
    g = min(max(anisotropy, -MOST_ANISOTROPY), MOST_ANISOTROPY)
    extinction = tuple(1.0 / max(part, LEAST_RADIUS) for part in radius)
    return medium(extinction, tuple(albedo_of_color(part, g) for part in color), g)


def transmission_medium(
    color: tuple[float, ...], depth: float, scatter: tuple[float, ...], anisotropy: float = 0.0
) -> Medium:
    """The medium of OpenPBR's and standard_surface's transmission, for a depth above 0 in metres.

    The extinction is -ln(color) / depth, the scattering scatter / depth. Where that is more than the extinction, the
    absorption of all channels is raised by the same amount until none is negative.
    """
    g = min(max(anisotropy, -MOST_ANISOTROPY), MOST_ANISOTROPY)
    scattering = [max(part, 0.0) / depth for part in scatter]
    extinction = extinction_of_color(color, depth)
    absorption = [t - s for t, s in zip(extinction, scattering, strict=True)]
    shift = max(-min(absorption), 0.0)
    red, green, blue = (part + shift for part in absorption)
    return Medium("interior", (red, green, blue), (scattering[0], scattering[1], scattering[2]), g)
