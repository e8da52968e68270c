"""Every builtin of the intrinsic table, in all languages side by side; texts_of_builtins.py has the texts."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest

from sssgen.ir import nodes as ir
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.intrinsics.integer_reads import GATHERS, READS, integer_gathers, integer_reads
from sssgen.ir.nodes import Module
from sssgen.ir.signatures import overload, parse
from sssgen.pipeline.compiler import transpile
from sssgen.run.compilers import Source
from texts_of_builtins import ALL
from validate import TARGETS, module_of, printed, validate_all

INTEGER_READS = {name: integer_reads(name).signatures for name in READS}
INTEGER_READS |= {name: integer_gathers(name).signatures for name in GATHERS}


@pytest.mark.parametrize("source", ALL)
def test_builtin(source: str) -> None:
    message = ALL[source]
    hlsl = message.get("hlsl", source)
    numpy = re.sub(r"\bnot\(", "not_(", re.sub(r"\bmap\b", "map_", source))
    defaults = {"glsl-es": message["glsl"], "hlsl": hlsl, "dx9": hlsl, "urp": hlsl, "wgsl": source, "numpy": numpy}
    validate_all(source, {**defaults, **message})


def test_every_signature_has_a_case() -> None:
    shown = set()
    for source in ALL:
        (function,) = module_of(source).functions
        assert function.body is not None
        (stmt,) = function.body
        assert isinstance(stmt, ir.Return) and isinstance(stmt.value, ir.Intrinsic)
        result = overload(stmt.value.name, [arg.type for arg in stmt.value.args])
        assert result is not None
        shown.add((stmt.value.name, result.params))
    table = {
        (row.name, ",".join(parse(text)[1:]))
        for row in BUILTINS.values()
        for text in row.signatures
        if text not in INTEGER_READS.get(row.name, ())  # test_integer_reads.py
    }
    assert table - shown == set()


@pytest.mark.parametrize("target", [*TARGETS, "metal", "unity-shadergraph", "unreal", "bevy", "tsl"])
def test_every_case_compiles(target: str, assert_compiles: Callable[[Source], None]) -> None:
    """All cases in one library, in every compiler that reads the target."""
    functions = []
    for number, (source, expected) in enumerate(ALL.items()):
        refused = [name for name, text in expected.items() if text.startswith("error:")]
        refused += [name for name in ("metal", "godot", "tsl") if printed(source, name).startswith("error:")]
        if {"unity-shadergraph": "urp", "unreal": "urp", "bevy": "wgsl"}.get(target, target) not in refused:
            (function,) = module_of(source).functions
            functions.append(function._replace(name=f"case_{number}"))
    name = TARGETS.get(target, target)
    files = transpile(Module(functions=tuple(functions)), name, "cases").files
    (file,) = [file for file in files if not file.endswith(".json")]
    version = "#version 430\n" if target == "glsl" else ""  # rows with `later_glsl` are among them
    assert_compiles(Source(version + files[file], name, "library", name=file))
