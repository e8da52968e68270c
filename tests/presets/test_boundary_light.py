"""Light inside a body below a refracting surface."""

from __future__ import annotations

import numpy as np
import pytest

from sssgen.material.material_text import MaterialSection
from sssgen.presets.boundary_light import behind_boundary, leaving_shares


def diffuse_from_inside(ior: float) -> float:
    """Fresnel's reflectance of diffuse light from inside, by quadrature."""
    cosine = (np.arange(20000) + 0.5) / 20000
    sine_outside = ior * np.sqrt(1.0 - cosine**2)
    outside = np.sqrt(np.maximum(1.0 - sine_outside**2, 0.0))
    s = (ior * cosine - outside) / (ior * cosine + outside)
    p = (cosine - ior * outside) / (cosine + ior * outside)
    reflected = np.where(sine_outside < 1.0, 0.5 * (s**2 + p**2), 1.0)
    return float((2.0 * cosine * reflected).mean())


@pytest.mark.parametrize("ior", [1.2, 1.33, 1.5, 1.6])
def test_share_of_a_black_body_is_what_the_surface_lets_through(ior: float) -> None:
    """The fit is within 0.03 of Fresnel's equations."""
    assert leaving_shares([0.0], ior)[0] == pytest.approx(1.0 - diffuse_from_inside(ior), abs=0.03)


def test_white_body_and_matched_surface_lose_nothing() -> None:
    assert leaving_shares([1.0], 1.5) == pytest.approx([1.0])
    assert leaving_shares([0.2, 0.7], 1.0) == [1.0, 1.0]


def test_sum_over_reflections() -> None:
    """The share is the sum of a geometric series: what leaves at once, after one return, after two, and so on."""
    color, inside = 0.6, 1.0 - leaving_shares([0.0], 1.5)[0]
    series = sum((1.0 - inside) * (inside * color) ** count for count in range(200))
    assert leaving_shares([color], 1.5)[0] == pytest.approx(series)


def test_octaves_have_the_square_of_the_albedo() -> None:
    """What two channels differ by is that of the shares; the rest of the stage stays."""
    values = (
        ("extinction", [5.0, 5.0, 5.0]),
        ("scattering_albedo", [0.9, 0.9, 0.9]),
        ("octaves", [0.1, 0.2, 0.3, 0.0]),
    )
    colors = (0.8, 0.5, 0.2)
    stage = behind_boundary(MaterialSection("translucency", "interior_octaves", values), colors, 1.5)
    assert stage.technique == "interior_octaves_refracted"
    changed = dict(stage.values)
    shares, albedo = leaving_shares(colors, 1.5), changed["scattering_albedo"]
    assert isinstance(albedo, list)
    assert (albedo[2] / albedo[0]) ** 2 == pytest.approx(shares[2] / shares[0])
    assert changed["extinction"] == [5.0, 5.0, 5.0] and changed["ior"] == 1.5


def test_other_stages_stay() -> None:
    stage = MaterialSection("surface", "pbr_constants", (("metalness", 0.0),))
    assert behind_boundary(stage, (0.5, 0.5, 0.5), 1.5) is stage
