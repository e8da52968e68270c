"""Both stages of a program translated together: `sssgen transpile --stages` and its reflection."""

from __future__ import annotations

import json
from typing import Any

import pytest

from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.two_stages import Source, TranslatedProgram, transpile_stages
from sssgen.run import compilers
from sssgen.support.diagnostics import SssgenError
from sssgen.targets.program_reflection import ROWS

VERTEX = """#version 300 es
struct Light { vec3 color; float weights[2]; };
uniform mat4 view;
uniform mat3 turn;
uniform Light lights[2];
uniform bool isWide;
uniform float unused;
uniform sampler2D bones;
in vec3 position;
in mat4 place;
in vec2 spare;
out vec2 at;
flat out int side;
out vec3 notRead;
void main() {
    at = position.xy;
    side = 1;
    notRead = turn * position;
    gl_Position = view * place * texelFetch(bones, ivec2(0), 0);
    if (isWide) { gl_Position.x += lights[1].weights[1]; }
}
"""
FRAGMENT = """#version 300 es
precision highp float;
struct Light { vec3 color; float weights[2]; };
uniform Light lights[2];
uniform sampler2D map, maps[3];
uniform mat4 view;
uniform float position;
in vec2 at;
flat in int side;
in vec4 never;
out vec4 color;
vec4 read(sampler2D which) { return texture(which, at); }
void main() {
    color = read(map) * position + texture(maps[1], at) * lights[0].color.xyzx + view[side];
    color.x += 0.5 + dFdy(at.y) + gl_FragCoord.y;
}
"""


def translate(vertex: str, fragment: str, target: str = "wgsl", rows: str = ROWS[0]) -> TranslatedProgram:
    stages = [load_glsl_text(text, name) for text, name in ((vertex, "a.vert"), (fragment, "b.frag"))]
    first, second = [Source(stage.module, stage.head) for stage in stages]
    return transpile_stages(first, second, target, "pair", rows=rows)


def described(program: TranslatedProgram) -> dict[str, Any]:
    result: dict[str, Any] = json.loads(program.files["pair.program.json"])
    return result


def test_both_stages_declare_the_same_block_and_textures() -> None:
    program = translate(VERTEX, FRAGMENT)
    blocks = []
    for stage in ("vertex", "fragment"):
        text = program.files[f"pair.{stage}.wgsl"]
        members = text[text.index("struct Material {") : text.index("var<private>")].splitlines()
        blocks.append([line.split(":")[-1] if "@" not in line else line.split(" var")[0] for line in members])
    assert blocks[0] == blocks[1]


def test_what_the_program_does_not_use_is_left_out() -> None:
    program = described(translate(VERTEX, FRAGMENT))
    assert [attribute["name"] for attribute in program["attributes"]] == ["position", "place"]
    assert [varying["name"] for varying in program["varyings"]] == ["at", "side"]
    names = {uniform["name"] for uniform in program["uniforms"]}
    assert names == {"view", "turn", "lights[].weights", "isWide", "lights[].color", "position"}
    assert [texture["name"] for texture in program["textures"]] == ["bones", "map", "maps[1]"]


def test_the_reflection_of_a_program() -> None:
    program = described(translate(VERTEX, FRAGMENT))
    uniforms = {uniform.pop("name"): uniform for uniform in program["uniforms"]}
    assert uniforms["lights[].weights"] == {
        "stages": ["vertex"], "type": "float", "lengths": [2, 2], "offset": 112, "size": 52, "array_stride": 16,
        "matrix_stride": 0,
    }  # fmt: skip
    assert uniforms["view"]["stages"] == ["vertex", "fragment"]
    assert (uniforms["turn"]["type"], uniforms["turn"]["matrix_stride"]) == ("mat3", 16)
    attribute = program["attributes"][1]
    assert attribute == {"name": "place", "type": "mat4", "location": 1, "locations": 4, "format": "float32x4"}
    textures = {texture["name"]: texture for texture in program["textures"]}
    assert (textures["bones"]["filterable"], textures["bones"]["sampler"]) == (False, "")
    assert (textures["map"]["filterable"], textures["map"]["sampler"]) == (True, "filtering")  # by a function
    assert textures["bones"]["stages"] == ["vertex"]
    places = [number for texture in program["textures"] for number in list(texture["binding"].values())[1:]]
    assert places == list(range(1, 7))
    interpolations = {varying["name"]: varying["interpolation"] for varying in program["varyings"]}
    assert interpolations == {"at": "smooth", "side": "flat"}
    assert program["outputs"] == [{"name": "color", "path": [], "type": "vec4", "location": 0}]


def test_the_order_of_the_stages_is_free() -> None:
    stages = [load_glsl_text(text, name) for text, name in ((VERTEX, "a.vert"), (FRAGMENT, "b.frag"))]
    sources = [Source(stage.module, stage.head) for stage in stages]
    in_order, swapped = (transpile_stages(*each, "wgsl", "pair") for each in (sources, sources[::-1]))
    assert in_order.files == swapped.files
    assert in_order.renames == swapped.renames[::-1]


def test_the_rows_of_a_picture() -> None:
    turned, upright = (translate(VERTEX, FRAGMENT, rows=rows) for rows in ("bottom-first", "top-first"))
    assert "Position.y = -Position.y;" in turned.files["pair.vertex.wgsl"]
    assert "+ dpdy(at.y)" in turned.files["pair.fragment.wgsl"]
    assert not turned.warnings
    assert "Position.y = " not in upright.files["pair.vertex.wgsl"]
    assert "(-dpdy(at.y))" in upright.files["pair.fragment.wgsl"]
    assert "gl_FragCoord.y counts from the top" in upright.warnings[0].message
    assert [described(program)["rows"] for program in (turned, upright)] == ["bottom-first", "top-first"]


@pytest.mark.parametrize("target", ["glsl-330", "glsl-es-300", "hlsl"])
def test_other_languages(target: str) -> None:
    program = described(translate(VERTEX, FRAGMENT, target))
    assert ("offset" in program["uniforms"][0]) == (target == "hlsl")
    assert len({uniform["name"] for uniform in program["uniforms"]}) == 6


def test_mismatches_name_both_places() -> None:
    body = "void main() { at = tint.xy; gl_Position = vec4(p, 1.0); }\n"
    vertex = f"uniform vec3 tint;\nattribute vec3 p;\nvarying vec2 at;\n{body}"
    body = "void main() { gl_FragColor = tint + at.xyzz + gone.xyxy; }\n"
    fragment = f"uniform vec4 tint;\nvarying vec3 at;\nvarying vec2 gone;\n{body}"
    with pytest.raises(SssgenError) as error:
        translate(vertex, fragment)
    messages = [(each.message, each.span.file, each.span.line) for each in error.value.diagnostics]
    assert messages == [
        ("the vertex shader writes 'at' as a vec2 (a.vert:3:14), but the fragment shader reads a vec3", "b.frag", 2),
        ("the vertex shader a.vert does not write 'gone', which the fragment shader reads", "b.frag", 3),
        ("the uniform 'tint' is a vec3 in a.vert:1:14, but a vec4 here", "b.frag", 1),
    ]


def test_errors_of_both_stages_are_reported_together() -> None:
    head = "struct S { vec4 v; float f; };\nuniform S s[2];\nint first() { return 0; }\n"
    vertex = f"{head}attribute vec3 p;\nvoid main() {{ S one = s[first()]; gl_Position = one.v + p.xyzz; }}\n"
    fragment = f"{head}void main() {{ S one = s[first()]; gl_FragColor = one.v; }}\n"
    with pytest.raises(SssgenError) as error:
        translate(vertex, fragment)
    assert [each.span.file for each in error.value.diagnostics] == ["a.vert", "b.frag"]


def test_more_than_every_device_has() -> None:
    reads = " + ".join(f"texture2D(maps[{index}], at)" for index in range(20))
    vertex = """attribute vec2 p;
attribute mat4 a, b, c, d;
varying vec2 at;
void main() { at = p; gl_Position = a * b * c * d * vec4(p, 0.0, 1.0); }
"""
    fragment = (
        "precision highp float;\nuniform sampler2D maps[20];\nuniform vec4 many[5000];\nuniform int which;\n"
        f"varying vec2 at;\nvoid main() {{ gl_FragColor = {reads} + many[which]; }}\n"
    )
    counts = {"20 textures in the fragment shader": 16, "20 samplers in the fragment shader": 16}
    counts["17 locations of attributes"] = 16
    counts["80016 bytes of uniforms"] = 65536
    expected = [
        f"the program has {count}: devices of WGSL (WebGPU) have at least {least}, and some no more"
        for count, least in counts.items()
    ]
    program = translate(vertex, fragment)
    assert [warning.message for warning in program.warnings] == expected
    assert described(program)["warnings"] == expected


BLOCKS = """#version 300 es
layout(std140, row_major) uniform;
struct Light { vec3 color; float weights[3]; mat3 turn; };
uniform Scene { float first; Light lights[2]; layout(column_major) mat2 skew; bool is; mat2x3 rows; vec3 last; } scene;
uniform Own { vec2 size; float unread[2]; mat4 view; };
in vec3 position;
out vec3 v;
void main() {
    v = scene.lights[1].turn * scene.last + scene.lights[0].weights[2] + vec3(scene.skew[0], 0.0) + scene.rows[1];
    gl_Position = view * vec4(position, scene.is ? 1.0 : size.x);
}
"""
READER = """#version 300 es
precision highp float;
layout(std140, row_major) uniform;
struct Light { vec3 color; float weights[3]; mat3 turn; };
uniform Scene { float first; Light lights[2]; layout(column_major) mat2 skew; bool is; mat2x3 rows; vec3 last; } other;
in vec3 v;
out vec4 color;
void main() { color = vec4(v + other.lights[1].color + other.last, other.first); }
"""


def test_places_in_the_blocks_of_the_source() -> None:
    """The numbers are those of OpenGL ES 3.0, section 2.12.6.4; Chromium's WebGL has the same."""
    uniforms = described(translate(BLOCKS, READER))["uniforms"]
    places = {uniform["name"]: tuple(uniform["block"].values()) for uniform in uniforms}
    assert places == {
        "Scene.first": ("Scene", 0, [], 0, False),
        "Scene.lights[].color": ("Scene", 16, [112], 0, False),
        "Scene.lights[].weights": ("Scene", 32, [112, 16], 0, False),
        "Scene.lights[].turn": ("Scene", 80, [112], 16, True),
        "Scene.skew": ("Scene", 240, [], 16, False),
        "Scene.is": ("Scene", 272, [], 0, False),
        "Scene.rows": ("Scene", 288, [], 16, True),
        "Scene.last": ("Scene", 336, [], 0, False),
        "size": ("Own", 0, [], 0, False),
        "view": ("Own", 48, [], 16, True),
    }
    (last,) = [uniform for uniform in uniforms if uniform["name"] == "Scene.last"]
    assert last["stages"] == ["vertex", "fragment"]  # under other names of the instance


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("vec3 last;", "vec4 last;", "has 'last' here (a.vert:4:106)"),
        ("float first; ", "", "has 'first' here (a.vert:4:23)"),
        (" vec3 last;", "", "has 'last' here (a.vert:4:106)"),
        ("vec3 last;", "vec3 last; float more;", "ends before this member (a.vert:4:106)"),
        ("layout(column_major) ", "", "has 'skew' here (a.vert:4:73)"),
        ("vec3 color; float", "vec4 color; float", "has 'lights' here (a.vert:4:36)"),
    ],
)
def test_blocks_of_one_name_with_other_members(old: str, new: str, message: str) -> None:
    with pytest.raises(SssgenError) as error:
        translate(
            BLOCKS, READER.replace(old, new).replace("v + other.lights[1].color + other.last, other.first", "v, 1.0")
        )
    (each,) = error.value.diagnostics
    assert each.message == f"the block 'Scene' differs from that of the vertex shader, which {message}"
    assert each.hint == "declare the same members in the same order in both stages"


def test_structs_without_a_name_are_compared_by_their_members() -> None:
    vertex = """struct { vec3 own; } hidden;
uniform struct { vec4 tint; float w; } material;
attribute vec3 p;
void main() { hidden.own = material.tint.xyz; gl_Position = vec4(p + hidden.own, material.w); }
"""
    fragment = "uniform struct { vec4 tint; float w; } material;\nvoid main() { gl_FragColor = material.tint; }\n"
    program = described(translate(vertex, fragment))
    assert [uniform["name"] for uniform in program["uniforms"]] == ["material.tint", "material.w"]
    with pytest.raises(SssgenError) as error:
        translate(vertex, fragment.replace("float w", "vec2 w"))
    (each,) = error.value.diagnostics
    there, here = "a struct { vec4 tint; float w; }", "a struct { vec4 tint; vec2 w; }"
    assert each.message == f"the uniform 'material' is {there} in a.vert:2:40, but {here} here"


def test_a_texture_that_functions_get_has_a_sampler() -> None:
    """WGSL's functions take the sampler with the texture: the layout must have it, though only texels are read."""
    vertex = """#version 300 es
uniform highp sampler2D bones;
uniform highp sampler2DArray targets;
in vec3 p;
vec4 row(highp sampler2D map, int index) { return texelFetch(map, ivec2(index, 0), 0); }
void main() {
    gl_Position = row(bones, 1) + texelFetch(targets, ivec3(int(p.x), int(p.y), int(p.z)), 0) + vec4(p, 1.0);
}
"""
    fragment = "#version 300 es\nprecision highp float;\nout vec4 color;\nvoid main() { color = vec4(1.0); }\n"
    program = translate(vertex, fragment)
    textures = {texture["name"]: texture for texture in described(program)["textures"]}
    for name in ("bones", "targets"):
        assert (textures[name]["filterable"], textures[name]["sampler"]) == (False, "non-filtering")
        assert f"{name}, {name}_sampler" in program.files["pair.vertex.wgsl"]


def test_points() -> None:
    vertex = "attribute vec3 p;\nvoid main() { gl_PointSize = 4.0; gl_Position = vec4(p, 1.0); }\n"
    (warning,) = translate(vertex, "void main() { gl_FragColor = vec4(1.0); }\n").warnings
    assert "draw two triangles for each" in warning.hint
    with pytest.raises(SssgenError) as error:
        translate(vertex, "void main() { gl_FragColor = gl_PointCoord.xyxy; }\n")
    assert "with a varying in its place" in error.value.diagnostics[0].hint


POSITION = "in vec3 p;\nvoid main() { gl_Position = vec4(p, t); }\n"
COLOR = "precision highp float;\nout vec4 color;\nvoid main() { color = vec4(t); }\n"


@pytest.mark.parametrize(
    ("vertex", "fragment", "message", "hint"),
    [
        ("uniform B { float t; };", "uniform float t;", "the uniform 't' is a member of the block 'B' in", "alike"),
        ("uniform float t;", "uniform B { float t; };", "the uniform 't' is outside of blocks in", "alike"),
        ("uniform float t;", "uniform vec2 t[2];", "the uniform 't' is a float in", "alike"),
        ("uniform B { float t; }; uniform B { float u; } b;", "", "the block 'B' is already declared", "another name"),
        ("uniform B { sampler2D maps[2]; float t; };", "", "a block cannot contain textures", "outside of the block"),
        (
            "layout(location = 1) in mat2 m; layout(location = 2) in float t;",
            "",
            "'t' has a location of 'm'",
            "its own",
        ),
        (
            "layout(std140) uniform B { float t; };",
            "uniform B { float t; };",
            "the block 'B' is shared, but std140 in the vertex shader (a.vert:2:34)",
            "layout(std140) in both",
        ),
        (
            "out B { float t; float u; };",
            "in B { float u; float t; };",
            "the members of the block 'B' are in another order in the vertex shader (a.vert:2:15)",
            "in one order",
        ),
        (
            "layout(location = 4) uniform float t;",
            "layout(location = 5) uniform float t;",
            "'t' is at the location 5, but at 4 in the vertex shader (a.vert:2:36)",
            "one location",
        ),
        (
            "layout(location = 4) uniform float t;",
            "layout(location = 3) uniform vec2 t[2];",
            "the uniform 't' is a float in",
            "alike",
        ),
        (
            "layout(location = 4) uniform float t;",
            "struct Places { vec2 first; vec2 second; }; layout(location = 3) uniform Places places; uniform float t;",
            "'places' takes a location of 't' of the vertex shader (a.vert:2:36)",
            "each uniform its own",
        ),
    ],
)
def test_programs_that_do_not_link(vertex: str, fragment: str, message: str, hint: str) -> None:
    position = POSITION.replace("t);", "t + m[0].x);") if "mat2" in vertex else POSITION
    color = COLOR.replace(
        "vec4(t)", "vec4(t[1], 0.0, 0.0)" if "[2]" in fragment else "vec4(t)" if fragment else "vec4(1.0)"
    )
    with pytest.raises(SssgenError) as error:
        translate(
            f"#version 300 es\n{vertex}\n{position}", f"#version 300 es\nprecision highp float;\n{fragment}\n{color}"
        )
    assert message in error.value.diagnostics[0].message
    assert hint in error.value.diagnostics[0].hint


@pytest.mark.parametrize("ending", ["\n", "\r\n"])
def test_stages_that_agree_in_other_words(ending: str) -> None:
    """Other versions, precisions, orders, interpolations and ends of lines."""
    vertex = """attribute vec3 p;
uniform highp float t;
varying highp vec2 a;
varying vec3 unread;
varying mat3 turn;
void main() { a = p.xy; unread = p; turn = mat3(t); gl_Position = vec4(p, 1.0); }
"""
    fragment = """#version 300 es
precision mediump float;
uniform mediump float t;
in mat3 turn;
centroid in vec2 a;
out vec4 color;
void main() { color = vec4(turn * vec3(a, t), 1.0); }
"""
    program = described(translate(vertex.replace("\n", ending), fragment.replace("\n", ending)))
    varyings = {(varying["name"], *varying["path"]): varying["interpolation"] for varying in program["varyings"]}
    turn = {("turn", column): "smooth" for column in range(3)}
    assert varyings == {("a",): "centroid", **turn}
    assert program["uniforms"][0]["stages"] == ["vertex", "fragment"]


def test_names_that_differ_at_one_location() -> None:
    """A language without locations matches by name: a name that both stages have free is taken."""
    vertex = "#version 310 es\nlayout(location = 1) out highp float height;\n"
    vertex += "void main() { gl_Position = vec4(0.0); height = 1.0; }"
    fragment = """#version 310 es
precision highp float;
layout(location = 1) in float level;
layout(location = 0) out vec4 color;
float height() { return 2.0; }
void main() { color = vec4(level * height()); }
"""
    files = translate(vertex, fragment, "glsl-es-300").files
    assert "height_2 = 1.0;" in files["pair.glsl-es-300.vert"]
    assert "in float height_2;" in files["pair.glsl-es-300.frag"]
    for target in ("glsl-es-300", "glsl-330"):
        files = translate(vertex, fragment, target).files
        source = compilers.Source(files[f"pair.{target}.frag"], target, companion=files[f"pair.{target}.vert"])
        assert not [message for own in compilers.check(source).values() for message in compilers.errors(own)]


def test_precisions_of_a_uniform_agree_in_es() -> None:
    """GLSL ES 3.00, section 4.5.3: a program has one uniform of a name. Defaults count, and members of structs."""
    head = "#version 300 es\n"
    vertex = (
        f"{head}struct Lamp {{ float power; }};\nuniform Lamp lamp;\nvoid main() {{ gl_Position = vec4(lamp.power); }}"
    )
    fragment = (
        f"{head}precision PRECISION float;\nstruct Lamp {{ float power; }};\nuniform Lamp lamp;\nout vec4 color;\n"
    )
    fragment += "void main() { color = vec4(lamp.power); }"
    translate(vertex, fragment.replace("PRECISION", "highp"))
    with pytest.raises(SssgenError, match=r"'lamp' is highp in a\.vert:3:14, but mediump here"):
        translate(vertex, fragment.replace("PRECISION", "mediump"))
