"""Differences between GLSL, HLSL and WGSL: each file of tests/pitfalls is one rule, with cases that show all languages.

A case is a source under `=== source` (see `validate`) and behind it what each target makes of it. GLSL ES stands there
where it differs from GLSL 3.30, and Unity's dialects where they differ from HLSL. A new case is a new source;
UPDATE_SNAPSHOTS=1 adds and renews the rest, for review. Every case is compiled here, and run by test_execution.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

import sssgen
from pitfall_cases import COMPARED_WITH, RULES, program, read
from sssgen.pipeline.compiler import transpile
from sssgen.run.compilers import Source
from validate import TARGETS, module_of, validate_all


@pytest.mark.parametrize("path", RULES, ids=lambda path: path.stem)
def test_rule(path: Path) -> None:
    rule, cases = read(path)
    assert rule.endswith(".")
    for case in cases:
        assert {target for target, beside in COMPARED_WITH.items() if not beside} <= set(case.texts), case.source
        validate_all(case.source, case.texts)


def test_names_are_used_once() -> None:
    whole, functions = program()
    assert len({function.key for function in whole.functions}) == len(whole.functions)
    assert len({function.name for _, function in functions}) == len(functions)


@pytest.mark.parametrize("target", [*TARGETS, "metal", "unity-shadergraph", "unreal", "bevy", "tsl"])
def test_every_case_compiles(target: str, assert_compiles: Callable[[Source], None]) -> None:
    """All cases in one library, in every compiler that reads the target."""
    name = TARGETS.get(target, target)
    files = transpile(program()[0], name, "pitfalls").files
    (file,) = [file for file in files if not file.endswith(".json")]
    assert_compiles(Source(files[file], name, "library", name=file))


def test_renames_are_reported() -> None:
    module = module_of("float f(float lerp, float x1) { float point = 2.0 * lerp; return point * x1; }")
    for target in ("glsl-330", "wgsl", "numpy"):
        assert transpile(module, target, "case").reflection["renames"] == {"f.lerp": "lerp_", "f.point": "point_"}


@pytest.mark.parametrize("target", sssgen.all_targets())
def test_conventions_are_reported(target: str) -> None:
    """The direction of y, rows and columns, the encoding of colors: the text does not show them."""
    conventions = sssgen.compile("ice", target).reflection["conventions"]
    assert {"matrices", "framebuffer_y", "uv_origin", "color_space"} <= set(conventions)
    in_a_shell = target not in ("numpy", "shadertoy", "tsl", "unity-shadergraph", "unreal")
    assert {"clip_y", "clip_z"} <= set(conventions) or not in_a_shell


def test_precision_is_declared_where_there_is_no_default() -> None:
    compiled = sssgen.compile("wax_mouse", "glsl-es-300").files["wax_mouse.glsl-es-300.frag"]
    code = [line for line in compiled.splitlines() if line and not line.startswith("//")]
    assert code[0] == "#version 300 es"
    assert {"precision highp float;", "precision highp int;", "precision highp sampler3D;"} <= set(code[1:5])
