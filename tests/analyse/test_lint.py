"""`sssgen lint`: operations that may fail, with places and example inputs, and operations that are proven safe."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from sssgen.analyse.lint.input_assumptions import presets
from sssgen.analyse.lint.lint_findings import MAY_FAIL, NOT_PROVEN, PROVEN, lint
from sssgen.cli.main import main
from sssgen.support.diagnostics import SssgenError

HAZARDS = """\
uniform float share : hint_range(0.0, 1.0) = 0.5;
uniform float width : hint_range(0.1, 1.0) = 0.5;

float ratio(float a, float b)
{
    return a / b;
}

vec3 between(vec3 a, vec3 b)
{
    return normalize(a + b);
}

float known(float a)
{
    return sqrt(a * a + share) / width;
}
"""


@pytest.fixture
def hazards(tmp_path: Path) -> str:
    path = tmp_path / "hazards.glsl"
    path.write_text(HAZARDS)
    return str(path)


def test_plain_functions_have_no_guard(hazards: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lint", hazards]) == 1
    output = capsys.readouterr().out
    assert "warning: /: a division by 0 [division]\n" in output
    assert f"{hazards}:6:12" in output
    assert " 6 |     return a / b;\n   |            ^^^^^" in output
    assert "found: a in -1e+06..1e+06, b in -1e+06..1e+06" in output
    assert "write: max(abs(b), 1e-20)" in output
    assert output.endswith(
        "4 operations with a domain: 2 proven safe, 2 may fail, 0 not proven (division: 1, nan: 1)\n"
    )


def test_proven_functions_pass(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "safe.glsl"
    path.write_text("float root(float a) { return sqrt(a * a + 1.0); }\n")
    assert main(["lint", str(path)]) == 0
    assert "1 operation with a domain: 1 proven safe" in capsys.readouterr().out
    assert main(["lint", "--all", str(path)]) == 0
    assert "sqrt: proven safe" in capsys.readouterr().out


def test_the_example_fails(capsys: pytest.CaptureFixture[str]) -> None:
    """The printed command gives NaN."""
    assert main(["lint", "lobe_normalized"]) == 0  # the emitted text has guards
    line = next(text for text in capsys.readouterr().out.splitlines() if "example: " in text)
    command = line.split("example: ")[1].replace("sssgen eval", f"{sys.executable} -m sssgen eval")
    process = subprocess.run(["sh", "-c", command], capture_output=True, text=True, check=True)
    assert "nan" in process.stdout
    guarded = command.replace("--guards none", "--guards auto")
    process = subprocess.run(["sh", "-c", guarded], capture_output=True, text=True, check=True)
    assert "nan" not in process.stdout


def test_json_for_editors(hazards: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lint", "--json", hazards]) == 1
    data = json.loads(capsys.readouterr().out)
    assert not data["ok"]
    results = {entry["operation"]: entry for entry in data["results"][0]["findings"] if entry["verdict"] == MAY_FAIL}
    assert results["/"]["line"] == 6
    assert results["/"]["severity"] == "warning"
    assert results["normalize"]["example"].startswith("echo")
    assert "inversesqrt" in results["normalize"]["help"]


def test_examples_are_optional(hazards: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lint", "--no-examples", hazards]) == 1
    output = capsys.readouterr().out
    assert "a division by 0 [division] (not proven)" in output
    assert "example:" not in output
    assert "2 proven safe, 0 may fail, 2 not proven" in output


def test_a_material_is_analysed_as_a_whole() -> None:
    """In a chain each quantity is in its range; a single function accepts any number."""
    alone = {(entry.site.operation, entry.verdict) for entry in lint("thickness_from_thinness").findings}
    assert ("thickness", MAY_FAIL) in alone
    chained = lint("paper_lantern", with_examples=False).findings
    assert all(entry.guarded for entry in chained)
    assert sum(entry.verdict == PROVEN for entry in chained) > sum(entry.verdict == NOT_PROVEN for entry in chained)


def test_fixed_values_prove_more(tmp_path: Path) -> None:
    path = tmp_path / "glow.toml"
    text = """
[material]
name = "glow"

[[thickness]]
technique = "transmittance_map"

[translucency]
technique = "lobe_normalized"
{fixed}
"""
    path.write_text(text.format(fixed=""))
    assert any(
        entry.site.place.startswith("translucency")
        for entry in lint(str(path), False).findings
        if entry.verdict != PROVEN
    )
    path.write_text(text.format(fixed="distortion = { value = 0.0, fixed = true }"))
    # the direction of the light may still be 0
    assert [
        entry.site.operation
        for entry in lint(str(path), False).findings
        if "lobe" in entry.site.place and entry.verdict != PROVEN
    ] == ["normalize"]


KINDS_AT_ONCE = """\
float f(float a, float b, vec3 v, float e)
{
    return pow(a, b) / b + smoothstep(e, 0.5, a) + normalize(v).x + exp(b);
}
"""


def test_kinds_are_kept_apart(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Overflow is not reported unless it is asked for; an operation that may fail in two ways has two findings."""
    path = tmp_path / "kinds.glsl"
    path.write_text(KINDS_AT_ONCE)
    report = lint(str(path), with_examples=False)
    kinds = [(finding.site.operation, finding.kind) for finding in report.unproven()]
    assert sorted(kinds) == [("/", "division"), ("normalize", "nan"), ("pow", "nan"), ("smoothstep", "undefined")]
    assert report.hidden == {"overflow": 4}  # exp, pow, the quotient, the sum
    every = lint(str(path), with_examples=False, kinds=("nan", "overflow"))
    assert {finding.kind for finding in every.unproven() if finding.site.operation == "pow"} == {"nan", "overflow"}
    assert main(["lint", "--no-examples", "--kind", "overflow", str(path)]) == 1
    output = capsys.readouterr().out
    assert "exp: exp overflows [overflow]" in output and "[nan]" not in output
    assert main(["lint", "--json", "--no-examples", "--kind", "all", str(path)]) == 1
    findings = json.loads(capsys.readouterr().out)["results"][0]["findings"]
    assert {entry["kind"] for entry in findings if entry["kind"]} == {"nan", "division", "undefined", "overflow"}
    assert all(entry["function"] == "f" for entry in findings)
    assert main(["lint", "--kind", "nann", str(path)]) == 2
    assert "did you mean 'nan'?" in capsys.readouterr().err


SHADER = """\
#version 300 es
precision highp float;
struct Lamp { vec3 at; float decay; };
uniform Lamp lamp;
in float width;
out vec4 color;
float state = 2.0;
float unused(float x) { return sqrt(x); }
float share(float x) { return 1.0 / x; }
void raise() { state += 1.0; }
void main() {
    raise();
    float fine = share(state);
    for (int i = 0; i < 3; i++) raise();
    color = vec4(fine, share(state), sqrt(state), 1.0 / lamp.decay);
}
"""


def test_a_whole_shader_runs_from_its_main(tmp_path: Path) -> None:
    """A function that main() does not reach never runs; module variables have the values that main() gives them."""
    path = tmp_path / "whole.frag"
    path.write_text(SHADER)
    report = lint(str(path), with_examples=False)
    assert [(finding.site.operation, finding.site.node.span.line) for finding in report.unproven()] == [("/", 15)]
    assert [finding.site.operation for finding in report.findings if finding.verdict == PROVEN] == ["/", "sqrt"]


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("lobe_normalised", "did you mean 'lobe_normalized'?"),
        ("nothing.glsl", "no such file"),
        ("nothing.sss", "no such file"),
        ("nothing.toml", "no such file"),
    ],
)
def test_wrong_names(name: str, message: str) -> None:
    with pytest.raises(SssgenError, match=re.escape(message)):
        lint(name)


def test_wrong_files(tmp_path: Path) -> None:
    """A file that is not a shader is reported with its place."""
    for name, data in (("a.glsl", b"float f( {"), ("b.glsl", b"\x00\xff\x01"), ("c.glsl", b"")):
        path = tmp_path / name
        path.write_bytes(data)
        if data:
            with pytest.raises(SssgenError) as raised:
                lint(str(path))
            assert raised.value.diagnostics[0].span.file == str(path)
        else:
            assert lint(str(path)).findings == []
    with pytest.raises(SssgenError):
        lint(str(tmp_path))


def test_a_compute_shader_of_a_wrong_size_has_one_error(tmp_path: Path) -> None:
    """With a wrong size, too, it is a compute shader: the buffer and the builtins are no errors."""
    path = tmp_path / "compute.glsl"
    path.write_text(
        "#version 430\nlayout(local_size_x = 0) in;\nlayout(std430, binding = 0) buffer B { float v[]; };\n"
        "void main() { v[gl_GlobalInvocationID.x] = float(gl_WorkGroupSize.x); barrier(); }\n"
    )
    with pytest.raises(SssgenError) as raised:
        lint(str(path))
    (diagnostic,) = raised.value.diagnostics
    assert "a local_size_x must be" in diagnostic.message and diagnostic.hint


def test_names_mean_nothing_in_plain_functions(tmp_path: Path) -> None:
    """In a plain function `roughness` is any number; in a technique it is a quantity with a range."""
    path = tmp_path / "names.glsl"
    path.write_text("float f(float roughness, float L) { return sqrt(1.0 - roughness) + sqrt(2.0 - L); }\n")
    assert [entry.verdict for entry in lint(str(path)).findings] == [MAY_FAIL, MAY_FAIL]


def test_parameters_that_cannot_be_sampled_have_no_example(tmp_path: Path) -> None:
    path = tmp_path / "types.glsl"
    path.write_text(
        "struct S { float a; };\nfloat f(S s) { return sqrt(s.a); }\nfloat g(float a[3]) { return 1.0 / a[1]; }\n"
        "float h(sampler2D t) { return sqrt(texture(t, vec2(0.5)).x - 2.0); }\nmat2 i(mat2 m) { return inverse(m); }\n"
    )
    assert {entry.verdict for entry in lint(str(path)).findings} <= {MAY_FAIL, NOT_PROVEN}


ASSUMED = """\
#version 300 es
precision highp float;
struct Light { vec3 direction; float decay; };
uniform Light lights[2]; // sssgen: assume unit lights.direction
uniform mat4 viewMatrix;
uniform float roughness; // sssgen: assume 0.1 <= roughness <= 1
in vec3 vNormal;
out vec4 color;
vec3 bent(vec3 v) // sssgen: assume nonzero v
{
    return normalize(v);
}
void main() {
    vec3 n = normalize(vNormal);
    vec3 world = normalize((vec4(n, 0.0) * viewMatrix).xyz);
    vec3 l = normalize(lights[1].direction);
    // sssgen: assume 0 <= tint <= 1
    vec3 tint = color.rgb;
    color = vec4(bent(world) + l + sqrt(tint), 1.0 / roughness);
}
"""


def test_assumptions_of_presets_and_comments(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Each assumption proves something, and is listed."""
    path = tmp_path / "assumed.frag"
    path.write_text(re.sub(r"//.*", "", ASSUMED))
    assert len(lint(str(path), False).unproven()) == 5
    path.write_text(ASSUMED)
    assert [finding.site.node.span.line for finding in lint(str(path), False).unproven()] == [14, 15]
    report = lint(str(path), False, assumed=["threejs"])
    assert report.unproven() == []
    facts = {(fact.name, fact.source) for fact in report.assumptions}
    assert facts >= {("vNormal", "threejs"), ("viewMatrix", "threejs"), ("lights.direction", "comment")}
    assert ("bent(), line 9", "source") in facts
    assert main(["lint", str(path), "--assume", "threejs", "--no-examples"]) == 0
    assert "assumed (threejs): viewMatrix: orthonormal" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("comment", "message"),
    [
        ("assume", "nothing is assumed here"),
        ("asume x > 0", "unknown words behind 'sssgen:'"),
        ("assume unit", "'unit' is no assumption"),
        ("assume nothing > 0", "there is no input 'nothing'"),
        ("assume 2 <= roughness <= 1", "no number is in 2..1"),
        ("assume roughness is small", "'roughness is small' is no assumption"),
    ],
)
def test_wrong_comments_are_reported_with_their_place(comment: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "wrong.frag"
    path.write_text(ASSUMED.replace("assume 0.1 <= roughness <= 1", comment))
    with pytest.raises(SssgenError, match=re.escape(message)) as raised:
        lint(str(path))
    assert raised.value.diagnostics[0].span[:3] == (str(path), 6, 26)


def test_wrong_comments_in_functions(tmp_path: Path) -> None:
    path = tmp_path / "wrong.glsl"
    for comment, message in (
        ("assume missing > 0", "missing"),
        ("assume finite x", "'finite' is for the inputs of a file"),
        ("assume x >", "not expected here"),
    ):
        path.write_text(f"float f(float x)\n{{\n    // sssgen: {comment}\n    return x;\n}}\n")
        with pytest.raises(SssgenError, match=re.escape(message)) as raised:
            lint(str(path))
        assert raised.value.diagnostics[0].span.line == 3
    path.write_text(
        "float f(float x)\n{\n    if (x < 0.0)\n        // sssgen: assume x > 1\n        x = 1.0;\n    return x;\n}\n"
    )
    with pytest.raises(SssgenError, match="an assumption cannot be here"):
        lint(str(path))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[[assume]]\nnames = ['x']\n", "this rule assumes nothing"),
        ("[[assume]]\nrange = [0, 1]\n", "this rule has no names"),
        ("[[assume]]\nnames = ['x']\nrange = [1, 0]\n", "must be two numbers"),
        ("[[assume]]\nnames = ['x']\nuni = true\n", "unknown key 'uni'"),
        ("[[assume]]\nnames = ['x']\nunit = true\nstorage = 'varing'\n", "unknown storage 'varing'"),
        ("assume = 1\n", "must be written [[assume]]"),
        ("[[assume]\n", "expected"),
    ],
)
def test_wrong_files_of_assumptions(text: str, message: str, tmp_path: Path, hazards: str) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(text)
    with pytest.raises(SssgenError, match=re.escape(message)) as raised:
        lint(hazards, False, assumed=[str(path)])
    assert raised.value.diagnostics[0].span.file == str(path)


UNUSED = """\
[[assume]]
names = ["roughnes"]
range = [0.0, 1.0]

[[assume]]
names = ["roughness"]
storage = "varying"
range = [0.0, 1.0]

[[assume]]
names = ["*Normal", "nothing"]
nonzero = true
"""


def test_assumptions_that_match_nothing_are_mentioned(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A rule of a file, with the likely name; a preset as a whole; not what another file of the run has."""
    mine, shader, other = tmp_path / "mine.toml", tmp_path / "assumed.frag", tmp_path / "other.glsl"
    mine.write_text(UNUSED)
    shader.write_text(ASSUMED)
    other.write_text("uniform float roughnes;\nfloat f(float x) { return x * roughnes; }\n")
    command = ["lint", str(shader), "--no-examples", "--assume", str(mine)]
    main(command)
    errors = capsys.readouterr().err
    assert f"there is no 'roughnes'\n  --> {mine}:2:9\n" in errors and "did you mean 'roughness'?" in errors
    assert "the input 'roughness' has another storage or type than this rule is about" in errors
    assert errors.count("warning: ") == 2
    main([*command, "--json"])
    warnings = json.loads(capsys.readouterr().out)["warnings"]
    assert [warning["line"] for warning in warnings] == [2, 6]
    main([*command, str(other)])
    assert "roughnes'" not in capsys.readouterr().err
    main(["lint", str(shader), "--no-examples", "--assume", "playcanvas"])
    assert "the preset 'playcanvas' matches no input of this shader" in (errors := capsys.readouterr().err)
    assert "presets that match: babylonjs, colors, generic, threejs, unit-normals" in errors


def test_a_difference_of_fields_has_a_warning_of_its_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shader, rules = tmp_path / "lit.glsl", tmp_path / "mine.toml"
    shader.write_text(
        "struct Lamp { vec3 place; };\nuniform Lamp lamp;\nfloat f(float x) { return x / lamp.place.x; }\n"
    )
    rules.write_text('[[assume]]\nnames = ["lamp.place - p"]\nstorage = "difference"\nnonzero = true\n')
    main(["lint", str(shader), "--no-examples", "--assume", str(rules)])
    errors = capsys.readouterr().err
    assert "matches no difference: there is no 'lamp.place - p'" in errors and "write a comment" in errors


RESTRICTED = """\
uniform float scale; // sssgen: assume scale > 0
float root(float x) { return sqrt(x); }
float scaled(float x) { return sqrt(x) / scale; }
float stated(float x)
{
    // sssgen: assume x > 0
    return log(x) + sqrt(x - 1.0);
}
"""


def test_examples_are_searched_where_nothing_is_assumed(tmp_path: Path) -> None:
    """An assumption stops the search in the functions that it is about."""
    path = tmp_path / "some.glsl"
    path.write_text(RESTRICTED)
    verdicts = {finding.site.node.span.line: finding.verdict for finding in lint(str(path)).unproven()}
    assert verdicts == {2: MAY_FAIL, 3: NOT_PROVEN, 7: NOT_PROVEN}


def test_presets_are_for_plain_glsl(hazards: str) -> None:
    for name in presets():
        lint(hazards, False, assumed=[name])
    with pytest.raises(SssgenError, match="did you mean 'threejs'"):
        lint(hazards, False, assumed=["threejss"])
    with pytest.raises(SssgenError, match="takes no assumptions"):
        lint("ice", False, assumed=["threejs"])


CHAIN = """\
float half_of(float y) { return 0.5 * y; }
float f(float x)
{
    float a = half_of(x);
    float b = 1.0 - a * a;
    return sqrt(b);
}
"""


def test_the_way_to_the_input_is_explained(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "chain.glsl"
    path.write_text(CHAIN)
    (finding,) = lint(str(path), False).unproven()
    steps = [(step.what, step.span.line, step.widens) for step in finding.why]
    assert steps[:2] == [("definition", 5, False), ("operation", 5, True)]
    assert steps[-1] == ("parameter", 2, False)
    assert main(["lint", str(path), "--no-examples"]) == 1
    output = capsys.readouterr().out
    assert "because: 1.0 - a * a widens the range: in -2.5e+11..1, line 5" in output
    assert "because: parameter x is in -1e+06..1e+06, line 2" in output


def test_baselines_follow_moved_lines(hazards: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Known findings do not fail; a second one of the same kind and text does."""
    baseline = str(tmp_path / "known.json")
    command = ["lint", hazards, "--no-examples", "--baseline", baseline]
    assert main([*command, "--write-baseline"]) == 0
    assert main(command) == 0
    text = Path(hazards).read_text()
    Path(hazards).write_text(f"\n\n{text}")
    assert main(command) == 0
    Path(hazards).write_text(text.replace("return a / b;", "float twice = a / b;\n    return twice + a  /  b;"))
    capsys.readouterr()
    assert main([*command, "--json"]) == 0  # the second division cannot fail where the first did not
    Path(hazards).write_text(
        text.replace("return a / b;", "float twice = a / b;\n    b = a;\n    return twice + a / b;")
    )
    assert main(command) == 1
    assert "accepts 2 findings; 1 new" in capsys.readouterr().out


@pytest.mark.parametrize("text", ["{", "[]", '{"version": 1, "findings": [{}]}', '{"version": 2, "findings": []}'])
def test_wrong_baselines(text: str, hazards: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "known.json"
    path.write_text(text)
    assert main(["lint", hazards, "--no-examples", "--baseline", str(path)]) == 2
    assert str(path) in capsys.readouterr().err
    assert main(["lint", hazards, "--write-baseline"]) == 2


def test_compute_shaders(tmp_path: Path) -> None:
    """The places of invocations have their ranges; memory that others write may hold anything at each read."""
    path = tmp_path / "places.comp"
    path.write_text(
        "#version 430\nlayout(local_size_x = 64, local_size_y = 2) in;\n"
        "layout(std430) readonly buffer A { float a[64]; };\nlayout(std430) buffer B { float b[]; };\n"
        "shared float t[32];\nshared uint n;\nuniform uint k;\n"
        "void main() {\n"
        "    uint l = gl_LocalInvocationID.x;\n"
        "    t[l] = a[l];\n"  # 10: t has 32 elements
        "    b[gl_GlobalInvocationID.x] = 1.0 / (float(l) + 1.0);\n"
        "    b[0] = 1.0 / float(l);\n"  # 12
        "    n = 3u;\n"
        "    barrier();\n"
        "    uint before = atomicAdd(n, 1u);\n"
        "    b[1] = float(6u / n) + float(6u / before);\n"  # 16, twice
        "    b[2] = t[gl_LocalInvocationIndex / 4u] + a[gl_LocalInvocationIndex];\n"  # 17: a has 64 elements
        "    b[3] = 1.0 / float(64u - l) + 1.0 / float(gl_NumWorkGroups.x);\n"
        "    if (b[4] > 1.0) { b[5] = 1.0 / b[4]; }\n"  # 19: another invocation may write it in between
        "}\n"
    )
    lines = [entry.span.line for entry in lint(str(path)).findings if entry.verdict != PROVEN]
    assert sorted(lines) == [10, 12, 16, 16, 17, 19]


def test_a_file_with_errors_does_not_stop_the_others(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """They are linted, and the status is that of the errors; a report that would lack findings is not written."""
    good, bad, log = tmp_path / "good.glsl", tmp_path / "bad.glsl", tmp_path / "log.sarif"
    good.write_text("float f(float x) { return 1.0 / x; }\n", encoding="utf-8")
    bad.write_text("float f(float x) { return y; }\n", encoding="utf-8")
    arguments = ["lint", str(bad), str(good), "--no-examples"]
    assert main(arguments) == 2
    printed = capsys.readouterr()
    assert "good.glsl: 1 operation with a domain" in printed.out and "unknown name 'y'" in printed.err
    assert main([*arguments, "--json"]) == 2
    report = json.loads(capsys.readouterr().out)
    assert not report["ok"] and len(report["results"]) == 1 and "'y'" in report["diagnostics"][0]["message"]
    assert main([*arguments, "--sarif", str(log)]) == 2 and not log.exists()


def test_a_scene_of_shadertoy_needs_no_option(tmp_path: Path) -> None:
    """Its uniforms and their ranges are those of the site, also for the examples of its functions."""
    scene, part = tmp_path / "scene.glsl", tmp_path / "part.glsl"
    scene.write_text(
        "float wave(float x) { return sqrt(x) * iTime; }\n"
        "void mainImage(out vec4 color, in vec2 at)\n"
        "{\n"
        "    color = vec4(wave(1.0 - at.x / iResolution.x), 1.0 / iMouse.x, 0.0, 1.0);\n"
        "}\n",
        encoding="utf-8",
    )
    found = {entry.span.line: entry for entry in lint(str(scene)).unproven()}
    assert found.keys() == {1, 4}  # iMouse.x may be 0, iResolution.x is at least 1
    part.write_text("float wave(float x) { return sqrt(x * x) * iTime; }\n", encoding="utf-8")
    with pytest.raises(SssgenError, match=r"write uniform float iTime;, or transpile with --entry shadertoy"):
        lint(str(part))


def test_examples_keep_to_the_ranges_of_uniforms(tmp_path: Path) -> None:
    path = tmp_path / "film.glsl"
    path.write_text(
        "uniform float film_ior : hint_range(1.0, 2.5) = 1.3;\nfloat phase(float c) { return c / (film_ior - 1.0); }\n",
        encoding="utf-8",
    )
    (finding,) = lint(str(path)).unproven()
    assert finding.verdict == MAY_FAIL and '"film_ior": 1.0' in finding.example
