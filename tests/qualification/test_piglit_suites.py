"""The readers of piglit's vectors and programs, on files of our own in its formats."""

from __future__ import annotations

from pathlib import Path

import pytest

from qualification.suites import piglit_vectors
from qualification.suites.piglit_shaders import read
from qualification.suites.piglit_vectors import Vector, VectorCase, run_case
from qualification.suites.text_cases import builds

MODULE = """
import collections
import numpy as np

Signature = collections.namedtuple("Signature", "name template extension rettype argtypes")
TestVector = collections.namedtuple("TestVector", "arguments result tolerance")
print("what it prints is not shown")
test_suite = {
    Signature("mat", "{0} * {1}", None, "vec2", ("mat2", "vec2")): [
        TestVector((np.array([[1.0, 2.0], [3.0, 4.0]]), np.array([1.0, 10.0])), np.array([21.0, 43.0]), 0.001)
    ],
    Signature("op-assign-add", "{0};\\n  result += {1}", None, "int", ("int", "int")): [
        TestVector((np.int32(2), np.int32(3)), np.int32(5), 0.0),
        TestVector((np.int32(2), np.int32(-3)), np.int32(7), 0.0),
    ],
    Signature("wide", "{0}", "ARB_gpu_shader_int64", "int64_t", ("int64_t",)): [TestVector((1,), 1, 0.0)],
}
"""
PROGRAM = """[require]
GLSL >= 1.30

[vertex shader]
in vec4 piglit_vertex;
out vec2 uv;
void main() { uv = piglit_vertex.xy; gl_Position = piglit_vertex; }

[fragment shader]
in vec2 uv;
void main() { gl_FragColor = vec4(uv, 0.0, 1.0); }

[test]
draw rect -1 -1 2 2
"""


def test_vectors_are_read_and_run(tmp_path: Path) -> None:
    path = tmp_path / piglit_vectors.MODULE
    path.parent.mkdir()
    path.write_text(MODULE, "utf-8")
    matrix, added, wide = piglit_vectors.cases(tmp_path)
    assert matrix == VectorCase(
        "piglit-vectors/mat(mat2, vec2)", "a0 * a1", "vec2", ("mat2", "vec2"), (matrix.vectors[0],)
    )
    assert matrix.vectors[0].arguments == ((1.0, 3.0, 2.0, 4.0), (1.0, 10.0))
    pytest.importorskip("moderngl", reason="moderngl is missing: pip install -e '.[gl]'")
    (result,) = run_case(matrix)
    assert {outcome.outcome for outcome in result.outcomes.values()} == {"right"} and len(result.outcomes) == 8
    right, wrong = run_case(added)
    assert {outcome.outcome for outcome in right.outcomes.values()} == {"right"}
    assert {outcome.outcome for outcome in wrong.outcomes.values()} == {"wrong"}
    assert wrong.outcomes["numpy"].why == "((2.0,), (-3.0,)) is [-1.0], [7.0] is expected"
    assert run_case(wide)[0].kind == "skipped"


def test_a_vector_is_near_within_its_tolerance() -> None:
    pytest.importorskip("moderngl", reason="moderngl is missing: pip install -e '.[gl]'")
    vectors = (Vector(((0.0, 0.0),), (0.03, 0.04), 0.06), Vector(((0.0, 0.0),), (0.03, 0.04), 0.04))
    near, far = run_case(VectorCase("own/same(vec2)", "a0", "vec2", ("vec2",), vectors))
    assert (near.outcomes["numpy"].outcome, far.outcomes["numpy"].outcome) == ("right", "wrong")


def test_a_program_is_read() -> None:
    case = read(PROGRAM, "own/uv.shader_test")
    assert case is not None and (case.name, case.label) == ("piglit/own/uv.shader_test", "uv.frag")
    assert case.text.startswith("#version 130\nin vec2 uv;") and case.vertex.startswith("#version 130\n")
    assert case.valid and not case.skipped
    passthrough = read(PROGRAM.replace("[vertex shader]", "[vertex shader passthrough]\n[notes]"), "own/uv.shader_test")
    assert passthrough is not None and not passthrough.vertex
    unlinked = read(PROGRAM.replace("draw rect", "link error\ndraw rect"), "own/uv.shader_test")
    assert unlinked is not None and not unlinked.valid
    geometry = read(PROGRAM.replace("[vertex shader]", "[geometry shader]"), "own/uv.shader_test")
    assert geometry is not None and geometry.skipped == "it has the section geometry shader"
    assert read("[require]\n[test]\n", "own/empty.shader_test") is None
    embedded = read(PROGRAM.replace("GLSL >= 1.30", "GLSL ES >= 3.00"), "own/uv.shader_test")
    assert embedded is not None and embedded.text.startswith("#version 300 es\n")


def test_a_program_of_two_stages_is_compiled() -> None:
    pytest.importorskip("wgpu", reason="wgpu is missing: pip install -e '.[webgpu]'")
    case = read(PROGRAM, "own/uv.shader_test")
    assert case is not None
    assert {name: outcome.outcome for name, outcome in builds(case).items()} == dict.fromkeys(
        ("wgsl", "hlsl", "glsl-330", "glsl-es-300"), "right"
    )
    unwritten = builds(
        case._replace(vertex=case.vertex.replace("uv = piglit_vertex.xy;", "").replace("out vec2 uv;", ""))
    )
    assert {outcome.outcome for outcome in unwritten.values()} == {"refused"}
