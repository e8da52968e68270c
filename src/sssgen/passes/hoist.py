"""Moves derivatives, and texture reads that choose their own level, to where all pixels of a quad pass.

Why: both compare a pixel with its neighbours. Where these took another branch, the result is undefined in GLSL and
HLSL, and WGSL refuses the module; so one rule holds for every target. In this order, the remedies are
1. the operation, or the whole call that has it, is computed before the branch, where its operands are the
   same there;
2. a texture read gets its level from derivatives taken before the branch, of the coordinates as they were
   there;
3. a texture read gets level 0, and a derivative is taken as 0. A note reports 2 and 3 to the user.
Place: after `prune`, which removes unused operations; before the passes for one target.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

from sssgen.ir import nodes as ir
from sssgen.ir.constant_expressions import zero
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.transform import Transformer
from sssgen.ir.types import FLOAT, Sampler, components, vector_of
from sssgen.ir.walk import (
    all_expressions,
    builtins_of,
    operands,
    statements,
    subexpressions,
    with_operands,
    written_root,
)
from sssgen.passes.divergence import CallContext, Divergence, Summary, implicit, join, summaries
from sssgen.passes.explicit_levels import at_level
from sssgen.passes.scopes import claim, declared, qualified_name
from sssgen.passes.unsupported import Note

_LARGEST = 64
"""How many nodes an expression may have that replaces a variable."""


def hoist(module: ir.Module, entries: Iterable[str], in_branches: Collection[str] = ()) -> tuple[ir.Module, list[Note]]:
    """The module with every implicit derivative in uniform control flow, and notes on what that changed.

    `entries` are the keys of the functions that are called from outside, for each pixel with other values. Those that
    are `in_branches`, too, are called where not all pixels of a quad may pass.
    """
    if implicit().isdisjoint(builtins_of(module)):
        return module, []
    summary_of = summaries(module)
    functions = {function.key: function for function in module.functions}
    sites: dict[str, CallContext] = {}
    for key in entries:
        if summary_of[key].compares:
            names = frozenset(param.name for param in functions[key].params)
            sites[key] = CallContext(key not in in_branches, names)
    notes: dict[Note, None] = {}
    for key in _callers_first(sites, summary_of):
        function = functions[key]
        flow = Divergence(function, sites[key], summary_of, functions)
        if flow.misplaced:
            functions[key] = function = _Hoister(function, sites[key], flow, summary_of, notes).run()
            flow = Divergence(function, sites[key], summary_of, functions)
        for callee, site in flow.sites.items():
            sites[callee] = join(sites.get(callee), site)
    changed = any(functions[function.key] is not function for function in module.functions)
    if changed:
        module = module._replace(functions=tuple([functions[function.key] for function in module.functions]))
    return module, list(notes)


def _callers_first(entries: Iterable[str], summaries: Mapping[str, Summary]) -> list[str]:
    """The functions that compare pixels, each after those that call it."""
    order: list[str] = []
    visited: set[str] = set()

    def visit(key: str) -> None:
        if key not in visited and key in summaries and summaries[key].compares:
            visited.add(key)
            for callee in summaries[key].callees:
                visit(callee)
            order.append(key)

    for key in entries:
        visit(key)
    return order[::-1]


class _Region:
    """Statements that not all pixels reach, and the values known before them."""

    def __init__(self, visible: Iterable[str], reachable: bool = True) -> None:
        self.available = set(visible)
        """The variables that exist before the region."""
        self.changed: set[str] = set()
        """Those of them that have changed since, and module variables (see `qualified_name`)."""
        self.definitions: dict[str, ir.Expr] = {}
        """The values of variables, as expressions over available variables that have not changed."""
        self.starts: dict[str, ir.Expr] = {}
        """The first values of the region's own variables, in the same form."""
        self.hoisted: list[ir.Stmt] = []
        self.variables: dict[object, str] = {}
        """The names of the hoisted variables, by the keys of their values."""
        self.reachable = reachable
        """Whether statements can be inserted before it; False where the whole function is called from a branch."""

    def change(self, names: Iterable[str]) -> None:
        for name in names:
            self.changed.add(name)
            self.definitions.pop(name, None)


class _Hoister(Transformer):
    """Rewrites one function."""

    def __init__(
        self,
        function: ir.Function,
        site: CallContext,
        flow: Divergence,
        summaries: Mapping[str, Summary],
        notes: dict[Note, None],
    ) -> None:
        super().__init__()
        self.source, self.flow, self.summaries, self.notes = function, flow, summaries, notes
        self.taken = set(declared(function))
        self.depth = 0
        """How many blocks enclose the current statement."""
        self.depths = {param.name: 1 for param in function.params}
        """How many enclose each variable's declaration."""
        self.shared = summaries[function.key].reads
        self.region = None if site.uniform else _Region((), False)

    def run(self) -> ir.Function:
        return self.function(self.source)

    # Statements

    def block(self, block: ir.Block) -> ir.Block:
        self.depth += 1
        new = self.sequence(block)
        self.depth -= 1
        return tuple(new)

    def sequence(self, block: ir.Block) -> list[ir.Stmt]:
        out: list[ir.Stmt] = []
        for index, stmt in enumerate(block):
            if self.region is not None:
                out.append(self.rewrite_statement(stmt))
                continue
            region = _Region(self.scope)
            if id(stmt) in self.flow.inside:
                self.region = region
                new = self.rewrite_statement(stmt)
                self.region = None
            else:
                new = self.rewrite_statement(stmt)
                region.change(self.changes_of((stmt,)))
            if id(stmt) in self.flow.after:
                self.region = region
                rest = self.sequence(block[index + 1 :])
                self.region = None
                return [*out, *region.hoisted, new, *rest]
            out += [*region.hoisted, new]
        return out

    def rewrite_statement(self, stmt: ir.Stmt) -> ir.Stmt:
        new = self.statement(stmt)
        assert new is not None
        return new

    def declare(self, stmt: ir.Declare) -> ir.Stmt | None:
        new = super().declare(stmt)
        assert isinstance(new, ir.Declare)
        self.depths[stmt.name] = self.depth
        if self.region is not None:
            self.region.starts.pop(stmt.name, None)
            earlier = self.earlier_value(new.value) if new.value is not None else None
            self.define(stmt.name, earlier)
            if earlier is not None:
                self.region.starts[stmt.name] = earlier
        return new

    def assign(self, stmt: ir.Assign) -> ir.Stmt | None:
        new = super().assign(stmt)
        if self.region is not None and isinstance(new, ir.Assign):
            self.note_store(new.target, new.op, new.value)
        return new

    def for_loop(self, stmt: ir.For) -> ir.Stmt | None:
        if self.region is not None:
            self.region.change(self.changes_of((stmt,)))
        return super().for_loop(stmt)

    def while_loop(self, stmt: ir.While) -> ir.Stmt | None:
        if self.region is not None:
            self.region.change(self.changes_of((stmt,)))
        return super().while_loop(stmt)

    def header(self, stmt: ir.Stmt | None) -> ir.Stmt | None:
        new = super().header(stmt)
        if self.region is not None and isinstance(stmt, ir.Declare):
            self.region.change((stmt.name,))
            self.region.starts.pop(stmt.name, None)
        return new

    def define(self, name: str, value: ir.Expr | None) -> None:
        """Notes the new value of a variable, as an expression over variables from before the region."""
        assert self.region is not None
        if value is not None and sum(1 for _ in subexpressions(value)) <= _LARGEST:
            self.region.definitions[name] = value
        else:
            self.region.definitions.pop(name, None)

    def note_store(self, target: ir.Expr, op: str, value: ir.Expr) -> None:
        """Notes what an assignment changes. In the block of the variable's declaration it defines the variable."""
        assert self.region is not None
        variable = written_root(target)
        if variable is None:
            return
        if isinstance(variable, ir.Global):
            self.region.change((qualified_name(variable),))
        elif target is variable and self.depths.get(variable.name, 0) == self.depth:
            if op:
                value = ir.Binary(target.type, op, target, value, target.span)
            earlier = self.earlier_value(value)
            self.region.change((variable.name,))
            self.define(variable.name, earlier)
        else:
            self.region.change((variable.name,))

    def changes_of(self, block: ir.Block) -> set[str]:
        """The variables that a block may change."""
        names = set()
        for stmt in statements(block):
            target = written_root(stmt.target) if isinstance(stmt, ir.Assign) else None
            if target is not None:
                names.add(qualified_name(target))
        for expr in all_expressions(block):
            if isinstance(expr, ir.Call):
                names |= self.writes_of(expr)
        return names

    def writes_of(self, call: ir.Call) -> set[str]:
        summary = self.summaries[call.function]
        targets = [written_root(call.args[index]) for index in summary.outs]
        return {qualified_name(target) for target in targets if target is not None}.union(
            map("${}".format, summary.writes)
        )

    # Expressions

    def expression(self, expr: ir.Expr) -> ir.Expr:
        """The expression with every misplaced operation in it moved or replaced, from the inside out."""
        changed = super().expression(expr)
        if id(expr) in self.flow.misplaced:
            assert isinstance(changed, ir.Call | ir.Intrinsic)
            earlier = self.earlier_value(changed)
            if earlier is not None:
                return self.hoisted(earlier, _base_name(changed), expr.span)
            if isinstance(changed, ir.Intrinsic):
                return self.with_level(changed)
        if self.region is not None and isinstance(expr, ir.Call):
            self.region.change(self.writes_of(expr))
        return changed

    def earlier_value(self, expr: ir.Expr) -> ir.Expr | None:
        """An expression with the same value before the region, or None if there is none."""
        region = self.region
        if region is None or not region.reachable:
            return None
        if isinstance(expr, ir.Local):
            if expr.name in region.definitions:
                return region.definitions[expr.name]
            return expr if expr.name in region.available and expr.name not in region.changed else None
        if isinstance(expr, ir.Global):
            return None if qualified_name(expr) in region.changed else expr
        if isinstance(expr, ir.Call):
            called = self.summaries[expr.function]
            if not called.pure or not region.changed.isdisjoint(map("${}".format, called.reads)):
                return None
        return self.rebuild(expr, [self.earlier_value(operand) for operand in operands(expr)])

    def rebuild(self, expr: ir.Expr, new: list[ir.Expr | None]) -> ir.Expr | None:
        """`expr` with other operands, or None where one is missing."""
        if not new:
            return expr
        whole = tuple([operand for operand in new if operand is not None])
        if len(whole) < len(new):
            return None
        same = all(replacement is operand_ for replacement, operand_ in zip(whole, operands(expr), strict=True))
        return expr if same else with_operands(expr, whole)

    def hoisted(self, value: ir.Expr, name: str, span: ir.Span) -> ir.Local:
        """A variable before the region that holds a value."""
        assert self.region is not None
        key = _key(value)
        variable = self.region.variables.get(key)
        if variable is None:
            variable = self.region.variables[key] = claim(name, self.taken)
            self.region.available.add(variable)
            self.region.hoisted.append(ir.Declare(variable, value.type, value, span))
        return ir.Local(value.type, variable, span)

    # The level made explicit

    def with_level(self, expr: ir.Intrinsic) -> ir.Expr:
        """A builtin that cannot be moved, without the comparison of neighbours."""
        row = BUILTINS[expr.name]
        if row.kind == "derivative":
            self.note(f"{expr.name} is taken as 0 here", expr.span)
            return zero(expr.type, expr.span)
        map_, coordinate, *others = expr.args
        assert isinstance(map_.type, Sampler)
        if row.with_level is None or not row.with_gradients:
            return expr  # no such builtin has an explicit level
        offset, bias = others[: len(row.constant)], others[len(row.constant) :]
        coordinates = self.start_value(coordinate) if not map_.type.shadow else None
        if coordinates is None or not any(map(self.may_vary, subexpressions(coordinates))):
            read = at_level(expr, bias[0] if bias else ir.Literal(FLOAT, 0.0, expr.span))
            if read is None:
                return expr  # no such builtin has an explicit level
            self.note(f"{_words(map_)} is read at level 0 here", expr.span)
            return read
        name = coordinates.name if isinstance(coordinates, ir.Local) else "coordinates"
        if map_.type.array:  # the layer has no slope
            letters = "xyzw"[: components(coordinate.type) - 1]
            coordinates = ir.Swizzle(vector_of("float", len(letters)), coordinates, letters, expr.span)
        slopes: list[ir.Expr] = []
        for builtin, axis in (("dFdx", "dx"), ("dFdy", "dy")):
            slope = ir.Intrinsic(coordinates.type, builtin, (coordinates,), expr.span)
            slopes.append(self.hoisted(slope, f"{name}_{axis}", expr.span))
        if bias:
            scale = ir.Intrinsic(FLOAT, "exp2", (bias[0],), expr.span)
            slopes = [ir.Binary(slope.type, "*", slope, scale, expr.span) for slope in slopes]
        self.note(f"{_words(map_)} is read here at the level that its coordinates had before", expr.span)
        return ir.Intrinsic(expr.type, row.with_gradients, (map_, coordinate, *slopes, *offset), expr.span)

    def may_vary(self, part: ir.Expr) -> bool:
        """Whether it is a variable, of the function or of the module."""
        return isinstance(part, ir.Local) or (isinstance(part, ir.Global) and part.name in self.shared)

    def start_value(self, expr: ir.Expr) -> ir.Expr | None:
        """The value that coordinates have before the region; unknown terms of a sum are omitted."""
        region = self.region
        if region is None or not region.reachable:
            return None
        if isinstance(expr, ir.Local):
            return expr if expr.name in region.available else region.starts.get(expr.name)
        if isinstance(expr, ir.Call) and not self.summaries[expr.function].pure:
            return None
        parts = [self.start_value(operand) for operand in operands(expr)]
        if isinstance(expr, ir.Binary) and expr.op in ("+", "-"):
            left, right = parts
            if left is None or right is None:
                term = left if left is not None else right
                return term if term is not None and term.type == expr.type else None
        return self.rebuild(expr, parts)

    def note(self, message: str, span: ir.Span) -> None:
        reason = "neighbouring pixels may take another branch"
        self.notes[Note(f"{message}: {reason}, so their difference is not known", span)] = None


def _base_name(expr: ir.Call | ir.Intrinsic) -> str:
    """A readable name for the value of an operation that is moved."""
    if isinstance(expr, ir.Call):
        return f"{expr.function.split('(')[0]}_value"
    subject = expr.args[0]
    name = subject.name if isinstance(subject, ir.Local | ir.Global) else ""
    row = BUILTINS[expr.name]
    if row.kind == "fetch":
        return f"{name or 'texture'}_sample"
    return f"{name or 'value'}_{f'd{row.axis}' if row.axis else 'width'}"


def _words(map: ir.Expr) -> str:
    return f"'{map.name}'" if isinstance(map, ir.Local | ir.Global) else "a texture"


def _key(expr: ir.Expr) -> object:
    """A key that is equal for expressions that differ in their spans alone."""
    fields = [part for part in expr[:-1] if isinstance(part, (str, int, float))]
    return (type(expr), expr.type, *fields, *[_key(operand) for operand in operands(expr)])
