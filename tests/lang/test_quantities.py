"""The rules of quantity types, each with valid and invalid examples."""

from __future__ import annotations

import pytest

from sssgen.ir.types import FLOAT, VEC3, Type, spell
from sssgen.ir.verify import verify
from sssgen.lang.check import quantities as q
from sssgen.lang.check.module_checker import check
from sssgen.lang.check.quantities import QUANTITIES
from sssgen.lang.syntax.parser import parse
from sssgen.support.diagnostics import SssgenError


def checked(source: str) -> None:
    assert verify(check(parse(source, "a.sss"), source)) == []


NAMES = {name: f"the_{name}" for name in QUANTITIES}
PARAMS = ", ".join(f"{name} {value}" for name, value in NAMES.items())


def fits(expression: str, quantity: str, type_: Type = FLOAT) -> bool:
    """Whether an expression may be returned as a quantity, or for '' as a plain type."""
    params = f"{PARAMS}, float x, vec3 v, mat3 m, bool p"
    function = f"{quantity or spell(type_)} f({params}) {{ return {expression}; }}"
    try:
        checked(f"uniform sampler2D map : holds(thinness);\n{function}")
    except SssgenError:
        return False
    return True


def measures(expression: str, plain: Type) -> str:
    """The quantity of an expression: which one it may be returned as."""
    assert fits(expression, "", plain), expression
    results = [name for name, type_ in QUANTITIES.items() if type_ == plain and fits(expression, name)]
    assert len(results) <= 1
    return results[0] if results else ""


@pytest.mark.parametrize("name", QUANTITIES)
def test_quantities_decay_and_are_named(name: str) -> None:
    """A quantity is its plain type at will; a plain value becomes one only by its constructor."""
    plain = QUANTITIES[name]
    value = f"{spell(plain)}(1.0)"
    assert fits(NAMES[name], "", plain)
    assert fits(NAMES[name], name)
    assert not fits(value, name)
    assert fits(f"{name}({value})", name)
    assert fits(f"{name}({NAMES[name]})", name)
    assert measures(f"{spell(plain)}({NAMES[name]})", plain) == ""


@pytest.mark.parametrize("source", QUANTITIES)
@pytest.mark.parametrize("target", QUANTITIES)
def test_quantities_never_become_each_other(source: str, target: str) -> None:
    same, alike = source == target, QUANTITIES[source] == QUANTITIES[target]
    assert fits(NAMES[source], target) == same
    assert fits(f"{target}({NAMES[source]})", target) == same
    if alike:
        assert fits(f"{target}({spell(QUANTITIES[source])}({NAMES[source]}))", target)


SCALAR = ("thickness", "thinness", "transmittance")
MEASURED = {
    # Sums
    **{f"the_{name} {op} the_{name}": name for name in SCALAR for op in "+-"},
    **{f"the_{name} {op} x": "" for name in SCALAR for op in "+-*/"},
    **{f"x {op} the_{name}": "" for name in SCALAR for op in "+-*/"},
    **{f"the_{name} {op} the_{other}": "" for name in SCALAR for other in SCALAR for op in "*/"},
    "the_world_position - the_world_position": "world_direction",
    "the_world_position + the_world_direction": "world_position",
    "the_world_direction + the_world_position": "world_position",
    "the_world_position - the_world_direction": "world_position",
    "the_world_direction + the_world_direction": "world_direction",
    "the_object_position + 2.0 * the_object_direction": "object_position",
    "the_world_position + the_thickness * the_world_direction": "world_position",
    "the_world_position + the_world_position": "",
    "the_world_position + v": "",
    "v - the_world_direction": "",
    # Products
    "x * the_world_direction": "world_direction",
    "the_world_direction * the_thickness": "world_direction",
    "the_world_direction / x": "world_direction",
    "x / the_world_direction": "",
    "v * the_world_direction": "",
    "the_world_direction * the_world_direction": "",
    "x * the_world_position": "",
    "m * the_world_direction": "",
    "the_world_direction * m": "",
    "m * the_tangent_position": "",
    # Signs
    "-the_world_direction": "world_direction",
    "-the_world_position": "",
    "-the_thickness": "",
    "+the_world_direction": "world_direction",
    # Builtins
    "normalize(the_world_direction)": "world_direction",
    "normalize(the_world_position)": "",
    "cross(the_world_direction, the_world_direction)": "world_direction",
    "cross(the_world_direction, v)": "world_direction",
    "reflect(the_world_direction, the_world_direction)": "world_direction",
    "refract(the_world_direction, the_world_direction, x)": "world_direction",
    "faceforward(the_world_direction, the_world_direction, the_world_direction)": "world_direction",
    "mix(the_world_direction, the_world_direction, x)": "world_direction",
    "mix(the_world_position, the_world_position, x)": "world_position",
    "mix(the_thickness, the_thickness, the_thinness)": "thickness",
    "mix(the_thickness, x, x)": "",
    "min(the_thickness, x)": "thickness",
    "max(x, the_thickness)": "thickness",
    "clamp(the_thinness, 0.0, 1.0)": "thinness",
    "clamp(x, the_thinness, the_thinness)": "thinness",
    "abs(the_thickness)": "thickness",
    "abs(the_world_direction)": "world_direction",
    "saturate(the_transmittance)": "transmittance",
    "length(the_world_direction)": "",
    "distance(the_world_position, the_world_position)": "",
    "dot(the_world_direction, the_world_position)": "",
    "exp(-the_thickness)": "",
    "step(the_thickness, the_thickness)": "",
    "smoothstep(the_thickness, the_thickness, the_thickness)": "",
    # Parts
    "the_world_direction.x": "",
    "the_world_direction.zyx": "",
    "the_world_direction[0]": "",
    "texture(map, the_uv_position).r": "thinness",
    "texture(map, the_uv_position)[0]": "",
    "texture(map, the_uv_position).rgb": "",
    "textureLod(map, the_uv_position, 0.0).g": "thinness",
    "(texture(map, the_uv_position) + texture(map, the_uv_position)).r": "thinness",
    # Choices
    "p ? the_thickness : the_thickness": "thickness",
    "p ? the_thickness : x": "",
}


@pytest.mark.parametrize("expression", MEASURED)
def test_quantities_of_expressions(expression: str) -> None:
    for plain in (FLOAT, VEC3):
        if fits(expression, "", plain):
            assert measures(expression, plain) == MEASURED[expression]
            return
    pytest.fail(f"{expression} is neither a float nor a vec3")


REFUSED = [
    *(f"x + (the_{name} {op} the_{other})" for name, other in (SCALAR[:2], SCALAR[1:]) for op in "+-"),
    *(f"(the_thickness {op} the_thinness) ? x : x" for op in ("<", ">", "<=", ">=", "==", "!=")),
    "length(the_world_direction - the_world_position)",
    "dot(the_world_direction, the_tangent_direction)",
    "distance(the_world_position, the_object_position)",
    "length(cross(the_world_direction, the_object_direction))",
    "length(reflect(the_world_direction, the_tangent_direction))",
    "length(refract(the_world_direction, the_tangent_direction, 1.0))",
    "length(faceforward(the_world_direction, the_world_direction, the_tangent_direction))",
    "length(mix(the_world_direction, the_world_position, 0.5))",
    "length(max(the_world_direction, the_world_position))",
    "length(the_world_position + the_object_direction)",
    "length(the_world_position * the_object_direction)",
    "length(the_uv_position - the_uv_position - the_uv_position)",
    "min(the_thickness, the_thinness)",
    "clamp(x, the_thickness, the_thinness)",
    "mix(the_thickness, the_thinness, x)",
    "step(the_thickness, the_thinness)",
    "smoothstep(the_thickness, the_thinness, x)",
    "p ? the_thickness : the_thinness",
    "texture(map, the_uv_direction).r",
    "(the_world_position == the_world_direction) ? x : x",
]


@pytest.mark.parametrize("expression", REFUSED)
def test_quantities_that_do_not_go_together(expression: str) -> None:
    assert not fits(expression, "")


def test_every_quantity_error_suggests_a_conversion() -> None:
    for source in ("", *QUANTITIES):
        for target in QUANTITIES:
            if source != target:
                assert q.conversion(source, target)
    assert q.conversion("thickness", "transmittance") == "convert it with beer_lambert(…)"
    assert q.conversion("thinness", "thickness") == "convert it with thickness_from_thinness(…)"
    assert (
        q.conversion("object_direction", "world_direction")
        == "convert it with world_from_object(…) of common/frames.sss"
    )


def test_quantities_in_arrays_and_structs() -> None:
    checked("thickness f(thickness list[2]) { return list[0] + list[1]; }")
    checked("struct S { thickness list[2]; };\nthickness f(S s) { s.list[0] = thickness(1.0); return s.list[1]; }")
    checked("float f() { thickness list[2] = float[2](thickness(1.0), thickness(2.0)); return list[0]; }")
    with pytest.raises(SssgenError, match="this must be a thickness"):
        checked("float f() { thickness list[2] = float[2](1.0, 2.0); return list[0]; }")


def test_scaling_in_place_keeps_a_quantity() -> None:
    """See docs/language.md: masks scale."""
    checked("thickness f(thickness d, thinness t, float x) { d *= x; d /= 2.0; d *= t; return d; }")
    checked("world_direction f(world_direction v) { v *= 2.0; return v; }")
    for statement in ("d += 1.0;", "d++;", "d += t;", "v *= m;", "v *= vec3(1.0);", "v += P;"):
        with pytest.raises(SssgenError):
            checked(f"void f(thickness d, thinness t, world_direction v, world_position P, mat3 m) {{ {statement} }}")
