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
from sssgen.ir.constant_arithmetic import Numbers
from sssgen.ir.constant_expressions import constant_numbers, literal, placed_at, same_number, uniform_value
from sssgen.ir.nodes import (
    Assign,
    Assume,
    Binary,
    Call,
    Construct,
    Declare,
    Expr,
    For,
    Function,
    Global,
    If,
    Index,
    Intrinsic,
    Literal,
    Local,
    Member,
    Module,
    Select,
    Stmt,
    Swizzle,
    Unary,
    Variable,
    While,
)
from sssgen.ir.rules import element_type
from sssgen.ir.transform import Transformer, rewrite
from sssgen.ir.types import BOOL, Matrix, Scalar, Struct, Vector, kind_of
from sssgen.ir.walk import operands
from sssgen.passes.constructed_parts import calls, only_argument, picked
from sssgen.passes.scopes import separate


def fold(module: Module, fixed: Mapping[str, tuple[float, ...]] = {}) -> Module:
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
        if isinstance(substituted, Literal) or constant_numbers(substituted) is not None:
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
        self.fixed: dict[str, Expr] = {}
        self.constants: dict[str, Expr] = {}
        self.spliced = False
        """Whether statements of an inner block have moved into an outer one."""
        self.methods: dict[type, Any] = {
            Binary: self.binary,
            Unary: self.unary,
            Select: self.select,
            Intrinsic: self.intrinsic,
            Construct: self.construct,
            Swizzle: self.swizzle,
            Index: self.index,
            Member: self.member,
        }

    def variable(self, variable: Variable) -> Variable:
        value = self.expression(variable.value) if variable.value is not None else None
        return variable if value is variable.value else variable._replace(value=value)

    # Statements

    def function(self, function: Function) -> Function:
        self.spliced = False
        function = super().function(function)
        return separate(function) if self.spliced else function

    def assign(self, stmt: Assign) -> Stmt | None:
        target, value = self.expression(stmt.target), self.expression(stmt.value)
        if stmt.op and _is_neutral(stmt.op, value) and value.type == target.type and not calls(target):
            return None
        same = target is stmt.target and value is stmt.value
        return stmt if same else Assign(target, stmt.op, value, stmt.span)

    def branch(self, stmt: If) -> Stmt | None:
        condition = self.condition(stmt.condition)
        if isinstance(condition, Literal):
            self.spliced = True
            self.out += self.block(stmt.then if condition.value else stmt.otherwise)
            return None
        then, otherwise = self.inner(stmt.then), self.inner(stmt.otherwise)
        same = condition is stmt.condition and then is stmt.then and otherwise is stmt.otherwise
        return stmt if same else If(condition, then, otherwise, stmt.span)

    def assume(self, stmt: Assume) -> Stmt | None:
        new = super().assume(stmt)
        return None if isinstance(new, Assume) and isinstance(new.condition, Literal) else new

    def while_loop(self, stmt: While) -> Stmt | None:
        condition = self.condition(stmt.condition)
        if isinstance(condition, Literal) and not condition.value:
            return None
        body = self.inner(stmt.body)
        return stmt if condition is stmt.condition and body is stmt.body else While(condition, body, stmt.span)

    def for_loop(self, stmt: For) -> Stmt | None:
        new = super().for_loop(stmt)
        assert isinstance(new, For)
        init, condition = new.init, new.condition
        if condition is None or not isinstance(init, (Declare, Assign)) or not self.never_runs(init, condition):
            return new
        return init if isinstance(init, Assign) else None

    def header(self, stmt: Stmt | None) -> Stmt | None:
        """A statement without effect stays here, as the loop would not be seen to end."""
        return super().header(stmt) or stmt

    def never_runs(self, init: Declare | Assign, condition: Expr) -> bool:
        """Whether a loop's condition is false with the value that `init` sets."""
        if init.value is None or (isinstance(init, Assign) and (init.op or not isinstance(init.target, Local))):
            return False
        start = self.with_constants(init.value)
        if constant_numbers(start) is None:
            return False
        name = init.name if isinstance(init, Declare) else init.target.name  # type: ignore[union-attr]  # a Local

        def change(node: Expr) -> Expr:
            return start if type(node) is Local and node.name == name else node

        first = self.with_constants(self.expression(rewrite(condition, change)))
        return isinstance(first, Literal) and not first.value

    # Conditions

    def with_constants(self, expr: Expr) -> Expr:
        """The expression with the values of module constants substituted and folded."""

        def change(node: Expr) -> Expr:
            return self.constants.get(node.name, node) if type(node) is Global else node

        substituted = rewrite(expr, change)
        return expr if substituted is expr else self.expression(substituted)

    def condition(self, condition: Expr) -> Expr:
        """A condition, as a literal where the module's constants decide it."""
        return self.settled(self.expression(condition))

    def settled(self, condition: Expr) -> Expr:
        if isinstance(condition, Literal) or not self.constants:
            return condition
        substituted = self.with_constants(condition)
        if substituted is condition or isinstance(substituted, Literal):
            return substituted
        if isinstance(condition, Binary) and condition.op in ("&&", "||"):
            left, right = self.settled(condition.left), self.settled(condition.right)
            if left is not condition.left or right is not condition.right:
                return self.simplified(condition._replace(left=left, right=right))
        return condition

    # Expressions

    def expression(self, expr: Expr) -> Expr:
        """The expression, folded."""
        kind = type(expr)
        if kind is Local or kind is Literal:
            return expr
        if kind is Global:
            value = self.fixed.get(expr.name)  # type: ignore[union-attr]  # it is a Global
            return expr if value is None else placed_at(value, expr.span)
        if kind is Call:
            return super().expression(expr)
        folded: Expr = self.methods[kind](expr)
        return folded

    def binary(self, expr: Binary) -> Expr:
        left, right = self.expression(expr.left), self.expression(expr.right)
        if left is not expr.left or right is not expr.right:
            expr = Binary(expr.type, expr.op, left, right, expr.span)
        left_kind, right_kind = type(left), type(right)
        if left_kind is Literal or right_kind is Literal or left_kind is Construct or right_kind is Construct:
            return self.simplified(expr)
        return expr

    def simplified(self, expr: Binary) -> Expr:
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

    def unary(self, expr: Unary) -> Expr:
        operand = self.expression(expr.operand)
        values = constant_numbers(operand)
        if values is not None:
            result = arithmetic.unary(expr.op, values, kind_of(expr.type))
            if result is not None:
                return literal(expr.type, result, expr.span)
        if isinstance(operand, Unary) and operand.op == expr.op:
            return operand.operand
        return expr if operand is expr.operand else Unary(expr.type, expr.op, operand, expr.span)

    def select(self, expr: Select) -> Expr:
        condition = self.condition(expr.condition)
        if isinstance(condition, Literal):
            return self.expression(expr.yes if condition.value else expr.no)
        yes, no = self.expression(expr.yes), self.expression(expr.no)
        if expr.type == BOOL and isinstance(yes, Literal) and isinstance(no, Literal) and yes.value != no.value:
            return condition if yes.value else Unary(BOOL, "!", condition, expr.span)
        if condition is expr.condition and yes is expr.yes and no is expr.no:
            return expr
        return Select(expr.type, condition, yes, no, expr.span)

    def intrinsic(self, expr: Intrinsic) -> Expr:
        new = super().expression(expr)
        args: list[Numbers] = []
        for arg in operands(new):
            if type(arg) is not Literal and type(arg) is not Construct:
                return new
            values = constant_numbers(arg)
            if values is None:
                return new
            args.append(values)
        result = arithmetic.builtin(expr.name, args, [arg.type for arg in expr.args], expr.type)
        return new if result is None else literal(expr.type, result, expr.span)

    def construct(self, expr: Construct) -> Expr:
        new = super().expression(expr)
        assert isinstance(new, Construct)
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
        flat: list[Expr] = []
        for arg in args:
            if isinstance(arg, Construct) and len(arg.args) > 1:
                flat.extend(arg.args)
            else:
                flat.append(arg)
        if len(flat) > len(args):
            new = Construct(type_, tuple(flat), new.span)
        parts = [constant_numbers(arg) or () for arg in flat]
        numbers = tuple([number for part in parts for number in part])
        if () not in parts and all(same_number(number, numbers[0]) for number in numbers):
            return literal(type_, numbers, new.span)
        return new

    def swizzle(self, expr: Swizzle) -> Expr:
        value, letters = self.expression(expr.value), expr.components
        if isinstance(value, Swizzle):
            letters = "".join([value.components["xyzw".index(letter)] for letter in letters])
            value = value.value
        if value.type == expr.type and letters == "xyzw"[: len(letters)]:
            return value
        if isinstance(value, Construct):
            parts = picked(value, ["xyzw".index(letter) for letter in letters], expr.type, expr.span)
            if parts is not None:
                return parts
        if value is expr.value and letters == expr.components:
            return expr
        return Swizzle(expr.type, value, letters, expr.span)

    def index(self, expr: Index) -> Expr:
        new = super().expression(expr)
        assert isinstance(new, Index)
        value, index = new.value, new.index
        if not isinstance(index, Literal):
            return new
        last = (element_type(value.type) or (expr.type, 1))[1] - 1
        if not 0 <= index.value <= last:
            # the value is undefined; targets refuse such an index
            index = index._replace(value=0 if index.value < 0 else last)
            new = Index(expr.type, value, index, expr.span)
        if isinstance(value, Construct):
            place = int(index.value)
            if isinstance(value.type, Vector):
                return picked(value, [place], expr.type, expr.span) or new
            if len(value.args) == last + 1 and all(arg.type == expr.type for arg in value.args):
                return only_argument(value, place) or new
        return new

    def member(self, expr: Member) -> Expr:
        new = super().expression(expr)
        assert isinstance(new, Member)
        if isinstance(new.value, Construct) and isinstance(new.value.type, Struct):
            names = [field.name for field in new.value.type.fields]
            return only_argument(new.value, names.index(expr.field)) or new
        return new


_NEUTRAL = {"*": 1, "/": 1, "+": 0, "-": 0, "<<": 0, ">>": 0, "|": 0, "^": 0}


def _is_neutral(op: str, right: Expr) -> bool:
    """Whether `x op right` is x (given that it has x's type)."""
    neutral = _NEUTRAL.get(op)
    if neutral is None or isinstance(right.type, Matrix):
        return False
    values = constant_numbers(right)
    return values is not None and all(value == neutral for value in values)


def _logic(expr: Binary, x: Numbers | None, y: Numbers | None) -> Expr:
    """`&&`, `||` or `^^`, of which one side may be known."""
    constant, other = (x, expr.right) if x is not None else (y, expr.left)
    if constant is None:
        return expr
    if expr.op == "^^":
        return Unary(BOOL, "!", other, expr.span) if constant[0] else other
    if constant[0] == (expr.op == "&&"):
        return other
    # the right side is not evaluated where the left one decides; a left side with effects is
    return expr if x is None and calls(other) else Literal(BOOL, constant[0], expr.span)
