"""Reduces a failing program: drops declarations and statements, and replaces expressions, while it fails alike."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from glsl_tree import NONE, Function, Node, Program, copied, copied_program
from glsl_values import kind, matrix_size, vector_size

STATEMENTS = {"block", "declare", "do_expression", "if", "for", "while", "do", "switch", "break", "continue", "return",
              "empty", "case"}  # fmt: skip
ROUNDS = 4


def reduced(program: Program, fails: Callable[[Program], bool]) -> Program:
    """The smallest program found for which `fails` still holds."""
    for _ in range(ROUNDS):
        before = size(program)
        program = _without_declarations(program, fails)
        for index in range(len(program.functions)):
            program = _smaller_body(program, index, fails)
        if size(program) == before:
            break
    return program


def size(program: Program) -> int:
    """The number of nodes and declarations."""
    nodes = sum(_count(function.body) + 2 for function in program.functions)
    values = sum(1 + _count(variable.value) for variable in program.variables if variable.value is not None)
    return nodes + values + len(program.variables) + len(program.structs) + len(program.macros)


def _count(node: Node) -> int:
    return 1 + sum(_count(part) for part in node.parts)


def _without_declarations(program: Program, fails: Callable[[Program], bool]) -> Program:
    for name in ("functions", "variables", "macros", "structs"):
        index = 0
        while index < len(getattr(program, name)):
            smaller = copied_program(program)
            declarations = getattr(smaller, name)
            key = index if isinstance(declarations, list) else list(declarations)[index]
            if isinstance(declarations[key], Function) and declarations[key].name == program.entry:
                index += 1
                continue
            del declarations[key]
            if fails(smaller):
                program = smaller
            else:
                index += 1
    for index, variable in enumerate(program.variables):
        if variable.value is not None and variable.value.kind != "literal":
            for value in _simpler(variable.value):
                smaller = copied_program(program)
                smaller.variables[index].value = value
                if fails(smaller):
                    program = smaller
                    break
    return program


def _smaller_body(program: Program, index: int, fails: Callable[[Program], bool]) -> Program:
    """Tries every edit of one function, from its first node on."""
    position = 0
    while True:
        nodes = list(_nodes(program.functions[index].body))
        if position >= len(nodes):
            return program
        for edit in _edits(nodes[position]):
            smaller = copied_program(program)
            edit(list(_nodes(smaller.functions[index].body))[position])
            if fails(smaller):
                program = smaller
                break
        else:
            position += 1


def _nodes(node: Node) -> Iterator[Node]:
    yield node
    for part in node.parts:
        yield from _nodes(part)


def _edits(node: Node) -> Iterator[Callable[[Node], None]]:
    """Changes of one node, in place."""
    if node.kind in ("block", "case", "switch"):
        start = 1 if node.kind == "switch" else 0
        for length in (4, 2, 1):
            for first in range(start, len(node.parts) - length + 1):
                yield lambda target, first=first, length=length: target.parts.__delitem__(slice(first, first + length))
    if node.kind == "if" and len(node.parts) == 3:
        yield lambda target: target.parts.__delitem__(2)
    if node.kind in STATEMENTS and node.kind != "case":
        for part in node.parts:
            bodies = part.parts if part.kind == "case" else [part] if part.kind in STATEMENTS else []
            if bodies and node.kind != "block":
                yield lambda target, bodies=bodies: _become(
                    target, Node("block", parts=[copied(body) for body in bodies])
                )
        if node.kind == "block" and len(node.parts) == 1:
            yield lambda target: _become(target, target.parts[0])
        return
    if node.kind in (NONE, "case") or not node.type:
        return
    for simpler in _simpler(node):
        yield lambda target, simpler=simpler: _become(target, copied(simpler))


def _simpler(node: Node) -> Iterator[Node]:
    """Expressions of the same type, smallest first."""
    if node.kind in ("literal", "name"):
        return
    if "[" not in node.type:
        kind_, size_ = kind(node.type), vector_size(node.type) or matrix_size(node.type)
        numbers = {"int": (1, "1"), "uint": (1, "1u"), "bool": (True, "true"), "float": (1.0, "1.0")}
        number = Node("literal", kind_, [], numbers[kind_])
        if node.type in ("int", "uint", "bool", "float", "~float"):
            yield number
        elif size_ and node.kind != "construct":
            yield Node("construct", node.type, [number], node.type)
    for part in _nodes(node):
        if part is not node and part.type == node.type and part.kind != "hole":
            yield part


def _become(node: Node, other: Node) -> None:
    node.kind, node.type, node.parts, node.data = other.kind, other.type, other.parts, other.data
