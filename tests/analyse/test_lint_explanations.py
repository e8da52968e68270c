"""What a finding says: its excerpt, its operands, its way back to an input, and its remedy."""

from __future__ import annotations

from pathlib import Path

import pytest

from sssgen.analyse.lint.lint_findings import Finding, lint

HEAD = """\
#version 300 es
precision highp float;
#define saturate(a) clamp(a, 0.0, 1.0)
struct Coat { vec3 color; float rough; };
uniform Coat coat;
uniform vec3 eye;
uniform sampler2D table;
uniform bool flat_view;
in vec3 at;
out vec4 color;
void far(inout Coat c, float x) { c.rough += 1e30 * x; }
void main() {
"""


def findings(body: str, tmp_path: Path, assumed: str = "") -> list[Finding]:
    """The findings of a main() with these lines."""
    path = tmp_path / "shader.frag"
    path.write_text(f"{HEAD}{body}\n}}\n")
    presets = []
    if assumed:
        presets = [str(tmp_path / "mine.toml")]
        Path(presets[0]).write_text(assumed)
    return lint(str(path), False, assumed=presets).unproven()


@pytest.mark.parametrize(
    ("body", "texts"),
    [
        (
            "color.x = 1.0 / ( 4.0 * ( at.x + at.y ) );",
            ["found: y in -8e+06..8e+06; y is 4.0 * ( at.x + at.y )\n", "^" * 31],
        ),
        (
            "float s = saturate( at.x * ( eye.y ) );\ncolor.x = 1.0 / s;",
            ["s = saturate( at.x * ( eye.y ) ) is in 0..1"],
        ),
        ("float s = ( flat_view ) ? 0.0 : at.x;\ncolor.x = 1.0 / s;", ["s = ( flat_view ) ? 0.0 : at.x is in"]),
        (
            "float s = at.x * at.y\n  + ( at.z *\n  eye.x );\ncolor.x = 1.0 / s;",
            ["s = at.x * at.y + ( at.z * eye.x ) is in"],
        ),
        (
            "float s = clamp(at.x + at.y + at.z + eye.x + eye.y + eye.z + at.x, -1.0, 1.0);\ncolor.x = 1.0 / s;",
            ["s = clamp(at.x + at.y + at.z + eye.x + eye.y + eye.z + at.x, … is in"],
        ),
    ],
)
def test_excerpts_have_whole_brackets(body: str, texts: list[str], tmp_path: Path) -> None:
    (finding,) = findings(body, tmp_path)
    for text in texts:
        assert text in finding.render()


def test_the_index_is_named(tmp_path: Path) -> None:
    """Not the array, and in the remedy, too."""
    (finding,) = findings(
        "float numbers[4] = float[4](1.0, 2.0, 3.0, 4.0);\ncolor.x = numbers[int(at.x) + 1];", tmp_path
    )
    assert finding.found.endswith("y is int(at.x) + 1")
    assert finding.remedy == "clamp(y, 0, 3) in place of y; y is int(at.x) + 1"


def test_the_field_of_a_struct_is_followed(tmp_path: Path) -> None:
    """Not the widest field, through copies, parameters and calls."""
    body = "Coat c;\nc.color = eye;\nc.rough = coat.rough;\nc.color *= 1e20;\ncolor.x = 1.0 / c.rough;"
    (finding,) = findings(body, tmp_path)
    assert [(step.what, step.name) for step in finding.why] == [("uniform", "coat.rough")]
    (finding,) = findings("Coat c = Coat(eye, 0.0);\nfar(c, at.x);\ncolor.x = 1.0 / c.rough;", tmp_path)
    assert finding.why[-1].name == "at" and finding.why[-1].range.high == 1e6
    assert "because: c.rough += 1e30 * x is in -1e+36..1e+36" in finding.render()
    (finding,) = findings("vec3 d[2];\nd[0] = eye;\nd[1] = at;\ncolor.xyz = normalize(d[1]);", tmp_path)
    assert finding.why[-1].name == "at"


@pytest.mark.parametrize(
    ("call", "remedy"),
    [
        ("smoothstep(0.9, 0.1, at.x)", "1.0 - smoothstep(0.1, 0.9, at.x) in place of the call"),
        ("smoothstep(0.5, 0.5, at.x)", "step(0.5, at.x) in place of the call"),
        (
            "smoothstep(0.0, abs(at.y), at.z)",
            "t * t * (3.0 - 2.0 * t), with t = clamp((z - x) / max(y - x, 1e-20), 0.0, 1.0), in place of the call; x",
        ),
        ("smoothstep(at.y, at.z, at.x)", "or 1.0 - smoothstep(at.z, at.y, at.x) where at.y > at.z"),
        ("determinant(inverse(mat2(at.xy, at.xy)))", "call it only where abs(determinant(x)) > 1e-20"),
    ],
)
def test_remedies_are_expressions(call: str, remedy: str, tmp_path: Path) -> None:
    (finding,) = findings(f"color.x = {call};", tmp_path)
    assert remedy in finding.remedy and "{" not in finding.remedy


def test_rounding_beyond_1_is_said(tmp_path: Path) -> None:
    (finding,) = findings("color.x = acos(dot(normalize(at + 2e6), normalize(eye + 2e6)));", tmp_path)
    assert finding.remedy.startswith("clamp(x, -1.0, 1.0) in place of x, as rounding alone can exceed 1; x is dot(")
    (finding,) = findings("color.x = acos(at.x);", tmp_path)
    assert finding.remedy == "clamp(at.x, -1.0, 1.0) in place of at.x"


RULES = """\
[[assume]]
names = ["table.r"]
range = [0.1, 1.0]

[[assume]]
names = ["e* - at"]
storage = "difference"
nonzero = true
"""


@pytest.mark.parametrize(
    ("body", "count"),
    [
        ("color.x = 1.0 / texture(table, at.xy).r;", 0),
        ("vec2 t = texture(table, at.xy).rg;\ncolor.x = 1.0 / (t.x + t.y);", 0),
        ("color.x = 1.0 / texture(table, at.xy).g;", 1),
        ("color.x = 1.0 / texture(table, at.xy).r - 1.0 / (texture(table, at.xy).r - 0.1);", 1),
        ("vec3 p = at;\ncolor.xyz = normalize(eye - p);", 0),
        ("color.xyz = normalize(p_of());", 0),
        ("color.xyz = normalize(eye - 2.0 * at);", 1),
        ("color.xyz = normalize(eye + at);", 1),
        ("color.xyz = vec3(1.0 / (eye - at).x);", 1),
    ],
)
def test_channels_and_differences_are_assumed(body: str, count: int, tmp_path: Path) -> None:
    """One channel of a texture; the difference of a uniform and an input, in both orders."""
    body = body.replace("p_of()", "at - eye")
    assert len(findings(body, tmp_path)) > 0
    assert len(findings(body, tmp_path, RULES)) == count
