"""The tree of a random GLSL program, and its text.

A node is a kind with a type, parts and one datum, so that the reducer can change a tree without knowing its kinds. A
type is its text in GLSL; `~float` and `~vec3` are floats that may be rounded, which never decide anything.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any


@dataclass(slots=True)
class Node:
    """An expression or a statement."""

    kind: str
    type: str = ""
    parts: list[Node] = field(default_factory=list)
    data: Any = None


@dataclass(slots=True)
class Parameter:
    """A parameter of a function; the direction is '', 'in', 'out', 'inout' or 'const in'."""

    type: str
    name: str
    direction: str = ""


@dataclass(slots=True)
class Function:
    """A function of a program."""

    name: str
    result: str
    params: list[Parameter]
    body: Node
    prototype: bool = False


@dataclass(slots=True)
class Variable:
    """A variable or constant at file scope; `qualifier` is 'const', 'uniform' or ''."""

    type: str
    name: str
    value: Node | None
    qualifier: str


@dataclass(slots=True)
class Macro:
    """A macro; `body` has nodes of the kind `hole` in place of its parameters."""

    name: str
    params: list[str]
    body: Node


@dataclass(slots=True)
class Program:
    """Declarations in their order; the last function takes the inputs and returns the numbers to compare."""

    structs: dict[str, list[tuple[str, str]]] = field(default_factory=dict)
    macros: dict[str, Macro] = field(default_factory=dict)
    variables: list[Variable] = field(default_factory=list)
    functions: list[Function] = field(default_factory=list)
    entry: str = ""
    smooth: bool = False
    """Whether the entry returns rounded floats."""

    @property
    def has_state(self) -> bool:
        """Whether a variable at file scope can change."""
        return any(not variable.qualifier for variable in self.variables)


NONE = "none"
"""The kind of a part that is absent: a declarator without a value, a `for` without a condition."""

COMPONENTS = {"x": 0, "y": 1, "z": 2, "w": 3, "r": 0, "g": 1, "b": 2, "a": 3, "s": 0, "t": 1, "p": 2, "q": 3}

_LEVELS = {
    "*": 12, "/": 12, "%": 12, "+": 11, "-": 11, "<<": 10, ">>": 10, "<": 9, ">": 9, "<=": 9, ">=": 9, "==": 8,
    "!=": 8, "&": 7, "^": 6, "|": 5, "&&": 4, "^^": 3, "||": 2,
}  # fmt: skip
_UNARY, _POSTFIX, _CHOICE, _ASSIGNMENT, _COMMA = 13, 14, 1, 0, -1


def plain(type_: str) -> str:
    """A type as GLSL spells it."""
    return type_.removeprefix("~")


def declared(type_: str, name: str) -> str:
    """A declarator with its type; an array's length is written after the name or after the type, by the name."""
    type_ = plain(type_)
    if type_.endswith("]") and len(name) % 2:
        element, _, length = type_.partition("[")
        return f"{element} {name}[{length}"
    return f"{type_} {name}"


def expression(node: Node, level: int = _COMMA) -> str:
    """The text of an expression in a place that binds as strongly as `level`."""
    text, own = _expression(node)
    return f"({text})" if own < level else text


def _arguments(nodes: list[Node]) -> str:
    return ", ".join(expression(node, _ASSIGNMENT) for node in nodes)


def _expression(node: Node) -> tuple[str, int]:
    kind, parts, data = node.kind, node.parts, node.data
    if kind == "literal":
        return str(data[1]), _UNARY if str(data[1]).startswith("-") else _POSTFIX
    if kind in ("name", "hole"):
        return str(data), _POSTFIX
    if kind == "brackets":
        return f"({expression(parts[0])})", _POSTFIX
    if kind == "unary":
        operand = expression(parts[0], _UNARY)
        return f"{data}{' ' if operand.startswith(data[0]) else ''}{operand}", _UNARY
    if kind == "step":
        operator, is_prefix = data
        if is_prefix:
            return f"{operator}{expression(parts[0], _UNARY)}", _UNARY
        return f"{expression(parts[0], _POSTFIX)}{operator}", _POSTFIX
    if kind == "binary":
        own = _LEVELS[data]
        right = expression(parts[1], own + 1)
        return f"{expression(parts[0], own)} {data} {right}", own
    if kind == "choice":
        condition = expression(parts[0], _CHOICE + 1)
        return f"{condition} ? {expression(parts[1], _ASSIGNMENT)} : {expression(parts[2], _CHOICE)}", _CHOICE
    if kind == "assign":
        return f"{expression(parts[0], _UNARY)} {data} {expression(parts[1], _ASSIGNMENT)}", _ASSIGNMENT
    if kind == "comma":
        return f"{expression(parts[0])}, {expression(parts[1], _ASSIGNMENT)}", _COMMA
    if kind in ("call", "builtin"):
        return f"{data}({_arguments(parts)})", _POSTFIX
    if kind == "construct":
        return f"{plain(data)}({_arguments(parts)})", _POSTFIX
    if kind == "list":
        return f"{{{_arguments(parts)}}}", _POSTFIX
    if kind == "macro":
        return data + (f"({_arguments(parts)})" if parts else ""), _POSTFIX
    base = expression(parts[0], _POSTFIX)
    if kind in ("swizzle", "member"):
        return f"{base}.{data}", _POSTFIX
    if kind == "length":
        return f"{base}.length()", _POSTFIX
    assert kind == "index", kind
    return f"{base}[{expression(parts[1])}]", _POSTFIX


def statement(node: Node, pad: str = "    ") -> str:
    """The lines of a statement."""
    kind, parts, data = node.kind, node.parts, node.data
    inner = pad + "    "
    if kind == "block":
        return f"{pad}{{\n{lines(parts, inner)}{pad}}}\n"
    if kind == "declare":
        return f"{pad}{_declaration(node)};\n"
    if kind == "do_expression":
        return f"{pad}{expression(parts[0])};\n"
    if kind == "if":
        text = f"{pad}if ({expression(parts[0])}){_body(parts[1], pad)}"
        return text + (f"{pad}else{_body(parts[2], pad)}" if len(parts) > 2 else "")
    if kind == "for":
        start = "" if parts[0].kind == NONE else _declaration(parts[0])
        test, step = ("" if part.kind == NONE else f" {expression(part)}" for part in parts[1:3])
        return f"{pad}for ({start};{test};{step}){_body(parts[3], pad)}"
    if kind == "while":
        return f"{pad}while ({expression(parts[0])}){_body(parts[1], pad)}"
    if kind == "do":
        return f"{pad}do{_body(parts[0], pad)}{pad}while ({expression(parts[1])});\n"
    if kind == "switch":
        cases = "".join(statement(case, inner) for case in parts[1:])
        return f"{pad}switch ({expression(parts[0])}) {{\n{cases}{pad}}}\n"
    if kind == "case":
        labels = "".join(f"{pad}{'default' if label is None else f'case {expression(label)}'}:\n" for label in data)
        return labels + lines(parts, inner)
    if kind == "return" and parts:
        return f"{pad}return {expression(parts[0])};\n"
    assert kind in ("break", "continue", "return", "empty"), kind
    return f"{pad}{'' if kind == 'empty' else kind};\n"


def lines(nodes: list[Node], pad: str) -> str:
    """The lines of statements."""
    return "".join(statement(node, pad) for node in nodes)


def _body(node: Node, pad: str) -> str:
    """The statement that a head controls."""
    if node.kind == "block":
        return " " + statement(node, pad).lstrip()
    return "\n" + statement(node, pad + "    ")


def _declaration(node: Node) -> str:
    """`data` is (qualifier, names); the parts are the values, of the kind `none` where there is none."""
    if node.kind == "do_expression":
        return expression(node.parts[0])
    qualifier, names = node.data
    values = ["" if part.kind == NONE else f" = {expression(part, _ASSIGNMENT)}" for part in node.parts]
    head = f"{qualifier} " if qualifier else ""
    if len(names) == 1:
        return f"{head}{declared(node.type, names[0])}{values[0]}"
    declarators = ", ".join(name + value for name, value in zip(names, values, strict=True))
    return f"{head}{plain(node.type)} {declarators}"


def _head(function: Function) -> str:
    params = [f"{param.direction} {declared(param.type, param.name)}".strip() for param in function.params]
    return f"{plain(function.result)} {function.name}({', '.join(params)})"


def source(program: Program) -> str:
    """The text of a program."""
    parts = []
    for macro in program.macros.values():
        params = f"({', '.join(macro.params)})" if macro.params else ""
        parts.append(f"#define {macro.name}{params} {expression(macro.body)}\n")
    for name, fields in program.structs.items():
        members = " ".join(f"{declared(type_, field)};" for type_, field in fields)
        parts.append(f"struct {name} {{ {members} }};\n")
    for variable in program.variables:
        value = f" = {expression(variable.value, _ASSIGNMENT)}" if variable.value is not None else ""
        parts.append(f"{variable.qualifier} {declared(variable.type, variable.name)}{value};\n".lstrip())
    parts += [f"{_head(function)};\n" for function in program.functions if function.prototype]
    parts += [f"{_head(function)} {statement(function.body, '').lstrip()}" for function in program.functions]
    return "".join(parts) + "".join(f"#undef {name}\n" for name in program.macros)


def copied(node: Node) -> Node:
    """A copy that shares no node."""
    data = node.data
    if node.kind == "case":
        data = [None if label is None else copied(label) for label in data]
    return Node(node.kind, node.type, [copied(part) for part in node.parts], data)


def copied_program(program: Program) -> Program:
    """A copy whose declarations and trees can be changed."""
    variables = [replace(variable, value=variable.value and copied(variable.value)) for variable in program.variables]
    functions = [
        replace(function, params=list(function.params), body=copied(function.body)) for function in program.functions
    ]
    return replace(
        program,
        structs=dict(program.structs),
        macros=dict(program.macros),
        variables=variables,
        functions=functions,
    )
