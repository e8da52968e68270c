"""Functions that read uniforms receive them as parameters."""

from __future__ import annotations

from pass_cases import assert_is, key, module_of
from sssgen.ir.nodes import Module
from sssgen.ir.verify import verify
from sssgen.passes.uniforms_to_parameters import uniforms_to_parameters

SOURCE = """
    uniform sampler2D map; uniform float depth = 1.0; uniform vec3 tint = vec3(1.0); const float HALF = 0.5;
    float sdf(vec3 p) { return p.x * depth * HALF; }
    float lone(float x) { return x; }
    vec3 f(vec3 tint, float x) { float map = 2.0; return tint * sdf(tint) * map * lone(x); }
    vec4 g(vec2 uv) { return texture(map, uv) * sdf(vec3(0.0)) + vec4(f(tint, 1.0), 1.0); }
    """


def passed_on(module: Module) -> Module:
    """The module after the pass, whose new parameters name the uniforms that they pass; the test's own text cannot."""
    result = uniforms_to_parameters(module)
    names = {uniform.name for uniform in module.uniforms}
    functions = []
    for function in result.functions:
        assert all(param.passes == param.name for param in function.params if param.passes)
        assert {param.passes for param in function.params} <= names | {""}
        plain = tuple([param._replace(passes="") for param in function.params])
        functions.append(function._replace(params=plain))
    return result._replace(functions=tuple(functions))


def test_uniforms_and_textures_are_passed_along() -> None:
    assert_is(
        passed_on(module_of(SOURCE)),
        """
        uniform sampler2D map; uniform float depth = 1.0; uniform vec3 tint = vec3(1.0); const float HALF = 0.5;
        float sdf(vec3 p, float depth) { return p.x * depth * HALF; }
        float lone(float x) { return x; }
        vec3 f(vec3 tint, float x, float depth) { float map = 2.0; return tint * sdf(tint, depth) * map * lone(x); }
        vec4 g(vec2 uv, sampler2D map, float depth, vec3 tint) {
            return texture(map, uv) * sdf(vec3(0.0), depth) + vec4(f(tint, 1.0, depth), 1.0);
        }
        """,
    )


def test_textures_may_stay_global() -> None:
    result = uniforms_to_parameters(module_of(SOURCE), textures=False)
    assert verify(result) == []
    assert [param.name for param in result.functions[-1].params] == ["uv", "depth", "tint"]
    assert [param.passes for param in result.functions[-1].params] == ["", "depth", "tint"]


def test_quantities_and_places_are_preserved() -> None:
    source = (
        "uniform float depth = 1.0; uniform thickness d = thickness(1.0); float f(float x) { return x * depth * d; }"
    )
    module = module_of(source)
    _, first, second = uniforms_to_parameters(module).functions[0].params
    assert (first.quantity, second.quantity, second.span) == ("", "thickness", module.uniforms[1].span)


def test_variables_make_way_for_uniforms() -> None:
    assert_is(
        passed_on(
            module_of(
                """
                uniform float depth = 1.0;
                float g(float x) { return x * depth; }
                float f(float depth, float depth_2) {
                    float y = g(depth); { float depth_3 = y; y += depth_3; } return y * depth_2;
                }
                """
            )
        ),
        """
        uniform float depth = 1.0;
        float g(float x, float depth) { return x * depth; }
        float f(float depth_4, float depth_2, float depth) {
            float y = g(depth_4, depth); { float depth_3 = y; y += depth_3; } return y * depth_2;
        }
        """,
    )


def test_colliding_overloads_get_different_names() -> None:
    assert_is(
        passed_on(
            module_of(
                """
                uniform float depth = 1.0;
                float ball(vec3 p) { return p.x * depth; }
                float ball(vec3 p, float r) { return p.x - r; }
                float f(vec3 p) { return ball(p) + ball(p, 2.0); }
                """
            )
        ),
        """
        uniform float depth = 1.0;
        float ball_2(vec3 p, float depth) { return p.x * depth; }
        float ball(vec3 p, float r) { return p.x - r; }
        float f(vec3 p, float depth) { return ball_2(p, depth) + ball(p, 2.0); }
        """,
    )


def test_functions_without_uniforms_are_unchanged() -> None:
    module = module_of(SOURCE)
    result = uniforms_to_parameters(module)
    assert result.functions[1] is module.functions[1]
    assert result.uniforms is module.uniforms
    assert key(result, "sdf") == "sdf(vec3,float)"
