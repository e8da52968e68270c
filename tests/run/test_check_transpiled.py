"""`sssgen check` of files that `sssgen transpile` wrote: their reflection states language, stage and entry."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from slow_cases import diagonal, some_slow
from sssgen.cli import main as cli
from sssgen.run.check.shader_files import read
from sssgen.run.compilers.calling_entry import functions
from sssgen.support.diagnostics import SssgenError

FRAGMENT = """#version 330
in vec3 tint; in vec3 normal; out vec4 color; uniform float u;
void main() { color = vec4(tint + normal * u, 1.0); }
"""
VERTEX = """#version 330
in vec3 position; out vec3 normal; out vec3 tint;
void main() { normal = position; tint = position.zyx; gl_Position = vec4(position, 1.0); }
"""
LIBRARY = "float half_of(float x) { return x * 0.5; }\nvoid turn(inout float a[3]) { a[0] = a[2]; }\n"
LANGUAGES = {
    "hlsl": "z.hlsl", "wgsl": "z.wgsl", "glsl-330": "z.frag", "glsl-es-300": "y.glsl", "unity-urp": "u.hlsl",
    "unity-builtin": "c.cginc", "numpy": "n.py",
}  # fmt: skip


pytestmark = pytest.mark.usefixtures("in_folder", "outside_ci")


def transpiled(name: str, text: str, target: str, output: str) -> None:
    Path(name).write_text(text, encoding="utf-8")
    assert cli.main(["transpile", name, "--target", target, "-o", output]) == 0


def checked(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, list[tuple[str, str, bool]]]:
    """The status, and (file, stage, whether it compiles) of each compilation."""
    capsys.readouterr()
    status = cli.main(["check", *arguments, "--json"])
    return status, [(row["file"], row["stage"], row["ok"]) for row in json.loads(capsys.readouterr().out)["results"]]


@pytest.mark.parametrize(
    ("target", "name", "text", "stage"),
    diagonal(
        LANGUAGES,
        [
            pytest.param("a.frag", FRAGMENT, "fragment", id="a.frag"),
            pytest.param("f.glsl", LIBRARY, "library", id="f.glsl"),
        ],
    ),
)
def test_any_name_will_do(name: str, text: str, stage: str, target: str, capsys: pytest.CaptureFixture[str]) -> None:
    output = LANGUAGES[target]
    transpiled(name, text, target, output)
    if stage == "fragment" and target in ("unity-urp", "unity-builtin", "numpy"):
        stage = "library"
    status, rows = checked(capsys, output)
    assert (status, set(rows)) == (0, {(output, stage, True)})
    assert set(rows) <= set(checked(capsys, ".")[1])


def test_a_vertex_shader_is_checked_as_one(capsys: pytest.CaptureFixture[str]) -> None:
    transpiled("a.vert", VERTEX, "hlsl", "z.hlsl")
    assert {row[1:] for row in checked(capsys, "z.hlsl")[1]} == {("vertex", True)}


def test_another_file_as_reflection_is_an_error() -> None:
    transpiled("a.frag", FRAGMENT, "hlsl", "z.hlsl")
    for text in ("{", "[]", '{"source_map": {}}', '{"source_map": {"z": {}}, "files": [], "target": "hlsl"}'):
        Path("z.hlsl.reflection.json").write_text(text, encoding="utf-8")
        with pytest.raises(SssgenError, match="not a reflection file"):
            read(["z.hlsl"], [])


@pytest.mark.parametrize("kind", ["array<f32, 3>", "mat3x3f", "array<vec4f, 2>"])
def test_a_wrapped_pointer_is_called(kind: str) -> None:
    """The line may break after each comma and before each name."""
    for broken in (f"ptr<function,\n    {kind}>", f"ptr<function, {kind}>".replace(", ", ",\n        ")):
        (function,) = functions(f"fn f(a: {broken}, b:\n    f32) {{\n}}\n", wgsl=True)
        assert [parameter[0] for parameter in function.parameters] == [f"ptr<function, {kind}>", "f32"]


@pytest.mark.parametrize("target", some_slow(["wgsl", "hlsl", "glsl-330"], "wgsl"))
def test_two_stages_are_compared(target: str, capsys: pytest.CaptureFixture[str]) -> None:
    """The fragment shader reads the second output of three."""
    vertex = "#version 330\nout vec3 a, b, c; void main() { a = b = c = vec3(1.0); gl_Position = vec4(1.0); }"
    Path("a.vert").write_text(vertex, "utf-8")
    Path("b.frag").write_text("#version 330\nin vec3 b; out vec4 x; void main() { x = vec4(b, 1.0); }", "utf-8")
    Path("c.frag").write_text("#version 330\nin vec2 b; out vec4 x; void main() { x = vec4(b, b); }", "utf-8")
    Path("d.frag").write_text("#version 330\nin vec3 d; out vec4 x; void main() { x = vec4(d, 1.0); }", "utf-8")

    def messages(name: str, *options: str) -> list[str]:
        assert cli.main(["transpile", "a.vert", "--target", target, "-o", "v.out"]) == 0
        assert cli.main(["transpile", name, "--target", target, "-o", "f.out", *options]) == 0
        capsys.readouterr()
        cli.main(["check", "v.out", "f.out", "--target", target, "--json"])
        rows = json.loads(capsys.readouterr().out)["results"]
        (row,) = [row for row in rows if row["compiler"] == "interface"]
        assert row["file"] == "f.out"
        return [message["text"] for message in row["messages"]]

    alone = {
        "wgsl": ["'b' has location 0 here, but 1 in the vertex shader: transpile this file --with the other"],
        "hlsl": ["the inputs are fewer than the outputs of v.out: transpile this file --with the other"],
        "glsl-330": [],
    }
    assert messages("b.frag") == alone[target]
    assert messages("b.frag", "--with", "a.vert") == []
    assert messages("c.frag") == ["'b' is vec2 here, but vec3 in the vertex shader"]
    assert messages("d.frag") == ["the vertex shader has no output 'd'"]


def test_stages_are_paired_by_their_names(capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("one", "two"):
        transpiled(f"{name}.vert", VERTEX, "wgsl", f"{name}.vert.wgsl")
        transpiled(f"{name}.frag", FRAGMENT, "wgsl", f"{name}.frag.wgsl")
    transpiled("three.frag", FRAGMENT, "wgsl", "three.wgsl")
    names = [f"{name}.{stage}.wgsl" for name in ("one", "two") for stage in ("frag", "vert")]
    capsys.readouterr()
    assert cli.main(["check", *names, "three.wgsl", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["results"]
    assert [row["file"] for row in rows if row["compiler"] == "interface"] == ["one.frag.wgsl", "two.frag.wgsl"]
