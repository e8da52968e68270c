"""`tools/dump_shaders.js` in a page: which programs it collects, and the files that it downloads."""

from __future__ import annotations

import io
import json
import zipfile
from typing import Any

import pytest

from folders import ROOT
from sssgen.run.backends.browser_page import START, WEBGL, LostError, Page
from sssgen.run.machine_parts import chromium

VERTEX = """#version 300 es
#define SHADER_NAME lit:blue
in vec2 corner;
out vec2 at;
void main() { at = corner; gl_Position = vec4(corner, 0, 1); }"""
FRAGMENT = """#version 300 es
precision highp float; // ü
in vec2 at;
uniform vec3 tint[2];
out vec4 color;
void main() { color = vec4(tint[1], at.x); }"""
BLOCKED = """#version 300 es
precision highp float;
uniform Look { vec4 tint; };
uniform sampler2D map;
out vec4 color;
void main() { color = texture(map, tint.xy); }"""
PAGE = """
const gl = document.createElement('canvas').getContext('webgl2');
const program = (vertex, fragment, feedback = []) => {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
    gl.deleteShader(shader);
  }
  if (feedback.length) gl.transformFeedbackVaryings(made, feedback, gl.INTERLEAVED_ATTRIBS);
  gl.linkProgram(made);
  return made;
};
const [VERTEX, FRAGMENT, BLOCKED] = TEXTS;
const before = program(VERTEX, `${FRAGMENT}\\n\\n`);
await import('dump');
program(VERTEX, FRAGMENT);
program(VERTEX, FRAGMENT);
program(VERTEX, `${FRAGMENT}\\n`, ['at']);
program(VERTEX, 'no shader');
const first = dumpedShaders.programs().length;
gl.useProgram(before);
gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(16), gl.STATIC_DRAW);
gl.enableVertexAttribArray(0);
gl.vertexAttribPointer(0, 2, gl.SHORT, true, 16, 4);
gl.uniform3fv(gl.getUniformLocation(before, 'tint'), [1, 2, 3, 4, 5, 6]);
gl.enable(gl.DEPTH_TEST);
gl.depthFunc(gl.LEQUAL);
gl.enable(gl.BLEND);
gl.blendFunc(gl.SRC_ALPHA, gl.ONE);
const blocked = program(VERTEX, BLOCKED);
gl.drawArrays(gl.TRIANGLES, 0, 3);
gl.useProgram(blocked);
gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 1, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, gl.createBuffer());
gl.bufferData(gl.UNIFORM_BUFFER, new Float32Array([1, 0, 0, 0]), gl.STATIC_DRAW);
gl.disableVertexAttribArray(0);
gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, 2);
const fault = gl.getError();
program(VERTEX.replace(/#define.*/, ''), FRAGMENT);
const socket = new WebSocket(location.href.replace('http:', 'ws:'));
socket.onopen = async () => {
  socket.send(JSON.stringify({ first, fault, programs: dumpedShaders.programs() }));
  socket.send(await dumpedShaders.zip().arrayBuffer());
};
"""


@pytest.fixture(scope="module")
def dumped() -> tuple[dict[str, Any], zipfile.ZipFile]:
    """What the script says of a page's programs, and its file."""
    if not chromium():
        pytest.skip("chromium is missing")
    script = PAGE.replace("TEXTS", json.dumps([VERTEX, FRAGMENT, BLOCKED]))
    try:
        page = Page(chromium(), "swiftshader", script, WEBGL, {"dump": ROOT / "tools" / "dump_shaders.js"})
    except LostError as reason:
        pytest.skip(f"chromium {reason}")
    try:
        answer, data = page.receive(START)
    finally:
        page.close()
    return answer, zipfile.ZipFile(io.BytesIO(data))


def test_programs_are_collected_when_they_are_linked_or_used(dumped: tuple[dict[str, Any], zipfile.ZipFile]) -> None:
    answer, _ = dumped
    assert answer["first"] == 2  # equal texts are one program, and one that does not link is none
    names = [program["name"] for program in answer["programs"]]
    assert names == ["lit_blue", "lit_blue_2", "lit_blue_3", "lit_blue_4", "program"]
    first, second, used, *_ = answer["programs"]
    assert (first["vertex"], first["fragment"], first["webgl"]) == (VERTEX, FRAGMENT, 2)
    assert first["attributes"] == [{"name": "corner", "type": "0x8b50", "size": 1, "location": 0}]
    assert first["uniforms"] == [{"name": "tint[0]", "type": "0x8b51", "size": 2}]
    assert first["feedback"] == [] and second["feedback"] == ["at"]
    assert used["fragment"] == f"{FRAGMENT}\n\n"


def test_the_file_has_both_stages_of_each_program(dumped: tuple[dict[str, Any], zipfile.ZipFile]) -> None:
    answer, file = dumped
    assert file.testzip() is None
    stages = [f"{program['name']}.{stage}" for program in answer["programs"] for stage in ("vert", "frag")]
    assert file.namelist() == [*stages, "programs.json"]
    assert file.read("lit_blue.frag").decode() == FRAGMENT
    described = json.loads(file.read("programs.json"))
    assert described["page"].startswith("http://127.0.0.1")
    assert [program["name"] for program in described["programs"]] == [p["name"] for p in answer["programs"]]
    assert "vertex" not in described["programs"][0]


def test_the_first_draw_in_the_words_of_the_loader(dumped: tuple[dict[str, Any], zipfile.ZipFile]) -> None:
    answer, _ = dumped
    assert answer["fault"] == 0  # the page sees no error of the script
    one, _, used, blocked, never = answer["programs"]
    assert "draw" not in one and "draw" not in never
    factors = {"srcFactor": "src-alpha", "dstFactor": "one", "operation": "add"}
    assert used["draw"] == {
        "call": "drawArrays(triangle-list, 0, 3)",
        "pipeline": {
            "topology": "triangle-list", "cull": "none", "frontFace": "ccw",
            "depth": {"test": True, "write": True, "compare": "less-equal"},
            "blend": {"color": factors, "alpha": factors},
        },
        "uniforms": {"tint": [1, 2, 3, 4, 5, 6]},
        "blocks": {},
        "textures": {},
        "attributes": {"corner": {"format": "snorm16x2", "stride": 16, "offset": 4}},
    }  # fmt: skip
    draw = blocked["draw"]
    assert draw["call"] == "drawArraysInstanced(triangle-strip, 0, 4, 2)"
    assert draw["blocks"] == {"Look": [0, 0, 128, 63, *[0] * 12]}
    assert draw["textures"]["map"] == {
        "minFilter": "linear", "magFilter": "linear", "lodMaxClamp": 0, "addressModeU": "repeat",
        "addressModeV": "repeat",
    }  # fmt: skip
    assert draw["attributes"] == {"corner": {"constant": [0, 0, 0, 1]}}
