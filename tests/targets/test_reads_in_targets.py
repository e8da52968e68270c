"""Every texture builtin for every sampler type in every target: the text compiles, or the error has a place
or names the type.

`test_intrinsics_in_targets.py` compiles each overload with variables for arguments; here they are expressions, which
polyfills cannot repeat, in a shader that is translated as its author wrote it.
"""

from __future__ import annotations

from collections.abc import Callable

import pytest

from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.signatures import overloads
from sssgen.ir.types import BY_NAME, FLOAT, Sampler, Type, spell
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.compilers import Source
from sssgen.support.diagnostics import SssgenError
from validate import SAMPLERS

READS = [row.name for row in BUILTINS.values() if row.kind == "fetch"]
FEW = ["texture", "textureOffset", "textureGather", "textureGatherOffset"]
TARGETS = ["glsl-330", "glsl-es-300", "hlsl", "wgsl", "numpy"]
VALUES = {
    "float": "(x * 0.5)", "int": "int(x + 1.0)", "vec2": "vec2(x, x + 0.5)", "vec3": "vec3(x, x + 0.5, 1.0)",
    "vec4": "vec4(x, x + 0.5, 1.0, 0.5)", "ivec2": "ivec2(int(x), 1)", "ivec3": "ivec3(int(x), 1, 0)",
}  # fmt: skip
CONSTANTS = {"int": "1", "ivec2": "ivec2(1, -2)", "ivec3": "ivec3(1, -2, 0)"}


def function(name: str, types: tuple[Type, ...], result: Type, number: int) -> str:
    """A function that reads the texture at expressions of x."""
    constants = BUILTINS[name].constants(types)
    args = [(CONSTANTS if index in constants else VALUES)[spell(type_)] for index, type_ in enumerate(types) if index]
    call = f"{name}({', '.join(['map', *args])})"
    return f"{spell(result)} read_{number}({spell(types[0])} map, float x) {{ return {call}; }}\n"


def check(name: str, target: str, assert_compiles: Callable[[Source], None]) -> None:
    accepted = ""
    for number, (types, overload) in enumerate(overloads(name).items()):
        text = function(name, types, overload.result, number)
        module = load_glsl_text(text, "case.glsl").module
        try:
            transpile(module, target, "case", keep=True)
        except SssgenError as error:
            (one,) = error.diagnostics
            # a type that the target lacks has no place
            assert one.message.endswith(f"has no {spell(types[0])}") or (one.span.file, one.span.line) == (
                "case.glsl",
                1,
            )
        else:
            accepted += text
    if accepted:
        files = transpile(load_glsl_text(accepted, "case.glsl").module, target, "case", keep=True).files
        ((file, content),) = [(file, content) for file, content in files.items() if not file.endswith(".json")]
        assert_compiles(Source(content, target, "library", name=file))


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("name", FEW)
def test_reads_compile_or_are_refused(name: str, target: str, assert_compiles: Callable[[Source], None]) -> None:
    check(name, target, assert_compiles)


@pytest.mark.slow
@pytest.mark.parametrize("target", [*TARGETS, "unity-builtin", "unity-urp"])
@pytest.mark.parametrize("name", READS)
def test_all_reads_compile_or_are_refused(name: str, target: str, assert_compiles: Callable[[Source], None]) -> None:
    check(name, target, assert_compiles)


@pytest.mark.parametrize("name", READS)
def test_other_samplers_are_refused(name: str) -> None:
    """A sampler that a builtin does not have is an error with its place."""
    taken = {types[0] for types in overloads(name)}
    example = next(iter(overloads(name)))
    for sampler in SAMPLERS.values():
        if BY_NAME[sampler] not in taken:
            assert isinstance(BY_NAME[sampler], Sampler)
            text = function(name, (BY_NAME[sampler], *example[1:]), FLOAT, 0)
            with pytest.raises(SssgenError) as caught:
                load_glsl_text(text, "case.glsl")
            assert all(one.span.line == 1 and "no overload" in one.message for one in caught.value.diagnostics)
