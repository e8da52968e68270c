"""What a refracting surface changes of the light inside a body: it reflects a part back, which is scattered again."""

from __future__ import annotations

import math
from collections.abc import Sequence

from sssgen.material.material_text import MaterialSection

_SLOW = 0.18
"""The share of `interior_octaves` whose light fades slowest that is added: light which the surface reflects back goes
deeper. Fitted, as is `_MATTE`, to wax, jade, skin and soap on three bodies (docs/preset_errors.md has others)."""
_MATTE = 0.69
"""The share of the matte reflection that is left: light of the front is also in the octaves."""


def leaving_shares(colors: Sequence[float], ior: float) -> list[float]:
    """The light that leaves a refracting surface over that of a matched one, for what a thick body reflects, 0 to 1.

    (1 - F) / (1 - F c): of light that reaches the surface from inside, F is reflected back, of which the body returns
    the share c, again and again. F is the diffuse reflectance from inside for the index of refraction `ior`, in the
    fit of Egan and Hilgeman (1973) that Jensen and others use (A Practical Model for Subsurface Light Transport, 2001).
    """
    inside = -1.440 / ior**2 + 0.710 / ior + 0.668 + 0.0636 * ior if ior > 1.0 else 0.0
    return [(1.0 - inside) / (1.0 - inside * min(max(color, 0.0), 1.0)) for color in colors]


def behind_boundary(stage: MaterialSection, colors: Sequence[float], ior: float) -> MaterialSection:
    """A stage of a body with a matched surface, as it is below a refracting one; `colors` are of a thick body."""
    shares = leaving_shares(colors, ior)
    values = dict(stage.values)
    if stage.technique == "base_color":
        red, green, blue, alpha = _numbers(values["tint"])
        tint = [_MATTE * share * part for share, part in zip(shares, (red, green, blue), strict=True)]
        return stage._replace(values=tuple((values | {"tint": [*tint, alpha]}).items()))
    if stage.technique != "interior_octaves":
        return stage
    # the light of octaves has the square of the albedo
    largest = max(shares)
    albedo = _numbers(values["scattering_albedo"])
    values["scattering_albedo"] = [a * math.sqrt(s / largest) for a, s in zip(albedo, shares, strict=True)]
    *faster, slowest = _numbers(values["octaves"])
    values["octaves"] = [round(largest * share, 3) for share in (*faster, slowest + _SLOW)]
    return stage._replace(technique="interior_octaves_refracted", values=tuple((values | {"ior": ior}).items()))


def _numbers(value: object) -> list[float]:
    assert isinstance(value, list | tuple)
    return [float(number) for number in value]
