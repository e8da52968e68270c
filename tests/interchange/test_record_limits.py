"""Numbers that no material has are limited, with a note."""

from __future__ import annotations

from sssgen.interchange.imported_material import Notes
from sssgen.interchange.record_limits import limit_numbers
from sssgen.interchange.surface_model import Image, Picture, Quantity, SurfaceModel


def test_constants_are_limited() -> None:
    notes = Notes()
    model = SurfaceModel("m", metalness=Quantity((2.0,)), emission=Quantity((-1.0, 5.0, 1e9)))
    result = limit_numbers(model, notes)
    assert (result.metalness.factor, result.emission.factor) == ((1.0,), (0.0, 5.0, 1000.0))
    assert {*notes.by_field} == {"metalness", "emission"}


def test_usual_records_stay() -> None:
    """A picture may have a factor above 1."""
    image = Image(Picture("dark.png", b""))
    model = SurfaceModel("m", base_color=Quantity((4.0, 4.0, 4.0), image))
    assert limit_numbers(model, Notes()) is model


def test_a_thickness_is_a_length_also_with_a_picture() -> None:
    notes, image = Notes(), Image(Picture("thickness", b""), "r")
    model = SurfaceModel("thick", thickness=Quantity((1e9,), image), base_color=Quantity((5.0, 5.0, 5.0), image))
    result = limit_numbers(model, notes)
    assert result.thickness.factor == (1e6,) and result.base_color.factor == (5.0, 5.0, 5.0)
    assert "1e+06" in notes.by_field["thickness"][0]


def test_an_index_is_not_negative() -> None:
    notes = Notes()
    assert limit_numbers(SurfaceModel("m", ior=-1.0), notes).reflectance == 0.0
    assert "ior" in notes.by_field
