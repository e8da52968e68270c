"""The language: declarations in the IR, with their documentation and their places."""

from __future__ import annotations

import pytest

from checked_source import checked, text_of
from sssgen.ir import nodes as ir
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.support.diagnostics import SssgenError


def test_functions() -> None:
    source = """
float f(const in float, highp vec2 y, out vec3 z, inout float list[2]) { z = vec3(y, list[0]); return 1.0; }
void g(void) { return; }
float h();
"""
    assert (
        text_of(source)
        == """\
function float f(in float unnamed_1, in vec2 y, out vec3 z, inout float[2] list) {
    set z = vec3{y, list[0]};
    return 1.0;
}
function void g() {
    return;
}
function float h() slot
"""
    )


def test_attribute_in_a_fragment_shader() -> None:
    source = "#version 100\nattribute highp vec4 place;\nvoid main() { gl_FragColor = place; }\n"
    with pytest.raises(SssgenError, match="a fragment shader has no attributes"):
        load_glsl_text(source, "shade.frag")
    load_glsl_text(source.removeprefix("#version 100\n"), "shade.frag")  # perhaps a part that an engine completes


def test_prototypes_and_their_definitions() -> None:
    """A definition replaces its prototype; a prototype after the definition, or twice, changes nothing."""
    source = """
float f(float x);
float f(float x);
float g(float x) { return f(x); }
float f(float y) { return y; }
float f(float x);
float g(float x);
"""
    module = checked(source)
    assert [(function.key, function.body is None) for function in module.functions] == [
        ("f(float)", False),
        ("g(float)", False),
    ]
    assert module.functions[0].params[0].name == "y"


def test_overloads() -> None:
    source = """
float f(float x) { return x; }
float f(vec2 x) { return f(x.x); }
float f(float x, float y) { return f(vec2(x, y)); }
thickness f(int x) { return thickness(1.0); }
float g() { return f(1.0) + f(1.0, 2.0) + f(1); }
"""
    assert "return (($f(1.0) + $f(1.0, 2.0)) + $f(1));" in text_of(source)


def test_included_declarations() -> None:
    """Included declarations are first; an included prototype may be defined, an included function not."""
    included = checked(
        "struct S { float x; };\nconst int N = 2;\nuniform float u;\n"
        "float slot(float x);\nfloat f(S s) { return slot(s.x) + u; }"
    )
    module = checked(
        "float list() { float x[N]; S s = S(u); return f(s) + x[1]; }\nfloat slot(float x) { return x; }", included
    )
    assert [function.key for function in module.functions] == ["slot(float)", "f(S)", "list()"]
    assert module.functions[0].body is not None
    assert module.structs == included.structs
    for again in ("float f(S s) { return 1.0; }", "uniform float u;", "const float N = 1.0;", "struct S { float y; };"):
        with pytest.raises(SssgenError, match="already d"):
            checked(again, included)
    with pytest.raises(SssgenError, match="recursion"):
        checked("float slot(float x) { return f(S(x)); }", included)


def test_uniforms() -> None:
    source = """
uniform float a;
uniform highp vec3 b : source_color = vec3(1.0, 0.5, 0.0);
uniform vec2 c = vec2(0.25);
uniform mat2 d;
uniform mat2 e = mat2(2.0);
uniform mat2 f = mat2(vec2(1.0, 2.0), vec2(-3.0));
uniform int g : hint_range(-1, 0x10, 1) = 3;
uniform uint h = 7u;
uniform bool i = true;
uniform bvec2 j = bvec2(false, true);
uniform float k[2] = float[2](1.0, -0.0);
uniform vec2 l[2];
uniform thickness m : unit("m"), alias("depth", d), hint_range(0.0, 1.0) = 0.5;
uniform world_direction n = vec3(0.0, 0.0, 1.0);
uniform sampler2D o : holds(thickness), default_gray;
uniform sampler2D drawn_map : drawn(light_depth);
uniform sampler3D p;
uniform samplerCube q : default_black, normal_map;
uniform ivec2 r = ivec2(1.9, true);
"""
    assert (
        text_of(source)
        == """\
uniform float a = (0.0)
uniform vec3 b = (1.0, 0.5, 0.0) [source_color()]
uniform vec2 c = (0.25, 0.25)
uniform mat2 d = (1.0, 0.0, 0.0, 1.0)
uniform mat2 e = (2.0, 0.0, 0.0, 2.0)
uniform mat2 f = (1.0, 2.0, -3.0, -3.0)
uniform int g = (3.0) [hint_range(-1.0, 16.0, 1.0)]
uniform uint h = (7.0)
uniform bool i = (1.0)
uniform bvec2 j = (0.0, 1.0)
uniform float[2] k = (1.0, -0.0)
uniform vec2[2] l = (0.0, 0.0, 0.0, 0.0)
uniform float m : thickness = (0.5) [unit("m"), alias("depth", "d"), hint_range(0.0, 1.0)]
uniform vec3 n : world_direction = (0.0, 0.0, 1.0)
uniform sampler2D o : thickness [holds("thickness"), default_gray()]
uniform sampler2D drawn_map [drawn("light_depth")]
uniform sampler3D p
uniform samplerCube q [default_black(), normal_map()]
uniform ivec2 r = (1.0, 1.0)
"""
    )


def test_structs_and_constants() -> None:
    source = """
precision highp float;
const int N = 2, M = N + 1;
struct Inner { float x, y[2]; };
struct Outer { Inner inner; Inner pair[2]; thickness depth; };
const float PI = 3.14159, TWO_PI = 2.0 * PI;
const vec2 AXIS = normalize(vec2(1.0, TWO_PI));
const float LIST[2] = float[2](PI, AXIS.x);
float f(Outer o) { float list[N * 2]; return o.pair[1].y[0] + o.depth + LIST[N - 1] + list[3]; }
"""
    assert (
        text_of(source)
        == """\
struct Inner {
    float x;
    float[2] y;
}
struct Outer {
    Inner inner;
    Inner[2] pair;
    float depth : thickness;
}
const int N = 2
const int M = ($N + 1)
const float PI = 3.14159
const float TWO_PI = (2.0 * $PI)
const vec2 AXIS = normalize(vec2{1.0, $TWO_PI})
const float[2] LIST = float[2]{$PI, $AXIS.x}
function float f(in Outer o) {
    var float[4] list;
    return (((o.pair[1].y[0] + o.depth) + $LIST[($N - 1)]) + list[3]);
}
"""
    )


def test_documentation() -> None:
    source = """
/// One line.
uniform float a; /// behind: not for b
uniform float b;

/// Two
///   lines.
uniform float c;
/// too far

uniform float d;
// plain
uniform float e;
//// banner
uniform float f;
/** A block
 *
 *  formula: a * b
 *    and more
 */
float g() { return 1.0; }
/**
    Without stars,
      indented.
*/
struct S { float x; };
/** Block. */
/// And a line.
uniform float h;
/***/
uniform float i;
/**/
uniform float j;
/// Of a slot.
float k();
"""
    module = checked(source)
    docs = {uniform.name: uniform.doc for uniform in module.uniforms if uniform.doc}
    assert docs == {"a": "One line.", "c": "Two\n  lines.", "h": "Block.\nAnd a line."}
    assert module.functions[0].doc == "A block\n\n formula: a * b\n   and more"
    assert module.functions[1].doc == "Of a slot."
    assert module.structs[0].doc == "Without stars,\n  indented."


def test_spans() -> None:
    """Every node knows its place: lines and columns from 1, the end exclusive."""
    source = "float f(vec2 xy) {\n    return max(xy.x,\n               -1.0) * 2.0;\n}\n"
    (function,) = checked(source).functions
    assert function.span == ("a.sss", 1, 7, 1, 8)
    assert function.params[0].span == ("a.sss", 1, 14, 1, 16)
    assert function.body is not None
    (leave,) = function.body
    assert leave.span == ("a.sss", 2, 5, 3, 27)
    assert isinstance(leave, ir.Return) and isinstance(leave.value, ir.Binary)
    left = leave.value.left
    assert leave.value.span == ("a.sss", 2, 12, 3, 27)
    assert left.span == ("a.sss", 2, 12, 3, 21)
    assert isinstance(left, ir.Intrinsic)
    assert [arg.span[1:] for arg in left.args] == [(2, 16, 2, 20), (3, 16, 3, 20)]


def test_windows_line_ends() -> None:
    source = "/// Doc.\r\nuniform float a;\r\nfloat f() {\r\n    return a;\r\n}\r\n"
    module = checked(source)
    assert module.uniforms[0].doc == "Doc."
    assert module.functions[0].span == ("a.sss", 3, 7, 3, 8)


def test_empty_files() -> None:
    for source in ("", "\n\n", "// nothing", "/* nothing */", ";;"):
        assert checked(source) == ir.Module()


def test_builtin_block_with_an_instance() -> None:
    """The block of GLSL's own outputs may have a name; its members are declared anyway."""
    source = "out gl_PerVertex { vec4 gl_Position; } gl_out;\nvoid main() { gl_Position = vec4(0.0); }\n"
    assert [variable.name for variable in load_glsl_text(source, "a.vert").module.variables] == ["gl_Position"]


@pytest.mark.parametrize("name", ["gl_ViewID_OVR", "gl_DrawID", "gl_BaseVertex", "gl_BaseInstance"])
def test_variables_of_the_draw_call_become_uniforms(name: str) -> None:
    main = f"void main() {{ gl_Position = vec4(float({name}), {name}, 0.0, 1.0); }}"
    source = f"#version 300 es\nlayout(num_views = 2) in;\n{main}"
    loaded = load_glsl_text(source, "views.vert")
    assert [uniform.name for uniform in loaded.module.uniforms] == [name]
    assert [warning.message for warning in loaded.warnings] == [f"{name} becomes a uniform: set it for each draw call"]
