"""Rewrites a module until the target can express every node; printing is then a table and a few methods.

Last of the passes that change structure: the others see one language-neutral form. What a target can express is its
descriptor's `[capabilities]`; which builtins it has is the intrinsic table's. Knows no target by its name.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from sssgen.ir import nodes as ir
from sssgen.ir import signatures
from sssgen.ir.constant_evaluation import combined
from sssgen.ir.constant_expressions import literal
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.loops import at_every_end
from sssgen.ir.transform import Transformer, rewrite
from sssgen.ir.types import BOOL, FLOAT, UINT, Array, Matrix, Sampler, Scalar, Struct, Type, Vector, components, kind_of
from sssgen.ir.walk import calls_of, subexpressions
from sssgen.passes import uniform_blocks as blocks
from sssgen.passes.capabilities import Capabilities
from sssgen.passes.legal.array_results import by_out_parameter, filling
from sssgen.passes.legal.constant_calls import ConstantCalls, as_literals
from sssgen.passes.legal.integer_operators import counts_up, with_result
from sssgen.passes.legal.legal_operators import is_integer_division, legal_operator, widened
from sssgen.passes.legal.matrix_columns import by_whole_columns, matrix_from, needs_columns
from sssgen.passes.legal.part_stores import is_dynamic_store, is_swizzle_store, parts_of, whole_store
from sssgen.passes.legal.wide_constants import ConstantIntegers, chooses_nested, is_wider
from sssgen.passes.lift_calls import Calls, awkward, lift, reads_too_late
from sssgen.passes.scopes import assigned, declared, fresh, outs_of
from sssgen.passes.substitute import inlined, is_cheap, returned
from sssgen.passes.unsupported import MissingBuiltin, Unsupported
from sssgen.passes.variable_effects import effects

Polyfill = Callable[[str, Sequence[Type]], ir.Module]
"""Gives the module whose last function implements a builtin for these argument types."""


class _OutOfOrder(Exception):
    """A value would be computed before a call that precedes it in the source."""


_JUMPS = (ir.Return, ir.Break, ir.Continue)  # in WGSL a discarded invocation goes on
_NOT_CONSTANT = "this cannot be expressed in a constant for this target"


def legalise(module: ir.Module, dialect: str, capabilities: Capabilities, polyfill: Polyfill) -> ir.Module:
    """The module as the target can express it. Raises Unsupported."""
    return _Legaliser(module, dialect, capabilities, polyfill).run()


class _Legaliser(Transformer):
    """Rewrites functions: values that must be computed before a statement are appended to `out` before it."""

    def __init__(self, module: ir.Module, dialect: str, capabilities: Capabilities, polyfill: Polyfill) -> None:
        super().__init__()
        self.module = module
        self.dialect = dialect
        self.language = dialect.partition("-")[0]
        self.capabilities = capabilities
        self.polyfill = polyfill
        self.functions = {function.key: function for function in module.functions}
        self.helpers: dict[str, ir.Function] = {}
        self.uniforms = {uniform.name for uniform in module.uniforms}
        self.counters: list[str] = []
        """The counters of the enclosing loops that are never negative; '' for a loop without one."""
        self.names: set[str] = set()
        """All names of the current function, once a new one is chosen."""
        self.current: ir.Function | None = None
        """None in the value of a constant or variable, before which nothing can be computed."""
        self.texts: dict[tuple[str, tuple[Type, ...]], str] = {}
        self.shared = effects(module)
        self.calls = Calls(self.functions, self.shared)
        self.outs = outs_of(module.functions)
        self.writing = bool(self.shared or self.outs)
        """Whether any call can write anything."""
        self.constant_calls: ConstantCalls | None = None
        """Once it is needed."""
        self.integers = None if capabilities.wrapping_constants else ConstantIntegers()
        self.ordered: set[int] = set()
        """The ids of the statements of which no part may be computed before them."""

    def run(self) -> ir.Module:
        constants = tuple([self.constant(constant) for constant in self.module.constants])
        functions, errors = list[ir.Function](), list[Unsupported]()
        for function in self.module.functions:
            try:
                functions.append(self.function(function))
            except Unsupported as error:
                errors.append(error)
        if errors:
            raise Unsupported(errors[0].message, errors[0].span, errors[1:])
        self.current = None
        variables = tuple([self.variable(variable) for variable in self.module.variables])
        functions = [*self.helpers.values(), *functions]
        return self.module._replace(constants=constants, functions=tuple(functions), variables=variables)

    def constant(self, constant: ir.Constant) -> ir.Constant:
        value = self.known_initially(constant.value)
        numbers = self.integers.value(value) if self.integers is not None else None
        if self.integers is not None and numbers is not None:
            self.integers.constants[constant.name] = numbers
        return constant if value is constant.value else constant._replace(value=value)

    def variable(self, variable: ir.Variable) -> ir.Variable:
        value = self.known_initially(variable.value) if variable.value is not None else None
        return variable if value is variable.value else variable._replace(value=value)

    def known_initially(self, value: ir.Expr) -> ir.Expr:
        """The value of a declaration at file scope; its numbers where the target cannot compute it there."""
        try:
            return self.initial(value)
        except Unsupported:
            numbers = self.number_of(value)
            if numbers is None:
                raise
            return self.initial(numbers)

    def number_of(self, value: ir.Expr) -> ir.Expr | None:
        """The value of an expression of constants as literals; None where it is not constant."""
        if self.constant_calls is None:
            self.constant_calls = ConstantCalls(self.module, self.polyfill)
        numbers = self.constant_calls.value(value)
        return None if numbers is None else as_literals(value.type, numbers, value.span)

    def function(self, function: ir.Function) -> ir.Function:
        new = self.in_order(function)
        fills = isinstance(new.result, Array) and not self.capabilities.array_constructors
        return by_out_parameter(new) if fills else new

    def in_order(self, function: ir.Function) -> ir.Function:
        """A function whose writing calls are executed in their order."""
        if not self.writing or not self.calls.changing(function):
            return self.lifted(function)
        if not self.capabilities.out_parameters:
            return self.lifted(lift(function, self.calls))
        stmts = awkward(function, self.calls)
        lifts = stmts and (
            not self.capabilities.operand_order
            or awkward(function, Calls(self.functions))
            or reads_too_late(function, self.calls)
        )
        if lifts or self.writes_parts(function):
            return self.lifted(lift(function, self.calls))
        self.ordered = {id(stmt) for stmt in stmts}
        out, counters = self.out, list(self.counters)
        try:
            return self.lifted(function)
        except _OutOfOrder:
            self.ordered, self.out, self.counters = set(), out, counters
            return self.lifted(lift(function, self.calls))

    def writes_parts(self, function: ir.Function) -> bool:
        """Whether a call writes a part of a variable into which the target has no store."""
        return any(
            self.refused(part)
            for call in calls_of(function.body or ())
            for index in self.outs.get(call.function, ())
            for part in parts_of(call.args[index])
        )

    def lifted(self, function: ir.Function) -> ir.Function:
        """A function whose writing calls are where the target can have them."""
        self.names, self.current = set(), function
        if not self.capabilities.mutable_parameters:
            function = self.copy_parameters(function)
        return super().function(function)

    def copy_parameters(self, function: ir.Function) -> ir.Function:
        """Gives each `in` parameter that is assigned a variable of its own name; the parameter is renamed."""
        written = assigned(function, self.outs)
        if written.isdisjoint([param.name for param in function.params]):
            return function
        params, copies = [], []
        for param in function.params:
            if param.direction == "in" and param.name in written:
                name = self.new_name(f"{param.name}_in")
                copies.append(ir.Declare(param.name, param.type, ir.Local(param.type, name, param.span), param.span))
                param = param._replace(name=name)
            params.append(param)
        return function._replace(params=tuple(params), body=(*copies, *(function.body or ())))

    def new_name(self, name: str) -> str:
        """A name that the function does not use yet."""
        assert self.current is not None
        self.names = self.names or set(declared(self.current))
        name = fresh(name, self.names)
        self.names.add(name)
        return name

    # Statements

    def block(self, block: ir.Block) -> ir.Block:
        if not self.capabilities.unreachable_statements:
            last = next((index for index, stmt in enumerate(block) if isinstance(stmt, _JUMPS)), len(block))
            block = block if last + 1 >= len(block) else block[: last + 1]
        return super().block(block)

    def statement(self, stmt: ir.Stmt) -> ir.Stmt | None:
        start = len(self.out)
        new = super().statement(stmt)
        if id(stmt) in self.ordered and len(self.out) - start + (new is not None) > 1:
            raise _OutOfOrder
        return new

    def declare(self, stmt: ir.Declare) -> ir.Stmt | None:
        value = stmt.value
        if value is None:
            return stmt
        place = ir.Local(stmt.type, stmt.name, stmt.span)
        if isinstance(value, ir.Select) and not self.chooses(value):
            value = self.select(value, place)
            if value is place:
                self.out.insert(-1, stmt._replace(value=None))
                return None
            return stmt._replace(value=value)
        begin = self.initial(value)
        return stmt if begin is value else ir.Declare(stmt.name, stmt.type, begin, stmt.span)

    def initial(self, value: ir.Expr) -> ir.Expr:
        """An initial value: there every language can list the parts of an array or struct."""
        if type(value) is ir.Construct and isinstance(value.type, (Array, Struct)):
            return value._replace(args=tuple([self.initial(arg) for arg in value.args]))
        return self.expression(value)

    def assign(self, stmt: ir.Assign) -> ir.Stmt | None:
        op, span = stmt.op, stmt.span
        if (
            isinstance(stmt.value, ir.Select)
            and isinstance(stmt.target, ir.Local)
            and not (op or self.chooses(stmt.value))
        ):
            value = self.select(stmt.value, stmt.target)
            return None if value is stmt.target else stmt._replace(value=value)
        place, value = self.place(stmt.target), self.expression(stmt.value)
        if type(place) is not ir.Local and any(map(self.refused, parts_of(place))):
            if op:
                value = self.binary(ir.Binary(place.type, op, place, value, span))
            place, value = whole_store(place, value, self.refused, self.keep_expensive)
            return ir.Assign(place, "", value, span)
        if op:
            result = self.binary(ir.Binary(place.type, op, place, value, span))
            linear = isinstance(value.type, Matrix) and op == "*"
            if linear or not (isinstance(result, ir.Binary) and result.op == op and result.left is place):
                return ir.Assign(place, "", result, span)
            value = result.right
        same = place is stmt.target and value is stmt.value
        return stmt if same else ir.Assign(place, op, value, span)

    def refused(self, part: ir.Expr) -> bool:
        """Whether the target has no store into such a part."""
        return (is_swizzle_store(part) and not self.capabilities.swizzle_store) or (
            is_dynamic_store(part) and not self.capabilities.dynamic_stores
        )

    def evaluate(self, stmt: ir.Evaluate) -> ir.Stmt | None:
        new = super().evaluate(stmt)
        return None if isinstance(new, ir.Evaluate) and isinstance(new.call, ir.Local) else new

    def leave(self, stmt: ir.Return) -> ir.Stmt | None:
        value = self.returned(stmt.value, stmt.span) if stmt.value is not None else None
        return stmt if value is stmt.value else ir.Return(value, stmt.span)

    def returned(self, value: ir.Expr, span: ir.Span) -> ir.Expr:
        """The value of the function's last return; the first arm of a choice that needs an if returns before it."""
        if not isinstance(value, ir.Select) or not self.branches(value):
            return self.expression(value)
        condition, then = self.expression(value.condition), self.inner((ir.Return(value.yes, value.yes.span),))
        self.out.append(ir.If(condition, then, (), span))
        return self.returned(value.no, span)

    def for_loop(self, stmt: ir.For) -> ir.Stmt | None:
        condition, body = self.loop(stmt)
        init = self.header(stmt.init)
        start = len(self.out)
        step = self.header(stmt.step)
        steps = [*self.out[start:], step] if step is not None else self.out[start:]
        if len(steps) > 1:
            del self.out[start:]
            return ir.For(init, condition, None, at_every_end(body, steps), stmt.span)
        return ir.For(init, condition, step, body, stmt.span)

    def while_loop(self, stmt: ir.While) -> ir.Stmt | None:
        condition, body = self.loop(stmt)
        assert condition is not None
        return ir.While(condition, body, stmt.span)

    def loop(self, loop: ir.For | ir.While) -> tuple[ir.Expr | None, ir.Block]:
        """Condition and body; where the condition needs statements, the body begins with them and may break then."""
        condition, before = self.apart(loop.condition) if loop.condition is not None else (None, [])
        self.counters.append(counts_up(loop) if isinstance(loop, ir.For) else "")
        body = self.inner(loop.body)
        self.counters.pop()
        if before and id(loop) in self.ordered:
            raise _OutOfOrder
        if before and condition is not None:
            stop = ir.Unary(BOOL, "!", condition, condition.span)
            body = (*before, ir.If(stop, (ir.Break(loop.span),), (), loop.span), *body)
            condition = ir.Literal(BOOL, True, condition.span)
        return condition, body

    # What is computed before a statement

    def keep(self, value: ir.Expr, name: str) -> ir.Expr:
        """Computes a value before the statement, into a variable."""
        if self.current is None:
            raise Unsupported(_NOT_CONSTANT, value.span)
        name = self.new_name(name)
        self.out.append(ir.Declare(name, value.type, value, value.span))
        return ir.Local(value.type, name, value.span)

    def keep_expensive(self, value: ir.Expr, name: str) -> ir.Expr:
        return value if is_cheap(value) else self.keep(value, name)

    def apart(self, expr: ir.Expr) -> tuple[ir.Expr, list[ir.Stmt]]:
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
            self.out.append(ir.Evaluate(filling(new, self.functions[new.function], place), new.span))
            return place
        return self.legal(new)

    def legal(self, expr: ir.Expr) -> ir.Expr:
        """A node whose operands are legal already."""
        nested = not self.capabilities.constant_choices and chooses_nested(expr)
        if self.integers is None or not (nested or kind_of(expr.type) in ("int", "uint")):
            return self.expressible(expr)
        parts = self.integers.parts(expr)
        numbers = combined(expr, parts) if parts else None
        if numbers is None:
            return self.expressible(expr)
        computed = nested or is_wider(expr, parts, numbers)
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
            zero = widened(ir.Literal(UINT, 0, expr.span), components(expr.type))
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
        return expr

    def intrinsic(self, call: ir.Intrinsic) -> ir.Expr:
        types = [arg.type for arg in call.args]
        text = self.text(call.name, tuple(types))
        row = BUILTINS[call.name]
        if self.current is None and self.language in row.not_constant:
            raise Unsupported(_NOT_CONSTANT, call.span)
        if not self.capabilities.constant_choices and isinstance(call.type, Vector) and row.is_choice(types):
            number = self.number_of(call)
            if number is not None:
                return number
        if text.startswith("op:"):
            if len(call.args) == 1:
                return ir.Unary(call.type, text[3:], call.args[0], call.span)
            return ir.Binary(call.type, text[3:], call.args[0], call.args[1], call.span)
        if text == "":
            try:
                module = self.polyfill(call.name, types)
            except KeyError:
                raise MissingBuiltin(call.name, call.span) from None
            try:
                return self.call_polyfill(self.with_constants_inlined(call, module), module)
            except MissingBuiltin:  # one of the polyfill, which the author has not written
                raise MissingBuiltin(call.name, call.span) from None
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
        text = self.texts.get((name, types))
        if text is None:
            text = self.texts[name, types] = signatures.text(name, self.dialect, types)
        return text

    def with_constants_inlined(self, call: ir.Intrinsic, module: ir.Module) -> ir.Intrinsic:
        """A call whose polyfill can be inlined, if it is an expression and an argument has to be constant: those of
        functions are not."""
        constants = BUILTINS[call.name].constants([arg.type for arg in call.args])
        if not constants or returned(module) is None or inlined(module, call.args, call.span) is not None:
            return call
        fixed = [isinstance(arg.type, Sampler) or index in constants for index, arg in enumerate(call.args)]
        kept = [arg if skip else self.keep_expensive(arg, "place") for arg, skip in zip(call.args, fixed, strict=True)]
        return call._replace(args=tuple(kept))

    def call_polyfill(self, call: ir.Intrinsic, module: ir.Module) -> ir.Expr:
        """The polyfill's expression where it is short and its arguments are cheap, else a call of the polyfill."""
        function = module.functions[-1]
        writes = self.writing and any(map(self.calls.writing, call.args))  # each is evaluated once, in this order
        placed = inlined(module, call.args, call.span) if not writes else None
        if placed is not None:
            return self.expression(placed)
        if self.current is None:
            raise Unsupported(_NOT_CONSTANT, call.span)
        for helper in module.functions:
            if helper.key not in self.helpers:
                self.functions[helper.key] = helper
                self.outs |= outs_of([helper])
                self.writing = bool(self.shared or self.outs)
                outer = self.names, self.current, self.ordered
                self.helpers[helper.key] = helper  # before its own body: it may be asked for again there
                legal = self.function(helper)
                del self.helpers[helper.key]
                self.helpers[helper.key] = legal
                self.names, self.current, self.ordered = outer
        return ir.Call(call.type, function.key, call.args, call.span)

    def construct(self, construct: ir.Construct) -> ir.Expr:
        type_, args, span = construct.type, construct.args, construct.span
        if kind_of(type_) == "bool" and not self.capabilities.bool_conversions:
            return self.bools(construct)
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

    def bools(self, construct: ir.Construct) -> ir.Expr:
        """A constructor of bools without conversions of numbers: `x != 0`."""
        args = tuple([self.compared(arg) for arg in construct.args])
        if len(args) == 1 and args[0].type == construct.type:
            return args[0]
        return construct._replace(args=args)

    def compared(self, value: ir.Expr) -> ir.Expr:
        """The bools of numbers; bools themselves."""
        type_, span = value.type, value.span
        if kind_of(type_) == "bool" or not isinstance(type_, Scalar | Vector):
            return value
        zero = literal(type_, (0.0 if type_.kind == "float" else 0,), span)
        if isinstance(type_, Scalar):
            return ir.Binary(BOOL, "!=", value, zero, span)
        return self.intrinsic(ir.Intrinsic(Vector("bool", type_.size), "notEqual", (value, zero), span))

    def binary(self, binary: ir.Binary) -> ir.Expr:
        if is_integer_division(binary) and not self.capabilities.integer_division and self.current is not None:
            result = with_result(binary, self.keep_expensive, self.counters)
            # `equal` in it may have another form in the language
            return rewrite(result, lambda part: self.intrinsic(part) if isinstance(part, ir.Intrinsic) else part)
        return legal_operator(binary, self.capabilities, self.keep_expensive)

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
            (yes, before_yes), (no, before_no) = self.apart(select.yes), self.apart(select.no)
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
        aggregate = isinstance(select.type, Struct | Array)
        return self.capabilities.ternary and (not aggregate or self.capabilities.struct_choices)

    def branches(self, select: ir.Select) -> bool:
        """Whether a choice becomes an if: its arms are not plain values, or one of them calls or samples."""
        if self.chooses(select) or self.current is None:
            return False
        plain = isinstance(select.type, Scalar | Vector)
        return not plain or any(_is_costly(part) for arm in (select.yes, select.no) for part in subexpressions(arm))


def _is_costly(expr: ir.Expr) -> bool:
    return isinstance(expr, ir.Call) or (isinstance(expr, ir.Intrinsic) and BUILTINS[expr.name].kind == "fetch")
