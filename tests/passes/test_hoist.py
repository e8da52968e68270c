"""Implicit derivatives move to uniform control flow; those that cannot are reported."""

from __future__ import annotations

from collections.abc import Callable

from hypothesis import given, reject, settings
from hypothesis import strategies as st

from pass_cases import assert_is, module_of, text
from shaded_programs import module_for
from sssgen.passes.hoist import hoist
from sssgen.pipeline.compiler import transpile
from sssgen.run.compilers import Compiler, Source, errors
from sssgen.run.compilers.calling_entry import functions
from sssgen.support.diagnostics import SssgenError

HEAD = """
    uniform sampler2D map; uniform sampler2D other; uniform float depth = 1.0; uniform int steps = 4;
    """


def becomes(before: str, after: str, *notes: str, entries: tuple[str, ...] = ("f",)) -> None:
    """Hoisting gives this module, and notes with these beginnings."""
    module = module_of(HEAD + before)
    result, found = hoist(module, [function.key for function in module.functions if function.name in entries])
    assert_is(result, HEAD + after)
    assert [note.message[: len(begin)] for note, begin in zip(found, notes, strict=True)] == list(notes)
    again, _ = hoist(result, [function.key for function in result.functions if function.name in entries])
    assert text(again) == text(result), "nothing is left to do"


def stays(source: str) -> None:
    module = module_of(HEAD + source)
    result, notes = hoist(module, [function.key for function in module.functions if function.name == "f"])
    assert result is module and not notes


def test_an_entry_that_is_called_in_branches_reads_level_0() -> None:
    source = "vec4 read(vec2 uv) { return texture(map, uv); } vec4 f(vec2 uv) { return read(uv) * depth; }"
    module = module_of(HEAD + source)
    (entry,) = [function.key for function in module.functions if function.name == "f"]
    result, notes = hoist(module, [entry], [entry])
    assert_is(result, HEAD + source.replace("texture(map, uv)", "textureLod(map, uv, 0.0)"))
    assert [note.message for note in notes] and notes[0].message.startswith("'map' is read at level 0 here")


def test_uniform_flow_is_unchanged() -> None:
    stays(
        """
        vec4 read(vec2 uv) { return texture(map, uv); }
        vec4 f(vec2 uv, float x) {
            vec4 c = texture(map, uv);
            if (depth > 1.0) { c += texture(map, uv + 1.0) + dFdx(x); }
            for (int i = 0; i < steps; i++) { c += read(uv * float(i)); if (depth < float(i)) { break; } }
            if (x > 1.0) { c += textureLod(map, uv, 0.0); }
            float part = x > 0.0 ? 1.0 : 2.0;
            bool both = depth > 0.5 && texture(map, uv).x > part;
            for (int i = 0; float(i) < x && i < 4; i++) { c *= 2.0; if (c.x > 3.0) { break; } }
            if (both) { return c; }
            return c * 2.0;
        }
        """
    )


def test_a_read_in_a_branch_is_moved_before_it() -> None:
    becomes(
        "vec4 f(vec2 uv, float x) { vec4 c = vec4(0.0); if (x > 0.0) { c = texture(map, uv * 2.0) * x; } return c; }",
        """
        vec4 f(vec2 uv, float x) {
            vec4 c = vec4(0.0);
            vec4 map_sample = texture(map, uv * 2.0);
            if (x > 0.0) { c = map_sample * x; }
            return c;
        }
        """,
    )


def test_variables_of_the_branch_are_substituted_by_their_values() -> None:
    becomes(
        """
        vec4 f(vec2 uv, float x) {
            vec4 c = vec4(0.0);
            if (x > 0.0) {
                vec2 at = uv * 2.0;
                at += 0.5;
                vec4 first = texture(map, at);
                c = first + texture(map, at) + texture(other, first.xy);
            }
            return c;
        }
        """,
        """
        vec4 f(vec2 uv, float x) {
            vec4 c = vec4(0.0);
            vec4 map_sample = texture(map, uv * 2.0 + 0.5);
            vec4 other_sample = texture(other, map_sample.xy);
            if (x > 0.0) {
                vec2 at = uv * 2.0;
                at += 0.5;
                vec4 first = map_sample;
                c = first + map_sample + other_sample;
            }
            return c;
        }
        """,
    )


def test_choices_and_short_circuits() -> None:
    becomes(
        """
        float f(vec2 uv, float x) {
            float a = x > 0.5 ? texture(map, uv).x : fwidth(x);
            bool b = x > 0.5 && texture(other, uv).x > a;
            return b ? a : x;
        }
        """,
        """
        float f(vec2 uv, float x) {
            vec4 map_sample = texture(map, uv);
            float x_width = fwidth(x);
            float a = x > 0.5 ? map_sample.x : x_width;
            vec4 other_sample = texture(other, uv);
            bool b = x > 0.5 && other_sample.x > a;
            return b ? a : x;
        }
        """,
    )


def test_the_outermost_branch_counts() -> None:
    becomes(
        """
        vec4 f(vec2 uv, float x) {
            vec4 c = vec4(0.0);
            if (depth > 0.5) {
                vec2 at = uv * depth;
                if (x > 0.0) { if (x > 1.0) { c = texture(map, at); } }
            }
            return c;
        }
        """,
        """
        vec4 f(vec2 uv, float x) {
            vec4 c = vec4(0.0);
            if (depth > 0.5) {
                vec2 at = uv * depth;
                vec4 map_sample = texture(map, at);
                if (x > 0.0) { if (x > 1.0) { c = map_sample; } }
            }
            return c;
        }
        """,
    )


def test_flow_after_an_early_return_is_not_uniform() -> None:
    becomes(
        """
        vec4 f(vec2 uv, float x) {
            if (depth > 2.0) { return vec4(1.0); }
            if (x < 0.0) { return vec4(0.0); }
            vec2 at = uv * depth;
            vec4 c = texture(map, at);
            at += c.xy;
            return c + texture(map, at);
        }
        """,
        """
        vec4 f(vec2 uv, float x) {
            if (depth > 2.0) { return vec4(1.0); }
            vec4 map_sample = texture(map, uv * depth);
            vec4 map_sample_2 = texture(map, uv * depth + map_sample.xy);
            if (x < 0.0) { return vec4(0.0); }
            vec2 at = uv * depth;
            vec4 c = map_sample;
            at += c.xy;
            return c + map_sample_2;
        }
        """,
    )


def test_samples_move_before_a_discard_in_a_function() -> None:
    becomes(
        """
        float cut(float x) { if (x < 0.0) { discard; } return x; }
        vec4 f(vec2 uv, float x) { float y = cut(x); return texture(map, uv) * y; }
        """,
        """
        float cut(float x) { if (x < 0.0) { discard; } return x; }
        vec4 f(vec2 uv, float x) { vec4 map_sample = texture(map, uv); float y = cut(x); return map_sample * y; }
        """,
    )


def test_complete_calls_are_moved() -> None:
    becomes(
        """
        vec4 read(vec2 uv) { vec4 texel = texture(map, uv); return texel * depth; }
        vec4 f(vec2 uv, float x) { vec4 c = vec4(0.0); if (x > 0.0) { c = read(uv) + read(uv * x); } return c; }
        """,
        """
        vec4 read(vec2 uv) { vec4 texel = texture(map, uv); return texel * depth; }
        vec4 f(vec2 uv, float x) {
            vec4 c = vec4(0.0);
            vec4 read_value = read(uv);
            vec4 read_value_2 = read(uv * x);
            if (x > 0.0) { c = read_value + read_value_2; }
            return c;
        }
        """,
    )


def test_a_loop_with_divergent_exit() -> None:
    becomes(
        """
        vec4 f(vec2 uv, float x) {
            vec2 at = uv; vec4 sum = vec4(0.0);
            for (int i = 0; i < steps; i++) {
                sum += texture(map, at, 1.0) + texture(other, uv);
                at += 0.1;
                if (sum.x > x) { break; }
            }
            return sum + texture(other, at);
        }
        """,
        """
        vec4 f(vec2 uv, float x) {
            vec2 at = uv; vec4 sum = vec4(0.0);
            vec2 at_dx = dFdx(at); vec2 at_dy = dFdy(at);
            vec4 other_sample = texture(other, uv);
            for (int i = 0; i < steps; i++) {
                sum += textureGrad(map, at, at_dx * exp2(1.0), at_dy * exp2(1.0)) + other_sample;
                at += 0.1;
                if (sum.x > x) { break; }
            }
            return sum + texture(other, at);
        }
        """,
        "'map' is read here at the level that its coordinates had before",
    )


def test_a_partially_known_sum_is_hoisted() -> None:
    becomes(
        """
        vec4 f(vec2 uv, float x) {
            vec4 c = vec4(0.0);
            for (int i = 0; float(i) < x && i < 9; i++) { c += texture(map, (uv + float(i) * 0.1) * 2.0); }
            return c;
        }
        """,
        """
        vec4 f(vec2 uv, float x) {
            vec4 c = vec4(0.0);
            vec2 coordinates_dx = dFdx(uv * 2.0); vec2 coordinates_dy = dFdy(uv * 2.0);
            for (int i = 0; float(i) < x && i < 9; i++) {
                c += textureGrad(map, (uv + float(i) * 0.1) * 2.0, coordinates_dx, coordinates_dy);
            }
            return c;
        }
        """,
        "'map' is read here at the level that its coordinates had before",
    )


def test_an_offset_stays_and_a_layer_has_no_slope() -> None:
    becomes(
        """
        uniform sampler2DArray layers;
        vec4 f(vec3 at, float x) {
            vec4 c = vec4(0.0);
            for (int i = 0; float(i) < x && i < 9; i++) {
                at += 0.1;
                c += texture(layers, at) + textureOffset(map, at.xy, ivec2(1, -2), 1.0);
            }
            return c;
        }
        """,
        """
        uniform sampler2DArray layers;
        vec4 f(vec3 at, float x) {
            vec4 c = vec4(0.0);
            vec2 at_dx = dFdx(at.xy); vec2 at_dy = dFdy(at.xy);
            for (int i = 0; float(i) < x && i < 9; i++) {
                at += 0.1;
                c += textureGrad(layers, at, at_dx, at_dy)
                    + textureGradOffset(map, at.xy, at_dx * exp2(1.0), at_dy * exp2(1.0), ivec2(1, -2));
            }
            return c;
        }
        """,
        "'layers' is read here at the level that its coordinates had before",
        "'map' is read here at the level that its coordinates had before",
    )


def test_a_shadow_comparison_reads_level_0() -> None:
    becomes(
        """
        uniform sampler2DShadow shade;
        float f(vec3 at, float x) {
            if (x > 0.0) { at += 0.1; return texture(shade, at); }
            return 0.0;
        }
        """,
        """
        uniform sampler2DShadow shade;
        float f(vec3 at, float x) {
            if (x > 0.0) { at += 0.1; return textureLod(shade, at, 0.0); }
            return 0.0;
        }
        """,
        "'shade' is read at level 0 here",
    )


def test_coordinates_unknown_before_the_branch_read_level_0() -> None:
    becomes(
        """
        float g(float x, out float y) { y = x; return x; }
        vec4 f(vec2 uv, float x) {
            float y; vec4 c = vec4(0.0);
            if (g(x, y) > 0.0) {
                float z; float w = g(x, z);
                c = texture(map, vec2(z)) + texture(other, vec2(y), 2.0) + dFdx(w);
            }
            return c;
        }
        """,
        """
        float g(float x, out float y) { y = x; return x; }
        vec4 f(vec2 uv, float x) {
            float y; vec4 c = vec4(0.0);
            vec2 coordinates_dx = dFdx(vec2(y)); vec2 coordinates_dy = dFdy(vec2(y));
            if (g(x, y) > 0.0) {
                float z; float w = g(x, z);
                c = textureLod(map, vec2(z), 0.0)
                    + textureGrad(other, vec2(y), coordinates_dx * exp2(2.0), coordinates_dy * exp2(2.0)) + 0.0;
            }
            return c;
        }
        """,
        "'map' is read at level 0 here",
        "'other' is read here at the level",
        "dFdx is taken as 0 here",
    )


def test_a_function_that_must_stay_in_the_branch_reads_level_0() -> None:
    becomes(
        """
        float read(vec2 uv, inout float x) { x += texture(map, uv).x; return x; }
        float deeper(vec2 uv, inout float x) { return read(uv, x); }
        float f(vec2 uv, float x) { float y = x; float z = 0.0; if (x > 0.0) { z = deeper(uv, y); } return z + y; }
        """,
        """
        float read(vec2 uv, inout float x) { x += textureLod(map, uv, 0.0).x; return x; }
        float deeper(vec2 uv, inout float x) { return read(uv, x); }
        float f(vec2 uv, float x) { float y = x; float z = 0.0; if (x > 0.0) { z = deeper(uv, y); } return z + y; }
        """,
        "'map' is read at level 0 here",
    )


def test_parameters_vary_with_their_calls() -> None:
    becomes(
        """
        vec4 some(vec2 uv, float a) { vec4 c = vec4(0.0); if (a > 0.0) { c = texture(map, uv); } return c; }
        vec4 same(vec2 uv, float a) { vec4 c = vec4(0.0); if (a > 0.0) { c = texture(map, uv); } return c; }
        vec4 f(vec2 uv, float x) { return some(uv, x) + some(uv, depth) + same(uv, depth); }
        """,
        """
        vec4 some(vec2 uv, float a) {
            vec4 c = vec4(0.0); vec4 map_sample = texture(map, uv); if (a > 0.0) { c = map_sample; } return c;
        }
        vec4 same(vec2 uv, float a) { vec4 c = vec4(0.0); if (a > 0.0) { c = texture(map, uv); } return c; }
        vec4 f(vec2 uv, float x) { return some(uv, x) + some(uv, depth) + same(uv, depth); }
        """,
    )


def test_a_variable_varies_from_its_assignment() -> None:
    becomes(
        """
        vec4 f(vec2 uv, float x) {
            float a = depth; vec4 c = vec4(0.0);
            if (a > 0.0) { c += texture(map, uv); }
            for (int i = 0; i < 4; i++) { if (a > 1.0) { c += texture(other, uv); } a = c.x; }
            a = depth;
            if (a > 2.0) { c += texture(map, uv); }
            if (x > 0.0) { a = 3.0; }
            if (a > 2.0) { c += texture(map, uv); }
            return c;
        }
        """,
        """
        vec4 f(vec2 uv, float x) {
            float a = depth; vec4 c = vec4(0.0);
            if (a > 0.0) { c += texture(map, uv); }
            for (int i = 0; i < 4; i++) {
                vec4 other_sample = texture(other, uv); if (a > 1.0) { c += other_sample; } a = c.x;
            }
            a = depth;
            if (a > 2.0) { c += texture(map, uv); }
            if (x > 0.0) { a = 3.0; }
            vec4 map_sample = texture(map, uv);
            if (a > 2.0) { c += map_sample; }
            return c;
        }
        """,
    )


def test_functions_that_entries_do_not_reach_are_left_alone() -> None:
    stays(
        """
        vec4 f(vec2 uv) { return texture(map, uv); }
        vec4 g(vec2 uv) { if (uv.x > 0.0) { return texture(map, uv); } return vec4(0.0); }
        """
    )


@given(st.integers(0, 1 << 32), st.booleans())
@settings(max_examples=60)
def test_tint_finds_all_flow_uniform(compiler: Callable[[str], Compiler], seed: int, discards: bool) -> None:
    module = module_for(seed, discards)
    try:
        files = transpile(module, "wgsl", "random").files
    except SssgenError:  # a division by a constant 0
        reject()
    (library,) = [text for name, text in files.items() if name.endswith(".wgsl")]
    source = Source(library + _entry(library), "wgsl", name=f"seed {seed}")
    assert not errors(compiler("tint").check(source))


def _entry(library: str) -> str:
    """A fragment shader that calls `f` with a uniform's members where requested, and else with varying values."""
    (function,) = [function for function in functions(library, wgsl=True) if function.name == "f"]
    inputs, before, args = [], [], []
    for place, (kind, name, _) in enumerate(function.parameters):
        if kind.startswith("texture") or kind == "sampler":
            args.append("bound_map" if kind.startswith("texture") else "bound_sampler")
        elif name in ("level", "mode", "tint"):
            args.append(f"bound.{name}")
        else:
            pointer = kind.startswith("ptr")
            inputs.append(f"@location({place}) @interpolate(flat) in{place}: {'f32' if pointer else kind}")
            if pointer:
                before.append(f"var held{place} = inputs.in{place};")
            args.append(f"&held{place}" if pointer else f"inputs.in{place}")
    return f"""
struct Inputs {{ {", ".join(inputs)} }}
struct Bound {{ level: f32, mode: i32, tint: vec3f }}
@group(0) @binding(0) var<uniform> bound: Bound;
@group(0) @binding(1) var bound_map: texture_2d<f32>;
@group(0) @binding(2) var bound_sampler: sampler;
@fragment fn main(inputs: Inputs) -> @location(0) vec4f {{
    {" ".join(before)}
    return vec4f(f({", ".join(args)}));
}}
"""
