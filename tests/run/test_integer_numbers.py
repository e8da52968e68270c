"""Plain GLSL whose numbers depend on 32-bit integers, conversions to bool, places and scopes, on every back end.

Each case is a text with a function `f`, its argument, and the result that GLSL's specification gives.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from slow_cases import back_end_cases
from sssgen.ir.types import components, kind_of
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.backend_registry import BACKENDS, SINGLE
from sssgen.run.backends import Backend, Call, Text
from sssgen.support.diagnostics import SssgenError
from whole_shaders import compile_errors

LOWEST, HIGHEST, MOST = -(2**31), 2**31 - 1, 2**32 - 1
DTYPES = {"float": np.float32, "int": np.int32, "uint": np.uint32, "bool": np.bool_}

WRAPPED = [
    ("int f(int x) { return (2147483647 + 1) / 2 + x; }", 5, -1073741819),
    ("int f(int x) { return (65536 * 65536 * 3 >> 4) + x; }", 5, 5),
    ("int f(int x) { return ((1 << 31) >> 31) + x; }", 5, 4),
    ("float f(float x) { return x * float(1 << 31); }", 2.0, -(2.0**32)),
    ("int f(int x) { return x & (1 << 31); }", -5, LOWEST),
    ("int f(int x) { return x + (-2147483647 - 1) / -1; }", 1, LOWEST + 1),  # Mesa's compiler dies at it
    ("const int K = -2147483648; int f(int x) { return x + (K + 0) % -1; }", 3, 3),
    ("uint f(uint x) { return x & uint(~0); }", 77, 77),
    ("uint f(uint x) { return x | (3u << 31); }", 5, 2**31 + 5),
    ("int f(int x) { return mix(5, 0, false) + x; }", 2, 7),
    ("int f(int x) { return bitfieldExtract(clamp(2, -5, 9), 0, 8) + x; }", 0, 2),
    ("uint f(uint x) { return (x | bitfieldExtract(x, -1, 1)) & x; }", 6, 6),
    ("const int K = 1 << 31; int f(int x) { return K / 2 + x; }", 1, -(2**30) + 1),
    ("const int K = 2147483647; int f(int x) { return (K + 1) / 2 + x; }", 0, -(2**30)),
    ("const uint K = 4294967295u; uint f(uint x) { return (K + 1u) / 2u + x; }", 5, 5),
    ("int f(int x) { return -2147483648 + x; }", 5, LOWEST + 5),
    ("int f(int x) { return -(-2147483648) + x; }", 5, LOWEST + 5),
    ("int f(int x) { return 3000000000 + 037777777777 + x; }", 5, 3000000000 - 2**32 + 4),
    ("int f(int x) { return int(0x80000000u) / 2 + x; }", 0, -(2**30)),
    ("int f(int x) { return int(0xffffffffu) + x; }", 5, 4),
    ("int f(int x) { return (2147483647 + int(true)) / 2 + x; }", 0, -(2**30)),
    ("int f(int x) { return ((true ? 2147483647 : 1) + 1) / 2 + x; }", 0, -(2**30)),
    ("int f(int x) { return (ivec2(2147483647, 1).x + 1) / 2 + x; }", 0, -(2**30)),
    ("int f(int x) { return abs(-2147483648) / 2 + x; }", 0, -(2**30)),
    ("uint f(uint x) { return uint(-1) + x; }", 3, 2),
    ("uint f(uint x) { return -5u / 2u + x; }", 0, (2**32 - 5) // 2),
    ("uint f(uint x) { return (2u - 5u) / 2u + x; }", 0, (2**32 - 3) // 2),
    ("int f(int x) { x += 2147483647 + 2; x *= 65536 * 65536 + 3; return x; }", 1, -(2**31 - 2) * 3 % 2**32 - 2**32),
    ("int f(int x) { return 2147483647 + 1 < x ? 1 : 0; }", 0, 1),
    ("const int A[2] = int[2](7, -2147483648); int f(int x) { return -A[1] / 2 + x; }", 0, -(2**30)),
    ("struct S { int a; ivec2 b; }; const S s = S(2147483647, ivec2(2, 3));"
     "int f(int x) { return (s.a + s.b.y) / 2 + x; }", 0, -(2**30) + 1),
    ("int f(int x) { switch (x) { case (1 << 31) >> 31: return 5; } return 7; }", -1, 5),
]  # fmt: skip
OVERLOADS = "int g(int a) { return 1; } int g(uint a) { return 2; } int g(float a) { return 3; }"
TYPES = [
    (f"{OVERLOADS} int f(int x) {{ return g(-5) * 100 + g(2 + 3) * 10 + g(x > 0 ? 5 : 3); }}", 1, 111),
    ("float f(int x) { return float(uint(x > 0 ? 2 : -2147483647)); }", 0, 2.0**31),
    ("vec2 f(int x) { return vec2(uvec2(x > 0 ? 2 : -2147483647, 5) / 2u); }", 0, (2.0**30, 2.0)),
    ("uint f(uint x) { return -(x / 7u); }", 70, 2**32 - 10),
    ("const uint M = 0xaaaaaaaau; uint f(uint x) { return clamp(7u, 0u, M) + M + x; }", 0xAAAAAAAA, 0x5555555B),
    (f"{OVERLOADS} int f(int x) {{ return g(5u) * 100 + g(2.0) * 10 + g(x > 0 ? 1.0 : 2.0); }}", 1, 233),
    ("float f(float x) { return mix(3.0, 4.0, true) + float(mix(3u, 4u, true)) + float(mix(true, false, true)); }",
     0.0, 8.0),
]  # fmt: skip
BOOLS = [
    ("int f(int x) { return int(bool(uint(x))); }", 5, 1),
    ("int f(float x) { return int(bool(int(x))); }", 7.5, 1),
    ("int f(float x) { return int(bool(int(x))); }", 0.5, 0),
    ("float f(int x) { return float(bool(x)); }", -7, 1.0),
    ("uint f(int x) { return uint(bool(uint(x))); }", -7, 1),
    ("uint f(uint x) { return uint(bool(int(x))); }", 6, 1),
    ("int f(uint x) { bool b = bool(int(uint(x))); return int(b); }", 6, 1),
    ("int f(uint x) { return int(bool(bitCount(x))); }", 7, 1),
    ("ivec2 f(int x) { return ivec2(bvec2(uvec2(ivec2(x, 0)))); }", 5, (1, 0)),
    ("uvec3 f(float x) { return uvec3(bvec3(ivec3(x, 0.5, 2.0))); }", 5.0, (1, 0, 1)),
    ("ivec2 f(int x) { return ivec2(bvec2(uint(x), float(x))); }", 5, (1, 1)),
]
VECTOR = "vec3 v = vec3(1.0, 2.0, 3.0) * x;"
PLACES = [
    (f"vec3 f(float x) {{ {VECTOR} v.zyx[1] = 7.0; return v; }}", 1.0, (1, 7, 3)),
    (f"vec3 f(float x) {{ {VECTOR} v.zyx[0] *= 7.0; v.zyx.xy[1] += 1.0; return v; }}", 1.0, (1, 3, 21)),
    (f"vec3 f(float x) {{ {VECTOR} int i = int(x) + 1; v.zyx[i] += 7.0; return v; }}", 1.0, (8, 2, 3)),
    (f"vec3 f(float x) {{ {VECTOR} int i = int(x); v.zyx.zx[i] = 7.0; return v; }}", 1.0, (1, 2, 7)),
    (f"vec3 f(float x) {{ {VECTOR} mat3 m = mat3(v, v, v); m[1].zyx[0] = 7.0; return m[0] + m[1]; }}", 1.0, (2, 4, 10)),
    (f"vec3 f(float x) {{ {VECTOR} v.zyx[1]++; --v.xzy.yx[0]; return v; }}", 1.0, (1, 3, 2)),
    (f"struct S {{ vec3 a; }}; vec3 f(float x) {{ {VECTOR} S s = S(v); s.a.zyx[0] = 7.0; return s.a; }}",
     1.0, (1, 2, 7)),
    (f"void g(inout float y) {{ y += 7.0; }} vec3 f(float x) {{ {VECTOR} g(v.zyx[0]); return v; }}", 1.0, (1, 2, 10)),
    ("void g(inout float y) { y += 7.0; }"
     f"vec3 f(float x) {{ {VECTOR} int i = int(x) + 1; g(v.zyx[i]); g(v[i]); return v; }}", 1.0, (8, 2, 10)),
    (f"void g(inout vec2 y) {{ y += 7.0; }} vec3 f(float x) {{ {VECTOR} g(v.zyx.xy); return v; }}", 1.0, (1, 9, 10)),
]  # fmt: skip
LOOP = "for (int i = 0; i < 3; i++) s += i * x;"
SCOPES = [
    (f"int f(int x) {{ int s = 0; {LOOP} int i = 2; return s + i; }}", 5, 17),
    (f"int f(int x) {{ int s = 0; {LOOP} {LOOP} float i = 2.0; return s + int(i); }}", 5, 32),
    (f"int f(int x) {{ int s = 0; {LOOP} {{ int i = 5; s += i; }} {LOOP} {{ int i = 6; s += i; }} return s; }}", 5, 41),
    (f"const int i = 9; int f(int x) {{ int s = 0; {LOOP} return s + i; }}", 5, 24),
    (f"int f(int x) {{ int s = 0; {LOOP} int i_2 = 3; int i = 2; return s + i * i_2; }}", 5, 21),
    (f"int f(int x) {{ int s = 0; for (int k = 0; k < 2; k++) {LOOP} int k = 2, i = 1; return s + i + k; }}", 5, 33),
]
CASES = WRAPPED + TYPES + BOOLS + PLACES + SCOPES


@pytest.mark.parametrize("name", back_end_cases(SINGLE))
def test_numbers(name: str, backend: Callable[[str], Backend]) -> None:
    """All cases of a back end in one test, which costs a start of the driver."""
    machine = backend(name)
    failures = []
    for text, argument, expected in CASES:
        module = load_glsl_text(text, "case.glsl").module
        function = module.functions[-1]
        kind = kind_of(function.params[0].type)
        call = Call("f", (function.params[0].type,), function.result, (np.full(4, argument, DTYPES[kind]),))
        try:
            files = transpile(module, BACKENDS[name].target, "case", "none", keep=True).files
            emitted = next(content for file, content in files.items() if not file.endswith(".json"))
            (result,) = machine.run(Text(emitted), [call])
        except SssgenError as error:
            failures.append(f"{text}\n{error}")
            continue
        size = components(function.result)
        actual = np.broadcast_to(result, (size, 4) if size > 1 else (4,))[..., 0]
        if not np.array_equal(actual, np.array(expected)):
            failures.append(f"{text}\n{actual}, not {expected}")
    assert not failures, "\n\n".join([f"{len(failures)} of {len(CASES)}", *failures])


KEPT = [
    ("int f(int x) { return 2 * 3 + (7 >> 1) + x; }", "2 * 3 + (7 >> 1"),
    ("uint f(uint x) { return x ^ ~0u; }", "~0u"),
    ("uint f(uint x) { return x * (2654435761u * 3u); }", "0x9e3779b1u * 3u"),
    ("const int K = 1 << 4; int f(int x) { return K * 2 + x; }", "K * 2"),
]


@pytest.mark.parametrize(("text", "part"), KEPT)
@pytest.mark.parametrize("target", ["wgsl", "hlsl"])
def test_constants_that_agree_keep_their_text(text: str, part: str, target: str) -> None:
    files = transpile(load_glsl_text(text, "case.glsl").module, target, "case", "none", keep=True).files
    assert part in "\n".join(files.values())


UNDEFINED = [
    ("const float k = -1.0; uint f(uint x) { return uint(k) + x; }", "this constant does not fit in a uint"),
    ("int f(int x) { return int(3e5 * 3e5) + x; }", "this constant does not fit in an int"),
    ("int f(int x) { return x / (2 - 2); }", "by the constant 0 is undefined"),
    (
        "const int K = 32; int f(int x) { return x << K; }",
        "a shift by as many bits as there are, or more",
    ),
]


@pytest.mark.parametrize(("text", "message"), UNDEFINED)
def test_constants_without_a_value(text: str, message: str) -> None:
    """They are errors where a language refuses them, except in WGSL, where the device computes them."""
    module = load_glsl_text(text, "case.glsl").module
    with pytest.raises(SssgenError, match=message):
        transpile(module, "tsl", "case", "none", keep=True)
    compiled = transpile(module, "wgsl", "case", "none", keep=True)
    assert [message in warning.message for warning in compiled.warnings] == [True]
    assert compile_errors(next(iter(compiled.files.values())), "wgsl", "library") == []
    assert not transpile(module, "hlsl", "case", "none", keep=True).warnings
