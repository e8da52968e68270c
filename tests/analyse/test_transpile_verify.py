"""`sssgen transpile --verify`: functions as they are written compared with their transpiled texts."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from sssgen.analyse.verify.inline_includes import expand
from sssgen.analyse.verify.machines import Machines
from sssgen.analyse.verify.stage_variables import plain, without_functions
from sssgen.analyse.verify.verification import load, verify
from sssgen.analyse.verify.verification_report import BACKENDS, Comparison, Coverage, Report, Row
from sssgen.analyse.verify.verified_function import Options
from sssgen.ir.nodes import Module
from sssgen.ir.old_names import OLD_NAMES
from sssgen.run.evaluate.deviation import GOAL
from sssgen.support.diagnostics import SssgenError

SAMPLES = 200

FUNCTIONS = """
struct Lamp { vec3 color; float power; };

vec3 lit(Lamp lamp, vec3 n) { return lamp.color * lamp.power * max(n.z, 0.0); }
vec2 twice(vec2 p) { return 2.0 * p; }
float twice(float x) { return 2.0 * x; }
void split(float x, out float a, inout vec2 b) { a = x + x; b += x; }
vec3 turned(mat3 m, vec3 v) { return m * v; }
vec4 seen(sampler2D map, vec2 p) { return texture(map, p); }
float weighted(float w[3]) { return w[0] + w[1] * 2.0 + w[2]; }
bool both(bvec2 b) { return all(b); }
int sum_below(int n) { int sum = 0; for (int i = 0; i < 8; i++) { if (i >= n) break; sum += i; } return sum; }
float slope(vec2 p) { return dFdx(p.x) + dFdy(p.y); }
float shown_where(float x) { if (x < 0.5) discard; return x; }
"""


Rows = Callable[..., dict[str, Row]]


@pytest.fixture(scope="module")
def rows(machines: Machines) -> Rows:
    """`rows(text, read)`: the rows by function."""

    def run(text: str, read: Callable[[str, str], Module] = load) -> dict[str, Row]:
        report = verify(text, "shader.glsl", Options(SAMPLES), read=read, machines=machines)
        return {row.function: row for row in report.rows}

    return run


def misread(*mistakes: tuple[str, str]) -> Callable[[str, str], Module]:
    """A front end that misreads its text."""

    def read(text: str, shown: str) -> Module:
        for right, wrong in mistakes:
            assert text.count(right) == 1
            text = text.replace(right, wrong)
        return load(text, shown)

    return read


def test_every_function_runs_in_every_text(rows: Rows) -> None:
    results = rows(FUNCTIONS)
    assert list(results) == [
        "lit(Lamp,vec3)", "twice(vec2)", "twice(float)", "split(float,float,vec2)", "turned(mat3,vec3)",
        "seen(sampler2D,vec2)", "weighted(float[3])", "both(bvec2)", "sum_below(int)", "slope(vec2)",
        "shown_where(float)",
    ]  # fmt: skip
    for row in results.values():
        assert row.ok, row
        assert row.comparisons.keys() == BACKENDS.keys()
        assert row.lanes == SAMPLES and row.undefined <= 0.06 * SAMPLES


MISTAKES = [
    ("max(n.z, 0.0)", "max(n.z, 0.01)"),
    ("2.0 * p", "2.0 * p.yx"),
    ("2.0 * x", "2.0002 * x"),
    ("b += x", "b -= x"),
    ("m * v", "v * m"),
    ("texture(map, p)", "texture(map, p + 0.01)"),
    ("w[1] * 2.0", "w[2] * 2.0"),
    ("all(b)", "any(b)"),
    ("i >= n", "i > n"),
    ("dFdy(p.y)", "dFdy(p.x)"),
    ("x < 0.5) discard", "x < 0.4) discard"),
]
"""One in each function."""


@pytest.mark.slow
def test_errors_of_the_front_end_are_found_in_every_text(rows: Rows) -> None:
    results = rows(FUNCTIONS, misread(*MISTAKES))
    assert len(results) == len(MISTAKES)
    for row in results.values():
        assert row.comparisons.keys() == BACKENDS.keys()
        for name, one in row.comparisons.items():
            assert one.deviation is not None and one.deviation > GOAL, (row.function, name)
            assert not one.ok and "the author's text gives" in one.at
        assert not row.ok


@pytest.mark.slow
def test_ill_conditioned_hashes_are_compared_and_wrong_ones_fail(rows: Rows) -> None:
    text = "float scatter(vec2 p) { return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453); }"
    row = rows(text)["scatter(vec2)"]
    assert row.ok and row.comparisons["glsl"] == Comparison(0.0)
    assert row.comparisons["oracle"].excluded > 0.8 * SAMPLES
    wrong = rows(text, misread(("78.233", "78.133")))["scatter(vec2)"]
    assert not wrong.ok


@pytest.mark.slow
def test_an_edge_in_the_inputs_does_not_hide_other_errors(rows: Rows) -> None:
    text = "float edge(float x) { return x < 0.7 ? 0.0 : fract(70000.0 * x); }"
    assert rows(text)["edge(float)"].ok
    assert not rows(text, misread(("0.7", "0.71")))["edge(float)"].ok


def test_a_ray_at_the_edge_of_total_reflection_may_be_either(machines: Machines) -> None:
    """In float32 two terms cancel exactly, so that every driver has the one, and float64 the other ray."""
    text = """vec3 through_both_sides(vec3 ray, vec3 normal, float ior) {
        vec3 inside = refract(ray, normal, 1.0 / ior);
        return refract(inside, -normalize(reflect(normal, inside)), ior);
    }"""
    report = verify(text, "rays.glsl", Options(4000, seed=1), machines=machines)
    assert report.ok and report.rows[0].comparisons["oracle"].excluded > 50, report.rows


@pytest.mark.slow
def test_lanes_without_a_result_are_counted(rows: Rows) -> None:
    row = rows("float over(float x) { return 1.0 / x; }")["over(float)"]
    assert row.ok and 0 < row.undefined < SAMPLES
    row = rows("float root(float x) { return sqrt(-1.0 - x * x); }")["root(float)"]
    assert not row.ok and row.reason == "GLSL leaves every result undefined"


def test_an_unsupported_function_fails_only_its_own_row(rows: Rows) -> None:
    long = ", ".join(f"float x{i}" for i in range(300))
    text = f"float many({long}) {{ return x0; }}\nvoid nothing(float x) {{ }}\nfloat same(float x) {{ return x; }}"
    results = rows(text)
    assert "takes 300 numbers" in next(row.reason for name, row in results.items() if name.startswith("many"))
    assert results["nothing(float)"].reason == "it has no outputs"
    assert results["same(float)"].ok


@pytest.mark.slow
def test_a_uniform_has_several_values(rows: Rows) -> None:
    text = "uniform float size;\nuniform sampler2D map;\nvec4 f(vec2 p) { return size * texture(map, p); }"
    assert rows(text)["f(vec2)"].ok
    assert not rows(text, misread(("size * tex", "0.5 * tex")))["f(vec2)"].ok


SHADER = """#version 330 core
struct Lamp { vec3 color; float power; };
layout(location = 0) in vec2 uv;
flat in int kind;
uniform float time;
uniform Lamp lamps[2];
uniform sampler2D map;
out vec4 color;
float level = 0.5;
vec3 tint;
float ring(vec2 p) { return abs(length(p) - level); }
void keep(vec3 c) { tint = c * time; level += 1.0; }
vec3 kept() { return tint * level * lamps[1].color; }
void main() {
    keep(vec3(uv, float(kind)));
    color = vec4(kept(), ring(uv)) + texture(map, uv) + gl_FragCoord;
}
"""


@pytest.mark.slow
def test_a_shader_is_run_function_by_function(rows: Rows) -> None:
    results = rows(SHADER)
    assert list(results) == ["ring(vec2)", "keep(vec3)", "kept()", "main()"]
    for row in results.values():
        assert row.ok, row
    wrong = misread(
        ("(p) - level", "(p) + level"),
        ("level += 1.0", "level += 1.1"),
        ("level * lamps[1]", "level * lamps[0]"),
        ("+ gl_FragCoord", "+ gl_FragCoord.yxzw"),
    )
    assert not any(row.ok for row in rows(SHADER, wrong).values())


def test_old_glsl_runs_unchanged(rows: Rows) -> None:
    text = """
#ifdef GL_ES
precision mediump float;
#endif
varying vec2 uv;
uniform sampler2D map;
uniform float u_time;
void main() {
    gl_FragColor = texture2D(map, uv) * sin(u_time);
}
"""
    assert rows(text)["main()"].ok
    assert not rows(text, misread(("sin(", "cos(")))["main()"].ok


@pytest.mark.slow
def test_the_tolerance_of_drivers_does_not_hide_larger_errors(rows: Rows) -> None:
    text = "float f(float x) { return asin(clamp(x, -1.0, 1.0)); }"
    row = rows(text)["f(float)"]
    assert row.ok and row.comparisons["glsl"] == Comparison(0.0)
    wrong = rows(text, misread(("asin(cl", "1.01 * asin(cl")))["f(float)"]
    assert not any(one.ok for one in wrong.comparisons.values())


def test_a_struct_of_uniforms_needs_no_name(rows: Rows) -> None:
    text = "uniform struct { float scale; } u;\nfloat scaled(float x) { return x * u.scale; }\n"
    assert rows(text)["scaled(float)"].ok


def test_initial_values_of_variables_need_no_main(rows: Rows) -> None:
    text = "uniform float time;\nfloat start = time * 2.0;\nfloat next(float x) { return start + x; }"
    assert rows(text)["next(float)"].ok


@pytest.mark.slow
@pytest.mark.parametrize("version", ["300 es", "330", "410 core", "450", "460", "120", ""])
def test_every_version_of_glsl_runs(rows: Rows, version: str) -> None:
    head = f"#version {version}\n" if version else ""
    text = f"{head}#ifdef GL_ES\nprecision highp float;\n#endif\nfloat f(vec2 p) {{ return dot(p, p); }}"
    assert rows(text)["f(vec2)"].ok


def test_macros_are_those_of_the_version(machines: Machines) -> None:
    """Also where the text without its #version would be one of GLSL ES."""
    text = """#version 330
precision highp float;
#if defined(GL_core_profile) && !defined(GL_ES)
float f(float x) { return x; }
#endif"""
    report = verify(text, "shader.glsl", Options(SAMPLES), machines=machines)
    assert [row.function for row in report.rows] == ["f(float)"] and report.ok


def test_a_scene_of_shadertoy_has_its_uniforms(machines: Machines) -> None:
    text = """void mainImage(out vec4 color, in vec2 at) {
    color = vec4(at / iResolution.xy, sin(iTime), iChannelTime[1]) + texture(iChannel0, at / 64.0);
}"""
    report = verify(text, "scene.glsl", Options(SAMPLES, entry="shadertoy"), machines=machines)
    assert [row.function for row in report.rows] == ["mainImage(vec4,vec2)"] and report.ok


def test_refusals_of_the_driver_are_reported(rows: Rows) -> None:
    text = "float f(samplerCubeShadow map, vec4 p) { return texture(map, p); }"
    text += "\nfloat g(float x) { return later(x); }\nfloat later(float x) { return x; }"
    results = rows(text, misread(("later(x); }\nfloat", "x; }\nfloat")))
    assert results["f(samplerCubeShadow,vec4)"].reason == "it takes a samplerCubeShadow, which is not supported here"
    assert results["g(float)"].reason.startswith("the driver refuses it as written: gl: ")


def test_a_function_that_the_driver_refuses_does_not_hide_the_others(rows: Rows) -> None:
    text = "float early(float x) { return later(x); }\nfloat later(float x) { return x; }\n"
    results = rows(f"{text}float alone(float x) {{ return 2.0 * x; }}", misread(("later(x); }", "x; }")))
    assert results["early(float)"].reason.startswith("the driver refuses it as written: gl: ")
    assert results["later(float)"].ok and results["alone(float)"].ok


def test_functions_are_removed_with_their_lines() -> None:
    text = "float a(float x);\n#ifdef B\nfloat a(vec2 x[2]) {\n if (b) { }\n}\n#endif\nfloat u = a(1.0);\nS b(S a) { }"
    assert without_functions(text, {"a"}) == "\n#ifdef B\n\n\n\n#endif\nfloat u = a(1.0);\nS b(S a) { }"


def test_one_function_is_run_by_its_name(machines: Machines) -> None:
    text = "float f(float x) { return x; }\nfloat f(vec2 x) { return x.y; }\nvoid main() { }"
    report = verify(text, "a.frag", Options(50, function="f"), machines=machines)
    assert [row.function for row in report.rows] == ["f(float)", "f(vec2)"] and report.ok
    with pytest.raises(SssgenError, match="the file has no function 'mains'") as error:
        verify(text, "a.frag", Options(50, function="mains"), machines=machines)
    assert error.value.diagnostics[0].hint == "did you mean 'main'?"


def test_old_text_of_webgl_runs_as_an_engine_writes_it(rows: Rows) -> None:
    text = """#extension GL_EXT_draw_buffers : require
#ifdef GL_ES
#define in varying
#define first gl_FragData[0]
#endif
precision mediump float;
in vec2 at;
uniform sampler2D image;
void main() {
    float fine = 1.0 + 0.0001 * at.x; // more than 16 bits
    first = vec4(fine, 1.0, at);
    gl_FragData[1] = texture2D(image, at);
}
"""
    assert rows(text)["main()"].ok
    assert not rows(text, misread(("vec4(fine,", "vec4(1.0,")))["main()"].ok


def test_text_of_webgl_2_runs_as_an_engine_writes_it(rows: Rows) -> None:
    text = """#version 300 es
precision highp float;
layout(std140, column_major) uniform;
layout(std140) uniform Scene { mat4 view; };
#ifdef FLIPPED
vec2 turned(vec2 p) {
#else
vec2 turned(vec2 p) {
#endif
    return p.yx; }
in vec3 normal;
out vec4 color;
void main() { color = view * vec4(turned(normal.xy), normal.z, 1.0); }
"""
    assert rows(text)["main()"].ok


def test_a_variable_without_a_value_explains_a_deviation(rows: Rows) -> None:
    text = """struct Surface { float height; float shade; };
float f(float x, float y) { Surface s; s.shade = y; float h = 0.0; return x > 0.0 ? s.shade : s.height + h; }"""
    row = rows(text, misread(("h = 0.0", "h = 3.0")))["f(float,float)"]
    assert row.ok and row.comparisons["wgsl"].excluded > 0.3 * SAMPLES
    assert not rows(text, misread(("? s.shade", "? -s.shade")))["f(float,float)"].ok


def test_functions_of_rare_inputs_are_run(rows: Rows) -> None:
    ordered = " + ".join(f"smoothstep(low[{i}], high[{i}], x)" for i in range(12))
    text = f"uniform float scale;\nfloat f(float low[12], float high[12], float x) {{ return scale * ({ordered}); }}"
    row = rows(text)["f(float[12],float[12],float)"]
    assert row.ok and row.undefined < 0.7 * SAMPLES


def test_a_search_around_one_comparison_has_whole_quads(rows: Rows) -> None:
    assert rows("float f(vec2 p) { float d = dFdx(p.x); return p.y < 0.3 ? d : p.x; }")["f(vec2)"].ok


@pytest.mark.slow
def test_the_same_seed_gives_the_same_rows(machines: Machines) -> None:
    once, again = (verify(FUNCTIONS, "shader.glsl", Options(50, seed), machines=machines) for seed in (3, 3))
    assert once == again


def test_the_report_lists_every_row() -> None:
    rows = [
        Row("f(float)", 1, 100, 3, {"glsl": Comparison(0.0), "hlsl": Comparison(float("inf"), 2, "result[0]: nan")}),
        Row("g(float)", 2, reason="it has no outputs"),
        Row(
            "i(float)",
            4,
            100,
            comparisons={
                "glsl": Comparison(0.0),
                "oracle": Comparison(1e-4, 0, "result[1]: 0"),
            },
            branches=Coverage(7, 8, ("line 12 (else)",)),
        ),
        Row(
            "h(float)",
            3,
            100,
            comparisons={"glsl": Comparison(None, 100), "hlsl": Comparison(None, error="no such thing")},
        ),
    ]
    report = Report(rows, dict.fromkeys(("webgpu", "tsl", "tsl-webgl2"), "pip install it"))
    lines = list(report.lines())
    assert lines == [
        "largest deviation     glsl     hlsl   oracle   of lanes (goal: 1e-05)",
        "f(float)                 0      inf            100 but for 3 undefined, 2 ill-conditioned in hlsl",
        "    hlsl result[0]: nan",
        "g(float)           not run: it has no outputs",
        "i(float)                 0            0.0001   100; branches 7 of 8",
        "    oracle result[1]: 0",
        "    never taken: line 12 (else)",
        "h(float)                 –   failed            100 but for 100 ill-conditioned in glsl",
        "    hlsl does not run: no such thing",
        "webgpu is missing: pip install it",
        "tsl is missing: pip install it",
        "tsl-webgl2 is missing: pip install it",
    ]
    result = json.loads(json.dumps(report.as_json(), allow_nan=False))
    assert [row["ok"] for row in result["functions"]] == [False] * 4 and not report.ok
    assert result["functions"][1]["not_run"] == "it has no outputs"
    assert result["functions"][0]["texts"]["hlsl"]["deviation"] is None
    assert result["functions"][2]["branches"] == {"outcomes": 8, "taken": 7, "never": ["line 12 (else)"]}


def test_the_interface_of_a_stage_becomes_variables() -> None:
    text = """#version 330 core
#extension GL_ARB_gpu_shader5 : enable
layout(location = 0) flat in vec2 uv; // in
layout(std140) uniform Camera { layout(offset = 0) mat4 view; vec3 eye; };
layout(std140) uniform Fog { float near; } fog;
uniform highp float time;
uniform vec3 points[4];
uniform Lamp lamps[2];
uniform sampler2D maps[2];
#define varying in
out vec4 color;
float f(in float x, out float y) { y = x; return x; }
void main() { color = vec4(gl_FragCoord.x); }
"""
    result = plain(text)
    assert result.version == "330 core" and not result.is_es
    assert result.text.split("\n") == [
        "vec4 sssgen_coordinates;", "#define gl_FragCoord sssgen_coordinates", "#define main sssgen_written_main", "",
        "#extension GL_ARB_gpu_shader5 : enable", "   vec2 uv; // in", "   mat4 view; vec3 eye; ",
        " struct Fog { float near; } fog;", "uniform highp float time;", " vec3 points[4];", " Lamp lamps[2];",
        "uniform sampler2D maps[2];", "#define varying in", " vec4 color;",
        "float f(in float x, out float y) { y = x; return x; }",
        "void main() { color = vec4(gl_FragCoord.x); }", "", "#undef gl_FragCoord", "#undef main", "",
    ]  # fmt: skip
    assert result.for_driver("450 core").split("\n")[:2] == [
        "#version 450 core",
        "#extension GL_ARB_gpu_shader5 : enable",
    ]


def test_textures_of_a_kind_that_is_not_drawn_have_a_reason(rows: Rows) -> None:
    text = "uniform samplerCubeShadow lamp;\nuniform sampler2D maps[1];\nfloat f(vec4 p) { return texture(lamp, p); }\n"
    results = rows(f"{text}vec4 g(vec2 p) {{ return texture(maps[0], p); }}")
    assert results["f(vec4)"].reason == "it reads 'lamp', a samplerCubeShadow, which is not supported here"
    assert results["g(vec2)"].ok


def test_old_names_are_renamed_for_the_driver_alone() -> None:
    result = plain("varying vec2 uv;\nvec4 f(sampler2D s) { return texture2D(s, uv); }")
    assert "#define texture2D texture\n" in result.for_driver("450 core")
    assert "#define texture2D" not in result.text
    assert "#define texture2D texture\n" not in plain("#define texture2D tex\nvec4 v = texture2D(a);").for_driver("330")


HINTED = """uniform vec3 paint : source_color, alias("my (paint)", "p") = vec3(1.0, vec2(0.5)), // a colour ; of
    other = vec3(2.0);
uniform float strength : hint_range(0.0, 1.0) = 0.5;
vec3 tinted(vec3 color) { return mix(color, color * paint, color.r > 0.0 ? strength : 0.1); }
"""


def test_the_driver_gets_uniforms_without_hints() -> None:
    desktop, mobile = (plain(HINTED).for_driver(version) for version in ("450 core", "300 es"))
    assert "uniform vec3 paint  = vec3(1.0, vec2(0.5)), // a colour ; of\n    other = vec3(2.0);" in desktop
    assert "uniform float strength  = 0.5;" in desktop
    assert "uniform vec3 paint  , // a colour ; of\n    other ;\nuniform float strength  ;" in mobile  # as ES requires
    for text in (desktop, mobile, plain(HINTED).text):
        assert "color.r > 0.0 ? strength : 0.1" in text
    assert "hint_range" in plain(HINTED).text  # which our front end reads


def test_functions_of_hinted_uniforms_run(rows: Rows) -> None:
    assert rows(HINTED)["tinted(vec3)"].ok


def test_the_driver_gets_the_new_name_of_every_old_one() -> None:
    for old, (new, _) in OLD_NAMES.items():
        text = plain(f"float f(float x) {{ return {old}(x); }}").for_driver("330")
        assert f"#define {old} {new}\n" in text


def test_old_shadow_reads_are_defined_for_the_driver(rows: Rows) -> None:
    text = """
float shadow(sampler2DShadow map, vec3 p) { return shadow2D(map, p).r + shadow2DProj(map, vec4(p, 2.0)).r; }
float twice(float x) { return 2.0 * x; }
"""
    assert plain(text).for_driver("450 core").count("vec4 shadow2D(") == 1
    assert rows(text)["twice(float)"].ok


def test_reads_by_their_old_names_run(rows: Rows) -> None:
    text = """
vec4 graded(sampler2D map, vec2 p) { return texture2DGradARB(map, p, vec2(0.1, 0.0), vec2(0.0, 0.1)); }
vec4 fetched(sampler3D map) { return texelFetch3D(map, ivec3(1, 2, 0), 0); }
int width(sampler2D map) { return textureSize2D(map, 0).x; }
vec4 projected(sampler2D map, vec3 p) { return texture2DProjGradEXT(map, vec3(p.xy, 2.0), vec2(0.1), vec2(0.2)); }
"""
    assert all(row.ok for row in rows(text).values())


def test_includes_are_written_out_once(tmp_path: Path) -> None:
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "a.glsl").write_text('#include "b.glsl"\nfloat a;\n')
    (tmp_path / "lib" / "b.glsl").write_text('#include "a.glsl"\nfloat b;\n')
    path = tmp_path / "main.glsl"
    text = '#include "lib/a.glsl"\n// #include "none"\n#include <b.glsl>\nfloat c;\n'
    assert expand(text, path, [tmp_path / "lib"]) == '\nfloat b;\n\nfloat a;\n\n// #include "none"\n\nfloat c;\n'
    with pytest.raises(SssgenError, match=r"cannot find 'lost\.glsl'"):
        expand('#include "lost.glsl"', path)


def test_probes_do_not_capture_names_of_the_text(rows: Rows) -> None:
    text = (
        "float sssgen_result = 2.0;\nfloat sssgen_0 = 3.0;\nconst float sssgen_of_x = 5.0;\n"
        "struct sssgen_1 { float a; };\nfloat sssgen_probe_0(float x) { return x; }\n"
        "float f(float x) { return x * sssgen_result + sssgen_0 + sssgen_of_x; }\n"
        "void g(float result, float lane, out float of_x) { of_x = result + sssgen_of_x + lane; }\n"
    )
    results = rows(text)
    assert list(results) == ["sssgen_probe_0(float)", "f(float)", "g(float,float,float)"]
    assert all(row.ok and row.comparisons for row in results.values())
