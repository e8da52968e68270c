"""Reads and gathers of integer textures: GLSL's own, or others. The tests of parity compare the values."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from sssgen.ir.intrinsics.integer_reads import GATHERS, READS, integer_gathers, integer_reads
from sssgen.ir.signatures import parse
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.compilers import Source
from sssgen.support.diagnostics import SssgenError

SIGNATURES = [
    *((name, signature) for name in READS for signature in integer_reads(name).signatures),
    *((name, signature) for name in GATHERS for signature in integer_gathers(name).signatures),
]
VALUES = {"float": "0.5", "int": "2", "ivec2": "ivec2(1, -2)", "ivec3": "ivec3(1, -2, 0)"}
"""What an argument is, where it is no parameter; offsets are constants."""


def function(number: int, name: str, signature: str) -> str:
    """A function that reads a texture."""
    result, sampler, *types = parse(signature)
    params = ", ".join([f"{sampler} map", *(f"{type_} p{at}" for at, type_ in enumerate(types) if type_ not in VALUES)])
    arguments = ", ".join(["map", *(VALUES.get(type_, f"p{at}") for at, type_ in enumerate(types))])
    return f"{result} read_{number}({params}) {{ return {name}({arguments}); }}\n"


def text_of(target: str, source: str) -> str:
    files = transpile(load_glsl_text(source, "reads.glsl").module, target, "reads").files
    return "".join(text for name, text in files.items() if not name.endswith(".json"))


@pytest.mark.parametrize("target", ["wgsl", "hlsl", "metal", "glsl-330", "glsl-es-300"])
def test_every_read_compiles(target: str, assert_compiles: Callable[[Source], None]) -> None:
    """All but those of cubes that need a gather, in languages without one: these are refused."""
    gathers = target in ("wgsl", "hlsl")
    functions = []
    for number, (name, signature) in enumerate(SIGNATURES):
        source = function(number, name, signature)
        is_refused = "samplerCube" in signature and not gathers and (name in GATHERS or target == "metal")
        if not is_refused:
            functions.append(source)
            continue
        with pytest.raises(SssgenError, match=f"no {name} " if name in GATHERS else "no texture"):
            text_of(target, source)
    text = text_of(target, "".join(functions))
    assert_compiles(Source(text, target, "library", name="reads"))
    assert len(functions) == {"metal": 72}.get(target, 84 if gathers else 80)
