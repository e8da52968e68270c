"""Compiles source for the NumPy target, and compares its results with those of the interpreter."""

from __future__ import annotations

from typing import Any

import numpy as np

from ir_interpreter import Discarded, Interpreter
from name_rules import rules_of
from sssgen.ir.nodes import Function, Module
from sssgen.ir.types import Array, Matrix, Struct, Type, Vector, kind_of
from sssgen.ir.verify import verify
from sssgen.lang.check.module_checker import check
from sssgen.lang.syntax.parser import parse
from sssgen.passes.names import rename
from sssgen.passes.numpy.predicate import predicate
from sssgen.targets.printers.numpy_printer import print_functions
from sssgen.targets.registry import load
from sssgen.targets.runtime.numpy_values import Record, precision

DTYPES: dict[str, Any] = {"float": np.float64, "int": np.int32, "uint": np.uint32, "bool": np.bool_}


def module_of(source: str) -> Module:
    return check(parse(source, "test.sss"), source)


def python_of(module: Module) -> str:
    """The Python text of a checked module."""
    names = load("numpy").names
    renamed, _ = rename(predicate(module), rules_of(names.exact | names.private, False))
    return print_functions(renamed)


def compiled(source: str, **uniforms: Any) -> dict[str, Any]:
    """The functions of a source text, as Python objects."""
    text = python_of(module_of(source))
    namespace: dict[str, Any] = {}
    exec(compile(text, "<printed>", "exec"), namespace)
    return {**namespace, **_set(namespace, uniforms)}


def _set(namespace: dict[str, Any], uniforms: dict[str, Any]) -> dict[str, Any]:
    namespace.update(uniforms)
    return uniforms


def run(source: str, *args: Any, name: str = "f", **uniforms: Any) -> Any:
    """Calls a function of a source text."""
    with precision(np.float64):
        return compiled(source, **uniforms)[name](*args)


def lanes_of(type_: Type, values: list[Any]) -> Any:
    """Combines values of the interpreter, one per lane, into a value of the runtime."""
    if isinstance(type_, Struct):
        fields = enumerate(type_.fields)
        return Record(**{field.name: lanes_of(field.type, [value[i] for value in values]) for i, field in fields})
    if isinstance(type_, Array) and isinstance(type_.element, Struct):
        rows = [[value[i] for value in values] for i in range(type_.length)]
        fields = enumerate(type_.element.fields)
        return Record(
            **{
                field.name: lanes_of(
                    Array(field.type, type_.length),
                    [tuple(row[i] for row in element_rows) for element_rows in zip(*rows, strict=True)],
                )
                for i, field in fields
            }
        )
    kind = kind_of(type_.element if isinstance(type_, Array) else type_)
    return np.moveaxis(np.array(values, DTYPES[kind]), 0, -1)


def assert_agrees(source: str, lanes: list[tuple[Any, ...]], name: str = "f", **uniforms: Any) -> None:
    """Asserts that the printed function and the interpreter give the same bits in every lane.

    `lanes` holds the in and inout arguments of each lane.
    """
    module = module_of(source)
    function = next(function for function in module.functions if function.name == name)
    problems = [problem for problem in verify(predicate(module)) if "any_lane" not in problem]
    assert problems == []
    text = python_of(module)
    try:
        printed = _printed(function, text, lanes, uniforms)
        for lane, args in enumerate(lanes):
            try:
                expected = Interpreter(module, uniforms).call(function.key, *args)
            except Discarded:
                assert bool(np.broadcast_to(printed[-1], (len(lanes),))[lane]), f"lane {lane} is not discarded"
                continue
            types = [function.result] if len(expected) > _outs(function) else []
            types += [param.type for param in function.params if param.direction != "in"]
            for type_, value, result in zip(types, expected, printed, strict=False):
                _assert_same(type_, value, result, lane, len(lanes))
            if len(printed) > len(expected):
                assert not np.broadcast_to(printed[-1], (len(lanes),))[lane], f"lane {lane} is discarded"
    except Exception as error:
        error.add_note(f"{source}\n{text}")
        raise


def _outs(function: Function) -> int:
    return sum(param.direction != "in" for param in function.params)


def _printed(function: Function, text: str, lanes: list[tuple[Any, ...]], uniforms: dict[str, Any]) -> tuple[Any, ...]:
    arguments = [param for param in function.params if param.direction != "out"]
    namespace: dict[str, Any] = {}
    exec(compile(text, "<printed>", "exec"), namespace)
    namespace.update(uniforms)
    args = [lanes_of(param.type, [lane[i] for lane in lanes]) for i, param in enumerate(arguments)]
    before = [np.array(arg) for arg in args if isinstance(arg, np.ndarray)]
    with precision(np.float64):
        result = namespace[function.name](*args)
    for old, arg in zip(before, (arg for arg in args if isinstance(arg, np.ndarray)), strict=True):
        np.testing.assert_array_equal(old, arg, "an argument was changed in place")
    return result if isinstance(result, tuple) else (result,)


def _assert_same(type_: Type, expected: Any, result: Any, lane: int, count: int) -> None:
    if isinstance(type_, Struct):
        for field, part in zip(type_.fields, expected, strict=True):
            _assert_same(field.type, part, getattr(result, field.name), lane, count)
        return
    array = np.asarray(result)
    if array.dtype.kind == "i" or array.dtype.kind == "u":
        kind = kind_of(type_.element if isinstance(type_, Array) else type_)
        assert isinstance(result, int) or array.dtype == DTYPES[kind], f"{array.dtype} for {type_}"
    whole = np.broadcast_to(array, (*_shape(type_), count))
    np.testing.assert_array_equal(whole[..., lane], np.array(expected), f"lane {lane}")


def _shape(type_: Type) -> tuple[int, ...]:
    if isinstance(type_, Array):
        return (type_.length, *_shape(type_.element))
    if isinstance(type_, Matrix):
        return (type_.columns, type_.rows)
    return (type_.size,) if isinstance(type_, Vector) else ()
