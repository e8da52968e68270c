"""Rewrites a module until the target can say every node; printing is then a table and a few methods.

Last of the passes that change meaning-bearing structure: the others see one language-neutral form. What a target can
say is its descriptor's `[capabilities]`; which builtins it has is the intrinsic table's. Knows no target by name.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from operator import is_

from sssgen.ir import nodes as ir
from sssgen.ir import signatures
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.transform import rewrite
from sssgen.ir.types import (
    BOOL,
    FLOAT,
    INT,
    UINT,
    Array,
    Matrix,
    Scalar,
    Struct,
    Type,
    Vector,
    components,
    kind_of,
    vector_of,
)
from sssgen.ir.walk import operands, subexpressions, with_operands
from sssgen.passes import uniform_blocks as blocks
from sssgen.passes.capabilities import Capabilities
from sssgen.passes.legal.integer_operators import counts_up, with_result
from sssgen.passes.legal.matrix_columns import by_whole_columns, needs_columns
from sssgen.passes.legal.part_stores import is_dynamic_store, is_swizzle_store, parts_of, whole_store
from sssgen.passes.lift_calls import Calls, awkward, lift
from sssgen.passes.scopes import assigned, declared, outs_of
from sssgen.passes.substitute import inlined, is_cheap
from sssgen.passes.unsupported import Unsupported
from sssgen.passes.variable_effects import effects

Polyfill = Callable[[str, Sequence[Type]], ir.Module]
"""Gives the module whose last function stands in for a builtin with these argument types."""


_EVERYWHERE = frozenset(("+", "-", "*", "<", ">", "<=", ">=", "&&", "||"))
"""The operators that mean the same in every language, but on matrices."""


class _OutOfOrder(Exception):
    """Something would be computed before a call that it stands behind."""


def legalise(module: ir.Module, dialect: str, capabilities: Capabilities, polyfill: Polyfill) -> ir.Module:
    """The module as the target can say it. Raises Unsupported."""
    return _Legaliser(module, dialect, capabilities, polyfill).run()


class _Legaliser:
    def __init__(self, module: ir.Module, dialect: str, capabilities: Capabilities, polyfill: Polyfill) -> None:
        self.module = module
        self.dialect = dialect
        self.language = dialect.partition("-")[0]
        self.capabilities = capabilities
        self.polyfill = polyfill
        self.functions = {function.key: function for function in module.functions}
        self.helpers: dict[str, ir.Function] = {}
        self.uniforms = {uniform.name for uniform in module.uniforms}
        self.counters: list[str] = []
        """The counters of the loops around that are never negative."""
        self.names: set[str] = set()
        """Those of the function at hand, once one is to be chosen."""
        self.at_hand: ir.Function | None = None
        self.prelude: list[ir.Stmt] | None = None
        self.texts: dict[tuple[str, tuple[Type, ...]], str] = {}
        self.shared = effects(module)
        self.calls = Calls(self.functions, self.shared)
        self.outs = outs_of(module.functions)
        self.writing = bool(self.shared or self.outs)
        """Whether any call can write anything."""
        self.ordered: set[int] = set()
        """The statements, by id, before which nothing of theirs may be computed."""

    def run(self) -> ir.Module:
        functions, refused = list[ir.Function](), list[Unsupported]()
        for function in self.module.functions:
            try:
                functions.append(self.function(function))
            except Unsupported as error:
                refused.append(error)
        if refused:
            raise Unsupported(refused[0].message, refused[0].span, refused[1:])
        constants = tuple(constant._replace(value=self.initial(constant.value)) for constant in self.module.constants)
        variables = tuple([self.variable(variable) for variable in self.module.variables])
        functions = [*self.helpers.values(), *functions]
        return self.module._replace(constants=constants, functions=tuple(functions), variables=variables)

    def variable(self, variable: ir.Variable) -> ir.Variable:
        value = self.initial(variable.value) if variable.value is not None else None
        return variable if value is variable.value else variable._replace(value=value)

    def function(self, function: ir.Function) -> ir.Function:
        if isinstance(function.result, Array) and not self.capabilities.array_constructors:
            raise Unsupported(
                "a function cannot return an array for this target: give it an out parameter", function.span
            )
        if not self.writing:
            return self.lifted(function)
        if not self.capabilities.out_parameters:
            return self.lifted(lift(function, self.calls))
        stmts = awkward(function, self.calls)
        if stmts and (not self.capabilities.operand_order or awkward(function, Calls(self.functions))):
            return self.lifted(lift(function, self.calls))
        self.ordered = {id(stmt) for stmt in stmts}
        prelude, counters = self.prelude, list(self.counters)
        try:
            return self.lifted(function)
        except _OutOfOrder:
            self.ordered, self.prelude, self.counters = set(), prelude, counters
            return self.lifted(lift(function, self.calls))

    def lifted(self, function: ir.Function) -> ir.Function:
        """A function whose writing calls stand where they can."""
        self.names, self.at_hand = set(), function
        if not self.capabilities.mutable_parameters:
            function = self.copy_parameters(function)
        body = self.block(function.body or ())
        return function if body is function.body else function._replace(body=body)

    def copy_parameters(self, function: ir.Function) -> ir.Function:
        """Gives each `in` parameter that is assigned a variable of its own name; the parameter is renamed."""
        written = assigned(function, self.outs)
        if written.isdisjoint([param.name for param in function.params]):
            return function
        params, copies = [], []
        for param in function.params:
            if param.direction == "in" and param.name in written:
                given = self.fresh(f"{param.name}_in")
                copies.append(ir.Declare(param.name, param.type, ir.Local(param.type, given, param.span), param.span))
                param = param._replace(name=given)
            params.append(param)
        return function._replace(params=tuple(params), body=(*copies, *(function.body or ())))

    def fresh(self, name: str) -> str:
        """A name that the function does not use yet."""
        assert self.at_hand is not None
        self.names = self.names or set(declared(self.at_hand))
        free, count = name, 2
        while free in self.names:
            free, count = f"{name}_{count}", count + 1
        self.names.add(free)
        return free

    # Statements

    def block(self, block: ir.Block) -> ir.Block:
        result: list[ir.Stmt] = []
        for stmt in block:
            result.extend(self.statement(stmt))
        return block if len(result) == len(block) and all(map(is_, result, block)) else tuple(result)

    def statement(self, stmt: ir.Stmt) -> list[ir.Stmt]:
        """A statement, after what it needs to have computed before."""
        outer, self.prelude = self.prelude, []
        new: ir.Stmt | None = stmt
        if isinstance(stmt, ir.Declare):
            new = self.declare(stmt, stmt.value) if stmt.value is not None else stmt
        elif isinstance(stmt, ir.Assign):
            new = self.assign(stmt)
        elif isinstance(stmt, ir.Return):
            value = self.leaving(stmt.value, stmt.span) if stmt.value is not None else None
            new = stmt if value is stmt.value else ir.Return(value, stmt.span)
        elif isinstance(stmt, ir.Evaluate):
            new = ir.Evaluate(self.expr(stmt.call), stmt.span)
        elif isinstance(stmt, ir.If):
            new = ir.If(self.expr(stmt.condition), self.inner(stmt.then), self.inner(stmt.otherwise), stmt.span)
        elif isinstance(stmt, ir.For | ir.While):
            new = self.loop(stmt)
        result = self.prelude if new is None else [*self.prelude, new]
        if len(result) > 1 and id(stmt) in self.ordered:
            raise _OutOfOrder
        self.prelude = outer
        return result

    def declare(self, declare: ir.Declare, value: ir.Expr) -> ir.Stmt | None:
        place = ir.Local(declare.type, declare.name, declare.span)
        if isinstance(value, ir.Select) and not self.chooses(value):
            value = self.select(value, place)
            if value is place:
                assert self.prelude is not None
                self.prelude.insert(-1, declare._replace(value=None))
                return None
            return declare._replace(value=value)
        begin = self.initial(value)
        return declare if begin is value else ir.Declare(declare.name, declare.type, begin, declare.span)

    def initial(self, value: ir.Expr) -> ir.Expr:
        """What a variable begins with: there the parts of an array or struct can be listed in every language."""
        if type(value) is ir.Construct and isinstance(value.type, (Array, Struct)):
            return value._replace(args=tuple([self.initial(arg) for arg in value.args]))
        return self.expr(value)

    def assign(self, assign: ir.Assign) -> ir.Stmt | None:
        op, span = assign.op, assign.span
        if (
            isinstance(assign.value, ir.Select)
            and isinstance(assign.target, ir.Local)
            and not (op or self.chooses(assign.value))
        ):
            value = self.select(assign.value, assign.target)
            return None if value is assign.target else assign._replace(value=value)
        place, value = self.place(assign.target), self.expr(assign.value)
        if type(place) is not ir.Local and any(map(self.refused, parts_of(place))):
            if op:
                value = self.binary(ir.Binary(place.type, op, place, value, span))
            place, value = whole_store(place, value, self.refused, self.keep_cheap)
            return ir.Assign(place, "", value, span)
        if op:
            result = self.binary(ir.Binary(place.type, op, place, value, span))
            linear = isinstance(value.type, Matrix) and op == "*"
            if linear or not (isinstance(result, ir.Binary) and result.op == op and result.left is place):
                return ir.Assign(place, "", result, span)
            value = result.right
        same = place is assign.target and value is assign.value
        return assign if same else ir.Assign(place, op, value, span)

    def refused(self, part: ir.Expr) -> bool:
        """Whether the target has no store into such a part."""
        return (is_swizzle_store(part) and not self.capabilities.swizzle_store) or (
            is_dynamic_store(part) and not self.capabilities.dynamic_stores
        )

    def leaving(self, value: ir.Expr, span: ir.Span) -> ir.Expr:
        """What a function returns at last; of a choice that needs an if, the first arm leaves before."""
        if not isinstance(value, ir.Select) or not self.branches(value):
            return self.expr(value)
        assert self.prelude is not None
        condition, then = self.expr(value.condition), self.inner((ir.Return(value.yes, value.yes.span),))
        self.prelude.append(ir.If(condition, then, (), span))
        return self.leaving(value.no, span)

    def keep(self, value: ir.Expr, name: str) -> ir.Expr:
        """Computes a value before the statement, into a local."""
        if self.prelude is None:
            raise Unsupported("this cannot be said in a constant or a loop's condition for this target", value.span)
        name = self.fresh(name)
        self.prelude.append(ir.Declare(name, value.type, value, value.span))
        return ir.Local(value.type, name, value.span)

    def keep_cheap(self, value: ir.Expr, name: str) -> ir.Expr:
        return value if is_cheap(value) else self.keep(value, name)

    def loop(self, loop: ir.For | ir.While) -> ir.Stmt:
        """A loop; where its condition needs statements, the body begins with them and leaves by itself."""
        condition, before = self.apart(loop.condition) if loop.condition is not None else (None, [])
        counter = counts_up(loop) if isinstance(loop, ir.For) else ""
        self.counters.append(counter)
        body = self.inner(loop.body)
        self.counters.pop()
        if before and id(loop) in self.ordered:
            raise _OutOfOrder
        if before and condition is not None:
            stop = ir.Unary(BOOL, "!", condition, condition.span)
            body = (*before, ir.If(stop, (ir.Break(loop.span),), (), loop.span), *body)
            condition = ir.Literal(BOOL, True, condition.span)
        if isinstance(loop, ir.While):
            assert condition is not None
            return ir.While(condition, body, loop.span)
        init = self.statement(loop.init) if loop.init is not None else []
        step = self.statement(loop.step) if loop.step is not None else []
        assert self.prelude is not None
        self.prelude.extend(init[:-1])
        if len(step) > 1:
            raise Unsupported("this loop's step cannot be said for this target", loop.span)
        return ir.For(init[-1] if init else None, condition, step[0] if step else None, body, loop.span)

    def inner(self, block: ir.Block) -> ir.Block:
        outer, self.prelude = self.prelude, []
        result = self.block(block)
        self.prelude = outer
        return result

    def apart(self, expr: ir.Expr) -> tuple[ir.Expr, list[ir.Stmt]]:
        """An expression, and what is to be computed before it, not yet said."""
        outer, self.prelude = self.prelude, []
        new = self.expr(expr)
        before, self.prelude = self.prelude, outer
        return new, before

    # Expressions

    def expr(self, expr: ir.Expr) -> ir.Expr:
        kind = type(expr)
        if kind is ir.Local or kind is ir.Literal:
            return expr
        if isinstance(expr, ir.Binary):
            left, right = self.expr(expr.left), self.expr(expr.right)
            same = left is expr.left and right is expr.right
            return self.binary(expr if same else ir.Binary(expr.type, expr.op, left, right, expr.span))
        if kind is ir.Select and not self.chooses(expr):  # type: ignore[arg-type]  # narrowed by its exact class
            return self.select(expr)  # type: ignore[arg-type]  # the same
        if isinstance(expr, ir.Index) and isinstance(expr.value, ir.Global) and expr.value.name in self.uniforms:
            return blocks.element(expr._replace(index=self.expr(expr.index)), self.capabilities)
        old = operands(expr)
        new = tuple([self.expr(operand) for operand in old])
        return self.node(expr if all(map(is_, old, new)) else with_operands(expr, new))

    def place(self, place: ir.Expr) -> ir.Expr:
        """What is assigned to: only its indices are expressions."""
        if isinstance(place, ir.Swizzle | ir.Member):
            return place._replace(value=self.place(place.value))
        if isinstance(place, ir.Index):
            return place._replace(value=self.place(place.value), index=self.expr(place.index))
        return place

    def node(self, expr: ir.Expr) -> ir.Expr:
        """One node, no operator of two, whose operands are legal already."""
        if isinstance(expr, ir.Intrinsic):
            return self.intrinsic(expr)
        if isinstance(expr, ir.Construct):
            return self.construct(expr)
        if (
            isinstance(expr, ir.Unary)
            and expr.op == "-"
            and kind_of(expr.type) == "uint"
            and not self.capabilities.uint_minus
        ):
            zero = _widened(ir.Literal(UINT, 0, expr.span), components(expr.type))
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
        return expr

    def intrinsic(self, call: ir.Intrinsic) -> ir.Expr:
        types = [arg.type for arg in call.args]
        text = self.text(call.name, tuple(types))
        row = BUILTINS[call.name]
        if text.startswith("op:"):
            if len(call.args) == 1:
                return ir.Unary(call.type, text[3:], call.args[0], call.span)
            return ir.Binary(call.type, text[3:], call.args[0], call.args[1], call.span)
        if text == "":
            try:
                module = self.polyfill(call.name, types)
            except KeyError:
                raise Unsupported(f"this target has no {call.name}", call.span) from None
            return self.call_polyfill(call, module)
        if self.language in row.splat and isinstance(call.type, Vector):
            args = tuple(
                ir.Construct(Vector(kind_of(arg.type), call.type.size), (arg,), arg.span)
                if isinstance(arg.type, Scalar) and kind_of(arg.type) == call.type.kind
                else arg
                for arg in call.args
            )
            return call._replace(args=args)
        return call

    def text(self, name: str, types: tuple[Type, ...]) -> str:
        """How the target writes a builtin of these types."""
        known = self.texts.get((name, types))
        if known is None:
            known = self.texts[name, types] = signatures.text(name, self.dialect, types)
        return known

    def call_polyfill(self, call: ir.Intrinsic, module: ir.Module) -> ir.Expr:
        """The polyfill's expression itself where it is short and its arguments are cheap, else a call of it."""
        function = module.functions[-1]
        placed = inlined(module, call.args, call.span)
        if placed is not None:
            return self.expr(placed)
        for helper in module.functions:
            if helper.key not in self.helpers:
                self.functions[helper.key] = helper
                self.outs |= outs_of([helper])
                self.writing = bool(self.shared or self.outs)
                around = self.names, self.at_hand, self.prelude, self.ordered
                self.helpers[helper.key] = helper  # before its own body: it may be asked for again there
                legal = self.function(helper)
                del self.helpers[helper.key]
                self.helpers[helper.key] = legal
                self.names, self.at_hand, self.prelude, self.ordered = around
        return ir.Call(call.type, function.key, call.args, call.span)

    def construct(self, construct: ir.Construct) -> ir.Expr:
        type_, args, span = construct.type, construct.args, construct.span
        if isinstance(type_, Matrix) and len(args) == 1 and not self.capabilities.matrix_conversions:
            return self.matrix_from(type_, args[0], span)
        if isinstance(type_, Matrix) and needs_columns(type_, args) and not self.capabilities.mixed_columns:
            kept = [arg if is_cheap(arg) or isinstance(arg.type, Scalar) else self.keep(arg, "part") for arg in args]
            return by_whole_columns(type_, kept, span)
        if isinstance(type_, Struct) and not self.capabilities.struct_constructors:
            return self.keep(construct, type_.name[0].lower() + type_.name[1:])
        if isinstance(type_, Array) and not self.capabilities.array_constructors:
            return self.keep(construct, "values")
        return construct

    def matrix_from(self, type_: Matrix, value: ir.Expr, span: ir.Span) -> ir.Expr:
        """A matrix from a scalar (its diagonal) or from another matrix, written out by columns."""
        zero, one = ir.Literal(FLOAT, 0.0, span), ir.Literal(FLOAT, 1.0, span)
        if isinstance(value.type, Scalar):
            if not is_cheap(value):
                value = self.keep(value, "diagonal")
            cells = [value if row == column else zero for column in range(type_.size) for row in range(type_.size)]
            return ir.Construct(type_, tuple(cells), span)
        if not is_cheap(value):
            value = self.keep(value, "matrix")
        assert isinstance(value.type, Matrix)
        old, new = value.type.size, type_.size
        columns: list[ir.Expr] = []
        for column in range(new):
            index = ir.Index(Vector("float", old), value, ir.Literal(INT, column, span), span)
            unit = tuple(one if row == column else zero for row in range(old, new))
            if column >= old:
                columns.append(ir.Construct(Vector("float", new), tuple([zero] * old) + unit, span))
            elif new < old:
                columns.append(ir.Swizzle(Vector("float", new), index, "xyzw"[:new], span))
            else:
                columns.append(ir.Construct(Vector("float", new), (index, *unit), span) if unit else index)
        return ir.Construct(type_, tuple(columns), span)

    def binary(self, binary: ir.Binary) -> ir.Expr:
        left, right, op, span = binary.left, binary.right, binary.op, binary.span
        if op in _EVERYWHERE and type(left.type) is not Matrix and type(right.type) is not Matrix:
            return binary
        if op == "^^":
            return ir.Binary(BOOL, "!=", left, right, span)
        if op in ("==", "!=") and binary.type == BOOL and not isinstance(left.type, Scalar):
            return self.equality(binary) if not self.capabilities.whole_equality else binary
        whole = op in ("/", "%", "<<", ">>") and kind_of(left.type) != "float"
        if whole and not self.capabilities.integer_division and self.prelude is not None:
            return self.integer(binary)
        if op in ("<<", ">>", "&", "|", "^") and not self.capabilities.mixed_bits:
            size = max(components(left.type), components(right.type))
            right = _amount(right, size) if op in ("<<", ">>") else _widened(right, size)
            return binary._replace(left=_widened(left, size), right=right)
        if not self.capabilities.matrix_scalar_arithmetic:
            if isinstance(left.type, Matrix) and isinstance(right.type, Scalar) and op == "/":
                inverse = ir.Binary(FLOAT, "/", ir.Literal(FLOAT, 1.0, span), right, span)
                return ir.Binary(left.type, "*", left, inverse, span)
            if isinstance(binary.type, Matrix) and op in "+-/" and (left.type != right.type or op == "/"):
                return self.by_columns(binary)
        return binary

    def integer(self, binary: ir.Binary) -> ir.Expr:
        """An integer division, remainder or shift; `equal` in it is to be said in the language's way."""
        result = with_result(binary, self.keep_cheap, self.counters)
        return rewrite(result, lambda part: self.intrinsic(part) if isinstance(part, ir.Intrinsic) else part)

    def by_columns(self, binary: ir.Binary) -> ir.Expr:
        """Componentwise matrix arithmetic, column by column."""
        assert isinstance(binary.type, Matrix)
        column = Vector("float", binary.type.size)
        sides = [side if is_cheap(side) else self.keep(side, "matrix") for side in (binary.left, binary.right)]

        def part(side: ir.Expr, index: int) -> ir.Expr:
            place = ir.Literal(INT, index, side.span)
            return ir.Index(column, side, place, side.span) if isinstance(side.type, Matrix) else side

        columns = tuple(
            ir.Binary(column, binary.op, part(sides[0], index), part(sides[1], index), binary.span)
            for index in range(binary.type.size)
        )
        return ir.Construct(binary.type, columns, binary.span)

    def equality(self, binary: ir.Binary) -> ir.Expr:
        """`a == b` on vectors, matrices, arrays and structs as one bool."""
        left, right, span = binary.left, binary.right, binary.span
        type_ = left.type
        if isinstance(type_, Vector):
            parts = ir.Binary(Vector("bool", type_.size), binary.op, left, right, span)
            return ir.Intrinsic(BOOL, "all" if binary.op == "==" else "any", (parts,), span)
        left, right = (side if is_cheap(side) else self.keep(side, "compared") for side in (left, right))
        pairs: list[tuple[ir.Expr, ir.Expr]]
        if isinstance(type_, Struct):
            pairs = [
                (ir.Member(field.type, left, field.name, span), ir.Member(field.type, right, field.name, span))
                for field in type_.fields
            ]
        elif isinstance(type_, Matrix | Array):
            inner = Vector("float", type_.size) if isinstance(type_, Matrix) else type_.element
            count = type_.size if isinstance(type_, Matrix) else type_.length
            places = [ir.Literal(INT, index, span) for index in range(count)]
            pairs = [(ir.Index(inner, left, place, span), ir.Index(inner, right, place, span)) for place in places]
        else:
            return binary
        result: ir.Expr | None = None
        for one, other in pairs:
            equal = self.binary(ir.Binary(BOOL, binary.op, one, other, span))
            joined = "&&" if binary.op == "==" else "||"
            result = equal if result is None else ir.Binary(BOOL, joined, result, equal, span)
        assert result is not None
        return result

    def select(self, select: ir.Select, place: ir.Local | None = None) -> ir.Expr:
        """A choice for a target whose own evaluates both arms: fine for plain values; else the arms go into an if.

        Then it is `place` that gets the value and is returned, or a new variable.
        """
        span = select.span
        condition = self.expr(select.condition)
        if self.prelude is None:
            return ir.Select(select.type, condition, self.expr(select.yes), self.expr(select.no), span)
        arms = (select.yes, select.no)
        if not self.branches(select):
            (yes, before_yes), (no, before_no) = self.apart(select.yes), self.apart(select.no)
            if not before_yes and not before_no:
                return ir.Select(select.type, condition, yes, no, span)
        if place is None:
            place = ir.Local(select.type, self.fresh("chosen"), span)
            self.prelude.append(ir.Declare(place.name, select.type, None, span))
        then, otherwise = (self.inner((ir.Assign(place, "", arm, arm.span),)) for arm in arms)
        self.prelude.append(ir.If(condition, then, otherwise, span))
        return place

    def chooses(self, select: ir.Select) -> bool:
        """Whether the target has an expression for this choice."""
        whole = isinstance(select.type, Struct | Array)
        return self.capabilities.ternary and (not whole or self.capabilities.struct_choices)

    def branches(self, select: ir.Select) -> bool:
        """Whether a choice is for an if: its arms are not plain values, or one of them calls or samples."""
        if self.chooses(select) or self.prelude is None:
            return False
        plain = isinstance(select.type, Scalar | Vector)
        return not plain or any(_is_costly(part) for arm in (select.yes, select.no) for part in subexpressions(arm))


def _amount(amount: ir.Expr, size: int) -> ir.Expr:
    """By how much is shifted, as a uint or a vector of them."""
    if isinstance(amount, ir.Literal):
        amount = ir.Literal(UINT, amount.value, amount.span)
    elif kind_of(amount.type) == "int":
        amount = ir.Construct(vector_of("uint", components(amount.type)), (amount,), amount.span)
    return _widened(amount, size)


def _widened(value: ir.Expr, size: int) -> ir.Expr:
    """A scalar as a vector of this size, if that is more than one."""
    if components(value.type) == size:
        return value
    return ir.Construct(Vector(kind_of(value.type), size), (value,), value.span)


def _is_costly(expr: ir.Expr) -> bool:
    return isinstance(expr, ir.Call) or (isinstance(expr, ir.Intrinsic) and BUILTINS[expr.name].kind == "fetch")
