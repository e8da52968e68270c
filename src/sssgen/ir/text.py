"""The IR as text: printed, read back to an equal module, and diffed.

    file 0 "wax.sss"
    uniform@0:1:15-22 float density : thickness = (0.5) [hint_range(0.0, 1.0)]
    variable@0:2:10-12 in vec2 uv [interpolation("flat"), location(1.0)]
    doc "How much light is left behind a body."
    function@0:3:7-16 float remaining(in@0:3:23-24 vec3 p) {
        var@0:4:5-14 float d = length(p@0:4:23-24)@0:4:16-25;
        set@0:5:5-12 d += 1.0@0:5:10-12;
        return@0:6:5-20 exp((- d))@0:6:12-19;
    }

Every operator and every choice has parentheses, so there is no precedence. `$` marks declarations of the module:
`$density` is a global and `$remaining(x)` a call. A call without it is of a builtin, a name without it is a local, and
braces construct: `vec3{x, y, z}`. `-1.0` is a literal and `(- 1.0)` a negation. Types are written in declarations and
constructors; those of all other expressions follow from the rules, so the module must be valid (`ir.verify`).

A span follows the first token of a statement or declaration and the last of an expression:
`@file:line:column-`, then `column` or `line:column` of its end. No span means NOWHERE. Without spans,
modules are equal if their texts are. `//` begins a comment, which is not read.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import isfinite

from sssgen.ir import nodes as ir
from sssgen.ir.text_reader import TextError, read_module
from sssgen.ir.types import BOOL, FLOAT, UINT, Struct, spell

__all__ = ["TextError", "print_module", "read_module"]


def print_meaning(declaration: ir.Function | ir.Constant) -> str:
    """A declaration without its documentation and places: what two files declare alike has one text."""
    printer = _Printer(spans=False)
    if isinstance(declaration, ir.Constant):
        return printer.constant(declaration)
    return printer.function(declaration._replace(doc=""))


def print_module(module: ir.Module, spans: bool = True) -> str:
    """The text of a valid module. Raises ValueError for a number that is not finite."""
    return _Printer(spans).module(module)


class _Printer:
    def __init__(self, spans: bool) -> None:
        self.spans = spans
        self.files: dict[str, int] = {}

    def module(self, module: ir.Module) -> str:
        parts = [self.struct(struct) for struct in module.structs]
        parts += [self.constant(constant) for constant in module.constants]
        parts += [self.uniform(uniform) for uniform in module.uniforms]
        parts += [self.variable(variable) for variable in module.variables]
        parts += [self.function(function) for function in module.functions]
        if module.workgroup:
            parts.append(f"workgroup {' '.join(map(str, module.workgroup))}\n")
        files = [f"file {index} {_quoted(name)}\n" for name, index in self.files.items()]
        return "".join(files + parts)

    def at(self, span: ir.Span) -> str:
        if not self.spans or span == ir.NOWHERE:
            return ""
        file = self.files.setdefault(span.file, len(self.files))
        end = f"{span.end_column}" if span.end_line == span.line else f"{span.end_line}:{span.end_column}"
        return f"@{file}:{span.line}:{span.column}-{end}"

    def struct(self, struct: ir.StructDecl) -> str:
        assert isinstance(struct.type, Struct)
        fields = [f"    {spell(field.type)} {field.name}{_colon(field.quantity)};\n" for field in struct.type.fields]
        head = f"{_doc(struct.doc)}struct{self.at(struct.span)} {struct.type.name}"
        return f"{head} {{\n{''.join(fields)}}}\n"

    def constant(self, constant: ir.Constant) -> str:
        value = self.expr(constant.value)
        return f"const{self.at(constant.span)} {spell(constant.type)} {constant.name} = {value}\n"

    def uniform(self, uniform: ir.Uniform) -> str:
        declared = f"{spell(uniform.type)} {uniform.name}{_colon(uniform.quantity)}"
        default = f" = ({', '.join(map(_number, uniform.default))})" if uniform.default else ""
        return f"{_doc(uniform.doc)}uniform{self.at(uniform.span)} {declared}{default}{_hints(uniform.hints)}\n"

    def variable(self, variable: ir.Variable) -> str:
        declared = f"{variable.storage} {spell(variable.type)} {variable.name}"
        hints: list[tuple[str, tuple[float | str, ...]]] = []
        hints += [("builtin", (variable.builtin,))] if variable.builtin else []
        hints += [("interpolation", (variable.interpolation,))] if variable.interpolation else []
        hints += [("location", (float(variable.location),))] if variable.location >= 0 else []
        hints += [("access", (variable.access,))] if variable.access else []
        hints += [("layout", (variable.layout,))] if variable.layout else []
        value = f" = {self.expr(variable.value)}" if variable.value is not None else ""
        return f"{_doc(variable.doc)}variable{self.at(variable.span)} {declared}{_hints(hints)}{value}\n"

    def function(self, function: ir.Function) -> str:
        params = [
            f"{param.direction}{self.at(param.span)} {spell(param.type)} {param.name}{_colon(param.quantity)}"
            f"{f' passes {param.passes}' if param.passes else ''}"
            for param in function.params
        ]
        at, declared = self.at(function.span), f"{spell(function.result)} {function.name}({', '.join(params)})"
        body = " slot" if function.body is None else f" {self.block(function.body, 0)}"
        return f"{_doc(function.doc)}function{at} {declared}{_colon(function.quantity)}{body}\n"

    def block(self, block: ir.Block, depth: int) -> str:
        inside = "    " * (depth + 1)
        lines = "".join([f"{inside}{self.stmt(stmt, depth + 1)}\n" for stmt in block])
        return f"{{\n{lines}{'    ' * depth}}}"

    def stmt(self, stmt: ir.Stmt, depth: int) -> str:
        at = self.at(stmt.span)
        if isinstance(stmt, ir.Declare):
            value = f" = {self.expr(stmt.value)}" if stmt.value is not None else ""
            return f"var{at} {spell(stmt.type)} {stmt.name}{value};"
        if isinstance(stmt, ir.Assign):
            return f"set{at} {self.expr(stmt.target)} {stmt.op}= {self.expr(stmt.value)};"
        if isinstance(stmt, ir.Evaluate):
            return f"call{at} {self.expr(stmt.call)};"
        if isinstance(stmt, ir.Assume):
            return f"assume{at} {self.expr(stmt.condition)};"
        if isinstance(stmt, ir.If):
            otherwise = f" else {self.block(stmt.otherwise, depth)}" if stmt.otherwise else ""
            return f"if{at} {self.expr(stmt.condition)} then {self.block(stmt.then, depth)}{otherwise}"
        if isinstance(stmt, ir.For):
            init = self.stmt(stmt.init, depth) if stmt.init is not None else ";"
            condition = f" {self.expr(stmt.condition)}" if stmt.condition is not None else ""
            step = f" {self.stmt(stmt.step, depth)}" if stmt.step is not None else " ;"
            return f"for{at} ({init}{condition};{step}) {self.block(stmt.body, depth)}"
        if isinstance(stmt, ir.While):
            return f"while{at} {self.expr(stmt.condition)} do {self.block(stmt.body, depth)}"
        if isinstance(stmt, ir.MemoryOperation):
            result = f" -> {self.expr(stmt.result)}" if stmt.result is not None else ""
            return f"memory{at} {stmt.name}({self.list(stmt.args)}){result};"
        if isinstance(stmt, ir.Return) and stmt.value is not None:
            return f"return{at} {self.expr(stmt.value)};"
        return f"{type(stmt).__name__.lower()}{at};"

    def expr(self, expr: ir.Expr) -> str:
        return f"{self.bare(expr)}{self.at(expr.span)}"

    def bare(self, expr: ir.Expr) -> str:
        if isinstance(expr, ir.Local):
            return expr.name
        if isinstance(expr, ir.Literal):
            return _literal(expr)
        if isinstance(expr, ir.Binary):
            return f"({self.expr(expr.left)} {expr.op} {self.expr(expr.right)})"
        if isinstance(expr, ir.Global):
            return f"${expr.name}"
        if isinstance(expr, ir.Intrinsic):
            return f"{expr.name}({self.list(expr.args)})"
        if isinstance(expr, ir.Swizzle):
            return f"{self.expr(expr.value)}.{expr.components}"
        if isinstance(expr, ir.Construct):
            return f"{spell(expr.type)}{{{self.list(expr.args)}}}"
        if isinstance(expr, ir.Call):
            return f"${expr.function.split('(')[0]}({self.list(expr.args)})"
        if isinstance(expr, ir.Unary):
            return f"({expr.op} {self.expr(expr.operand)})"
        if isinstance(expr, ir.Member):
            return f"{self.expr(expr.value)}.{expr.field}"
        if isinstance(expr, ir.Index):
            return f"{self.expr(expr.value)}[{self.expr(expr.index)}]"
        return f"({self.expr(expr.condition)} ? {self.expr(expr.yes)} : {self.expr(expr.no)})"

    def list(self, exprs: Iterable[ir.Expr]) -> str:
        return ", ".join([self.expr(expr) for expr in exprs])


def _literal(literal: ir.Literal) -> str:
    if literal.type == FLOAT:
        return _number(literal.value)
    if literal.type == BOOL:
        return "true" if literal.value else "false"
    return f"{literal.value}u" if literal.type == UINT else f"{literal.value}"


def _number(value: float) -> str:
    """The shortest text that reads back as the same float64."""
    if not isfinite(value):
        raise ValueError(f"{value} has no text")
    return repr(float(value))


def _hints(hints: Iterable[tuple[str, tuple[float | str, ...]]]) -> str:
    listed = [f"{name}({', '.join(map(_hint_argument, args))})" for name, args in hints]
    return f" [{', '.join(listed)}]" if listed else ""


def _hint_argument(value: float | str) -> str:
    return _quoted(value) if isinstance(value, str) else _number(value)


def _colon(quantity: str) -> str:
    return f" : {quantity}" if quantity else ""


def _doc(doc: str) -> str:
    """A documentation comment, one quoted line per line."""
    return "doc " + "\n    ".join(map(_quoted, doc.split("\n"))) + "\n" if doc else ""


def _quoted(text: str) -> str:
    return f'"{"".join(map(_escaped, text))}"'


def _escaped(char: str) -> str:
    if char in '"\\':
        return f"\\{char}"
    return char if char.isprintable() else f"\\{ord(char):x};"
