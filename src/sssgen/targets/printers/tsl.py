"""Prints TSL, three.js's node language: JavaScript whose calls build the shader.

An operator is a method of its left operand, a variable is `.toVar()`, or `.toConst()` if nothing assigns to it, and a
block is a function. JavaScript's numbers are floats; other numbers, and what has a method, are nodes: `int(2)`. A
function with a layout becomes one of the shader; one with textures or arrays has none: its calls are expanded.
"""

from __future__ import annotations

import re

from sssgen.ir import nodes as ir
from sssgen.ir.types import VOID, Array, Matrix, Sampler, Struct, Type, Vector, kind_of, spell, unnested
from sssgen.ir.walk import all_expressions
from sssgen.passes.scopes import assigned
from sssgen.support.diagnostics import Diagnostic, SssgenError
from sssgen.targets.descriptor import Target
from sssgen.targets.printers.number_text import float_text
from sssgen.targets.printers.printed_lines import WIDTH, Line, wrap
from sssgen.targets.printers.printer import PRIMARY, Printer

_METHODS = {
    "+": "add", "-": "sub", "*": "mul", "/": "div", "%": "mod", "&&": "and", "||": "or", "<": "lessThan",
    ">": "greaterThan", "<=": "lessThanEqual", ">=": "greaterThanEqual", "==": "equal", "!=": "notEqual",
    "&": "bitAnd", "|": "bitOr", "^": "bitXor", "<<": "shiftLeft", ">>": "shiftRight",
}  # fmt: skip
_UNARY = {"-": "negate", "!": "not", "~": "bitNot"}
_CALLED = re.compile(r"(?<![.\w])[A-Za-z]\w*(?=\()")


class TslPrinter(Printer):
    def __init__(self, target: Target, module: ir.Module) -> None:
        super().__init__(target, module)
        self.assigned: set[str] = set()
        """The variables that the current function assigns to after their declaration."""
        self.called: set[str] = set()
        """The functions that the text calls."""

    # Expressions

    def node(self, expr: ir.Expr) -> str:
        """An expression that has methods: a number is not one."""
        is_plain = isinstance(expr, ir.Literal) and kind_of(expr.type) in ("float", "bool")
        return f"{self.type(expr.type)}({self.expr(expr)})" if is_plain else self.expr(expr)

    def literal(self, literal: ir.Literal) -> str:
        kind = kind_of(literal.type)
        return super().literal(literal) if kind in ("float", "bool") else f"{kind}({self.number(kind, literal)})"

    def number(self, kind: str, literal: ir.Literal) -> str:
        """A number of a literal converted to a kind, as JavaScript writes it."""
        if kind == "float":
            return float_text(float(literal.value), self.keeps_text)
        value = int(literal.value) & 0xFFFFFFFF
        if kind == "uint":
            return f"{value:#x}" if value >= 1 << 16 else str(value)
        return str(value - (1 << 32) if value >> 31 else value)

    def member(self, member: ir.Member) -> tuple[str, int]:
        return f"{self.node(member.value)}.get('{member.field}')", PRIMARY

    def unary(self, unary: ir.Unary) -> tuple[str, int]:
        return f"{self.node(unary.operand)}.{_UNARY[unary.op]}()", PRIMARY

    def index(self, index: ir.Index) -> tuple[str, int]:
        return f"{self.node(index.value)}.element({self.part('int', index.index)})", PRIMARY

    def binary(self, binary: ir.Binary) -> tuple[str, int]:
        return f"{self.node(binary.left)}.{_METHODS[binary.op]}({self.expr(binary.right)})", PRIMARY

    def arguments(self, args: tuple[ir.Expr, ...]) -> str:
        """Not every function of three takes numbers alone."""
        plain = all(isinstance(arg, ir.Literal) for arg in args)
        return self.join_arguments([self.node(arg) if plain else self.expr(arg) for arg in args])

    def select(self, select: ir.Select) -> tuple[str, int]:
        return f"select({self.arguments((select.condition, select.yes, select.no))})", PRIMARY

    def construct(self, construct: ir.Construct) -> tuple[str, int]:
        type_, args, span = construct.type, construct.args, construct.span
        if isinstance(type_, Array):
            return f"array([{', '.join(map(self.node, args))}])", PRIMARY
        if isinstance(type_, Struct):
            return super().construct(construct)
        if isinstance(type_, Matrix) and len(args) > type_.columns:  # numbers alone would be its rows
            rows, starts = type_.rows, range(0, len(args), type_.rows)
            args = tuple([ir.Construct(Vector("float", rows), args[start : start + rows], span) for start in starts])
        beside_nodes = not all(isinstance(arg, ir.Literal) for arg in args)
        parts = [self.part(kind_of(type_), arg, beside_nodes) for arg in args]
        return f"{self.type(type_)}({', '.join(parts)})", PRIMARY

    def part(self, kind: str, arg: ir.Expr, beside_nodes: bool = False) -> str:
        """An argument that becomes a number of a kind, or several: of a literal, a plain number.

        three makes floats of plain numbers beside nodes: there, integers of more than 24 bits are nodes, too.
        """
        if isinstance(arg, ir.Unary) and arg.op == "-" and isinstance(arg.operand, ir.Literal):
            arg = arg.operand._replace(value=-arg.operand.value)
        if not isinstance(arg, ir.Literal) or "bool" in (kind, kind_of(arg.type)):
            return self.expr(arg)
        text = self.number(kind, arg)
        is_exact = kind == "float" or abs(int(text, 0)) <= 1 << 24
        return text if is_exact or not beside_nodes else f"{kind}({text})"

    # Statements

    def statement(self, stmt: ir.Stmt, indent: int) -> list[Line]:
        pad = "    " * indent
        if isinstance(stmt, ir.If):
            lines = wrap(f"{pad}If({self.expr(stmt.condition)}, () => {{", stmt.span, chains=True)
            lines += self.block(stmt.then, indent + 1)
            while len(stmt.otherwise) == 1 and isinstance(stmt.otherwise[0], ir.If):
                stmt = stmt.otherwise[0]
                lines += wrap(f"{pad}}}).ElseIf({self.expr(stmt.condition)}, () => {{", stmt.span, chains=True)
                lines += self.block(stmt.then, indent + 1)
            if stmt.otherwise:
                lines += [Line(f"{pad}}}).Else(() => {{"), *self.block(stmt.otherwise, indent + 1)]
            return [*lines, Line(f"{pad}}});")]
        if isinstance(stmt, ir.For | ir.While):
            head = self.loop_header(stmt) if isinstance(stmt, ir.For) else f"{self.expr(stmt.condition)}, () => {{"
            lines = wrap(f"{pad}Loop({head}", stmt.span, chains=True)
            return [*lines, *self.block(stmt.body, indent + 1), Line(f"{pad}}});")]
        return wrap(f"{pad}{self.simple(stmt)};", stmt.span, chains=True)

    def loop_header(self, loop: ir.For) -> str:
        """A loop that counts."""
        init, condition, step = loop.init, loop.condition, loop.step
        assert isinstance(init, ir.Declare) and isinstance(condition, ir.Binary) and isinstance(step, ir.Assign)
        assert init.value is not None and isinstance(step.value, ir.Literal)
        kind, number = kind_of(init.type), step.value
        by_one = number.value == 1 and (step.op == "+") == (condition.op[0] == "<") and kind != "float"
        update = "" if by_one else f", update: '{step.op}= {super().literal(number)}'"
        counted = f"start: {self.part(kind, init.value)}, end: {self.part(kind, condition.right)}, type: '{kind}'"
        head = f"{counted}, condition: '{condition.op}', name: '{init.name}'{update}"
        return f"{{ {head} }}, ({{ {init.name} }}) => {{"

    def simple(self, stmt: ir.Stmt) -> str:
        if isinstance(stmt, ir.Assign):
            method = f"{_METHODS[stmt.op]}Assign" if stmt.op else "assign"
            return f"{self.node(stmt.target)}.{method}({self.expr(stmt.value)})"
        if isinstance(stmt, ir.Return) and stmt.value is not None:
            return f"return {self.node(stmt.value)}"
        jumps = isinstance(stmt, ir.Break | ir.Continue | ir.Discard)
        return f"{type(stmt).__name__}()" if jumps else super().simple(stmt)

    def declare(self, declare: ir.Declare) -> str:
        value = declare.value
        if value is None or declare.name in self.assigned:
            return f"const {declare.name} = {self.zero(declare.type) if value is None else self.node(value)}.toVar()"
        parts = value.args if isinstance(value, ir.Construct) and isinstance(value.type, Vector) else (value,)
        kept = "" if all(isinstance(part, ir.Literal) for part in parts) else ".toConst()"
        return f"const {declare.name} = {self.node(value)}{kept}"

    def zero(self, type_: Type) -> str:
        """The value of a variable without one."""
        if isinstance(type_, Array):
            of_structs = f"[{', '.join([self.zero(type_.element)] * type_.length)}]"
            numbers = f"'{self.type(type_.element)}', {type_.length}"
            return f"array({of_structs if isinstance(type_.element, Struct) else numbers})"
        fields = type_.fields if isinstance(type_, Struct) else ()
        return f"{self.type(type_)}({', '.join([self.zero(field.type) for field in fields])})"

    # Declarations

    def calling(self, lines: list[Line]) -> list[Line]:
        """The lines; what they call is imported."""
        self.called.update(name for line in lines for name in _CALLED.findall(line.text.partition("//")[0]))
        return lines

    def print_imports(self) -> list[Line]:
        own = self.module_names | {spell(struct.type) for struct in self.module.structs}
        return wrap(f"import {{ {', '.join(sorted(self.called - own))} }} from 'three/tsl';", ir.NOWHERE)

    def print_function(self, function: ir.Function) -> list[Line]:
        self.assigned = assigned(function, {})
        for part in all_expressions(function.body or ()):
            if isinstance(part.type, Matrix | Array):
                self.layout_type(part.type, part.span)
        lines = self.calling(super().print_function(function))[:-1]
        types = [function.result, *[param.type for param in function.params]]
        result, *names = [self.layout_type(type_, function.span) for type_ in types]
        if function.result == VOID or any(isinstance(type_, Sampler | Array) for type_ in types):
            return [*lines, Line("}, 'void');" if function.result == VOID else "});")]  # what returns nothing discards
        inputs = [f"{{ name: '{p.name}', type: '{type_}' }}" for p, type_ in zip(function.params, names, strict=True)]
        head = f"}}).setLayout({{ name: '{function.name}', type: '{result}', inputs: ["
        if len(head) + len(", ".join(inputs)) < WIDTH - 5:
            return [*lines, Line(f"{head}{', '.join(inputs)}] }});", function.span)]
        return [*lines, Line(head), *[Line(f"    {one},") for one in inputs], Line("] });")]

    def layout_type(self, type_: Type, span: ir.Span, is_part: bool = False) -> str:
        """A type in the layout of a function, or of a part of a struct. Raises SssgenError with its place."""
        name = spell(unnested(type_)[0])
        is_nested = isinstance(type_, Array) and (is_part or isinstance(type_.element, Array))
        if not is_nested and (name in self.target.types or isinstance(unnested(type_)[0], Struct)):
            return name
        what = "arrays in arrays and structs" if is_nested else name
        hint = "use variables for its elements or columns, or pass the values that are read of it"
        raise SssgenError([Diagnostic("error", f"{self.target.title} has no {what}", span, hint, self.source(span))])

    def signature(self, function: ir.Function) -> str:
        params = ", ".join([param.name for param in function.params])
        return f"export const {function.name} = /*@__PURE__*/ Fn(({f'[{params}]' if params else ''}) =>"

    def print_struct(self, struct: ir.StructDecl) -> list[Line]:
        assert isinstance(struct.type, Struct)
        name, fields = struct.type.name, struct.type.fields
        members = ", ".join([f"{field.name}: '{self.layout_type(field.type, struct.span, True)}'" for field in fields])
        return self.calling(
            wrap(f"export const {name} = /*@__PURE__*/ struct({{ {members} }}, '{name}');", struct.span)
        )

    def print_constant(self, constant: ir.Constant) -> list[Line]:
        return self.calling(wrap(f"const {constant.name} = /*@__PURE__*/ {self.node(constant.value)};", constant.span))
