"""The stand-in for Metal's library is strict, structs have the layout that the reflection states, examples run."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import sssgen
from folders import EXAMPLES
from slow_cases import some_slow
from sssgen.ir.types import FLOAT
from sssgen.material.material_loading import examples
from sssgen.run import backends
from sssgen.run.backends import Backend, Call, Text
from sssgen.run.compilers import Compiler, Source, errors
from sssgen.run.render.metal_values import material_block
from sssgen.run.render.scene_render import render
from sssgen.scene.scene_loading import load

WRONG = [
    ("rsqrt(dot(x, x))", "inversesqrt(dot(x, x))", "'inversesqrt' was not declared"),
    ("albedo = texel.xyz", "albedo = texel.xy", "no match for 'operator='"),
    ("across = T * surface", "across = input.uv * surface", "no match for 'operator+'"),
    ("material.distortion", "material.subsurface_color", "cannot convert"),
    ("thread float3& albedo", "float3& albedo", "the reference 'albedo' has no address space"),
    ("constant float JITTER", "const float JITTER", "'JITTER' has no address space"),
    ("constant Material& material", "Material& material", "the reference 'material' has no address space"),
    ("discard_fragment();", "discard;", "'discard' was not declared"),
    (".sample(base_color_texture_sampler, uv)", ".sample(uv)", "no matching function"),
    ("max(dot(to_light, to_light), 0.0001)", "max(to_light, 0.0001)", "no matching function"),
    ("fragment float4 fragment_main", "fragment float4 main_2", "there is no fragment function fragment_main"),
    ("float3 color = lights.ambient", "lights.count = 2;\n    float3 color = lights.ambient", "read-only"),
]  # fmt: skip


@pytest.mark.parametrize(("right", "wrong", "message"), WRONG, ids=[wrong[1][:24] for wrong in WRONG])
def test_invalid_text_is_refused(right: str, wrong: str, message: str, compiler: Callable[[str], Compiler]) -> None:
    text = sssgen.compile("ice", "metal").files["ice.metal"]
    assert text.count(right) >= 1
    source = Source(text.replace(right, wrong, 1), "metal", "fragment", "fragment_main")
    reported = errors(compiler("metal").check(source))
    found = [re.sub("[‘’]", "'", error.text) for error in reported]
    assert any(message in one for one in found), found
    line = text[: text.index(right)].count("\n") + 1
    if "fragment function" not in message:
        assert any(abs(error.line - line) <= 2 for error in reported), (line, reported)


KINDS = """
uniform float first = 0.5;
uniform vec3 color = vec3(1.0, 2.0, 3.0);
uniform bool on = true;
uniform mat3 turn;
uniform vec2 pair = vec2(4.0, 5.0);
uniform float row[3];
uniform mat2 small;
uniform ivec3 steps = ivec3(1, -2, 3);
uniform vec3 colors[2];
uniform bvec2 flags;
uniform uint bits = 7u;
/** Uses all of them.
role: surface
*/
void kinds(vec2 uv, out vec3 albedo)
{
    float sum = row[1] + float(bits & 15u) + (turn * color).x + (small * pair).y + float(steps.y) + first + colors[1].y;
    albedo = vec3(on || flags.y ? sum : uv.x);
}
"""


def test_the_layout_of_the_uniforms(tmp_path: Path, backend: Callable[[str], Backend]) -> None:
    """The compiler's offsets and size of `Material` are those of the reflection."""
    (tmp_path / "kinds.sss").write_text(KINDS, encoding="utf-8")
    path = tmp_path / "kinds.toml"
    path.write_text('[material]\nname = "kinds"\n[[surface]]\ntechnique = "./kinds.sss"\n', encoding="utf-8")
    compiled = sssgen.compile(str(path), "metal")
    reflection = compiled.reflection
    places = {uniform["name"]: uniform["offset"] for uniform in reflection["uniforms"]}
    assert len(places) == 11
    checks = [f"static_assert(__builtin_offsetof(Material, {name}) == {at});" for name, at in places.items()]
    checks.append(f"static_assert(sizeof(Material) == {reflection['uniform_block_size']});")
    text = compiled.files["kinds.metal"] + "\n".join(checks) + "\nfloat one(float x) { return x + 1.0; }\n"
    (result,) = backend("metal").run(Text(text), [Call("one", (FLOAT,), FLOAT, (np.array([1.0, 2.0]),))])
    np.testing.assert_array_equal(result, [2.0, 3.0])
    block = material_block(reflection, {})
    assert np.frombuffer(block, np.float32, 3, places["color"]).tolist() == [1.0, 2.0, 3.0]
    assert np.frombuffer(block, np.int32, 3, places["steps"]).tolist() == [1, -2, 3] and block[places["on"]] == 1


@pytest.mark.parametrize("name", some_slow([name for name in examples() if name != "marble_idol"], "ice", "jelly"))
def test_examples_equal_numpy(name: str, backend: Callable[[str], Backend]) -> None:
    scene = load(EXAMPLES / name / "scene.toml")
    shown, oracle = (render(scene, one, (48, 36)).encoded for one in (backend("metal"), backends.get("numpy")))
    assert np.ptp(oracle) > 0.3
    assert np.abs(shown - oracle).max() < 1.0 / 255.0


def test_derivatives_are_of_the_quad(backend: Callable[[str], Backend]) -> None:
    text = (
        "#include <metal_stdlib>\nusing namespace metal;\nfloat f(float x) { return dfdx(x * x) + 100.0 * dfdy(x); }\n"
    )
    x = np.arange(8.0)  # two rows of four
    (result,) = backend("metal").run(Text(text), [Call("f", (FLOAT,), FLOAT, (x,))])
    np.testing.assert_array_equal(result, [401, 401, 405, 405, 409, 409, 413, 413])


def test_a_pixel_is_discarded_alone(backend: Callable[[str], Backend]) -> None:
    text = (
        "#include <metal_stdlib>\nusing namespace metal;\n"
        "float f(float x) {\n    if (x > 2.0) {\n        discard_fragment();\n    }\n    return x + dfdx(x);\n}\n"
    )
    (result,) = backend("metal").run(Text(text), [Call("f", (FLOAT,), FLOAT, (np.arange(4.0),))])
    np.testing.assert_array_equal(result, [1.0, 2.0, 3.0, 0.0])


def test_vectors_of_integers_are_changed_in_place(backend: Callable[[str], Backend]) -> None:
    text = (
        "#include <metal_stdlib>\nusing namespace metal;\n"
        "float f(float x) {\n    uint3 a = uint3(uint(x), 7u, 9u);\n    a %= uint3(4u);\n    a.xy <<= 1u;\n"
        "    a.yz |= uint2(8u, 16u);\n    return float(a.x * 10000u + a.y * 100u + a.z);\n}\n"
    )
    (result,) = backend("metal").run(Text(text), [Call("f", (FLOAT,), FLOAT, (np.array([6.0, 9.0]),))])
    np.testing.assert_array_equal(result, [41417.0, 21417.0])
