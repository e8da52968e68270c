"""Stages that take the look of a medium, its colour and depth, in place of its albedo and extinction."""

from __future__ import annotations

import numpy as np
import pytest

from sssgen.material.material_loading import parse_material
from sssgen.material.model import TechniqueUse
from sssgen.material.scatter_color import albedo_of_color
from sssgen.support.diagnostics import SssgenError

HEAD = '[material]\nname = "m"\n[thickness]\ntechnique = "back_face_thickness"\n[translucency]\n'
OCTAVES = f'{HEAD}technique = "interior_octaves"\nbind = {{ light_path = "depth_map_path" }}\n'


def stage(text: str) -> TechniqueUse:
    return parse_material(text, "m.toml").stages[-1]


def test_color_and_depth_become_albedo_and_extinction() -> None:
    values = stage(f"{OCTAVES}color = [0.8, 0.2, 0.1]\ndepth = [0.5, 0.25, 0.1]\n").values
    assert values["scattering_albedo"] == pytest.approx([albedo_of_color(part) for part in (0.8, 0.2, 0.1)])
    assert values["extinction"] == pytest.approx((2.0, 4.0, 10.0))
    assert values["mean_free_path"] == pytest.approx((3.0 / 16.0,))


def test_each_key_stands_alone_and_may_be_fixed() -> None:
    use = stage(f"{OCTAVES}depth = {{ value = [0.5, 0.5, 0.5], fixed = true }}\nscattering_albedo = [0.5, 0.4, 0.3]\n")
    assert use.fixed == {"extinction", "mean_free_path"} and use.values["scattering_albedo"] == (0.5, 0.4, 0.3)


def test_a_mean_free_path_of_its_own_stays() -> None:
    assert stage(f"{OCTAVES}depth = [0.5, 0.5, 0.5]\nmean_free_path = 0.3\n").values["mean_free_path"] == (0.3,)
    sample = OCTAVES.replace("interior_octaves", "interior_sample")
    assert stage(f"{sample}depth = [0.5, 0.5, 0.5]\n").values["mean_free_path"] == pytest.approx((0.5,))


def test_a_color_is_srgb_where_it_is_a_text() -> None:
    from_text, from_numbers = (stage(f"{OCTAVES}color = {color}\n") for color in ('"#ff8000"', "[1.0, 0.2158605, 0.0]"))
    assert np.allclose(from_text.values["scattering_albedo"], from_numbers.values["scattering_albedo"], atol=1e-6)


@pytest.mark.parametrize(
    ("line", "place", "message"),
    [
        ("color = [0.8, 1.2, 0.1]", (8, 15), "1.2 is outside the range of 'color'"),
        ("depth = [0.0, 1.0, 1.0]", (8, 10), "0 is outside the range of 'depth'"),
        ("depth = 0.2", (8, 9), "'depth' takes 3 numbers"),
        ("depth = [0.2, 0.2]", (8, 9), "but this has 2 values"),
        ('color = "red"', (8, 9), "'red' is not a colour"),
        ("colour = [0.8, 0.2, 0.1]", (8, 1), "did you mean 'color'?"),
        ("color = [0.8, 0.2, 0.1]\nscattering_albedo = [0.5, 0.5, 0.5]", (9, 1), "the same parameter, given twice"),
        ("extinction = [5.0, 5.0, 5.0]\ndepth = [0.2, 0.2, 0.2]", (9, 1), "the same parameter, given twice"),
    ],
)
def test_errors_have_their_place(line: str, place: tuple[int, int], message: str) -> None:
    with pytest.raises(SssgenError) as caught:
        stage(f"{OCTAVES}{line}\n")
    (diagnostic,) = caught.value.diagnostics
    assert message in str(caught.value) and diagnostic.span[1:3] == place


def test_a_stage_without_these_parameters_takes_no_look() -> None:
    with pytest.raises(SssgenError, match="unknown parameter 'color' of 'absorption_tint'"):
        stage(f'{HEAD}technique = "absorption_tint"\ncolor = [0.5, 0.5, 0.5]\n')
