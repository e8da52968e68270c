"""Guards give finite numbers at the ends of the assumed ranges, of matrices too, on every back end."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from pass_cases import module_of
from sssgen.ir.formats import FLOAT32
from sssgen.passes.ranges.range_pass import analyse
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Array, Backend, Call, Text
from sssgen.run.check.compiler_inputs import sources
from sssgen.run.compilers import Source
from sssgen.support.diagnostics import SssgenError

LARGEST = FLOAT32.largest
BACKENDS = ["numpy-f32", "gl", "webgpu", "hlsl"]
LANGUAGES = ("glsl-330", "glsl-es-300", "hlsl", "wgsl", "numpy")


def results(backend: Backend, source: str, *args: Any, guards: str = "auto") -> Array:
    """The results of the function `f` of a source for lanes of arguments: of each, a list of numbers or of lists."""
    module = module_of(source)
    (function,) = [function for function in module.functions if function.name == "f"]
    compiled = transpile(module, backend.target.name, "case", guards=guards, called=[function.key])
    text = next(text for name, text in compiled.files.items() if not name.endswith(".json"))
    arrays = [np.moveaxis(np.array(arg, np.float32), 0, -1) for arg in args]
    types = tuple([param.type for param in function.params])
    (result,) = backend.run(Text(text), [Call("f", types, function.result, tuple(arrays))])
    return result


def guards_of(source: str) -> list[str]:
    """The operations of `f` that are not proven safe."""
    module = module_of(source)
    key = next(function.key for function in module.functions if function.name == "f")
    return [site.operation for site in analyse(module, [key], chained=False).sites if not site.proven]


MATRICES = {
    "mat2 f(mat2 m, float r) { for (int i = 0; i < 40; i++) { m = m * r; } return m; }": (2.0, 2.0 * 2.0**40),
    "mat2 f(mat2 m, float w) { for (int i = 0; i < 4; i++) { m = m / w; } return m; }": (2.0, 0.125),
    "mat2 f(mat2 m, float r) { for (int i = 0; i < 40; i++) { m += m * r; } return m; }": (1.0, 2.0 * 2.0**40),
    "mat2 f(mat2 m, float r) { m *= 1.0e20; m *= m * r; return m; }": (2.0, LARGEST),
    "mat2 f(mat2 m, float r) { return outerProduct(m[0] * 1.0e20, m[0] * 1.0e20 * r); }": (1.0, LARGEST),
    "mat2 f(mat2 m, float r) { return matrixCompMult(m * 1.0e20, m * 1.0e20 * r); }": (1.0, LARGEST),
    "mat2 f(mat2 m, float r) { return m / (m * r); }": (4.0, 0.25),
    "mat2 f(mat2 m, float r) { return r / m; }": (4.0, 2.0),
    "mat2 f(mat2 m, float r) { return (m * 1.0e20) * (m * 1.0e20 * r); }": (1.0, LARGEST),
    "mat2 f(mat2 m, float r) { return inverse(m * 1.0e25 * r); }": (1.0, None),
}
"""Source → r, and every number of the result where all numbers of m are 2 (None: any number)."""
HOSTILE = [0.0, 1e-40, -1e-30, 1e-3, -1.0, 3.0, 1000.0, -1000.0]


@pytest.mark.parametrize("source", MATRICES)
def test_guards_of_matrices_compile(source: str, assert_compiles: Callable[[Source], None]) -> None:
    module = module_of(source)
    for language in LANGUAGES:
        for text in sources(transpile(module, language, "case", guards="auto").files):
            assert_compiles(text)


@pytest.mark.parametrize("name", BACKENDS)
def test_guards_of_matrices_hold(name: str, backend: Callable[[str], Backend]) -> None:
    rng = np.random.default_rng(1)
    for source, (number, expected) in MATRICES.items():
        gpu = backend(name)
        got = results(gpu, source, [[[2.0, 2.0], [2.0, 2.0]]], [number])
        assert expected is None or np.allclose(got, expected, rtol=1e-5), (source, got)
        got = results(gpu, source, rng.choice(HOSTILE, (200, 2, 2)), rng.choice([*HOSTILE, 1e6, -1e6], 200))
        assert np.isfinite(got).all(), source


EXTREMES = [
    ("refract", "vec3", "refract(v * 1.0e4, w * 1.0e4, clamp(c, 0.0, 1.0e-20))"),
    ("inverse", "mat2", "inverse(mat2(v.x / c, v))"),
    ("inverse", "mat2", "inverse(inverse(mat2(v.x, v)))"),
    ("inverse", "mat4", "inverse(mat4(vec4(v, c), vec4(w, c), vec4(v, 1.0), vec4(c)) * 1.0e8)"),
    ("determinant", "float", "determinant(mat3(v, w, v.zxy) * 1.0e9)"),
    ("reflect", "vec3", "reflect(v * 1.9e32, normalize(w))"),
    ("cross", "vec3", "cross(v * 1.0e15, w * 1.0e15)"),
    ("dot", "float", "dot(v * 1.0e15, w * 1.0e15)"),
    ("dot", "float", "dot(vec2(v.x > 0.0 ? 2.0e19 : -2.0e19, 2.0e19), vec2(2.0e19)) * 1.0e-38"),
    ("*", "vec3", "vec3(1.0, 1.0, -1.0) * mat3(2.0e38 + c, 2.0e38, 2.0e38, v, w)"),
    ("length", "float", "length(v * 1.0e15) + distance(v * 1.0e15, w)"),
    ("mix", "float", "mix(v.x * 3.0e32, w.x * 3.0e32, clamp(c, 0.0, 1.0))"),
    ("fma", "float", "fma(clamp(v.x, 2.0e5, 3.0e5) * 1.0e15, 1.0e19, -clamp(w.x, 1.0e5, 2.0e5) * 1.0e33)"),
    ("mod", "float", "mod(v.x * 3.4e32, clamp(w.x, 1.0, 2.0) * 1.0e37)"),
    ("unpackHalf2x16", "vec2", "cubed(cubed(unpackHalf2x16(floatBitsToUint(v.x))))"),
    ("/", "float", "length(v * 1.0e-25) <= 0.0 ? 1.0 / (1.0e-20 - v.x * 1.0e-25) : 0.0"),
]
"""A builtin that a guard must mention (or else an overflow), and what `f(vec3 v, vec3 w, float c)` returns."""
CUBED = "vec2 cubed(vec2 x) { return x * x * x; }\n"


@pytest.mark.parametrize("name", BACKENDS)
def test_formulas_that_overflow_inside_are_guarded(name: str, backend: Callable[[str], Backend]) -> None:
    """Also where the result itself would be small, or no number at all."""
    rng = np.random.default_rng(2)
    sizes = [0.0, 1e-40, 1e-30, 1e-20, 1e-3, 0.5, 1.0, 1e3, 999999.0, 1e6]
    numbers = np.array([sign * size for size in sizes for sign in (1.0, -1.0)])
    for what, type_, value in EXTREMES:
        source = f"{CUBED}{type_} f(vec3 v, vec3 w, float c) {{ return {value}; }}"
        assert {what, "overflow"} & set(guards_of(source)), source
        v, w, c = (rng.choice(numbers, shape) for shape in ((300, 3), (300, 3), 300))
        v[:40], w[20:60] = 1e6, 1e6
        v[30:40] = [1e5 * at for at in (1, -1, 1e-25)]
        got = results(backend(name), source, v, w, c)
        assert np.isfinite(got).all(), (source, got[..., ~np.isfinite(got).reshape(-1, 300).all(axis=0)][..., :3])


@pytest.mark.parametrize("name", BACKENDS)
def test_a_guard_does_not_repeat_a_call_that_writes(name: str, backend: Callable[[str], Backend]) -> None:
    """The guard of atan(x, y) reads x too."""
    source = """
float next(inout float t) { t += 1.0; return t; }
float f(float t, float y) { float angle = atan(next(t), y) + pow(next(t), y) + mod(y, next(t)); return angle + t; }
"""
    got = results(backend(name), source, [0.0, 1.0], [1.0, -3.0])
    # atan(1, 1) + 2^1 + mod(1, 3) + 3, and atan(2, -3) + 3^-3 + mod(-3, 4) + 4
    assert np.allclose(got, [0.785398 + 2.0 + 1.0 + 3.0, 2.553590 + 0.037037 + 1.0 + 4.0], rtol=1e-3)


@pytest.mark.parametrize("name", BACKENDS)
def test_a_call_in_a_later_argument_may_write_an_earlier_one(name: str, backend: Callable[[str], Backend]) -> None:
    source = """
float scale(inout float x, float by) { x *= by; return by; }
float f(float y, float by) { float x = by; scale(x, scale(x, clamp(by, 1.0e20, 1.0e30))); return x; }
"""
    got = results(backend(name), source, [0.0, 1.0], [1.0, 3.0])
    assert np.isfinite(got).all() and (got >= 1e20).all(), got


def test_products_of_ordinary_size_have_no_guard() -> None:
    for type_, value in (
        ("mat3", "m * m * 0.5 + outerProduct(v, w) + transpose(m)"),
        ("vec3", "m * v + cross(v, w) + reflect(v, w) + refract(v * 1.0e-6, w * 1.0e-6, 0.7)"),
        ("float", "determinant(m) + dot(v, w) + length(v) + distance(v, w) + mix(v.x, w.x, v.y)"),
    ):
        assert guards_of(f"{type_} f(mat3 m, vec3 v, vec3 w) {{ return {value}; }}") == [], value


@pytest.mark.parametrize(
    ("call", "reason"),
    [
        ("clamp(0.5, 1.0, 0.0)", "clamp(0.5, 1.0, 0.0) has no value: the lower bound above the upper one"),
        ("float(clamp(7, 3, -1))", "clamp(7, 3, -1) has no value: the lower bound above the upper one"),
        ("clamp(vec2(0.5), vec2(0.0, 2.0), vec2(1.0)).x",
         "clamp(0.5, 2.0, 1.0) has no value: the lower bound above the upper one"),
        ("smoothstep(1.0, 0.5, 0.7)", "smoothstep(1.0, 0.5, 0.7) has no value: edges in the wrong order, or equal"),
        ("pow(-2.0, -2.0)", "pow(-2.0, -2.0) has no value: a power of less than 0, or one of 0 near the power 0"),
        ("pow(10.0, 100.0)", "pow(10.0, 100.0) has no value: a power that overflows"),
        ("mod(1.0, 0.0)", "mod(1.0, 0.0) has no value: a remainder of division by 0"),
        ("atan(0.0, 0.0)", "atan(0.0, 0.0) has no value: the angle of (0, 0)"),
        ("log(0.0)", "log(0.0) has no value: the logarithm of 0 or less"),
        ("acos(1.5)", "acos(1.5) has no value: an arc cosine of a number outside of -1..1"),
        ("normalize(vec2(0.0)).x", "normalize((0.0, 0.0)) has no value: the direction of a zero vector"),
        ("dot(vec2(1.0e30), vec2(1.0e30))",
         "the value of dot((1e+30, 1e+30), (1e+30, 1e+30)) is too large for a float"),
        ("float(bitfieldExtract(1, 30, 8))",
         "bitfieldExtract(1, 30, 8) has no value: it needs y >= 0, z >= 0, and y + z <= 32"),
    ],
)  # fmt: skip
def test_constants_without_a_value_are_reported_with_the_reason(call: str, reason: str) -> None:
    with pytest.raises(SssgenError) as error:
        transpile(module_of(f"float f(float x) {{\n    return x + {call};\n}}"), "glsl-330", "case")
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.message == reason
    assert diagnostic.span.line == 2
