"""GLSL as Vulkan's and OpenGL's shaders use it: blocks, buffers, separate textures, sizes of workgroups."""

from __future__ import annotations

import pytest

from qualification.suites.compiled_texts import complaint
from sssgen.ir.nodes import Module
from sssgen.ir.types import spell
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import Compiled, transpile
from sssgen.pipeline.two_stages import Source, transpile_stages
from sssgen.support.diagnostics import SssgenError

BUFFERS = """#version 450
layout(location = 0) out vec4 color;
layout(std430, binding = 3) readonly buffer Points { uint count; vec4 points[]; } cloud;
layout(std430, binding = 4) buffer Hits { uint hits[]; };
void main() {
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < cloud.count; i++) { sum += cloud.points[i % uint(cloud.points.length())]; }
    atomicAdd(hits[int(sum.x)], 1u);
    color = sum;
}
"""
SEPARATE = """#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
layout(set = 0, binding = 0) uniform texture2D image;
layout(set = 0, binding = 1) uniform sampler reads;
layout(set = 0, binding = 2) uniform texture2D depths;
layout(set = 0, binding = 3) uniform samplerShadow compares;
layout(set = 0, binding = 4) uniform texture2DArray layers[2];
layout(set = 0, binding = 5) uniform texture2D depths_too;
vec4 twice(texture2D t, sampler s, vec2 at) { return 2.0 * texture(sampler2D(t, s), at); }
float seen(samplerShadow s, texture2D t, vec3 at) { return texture(sampler2DShadow(t, s), at); }
float seen_twice(texture2D t, samplerShadow s) { return seen(s, t, vec3(0.5)); }
void main() {
    color = twice(image, reads, uv) + texture(sampler2D(image, reads), uv) + texelFetch(image, ivec2(0), 0);
    color.x += texture(sampler2DShadow(depths, compares), vec3(uv, 0.5)) + seen_twice(depths_too, compares);
    color.y += texture(sampler2DArray(layers[1], reads), vec3(uv, 1.0)).x;
}
"""


def load(text: str, label: str) -> Module:
    return load_glsl_text(text, label).module


def emitted(text: str, label: str, target: str) -> Compiled:
    return transpile(load(text, label), target, "shader", keep=True)


def first(compiled: Compiled) -> str:
    return next(iter(compiled.files.values()))


def test_members_of_a_block_take_the_locations_after_its_own() -> None:
    text = (
        "#version 450\nlayout(location = 2) out Vertex {\n"
        "    vec3 a; mat2 b; layout(location = 9) float c; vec2 d[2];\n} v;\n"
        "void main() { v.a = vec3(1.0); gl_Position = vec4(0.0); }\n"
    )
    places = {variable.name: variable.location for variable in load(text, "block.vert").variables}
    assert places == {"Vertex_a": 2, "Vertex_b": 3, "Vertex_c": 9, "Vertex_d": 10, "gl_Position": -1}


@pytest.mark.parametrize("target", ["wgsl", "hlsl", "glsl-330"])
def test_a_fragment_shader_has_storage_buffers(target: str) -> None:
    pytest.importorskip("wgpu", reason="wgpu is missing: pip install -e '.[webgpu]'")
    compiled = emitted(BUFFERS, "buffers.frag", target)
    assert not complaint(compiled.files)
    assert [buffer["block"] for buffer in compiled.reflection["storage_buffers"]] == ["Points", "Hits"]
    assert "workgroup_size" not in compiled.reflection


def test_a_vertex_shader_of_wgsl_reads_storage_buffers_alone() -> None:
    text = BUFFERS.replace("layout(location = 0) out vec4 color;", "").replace("color =", "gl_Position =")
    reading = text.replace("atomicAdd(hits[int(sum.x)], 1u);", "sum.x += float(hits[0]);")
    assert "var<storage, read> hits_buffer" in first(emitted(reading, "buffers.vert", "wgsl"))
    with pytest.raises(SssgenError, match="cannot write the storage buffer 'hits_buffer'"):
        emitted(text, "buffers.vert", "wgsl")
    assert "InterlockedAdd" in first(emitted(text, "buffers.vert", "hlsl"))


def test_what_has_no_storage_buffers() -> None:
    for target in ("glsl-es-300", "numpy"):
        with pytest.raises(SssgenError, match="'cloud' is a storage buffer, which this target lacks"):
            emitted(BUFFERS, "buffers.frag", target)
    with pytest.raises(SssgenError, match="a shader with memory takes no guards"):
        transpile(load(BUFFERS, "buffers.frag"), "wgsl", "shader", "all")
    vertex = load("#version 450\nvoid main() { gl_Position = vec4(0.0); }\n", "a.vert")
    with pytest.raises(SssgenError, match="a shader with memory takes no guards"):
        transpile_stages(Source(vertex), Source(load(BUFFERS, "buffers.frag")), "wgsl", "program", "all")


def test_separate_textures_are_one_with_their_samplers() -> None:
    module = load(SEPARATE, "separate.frag")
    assert [uniform.name for uniform in module.uniforms] == ["image", "depths", "layers_0", "layers_1", "depths_too"]
    text = first(transpile(module, "glsl-330", "shader", keep=True))
    assert "float seen(sampler2DShadow t, vec3 at)" in text and "sampler2DShadow depths_too;" in text
    assert "uniform sampler2DShadow depths;" in text and "vec4 twice(sampler2D t, vec2 at)" in text
    assert "twice(image, uv) + texture(image, uv) + texelFetch(image, ivec2(0), 0)" in text
    pytest.importorskip("wgpu", reason="wgpu is missing: pip install -e '.[webgpu]'")
    for target in ("wgsl", "hlsl"):
        assert not complaint(transpile(module, target, "shader", keep=True).files)


def test_an_array_of_blocks_is_a_block_for_each_element() -> None:
    text = (
        "#version 450\nlayout(location = 0) out vec4 color;\n"
        "layout(location = 1) in Vertex { vec3 a; vec2 b; } v[2];\n"
        "layout(std140, binding = 2) uniform Camera { vec3 eye; mat4 view; } cameras[2];\n"
        "layout(std430, binding = 5) buffer Data { uint n; float x[]; } data[2];\n"
        "void main() { color = vec4(cameras[1].eye + v[1].a, data[1].x[2]); atomicAdd(data[0].n, 2u); }\n"
    )
    module = load(text, "arrays.frag")
    places = {variable.name: variable.location for variable in module.variables if variable.name != "color"}
    assert places == {"Vertex_0_a": 1, "Vertex_0_b": 2, "Vertex_1_a": 3, "Vertex_1_b": 4, "data_0": 5, "data_1": 6}
    assert [uniform.source for uniform in module.uniforms if "eye" in uniform.name] == [
        "Camera[0].eye",
        "Camera[1].eye",
    ]
    pytest.importorskip("wgpu", reason="wgpu is missing: pip install -e '.[webgpu]'")
    for target in ("wgsl", "hlsl", "glsl-330"):
        assert not complaint(transpile(module, target, "shader", keep=True).files)


def test_sizes_of_workgroups() -> None:
    body = "layout(push_constant, std430) uniform Push { uint by[3]; } push;\nvoid main() { memoryBarrierImage(); }\n"
    assert load("#version 450\n" + body, "a.comp").workgroup == (1, 1, 1)
    assert load("#version 450\nlayout(local_size_x_id = 3, local_size_y = 2) in;\n" + body, "a.glsl").workgroup == (
        1,
        2,
        1,
    )
    used = "#version 450\nbuffer A { uint a[]; };\nvoid main() { a[gl_LocalInvocationIndex] = gl_WorkGroupID.x; }\n"
    assert load(used, "a.glsl").workgroup == (1, 1, 1)


def test_variables_of_a_draw_by_their_first_names() -> None:
    text = "#version 450\nvoid main() { gl_Position = vec4(gl_BaseVertexARB, gl_BaseInstanceARB, gl_DrawIDARB, 1); }\n"
    assert {uniform.name for uniform in load(text, "a.vert").uniforms} == {
        "gl_BaseVertexARB", "gl_BaseInstanceARB", "gl_DrawIDARB",
    }  # fmt: skip


def test_an_atomic_of_a_component_beside_a_copied_array() -> None:
    text = (
        "#version 450\nlayout(local_size_x = 1) in;\nstruct Ray { float far; };\n"
        "buffer A { uvec2 pair; Ray first; Ray rays[]; } a;\n"
        "void main() { atomicAdd(a.pair.y, 1u); a.first = a.rays[1]; }\n"
    )
    with pytest.raises(SssgenError, match="works on a component of a vector"):
        emitted(text, "a.comp", "wgsl")


def test_swizzles_of_a_number() -> None:
    head = "#version 420\nin float x;\nout vec4 color;\n"
    text = first(emitted(f"{head}void main() {{ color = vec4((x * 2.0).xxx, 3u.r); }}", "a.frag", "wgsl"))
    assert "color = vec4f(vec3f(x * 2.0), 3.0);" in text
    with pytest.raises(SssgenError, match="a float has no member 'xy'"):
        load(f"{head}void main() {{ color.rg = x.xy; }}", "a.frag")
    mobile = "#version 300 es\nprecision highp float;\nfloat f(float x) { return x.x; }\n"
    with pytest.raises(SssgenError, match="a float has no member 'x'"):
        load(mobile, "a.frag")


def test_global_variables_begin_with_calls() -> None:
    """main() sets them, and those after them that are not constant, in their order."""
    text = """#version 330
uniform float time;
out vec4 color;
float first = time;
float twice(float x) { return 2.0 * x; }
float second = twice(first);
float third = second + first;
float fourth = 4.0;
void main() { float first = third; color = vec4(first, second, third, fourth); }
"""
    emitted_text = first(emitted(text, "a.frag", "wgsl"))
    order = ["first = material.time;", "second = twice(first);", "third = second + first;", "first_ = third"]
    places = [emitted_text.index(part) for part in order]
    assert places == sorted(places) and "fourth: f32 = 4.0;" in emitted_text
    with pytest.raises(SssgenError, match=r"no main\(\) that could set it"):
        load("#version 330\nfloat one() { return 1.0; }\nfloat x = one();\n", "a.frag")


def test_lengths_by_use() -> None:
    text = (
        "#version 450\nout vec4 color;\nuniform vec4 tints[];\nuniform float gains[2] = {1.0, 0.5};\n"
        "vec2 a[];\nvec2 b[];\nvec2 b[4];\nvoid main() { a[1] = vec2(1.0); b[2] = a[0]; color = tints[6] * a[1].x; }\n"
    )
    module = load(text, "case.frag")
    lengths = {each.name: spell(each.type) for each in (*module.uniforms, *module.variables)}
    assert lengths == {"tints": "vec4[7]", "gains": "float[2]", "color": "vec4", "a": "vec2[2]", "b": "vec2[4]"}
    assert module.uniforms[1].default == (1.0, 0.5)


LENGTHS_BY_SCOPE = {
    "float a[]; float f() { const int k = 2, m = k * 3 + 1; a[m] = 1.0; return a[0]; }": 8,
    "const int K = 3; float a[]; float f() { a[K - 1] = 1.0; { const int K = 9; a[K / 2] = 1.0; } return a[0]; }": 5,
    "float a[]; float g() { float a[9]; return a[8]; } float f() { return a[1]; }": 2,
    "float a[]; float g(float a[9]) { return a[8]; } float f() { return a[1]; }": 2,
    "struct S { float a[9]; }; float a[]; float f() { S s; s.a[8] = 1.0; return a[1]; }": 2,
    "float a[]; float f() { { float a[9]; a[8] = 1.0; } for (float a[9];;) { a[8] = 1.0; break; } return a[1]; }": 2,
    "float a[]; uniform B { float x[9]; } b; float f() { return a[1] + b.x[8]; }": 2,
    "float a[]; float f() { return 1.0; }": 1,
    "float a[]; const int N = 2; float a[N]; float f() { return a[0]; }": 2,
}


@pytest.mark.parametrize("text", LENGTHS_BY_SCOPE)
def test_lengths_by_use_are_counted_by_scope(text: str) -> None:
    variables = load(f"#version 450\n{text}\n", "case.glsl").variables
    assert [spell(each.type) for each in variables if each.name == "a"] == [f"float[{LENGTHS_BY_SCOPE[text]}]"]


def test_the_length_by_use_of_a_local_variable() -> None:
    text = "int f() { float a[]; { float a[]; a[7] = 1.0; } a[1] = 3.0; return a.length(); }\n"
    emitted_text = first(emitted(text, "a.glsl", "glsl-330"))
    assert "float a[2]" in emitted_text and "return 2;" in emitted_text


@pytest.mark.parametrize("first", ["index = 1", "component = 1"])
def test_outputs_that_share_a_location(first: str) -> None:
    text = (
        f"#version 450\nlayout(location = 0) out float a;\nlayout(location = 0, {first}) out float b;\n"
        "void main() { a = b = 1.0; }\n"
    )
    assert [variable.location for variable in load(text, "case.frag").variables] == [0, 0]


def test_the_layout_of_buffers_that_follow() -> None:
    """`layout(std140) buffer;` alone: an element of an array is 16 bytes behind the one before it, of std430 4."""
    text = (
        "#version 450\nlayout(local_size_x = 1) in;\nlayout(std140) buffer;\nbuffer Wide { float x[4]; };\n"
        "layout(std430) buffer;\nbuffer Narrow { float y[4]; };\nvoid main() { y[1] = x[1]; }\n"
    )
    layouts = [variable.layout for variable in load(text, "case.comp").variables]
    assert layouts == ["std140", "std430"]
    assert "narrow[1] = asfloat(wide.Load(16));" in first(emitted(text, "case.comp", "hlsl"))


def test_what_reads_a_writeonly_buffer_takes_the_word_away() -> None:
    """Atomics and out arguments read, too, and drivers refuse that of writeonly buffers."""
    text = (
        "#version 430\nlayout(local_size_x = 4) in;\n"
        "layout(std430, binding = 0) writeonly buffer Counts { uint total; };\n"
        "layout(std430, binding = 1) writeonly buffer Wholes { float whole[]; };\n"
        "layout(std430, binding = 2) writeonly buffer Parts { float part[]; };\n"
        "layout(std430, binding = 3) writeonly buffer Copies { float copied[]; };\n"
        "void main() {\n    uint at = atomicAdd(total, 1u);\n    part[at] = modf(float(at) * 0.3, whole[at]);\n"
        "    whole[at + 1u] = float(at);\n    copied[at] = copied[at + 1u];\n}\n"
    )
    compiled = emitted(text, "parts.comp", "glsl-330")
    assert not complaint(compiled.files)
    access = {buffer["block"]: buffer["access"] for buffer in compiled.reflection["storage_buffers"]}
    assert access == {"Counts": "read_write", "Wholes": "read_write", "Parts": "writeonly", "Copies": "read_write"}
