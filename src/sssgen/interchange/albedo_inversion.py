"""The media of surface models, which give a colour and a length in place of coefficients."""

from __future__ import annotations

from sssgen.interchange.surface_model import extinction_of_color, medium
from sssgen.material.scatter_color import albedo_of_color
from sssgen.scene.measured.media import Medium

LEAST_RADIUS = 1e-6
"""A shorter mean free path, in metres, counts as this."""
MOST_ANISOTROPY = 0.95
"""The largest mean cosine that a medium keeps: beyond it the phase function is a line."""


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
