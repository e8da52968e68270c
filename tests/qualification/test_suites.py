"""The runner of outside suites, on a file of our own in their format."""

from __future__ import annotations

from pathlib import Path

import pytest

from qualification.suites.deqp_cases import Case, SuiteFormatError, Value, read
from qualification.suites.deqp_programs import stage_text
from qualification.suites.deqp_runs import run_case
from qualification.suites.lenience import LENIENCE, class_of
from qualification.suites.outcomes import Result
from qualification.suites.page import page, table

TEXT = """
# a comment
group doubles "Doubling"
    case of_a_vector
        version 300 es
        require limit "GL_MAX_VERTEX_IMAGE_UNIFORMS" > 0
        desc "Twice as much"
        values
        {
            input vec2 in0 = [ vec2(1.0, -2.0) | vec2(0.5, 4.0) ];
            uniform int uni0 = [ 2 | 3 ];
            output vec2 out0 = [ vec2(2.0, -4.0) | vec2(RIGHT, 12.0) ];
        }
        both ""
            #version 300 es
            precision highp float;
            ${DECLARATIONS}
            float scale = 1.0;
            void main()
            {
                ${SETUP}
                out0 = in0 * float(uni0) * scale;
                ${OUTPUT}
            }
        ""
    end
    case of_a_bool
        version 300 es
        expect compile_fail
        both ""
            #version 300 es
            precision highp float;
            ${DECLARATIONS}
            void main() { ${POSITION_FRAG_COLOR} = vec4(2.0 * OPERAND); }
        ""
    end
    case between_stages
        version 300 es
        vertex ""
            #version 300 es
            ${VERTEX_DECLARATIONS}
            out mediump float amount;
            void main() { amount = 1.0; ${VERTEX_OUTPUT} }
        ""
        fragment ""
            #version 300 es
            precision mediump float;
            ${FRAGMENT_DECLARATIONS}
            in mediump float amount;
            void main() { ${FRAG_COLOR} = vec4(amount); }
        ""
    end
    case with_a_geometry_stage
        version 310 es
        geometry ""
            #version 310 es
        ""
    end
end
"""


def cases(folder: Path, right: str = "1.5", operand: str = "true") -> list[Case]:
    path = folder / "own.test"
    path.write_text(TEXT.replace("RIGHT", right).replace("OPERAND", operand), "utf-8")
    return list(read(path, "own"))


def outcomes(result: Result) -> dict[str, str]:
    return {name: outcome.outcome for name, outcome in result.outcomes.items()}


def test_a_file_is_read(tmp_path: Path) -> None:
    vector, wrong, stages, geometry = cases(tmp_path)
    assert vector.name == "own.doubles.of_a_vector" and vector.version == "300 es" and vector.expects == "pass"
    assert vector.requires == ("limit GL_MAX_VERTEX_IMAGE_UNIFORMS > 0",)
    assert vector.values[0] == Value("input", "vec2", "in0", ((1.0, -2.0), (0.5, 4.0)))
    assert vector.stages["both"].startswith("#version 300 es\nprecision highp float;\n")
    assert wrong.expects == "compile_fail" and [*stages.stages] == ["vertex", "fragment"]
    assert [*geometry.stages] == ["geometry"]


def test_required_extensions_are_in_the_texts_of_their_stages(tmp_path: Path) -> None:
    path = tmp_path / "own.test"
    extension = 'require extension { "GL_OWN_a" | "GL_OWN_b" } in { vertex }\n        require extension "GL_OWN_c"'
    text = TEXT.replace("RIGHT", "1.5").replace("between_stages\n", f"between_stages\n        {extension}\n")
    path.write_text(text, "utf-8")
    case = next(each for each in read(path, "own") if "vertex" in each.stages)
    assert case.requires == ("extension GL_OWN_a | GL_OWN_b in vertex", "extension GL_OWN_c")
    lines = ["#version 300 es", "#extension GL_OWN_a : require", "#extension GL_OWN_c : require"]
    assert stage_text(case, "vertex").splitlines()[:3] == lines
    assert stage_text(case, "fragment").splitlines()[:2] == [lines[0], lines[2]]


def test_a_file_in_another_format(tmp_path: Path) -> None:
    path = tmp_path / "other.test"
    path.write_text("group a end end", "utf-8")
    with pytest.raises(SuiteFormatError, match="is no group"):
        list(read(path, "own"))


def test_each_kind_of_case_has_its_outcome(tmp_path: Path) -> None:
    pytest.importorskip("moderngl", reason="moderngl is missing: pip install -e '.[gl]'")
    results = [run_case(case) for case in cases(tmp_path)]
    assert [result.kind for result in results] == ["values", "must fail", "builds", "skipped"]
    assert all(set(outcomes(result).values()) == {"right"} for result in results[:3])
    assert len(outcomes(results[0])) == 8
    accepted = run_case(cases(tmp_path, operand="1.0")[1])
    assert outcomes(accepted) == {"front end": "accepted"}
    wrong = run_case(cases(tmp_path, right="1.7")[0])
    assert set(outcomes(wrong).values()) == {"wrong"}
    assert "[[1.5], [12.0]]" in wrong.outcomes["numpy"].why
    text = table({"gles3": [*results, accepted, wrong]})
    assert "| gles3 | values | NumPy | 1 | 1 |" in text
    assert "| other | 1 |" in page({"gles3": [accepted]}, "2000-01-01", 1, {})


def test_each_class_of_lenience_has_a_reason() -> None:
    assert all(lenience.why for lenience in LENIENCE.values())
    assert class_of("piglit/glsl-mismatched-uniform-precision-unused") == "precision"
    assert class_of("gles3/own.case") == "other"
