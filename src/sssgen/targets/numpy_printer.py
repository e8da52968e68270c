"""Prints Python on NumPy arrays: the oracle that the other targets are compared with.

It prints modules that `passes.predicate` has been through: a function takes arrays with the lanes on the last axis (see
`numpy_values`) and returns its result, then its out and inout parameters. Values are never changed in place, so that
variables may share them: `v.x = 1.0` is `v = store_swizzle(v, "x", 1.0)`. Uniforms that are no parameters are read as
the module's globals; constants that are no plain numbers are made in each function that uses them, as their element
type is that of `with precision(…)` around the call.
"""

from __future__ import annotations

import re

from ..ir import nodes as ir
from ..ir.types import VOID, Array, Matrix, Sampler, Scalar, Struct, Type, Vector, components, kind_of
from ..ir.walk import all_expressions, subexpressions
from ..passes.uniformity import count
from .descriptor import Target, load
from .layout import Member
from .numpy_numbers import Numbers, nonzero
from .printer import POSTFIX, PRIMARY, UNARY, WIDTH, Line, Printer, summary

_OPERATORS = {"||": "|", "^^": "^", "&&": "&"}
_PRECEDENCE = {
    "==": 5, "!=": 5, "<": 5, ">": 5, "<=": 5, ">=": 5, "|": 6, "^": 7, "&": 8, "<<": 9, ">>": 9,
    "+": 10, "-": 10, "*": 11, "/": 11,
}  # fmt: skip
_TEXELS = {
    "default_white": "1.0", "default_black": "0.0", "default_gray": "0.5", "default_bump": "(0.5, 0.5, 1.0, 1.0)",
}  # fmt: skip
_NAMES = {"not": "not_", "any_lane": "any"}


def print_functions(module: ir.Module) -> str:
    """A whole Python module with the functions of a module that is predicated and has legal names."""
    printer = NumpyPrinter(load("numpy"), module)
    parts = [[line for constant in module.constants for line in printer.print_constant(constant)]]
    parts += [printer.print_function(function) for function in module.functions]
    text = "\n\n".join("\n".join(line.text for line in part) for part in parts if part)
    return f"from sssgen.targets.numpy_runtime import *\n\n{text}\n"


class NumpyPrinter(Printer):
    """Prints one module."""

    def __init__(self, target: Target, module: ir.Module) -> None:
        super().__init__(target, module)
        self.numbers = Numbers(module)
        self.constants = {constant.name: constant for constant in module.constants}
        self.told: set[tuple[str, int]] = set()

    # Expressions

    def literal(self, literal: ir.Literal) -> str:
        """The shortest text that reads back to the same float64."""
        return repr(literal.value)

    def typed(self, *exprs: ir.Expr) -> list[str]:
        """Texts of values that go somewhere together: among uints that are all plain numbers, one says its type."""
        texts = [self.expr(expr) for expr in exprs]
        plain = [index for index, expr in enumerate(exprs) if kind_of(expr.type) == "uint" and self.numbers.plain(expr)]
        if plain and not any(kind_of(expr.type) == "uint" and not self.numbers.plain(expr) for expr in exprs):
            texts[plain[0]] = f"to_uint({texts[plain[0]]})"
        return texts

    def expr(self, expr: ir.Expr, least: int = 0) -> str:
        text, binding = self.bound(expr)
        return text if binding >= least else f"({text})"

    def bound(self, expr: ir.Expr) -> tuple[str, int]:
        if isinstance(expr, ir.Swizzle):
            value = self.expr(expr.value, POSTFIX)
            if len(expr.components) == 1:
                return f"{value}[{'xyzw'.index(expr.components)}]", POSTFIX
            return f'swizzle({self.expr(expr.value)}, "{expr.components}")', PRIMARY
        if isinstance(expr, ir.Unary):
            return self.unary(expr)
        if isinstance(expr, ir.Select):
            return f"select({self.expr(expr.condition)}, {', '.join(self.typed(expr.yes, expr.no))})", PRIMARY
        if isinstance(expr, ir.Index):
            if isinstance(expr.index, ir.Literal) and not isinstance(expr.type, Struct):
                return f"{self.expr(expr.value, POSTFIX)}[{expr.index.value}]", POSTFIX
            return f"index({self.expr(expr.value)}, {self.expr(expr.index)})", PRIMARY
        return super().bound(expr)

    def unary(self, unary: ir.Unary) -> tuple[str, int]:
        operand = unary.operand
        if unary.op == "!":
            return f"not_({self.expr(operand)})", PRIMARY
        text = self.expr(operand, UNARY) if kind_of(operand.type) != "uint" else self.typed(operand)[0]
        if unary.op == "-" and unary.type.kind == "int" and self.numbers.plain(operand) and self.numbers.may_wrap(unary):  # type: ignore[union-attr]  # it has a kind
            return f"to_int(-{text})", PRIMARY
        return f"{unary.op}{text}", UNARY

    def binary(self, binary: ir.Binary) -> tuple[str, int]:
        op, left, right = binary.op, binary.left, binary.right
        kind, plain = kind_of(left.type), self.numbers.plain(left) and self.numbers.plain(right)
        function = self.operator_function(binary, plain)
        if function:
            text = f"{function}({', '.join(self.typed(left, right))})"
            return (f"not_({text})" if op == "!=" else text), PRIMARY
        op = _OPERATORS.get(op, op)
        level = _PRECEDENCE[op]
        first, second = self.expr(left, level + (level == 5)), self.expr(right, level + 1)
        if second[0] == "-" and op in ("+", "-"):
            second = f"({second})"
        if kind == "uint" and plain:
            first = f"to_uint({self.expr(left)})"
        text = f"{first} {op} {second}"
        if kind == "int" and plain and op in ("+", "-", "*") and self.numbers.may_wrap(binary):
            return f"to_int({text})", PRIMARY
        return text, level

    def operator_function(self, binary: ir.Binary, plain: bool) -> str:
        """The runtime's function for an operator that Python's own does not stand for, else ''."""
        op, left, right = binary.op, binary.left, binary.right
        if op in ("==", "!="):
            return "" if isinstance(left.type, Scalar) else "equals"
        if op == "*" and isinstance(left.type, Matrix) and not isinstance(right.type, Scalar):
            return "mat_mul" if isinstance(right.type, Matrix) else "mat_vec"
        if op == "*" and isinstance(left.type, Vector) and isinstance(right.type, Matrix):
            return "vec_mat"
        if op == "/" and kind_of(left.type) == "float":
            return "divide" if plain and not nonzero(right) else ""
        if op in ("<<", ">>"):
            safe = isinstance(right, ir.Literal) and 0 <= right.value < 32 and not self.numbers.plain(left)
            return "" if safe else {"<<": "shift_left", ">>": "shift_right"}[op]
        return {"/": "int_divide", "%": "int_remainder"}.get(op, "")

    def arguments(self, args: tuple[ir.Expr, ...]) -> str:
        return ", ".join(self.typed(*args))

    def intrinsic(self, call: ir.Intrinsic) -> tuple[str, int]:
        return f"{_NAMES.get(call.name, call.name)}({self.arguments(call.args)})", PRIMARY

    def call(self, call: ir.Call) -> str:
        function = self.by_key[call.function]
        given = [arg for arg, param in zip(call.args, function.params, strict=True) if param.direction != "out"]
        return f"{self.function_name(function)}({', '.join([self.typed(arg)[0] for arg in given])})"

    def function_name(self, function: ir.Function) -> str:
        """Overloads that no pass has told apart get their types into their names."""
        if sum(other.name == function.name for other in self.module.functions) == 1:
            return function.name
        return re.sub(r"\W+", "_", function.key).strip("_")

    def construct(self, construct: ir.Construct) -> tuple[str, int]:
        type_, args = construct.type, construct.args
        if isinstance(type_, Struct):
            texts = [self.typed(arg)[0] for arg in args]
            fields = [f"{field.name}={text}" for field, text in zip(type_.fields, texts, strict=True)]
            return f"Record({', '.join(fields)})", PRIMARY
        if isinstance(type_, Array):
            texts = self.typed(*args) if kind_of(type_.element) != "uint" else [self.typed(arg)[0] for arg in args]
            repeated = len(texts) > 4 and len(set(texts)) == 1
            return f"array(*[{texts[0]}] * {len(texts)})" if repeated else f"array({', '.join(texts)})", PRIMARY
        kind, size = kind_of(type_), 1 if isinstance(type_, Scalar) else type_.size  # type: ignore[union-attr]  # a vector or matrix
        if len(args) > 1:
            parts = self.converted(kind, *args)
            return (f"mat({size}, {parts})" if isinstance(type_, Matrix) else f"vec({parts})"), PRIMARY
        part = self.converted(kind, *args)
        if isinstance(type_, Matrix):
            return f"{'resize' if isinstance(args[0].type, Matrix) else 'diagonal'}({size}, {part})", PRIMARY
        if isinstance(args[0].type, Scalar):
            return (f"splat({size}, {part})" if isinstance(type_, Vector) else part), PRIMARY
        if components(args[0].type) == size:
            return part, PRIMARY
        if size == 1:
            return f"{part if part.startswith('to_') else self.expr(args[0], POSTFIX)}[0]", POSTFIX
        return f'swizzle({part}, "{"xyzw"[:size]}")', PRIMARY

    def converted(self, kind: str, *args: ir.Expr) -> str:
        """The arguments of a constructor, each as its kind."""
        texts = self.typed(*args)
        foreign = [kind_of(arg.type) != kind for arg in args]
        return ", ".join(f"to_{kind}({text})" if far else text for text, far in zip(texts, foreign, strict=True))

    # Statements

    def block(self, block: ir.Block, indent: int) -> list[Line]:
        lines: list[Line] = []
        pad = "    " * indent
        for stmt in block:
            place = (stmt.span.file, stmt.span.line)
            if place not in self.told:
                self.told.add(place)
                lines += [Line(f"{pad}# {text}", stmt.span) for text in self.comments(*place)]
            lines.extend(self.statement(stmt, indent))
        return lines or [Line(f"{pad}pass")]

    def statement(self, stmt: ir.Stmt, indent: int) -> list[Line]:
        pad = "    " * indent
        if isinstance(stmt, ir.If):
            lines: list[Line] = []
            head = "if"
            while True:
                lines += wrap(f"{pad}{head} {self.expr(stmt.condition)}:", stmt.span)
                lines += self.block(stmt.then, indent + 1)
                if not (len(stmt.otherwise) == 1 and isinstance(stmt.otherwise[0], ir.If)):
                    break
                stmt, head = stmt.otherwise[0], "elif"
            if stmt.otherwise:
                lines += [Line(f"{pad}else:"), *self.block(stmt.otherwise, indent + 1)]
            return lines
        if isinstance(stmt, ir.For):
            return [Line(f"{pad}for {self.loop_header(stmt)}:", stmt.span), *self.block(stmt.body, indent + 1)]
        if isinstance(stmt, ir.While):
            return [*wrap(f"{pad}while {self.expr(stmt.condition)}:", stmt.span), *self.block(stmt.body, indent + 1)]
        text = self.simple(stmt)
        return wrap(pad + text, stmt.span) if text else []

    def loop_header(self, loop: ir.For) -> str:
        counter = count(loop)
        assert counter is not None  # other loops have become while
        start, stop = self.expr(counter.start), self.expr(counter.stop, _PRECEDENCE["+"])
        beyond = {"<=": 1, ">=": -1}.get(counter.op, 0)
        if beyond and isinstance(counter.stop, ir.Literal):
            stop = repr(int(counter.stop.value) + beyond)
        elif beyond:
            stop = f"{stop} {'+' if beyond > 0 else '-'} 1"
        bounds = [stop] if start == "0" and counter.step == 1 else [start, stop]
        bounds += [repr(counter.step)] if counter.step != 1 else []
        return f"{counter.name} in range({', '.join(bounds)})"

    def simple(self, stmt: ir.Stmt) -> str:
        if isinstance(stmt, ir.Declare):
            return self.assignment([stmt.name], stmt.value) if stmt.value is not None else ""
        if isinstance(stmt, ir.Assign):
            if isinstance(stmt.target, ir.Local) and not stmt.op:
                return self.assignment([stmt.target.name], stmt.value)
            value = ir.Binary(stmt.target.type, stmt.op, stmt.target, stmt.value, stmt.span) if stmt.op else stmt.value
            return self.store(stmt.target, self.typed(value)[0])
        if isinstance(stmt, ir.Evaluate):
            assert isinstance(stmt.call, ir.Call)
            return self.assignment(["_"] if stmt.call.type != VOID else [], stmt.call)
        if isinstance(stmt, ir.Return):
            return self.returned(self.typed(stmt.value) if stmt.value is not None else [])
        return super().simple(stmt)

    def assignment(self, names: list[str], value: ir.Expr) -> str:
        """`name = value`, or `name, out = call` where the call gives more than its result."""
        if isinstance(value, ir.Call):
            params = self.by_key[value.function].params
            outs = [arg for arg, param in zip(value.args, params, strict=True) if param.direction != "in"]
            names = names + [arg.name for arg in outs if isinstance(arg, ir.Local)]
        return f"{', '.join(names)} = {self.typed(value)[0]}"

    def store(self, target: ir.Expr, value: str) -> str:
        """The assignment that puts a new value into a variable or a part of one."""
        if isinstance(target, ir.Swizzle):
            return self.store(target.value, f'store_swizzle({self.expr(target.value)}, "{target.components}", {value})')
        if isinstance(target, ir.Index):
            place = self.expr(target.index)
            return self.store(target.value, f"store_index({self.expr(target.value)}, {place}, {value})")
        if isinstance(target, ir.Member):
            whole = self.expr(target.value, POSTFIX)
            return self.store(target.value, f"{whole}.replace({target.field}={value})")
        return f"{self.expr(target)} = {value}"

    def returned(self, values: list[str]) -> str:
        assert self.function is not None
        outs = [param.name for param in self.function.params if param.direction != "in"]
        return f"return {', '.join(values + outs)}".rstrip()

    # Declarations

    def print_function(self, function: ir.Function) -> list[Line]:
        self.function = function
        self.numbers.enter(function)
        given = ", ".join([param.name for param in function.params if param.direction != "out"])
        lines = [Line(""), *wrap(f"def {self.function_name(function)}({given}):", function.span)]
        lines += [Line('    """' + text.replace("\\", "\\\\").replace('"', "'") + '"""') for text in summary(function.doc)]
        for name in self.local_constants(function):
            constant = self.constants[name]
            lines += wrap(f"    {name} = {self.typed(constant.value)[0]}", constant.span)
        body = function.body or ()
        ends = bool(body) and isinstance(body[-1], ir.Return)
        if not ends and self.returned([]) != "return":
            body = (*body, ir.Return(None, function.span))
        lines += self.block(body, 1)
        if lines[-1].text == "    return":
            lines.pop()
        return lines if len(lines) > 2 else [*lines, Line("    pass")]

    def local_constants(self, function: ir.Function) -> list[str]:
        """The constants that a function has to make, each after those it needs."""
        found: dict[str, None] = {}

        def need(name: str) -> None:
            if name in self.constants and not self.shared(self.constants[name]):
                for part in subexpressions(self.constants[name].value):
                    if isinstance(part, ir.Global):
                        need(part.name)
                found[name] = None

        for part in all_expressions(function.body or ()):
            if isinstance(part, ir.Global):
                need(part.name)
        return list(found)

    def shared(self, constant: ir.Constant) -> bool:
        """Whether a constant is the same in every precision, so that the module can hold it."""
        return isinstance(constant.type, Scalar) and (constant.type.kind != "float" or self.numbers.plain(constant.value))

    def print_constant(self, constant: ir.Constant) -> list[Line]:
        if not self.shared(constant):
            return []
        return wrap(f"{constant.name} = {self.typed(constant.value)[0]}", constant.span)

    def print_struct(self, struct: ir.StructDecl) -> list[Line]:
        assert isinstance(struct.type, Struct)
        fields = ", ".join([field.name for field in struct.type.fields])
        return [Line(f"# {struct.type.name}: Record({fields})", struct.span)]

    def print_uniforms(self, members: list[Member]) -> list[Line]:
        """Each uniform with its default, for the caller to set another."""
        lines = []
        for uniform in (member.uniform for member in members):
            words = summary(uniform.doc)
            text = f"{uniform.name} = {self.default(uniform.type, uniform.default)}"
            lines.append(Line(f"{text}  # {words[0]}" if words else text, uniform.span))
        return lines

    def default(self, type_: Type, numbers: tuple[float, ...]) -> str:
        """A value from its components."""
        if isinstance(type_, Array):
            size = components(type_.element)
            parts = [self.default(type_.element, numbers[i : i + size]) for i in range(0, len(numbers), size)]
            return f"array({', '.join(parts)})"
        texts = [repr({"float": float, "bool": bool}.get(kind_of(type_), int)(number)) for number in numbers]
        if kind_of(type_) == "uint":
            texts[0] = f"to_uint({texts[0]})"
        if isinstance(type_, Scalar):
            return texts[0]
        size = f"{type_.size}, " if isinstance(type_, Matrix) else ""
        return f"{'mat' if size else 'vec'}({size}{', '.join(texts)})"

    def print_textures(self, textures: list[ir.Uniform]) -> list[Line]:
        """Each texture as one texel of its default, for the caller to set another."""
        lines = []
        for texture in textures:
            assert isinstance(texture.type, Sampler)
            hints = {name for name, _ in texture.hints}
            texel = next((text for hint, text in _TEXELS.items() if hint in hints), _TEXELS["default_white"])
            shape = {"2D": "1, 1, 4", "3D": "1, 1, 1, 4", "Cube": "6, 1, 1, 4"}[texture.type.dim]
            dim = ', dim="Cube"' if texture.type.dim == "Cube" else ""
            lines.append(Line(f"{texture.name} = Texture(np.full(({shape}), {texel}){dim})", texture.span))
        return lines


def wrap(text: str, span: ir.Span) -> list[Line]:
    """Breaks a long line inside its outermost parentheses that help, after a comma or before an operator."""
    indent = " " * (len(text) - len(text.lstrip()) + 4)
    lines: list[Line] = []
    open_ = 0
    while len(text) > WIDTH:
        depth, places = open_, []
        for match in re.finditer(r"[(\[]|[)\]]|(?<=,) | (?=[-+*/&|<>]+ )", text):
            depth += (match[0] in "([") - (match[0] in ")]")
            if match[0] == " " and depth > 0 and len(indent) < match.start() <= WIDTH:
                places.append((depth, -match.start()))
        if not places:
            break
        place = -min(places)[1]
        open_ += text.count("(", 0, place) + text.count("[", 0, place) - text.count(")", 0, place) - text.count("]", 0, place)
        lines.append(Line(text[:place], span))
        text = indent + text[place:].lstrip()
    return [*lines, Line(text, span)]
