"""A module with a main(): a whole shader in every language, which other compilers accept, with the meaning of GLSL."""

from __future__ import annotations

import pytest

from sssgen.ir.text import read_module
from sssgen.pipeline.compiler import transpile
from sssgen.run.compilers import Source, check, errors
from sssgen.support.diagnostics import SssgenError
from whole_shaders import FRAGMENT, FUNCTIONS, OLD, SEVERAL, STAGES, TARGETS, VERTEX, compile_errors, emitted_shader


@pytest.mark.parametrize("keep", [True, False])
@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("name", STAGES)
def test_a_whole_shader_compiles(name: str, target: str, keep: bool) -> None:
    stage = "vertex" if name == "vertex" else "fragment"
    text = emitted_shader(STAGES[name], target, keep)
    assert compile_errors(text, target, stage) == [], text  # type: ignore[arg-type]  # one of its two words


def test_unused_colour_outputs_are_omitted() -> None:
    assert "out vec4 FragData[2];" in emitted_shader(SEVERAL, "glsl-es-300")
    assert "SV_Target1" in emitted_shader(SEVERAL, "hlsl")
    assert "SV_Target2" not in emitted_shader(SEVERAL, "hlsl")


def test_the_stages_meet() -> None:
    """The outputs of the vertex shader are the inputs of the fragment shader, and the GL driver links them."""
    for target in ("glsl-330", "glsl-es-300"):
        source = Source(emitted_shader(FRAGMENT, target), target, "fragment", companion=emitted_shader(VERTEX, target))
        assert [str(one) for messages in check(source).values() for one in errors(messages)] == []
    wgsl = emitted_shader(VERTEX, "wgsl"), emitted_shader(FRAGMENT, "wgsl")
    for place in ("@location(0) @interpolate(flat) kind", "@location(1) uv"):
        assert all(place in text for text in wgsl)


def test_coordinates_follow_the_framebuffers_direction() -> None:
    assert "FragCoord.y = iResolution.y - FragCoord.y;" in emitted_shader(FRAGMENT, "hlsl")
    assert "FragCoord.w = 1.0 / FragCoord.w;" in emitted_shader(FRAGMENT, "hlsl")
    assert "FragCoord.y = material.iResolution.y - FragCoord.y;" in emitted_shader(FRAGMENT, "wgsl")
    assert "-uv_dy" in emitted_shader(FRAGMENT, "wgsl").replace("-value_dy", "-uv_dy")
    assert "Position.z = (Position.z + Position.w) * 0.5;" in emitted_shader(VERTEX, "hlsl")
    assert "dFdy(uv.y)" in emitted_shader(FRAGMENT, "glsl-330")
    assert "-dFdy" not in emitted_shader(FRAGMENT, "glsl-330")
    without = FRAGMENT.replace("iResolution", "size")
    numbered, warning = transpile(read_module(without), "wgsl", "x", keep=True).warnings
    assert "are numbered by name" in numbered.message
    assert "counts from the top" in warning.message
    assert transpile(read_module(without), "glsl-330", "x", keep=True).warnings == []


def test_glsl_is_unchanged() -> None:
    """The text is the author's, unused functions and all, in the order of its operands."""
    text = emitted_shader(FRAGMENT + "function float unused() {\n    return (1.0 + 1.0);\n}\n", "glsl-330")
    assert "float a = rand() + rand() * seed;" in text
    assert "return 1.0 + 1.0;" in text
    assert "kind = gl_VertexID % 3;" in emitted_shader(VERTEX, "glsl-330")
    module = read_module(FRAGMENT + "function float unused() {\n    return (1.0 + 1.0);\n}\n")
    pruned = transpile(module, "glsl-330", "x", called=["main()"], keep=True)
    assert "unused" not in next(iter(pruned.files.values()))


def test_unsupported_stage_inputs_are_refused() -> None:
    point = 'variable in vec2 gl_PointCoord [builtin("gl_PointCoord")]\n' + OLD
    with pytest.raises(SssgenError, match="has no gl_PointCoord"):
        transpile(read_module(point), "wgsl", "x", keep=True)
    function = "function float f() {\n    set $g *= 2.0;\n    return $g;\n}\n"
    loose = f"uniform float u = (1.0)\nvariable private float g = $u\n{function}"
    with pytest.raises(SssgenError, match="the value of 'g' is not constant"):
        transpile(read_module(loose), "wgsl", "x", keep=True)


def test_a_non_finite_constant_is_the_largest_number_where_required() -> None:
    text = "function float f() {\n    return (1.0 / 0.0);\n}\n"
    assert "1.0 / 0.0" in emitted_shader(text, "glsl-330")
    assert "return 3.4028234e38;" in emitted_shader(text, "wgsl")
    with pytest.raises(SssgenError, match="divided by 0"):
        transpile(read_module(text), "wgsl", "x")


def test_a_vertex_shader_reads_textures_at_level_0() -> None:
    read = "    set $uv += texture($map, $uv).xy;\n}\n"
    text = "uniform sampler2D map\n" + VERTEX.removesuffix("}\n") + read
    assert "texture(map, uv)" in emitted_shader(text, "glsl-330")
    for target, level in (("wgsl", "textureSampleLevel(map, map_sampler, uv, 0.0)"), ("hlsl", "SampleLevel")):
        result = emitted_shader(text, target)
        assert level in result
        assert compile_errors(result, target, "vertex") == []


def test_an_unsupported_interpolation_is_reported() -> None:
    text = 'variable in vec2 uv [interpolation("noperspective")]\n' + OLD
    assert "noperspective in vec2 uv;" in emitted_shader(text, "glsl-330")
    assert "@interpolate(linear)" in emitted_shader(text, "wgsl")
    compiled = transpile(read_module(text), "glsl-es-300", "x", keep=True)
    assert "\nin vec2 uv;" in next(iter(compiled.files.values()))
    assert "with perspective" in compiled.warnings[0].message


def test_functions_called_in_uniform_flow_may_sample_in_a_loop() -> None:
    """A function of a whole shader is judged by its calls: here the loop's bound is a constant."""
    text = """uniform sampler2D map
variable in vec2 uv
variable out vec4 color
function vec4 blurred(in int count) {
    var vec4 sum = vec4{0.0};
    for (var int i = 0; (i < count); set i += 1;) {
        set sum += texture($map, ($uv * float{i}));
    }
    return sum;
}
function void main() {
    set $color = $blurred(4);
}
"""
    compiled = transpile(read_module(text), "wgsl", "x", keep=True)
    assert [warning.message[:14] for warning in compiled.warnings] == ["the input 'uv'"]
    shown = next(iter(compiled.files.values()))
    assert compile_errors(shown, "wgsl") == [], shown


def test_variables_of_a_library() -> None:
    """Without an entry they are declared, for whoever calls its functions."""
    assert "var<private> g: f32 = 1.0;" in emitted_shader(FUNCTIONS, "wgsl")
    assert "static float g = 1.0;" in emitted_shader(FUNCTIONS, "hlsl")
    assert "\nfloat g = 1.0;" in emitted_shader(FUNCTIONS, "glsl-330")
