"""Statements as a target has them. Used by `legalise`."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.loops import at_every_end, break_unless
from sssgen.ir.types import BOOL, Array, Matrix, Struct, components
from sssgen.ir.walk import all_expressions, written_root
from sssgen.passes.capabilities import Capabilities
from sssgen.passes.legal.builtin_forms import Polyfill
from sssgen.passes.legal.ends import with_ends
from sssgen.passes.legal.integer_operators import counts_up
from sssgen.passes.legal.legal_expressions import LegalExpressions
from sssgen.passes.legal.part_stores import component_stores, is_dynamic_store, is_swizzle_store, parts_of, whole_store

_JUMPS = (ir.Return, ir.Break, ir.Continue)  # a discarded invocation may go on


def _jumps(stmt: ir.Stmt) -> bool:
    """Whether nothing behind a statement in its block is reached: naga looks for a return at the end alone."""
    if isinstance(stmt, ir.If):
        return any(map(_jumps, stmt.then)) and any(map(_jumps, stmt.otherwise))
    return isinstance(stmt, _JUMPS)


class OutOfOrderError(Exception):
    """A value would be computed before a call that precedes it in the source."""


class LegalStatements(LegalExpressions):
    """Rewrites statements and their expressions."""

    def __init__(self, module: ir.Module, dialect: str, capabilities: Capabilities, polyfill: Polyfill) -> None:
        super().__init__(module, dialect, capabilities, polyfill)
        self.ordered: set[int] = set()
        """The ids of the statements of which no part may be computed before them."""
        self.memories = {variable.name for variable in module.variables if variable.storage in ("shared", "buffer")}

    def block(self, block: ir.Block) -> ir.Block:
        if self.current is not None and not (self.capabilities.discard_ends and self.capabilities.endless_loops):
            block = with_ends(block, self.current.result, bool(self.counters), self.capabilities)
        if not self.capabilities.unreachable_statements:
            last = next((index for index, stmt in enumerate(block) if _jumps(stmt)), len(block))
            block = block if last + 1 >= len(block) else block[: last + 1]
        return super().block(block)

    def statement(self, stmt: ir.Stmt) -> ir.Stmt | None:
        start = len(self.out)
        new = super().statement(stmt)
        if id(stmt) in self.ordered and len(self.out) - start + (new is not None) > 1:
            raise OutOfOrderError
        return new

    def declare(self, stmt: ir.Declare) -> ir.Stmt | None:
        value = stmt.value
        self.scope[stmt.name] = stmt
        if value is None:
            return stmt if self.capabilities.large_variables or self.is_needed(stmt) else None
        place = ir.Local(stmt.type, stmt.name, stmt.span)
        if isinstance(value, ir.Select) and not self.chooses(value):
            value = self.select(value, place)
            if value is place:
                self.out.insert(-1, stmt._replace(value=None))
                return None
            return stmt._replace(value=value)
        begin = self.initial_value(value)
        new = self.scope[stmt.name] = stmt if begin is value else ir.Declare(stmt.name, stmt.type, begin, stmt.span)
        return new

    def is_needed(self, stmt: ir.Declare) -> bool:
        """Whether a variable is small, or used by its function: WGSL takes variables of 8192 bytes (section 2.4.1)."""
        if not isinstance(stmt.type, Array) or 4 * components(stmt.type) <= 8192 or self.current is None:
            return True
        parts = all_expressions(self.current.body or ())
        return any(isinstance(part, ir.Local) and part.name == stmt.name for part in parts)

    def initial_value(self, value: ir.Expr) -> ir.Expr:
        """An initial value: there every language can list the parts of an array or struct."""
        if type(value) is ir.Construct and isinstance(value.type, (Array, Struct)):
            return value._replace(args=tuple([self.initial_value(arg) for arg in value.args]))
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
        if type(place) is not ir.Local and any(map(self.lacks_store, parts_of(place))):
            if op:
                value = self.binary(ir.Binary(place.type, op, place, value, span))
            if self.is_memory(place):
                self.out += component_stores(place, value, self.lacks_store, self.keep_expensive)
                return None
            place, value = whole_store(place, value, self.lacks_store, self.keep_expensive)
            return ir.Assign(place, "", value, span)
        if op:
            result = self.binary(ir.Binary(place.type, op, place, value, span))
            linear = isinstance(value.type, Matrix) and op == "*"
            if linear or not (isinstance(result, ir.Binary) and result.op == op and result.left is place):
                return ir.Assign(place, "", result, span)
            value = result.right
        same = place is stmt.target and value is stmt.value
        return stmt if same else ir.Assign(place, op, value, span)

    def is_memory(self, place: ir.Expr) -> bool:
        """Whether other invocations may write what is beside a place."""
        root = written_root(place)
        if isinstance(root, ir.Local):
            params = self.current.params if self.memories and self.current is not None else ()
            return any(param.passes in self.memories for param in params if param.name == root.name)
        return root is not None and root.name in self.memories

    def lacks_store(self, part: ir.Expr) -> bool:
        """Whether the target has no store into such a part."""
        return (is_swizzle_store(part) and not self.capabilities.swizzle_store) or (
            is_dynamic_store(part) and not self.capabilities.dynamic_stores
        )

    def evaluate(self, stmt: ir.Evaluate) -> ir.Stmt | None:
        new = super().evaluate(stmt)
        return None if isinstance(new, ir.Evaluate) and isinstance(new.call, ir.Local) else new

    def leave(self, stmt: ir.Return) -> ir.Stmt | None:
        value = self.return_value(stmt.value, stmt.span) if stmt.value is not None else None
        return stmt if value is stmt.value else ir.Return(value, stmt.span)

    def return_value(self, value: ir.Expr, span: ir.Span) -> ir.Expr:
        """The value of the function's last return; the first arm of a choice that needs an if returns before it."""
        if not isinstance(value, ir.Select) or not self.branches(value):
            return self.expression(value)
        condition, then = self.expression(value.condition), self.inner((ir.Return(value.yes, value.yes.span),))
        self.out.append(ir.If(condition, then, (), span))
        return self.return_value(value.no, span)

    def for_loop(self, stmt: ir.For) -> ir.Stmt | None:
        outer, self.scope = self.scope, self.scope.copy()
        init = self.header(stmt.init)
        condition, body = self.loop(stmt)
        start = len(self.out)
        step = self.header(stmt.step)
        self.scope = outer
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
        condition, before = self.detach(loop.condition) if loop.condition is not None else (None, [])
        self.counters.append(counts_up(loop) if isinstance(loop, ir.For) else "")
        body = self.inner(loop.body)
        self.counters.pop()
        if before and id(loop) in self.ordered:
            raise OutOfOrderError
        if before and condition is not None:
            body = (*before, break_unless(condition), *body)
            condition = ir.Literal(BOOL, True, condition.span)
        return condition, body
