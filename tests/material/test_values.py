"""Values of parameters: those that fit a uniform become its components; others are refused."""

from __future__ import annotations

import itertools

import pytest

from sssgen.ir.nodes import NOWHERE, Uniform
from sssgen.ir.types import BY_NAME, Array
from sssgen.material import library
from sssgen.material.values import WrongValue, linear, read_value


def uniform(type_: str, *hints: tuple[str, tuple[float | str, ...]], length: int = 0) -> Uniform:
    result = BY_NAME[type_]
    return Uniform("u", Array(result, length) if length else result, (0.0,), hints, "", "", NOWHERE)


@pytest.mark.parametrize(
    ("type_", "raw", "expected"),
    [
        ("float", 1, (1.0,)),
        ("int", -3, (-3.0,)),
        ("bool", True, (1.0,)),
        ("bvec2", [True, False], (1.0, 0.0)),
        ("ivec3", [1, 2, 3], (1.0, 2.0, 3.0)),
        ("mat2", [1.0, 2.0, 3.0, 4.0], (1.0, 2.0, 3.0, 4.0)),
        ("mat2", [[1.0, 2.0], [3.0, 4.0]], (1.0, 2.0, 3.0, 4.0)),
    ],
)
def test_values(type_: str, raw: object, expected: tuple[float, ...]) -> None:
    assert read_value(uniform(type_), raw) == expected


def test_values_of_arrays() -> None:
    assert read_value(uniform("vec2", length=2), [[1, 2], [3, 4]]) == (1.0, 2.0, 3.0, 4.0)
    assert read_value(uniform("float", length=1), [1]) == (1.0,)


@pytest.mark.parametrize(
    ("type_", "raw"),
    [
        ("float", False),
        ("float", {}),
        ("int", 2**31),
        ("uint", -1),
        ("bool", 1),
        ("vec3", 1.0),
        ("vec3", []),
        ("mat2", [[1, 2, 3], [4]] * 2),
        ("vec2", [[[1]], {}]),
        ("float", float("nan")),
    ],
)
def test_wrong_values(type_: str, raw: object) -> None:
    with pytest.raises(WrongValue, match="'u'"):
        read_value(uniform(type_), raw)


@pytest.mark.parametrize(
    ("type_", "text", "expected"),
    [
        ("vec3", "#fff", (1.0, 1.0, 1.0)),
        ("vec3", "#000000", (0.0, 0.0, 0.0)),
        ("vec4", "#ffffff", (1.0, 1.0, 1.0, 1.0)),
        ("vec4", "#FFFFFF80", (1.0, 1.0, 1.0, 128 / 255)),  # alpha is linear already
    ],
)
def test_colours(type_: str, text: str, expected: tuple[float, ...]) -> None:
    assert read_value(uniform(type_, ("source_color", ())), text) == pytest.approx(expected)


@pytest.mark.parametrize("text", ["#ffffff80", "red", "#ggg", "", "fff", "#١١١"])
def test_wrong_colours(text: str) -> None:
    with pytest.raises(WrongValue):
        read_value(uniform("vec3", ("source_color", ())), text)


def test_the_srgb_curve_is_continuous_and_rises() -> None:
    values = [linear(i / 10_000) for i in range(10_001)]
    steps = [b - a for a, b in itertools.pairwise(values)]
    assert values[0] == 0.0
    assert values[-1] == pytest.approx(1.0)
    assert min(steps) > 0.0
    assert max(steps) < 2.4e-4


def test_a_colour_of_bytes_is_an_error() -> None:
    tint = next(one for one in library.load("base_color").uniforms if one.name == "tint")
    with pytest.raises(WrongValue, match="255 is no opacity of 'tint'") as wrong:
        read_value(tint, [200, 180, 150, 255])
    assert "#rrggbbaa" in wrong.value.hint
    assert read_value(tint, [2.0, 1.0, 0.5, 1.0]) == (2.0, 1.0, 0.5, 1.0)


def test_a_colour_that_light_fades_to_is_not_above_1() -> None:
    for name in ("absorption_tint", "gltf_volume"):
        color = next(one for one in library.load(name).uniforms if one.name == "attenuation_color")
        assert read_value(color, [0.0, 0.5, 1.0]) == (0.0, 0.5, 1.0)
        with pytest.raises(WrongValue, match=r"1\.4 is outside the range of 'attenuation_color'"):
            read_value(color, [1.4, 0.5, 1.0])
