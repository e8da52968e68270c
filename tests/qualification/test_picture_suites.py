"""The suites whose result is a picture, on texts of our own in their formats."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from qualification.suites import amber_cases, amber_runs, sample_cases, webgl_cases, webgl_runs
from qualification.suites.outcomes import Result
from qualification.suites.pictures import Translations, for_driver, of_fragment
from qualification.suites.text_cases import TextCase

AMBER = """#!amber
# A comment.
SHADER vertex plain_vertex PASSTHROUGH

# half_fragment is derived from the following GLSL:
# #version 310 es
# precision highp float;
# layout(set = 0, binding = 0) uniform Sizes { vec2 size; float shades[2]; };
# layout(push_constant) uniform Constants { int count; };
# layout(location = 0) out vec4 color;
#
# void main()
# {
#     color = vec4(shades[1], 0.0, float(count) / 255.0, 1.0);
#     if (gl_FragCoord.x > size.x / 2.0) { discard; }
# }
SHADER fragment half_fragment SPIRV-ASM TARGET_ENV spv1.0
; nothing
END

BUFFER sizes DATA_TYPE float STD140 DATA
 16.0 8.0
END
BUFFER count DATA_TYPE int32 DATA
 COUNT
END
BUFFER picture FORMAT B8G8R8A8_UNORM
PIPELINE graphics half
  ATTACH plain_vertex
  ATTACH half_fragment
  FRAMEBUFFER_SIZE 16 8
  BIND BUFFER picture AS color LOCATION 0
  BIND BUFFER sizes AS uniform DESCRIPTOR_SET 0 BINDING 0
  BIND BUFFER count AS push_constant
END
CLEAR_COLOR half 0 0 0 255
CLEAR half
RUN half DRAW_RECT POS 0 0 SIZE 16 8

EXPECT picture IDX 0 0 SIZE 8 8 EQ_RGBA 0 0 3 255
EXPECT picture IDX 8 0 SIZE 8 8 EQ_RGB 0 0 0
EXPECT picture EQ_HISTOGRAM_EMD_BUFFER picture TOLERANCE 0.005
"""
SCRIPT = """# A compute shader:
# #version 310 es
# layout(std430, binding = 0) buffer Data { int first; int rest[]; };
# layout(local_size_x = 1) in;
# void main() { first = 42; }

[compute shader spirv]
; nothing
[test]
uniform ubo 0:1 vec2 0 0.0 1.0
ssbo 0 subdata int 0 7
ssbo 0 subdata int 4 1 2
compute 1 2 1
probe ssbo int 0 4 == 1
"""
PAGE = """<script id="green" type="x-shader/x-fragment">#version 300 es
precision mediump float;
uniform float bright[2];
out vec4 color;
void main() { color = vec4(0.0, bright[1], 0.0, 1.0); }
</script>
<script id="broken" type="x-shader/x-fragment">#version 300 es
precision mediump float;
void main() { float a = true; }
</script>
<script>
GLSLConformanceTester.runRenderTests([
{ fShaderId: 'green', fShaderSuccess: true, linkSuccess: true, passMsg: 'Green',
  uniforms: [{name: 'bright', functionName: 'uniform1fv', value: [0.5, BRIGHT]}] },
{ fShaderId: 'broken', fShaderSuccess: false, linkSuccess: false, passMsg: 'Not green' },
], 2);
</script>
"""
DRAWN = """<script id="vs" type="x-shader/x-vertex">#version 300 es
in vec4 position; void main() { gl_Position = position; }
</script>
<script id="fs" type="x-shader/x-fragment">#version 300 es
precision mediump float; out vec4 color; void main() { color = vec4(1.0); }
</script>
<script>const program = setup(gl, ["vs", "fs"]);</script>
"""
VERTEX = """attribute vec4 gtf_Vertex;
attribute vec4 gtf_Color;
uniform mat4 gtf_ModelViewProjectionMatrix;
varying vec4 color;
void main() { color = gtf_Color; gl_Position = gtf_ModelViewProjectionMatrix * gtf_Vertex; }
"""
FRAGMENT = "precision mediump float; varying vec4 color;\nvoid main() { gl_FragColor = vec4(VALUE, color.gb, 1.0); }\n"


def run_amber(folder: Path, count: int) -> Result:
    path = folder / "half.amber"
    path.write_text(AMBER.replace("COUNT", str(count)), "utf-8")
    return amber_runs.run_case(amber_cases.read(path))


def distinct_outcomes(result: Result) -> set[str]:
    return {outcome.outcome for outcome in result.outcomes.values()}


@pytest.fixture(autouse=True)
def needs_opengl() -> None:
    pytest.importorskip("moderngl", reason="moderngl is missing: pip install -e '.[gl]'")


def test_a_case_of_amber(tmp_path: Path) -> None:
    result = run_amber(tmp_path, 3)
    assert distinct_outcomes(result) == {"right"}, result
    assert {"driver", "gl", "numpy"} <= set(result.outcomes)
    wrong = run_amber(tmp_path, 4)
    assert distinct_outcomes(wrong) == {"wrong", "skipped"}  # the driver is wrong, too
    assert wrong.outcomes["driver"].why == "64 of 64 pixels; the first is [0, 0, 4, 255]"


def test_a_script_of_amber(tmp_path: Path) -> None:
    path = tmp_path / "script.amber"
    path.write_text(SCRIPT, "utf-8")
    case = amber_cases.read(path)
    (pipeline,) = case.pipelines
    assert "void main() { first = 42; }" in pipeline.stages["compute"]
    assert np.frombuffer(case.buffers[pipeline.bound["0:0"]], np.int32).tolist() == [7, 1, 2]
    assert np.frombuffer(case.buffers[pipeline.bound["0:1"]], np.float32).tolist() == [0.0, 1.0]
    assert (case.expects[0].place, case.expects[0].values) == ((4,), (1.0,))


def test_a_compute_shader_of_amber(tmp_path: Path) -> None:
    path = tmp_path / "script.amber"
    for expected, outcome in (("1", "right"), ("2", "wrong")):
        path.write_text(SCRIPT.replace("4 == 1", f"4 == {expected}"), "utf-8")
        result = amber_runs.run_case(amber_cases.read(path))
        assert result.kind == "buffers" and distinct_outcomes(result) == {outcome}, result
        assert {"driver", "gl"} <= set(result.outcomes)


@pytest.mark.parametrize(
    ("type_", "std140", "numbers", "size"),
    [("float[]", True, "1 2", 32), ("float", False, "1 2", 8), ("vec3<float>", False, "1 2 3", 16),
     ("mat2x2<float>", True, "1 2 3 4", 32), ("vec2<int32>", True, "1 -2", 8)],
)  # fmt: skip
def test_the_bytes_of_a_buffer(type_: str, std140: bool, numbers: str, size: int) -> None:
    assert len(amber_cases.packed(type_, std140, numbers.split())) == size


def test_the_distance_of_histograms() -> None:
    black, white = np.zeros((10, 4), np.int64), np.full((10, 4), 255)
    assert amber_runs.histogram_distance(black, black) == 0.0
    assert amber_runs.histogram_distance(black, white) == pytest.approx(255 / 256)


def test_a_page_of_the_tester() -> None:
    green, broken = webgl_cases.page_cases(PAGE.replace("BRIGHT", "1.0"), "a.html")
    assert isinstance(green, webgl_cases.PictureCase) and green.uniforms == {"bright": (0.5, 1.0)}
    assert isinstance(broken, TextCase) and not broken.valid
    (result, refused) = webgl_runs.run_cases([green, broken])
    assert distinct_outcomes(result) == {"right"}, result
    assert refused.kind == "must fail" and distinct_outcomes(refused) == {"right"}
    dark, _ = webgl_cases.page_cases(PAGE.replace("BRIGHT", "0.9"), "a.html")
    assert distinct_outcomes(webgl_runs.run_cases([dark])[0]) == {"wrong", "skipped"}


def test_another_page_with_shaders() -> None:
    (case,) = webgl_cases.page_cases(DRAWN, "b.html")
    (bad,) = webgl_cases.page_cases(DRAWN.replace("fs", "badfs"), "b.html")
    assert isinstance(case, TextCase) and case.name == "b.html#vs,fs" and case.valid
    assert isinstance(bad, TextCase) and not bad.valid  # the page names what does not link


@pytest.mark.parametrize(
    ("value", "model", "outcome"), [("color.r", "grid", {"right"}), ("0.5", None, {"wrong", "skipped"})]
)
def test_a_page_of_ogles(tmp_path: Path, value: str, model: str | None, outcome: set[str]) -> None:
    fragments = {"ref.frag": "color.r", "a.frag": value}
    files = {"a.vert": VERTEX, **{name: FRAGMENT.replace("VALUE", red) for name, red in fragments.items()}}
    for name, text in files.items():
        (tmp_path / name).write_text(text, "utf-8")
    programs = {
        key: {"vertexShader": "a.vert", "fragmentShader": name}
        for key, name in (("referenceProgram", "ref.frag"), ("testProgram", "a.frag"))
    }
    test = {"name": "a.test.html", "pattern": "compare", "model": model, **programs}
    path = tmp_path / "a.html"
    run = f"OpenGLESTestRunner.run({json.dumps({'tests': [test]})[:-2]},]}});\nvar successfullyParsed = true;"
    path.write_text(run, "utf-8")
    (result,) = webgl_runs.run_cases([*webgl_cases.ogles_cases(path, "a")])
    assert distinct_outcomes(result) == outcome, result


def test_a_sample(tmp_path: Path) -> None:
    folder = tmp_path / sample_cases.FOLDER / "100"
    folder.mkdir(parents=True)
    text = "#version 100\nprecision mediump float;\nuniform vec2 resolution;\nuniform sampler2D tex;\n"
    text += "void main() { gl_FragColor = texture2D(tex, gl_FragCoord.xy / resolution); }\n"
    (folder / "a.frag").write_text(text, "utf-8")
    values = {"resolution": {"func": "glUniform2f", "args": [256.0, 256.0]}, "tex": {"texture": "DEFAULT"}}
    (folder / "a.json").write_text(json.dumps(values), "utf-8")
    (case,) = sample_cases.cases(tmp_path)
    result = sample_cases.run_case(case)
    assert case.name == "100/a.frag" and distinct_outcomes(result) == {"right"}, result


def test_a_sample_that_computes(tmp_path: Path) -> None:
    folder = tmp_path / sample_cases.FOLDER / "compute"
    folder.mkdir(parents=True)
    text = "#version 320 es\nlayout(std430, binding = 0) buffer Data { int first; int rest[]; };\n"
    text += "layout(local_size_x = 2) in;\nuniform float scale;\n"
    text += "void main() { rest[gl_GlobalInvocationID.x] += first * int(scale); }\n"
    (folder / "a.comp").write_text(text, "utf-8")
    fields = [{"type": "int", "data": [3]}, {"type": "int", "data": [1, 2, 3, 4]}]
    values = {
        "$compute": {"num_groups": [2, 1, 1], "buffer": {"binding": 0, "fields": fields}},
        "scale": {"args": [2.0]},
    }
    (folder / "a.json").write_text(json.dumps(values), "utf-8")
    (case,) = sample_cases.cases(tmp_path)
    assert np.frombuffer(case.buffer, np.int32).tolist() == [3, 1, 2, 3, 4]
    result = sample_cases.run_case(case)
    assert result.kind == "buffers" and distinct_outcomes(result) == {"right"}, result


def test_stable_pixels_depend_on_no_rounding() -> None:
    text = """#version 300 es
precision highp float;
out vec4 color;
void main() {
    float noisy = gl_FragCoord.y < 4.0 ? fract(sin(gl_FragCoord.x * 1e6) * 1e6) : 0.5;
    float undefined = gl_FragCoord.x < 4.0 ? clamp(0.5, 1.0, gl_FragCoord.y * 0.0) : 0.5;
    color = vec4(noisy, undefined, 0.5, 1.0);
}
"""
    stable = sample_cases.stable_places(of_fragment(text, (16, 16)))
    assert stable[8:12, 8:12].all() and not stable[:4].any() and not stable[:, :4].any()


def test_the_author_s_text_for_the_driver() -> None:
    own = "layout(set = 0, binding = 1) uniform A { int a; };\nlayout(push_constant) uniform B { int b; };\n"
    text = for_driver(f"#version 310 es\n{own}layout(set = 0, binding = 2) uniform sampler2D c;\n")
    assert "layout(std140, binding = 1) uniform A" in text and "layout(std140) uniform B" in text
    assert "layout(binding = 2) uniform sampler2D c" in text and "#define mediump highp" in text
    assert for_driver("void main() {}").startswith("#version 100\n")


def test_the_numbers_of_uniforms() -> None:
    text = """#version 310 es
precision highp float;
struct S { vec3 a; float b; };
uniform Own { mat2 m; float list[2]; S s[2]; } own;
uniform S loose[2];
out vec4 color;
void main() { color = vec4(own.m[1], own.list[1], own.s[1].b) + loose[1].b; }
"""
    data = np.arange(40, dtype=np.float32)
    program = of_fragment(text, (4, 4))._replace(blocks={"Own": data.tobytes()}, uniforms={"loose[1].b": np.array(5.0)})
    elements = Translations(program).elements()
    assert elements["own.m"] == (0.0, 1.0, 4.0, 5.0)
    assert (elements["own.list[1]"], elements["own.s[1].b"]) == ((12.0,), (23.0,))
    assert (elements["loose[0].b"], elements["loose[1].b"]) == ((0.0,), (5.0,))
