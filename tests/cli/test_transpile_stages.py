"""`sssgen transpile --stages` as a command."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from command_line import Run, folder_content

VERTEX = """attribute vec3 position;
uniform mat4 view;
varying vec2 at;
void main() { at = position.xy; gl_Position = view * vec4(position, 1.0); }
"""
FRAGMENT = """precision highp float;
varying vec2 at;
uniform sampler2D map;
void main() { gl_FragColor = texture2D(map, at); }
"""


def test_the_command(run: Run) -> None:
    Path("a.vert").write_text(VERTEX, encoding="utf-8")
    Path("b.frag").write_text(FRAGMENT, encoding="utf-8")
    arguments = ["transpile", "--stages", "a.vert", "b.frag", "-t", "wgsl", "-o", "out/still-water.2"]
    first, second = run(*arguments), run(*arguments)
    names = [
        "still-water.2.vertex.wgsl",
        "still-water.2.fragment.wgsl",
        "still-water.2.program.json",
        "webgl_program.js",
    ]
    assert first[:2] == (0, "".join([f"wrote out/{name}\n" for name in names]))
    assert second[:2] == (0, "".join([f"kept  out/{name}\n" for name in names]))
    assert set(folder_content("out")) == {
        "still-water.2.vertex.wgsl", "still-water.2.fragment.wgsl", "still-water.2.program.json", "webgl_program.js",
    }  # fmt: skip
    texts = json.loads(run("transpile", "--stages", "a.vert", "b.frag", "-t", "hlsl", "--json").out)["texts"]
    assert list(texts) == ["a.vertex.hlsl", "a.fragment.hlsl", "a.program.json"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("--stages a.vert b.frag -t wgsl", "--stages writes several files"),
        ("--stages a.vert a.vert -t wgsl -o x", "a vertex shader and a vertex shader"),
        ("--stages a.vert b.frag -t wgsl -o x b.frag", "FILE cannot be used with --stages"),
        ("--stages a.vert b.frag -t metal -o x", "metal has no whole shaders of plain GLSL"),
        ("--stages a.vert c.frag -t wgsl -o x", "no such file"),
        ("--stages a.vert empty.frag -t wgsl -o x", "empty.frag"),
        ("--stages a.vert b.frag -o x", "the target is missing"),
        ("-t wgsl", "the file is missing"),
    ],
)
def test_wrong_commands(run: Run, arguments: str, message: str) -> None:
    Path("a.vert").write_text(VERTEX, encoding="utf-8")
    Path("b.frag").write_text(FRAGMENT, encoding="utf-8")
    Path("empty.frag").write_text("// nothing\n", encoding="utf-8")
    before = folder_content(".")
    ran = run("transpile", *arguments.split())
    assert (ran.status, ran.out) == (2, "")
    assert message in ran.err
    assert folder_content(".") == before


def test_inputs_are_not_overwritten(run: Run) -> None:
    Path("a.glsl-330.vert").write_text(VERTEX, encoding="utf-8")
    Path("b.frag").write_text(FRAGMENT, encoding="utf-8")
    ran = run("transpile", "--stages", "a.glsl-330.vert", "b.frag", "-t", "glsl-330", "-o", "a")
    assert (ran.status, Path("a.glsl-330.vert").read_text(encoding="utf-8")) == (2, VERTEX)
    assert "the output file a.glsl-330.vert is also an input file" in ran.err


@pytest.mark.parametrize("name", ["out/water.wgsl", "out/water.program.json", "out/water.frag"])
def test_the_name_of_the_program(run: Run, name: str) -> None:
    Path("a.vert").write_text(VERTEX, encoding="utf-8")
    Path("b.frag").write_text(FRAGMENT, encoding="utf-8")
    assert run("transpile", "--stages", "a.vert", "b.frag", "-t", "wgsl", "-o", name).status == 0
    program = {"out/water.wgsl": "water", "out/water.program.json": "water.program", "out/water.frag": "water.frag"}[
        name
    ]
    assert f"{program}.vertex.wgsl" in folder_content("out")
