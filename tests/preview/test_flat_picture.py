"""Pictures of one triangle: plain GLSL, and materials that make their own rays."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from sssgen.preview.page_messages import PageMessages
from sssgen.preview.pane import Pane
from sssgen.support.diagnostics import SssgenError

WHOLE = """#version 300 es
precision highp float;
uniform float u_time; uniform vec2 resolution; uniform float amount; uniform mat3 turn; uniform sampler2D paper;
in vec2 vUv; out vec4 color;
void main() { color = texture(paper, vUv) * amount * sin(u_time + gl_FragCoord.x / resolution.x) + turn[0][0]; }
"""
TOY = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p / iResolution.xy, sin(iTime), 1.0); }\n"


def head(tmp_path: Path, text: str, name: str = "waves.frag") -> dict[str, Any]:
    (tmp_path / name).write_text(text, encoding="utf-8")
    picture: dict[str, Any] = Pane(str(tmp_path / name)).picture.head
    return picture


def test_a_whole_shader_has_its_uniforms_as_controls_and_its_textures_as_slots(tmp_path: Path) -> None:
    picture = head(tmp_path, WHOLE)
    assert picture["flat"]["given"] == {"u_time": "time", "resolution": "resolution"}
    assert [control["property"] for control in picture["controls"]] == ["amount"]
    assert [row["property"] for row in picture["textures"]] == ["paper"]
    assert "out vec2 vUv;" in picture["flat"]["vertex"] and "vUv = 0.5" in picture["flat"]["vertex"]


def test_shadertoys_entry_is_found(tmp_path: Path) -> None:
    picture = head(tmp_path, TOY, "toy.glsl")
    assert picture["flat"]["given"] == {"iResolution": "resolution", "iTime": "time"} and picture["title"] == "toy.glsl"


@pytest.mark.parametrize(
    ("function", "called"),
    [
        ("float f(vec2 p) { return p.x; }", "f(at)"),
        ("vec3 f(vec3 p, float t) { return p * t; }", "f(vec3(at, 0.0), iTime)"),
        ("vec4 f(vec2 p) { return p.xyxy; }\nfloat unshown(int i) { return 1.0; }", "f(at)"),
    ],
)
def test_a_function_of_a_place_is_drawn_around_0(tmp_path: Path, function: str, called: str) -> None:
    picture = head(tmp_path, function, "f.glsl")
    assert called in picture["flat"]["fragment"] and picture["title"].startswith("f(vec")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("void main() { gl_Position = vec4(0.0); }", "this is a vertex shader"),
        ("in vec3 vNormal; out vec4 c; void main() { c = vec4(vNormal, 1.0); }", "reads 'vNormal', a vec3"),
        ("uniform samplerCube s; out vec4 c; void main() { c = texture(s, vec3(1.0)); }", "reads 's', a samplerCube"),
        ("int f(int i) { return i; }", "nothing in the file can be shown"),
        ("float f(vec2 p) { return p; }", "waves.frag:1"),
        ("", "nothing in the file can be shown"),
    ],
)
def test_other_files_are_refused_with_a_reason(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(SssgenError) as error:
        head(tmp_path, text)
    assert message in str(error.value)


def test_values_of_plain_glsl_are_not_saved(tmp_path: Path) -> None:
    (tmp_path / "waves.frag").write_text(WHOLE, encoding="utf-8")
    talk = PageMessages(Pane(str(tmp_path / "waves.frag")))
    with pytest.raises(SssgenError, match="nothing can be saved"):
        talk.answer({"kind": "save", "values": {"amount": [0.5]}})
    assert (tmp_path / "waves.frag").read_text(encoding="utf-8") == WHOLE


def test_a_material_that_makes_its_own_rays_is_a_flat_picture() -> None:
    picture = Pane("jelly_cubes").picture.head
    assert picture["flat"]["given"] == {"aspect": "aspect", "time": "time"} and picture["flat"]["start"] > 1.0
    values = {control["property"]: control["value"] for control in picture["controls"]}
    assert values["orbit_radius"] == [pytest.approx(3.8)]


def test_the_emitted_text_of_plain_glsl_is_that_of_transpile(tmp_path: Path) -> None:
    (tmp_path / "waves.frag").write_text(TOY, encoding="utf-8")
    talk = PageMessages(Pane(str(tmp_path / "waves.frag")))
    answer = talk.reply({"kind": "text", "target": "wgsl", "form": "shader"})
    assert answer is not None and not answer["error"]
    assert "@fragment" in answer["files"][0]["text"] and answer["files"][0]["sources"]
