"""Suites whose cases are only translated and compiled, on folders of our own."""

from __future__ import annotations

from pathlib import Path

import pytest

from qualification.suites import text_folders
from qualification.suites.compiled_texts import complaint
from qualification.suites.features import unsayable
from qualification.suites.outcomes import Result
from qualification.suites.text_cases import TextCase, run_case

FRAGMENT = "#version 330\nin vec2 uv;\nout vec4 color;\nvoid main() { color = vec4(uv, 0.0, 1.0); }\n"


def write(folder: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")


def outcomes(result: Result) -> dict[str, str]:
    return {name: outcome.outcome for name, outcome in result.outcomes.items()}


def test_spirv_cross_without_assembler(tmp_path: Path) -> None:
    write(
        tmp_path,
        {
            "shaders/frag/plain.frag": FRAGMENT,
            "shaders/asm/frag/plain.asm.frag": "; SPIR-V",
            "shaders-hlsl/comp/wide.comp": "double wide;",
            "shaders/tesc/other.tesc": "",
        },
    )
    cases = list(text_folders.spirv_cross(tmp_path))
    assert [case.name for case in cases] == [
        "spirv-cross/shaders/frag/plain.frag",
        "spirv-cross/shaders-hlsl/comp/wide.comp",
    ]
    assert [case.skipped for case in cases] == ["", "numbers of 8, 16 or 64 bits"]


def test_glslang_says_which_texts_are_valid(tmp_path: Path) -> None:
    write(
        tmp_path / "Test",
        {
            "good.frag": FRAGMENT,
            "bad.frag": "void main() { vec2 a = vec3(1.0); }",
            "unknown.frag": FRAGMENT,
            "linked.frag": FRAGMENT,
            "baseResults/linked.frag.out": "linked.frag\nERROR: Linking fragment stage: Missing entry point\n",
            "baseResults/good.frag.out": "good.frag\nShader version: 330\n",
            "baseResults/bad.frag.out": "bad.frag\nERROR: 0:1: '=' : cannot convert\n",
        },
    )
    bad, good, linked = text_folders.glslang(tmp_path)
    assert linked.skipped and not good.skipped
    assert (bad.name, bad.valid) == ("glslang/bad.frag", False)
    assert (good.name, good.valid) == ("glslang/good.frag", True)
    assert outcomes(run_case(bad)) == {"front end": "right"}
    assert outcomes(run_case(bad._replace(text=FRAGMENT))) == {"front end": "accepted"}


def test_naga_and_lygia(tmp_path: Path) -> None:
    write(tmp_path / "naga/tests/in/glsl", {"a.vert": "", "a.params.toml": ""})
    assert [case.name for case in text_folders.naga(tmp_path)] == ["naga-glsl/a.vert"]
    write(
        tmp_path / "library",
        {
            "math/half.glsl": "float half_of(float x) { return 0.5 * x; }",
            "math/quarter.glsl": '#include "half.glsl"\nfloat quarter(float x) { return half_of(half_of(x)); }',
            "math/lost.glsl": '#include "missing.glsl"\n',
        },
    )
    half, lost, quarter = text_folders.lygia(tmp_path / "library")
    assert half.name == "lygia/math/half.glsl" and "half_of" in quarter.text and "#error" in lost.text


def test_each_text_is_compiled() -> None:
    pytest.importorskip("wgpu", reason="wgpu is missing: pip install -e '.[webgpu]'")
    result = run_case(TextCase("own/a.frag", "a.frag", FRAGMENT))
    assert result.kind == "builds" and outcomes(result) == dict.fromkeys(
        ("wgsl", "hlsl", "glsl-330", "glsl-es-300"), "right"
    )
    assert complaint({"a.fragment.wgsl": "fn main( {}"}).startswith("naga: ")
    kernel = TextCase(
        "own/d.comp", "d.comp", "#version 430\nlayout(local_size_x = 4) in;\nvoid main() { barrier(); }\n"
    )
    assert outcomes(run_case(kernel)) == dict.fromkeys(("wgsl", "hlsl", "glsl-330", "metal"), "right")
    refused = run_case(TextCase("own/b.frag", "b.frag", FRAGMENT.replace("vec2 uv", "vec5 uv")))
    assert outcomes(refused) == {"front end": "refused"}


def test_what_glslang_refuses_is_skipped() -> None:
    pytest.importorskip("wgpu", reason="wgpu is missing: pip install -e '.[webgpu]'")
    result = run_case(TextCase("own/c.frag", "c.frag", FRAGMENT.replace("uv,", "missing,"), judged=True))
    assert result.kind == "skipped" and "missing" in result.outcomes["front end"].why


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("uniform dvec3 a;", "numbers of 8, 16 or 64 bits"),
        ("#extension GL_KHR_shader_subgroup_basic : enable", "operations of subgroups"),
        ("// double trouble, gl_Layer\nuniform vec3 a;", ""),
        ("layout(location = 0, index = 1) out vec4 b;", "places within a location"),
    ],
)
def test_features_that_wgsl_lacks(text: str, why: str) -> None:
    assert unsayable(text) == why
