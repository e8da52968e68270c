"""Computes constants: parameters that a material fixes, arithmetic of literals, branches with a known condition.

Why: a fixed parameter costs nothing at run time and leaves no uniform; every target gets the same numbers;
WGSL computes constants itself, but refuses a module in which one is inf or NaN: such an expression is not
changed.
Place: first after `link`, so that `prune` finds dead branches and unused uniforms.

Only identities that hold for every float are used: `x * 1.0`, `x + 0.0` (but for the sign of a zero), never
`x * 0.0`. Module constants keep their names, for the reader, unless knowing them decides a condition.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sssgen.ir import constant_arithmetic as arithmetic
from sssgen.ir import nodes as ir
from sssgen.ir.constant_arithmetic import Numbers
from sssgen.ir.constant_expressions import constant_numbers, literal, placed_at, same_number, uniform_value
from sssgen.ir.rules import element_type
from sssgen.ir.transform import Transformer, rewrite
from sssgen.ir.types import BOOL, Matrix, Scalar, Struct, Vector, kind_of
from sssgen.ir.walk import operands
from sssgen.passes.constructed_parts import calls, only_argument, pick_components
from sssgen.passes.scopes import separate


def fold(module: ir.Module, fixed: Mapping[str, tuple[float, ...]] = {}) -> ir.Module:
    """The module with its constants computed; the uniforms named in `fixed` are replaced by these components.

    Raises ValueError where the components of a fixed uniform are not as many as its type has.
    """
    folder = _Folder()
    for uniform in module.uniforms:
        if uniform.name in fixed:
            folder.fixed[uniform.name] = uniform_value(uniform.type, fixed[uniform.name], uniform.span)
    constants = []
    for constant in module.constants:
        value = folder.expression(constant.value)
        constants.append(constant if value is constant.value else constant._replace(value=value))
        substituted = folder.with_constants(value)
        if isinstance(substituted, ir.Literal) or constant_numbers(substituted) is not None:
            folder.constants[constant.name] = substituted
    functions = tuple([folder.function(function) for function in module.functions])
    uniforms = module.uniforms
    if folder.fixed:
        uniforms = tuple([uniform for uniform in uniforms if uniform.name not in folder.fixed])
    variables = tuple([folder.variable(variable) for variable in module.variables])
    return module._replace(constants=tuple(constants), uniforms=uniforms, functions=functions, variables=variables)


class _Folder(Transformer):
    """Folds expressions and statements, from the leaves up."""

    def __init__(self) -> None:
        super().__init__()
        self.fixed: dict[str, ir.Expr] = {}
        self.constants: dict[str, ir.Expr] = {}
        self.spliced = False
        """Whether statements of an inner block have moved into an outer one."""
        self.methods: dict[type, Any] = {
            ir.Binary: self.binary,
            ir.Unary: self.unary,
            ir.Select: self.select,
            ir.Intrinsic: self.intrinsic,
            ir.Construct: self.construct,
            ir.Swizzle: self.swizzle,
            ir.Index: self.index,
            ir.Member: self.member,
        }

    def variable(self, variable: ir.Variable) -> ir.Variable:
        value = self.expression(variable.value) if variable.value is not None else None
        return variable if value is variable.value else variable._replace(value=value)

    # Statements

    def function(self, function: ir.Function) -> ir.Function:
        self.spliced = False
        function = super().function(function)
        return separate(function) if self.spliced else function

    def assign(self, stmt: ir.Assign) -> ir.Stmt | None:
        target, value = self.expression(stmt.target), self.expression(stmt.value)
        if stmt.op and _is_neutral(stmt.op, value) and value.type == target.type and not calls(target):
            return None
        same = target is stmt.target and value is stmt.value
        return stmt if same else ir.Assign(target, stmt.op, value, stmt.span)

    def branch(self, stmt: ir.If) -> ir.Stmt | None:
        condition = self.condition(stmt.condition)
        if isinstance(condition, ir.Literal):
            self.spliced = True
            self.out += self.block(stmt.then if condition.value else stmt.otherwise)
            return None
        then, otherwise = self.inner(stmt.then), self.inner(stmt.otherwise)
        same = condition is stmt.condition and then is stmt.then and otherwise is stmt.otherwise
        return stmt if same else ir.If(condition, then, otherwise, stmt.span)

    def assume(self, stmt: ir.Assume) -> ir.Stmt | None:
        new = super().assume(stmt)
        return None if isinstance(new, ir.Assume) and isinstance(new.condition, ir.Literal) else new

    def while_loop(self, stmt: ir.While) -> ir.Stmt | None:
        condition = self.condition(stmt.condition)
        if isinstance(condition, ir.Literal) and not condition.value:
            return None
        body = self.inner(stmt.body)
        return stmt if condition is stmt.condition and body is stmt.body else ir.While(condition, body, stmt.span)

    def for_loop(self, stmt: ir.For) -> ir.Stmt | None:
        new = super().for_loop(stmt)
        assert isinstance(new, ir.For)
        init, condition = new.init, new.condition
        if condition is None or not isinstance(init, (ir.Declare, ir.Assign)) or not self.never_runs(init, condition):
            return new
        return init if isinstance(init, ir.Assign) else None

    def header(self, stmt: ir.Stmt | None) -> ir.Stmt | None:
        """A statement without effect stays here, as the loop would not be seen to end."""
        return super().header(stmt) or stmt

    def never_runs(self, init: ir.Declare | ir.Assign, condition: ir.Expr) -> bool:
        """Whether a loop's condition is false with the value that `init` sets."""
        if init.value is None or (isinstance(init, ir.Assign) and (init.op or not isinstance(init.target, ir.Local))):
            return False
        start = self.with_constants(init.value)
        if constant_numbers(start) is None:
            return False
        name = init.name if isinstance(init, ir.Declare) else init.target.name  # type: ignore[union-attr]  # a Local

        def change(node: ir.Expr) -> ir.Expr:
            return start if type(node) is ir.Local and node.name == name else node

        first = self.with_constants(self.expression(rewrite(condition, change)))
        return isinstance(first, ir.Literal) and not first.value

    # Conditions

    def with_constants(self, expr: ir.Expr) -> ir.Expr:
        """The expression with the values of module constants substituted and folded."""

        def change(node: ir.Expr) -> ir.Expr:
            return self.constants.get(node.name, node) if type(node) is ir.Global else node

        substituted = rewrite(expr, change)
        return expr if substituted is expr else self.expression(substituted)

    def condition(self, condition: ir.Expr) -> ir.Expr:
        """A condition, as a literal where the module's constants decide it."""
        return self.decide(self.expression(condition))

    def decide(self, condition: ir.Expr) -> ir.Expr:
        if isinstance(condition, ir.Literal) or not self.constants:
            return condition
        substituted = self.with_constants(condition)
        if substituted is condition or isinstance(substituted, ir.Literal):
            return substituted
        if isinstance(condition, ir.Binary) and condition.op in ("&&", "||"):
            left, right = self.decide(condition.left), self.decide(condition.right)
            if left is not condition.left or right is not condition.right:
                return self.simplify(condition._replace(left=left, right=right))
        return condition

    # Expressions

    def expression(self, expr: ir.Expr) -> ir.Expr:
        """The expression, folded."""
        kind = type(expr)
        if kind is ir.Local or kind is ir.Literal:
            return expr
        if kind is ir.Global:
            value = self.fixed.get(expr.name)  # type: ignore[union-attr]  # it is a Global
            return expr if value is None else placed_at(value, expr.span)
        if kind is ir.Call:
            return super().expression(expr)
        folded: ir.Expr = self.methods[kind](expr)
        return folded

    def binary(self, expr: ir.Binary) -> ir.Expr:
        left, right = self.expression(expr.left), self.expression(expr.right)
        if left is not expr.left or right is not expr.right:
            expr = ir.Binary(expr.type, expr.op, left, right, expr.span)
        left_kind, right_kind = type(left), type(right)
        if (
            left_kind is ir.Literal
            or right_kind is ir.Literal
            or left_kind is ir.Construct
            or right_kind is ir.Construct
        ):
            return self.simplify(expr)
        return expr

    def simplify(self, expr: ir.Binary) -> ir.Expr:
        """The value of an operator with a constant operand or two, where that is simpler."""
        op, left, right = expr.op, expr.left, expr.right
        x, y = constant_numbers(left), constant_numbers(right)
        if x is not None and y is not None:
            values = arithmetic.binary(op, x, y, kind_of(left.type))
            return literal(expr.type, values, expr.span) if values is not None else expr
        if op in ("&&", "||", "^^"):
            return _logic(expr, x, y)
        if left.type == expr.type and _is_neutral(op, right):
            return left
        return right if right.type == expr.type and op in "*+|^" and _is_neutral(op, left) else expr

    def unary(self, expr: ir.Unary) -> ir.Expr:
        operand = self.expression(expr.operand)
        values = constant_numbers(operand)
        if values is not None:
            result = arithmetic.unary(expr.op, values, kind_of(expr.type))
            if result is not None:
                return literal(expr.type, result, expr.span)
        if isinstance(operand, ir.Unary) and operand.op == expr.op:
            return operand.operand
        return expr if operand is expr.operand else ir.Unary(expr.type, expr.op, operand, expr.span)

    def select(self, expr: ir.Select) -> ir.Expr:
        condition = self.condition(expr.condition)
        if isinstance(condition, ir.Literal):
            return self.expression(expr.yes if condition.value else expr.no)
        yes, no = self.expression(expr.yes), self.expression(expr.no)
        if expr.type == BOOL and isinstance(yes, ir.Literal) and isinstance(no, ir.Literal) and yes.value != no.value:
            return condition if yes.value else ir.Unary(BOOL, "!", condition, expr.span)
        if condition is expr.condition and yes is expr.yes and no is expr.no:
            return expr
        return ir.Select(expr.type, condition, yes, no, expr.span)

    def intrinsic(self, expr: ir.Intrinsic) -> ir.Expr:
        new = super().expression(expr)
        args: list[Numbers] = []
        for arg in operands(new):
            if type(arg) is not ir.Literal and type(arg) is not ir.Construct:
                return new
            values = constant_numbers(arg)
            if values is None:
                return new
            args.append(values)
        result = arithmetic.builtin(expr.name, args, [arg.type for arg in expr.args], expr.type)
        return new if result is None else literal(expr.type, result, expr.span)

    def construct(self, expr: ir.Construct) -> ir.Expr:
        new = super().expression(expr)
        assert isinstance(new, ir.Construct)
        type_, args = new.type, new.args
        if not isinstance(type_, Scalar | Vector):
            return new
        if len(args) == 1:
            only = args[0]
            if only.type == type_:
                return only
            values = constant_numbers(only) if kind_of(only.type) != type_.kind else None
            converted = [arithmetic.converted(value, type_.kind) for value in values or ()]
            if converted and None not in converted:
                return literal(type_, tuple([value for value in converted if value is not None]), new.span)
            return new
        flat: list[ir.Expr] = []
        for arg in args:
            if isinstance(arg, ir.Construct) and len(arg.args) > 1:
                flat.extend(arg.args)
            else:
                flat.append(arg)
        if len(flat) > len(args):
            new = ir.Construct(type_, tuple(flat), new.span)
        parts = [constant_numbers(arg) or () for arg in flat]
        numbers = tuple([number for part in parts for number in part])
        if () not in parts and all(same_number(number, numbers[0]) for number in numbers):
            return literal(type_, numbers, new.span)
        return new

    def swizzle(self, expr: ir.Swizzle) -> ir.Expr:
        value, letters = self.expression(expr.value), expr.components
        if isinstance(value, ir.Swizzle):
            letters = "".join([value.components["xyzw".index(letter)] for letter in letters])
            value = value.value
        if value.type == expr.type and letters == "xyzw"[: len(letters)]:
            return value
        if isinstance(value, ir.Construct):
            parts = pick_components(value, ["xyzw".index(letter) for letter in letters], expr.type, expr.span)
            if parts is not None:
                return parts
        if value is expr.value and letters == expr.components:
            return expr
        return ir.Swizzle(expr.type, value, letters, expr.span)

    def index(self, expr: ir.Index) -> ir.Expr:
        new = super().expression(expr)
        assert isinstance(new, ir.Index)
        value, index = new.value, new.index
        if not isinstance(index, ir.Literal):
            return new
        last = (element_type(value.type) or (expr.type, 1))[1] - 1
        if not 0 <= index.value <= last:
            # the value is undefined; targets refuse such an index
            index = index._replace(value=0 if index.value < 0 else last)
            new = ir.Index(expr.type, value, index, expr.span)
        if isinstance(value, ir.Construct):
            place = int(index.value)
            if isinstance(value.type, Vector):
                return pick_components(value, [place], expr.type, expr.span) or new
            if len(value.args) == last + 1 and all(arg.type == expr.type for arg in value.args):
                return only_argument(value, place) or new
        return new

    def member(self, expr: ir.Member) -> ir.Expr:
        new = super().expression(expr)
        assert isinstance(new, ir.Member)
        if isinstance(new.value, ir.Construct) and isinstance(new.value.type, Struct):
            names = [field.name for field in new.value.type.fields]
            return only_argument(new.value, names.index(expr.field)) or new
        return new


_NEUTRAL = {"*": 1, "/": 1, "+": 0, "-": 0, "<<": 0, ">>": 0, "|": 0, "^": 0}


def _is_neutral(op: str, right: ir.Expr) -> bool:
    """Whether `x op right` is x (given that it has x's type)."""
    neutral = _NEUTRAL.get(op)
    if neutral is None or isinstance(right.type, Matrix):
        return False
    values = constant_numbers(right)
    return values is not None and all(value == neutral for value in values)


def _logic(expr: ir.Binary, x: Numbers | None, y: Numbers | None) -> ir.Expr:
    """`&&`, `||` or `^^`, of which one side may be known."""
    constant, other = (x, expr.right) if x is not None else (y, expr.left)
    if constant is None:
        return expr
    if expr.op == "^^":
        return ir.Unary(BOOL, "!", other, expr.span) if constant[0] else other
    if constant[0] == (expr.op == "&&"):
        return other
    # the right side is not evaluated where the left one decides; a left side with effects is
    return expr if x is None and calls(other) else ir.Literal(BOOL, constant[0], expr.span)
