"""The shares of imported bodies that scatter light: they follow the size, and the matte share has the medium's hue."""

from __future__ import annotations

import io

import numpy as np
import pytest
from PIL import Image as Pillow

from sssgen.interchange.body_shares import shares_of
from sssgen.interchange.imported_material import Notes
from sssgen.interchange.surface_model import Image, Picture, Quantity, SurfaceModel, medium
from sssgen.interchange.technique_choice import Choice, choose
from sssgen.material.scatter_color import albedo_of_multiscatter

ALBEDO = albedo_of_multiscatter((0.8, 0.5, 0.3))


def chosen(base: Quantity, share: float = 1.0) -> Choice:
    """The choice for a body of five mean free paths, of which the subsurface has a share."""
    inside = medium((5.0,) * 3, ALBEDO)
    return choose(
        SurfaceModel("wax", base_color=base, subsurface=Quantity((share,)), interior=inside), Notes(), 1.0, True, 1.0
    )


def value(choice: Choice, technique: str, name: str) -> object:
    return next(dict(stage.values)[name] for stage in choice.stages if stage.technique == technique)


def test_a_larger_body_is_more_matte_and_has_smaller_octaves() -> None:
    sizes = [0.1, 0.5, 1.5, 3.0, 6.0, 12.0, 29.0, 100.0]
    shares = [shares_of((size,) * 3, ALBEDO) for size in sizes]
    matte, octaves = [part.matte[0] for part in shares], [sum(part.octaves) for part in shares]
    assert matte == sorted(matte) and octaves[3:] == sorted(octaves[3:], reverse=True)
    assert matte[0] == matte[1] < 0.1 and 0.6 < matte[-2] < matte[-1] < 0.8
    assert all(0.0 <= share <= 8.0 for part in shares for share in part.octaves)


def test_sizes_between_those_of_the_table_are_interpolated() -> None:
    low, middle, high = (shares_of((size,) * 3, ALBEDO) for size in (4.0, 4.0 * 2.0**0.5, 8.0))
    assert np.array(middle.octaves) == pytest.approx(0.5 * np.add(low.octaves, high.octaves), abs=2e-3)


def test_the_matte_share_has_the_hue_of_a_dense_body() -> None:
    """Also where the channels' mean free paths differ: by its own share, each channel would have another hue."""
    matte = np.array(shares_of((2.0, 8.0, 16.0), ALBEDO).matte)
    assert matte / matte[0] == pytest.approx(np.array([0.8, 0.5, 0.3]) / 0.8, rel=1e-6)


def test_a_body_has_the_rest_of_its_base_colour_and_the_matte_share() -> None:
    base, share = (0.2, 0.4, 0.0), 0.25
    expected = 0.75 * np.array(base) + share * np.array(shares_of((5.0,) * 3, ALBEDO).matte)
    choice = chosen(Quantity(base), share)
    assert value(choice, "base_color", "tint")[:3] == pytest.approx(expected, abs=1e-3)
    octaves = value(choice, "interior_octaves", "octaves")
    assert octaves == pytest.approx(share * np.array(shares_of((5.0,) * 3, ALBEDO).octaves))


def test_no_light_enters_a_metal() -> None:
    model = SurfaceModel(
        "gold", base_color=Quantity((0.9, 0.7, 0.3)), metalness=Quantity((1.0,)), subsurface=Quantity((1.0,)),
        interior=medium((5.0,) * 3, ALBEDO),
    )  # fmt: skip
    choice = choose(model, Notes(), 1.0, True, 1.0)
    assert value(choice, "base_color", "tint")[:3] == pytest.approx((0.9, 0.7, 0.3))
    assert "interior_octaves" not in [stage.technique for stage in choice.stages]


@pytest.mark.parametrize("shade", [0.1, 0.6])
def test_a_picture_of_the_base_colour_keeps_its_pattern(shade: float) -> None:
    """Its mean becomes the matte share; where a tint would exceed 1, the texture is computed."""
    pixels = np.full((8, 8, 3), shade)
    pixels[:4] *= 1.5
    file = io.BytesIO()
    Pillow.fromarray((255.0 * pixels).round().astype(np.uint8)).save(file, "PNG")
    picture = Quantity((1.0, 1.0, 1.0), Image(Picture("base.png", file.getvalue())))
    choice = chosen(picture)
    stage = next(dict(stage.values) for stage in choice.stages if stage.technique == "base_color")
    texture = np.asarray(Pillow.open(io.BytesIO(choice.files[stage["base_color_texture"]])).convert("RGB")) / 255.0
    linear = np.where(texture <= 0.04045, texture / 12.92, ((texture + 0.055) / 1.055) ** 2.4)
    result = linear * stage["tint"][:3]
    assert result.mean(axis=(0, 1)) == pytest.approx(shares_of((5.0,) * 3, ALBEDO).matte, rel=0.03)
    assert result[:4].mean() / result[4:].mean() == pytest.approx(1.5, rel=0.03)
