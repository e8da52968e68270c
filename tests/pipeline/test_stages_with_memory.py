"""Storage buffers and images of the two stages of a program are one memory: `sssgen transpile --stages`."""

from __future__ import annotations

import json
import re

import pytest

from qualification.suites.compiled_texts import complaint
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.two_stages import Source, TranslatedProgram, transpile_stages
from sssgen.support.diagnostics import SssgenError

VERTEX = """#version 450
struct Bone { mat4 place; vec4 tint; };
layout(std430, binding = 3) buffer Bones { Bone bones[]; } skeleton;
layout(std430) readonly buffer Scale { float scale[]; } extra;
layout(std430) readonly buffer Unused { float never[]; };
in vec3 position;
in int bone;
out vec4 tint;
void main() {
    tint = skeleton.bones[bone].tint;
    gl_Position = skeleton.bones[bone].place * vec4(position * extra.scale[0], 1.0);
}
"""
FRAGMENT = """#version 450
layout(std430) buffer Counts { uint counts[]; };
struct Bone { mat4 place; vec4 tint; };
layout(std430, binding = 3) buffer Bones { Bone bones[]; } mine;
layout(r32f, binding = 4) readonly uniform image2D heights;
layout(rgba8) writeonly uniform image2D picture;
uniform sampler2D map;
in vec4 tint;
out vec4 color;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    counts[at.x] += 1u;
    color = tint * mine.bones[0].tint + imageLoad(heights, at) + texture(map, tint.xy);
    imageStore(picture, at, color);
}
"""


def translate(vertex: str, fragment: str, target: str = "wgsl") -> TranslatedProgram:
    stages = [load_glsl_text(text, name) for text, name in ((vertex, "a.vert"), (fragment, "b.frag"))]
    first, second = [Source(stage.module, stage.head) for stage in stages]
    return transpile_stages(first, second, target, "pair")


def test_each_buffer_and_image_has_one_binding() -> None:
    vertex, fragment, text = translate(VERTEX, FRAGMENT).files.values()
    assert re.findall(r"@binding\((\d+)\) var<storage, (\w+)> (\w+)", vertex) == [
        ("3", "read", "skeleton"), ("4", "read", "extra"),
    ]  # fmt: skip
    assert "@group(0) @binding(3) var<storage, read> mine: Bones;" in fragment
    assert "@group(0) @binding(5) var<storage, read_write> counts_buffer: Counts;" in fragment
    assert "@group(0) @binding(6) var heights: texture_storage_2d<r32float, read>;" in fragment
    program = json.loads(text)
    assert [(each["block"], each["access"], each["stages"]) for each in program["storage_buffers"]] == [
        ("Bones", "readonly", ["vertex", "fragment"]), ("Scale", "readonly", ["vertex"]),
        ("Counts", "read_write", ["fragment"]),
    ]  # fmt: skip
    assert [(each["name"], each["binding"]) for each in program["storage_images"]] == [
        ("heights", {"binding": 6}), ("picture", {"binding": 7}),
    ]  # fmt: skip


@pytest.mark.parametrize("target", ["wgsl", "hlsl", "glsl-330"])
def test_compilers_accept_both_stages(target: str) -> None:
    assert complaint(translate(VERTEX, FRAGMENT, target).files) == ""


def test_bindings_of_the_source_stay_and_others_are_free() -> None:
    vertex, fragment, _ = translate(VERTEX, FRAGMENT, "glsl-330").files.values()
    assert re.findall(r"binding = (\d)\) (?:readonly )?buffer (\w+)", vertex) == [("3", "Bones"), ("0", "Scale")]
    assert re.findall(r"binding = (\d)\) (?:readonly )?buffer (\w+)", fragment) == [("1", "Counts"), ("3", "Bones")]
    assert re.findall(r"binding = (\d)\) \w+ uniform image2D (\w+)", fragment) == [("4", "heights"), ("2", "picture")]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("vec4 tint; };", "vec4 tint; vec4 more; };", r"'Bones' is a struct .* in a\.vert:3:"),
        ("binding = 3", "binding = 2", r"'Bones' is binding = 3 in a\.vert:3:\d+, but binding = 2 here"),
        ("std430, binding = 3", "std140, binding = 3", r"'Bones' is std430 in a\.vert:3:\d+, but std140 here"),
        (
            "buffer Counts { uint counts[]; };",
            "buffer Counts { uint counts[]; };\nbuffer Others { float never[]; };",
            r"the storage buffer 'Unused' has a 'never', too, in a\.vert:5:\d+\n",
        ),
        (
            "    counts[at.x] += 1u;",
            "mine.bones[at.x].tint = tint;",
            r"'mine' is used by the vertex shader, too, .*\(wgsl",
        ),
    ],
)
def test_memory_that_differs(old: str, new: str, message: str) -> None:
    with pytest.raises(SssgenError, match=message):
        translate(VERTEX, FRAGMENT.replace(old, new))


def test_a_buffer_has_an_instance_name_in_both_stages() -> None:
    fragment = FRAGMENT.replace("} mine;", "};").replace("mine.", "")
    message = r"'Bones' is with an instance name in a\.vert:3:\d+, but without an instance name here"
    with pytest.raises(SssgenError, match=message):
        translate(VERTEX, fragment)


def test_other_targets_write_what_the_vertex_shader_reads() -> None:
    fragment = FRAGMENT.replace("counts[at.x] += 1u;", "mine.bones[at.x].tint = tint;")
    vertex, text, _ = translate(VERTEX, fragment, "hlsl").files.values()
    assert "RWByteAddressBuffer skeleton : register(u3);" in vertex
    assert "RWByteAddressBuffer mine : register(u3);" in text


def test_a_target_without_memory_says_so_first() -> None:
    fragment = FRAGMENT.replace("counts[at.x] += 1u;", "mine.bones[at.x].tint = tint;")
    with pytest.raises(SssgenError, match=r"is a storage buffer, which this target lacks \(glsl-es-300\)"):
        translate(VERTEX, fragment, "glsl-es-300")
    vertex = "#version 430\nlayout(r32f) uniform image2D map;\n"
    vertex += "void main() { gl_Position = imageLoad(map, ivec2(0)); }\n"
    fragment = "#version 430\nlayout(r32f) uniform image2D map;\nout vec4 color;\n"
    fragment += "void main() { imageStore(map, ivec2(1), vec4(1)); color = vec4(1); }\n"
    with pytest.raises(SssgenError, match=r"'map' is an image, which this target lacks \(glsl-es-300\)"):
        translate(vertex, fragment, "glsl-es-300")
    with pytest.raises(SssgenError, match=r"'map' is used by the vertex shader, too, .*\(wgsl"):
        translate(vertex, fragment)


def test_registers_that_would_differ() -> None:
    image = "layout(r32f, binding = 3) uniform image2D heights;\n"
    vertex = VERTEX.replace("in vec3", image + "in vec3").replace("tint = ", "tint = imageLoad(heights, ivec2(0)) + ")
    fragment = FRAGMENT.replace("layout(r32f, binding = 4) readonly uniform image2D heights;\n", image)
    vertex = vertex.replace("layout(std430, binding = 3) buffer Bones", "layout(std430, binding = 5) buffer Bones")
    fragment = fragment.replace("layout(std430, binding = 3) buffer Bones", "layout(std430, binding = 5) buffer Bones")
    translate(vertex, fragment, "hlsl")
    fragment = fragment.replace("layout(std430) buffer Counts", "layout(std430, binding = 3) buffer Counts")
    with pytest.raises(SssgenError, match="'heights' has the binding 3 in one stage, and 4 in the other"):
        translate(vertex, fragment, "hlsl")
