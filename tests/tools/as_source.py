"""Writes IR as source in the language; the front end makes the same module of the source, apart from spans."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.types import BOOL, UINT, Array, Scalar, Struct, Type, components, kind_of, spell

NOWHERE = ir.NOWHERE


def as_source(module: ir.Module) -> str:
    """The source of a module from `strategies.modules`, every expression in parentheses."""
    return _Source(module).text()


class _Source:
    def __init__(self, module: ir.Module) -> None:
        self.module = module
        self.functions = {function.key: function for function in module.functions}
        self.quantities: dict[tuple[type, str], str] = {
            (ir.Global, uniform.name): uniform.quantity for uniform in module.uniforms
        }

    def text(self) -> str:
        module = self.module
        parts = []
        for struct in module.structs:
            assert isinstance(struct.type, Struct)
            members = "".join(f"{self.declared(f.type, f.quantity, f.name)}; " for f in struct.type.fields)
            parts.append(f"{_comment(struct.doc)}struct {struct.type.name} {{ {members}}};")
        for constant in module.constants:
            value = self.expr(constant.value)
            parts.append(f"const {self.declared(constant.type, '', constant.name)} = {value};")
        parts += map(self.uniform, module.uniforms)
        parts += map(self.function, module.functions)
        return "\n".join(parts) + "\n"

    def declared(self, type_: Type, quantity: str, name: str) -> str:
        if isinstance(type_, Array):
            return f"{quantity or spell(type_.element)} {name}[{type_.length}]"
        return f"{quantity or spell(type_)} {name}"

    def uniform(self, uniform: ir.Uniform) -> str:
        hints = []
        for name, args in uniform.hints:
            texts = ", ".join(f'"{arg}"' if isinstance(arg, str) else repr(arg) for arg in args)
            hints.append(f"{name}({texts})" if args else name)
        text = f"uniform {self.declared(uniform.type, uniform.quantity, uniform.name)}"
        text += f" : {', '.join(hints)}" if hints else ""
        if uniform.default:
            text += f" = {self.default(uniform.type, list(uniform.default))}"
        return f"{_comment(uniform.doc)}{text};"

    def default(self, type_: Type, values: list[float]) -> str:
        if isinstance(type_, Array):
            size = components(type_.element)
            parts = [self.default(type_.element, values[at : at + size]) for at in range(0, len(values), size)]
            return f"{spell(type_)}({', '.join(parts)})"
        kind = kind_of(type_)
        convert = {"float": float, "int": int, "uint": int, "bool": bool}[kind]
        texts = [_literal(ir.Literal(Scalar(kind), convert(value), NOWHERE)) for value in values]
        return texts[0] if isinstance(type_, Scalar) else f"{spell(type_)}({', '.join(texts)})"

    def function(self, function: ir.Function) -> str:
        for param in function.params:
            self.quantities[ir.Local, param.name] = param.quantity
        self.result = function.quantity
        params = ", ".join(
            f"{param.direction} {self.declared(param.type, param.quantity, param.name)}" for param in function.params
        )
        result = function.quantity or spell(function.result)
        body = ";" if function.body is None else f" {self.block(function.body)}"
        return f"{_comment(function.doc)}{result} {function.name}({params}){body}"

    def block(self, block: ir.Block) -> str:
        return f"{{ {' '.join(map(self.stmt, block))} }}"

    def stmt(self, stmt: ir.Stmt) -> str:
        if isinstance(stmt, ir.Declare):
            value = f" = {self.expr(stmt.value)}" if stmt.value is not None else ""
            return f"{self.declared(stmt.type, '', stmt.name)}{value};"
        if isinstance(stmt, ir.Assign):
            return f"{self.bare(stmt.target)} {stmt.op}= {self.expr(stmt.value)};"
        if isinstance(stmt, ir.Evaluate):
            return f"{self.bare(stmt.call)};"
        if isinstance(stmt, ir.If):
            otherwise = f" else {self.block(stmt.otherwise)}" if stmt.otherwise else ""
            return f"if ({self.expr(stmt.condition)}) {self.block(stmt.then)}{otherwise}"
        if isinstance(stmt, ir.For):
            assert stmt.init is not None and stmt.condition is not None and stmt.step is not None
            step = self.stmt(stmt.step).rstrip(";")
            return f"for ({self.stmt(stmt.init)} {self.expr(stmt.condition)}; {step}) {self.block(stmt.body)}"
        if isinstance(stmt, ir.While):
            return f"while ({self.expr(stmt.condition)}) {self.block(stmt.body)}"
        if isinstance(stmt, ir.Return) and stmt.value is not None:
            return f"return {self.of_quantity(stmt.value, self.result)};"
        return f"{type(stmt).__name__.lower()};"

    def of_quantity(self, expr: ir.Expr, quantity: str) -> str:
        text = self.expr(expr)
        return f"{quantity}({text})" if quantity else text

    def expr(self, expr: ir.Expr) -> str:
        """An expression as a plain value: the constructor of its plain type removes a quantity."""
        text = self.bare(expr)
        return f"{spell(expr.type)}({text})" if self.quantity(expr) else f"({text})"

    def quantity(self, expr: ir.Expr) -> str:
        if isinstance(expr, ir.Local | ir.Global):
            return self.quantities.get((type(expr), expr.name), "")
        if isinstance(expr, ir.Call):
            return self.functions[expr.function].quantity
        if isinstance(expr, ir.Member) and isinstance(expr.value.type, Struct):
            return next(field.quantity for field in expr.value.type.fields if field.name == expr.field)
        return ""

    def bare(self, expr: ir.Expr) -> str:
        if isinstance(expr, ir.Literal):
            return _literal(expr)
        if isinstance(expr, ir.Local | ir.Global):
            return expr.name
        if isinstance(expr, ir.Unary):
            return f"{expr.op}{self.expr(expr.operand)}"
        if isinstance(expr, ir.Binary):
            return f"{self.expr(expr.left)} {expr.op} {self.expr(expr.right)}"
        if isinstance(expr, ir.Select):
            return f"{self.expr(expr.condition)} ? {self.expr(expr.yes)} : {self.expr(expr.no)}"
        if isinstance(expr, ir.Swizzle):
            return f"{self.inner(expr.value)}.{expr.components}"
        if isinstance(expr, ir.Member):
            return f"{self.inner(expr.value)}.{expr.field}"
        if isinstance(expr, ir.Index):
            return f"{self.inner(expr.value)}[{self.expr(expr.index)}]"
        quantities = [""] * len(expr.args)
        name = expr.name if isinstance(expr, ir.Intrinsic) else spell(expr.type)
        if isinstance(expr, ir.Call):
            function = self.functions[expr.function]
            name, quantities = function.name, [param.quantity for param in function.params]
        elif isinstance(expr.type, Struct):
            quantities = [field.quantity for field in expr.type.fields]
        args = [self.of_quantity(arg, quantity) for arg, quantity in zip(expr.args, quantities, strict=True)]
        return f"{name}({', '.join(args)})"

    def inner(self, expr: ir.Expr) -> str:
        return self.bare(expr) if isinstance(expr, ir.Local) else self.expr(expr)


def _literal(literal: ir.Literal) -> str:
    if literal.type == BOOL:
        return "true" if literal.value else "false"
    return f"{literal.value}u" if literal.type == UINT else repr(literal.value)


def _comment(doc: str) -> str:
    return "".join(f"/// {line}\n" for line in doc.split("\n")) if doc else ""
