"""Prints Python on NumPy arrays: the oracle that the other targets are compared with.

It prints modules that the pass `predicate` returned: a function takes arrays with the lanes on the last axis (see
`numpy_values`) and returns its result, then its out and inout parameters. Values are never changed in place, so that
variables may share them: `v.x = 1.0` is `v = store_swizzle(v, "x", 1.0)`. Uniforms that are not parameters are globals
of the module; constants that are not plain numbers are computed in each function that uses them, as their element type
is that of `with precision(…)` around the call.
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.types import VOID, Scalar, Struct
from sssgen.ir.walk import all_expressions, subexpressions
from sssgen.passes.numpy.uniformity import count
from sssgen.targets.descriptor import Target
from sssgen.targets.printers.numpy_expressions import PYTHON_PRECEDENCE, NumpyExpressions
from sssgen.targets.printers.printed_lines import Line, first_sentence, summary
from sssgen.targets.printers.printer import POSTFIX
from sssgen.targets.printers.python_text import texture_text, value_text, wrap
from sssgen.targets.registry import load
from sssgen.targets.uniform_layout import Member


def print_functions(module: ir.Module) -> str:
    """A whole Python module with the functions of a predicated module with legal names."""
    printer = NumpyPrinter(load("numpy"), module)
    parts = [[line for constant in module.constants for line in printer.print_constant(constant)]]
    parts += [printer.print_function(function) for function in module.functions]
    text = "\n\n".join("\n".join(line.text for line in part) for part in parts if part)
    return f"from sssgen.targets.numpy_runtime import *\n\n{text}\n"


class NumpyPrinter(NumpyExpressions):
    """Prints one module."""

    def __init__(self, target: Target, module: ir.Module) -> None:
        super().__init__(target, module)
        self.constants = {constant.name: constant for constant in module.constants}
        self.sharing: dict[str, bool] = {}
        """The results of `shared`."""
        self.printed_comments: set[tuple[str, int]] = set()

    # Statements

    def block(self, block: ir.Block, indent: int) -> list[Line]:
        lines: list[Line] = []
        pad = "    " * indent
        for stmt in block:
            place = (stmt.span.file, stmt.span.line)
            if place not in self.printed_comments:
                self.printed_comments.add(place)
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
            return [
                Line(f"{pad}for {self.loop_header(stmt)}:", stmt.span),
                *self.block(stmt.body, indent + 1),
            ]
        if isinstance(stmt, ir.While):
            return [
                *wrap(f"{pad}while {self.expr(stmt.condition)}:", stmt.span),
                *self.block(stmt.body, indent + 1),
            ]
        text = self.simple(stmt)
        return wrap(pad + text, stmt.span) if text else []

    def loop_header(self, loop: ir.For) -> str:
        counter = count(loop)
        assert counter is not None  # all other loops are while loops by now
        start, stop = self.expr(counter.start), self.expr(counter.stop, PYTHON_PRECEDENCE["+"])
        offset = {"<=": 1, ">=": -1}.get(counter.op, 0)
        if offset and isinstance(counter.stop, ir.Literal):
            stop = repr(int(counter.stop.value) + offset)
        elif offset:
            stop = f"{stop} {'+' if offset > 0 else '-'} 1"
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
            return self.return_text(self.typed(stmt.value) if stmt.value is not None else [])
        return super().simple(stmt)

    def assignment(self, names: list[str], value: ir.Expr) -> str:
        """`name = value`, or `name, out = call` where the call returns more than its result."""
        if isinstance(value, ir.Call):
            params = self.by_key[value.function].params
            outs = [arg for arg, param in zip(value.args, params, strict=True) if param.direction != "in"]
            names = names + [arg.name for arg in outs if isinstance(arg, ir.Local)]
        text = self.typed(value)[0]
        return f"{', '.join(names)} = {text}" if names else text

    def store(self, target: ir.Expr, value: str) -> str:
        """The assignment of a new value to a variable or a part of one."""
        if isinstance(target, ir.Swizzle):
            return self.store(target.value, f'store_swizzle({self.expr(target.value)}, "{target.components}", {value})')
        if isinstance(target, ir.Index):
            index = self.expr(target.index)
            return self.store(target.value, f"store_index({self.expr(target.value)}, {index}, {value})")
        if isinstance(target, ir.Member):
            record = self.expr(target.value, POSTFIX)
            return self.store(target.value, f"{record}.replace({target.field}={value})")
        return f"{self.expr(target)} = {value}"

    def return_text(self, values: list[str]) -> str:
        assert self.function is not None
        outs = [param.name for param in self.function.params if param.direction != "in"]
        return f"return {', '.join(values + outs)}".rstrip()

    # Declarations

    def print_function(self, function: ir.Function) -> list[Line]:
        self.function = function
        self.numbers.enter(function)
        params = ", ".join([param.name for param in function.params if param.direction != "out"])
        lines = [Line(""), *wrap(f"def {function.name}({params}):", function.span)]
        texts = summary(function.doc.replace("\\", "\\\\").replace('"', "'"), '    """"""')
        if texts:
            texts[0] = f'"""{texts[0]}'
            texts[-1] += '"""'
            lines += [Line(f"    {text}") for text in texts]
        for name in self.local_constants(function):
            constant = self.constants[name]
            lines += wrap(f"    {name} = {self.typed(constant.value)[0]}", constant.span)
        body = function.body or ()
        ends = bool(body) and isinstance(body[-1], ir.Return)
        if not ends and self.return_text([]) != "return":
            body = (*body, ir.Return(None, function.span))
        lines += self.block(body, 1)
        if lines[-1].text == "    return":
            lines.pop()
        return lines if len(lines) > 2 else [*lines, Line("    pass")]

    def local_constants(self, function: ir.Function) -> list[str]:
        """The constants that a function has to compute, each after those that it depends on."""
        names: dict[str, None] = {}

        def need(name: str) -> None:
            if name in self.constants and not self.is_shared(self.constants[name]):
                for part in subexpressions(self.constants[name].value):
                    if isinstance(part, ir.Global):
                        need(part.name)
                names[name] = None

        for part in all_expressions(function.body or ()):
            if isinstance(part, ir.Global):
                need(part.name)
        return list(names)

    def is_shared(self, constant: ir.Constant) -> bool:
        """Whether a constant is the same in every precision, so that it can be a global of the module."""
        result = self.sharing.get(constant.name)
        if result is None:
            used = [part.name for part in subexpressions(constant.value) if isinstance(part, ir.Global)]
            result = self.sharing[constant.name] = (
                isinstance(constant.type, Scalar)
                and (constant.type.kind != "float" or self.numbers.plain(constant.value))
                and all(self.is_shared(self.constants[name]) for name in used if name in self.constants)
            )
        return result

    def print_constant(self, constant: ir.Constant) -> list[Line]:
        if not self.is_shared(constant):
            return []
        return wrap(f"{constant.name} = {self.typed(constant.value)[0]}", constant.span)

    def print_struct(self, struct: ir.StructDecl) -> list[Line]:
        assert isinstance(struct.type, Struct)
        fields = ", ".join([field.name for field in struct.type.fields])
        return [Line(f"# {struct.type.name}: Record({fields})", struct.span)]

    def print_uniforms(self, members: list[Member]) -> list[Line]:
        """Each uniform with its default, which the caller may replace."""
        lines = []
        for uniform in (member.uniform for member in members):
            words = first_sentence(uniform.doc)
            text = f"{uniform.name} = {value_text(uniform.type, uniform.default)}"
            lines.append(Line(f"{text}  # {words}" if words else text, uniform.span))
        return lines

    def print_textures(self, textures: list[ir.Uniform]) -> list[Line]:
        """Each texture as one texel of its default, which the caller may replace."""
        return [Line(f"{texture.name} = {texture_text(texture)}", texture.span) for texture in textures]
