"""Rewrites a module until the target can say every node; printing is then a table and a few methods.

Last of the passes that change meaning-bearing structure: the others see one language-neutral form. What a target can
say is its descriptor's `[capabilities]`; which builtins it has is the intrinsic table's. Knows no target by name.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ..ir import nodes as ir
from ..ir import signatures
from ..ir.intrinsics import BUILTINS
from ..ir.types import (
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
from ..ir.walk import expressions, rewrite, root, statements, subexpressions

Polyfill = Callable[[str, Sequence[Type]], ir.Module]
"""Gives the module whose last function stands in for a builtin with these argument types."""

Can = Callable[[str], bool]


class Unsupported(Exception):
    """Something that the target has no way to say."""

    def __init__(self, message: str, span: ir.Span) -> None:
        super().__init__(message)
        self.message, self.span = message, span


def legalise(module: ir.Module, dialect: str, can: Can, polyfill: Polyfill) -> ir.Module:
    """The module as the target can say it. Raises Unsupported."""
    return _Legaliser(module, dialect, can, polyfill).run()


class _Legaliser:
    def __init__(self, module: ir.Module, dialect: str, can: Can, polyfill: Polyfill) -> None:
        self.module = module
        self.dialect = dialect
        self.language = dialect.partition("-")[0]
        self.can = can
        self.polyfill = polyfill
        self.functions = {function.key: function for function in module.functions}
        self.helpers: dict[str, ir.Function] = {}
        self.block_bools = set() if can("bool_uniforms") else {u.name for u in module.uniforms if u.type == BOOL}
        self.block_arrays = {
            uniform.name
            for uniform in module.uniforms
            if isinstance(uniform.type, Array) and not can("float_array_uniforms") and components(uniform.type.element) < 4
        }  # fmt: skip
        self.names: set[str] = set()
        self.prelude: list[ir.Stmt] | None = None

    def run(self) -> ir.Module:
        functions = [self.function(function) for function in self.module.functions]
        constants = tuple(constant._replace(value=self.expr(constant.value)) for constant in self.module.constants)
        return self.module._replace(constants=constants, functions=(*self.helpers.values(), *functions))

    def function(self, function: ir.Function) -> ir.Function:
        body = function.body or ()
        self.names = {param.name for param in function.params}
        self.names |= {stmt.name for stmt in statements(body) if isinstance(stmt, ir.Declare)}
        if not self.can("mutable_parameters"):
            function = self.copy_parameters(function)
        return function._replace(body=self.block(function.body or ()))

    def copy_parameters(self, function: ir.Function) -> ir.Function:
        """Gives each `in` parameter that is assigned a variable of its own name; the parameter is renamed."""
        written = {
            target.name
            for stmt in statements(function.body or ())
            for written in self.written(stmt)
            if (target := root(written)) is not None
        }
        params, copies = [], []
        for param in function.params:
            if param.direction == "in" and param.name in written:
                given = self.fresh(f"{param.name}_in")
                copies.append(ir.Declare(param.name, param.type, ir.Local(param.type, given, param.span), param.span))
                param = param._replace(name=given)
            params.append(param)
        return function._replace(params=tuple(params), body=(*copies, *(function.body or ())))

    def written(self, stmt: ir.Stmt) -> list[ir.Expr]:
        """What a statement assigns to, through a call too."""
        found = [stmt.target] if isinstance(stmt, ir.Assign) else []
        for expr in expressions(stmt):
            for part in subexpressions(expr):
                if isinstance(part, ir.Call):
                    params = self.functions[part.function].params
                    found += [arg for arg, param in zip(part.args, params, strict=True) if param.direction != "in"]
        return found

    def fresh(self, name: str) -> str:
        """A name that the function does not use yet."""
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
        return tuple(result)

    def statement(self, stmt: ir.Stmt) -> list[ir.Stmt]:
        """A statement, after what it needs to have computed before."""
        outer, self.prelude = self.prelude, []
        new: ir.Stmt = stmt
        after: list[ir.Stmt] = []
        if isinstance(stmt, ir.Declare) and stmt.value is not None:
            new = self.declare(stmt, stmt.value)
        elif isinstance(stmt, ir.Assign):
            new = self.assign(stmt)
        elif isinstance(stmt, ir.Return) and stmt.value is not None:
            new = ir.Return(self.expr(stmt.value), stmt.span)
        elif isinstance(stmt, ir.Evaluate):
            call = self.expr(stmt.call)
            new = ir.Evaluate(call, stmt.span)
        elif isinstance(stmt, ir.If):
            condition = self.expr(stmt.condition)
            before, self.prelude = self.prelude, []
            new = ir.If(condition, self.block(stmt.then), self.block(stmt.otherwise), stmt.span)
            self.prelude = before
        elif isinstance(stmt, ir.For | ir.While):
            new = self.loop(stmt)
        if not self.can("out_parameters"):
            new, after = self.split_out_arguments(new)
        result = [*self.prelude, new, *after]
        self.prelude = outer
        return result

    def declare(self, declare: ir.Declare, value: ir.Expr) -> ir.Stmt:
        if isinstance(value, ir.Construct) and isinstance(value.type, Array):  # an initialiser is sayable everywhere
            args = tuple(self.expr(arg) for arg in value.args)
            return declare._replace(value=value._replace(args=args))
        return declare._replace(value=self.expr(value))

    def assign(self, assign: ir.Assign) -> ir.Stmt:
        target, value = self.expr(assign.target), self.expr(assign.value)
        stores = isinstance(target, ir.Swizzle) and len(target.components) > 1
        if isinstance(target, ir.Swizzle) and stores and not self.can("swizzle_store"):
            return self.rebuild(target, assign.op, value, assign.span)
        if assign.op and isinstance(target.type, Vector) and isinstance(value.type, Matrix):
            return ir.Assign(target, "", self.binary(ir.Binary(target.type, assign.op, target, value, assign.span)), assign.span)  # fmt: skip
        if assign.op == "*" and isinstance(target.type, Matrix) and isinstance(value.type, Matrix):
            return ir.Assign(target, "", ir.Binary(target.type, "*", target, value, assign.span), assign.span)
        return ir.Assign(target, assign.op, value, assign.span)

    def rebuild(self, target: ir.Swizzle, op: str, value: ir.Expr, span: ir.Span) -> ir.Stmt:
        """`v.xz = value` as `v = vec3(value.x, v.y, value.y)`."""
        whole = target.value
        assert isinstance(whole.type, Vector)
        if op:
            value = ir.Binary(target.type, op, target, value, span)
        if not isinstance(value, ir.Local | ir.Global | ir.Literal) and components(value.type) > 1:
            value = self.keep(value, f"{_base_name(whole)}_{target.components}")
        parts = []
        for letter in "xyzw"[: whole.type.size]:
            index = target.components.find(letter)
            source, letter = (whole, letter) if index < 0 else (value, "xyzw"[index])
            single = isinstance(source.type, Scalar)
            parts.append(source if single else ir.Swizzle(Scalar(whole.type.kind), source, letter, span))
        return ir.Assign(whole, "", ir.Construct(whole.type, tuple(parts), span), span)

    def keep(self, value: ir.Expr, name: str) -> ir.Expr:
        """Computes a value before the statement, into a local."""
        if self.prelude is None:
            raise Unsupported("this cannot be said in a constant or a loop's condition for this target", value.span)
        name = self.fresh(name)
        self.prelude.append(ir.Declare(name, value.type, value, value.span))
        return ir.Local(value.type, name, value.span)

    def loop(self, loop: ir.For | ir.While) -> ir.Stmt:
        if isinstance(loop, ir.While):
            self_prelude, self.prelude = self.prelude, None
            condition = self.expr(loop.condition)
            self.prelude = self_prelude
            return ir.While(condition, self.inner(loop.body), loop.span)
        init = self.statement(loop.init) if loop.init is not None else []
        step = self.statement(loop.step) if loop.step is not None else []
        self_prelude, self.prelude = self.prelude, None
        test = self.expr(loop.condition) if loop.condition is not None else None
        self.prelude = self_prelude
        assert self.prelude is not None
        self.prelude.extend(init[:-1])
        if len(step) > 1:
            raise Unsupported("this loop's step cannot be said for this target", loop.span)
        return ir.For(init[-1] if init else None, test, step[0] if step else None, self.inner(loop.body), loop.span)

    def inner(self, block: ir.Block) -> ir.Block:
        outer, self.prelude = self.prelude, []
        result = self.block(block)
        self.prelude = outer
        return result

    def split_out_arguments(self, stmt: ir.Stmt) -> tuple[ir.Stmt, list[ir.Stmt]]:
        """Where out parameters are pointers, only whole variables can be passed: parts go through a variable."""
        after: list[ir.Stmt] = []

        def change(expr: ir.Expr) -> ir.Expr:
            if not isinstance(expr, ir.Call):
                return expr
            args = list(expr.args)
            for index, param in enumerate(self.functions[expr.function].params):
                target = args[index]
                if param.direction == "in" or isinstance(target, ir.Local):
                    continue
                name = self.fresh(_base_name(target) + "_part")
                value = target if param.direction == "inout" else None
                assert self.prelude is not None
                self.prelude.append(ir.Declare(name, target.type, value, target.span))
                args[index] = ir.Local(target.type, name, target.span)
                back = ir.Assign(target, "", args[index], target.span)
                swizzled = isinstance(target, ir.Swizzle) and len(target.components) > 1
                rebuild = isinstance(target, ir.Swizzle) and swizzled
                after.append(self.rebuild(target, "", args[index], target.span) if rebuild else back)  # type: ignore[arg-type]  # it is a Swizzle
            return expr._replace(args=tuple(args))

        if isinstance(stmt, ir.Declare) and stmt.value is not None:
            return stmt._replace(value=rewrite(stmt.value, change)), after
        if isinstance(stmt, ir.Assign):
            return stmt._replace(value=rewrite(stmt.value, change)), after
        if isinstance(stmt, ir.Evaluate):
            return stmt._replace(call=rewrite(stmt.call, change)), after
        return stmt, after

    # Expressions

    def expr(self, expr: ir.Expr) -> ir.Expr:
        return rewrite(expr, self.node)

    def node(self, expr: ir.Expr) -> ir.Expr:
        """One node whose operands are legal already."""
        if isinstance(expr, ir.Intrinsic):
            return self.intrinsic(expr)
        if isinstance(expr, ir.Construct):
            return self.construct(expr)
        if isinstance(expr, ir.Binary):
            return self.binary(expr)
        if isinstance(expr, ir.Select) and not self.can("ternary"):
            return self.select(expr)
        if isinstance(expr, ir.Global) and expr.name in self.block_bools:
            as_int = ir.Global(INT, expr.name, expr.span)
            return ir.Binary(BOOL, "!=", as_int, ir.Literal(INT, 0, expr.span), expr.span)
        if isinstance(expr, ir.Index) and isinstance(expr.value, ir.Global) and expr.value.name in self.block_arrays:
            kind, size = kind_of(expr.type), components(expr.type)
            row = ir.Index(Vector(kind, 4), expr.value, expr.index, expr.span)
            return ir.Swizzle(vector_of(kind, size), row, "xyzw"[:size], expr.span)
        return expr

    def intrinsic(self, call: ir.Intrinsic) -> ir.Expr:
        types = [arg.type for arg in call.args]
        text = signatures.text(call.name, self.dialect, types)
        row = BUILTINS[call.name]
        if text.startswith("op:"):
            if len(call.args) == 1:
                return ir.Unary(call.type, text[3:], call.args[0], call.span)
            return ir.Binary(call.type, text[3:], call.args[0], call.args[1], call.span)
        if text == "":
            if not row.polyfill:
                raise Unsupported(f"this target has no {call.name}", call.span)
            return self.call_polyfill(call, types)
        if self.language in row.splat and isinstance(call.type, Vector):
            args = tuple(
                ir.Construct(Vector(kind_of(arg.type), call.type.size), (arg,), arg.span)
                if isinstance(arg.type, Scalar) and kind_of(arg.type) == call.type.kind
                else arg
                for arg in call.args
            )
            return call._replace(args=args)
        return call

    def call_polyfill(self, call: ir.Intrinsic, types: list[Type]) -> ir.Expr:
        """The polyfill's expression itself where it is short and its arguments are cheap, else a call of it."""
        module = self.polyfill(call.name, types)
        function = module.functions[-1]
        body = function.body or ()
        if len(module.functions) == 1 and len(body) == 1 and isinstance(body[0], ir.Return) and body[0].value is not None:
            value = body[0].value
            uses: dict[str, int] = {}
            for part in subexpressions(value):
                if isinstance(part, ir.Local):
                    uses[part.name] = uses.get(part.name, 0) + 1
            args = {param.name: arg for param, arg in zip(function.params, call.args, strict=True)}
            if all(uses.get(name, 0) <= 1 or _cheap(arg) for name, arg in args.items()):
                placed = rewrite(value, lambda part: args[part.name] if isinstance(part, ir.Local) else part)
                return self.expr(_respan(placed, call.span))
        for helper in module.functions:
            if helper.key not in self.helpers:
                self.functions[helper.key] = helper
                names, prelude = self.names, self.prelude
                self.helpers[helper.key] = helper  # before its own body: it may be asked for again there
                legal = self.function(helper)
                del self.helpers[helper.key]
                self.helpers[helper.key] = legal
                self.names, self.prelude = names, prelude
        return ir.Call(call.type, function.key, call.args, call.span)

    def construct(self, construct: ir.Construct) -> ir.Expr:
        type_, args, span = construct.type, construct.args, construct.span
        if isinstance(type_, Vector) and len(args) == 1 and isinstance(args[0].type, Vector):
            if args[0].type.size > type_.size:  # vec3(v4) keeps the first three
                value = ir.Swizzle(Vector(args[0].type.kind, type_.size), args[0], "xyz"[: type_.size], span)
                return value if value.type == type_ else ir.Construct(type_, (value,), span)
        if isinstance(type_, Scalar) and len(args) == 1 and isinstance(args[0].type, Vector):
            first = ir.Swizzle(Scalar(args[0].type.kind), args[0], "x", span)
            return first if first.type == type_ else ir.Construct(type_, (first,), span)
        if isinstance(type_, Matrix) and len(args) == 1 and not self.can("matrix_conversions"):
            return self.matrix_from(type_, args[0], span)
        if isinstance(type_, Struct) and not self.can("struct_constructors"):
            name = self.fresh(type_.name[0].lower() + type_.name[1:])
            if self.prelude is None:
                raise Unsupported("a struct constructor cannot stand here for this target", span)
            made = ir.Local(type_, name, span)
            self.prelude.append(ir.Declare(name, type_, None, span))
            for field, arg in zip(type_.fields, args, strict=True):
                member = ir.Member(field.type, made, field.name, arg.span)
                self.prelude.append(ir.Assign(member, "", arg, arg.span))
            return made
        if isinstance(type_, Array) and not self.can("array_constructors"):
            return self.keep(construct, "values")
        return construct

    def matrix_from(self, type_: Matrix, value: ir.Expr, span: ir.Span) -> ir.Expr:
        """A matrix from a scalar (its diagonal) or from another matrix, written out by columns."""
        zero, one = ir.Literal(FLOAT, 0.0, span), ir.Literal(FLOAT, 1.0, span)
        if isinstance(value.type, Scalar):
            if not _cheap(value):
                value = self.keep(value, "diagonal")
            cells = [value if row == column else zero for column in range(type_.size) for row in range(type_.size)]
            return ir.Construct(type_, tuple(cells), span)
        if not _cheap(value):
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
        if op == "^^":
            return ir.Binary(BOOL, "!=", left, right, span)
        if op in ("==", "!=") and binary.type == BOOL and not isinstance(left.type, Scalar):
            return self.equality(binary) if not self.can("whole_equality") else binary
        if op in ("<<", ">>") and not self.can("signed_shifts") and kind_of(right.type) == "int":
            if isinstance(right, ir.Literal):
                return binary._replace(right=ir.Literal(UINT, right.value, right.span))
            size = components(right.type)
            return binary._replace(right=ir.Construct(vector_of("uint", size), (right,), right.span))
        if not self.can("matrix_scalar_arithmetic"):
            if isinstance(left.type, Matrix) and isinstance(right.type, Scalar) and op == "/":
                inverse = ir.Binary(FLOAT, "/", ir.Literal(FLOAT, 1.0, span), right, span)
                return ir.Binary(left.type, "*", left, inverse, span)
            if isinstance(binary.type, Matrix) and op in "+-/" and (left.type != right.type or op == "/"):
                return self.by_columns(binary)
        return binary

    def by_columns(self, binary: ir.Binary) -> ir.Expr:
        """Componentwise matrix arithmetic, column by column."""
        assert isinstance(binary.type, Matrix)
        column = Vector("float", binary.type.size)
        sides = [side if _cheap(side) else self.keep(side, "matrix") for side in (binary.left, binary.right)]

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
        left, right = (side if _cheap(side) else self.keep(side, "compared") for side in (left, right))
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

    def select(self, select: ir.Select) -> ir.Expr:
        """A choice that evaluates both arms is fine for plain values; else the arms go into an if."""
        plain = isinstance(select.type, Scalar | Vector)
        costly = any(_is_costly(part) for arm in (select.yes, select.no) for part in subexpressions(arm))
        if (plain and not costly) or self.prelude is None:
            return select
        name = self.fresh("chosen")
        chosen = ir.Local(select.type, name, select.span)
        self.prelude.append(ir.Declare(name, select.type, None, select.span))
        yes = ir.Assign(chosen, "", select.yes, select.yes.span)
        no = ir.Assign(chosen, "", select.no, select.no.span)
        self.prelude.append(ir.If(select.condition, (yes,), (no,), select.span))
        return chosen


def _is_costly(expr: ir.Expr) -> bool:
    return isinstance(expr, ir.Call) or (isinstance(expr, ir.Intrinsic) and BUILTINS[expr.name].kind == "fetch")


def _cheap(expr: ir.Expr) -> bool:
    """Whether writing an expression twice costs nothing."""
    if isinstance(expr, ir.Swizzle | ir.Member):
        return _cheap(expr.value)
    if isinstance(expr, ir.Construct) and len(expr.args) == 1:
        return _cheap(expr.args[0])
    return isinstance(expr, ir.Local | ir.Global | ir.Literal)


def _base_name(target: ir.Expr) -> str:
    while isinstance(target, ir.Swizzle | ir.Index):
        target = target.value
    if isinstance(target, ir.Member):
        return target.field
    return target.name if isinstance(target, ir.Local | ir.Global) else "value"


def _respan(expr: ir.Expr, span: ir.Span) -> ir.Expr:
    """What a polyfill computes stems from its call."""
    return rewrite(expr, lambda part: part._replace(span=span) if part.span.file.startswith("intrinsics/") else part)

