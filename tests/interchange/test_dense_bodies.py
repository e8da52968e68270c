"""Bodies of many mean free paths become matte, and balls without a mesh are small enough for their medium."""

from __future__ import annotations

import pytest

from sssgen.interchange.dense_bodies import DENSE, as_matte
from sssgen.interchange.imported_material import Notes
from sssgen.interchange.scene_text import ball_radius
from sssgen.interchange.surface_model import Quantity, SurfaceModel, medium


def scattering(extinction: float, share: float = 1.0, albedo: float = 0.9) -> SurfaceModel:
    """A body with a subsurface."""
    return SurfaceModel(
        "wax",
        base_color=Quantity((0.2, 0.2, 0.2)),
        subsurface=Quantity((share,)),
        interior=medium((extinction,) * 3, (albedo,) * 3),
    )


def test_a_thin_body_keeps_its_medium() -> None:
    model = scattering(1.0)
    assert as_matte(model, Notes(), 0.9 * DENSE) is model


def test_a_dense_body_has_the_color_of_its_medium() -> None:
    """The base colour and what the medium reflects, by the share of the subsurface."""
    notes = Notes()
    result = as_matte(scattering(1000.0, 0.5), notes, 1.0)
    full = as_matte(scattering(1000.0), Notes(), 1.0).base_color.factor[0]
    assert full == pytest.approx(0.47, abs=0.01), "what iadpython has for an albedo of 0.9"
    assert result.base_color.factor[0] == pytest.approx(0.5 * 0.2 + 0.5 * full)
    assert not result.transmits and result.interior is None
    assert "mean free paths" in notes.by_field["interior"][0] and "0.1%" in notes.by_field["interior"][1]


def test_clear_bodies_and_sheets_stay() -> None:
    clear = SurfaceModel("glass", transmission=Quantity((1.0,)), interior=medium((1000.0,) * 3, (0.0,) * 3))
    sheet = SurfaceModel("paper", thin_walled=True, diffuse_transmission=Quantity((0.5,)))
    for model in (clear, sheet):
        assert as_matte(model, Notes(), 1.0) is model


def test_the_ball_of_a_material_without_a_mesh() -> None:
    assert ball_radius(SurfaceModel("matte")) == 1.0
    assert ball_radius(scattering(0.1)) == 1.0
    assert ball_radius(scattering(1000.0)) == pytest.approx(0.006)
    assert as_matte(scattering(1000.0), Notes(), 4.0 / 3.0 * 0.006).interior is not None
