"""Computes what is constant: parameters that a material fixes, literals' arithmetic, branches whose condition
is known.

Why: a fixed parameter costs nothing at run time and leaves no uniform; every target gets the same numbers;
and WGSL computes constants itself, but refuses a module in which one is inf or NaN: such an expression is
left as it is written.
Place: first after `link`, as dead branches and unused uniforms are then `prune`'s to find.

Identities are only those that hold for every float: `x * 1.0`, `x + 0.0` (but for the sign of a zero), never
`x * 0.0`. Module constants keep their names, for the reader, unless knowing them decides a condition.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import copysign
from typing import Any

from sssgen.ir.nodes import (
    Assign,
    Assume,
    Binary,
    Block,
    Call,
    Construct,
    Declare,
    Evaluate,
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
    Return,
    Select,
    Span,
    Stmt,
    Swizzle,
    Unary,
    Variable,
    While,
)
from sssgen.ir.rules import element_type
from sssgen.ir.transform import rewrite
from sssgen.ir.types import BOOL, Array, Matrix, Scalar, Struct, Type, Vector, components, kind_of, vector_of
from sssgen.ir.walk import operands, subexpressions, with_operands
from sssgen.passes import constant_arithmetic as arithmetic
from sssgen.passes.constant_arithmetic import Number, Numbers
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
        known = folder.known(value)
        if isinstance(known, Literal) or constant_numbers(known) is not None:
            folder.constants[constant.name] = known
    functions = tuple([folder.function(function) for function in module.functions])
    uniforms = module.uniforms
    if folder.fixed:
        uniforms = tuple([uniform for uniform in uniforms if uniform.name not in folder.fixed])
    variables = tuple([folder.variable(variable) for variable in module.variables])
    return Module(module.structs, tuple(constants), uniforms, functions, variables)


def uniform_value(type: Type, numbers: tuple[float, ...], span: Span) -> Expr:
    """A uniform's components as an expression; a matrix's stand column after column."""
    if components(type) != len(numbers) or not numbers:
        raise ValueError(f"{len(numbers)} components for {components(type)}")
    if isinstance(type, Array):
        size = components(type.element)
        parts = [numbers[start : start + size] for start in range(0, len(numbers), size)]
        return Construct(type, tuple([uniform_value(type.element, part, span) for part in parts]), span)
    kind = kind_of(type)
    values = tuple([{"float": float, "bool": bool}.get(kind, int)(number) for number in numbers])
    if isinstance(type, Matrix):
        return Construct(type, tuple([Literal(Scalar(kind), value, span) for value in values]), span)
    return _literal(type, values, span)


def _literal(type: Type, values: Numbers, span: Span) -> Expr:
    """Scalars or a vector as literals; `vec3(1.0)` where all are the same."""
    if isinstance(type, Scalar):
        return Literal(type, values[0], span)
    one = Scalar(kind_of(type))
    if all(_same(value, values[0]) for value in values):
        values = values[:1]
    return Construct(type, tuple([Literal(one, value, span) for value in values]), span)


def _same(one: Number, other: Number) -> bool:
    return one == other and copysign(1.0, one) == copysign(1.0, other)


def constant_numbers(expr: Expr) -> Numbers | None:
    """The components of a literal or of a vector of literals, floats as float32; else None."""
    if isinstance(expr, Literal):
        value = expr.value
        if type(value) is float:
            single = arithmetic.float32(value)
            return None if single is None else (single,)
        return (value,)
    if isinstance(expr, Construct) and isinstance(expr.type, Vector):
        values: Numbers = ()
        for arg in expr.args:
            part = constant_numbers(arg) if isinstance(arg, Literal) else None
            if part is None:
                return None
            values += part
        return values if len(values) == expr.type.size else values * expr.type.size
    return None


def _calls(expr: Expr) -> bool:
    """Whether an expression calls a function, which may do more than give its value."""
    return any(type(node) is Call for node in subexpressions(expr))


class _Folder:
    """Folds expressions and statements, from the leaves up."""

    def __init__(self) -> None:
        self.fixed: dict[str, Expr] = {}
        self.constants: dict[str, Expr] = {}
        self.spliced = False
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
        if function.body is None:
            return function
        self.spliced = False
        body = self.block(function.body)
        if body is function.body:
            return function
        function = function._replace(body=body)
        return separate(function) if self.spliced else function

    def block(self, block: Block) -> Block:
        new: list[Stmt] = []
        for stmt in block:
            self.statement(stmt, new)
        same = len(new) == len(block) and all(one is other for one, other in zip(new, block, strict=True))
        return block if same else tuple(new)

    def statement(self, stmt: Stmt, out: list[Stmt]) -> None:
        """Adds what a statement becomes to `out`."""
        if isinstance(stmt, Declare):
            if stmt.value is not None:
                value = self.expression(stmt.value)
                stmt = stmt if value is stmt.value else Declare(stmt.name, stmt.type, value, stmt.span)
        elif isinstance(stmt, Assign):
            target, value = self.expression(stmt.target), self.expression(stmt.value)
            if stmt.op and _is_neutral(stmt.op, value) and value.type == target.type and not _calls(target):
                return
            if target is not stmt.target or value is not stmt.value:
                stmt = Assign(target, stmt.op, value, stmt.span)
        elif isinstance(stmt, If):
            condition = self.condition(stmt.condition)
            if isinstance(condition, Literal):
                self.spliced = True
                out.extend(self.block(stmt.then if condition.value else stmt.otherwise))
                return
            then, otherwise = self.block(stmt.then), self.block(stmt.otherwise)
            if condition is not stmt.condition or then is not stmt.then or otherwise is not stmt.otherwise:
                stmt = If(condition, then, otherwise, stmt.span)
        elif isinstance(stmt, Return):
            if stmt.value is not None:
                value = self.expression(stmt.value)
                stmt = stmt if value is stmt.value else Return(value, stmt.span)
        elif isinstance(stmt, Evaluate):
            call = self.expression(stmt.call)
            stmt = stmt if call is stmt.call else Evaluate(call, stmt.span)
        elif isinstance(stmt, Assume):
            condition = self.expression(stmt.condition)
            if isinstance(condition, Literal):
                return
            stmt = stmt if condition is stmt.condition else Assume(condition, stmt.span)
        elif isinstance(stmt, For):
            self.loop(stmt, out)
            return
        elif isinstance(stmt, While):
            condition = self.condition(stmt.condition)
            if isinstance(condition, Literal) and not condition.value:
                return
            body = self.block(stmt.body)
            if condition is not stmt.condition or body is not stmt.body:
                stmt = While(condition, body, stmt.span)
        out.append(stmt)

    def loop(self, stmt: For, out: list[Stmt]) -> None:
        init, step = self.header(stmt.init), self.header(stmt.step)
        condition = self.expression(stmt.condition) if stmt.condition is not None else None
        if condition is not None and isinstance(init, (Declare, Assign)) and self.never_runs(init, condition):
            if isinstance(init, Assign):
                out.append(init)
            return
        body = self.block(stmt.body)
        new = For(init, condition, step, body, stmt.span)
        out.append(stmt if all(one is other for one, other in zip(new, stmt, strict=True)) else new)

    def header(self, stmt: Stmt | None) -> Stmt | None:
        """A loop's init or step; one that does nothing stays, as the loop would not be seen to end."""
        out: list[Stmt] = []
        if stmt is not None:
            self.statement(stmt, out)
        return out[0] if out else stmt

    def never_runs(self, init: Declare | Assign, condition: Expr) -> bool:
        """Whether a loop's condition is false with what `init` sets."""
        if init.value is None or (isinstance(init, Assign) and (init.op or not isinstance(init.target, Local))):
            return False
        start = self.known(init.value)
        if constant_numbers(start) is None:
            return False
        name = init.name if isinstance(init, Declare) else init.target.name  # type: ignore[union-attr]  # a Local

        def change(node: Expr) -> Expr:
            return start if type(node) is Local and node.name == name else node

        first = self.known(self.expression(rewrite(condition, change)))
        return isinstance(first, Literal) and not first.value

    # Conditions

    def known(self, expr: Expr) -> Expr:
        """The expression with module constants put in and folded."""

        def change(node: Expr) -> Expr:
            return self.constants.get(node.name, node) if type(node) is Global else node

        put_in = rewrite(expr, change)
        return expr if put_in is expr else self.expression(put_in)

    def condition(self, condition: Expr) -> Expr:
        """A condition, as a literal where the module's constants decide it."""
        return self.settled(self.expression(condition))

    def settled(self, condition: Expr) -> Expr:
        if isinstance(condition, Literal) or not self.constants:
            return condition
        known = self.known(condition)
        if known is condition or isinstance(known, Literal):
            return known
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
            return expr if value is None else _at(value, expr.span)
        if kind is Call:
            return self.inside(expr)
        folded: Expr = self.methods[kind](expr)
        return folded

    def inside(self, expr: Expr) -> Expr:
        """The expression with its operands folded."""
        old = operands(expr)
        new = tuple([self.expression(operand) for operand in old])
        same = all(one is other for one, other in zip(old, new, strict=True))
        return expr if same else with_operands(expr, new)

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
            return _literal(expr.type, values, expr.span) if values is not None else expr
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
                return _literal(expr.type, result, expr.span)
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
        new = self.inside(expr)
        args: list[Numbers] = []
        for arg in operands(new):
            if type(arg) is not Literal and type(arg) is not Construct:
                return new
            values = constant_numbers(arg)
            if values is None:
                return new
            args.append(values)
        result = arithmetic.builtin(expr.name, args, [arg.type for arg in expr.args], expr.type)
        return new if result is None else _literal(expr.type, result, expr.span)

    def construct(self, expr: Construct) -> Expr:
        new = self.inside(expr)
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
                return _literal(type_, tuple([value for value in converted if value is not None]), new.span)
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
        if () not in parts and all(_same(number, numbers[0]) for number in numbers):
            return _literal(type_, numbers, new.span)
        return new

    def swizzle(self, expr: Swizzle) -> Expr:
        value, letters = self.expression(expr.value), expr.components
        if isinstance(value, Swizzle):
            letters = "".join([value.components["xyzw".index(letter)] for letter in letters])
            value = value.value
        if value.type == expr.type and letters == "xyzw"[: len(letters)]:
            return value
        if isinstance(value, Construct):
            picked = _picked(value, ["xyzw".index(letter) for letter in letters], expr.type, expr.span)
            if picked is not None:
                return picked
        if value is expr.value and letters == expr.components:
            return expr
        return Swizzle(expr.type, value, letters, expr.span)

    def index(self, expr: Index) -> Expr:
        new = self.inside(expr)
        assert isinstance(new, Index)
        value, index = new.value, new.index
        if not isinstance(index, Literal):
            return new
        last = (element_type(value.type) or (expr.type, 1))[1] - 1
        if not 0 <= index.value <= last:
            # nothing says what is there; targets refuse it if they see it
            index = index._replace(value=0 if index.value < 0 else last)
            new = Index(expr.type, value, index, expr.span)
        if isinstance(value, Construct):
            place = int(index.value)
            if isinstance(value.type, Vector):
                return _picked(value, [place], expr.type, expr.span) or new
            if len(value.args) == last + 1 and all(arg.type == expr.type for arg in value.args):
                return _one_of(value, place) or new
        return new

    def member(self, expr: Member) -> Expr:
        new = self.inside(expr)
        assert isinstance(new, Member)
        if isinstance(new.value, Construct) and isinstance(new.value.type, Struct):
            names = [field.name for field in new.value.type.fields]
            return _one_of(new.value, names.index(expr.field)) or new
        return new


def _at(value: Expr, span: Span) -> Expr:
    """A constant, standing at `span`."""
    if isinstance(value, Literal):
        return Literal(value.type, value.value, span)
    assert isinstance(value, Construct)
    return Construct(value.type, tuple([_at(arg, span) for arg in value.args]), span)


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
    known, other = (x, expr.right) if x is not None else (y, expr.left)
    if known is None:
        return expr
    if expr.op == "^^":
        return Unary(BOOL, "!", other, expr.span) if known[0] else other
    if known[0] == (expr.op == "&&"):
        return other
    # the right side is not evaluated where the left one decides; a left side with effects is
    return expr if x is None and _calls(other) else Literal(BOOL, known[0], expr.span)


def _one_of(value: Construct, index: int) -> Expr | None:
    """One argument of a construct, if the others can be dropped."""
    dropped = any(_calls(arg) for position, arg in enumerate(value.args) if position != index)
    return None if dropped else value.args[index]


def _picked(value: Construct, indices: list[int], type: Type, span: Span) -> Expr | None:
    """Components of an assembled vector, without assembling it; None where that is not simpler."""
    constant = constant_numbers(value)
    if constant is not None:
        return _literal(type, tuple([constant[index] for index in indices]), span)
    if len(value.args) == 1 and isinstance(value.args[0].type, Scalar):
        return value.args[0] if len(indices) == 1 else Construct(type, value.args, span)
    if len(value.args) == 1:
        return None
    places = [(number, part) for number, arg in enumerate(value.args) for part in range(components(arg.type))]
    groups: list[tuple[int, list[int]]] = []
    for index in indices:
        number, part = places[index]
        if groups and groups[-1][0] == number and isinstance(value.args[number].type, Vector):
            groups[-1][1].append(part)
        else:
            groups.append((number, [part]))
    used = [number for number, _ in groups]
    for number, arg in enumerate(value.args):
        twice = used.count(number) > 1 and not isinstance(arg, Local | Global | Literal)
        if twice or (number not in used and _calls(arg)):
            return None
    pieces = [_piece(value.args[number], parts, span) for number, parts in groups]
    return pieces[0] if len(pieces) == 1 else Construct(type, tuple(pieces), span)


def _piece(arg: Expr, parts: list[int], span: Span) -> Expr:
    """Some components of a vector, or a scalar as it is."""
    if not isinstance(arg.type, Vector) or parts == list(range(arg.type.size)):
        return arg
    value, letters = (arg.value, arg.components) if isinstance(arg, Swizzle) else (arg, "xyzw")
    type_ = vector_of(kind_of(arg.type), len(parts))
    return Swizzle(type_, value, "".join([letters[part] for part in parts]), span)
