"""Helpers for tests of passes: modules from source, and their comparison with the source of the expected result."""

from __future__ import annotations

from sssgen.ir.nodes import Module
from sssgen.ir.text import print_module
from sssgen.ir.verify import verify
from sssgen.lang.check.module_checker import check
from sssgen.lang.syntax.parser import parse


def module_of(source: str) -> Module:
    """The checked module of a source text."""
    module = check(parse(source, "test.sss"), source)
    assert not verify(module)
    return module


def key(module: Module, name: str) -> str:
    """The key of the only function with a name."""
    (function,) = (function for function in module.functions if function.name == name)
    return function.key


def assert_is(module: Module, source: str) -> None:
    """Asserts that the module is valid and equals that of the source, apart from spans."""
    assert verify(module) == []
    assert text(module) == text(module_of(source))


def text(module: Module) -> str:
    """The module's text without spans."""
    return print_module(module, spans=False)
