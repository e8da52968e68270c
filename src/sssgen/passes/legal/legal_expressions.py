"""Expressions as a target has them, and the statements that must be executed before them. Used by `legalise`."""

from __future__ import annotations

import functools

from sssgen.ir import nodes as ir
from sssgen.ir.constant_evaluation import combine
from sssgen.ir.constant_expressions import literal
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.rules import element_type
from sssgen.ir.transform import Transformer, rewrite
from sssgen.ir.types import FLOAT, INT, UINT, Array, Matrix, Scalar, Struct, Vector, components, kind_of
from sssgen.passes import uniform_blocks as blocks
from sssgen.passes.capabilities import Capabilities
from sssgen.passes.legal.array_results import call_into
from sssgen.passes.legal.bool_conversions import by_comparisons
from sssgen.passes.legal.builtin_forms import BuiltinForms, Polyfill
from sssgen.passes.legal.choices import calls_or_samples, chooses_nested, is_expression
from sssgen.passes.legal.constant_calls import ConstantCalls
from sssgen.passes.legal.integer_operators import with_result
from sssgen.passes.legal.legal_operators import is_integer_division, legal_operator, widen
from sssgen.passes.legal.matrix_columns import by_whole_columns, matrix_from, needs_columns
from sssgen.passes.legal.wide_constants import ConstantIntegers, is_wider, overflowing_division
from sssgen.passes.lift_calls import Calls
from sssgen.passes.scopes import assigned, claim, declared, outs_of
from sssgen.passes.substitute import inline, is_cheap
from sssgen.passes.unsupported import MissingBuiltin, Unsupported
from sssgen.passes.variable_effects import effects

_NOT_CONSTANT = "this cannot be expressed in a constant for this target"


class LegalExpressions(Transformer):
    """Rewrites expressions: values that must be computed before a statement are appended to `out` before it."""

    def __init__(self, module: ir.Module, dialect: str, capabilities: Capabilities, polyfill: Polyfill) -> None:
        super().__init__()
        self.module = module
        self.capabilities = capabilities
        self.polyfill = polyfill
        self.builtins = BuiltinForms(dialect, polyfill)
        self.functions = {function.key: function for function in module.functions}
        self.helpers: dict[str, ir.Function] = {}
        """The functions of polyfills that are called."""
        self.uniforms = {uniform.name for uniform in module.uniforms}
        self.counters: list[str] = []
        """The counters of the enclosing loops that are never negative; '' for a loop without one."""
        self.names: set[str] = set()
        """All names of the current function, once a new one is chosen."""
        self.current: ir.Function | None = None
        """None in the value of a constant or variable, before which nothing can be computed."""
        self.shared = effects(module)
        self.calls = Calls(self.functions, self.shared)
        self.outs = outs_of(module.functions)
        self.writing = bool(self.shared or self.outs)
        """Whether any call can write anything."""
        computed = capabilities.wrapping_constants and capabilities.constant_choices
        self.integers = None if computed else ConstantIntegers()
        """None where the target computes all constants as GLSL does."""
        self.constants = {constant.name: constant.value for constant in module.constants}

    @functools.cached_property
    def constant_calls(self) -> ConstantCalls:
        return ConstantCalls(self.module, self.polyfill)

    # What is computed before a statement

    def new_name(self, name: str) -> str:
        """A name that the function does not use yet."""
        assert self.current is not None
        self.names = self.names or set(declared(self.current))
        return claim(name, self.names)

    def keep(self, value: ir.Expr, name: str) -> ir.Expr:
        """Computes a value before the statement, into a variable."""
        if self.current is None:
            raise Unsupported(_NOT_CONSTANT, value.span)
        name = self.new_name(name)
        self.out.append(ir.Declare(name, value.type, value, value.span))
        return ir.Local(value.type, name, value.span)

    def keep_expensive(self, value: ir.Expr, name: str) -> ir.Expr:
        return value if is_cheap(value) else self.keep(value, name)

    def detach(self, expr: ir.Expr) -> tuple[ir.Expr, list[ir.Stmt]]:
        """An expression, and the statements to be executed before it, which are not in `out`."""
        outer, self.out = self.out, []
        new = self.expression(expr)
        before, self.out = self.out, outer
        return new, before

    # Expressions

    def expression(self, expr: ir.Expr) -> ir.Expr:
        kind = type(expr)
        if kind is ir.Local or kind is ir.Literal:
            return expr
        if isinstance(expr, ir.Binary):
            left, right = self.expression(expr.left), self.expression(expr.right)
            same = left is expr.left and right is expr.right
            expr = expr if same else ir.Binary(expr.type, expr.op, left, right, expr.span)
            is_variable = type(left) is ir.Local or type(right) is ir.Local
            return self.binary(expr) if is_variable else self.legal(expr)
        if isinstance(expr, ir.Select) and not self.chooses(expr):
            return self.select(expr)
        if isinstance(expr, ir.Index) and isinstance(expr.value, ir.Global) and expr.value.name in self.uniforms:
            return blocks.element(expr._replace(index=self.expression(expr.index)), self.capabilities)
        new = super().expression(expr)
        if isinstance(new, ir.Call) and isinstance(new.type, Array) and not self.capabilities.array_constructors:
            place = ir.Local(new.type, self.new_name("values"), new.span)
            self.out.append(ir.Declare(place.name, new.type, None, new.span))
            self.out.append(ir.Evaluate(call_into(new, self.functions[new.function], place), new.span))
            return place
        return self.legal(new)

    def legal(self, expr: ir.Expr) -> ir.Expr:
        """A node whose operands are legal already."""
        nested = not self.capabilities.constant_choices and chooses_nested(expr)
        if self.integers is None and (value := overflowing_division(expr, self.constants)) is not None:
            return literal(expr.type, value, expr.span)
        if self.integers is None or not (nested or kind_of(expr.type) in ("int", "uint")):
            return self.expressible(expr)
        parts = self.integers.parts(expr)
        numbers = combine(expr, parts) if parts else None
        if numbers is None:
            return self.expressible(expr)
        computed = nested or (not self.capabilities.wrapping_constants and is_wider(expr, parts, numbers))
        legal = literal(expr.type, numbers, expr.span) if computed else self.expressible(expr)
        self.integers.note(legal, numbers)
        return legal

    def expressible(self, expr: ir.Expr) -> ir.Expr:
        """A node whose operands are legal already, as the target can express it."""
        if isinstance(expr, ir.Binary):
            return self.binary(expr)
        if isinstance(expr, ir.Intrinsic):
            return self.intrinsic(expr)
        return self.construct(expr) if isinstance(expr, ir.Construct) else self.node(expr)

    def place(self, place: ir.Expr) -> ir.Expr:
        """The target of an assignment: only its indices are expressions."""
        if isinstance(place, ir.Swizzle | ir.Member):
            return self.node(place._replace(value=self.place(place.value)))
        if isinstance(place, ir.Index):
            return self.node(place._replace(value=self.place(place.value), index=self.expression(place.index)))
        return place

    def node(self, expr: ir.Expr) -> ir.Expr:
        """Another node whose operands are legal already."""
        if (
            isinstance(expr, ir.Unary)
            and expr.op == "-"
            and kind_of(expr.type) == "uint"
            and not self.capabilities.uint_minus
        ):
            zero = widen(ir.Literal(UINT, 0, expr.span), components(expr.type))
            return ir.Binary(expr.type, "-", zero, expr.operand, expr.span)
        if (
            isinstance(expr, ir.Unary)
            and isinstance(expr.type, Matrix)
            and not self.capabilities.matrix_scalar_arithmetic
        ):
            return ir.Binary(expr.type, "*", expr.operand, ir.Literal(FLOAT, -1.0, expr.span), expr.span)
        if isinstance(expr, ir.Global) and expr.name in self.uniforms:
            value = blocks.read(expr, self.capabilities)
            return value if value is expr or not isinstance(value, ir.Construct) else self.construct(value)
        if isinstance(expr, ir.Swizzle) and isinstance(expr.value, ir.Swizzle):
            letters = "".join([expr.value.components["xyzw".index(letter)] for letter in expr.components])
            return expr._replace(value=expr.value.value, components=letters)
        if isinstance(expr, ir.Index) and isinstance(expr.value, ir.Swizzle) and isinstance(expr.index, ir.Literal):
            # a store into `v.zyx[1]` is lost by DXC
            letter = expr.value.components[int(expr.index.value)]
            return ir.Swizzle(expr.type, expr.value.value, letter, expr.span)
        if isinstance(expr, ir.Index) and type(expr.index) is ir.Local and self.integers is not None:
            return self.element(expr, expr.index, self.integers)
        return expr

    def element(self, expr: ir.Index, variable: ir.Local, integers: ConstantIntegers) -> ir.Index:
        """An element at the value of a variable. Compilers that know the value refuse an index outside; the language
        gives it any element."""
        declared = self.scope.get(variable.name)
        value = integers.value(declared.value) if isinstance(declared, ir.Declare) and declared.value else None
        _, length = element_type(expr.value.type) or (None, 0)
        if value is None or 0 <= value[0] < length or not length or self.current is None:
            return expr
        if variable.name in assigned(self.current, self.outs):
            return expr
        return expr._replace(index=ir.Literal(INT, max(0, min(int(value[0]), length - 1)), variable.span))

    def construct(self, construct: ir.Construct) -> ir.Expr:
        type_, args, span = construct.type, construct.args, construct.span
        if kind_of(type_) == "bool" and not self.capabilities.bool_conversions:
            return by_comparisons(construct, self.intrinsic)
        if isinstance(type_, Matrix) and len(args) == 1 and not self.capabilities.matrix_conversions:
            return matrix_from(type_, args[0], self.keep_expensive, span)
        if isinstance(type_, Matrix) and needs_columns(type_, args) and not self.capabilities.mixed_columns:
            kept = [arg if is_cheap(arg) or isinstance(arg.type, Scalar) else self.keep(arg, "part") for arg in args]
            return by_whole_columns(type_, kept, span)
        if isinstance(type_, Struct) and not self.capabilities.struct_constructors:
            return self.keep(construct, type_.name[0].lower() + type_.name[1:])
        if isinstance(type_, Array) and not self.capabilities.array_constructors:
            return self.keep(construct, "values")
        return construct

    def binary(self, binary: ir.Binary) -> ir.Expr:
        if is_integer_division(binary) and not self.capabilities.integer_division and self.current is not None:
            return rewrite(with_result(binary, self.keep_expensive, self.counters), self.part_of_division)
        return legal_operator(binary, self.capabilities, self.keep_expensive)

    def part_of_division(self, part: ir.Expr) -> ir.Expr:
        """A part of what stands for an integer division or a shift: `equal` or a shift may have another form."""
        if isinstance(part, ir.Intrinsic):
            return self.intrinsic(part)
        if isinstance(part, ir.Binary) and part.op in ("<<", ">>", "&"):
            return legal_operator(part, self.capabilities, self.keep_expensive)
        return part

    # Builtins

    def intrinsic(self, call: ir.Intrinsic) -> ir.Expr:
        types = tuple([arg.type for arg in call.args])
        text = self.builtins.text(call.name, types)
        if self.current is None and not self.builtins.is_constant(call.name):
            raise Unsupported(_NOT_CONSTANT, call.span)
        if not self.capabilities.constant_choices and BUILTINS[call.name].is_choice(types):
            number = self.constant_calls.literals(call)
            if number is not None:
                return number
        if text and self.integers is not None and not self.capabilities.undefined_constants:
            text = "" if self.builtins.is_outside(call, self.integers.value) else text
        return self.builtins.spell_call(call, text) if text else self.replace_builtin(call)

    def replace_builtin(self, call: ir.Intrinsic) -> ir.Expr:
        """A builtin that the target has by a polyfill."""
        module = self.builtins.module(call)
        try:
            return self.call_polyfill(self.builtins.inlinable(call, module, self.keep_expensive), module)
        except MissingBuiltin:  # one of the polyfill, which the author has not written
            raise MissingBuiltin(call.name, call.span) from None

    def call_polyfill(self, call: ir.Intrinsic, module: ir.Module) -> ir.Expr:
        """The polyfill's expression where it is short and its arguments are cheap, else a call of the polyfill."""
        function = module.functions[-1]
        writes = self.writing and any(map(self.calls.writing, call.args))  # each is evaluated once, in this order
        placed = inline(module, call.args, call.span) if not writes else None
        if placed is not None:
            return self.expression(placed)
        if self.current is None:
            raise Unsupported(_NOT_CONSTANT, call.span)
        for helper in module.functions:
            if helper.key not in self.helpers:
                self.functions[helper.key] = helper
                self.outs |= outs_of([helper])
                self.writing = bool(self.shared or self.outs)
                self.helpers[helper.key] = helper  # before its own body: it may be asked for again there
                legal = self.function(helper)
                del self.helpers[helper.key]
                self.helpers[helper.key] = legal
        return ir.Call(call.type, function.key, call.args, call.span)

    # Choices

    def select(self, select: ir.Select, place: ir.Local | None = None) -> ir.Expr:
        """A choice for a target that evaluates both arms: as such for plain values; else the arms move into an if.

        The if assigns to `place`, or to a new variable, which is returned.
        """
        span = select.span
        condition = self.expression(select.condition)
        if self.current is None:
            if not isinstance(select.type, Scalar | Vector):
                raise Unsupported(_NOT_CONSTANT, span)
            yes, no = self.expression(select.yes), self.expression(select.no)
            return self.legal(ir.Select(select.type, condition, yes, no, span))
        arms = (select.yes, select.no)
        if not self.branches(select):
            (yes, before_yes), (no, before_no) = self.detach(select.yes), self.detach(select.no)
            if not before_yes and not before_no:
                return self.legal(ir.Select(select.type, condition, yes, no, span))
        if place is None:
            place = ir.Local(select.type, self.new_name("chosen"), span)
            self.out.append(ir.Declare(place.name, select.type, None, span))
        then, otherwise = (self.inner((ir.Assign(place, "", arm, arm.span),)) for arm in arms)
        self.out.append(ir.If(condition, then, otherwise, span))
        return place

    def chooses(self, select: ir.Select) -> bool:
        """Whether the target has an expression for this choice."""
        return is_expression(select, self.capabilities)

    def branches(self, select: ir.Select) -> bool:
        """Whether a choice becomes an if: its arms are not plain values, or one of them calls or samples."""
        if self.chooses(select) or self.current is None:
            return False
        return not isinstance(select.type, Scalar | Vector) or calls_or_samples(select)
