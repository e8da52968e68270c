"""Compiles source to checked IR."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.text import print_module
from sssgen.ir.verify import verify
from sssgen.lang.check.module_checker import check
from sssgen.lang.syntax.parser import parse


def checked(source: str, included: ir.Module | None = None) -> ir.Module:
    module = check(parse(source, "a.sss"), source, included or ir.Module())
    assert verify(module) == []
    return module


def text_of(source: str) -> str:
    return print_module(checked(source), spans=False)
