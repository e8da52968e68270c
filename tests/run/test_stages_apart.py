"""Vertex and fragment shaders that are translated apart, drawn together on every device."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest

from sssgen.ir.nodes import NOWHERE, Variable
from sssgen.ir.types import VEC2
from sssgen.passes.stage.stage_interface import Slot
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Backend
from sssgen.support.diagnostics import SssgenError
from sssgen.targets.printers.hlsl_entry import semantic
from stage_drawing import BACKENDS, CORNER, draw_stages, module_of

NEW, OLD = "#version 330\n", "#version 120\n"


def vertex(declarations: str, body: str, version: str = NEW) -> str:
    return f"{version}{declarations}{CORNER}void main() {{ place(); {body} }}\n"


def fragment(declarations: str, color: str) -> str:
    return f"{NEW}{declarations}\nout vec4 color;\nvoid main() {{ color = {color}; }}\n"


EQUAL = {
    "the order of the declarations differs": (
        vertex("out vec3 normal; out vec3 tint;", "normal = vec3(1.0, 2.0, 3.0); tint = vec3(4.0, 5.0, 6.0);"),
        fragment("in vec3 tint; in vec3 normal;", "vec4(tint.x, tint.y, normal.x, normal.z)"),
        (4.0, 5.0, 1.0, 3.0),
    ),
    "all types": (
        vertex(
            "out float f; out vec2 v[2]; out mat3 m; flat out int i; flat out uvec2 u; out vec4 a; flat out ivec3 w;",
            "f = 1.0; v[0] = vec2(2.0); v[1] = vec2(3.0, 4.0);"
            " m = mat3(5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0);"
            " i = -14; u = uvec2(15u, 16u); a = vec4(17.0); w = ivec3(18, 19, 20);",
        ),
        fragment(
            "flat in ivec3 w; in vec4 a; in mat3 m; flat in uvec2 u; in vec2 v[2]; flat in int i; in float f;",
            "vec4(f + v[1].y * 10.0, m[1].z * 10.0 + m[2].x, float(i) + float(u.y) * 100.0, a.w + float(w.y) * 100.0)",
        ),
        (41.0, 111.0, 1586.0, 1917.0),
    ),
    "some have a location": (
        vertex(
            "out vec2 z; layout(location = 1) out vec2 first; out vec2 b; layout(location = 0) out vec2 last;",
            "z = vec2(1.0); first = vec2(2.0); b = vec2(3.0); last = vec2(4.0);",
        ),
        fragment(
            "in vec2 b; in vec2 z; layout(location = 0) in vec2 last; layout(location = 1) in vec2 first;",
            "vec4(z.x, first.x, b.x, last.x)",
        ),
        (1.0, 2.0, 3.0, 4.0),
    ),
    "blocks with other instance names": (
        vertex(
            "out Lit { vec3 normal; vec2 uv; } vs_out; out Shade { vec2 uv; };",
            "vs_out.normal = vec3(1.0); vs_out.uv = vec2(2.0); uv = vec2(3.0);",
        ),
        fragment("in Shade { vec2 uv; } b; in Lit { vec3 normal; vec2 uv; };", "vec4(normal.x, uv.x, b.uv.x, 0.0)"),
        (1.0, 2.0, 3.0, 0.0),
    ),
    "names that differ in case, digits and underscores": (
        vertex(
            "out float tint; out float Tint; out float tint2; out float tint_2; out float t[2]; out float t1;"
            " out float sv_x; out float texcoord; out float t_;",
            "tint = 1.0; Tint = 2.0; tint2 = 3.0; tint_2 = 4.0; t[0] = 5.0; t[1] = 6.0; t1 = 7.0; sv_x = 8.0;"
            " texcoord = 9.0; t_ = 10.0;",
        ),
        fragment(
            "in float t1, t[2], sv_x, tint2, tint_2, Tint, tint, texcoord, t_;",
            "vec4(tint * 10.0 + Tint, tint2 * 10.0 + tint_2, t[0] * 100.0 + t[1] * 10.0 + t1,"
            " sv_x * 100.0 + texcoord + t_)",
        ),
        (12.0, 34.0, 567.0, 819.0),
    ),
    "reserved names": (
        vertex("out float half; out float half_; out float input;", "half = 1.0; half_ = 2.0; input = 3.0;"),
        fragment("in float input; in float half_; in float half;", "vec4(half, half_, input, 0.0)"),
        (1.0, 2.0, 3.0, 0.0),
    ),
    "structs": (
        vertex(
            "struct Lit { vec3 color; float weight; }; out Lit lit; flat out struct { int a; ivec2 b; } cell;",
            "lit = Lit(vec3(1.0, 2.0, 3.0), 4.0); cell.a = 5; cell.b = ivec2(6, 7);",
        ),
        fragment(
            "struct Lit { vec3 color; float weight; }; flat in struct { int a; ivec2 b; } cell; in Lit lit;",
            "vec4(lit.color.z, lit.weight, cell.a, cell.b.y)",
        ),
        (3.0, 4.0, 5.0, 7.0),
    ),
    "structs and arrays in structs": (
        vertex(
            "struct Lit { vec3 color; float weights[2]; }; struct Seen { Lit lits[2]; mat2 turn; }; out Seen seen;"
            " out Lit pair[2]; out vec2 seen_turn;",
            "for (int i = 0; i < 2; i++) { seen.lits[i] = Lit(vec3(float(i)), float[2](2.0, 3.0));"
            " pair[i].color = vec3(4.0); pair[i].weights = float[2](5.0, 6.0); }"
            " seen.turn = mat2(7.0); seen_turn = vec2(8.0); if (gl_VertexID >= 0) return; seen.turn = mat2(9.0);",
        ),
        fragment(
            "struct Lit { vec3 color; float weights[2]; }; struct Seen { Lit lits[2]; mat2 turn; }; in Seen seen;"
            " in Lit pair[2]; in vec2 seen_turn; float sum(Lit lit) { return lit.color.x + lit.weights[1]; }",
            "vec4(sum(seen.lits[1]), sum(pair[1]), seen.turn[1][1], seen_turn.x)",
        ),
        (4.0, 10.0, 7.0, 8.0),
    ),
    "varying": (
        vertex("varying vec2 b; varying vec2 a;", "a = vec2(1.0); b = vec2(2.0);", OLD),
        fragment("in vec2 a; in vec2 b;", "vec4(a, b)"),
        (1.0, 1.0, 2.0, 2.0),
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", EQUAL)
@pytest.mark.parametrize("together", [False, True])
def test_equal_declarations(case: str, together: bool, backend: Callable[[str], Backend]) -> None:
    before, after, expected = EQUAL[case]
    for name in BACKENDS:
        color = draw_stages(before, after, backend(name), together)
        np.testing.assert_allclose(color, expected, atol=1e-4, err_msg=name)


SUBSETS = {
    "the last one": (
        vertex("out vec3 a; out mat2 b; out vec3 c; flat out int d;",
               "a = vec3(1.0); b = mat2(2.0); c = vec3(3.0, 4.0, 5.0); d = 6;"),
        fragment("in vec3 c; in float unread;", "vec4(c, 1.0)"), (3.0, 4.0, 5.0, 1.0),
    ),
    "a member of a block": (
        vertex("out B { vec3 a; vec3 b; } o; out vec3 A;", "o.a = vec3(1.0); o.b = vec3(2.0); A = vec3(3.0);"),
        fragment("in B { vec3 a; vec3 b; } i;", "vec4(i.b, i.a.x)"), (2.0, 2.0, 2.0, 1.0),
    ),
    "the fragment shader decides on the interpolation": (
        vertex("out float a; out float b;", "a = 7.0; b = float(gl_VertexID);"),
        fragment("flat in float a; noperspective in float b;", "vec4(a, b > 0.0 ? 1.0 : 0.0, 0.0, 0.0)"),
        (7.0, 1.0, 0.0, 0.0),
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", SUBSETS)
def test_subsets_with_the_other_stage(case: str, backend: Callable[[str], Backend]) -> None:
    before, after, expected = SUBSETS[case]
    for name in ("gl", "hlsl", "webgpu"):
        color = draw_stages(before, after, backend(name), together=True)
        np.testing.assert_allclose(color, expected, atol=1e-4, err_msg=name)


def test_locations_under_other_names(backend: Callable[[str], Backend]) -> None:
    """GLSL ES 3.00 has no locations there, which is reported."""
    before = vertex(
        "layout(location = 3) out vec2 a; layout(location = 5) out vec2 b;", "a = vec2(1.0); b = vec2(2.0);"
    )
    after = fragment("layout(location = 5) in vec2 a; layout(location = 3) in vec2 c;", "vec4(a, c)")
    for name in ("gl", "hlsl", "webgpu"):
        np.testing.assert_allclose(draw_stages(before, after, backend(name)), (2.0, 2.0, 1.0, 1.0), err_msg=name)
    warnings = transpile(module_of(after, "a.frag"), "glsl-es-300", "a", keep=True).warnings
    assert [warning.message.partition(",")[0] for warning in warnings] == ["'a' has a location", "'c' has a location"]


@pytest.mark.parametrize(
    ("inputs", "message"),
    [
        ("in vec3 a, d;", "the vertex shader a.vert does not write 'd', which the fragment shader reads"),
        ("in vec2 a; in vec3 d;", r"writes 'a' as a vec3 \(a.vert:2:10\), but the fragment shader reads a vec2"),
        ("layout(location = 0) in vec3 a; in vec3 d;", "does not write 'a'"),
    ],
)
def test_stages_that_do_not_fit(inputs: str, message: str) -> None:
    before, after = vertex("out vec3 a, b;", "a = vec3(1.0); b = a;"), fragment(inputs, "vec4(a.xyx, d.x)")
    stages = module_of(before, "a.vert"), module_of(after, "a.frag")
    for module, partner in (stages, stages[::-1]):
        with pytest.raises(SssgenError, match=message):
            transpile(module, "wgsl", "a", keep=True, partner=partner)
    with pytest.raises(SssgenError, match="not two stages of one program"):
        transpile(stages[0], "wgsl", "a", keep=True, partner=stages[0])


def test_a_fragment_shader_alone_is_warned_of_where_locations_decide() -> None:
    after = module_of(fragment("in vec3 b, a;", "vec4(a, b.x)"), "a.frag")
    (warning,) = transpile(after, "wgsl", "a", keep=True).warnings
    assert warning.message.startswith("the inputs 'a', 'b' are numbered by name")
    assert not [
        *transpile(after, "hlsl", "a", keep=True).warnings,
        *transpile(after, "glsl-330", "a", keep=True).warnings,
    ]


def test_semantics_of_names_differ() -> None:
    """Of variables and of elements: a semantic ignores case, and digits at its end are its index."""
    names = "a A _a a_ aB a_b a_B A_b ab a1 a_1 a1_ sv_x Sv_x SV_x texcoord Texcoord texcoord0 v_uv vUv v_Uv V_UV"
    found = {("TEXCOORD", 0)}
    for name in names.split():
        variable = Variable(name, VEC2, "in", None, "", "", -1, "", NOWHERE)
        slots = [Slot(variable, path, VEC2, 0, name, part) for path, part in (((), 0), ((0,), 0), ((1,), 1))]
        places = [semantic(slot).upper() for slot in slots]
        assert not any(place.startswith("SV_") for place in places)
        parsed = [re.fullmatch(r"(.*?)(\d*)", place) for place in places]
        found |= {(match[1], int(match[2] or 0)) for match in parsed if match is not None}
    assert len(found) == 1 + 2 * len(names.split())  # a variable is element 0 of an array
