"""Choices between constants, for a target that cannot compute those between vectors made of vectors."""

from __future__ import annotations

import pytest

from sssgen.ir import nodes as ir
from sssgen.ir.constant_expressions import constant_numbers
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.lang.polyfills import polyfill
from sssgen.passes.legal.legalise import legalise
from sssgen.targets.registry import load


@pytest.mark.parametrize("target", ["glsl-330", "hlsl", "wgsl"])
@pytest.mark.parametrize(
    ("value", "numbers"),
    [
        ("mix(vec3(vec2(1.0), 3.0), vec3(4.0), bvec3(true, false, false))", (4.0, 1.0, 3.0)),
        ("mix(ivec3(ivec2(1), 3), ivec3(4), bvec3(false, true, false))", (1, 4, 3)),
        ("ONE < 2.0 ? vec3(vec2(1.0), 3.0) : vec3(4.0)", (1.0, 1.0, 3.0)),
    ],
)
def test_choices_of_constants_are_numbers(value: str, numbers: tuple[float, ...], target: str) -> None:
    type_ = "ivec3" if "ivec3" in value else "vec3"
    module = load_glsl_text(f"const float ONE = 1.0;\n{type_} f() {{ return {value}; }}", "case.glsl").module
    chosen = load(target)
    capabilities = chosen.capabilities._replace(constant_choices=False)
    (stmt,) = legalise(module, chosen.dialect, capabilities, polyfill).functions[-1].body or ()
    assert isinstance(stmt, ir.Return)
    assert isinstance(stmt.value, ir.Construct)
    assert constant_numbers(stmt.value) == numbers
