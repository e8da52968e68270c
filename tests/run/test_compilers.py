"""Compilers accept correct files and report the line of an error; files become sources with a language and a stage."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import pytest

from folders import UNITY_SAMPLES as SAMPLES
from sssgen.run import compilers
from sssgen.run.check.compiler_inputs import sources
from sssgen.run.compilers import (
    Compiler,
    Source,
    errors,
    shaderlab,
)
from sssgen.run.compilers import (
    calling_entry as calls,
)
from sssgen.run.compilers import (
    surface_shader as surface,
)

GLSL = "in vec2 v_uv;\nout vec4 color;\nuniform sampler2D t;\nvoid main() {\n    color = texture(t, v_uv);\n}"
GLSL_VERTEX = "out vec2 v_uv;\nvoid main() {\n    v_uv = vec2(0.0);\n    gl_Position = vec4(0.0);\n}\n"
GLSL_LIBRARY = """\
float first(vec3 x, inout float y[4], const in mat3 m) {
    y[0] = x.y;
    return x.x * m[0][0];
}
vec3 second(sampler2D map, vec2 uv) { return texture(map, uv).rgb; }
"""
HLSL = """\
Texture2D map : register(t0);
SamplerState map_sampler : register(s0);
float4 shade(float4 position : SV_Position) : SV_Target {
    return map.Sample(map_sampler, position.xy);
}
float4 place(float3 position : POSITION) : SV_Position { return float4(position, 1.0); }
"""
HLSL_LIBRARY = """\
float first(float3 x, inout float y[4], in float3x3 m) {
    y[0] = x.y;
    return x.x * m[0][0];
}
float3 second(Texture2D map, SamplerState s, float2 uv) { return map.Sample(s, uv).rgb; }
"""
WGSL = """\
@group(0) @binding(0) var map: texture_2d<f32>;
@group(0) @binding(1) var map_sampler: sampler;
@fragment fn shade(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
    return textureSample(map, map_sampler, uv);
}
"""
WGSL_LIBRARY = """\
fn first(x: vec3<f32>, y: ptr<function, array<f32, 4>>, m: mat3x3<f32>) -> f32 {
    (*y)[0] = x.y;
    return x.x * m[0][0];
}
fn second(map: texture_2d<f32>, s: sampler, uv: vec2<f32>) -> vec4<f32> { return textureSample(map, s, uv); }
"""
GOOD = [
    *(Source(GLSL, language) for language in ("glsl-330", "glsl-es-300")),
    *(Source(GLSL, language, companion=f"{head}\n{GLSL_VERTEX}") for language, head in
      (("glsl-330", "#version 330"), ("glsl-es-300", "#version 300 es"))),
    *(Source(GLSL_VERTEX, language, "vertex") for language in ("glsl-330", "glsl-es-300")),
    *(Source(GLSL_LIBRARY, language, "library") for language in ("glsl-330", "glsl-es-300")),
    Source(HLSL, "hlsl", "fragment", "shade"),
    Source(HLSL, "hlsl", "vertex", "place"),
    Source(HLSL_LIBRARY, "hlsl", "library"),
    Source(WGSL, "wgsl", "fragment", "shade"),
    Source(WGSL_LIBRARY, "wgsl", "library"),
    Source("import math\nx = math.pi\n", "numpy", "library"),
]  # fmt: skip
GLSLS = ("glsl-330", "glsl-es-300")
BAD = [  # (the correct text, the wrong text, the line)
    *((Source(GLSL, language), "t, v_uv", "t, v_u", 5) for language in ("glsl-330", "glsl-es-300")),
    *((Source(GLSL_LIBRARY, language, "library"), "x.x *", "x *", 3) for language in GLSLS),
    (Source(HLSL, "hlsl", "fragment", "shade"), "position.xy)", "position.xy + missing)", 4),
    (Source(HLSL, "hlsl", "vertex", "place"), "float4(position, 1.0)", "float4(position)", 6),
    (Source(HLSL_LIBRARY, "hlsl", "library"), "m[0][0]", "missing", 3),
    (Source(WGSL, "wgsl", "fragment", "shade"), "uv);", "v);", 4),
    (Source(WGSL_LIBRARY, "wgsl", "library"), "x.x *", "missing *", 3),
    (Source("import math\nx = math.pi\n", "numpy", "library"), "math.pi", "math.", 2),
]


@pytest.mark.parametrize("source", GOOD, ids=lambda s: f"{s.language}-{s.stage}")
def test_correct_text_compiles_everywhere(source: Source, assert_compiles: Callable[[Source], None]) -> None:
    assert_compiles(source)


@pytest.mark.parametrize(("source", "right", "wrong", "line"), BAD)
def test_wrong_text_is_refused_at_its_line(
    source: Source, right: str, wrong: str, line: int, compiler: Callable[[str], Compiler]
) -> None:
    assert right in source.text
    for name in compilers.readers(source.language):
        messages = errors(compiler(name).check(source.with_text(source.text.replace(right, wrong))))
        assert messages, name
        assert messages[0].line == line, (name, messages)


def test_the_driver_links_both_stages(compiler: Callable[[str], Compiler]) -> None:
    vertex = "#version 330\n" + GLSL_VERTEX.replace("v_uv", "v_other")
    assert "v_uv" in errors(compiler("gl").check(Source(GLSL, "glsl-330", companion=vertex)))[0].text


def test_tint_checks_uniformity_of_libraries_too(compiler: Callable[[str], Compiler]) -> None:
    text = WGSL_LIBRARY.replace("{ return texture", "{ if (uv.x > 0.0) { return vec4(0.0); } return texture")
    assert "uniform control flow" in errors(compiler("tint").check(Source(text, "wgsl", "library")))[0].text


def test_tint_survives_a_shader_that_is_wrong(compiler: Callable[[str], Compiler]) -> None:
    tint = compiler("tint")
    for text in ("", "\0", "fn", "é" * 5000, WGSL):
        tint.check(Source(text, "wgsl"))
    assert not tint.check(Source(WGSL, "wgsl"))


def test_every_version_names_a_number() -> None:
    for result in compilers.available():
        assert any(character.isdigit() for character in result.version()), result.name


def test_calls_pass_every_kind_of_parameter() -> None:
    called = calls.hlsl_entry("void f(inout float a, float b[2], Texture3D<float4> t) { }\n// void g() { }\n")
    assert "f(sssgen_check_0_0, sssgen_check_0_1, sssgen_check_0_2);" in called
    assert "float sssgen_check_0_1[2];" in called
    assert "g(" not in called.partition("sssgen_check_main")[2]


# --- Unity


@pytest.mark.parametrize(
    ("file", "language"),
    [
        ("surface.shader", "unity-builtin"),
        ("functions.cginc", "unity-builtin"),
        ("urp.shader", "unity-urp"),
        ("graph.hlsl", "unity-shadergraph"),
    ],
)
def test_unity_accepts_the_samples(file: str, language: str, assert_compiles: Callable[[Source], None]) -> None:
    text = (SAMPLES / file).read_text(encoding="utf-8")
    assert_compiles(Source(text, language, "fragment" if file.endswith(".shader") else "library", name=file))


@pytest.mark.parametrize(
    ("file", "right", "wrong", "reported"),
    [
        ("surface.shader", "base.a;", "base.missing;", "missing"),
        ("surface.shader", "void shade(", "void other(", "no function void shade"),
        ("surface.shader", "half4 LightingBacklit(", "half4 LightingOther(", "no lighting function"),
        ("surface.shader", "float _Strength;", "float _Strength; float4 _BaseMap_ST;", "which Unity"),
        ("surface.shader", "Range(0.5, 16)) = 4", 'Range(0.5, 16)) = "white" {}', "not a default of a Range"),
        ("surface.shader", '"bump" {}', '"bump" {', "not a property"),
        ("surface.shader", "ENDCG", "", "CGPROGRAM without its other end"),
        ("urp.shader", "light.direction + normal", "light.missing", "ForwardLit"),
        ("urp.shader", "min(positionCS.z,", "min(positionCS.missing,", "ShadowCaster vertex"),
        ("urp.shader", "uint count =", "uint number =", "ForwardLit"),  # only with _ADDITIONAL_LIGHTS
        ("urp.shader", "    float _Sharpness;\n        CBUFFER_END", "CBUFFER_END\n        float _Sharpness;",
         "_Sharpness is not in UnityPerMaterial"),
        ("urp.shader", "#pragma fragment frag", "", "no #pragma fragment"),
        ("graph.hlsl", "light.color *", "light.missing *", "functions"),
        ("graph.hlsl", "float3(0.5, 0.5, 0.0)", "missing", "preview"),
    ],
)  # fmt: skip
def test_unity_refuses_wrong_samples(
    file: str, right: str, wrong: str, reported: str, compiler: Callable[[str], Compiler]
) -> None:
    text = (SAMPLES / file).read_text(encoding="utf-8")
    assert right in text
    language = {"surface.shader": "unity-builtin", "urp.shader": "unity-urp"}.get(file, "unity-shadergraph")
    reported_errors = errors(compiler("unity").check(Source(text.replace(right, wrong), language, name=file)))
    assert any(reported in message.text for message in reported_errors), reported_errors


def test_unity_reports_the_line_of_the_file(compiler: Callable[[str], Compiler]) -> None:
    text = (SAMPLES / "urp.shader").read_text(encoding="utf-8").replace("CS.z;", "CS.missing;")
    line = next(i for i, text_line in enumerate(text.splitlines(), 1) if "missing" in text_line)
    assert errors(compiler("unity").check(Source(text, "unity-urp", name="urp.shader")))[0].line == line


def test_keyword_variants_cover_every_pair() -> None:
    code = """Shader "A/B" { SubShader { Pass {
        HLSLPROGRAM
        #pragma multi_compile _ A1 A2
        #pragma multi_compile_fragment _ B
        #pragma shader_feature_local C
        #pragma multi_compile_vertex _ D
        ENDHLSL
    } } }"""
    program = shaderlab.parse(code, "x", 202120).programs[0]
    rows = program.keyword_sets("fragment")
    lists = [["", "A1", "A2"], ["", "B"], ["", "C"]]
    for first, second in itertools.combinations(lists, 2):
        for a, b in itertools.product(first, second):
            combinations = [
                [next((x for x in row if x in keywords), "") for keywords in (first, second)] for row in rows
            ]
            assert [a, b] in combinations
    assert len(rows) <= 7
    assert all("D" not in row for row in rows)


def test_surface_lighting_and_output_must_agree() -> None:
    code = "struct Input { float2 uv_A; };\nvoid surf(Input i, inout SurfaceOutput o) { }"
    with pytest.raises(surface.SurfaceError, match="requires SurfaceOutputStandard"):
        surface.entries(code, "surf Standard")


# --- Files


def test_languages_stages_and_companions_of_sources() -> None:
    files = {
        "sub/ice.glsl-330.vert": "v", "sub/ice.glsl-330.frag": "f", "ice.hlsl": "h",
        "ice.functions.hlsl": "l", "ice.unity-urp.shader": "u", "ice.unity-urp.hlsl": "p",
        "ice.glsl-330.reflection.json": "{}",
    }  # fmt: skip
    results = {(s.name, s.language, s.stage): s for s in sources(files)}
    assert results["sub/ice.glsl-330.frag", "glsl-330", "fragment"].companion == "v"
    assert results["sub/ice.glsl-330.vert", "glsl-330", "vertex"].companion == "f"
    assert {stage for name, _, stage in results if name == "ice.hlsl"} == {"vertex", "fragment"}
    assert ("ice.functions.hlsl", "hlsl", "library") in results
    assert sum(name == "ice.unity-urp.shader" for name, _, _ in results) == 1
    assert ("ice.unity-urp.hlsl", "unity-urp", "library") in results
    assert not any("json" in name for name, _, _ in results)
