"""Names that the compiler invents never capture those of the author, and the author may use every one of them.

The invented names are those in the emitted texts of CONSTRUCTS that CONSTRUCTS does not contain.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from plain_calls import BACKENDS, Array, called, module_of
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.out_builtins import OUT_BUILTINS
from sssgen.ir.verify import verify
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Backend, get
from sssgen.support.diagnostics import SssgenError

X = np.array([-3.0, -1.5, 0.25, 1.0, 2.5, 4.0, 5.75, 7.0])
N = np.array([0, 1, 2, 3, 4, 5, 6, 7], np.int32)

CONSTRUCTS = """
DECLARATIONS
struct Ray { vec3 from; float reach; };
float total = 0.0;
float step_up(inout float a) { a += 1.0; total += a; return a * 2.0; }
void part(inout float a, inout float b) { a += 2.0; b = b * 3.0 + a; }
float one(float, float y) { return y; }
float early(float x, int n) {
    for (int i = 0; i < 9; i++) {
        if (i == n) { return x + float(i); }
        if (x > 2.0) { continue; }
        x += 0.5;
    }
    return x;
}
float body(float x, int nPARAMS) {
BEFORE
    int k = n++;
    float r = k > 2 ? (x += 1.0) : (x -= 1.0);
    switch (n & 3) {
        case 0: r += 1.0; break;
        case 1: switch (k & 3) { case 2: break; default: if (x > 0.0) { break; } r += 7.0; }
        case 2: if (r > 2.0) { break; } r += 3.0;
    }
    for (int i = 0, j = 4; i < 3; i++, r += 0.5, j--) {
        switch (j) { case 3: continue; case 2: if (r > 9.0) { break; } r += x; }
        if (i == k) { continue; }
        r += float(j);
    }
    do { r += 0.25; } while (k++ < 3);
    bool b = k++ > 3 && n++ > 2 || x > 0.0 && step_up(x) > 3.0 || step_up(r) > 2.0;
    float list[3];
    list[0] = x; list[1] = r; list[2] = 1.0;
    int i = n & 1;
    list[i++] = float(i);
    part(list[i], list[n & 1]);
    vec3 v = vec3(x, r, 2.0);
    v.zx = v.xy + (v.y += 1.0);
    v[n % 3] += 1.0;
    Ray ray = b ? Ray(v, 1.0) : Ray(v.zyx, r);
    part(ray.reach, ray.from.x);
    mat2 m = mat2(x, r, 1.0, 2.0);
    m[n & 1] *= 0.5;
    float whole;
    r += modf(x * 0.75, whole) + whole + (x + step_up(x) * x) + max(r++, 2.0) + one(1.0, x) + early(x, k);
    step_up(total);
    r += total * 0.125 + dot(ray.from, v) + ray.reach + (m * v.xy).x + list[0] + list[1] * 2.0
        + float(-7 / n) + (b ? 1.0 : 0.0);
AFTER
    return r;
}
float f(float x, int n) { total = 0.5; return body(x, nARGUMENTS); }
"""
PLACES = ("DECLARATIONS", "PARAMS", "BEFORE", "AFTER", "ARGUMENTS")

USUAL = {"selected", "chosen", "both", "once", "goes_on", "k_before", "before", "place", "mask", "running", "x_in"}

Role = Callable[[str, int], dict[str, str]]
ROLES: dict[str, Role] = {
    "const": lambda name, value: {"DECLARATIONS": f"const float {name} = {value}.0;"},
    "macro": lambda name, value: {"DECLARATIONS": f"#define {name} {value}.0"},
    "module variable": lambda name, value: {"DECLARATIONS": f"float {name} = {value}.0;"},
    "uniform": lambda name, value: {"DECLARATIONS": f"uniform float {name};"},
    "local before": lambda name, value: {"BEFORE": f"    float {name} = {value}.0;"},
    "local after": lambda name, value: {"AFTER": f"    float {name} = {value}.0;"},
    "inner local": lambda name, value: {
        "BEFORE": f"    float {name} = {value}.0; {{ float {name} = 1.0; x += {name} - 1.0; }}"
    },
    "parameter": lambda name, value: {"PARAMS": f", float {name}", "ARGUMENTS": f", {value}.0"},
    "function": lambda name, value: {"DECLARATIONS": f"float {name}() {{ return {value}.0; }}"},
    "struct": lambda name, value: {"DECLARATIONS": f"struct {name} {{ float m; }};"},
    "member": lambda name, value: {
        "DECLARATIONS": f"struct Of_{name} {{ float {name}; }};",
        "BEFORE": f"    Of_{name} of_{name} = Of_{name}({value}.0);",
    },
}  # fmt: skip
USES = {"function": "{0}()", "struct": "{0}({1}.0).m", "member": "of_{0}.{0}"}


def program(role: str, names: tuple[str, ...]) -> str:
    """CONSTRUCTS with declarations of these names; the values 1, 2, … of the names are added to its result."""
    parts = dict.fromkeys(PLACES, "")
    for value, name in enumerate(names, 1):
        for place, text in ROLES[role](name, value).items():
            parts[place] += text if place in ("PARAMS", "ARGUMENTS") else f"{text}\n"
    uses = [USES.get(role, "{0}").format(name, value) for value, name in enumerate(names, 1)]
    parts["AFTER"] += "\n".join([f"    r += {use};" for use in uses])
    return re.sub("|".join(PLACES), lambda match: parts[match.group()], CONSTRUCTS)


def texts(source: str) -> str:
    module = module_of(source)
    targets = ("numpy", "glsl-330", "glsl-es-300", "hlsl", "unity-builtin", "wgsl")
    files = [transpile(module, target, "case", "none", keep=True).files for target in targets]
    return "\n".join([text for each in files for name, text in each.items() if not name.endswith(".json")])


def identifiers(text: str) -> set[str]:
    return set(re.findall(r"(?<![\w.])[a-zA-Z]\w*", re.sub(r'//.*|#.*|"""[^"]*"""', "", text)))


@cache
def invented() -> tuple[str, ...]:
    """The names that the compiler invents, also where the author has those that it would take first."""
    names: set[str] = set()
    own = set(re.findall(r"\w+", CONSTRUCTS))
    for _ in range(2):
        source = program("local before", tuple(sorted(names)))
        names |= {name for name in identifiers(texts(source)) - own if may_be_declared(name)}
    return tuple(sorted(names))


def may_be_declared(name: str) -> bool:
    """Whether GLSL allows this name for everything."""
    if "__" in name or name in BUILTINS or name in OUT_BUILTINS:
        return False
    try:
        module_of(f"struct {name} {{ float {name}; }}; float f(float x) {{ return {name}(x).{name}; }}")
    except SssgenError:
        return False
    return True


def test_the_list_of_names_is_not_empty() -> None:
    assert USUAL | {"selected_2", "chosen_2"} <= set(invented())
    assert not {"f", "x", "step_up"} & set(invented())


@pytest.mark.parametrize("role", ROLES)
def test_the_checked_module_is_valid(role: str) -> None:
    assert verify(module_of(program(role, invented()))) == []


@pytest.mark.parametrize("name", BACKENDS)
@pytest.mark.parametrize("role", ROLES)
def test_the_author_may_use_every_name(role: str, name: str, backend: Callable[[str], Backend]) -> None:
    names = invented()
    values = [np.full(len(X), float(value)) for value in range(1, len(names) + 1)]
    result = called(program(role, names), backend(name), X, N, *(values if role == "uniform" else ()))
    np.testing.assert_allclose(result, expected() + np.sum(values, axis=0), rtol=1e-4)


SNIPPETS: dict[str, tuple[str, Callable[[float, int], float]]] = {
    "a constant that a switch would hide": (
        "const float selected = 10.0;\nfloat f(float x, int n) {\n"
        "    switch (n & 3) { case 0: x += 1.0; break; case 1: x += 2.0; }\n    return x + selected;\n}",
        lambda x, n: x + {0: 1.0, 1: 2.0}.get(n & 3, 0.0) + 10.0,
    ),
    "a constant that a choice would hide": (
        "const float chosen = 5.0;\nfloat f(float x, int n) { float y = n > 2 ? (x += 1.0) : x; return y + chosen; }",
        lambda x, n: x + (n > 2) + 5.0,
    ),
    "a uniform that a step would hide": (
        "uniform float n_before;\nfloat f(float x, int n) { int k = n++; return x + float(k + n) + n_before; }",
        lambda x, n: x + n + n + 1 + 100.0,
    ),
    "a variable that is declared after a choice": (
        "float f(float x, int n) { float y = n > 2 ? (x += 1.0) : x; float chosen = 2.0; return y + chosen; }",
        lambda x, n: x + (n > 2) + 2.0,
    ),
    "a variable that is declared after a switch": (
        "float f(float x, int n) { switch (n & 3) { case 0: x += 1.0; break; case 1: x += 2.0; }\n"
        "int selected = 5; return x + float(selected); }",
        lambda x, n: x + {0: 1.0, 1: 2.0}.get(n & 3, 0.0) + 5.0,
    ),
    "a variable of the body of a do": (
        "float f(float x, int n) { do { int n_before = 3; x += float(n_before); continue; }\n"
        "while (n++ < 3); return x; }",
        lambda x, n: x + 3.0 * max(4 - n, 1),
    ),
    "a variable of a case": (
        "float f(float x, int n) { switch (n & 1) { case 1: { int selected = n; x += float(selected); }\n"
        "switch (n & 3) { case 1: x += 1.0; } break; default: x += 9.0; } return x; }",
        lambda x, n: x + (n + ((n & 3) == 1) if n & 1 else 9.0),
    ),
    "a parameter that looks like one without a name": (
        "const float unnamed_1 = 3.0;\nfloat h(float, float unnamed_2, int) { return unnamed_1 * unnamed_2; }\n"
        "float f(float x, int n) { return h(1.0, x, n); }",
        lambda x, n: 3.0 * x,
    ),
    "a function with the name of a member of a block": (
        "uniform Block { float color; } lamp;\nfloat lamp_color(float x) { return x * 2.0; }\n"
        "float f(float x, int n) { return lamp_color(x) + lamp.color; }",
        lambda x, n: 2.0 * x + 100.0,
    ),
    "structs of two functions": (
        "float g(float x) { struct S { float b; }; S s = S(x); return s.b; }\n"
        "float f(float x, int n) { struct S { float a; float c; }; S s = S(x, g(x) * 2.0); return s.a + s.c; }",
        lambda x, n: 3.0 * x,
    ),
    "a struct that hides another": (
        "struct S { float q; };\nfloat g(float x) { S s; s.q = x; return s.q; }\n"
        "float f(float x, int n) { S o = S(x);\n"
        "{ struct S { float a; float b; }; S s = S(x, 1.0); o.q += s.a * s.b; } S p = S(g(x)); return o.q + p.q; }",
        lambda x, n: 3.0 * x,
    ),
    "a constant and a function with the names of structs": (
        "float S(float x) { return x * 2.0; }\nfloat g(float x) { struct S { float b; }; struct T { S s; };\n"
        "T t = T(S(x)); return t.s.b; }\nconst float T = 4.0;\nfloat f(float x, int n) { return g(x) + S(x) + T; }",
        lambda x, n: 3.0 * x + 4.0,
    ),
    "a function that a builtin with out parameters would call": (
        "float trunc(float x) { return 7.0; }\nfloat f(float x, int n) { float w; return modf(x, w) + w + trunc(x); }",
        lambda x, n: x + 7.0,
    ),
}


@pytest.mark.parametrize("name", BACKENDS)
@pytest.mark.parametrize("title", SNIPPETS)
def test_names_of_the_author_keep_their_meaning(title: str, name: str, backend: Callable[[str], Backend]) -> None:
    text, right = SNIPPETS[title]
    values = [np.full(len(X), 100.0)] if "uniform" in text else []
    wanted = [right(float(x), int(n)) for x, n in zip(X, N, strict=True)]
    np.testing.assert_allclose(called(text, backend(name), X, N, *values), wanted, rtol=1e-6)


@cache
def expected() -> Array:
    """The result of CONSTRUCTS alone."""
    return called(program("const", ()), get("numpy"), X, N)
