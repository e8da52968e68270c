"""Uniforms of struct types, split: they read the same, in every target."""

from __future__ import annotations

from typing import Any

import pytest

from ir_interpreter import Interpreter
from sssgen.ir.text import read_module
from sssgen.ir.verify import check_module
from sssgen.passes.stage.uniform_structs import uniform_structs
from whole_shaders import TARGETS, compile_errors, emitted_shader

LIGHTS = """struct Fall {
    float near;
    float[2] steps;
}
struct Light {
    vec3 color;
    Fall fall;
}
uniform Light[3] lights = (NUMBERS)
uniform Light sun = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
variable private Light first = $lights[0]
function float pick(in Light l, in int k) {
    return (l.color.x + l.fall.steps[k]);
}
function float f(in int i, in int j) {
    var Light a = $lights[i];
    var Fall b = $sun.fall;
    var Light[3] all = $lights;
    var float[2] q = $lights[i].fall.steps;
    var float x = (($lights[(i + 1)].fall.steps[j] + $pick($lights[2], 1)) + (a.fall.near * b.steps[j]));
    return ((x + ($first.color.y * q[j])) - (all[i].color[1] + $lights[1].fall.steps[0]));
}
function void main() {
}
""".replace("NUMBERS", ", ".join(f"{number}.5" for number in range(18)))


def values(numbers: tuple[float, ...], shape: Any) -> Any:
    """Numbers as a value of the interpreter's: `shape` counts scalars, or lists the shapes of the parts."""
    inputs = iter(numbers)

    def built(part: Any) -> Any:
        return tuple(map(built, part)) if isinstance(part, tuple) else next(inputs)

    return built(shape)


@pytest.mark.parametrize("i", [0, 1])
@pytest.mark.parametrize("j", [0, 1])
def test_a_split_struct_of_uniforms_reads_the_same(i: int, j: int) -> None:
    module = read_module(LIGHTS)
    check_module(module)
    split = uniform_structs(module)
    check_module(split, linked=True)
    light = ((0, 0, 0), (0, (0, 0)))
    lights, sun = module.uniforms
    table = {"lights": values(lights.default, (light,) * 3), "sun": values(sun.default, light)}
    apart: dict[str, Any] = {}
    for uniform in split.uniforms:
        shape: Any = {"color": (0, 0, 0), "near": 0, "steps": (0, 0)}[uniform.name.rsplit("_", 1)[1]]
        if uniform.name.startswith("lights"):
            shape = (0,) * 6 if shape == (0, 0) else (shape,) * 3
        apart[uniform.name] = values(uniform.default, shape)
    expected = Interpreter(module, table).call("f(int,int)", i, j)
    assert Interpreter(split, apart).call("f(int,int)", i, j) == expected


@pytest.mark.parametrize("target", TARGETS)
def test_a_struct_of_uniforms_compiles(target: str) -> None:
    assert compile_errors(emitted_shader(LIGHTS, target), target) == []
