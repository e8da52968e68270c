"""Makes safe what the range pass could not prove, and nothing else; takes the author's assumptions out.

Each guard is one of the intrinsic table, put around an argument, around the result, or in the call's place. What it
lets through is the limit that the table documents.
Place: after `hoist`, as the ranges are found there; before `parameters` and `legalise`, to which a guard is ordinary
code.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

from sssgen.ir import nodes as ir
from sssgen.ir.formats import FLOAT32, Format
from sssgen.ir.intrinsics import Guard, with_constants
from sssgen.ir.transform import rewrite_function, rewrite_module
from sssgen.ir.types import BOOL, FLOAT, UINT, Matrix, Type, components, kind_of, spell, vector_of
from sssgen.ir.walk import operands, statements, with_operands
from sssgen.passes.ranges.range_pass import Findings, analyse
from sssgen.passes.ranges.sites import BOUNDS, DIVISION, Site
from sssgen.passes.substitute import in_place, widened_bound

Source = Callable[[Guard, str, Sequence[Type], Type, Format, tuple[float, float]], tuple[ir.Module, str]]
"""Gives the module of a guard's function, and the letters of the arguments that it takes."""
Polyfill = Callable[[str, Sequence[Type]], ir.Module]


class Guarded(NamedTuple):
    """A module with its guards."""

    module: ir.Module
    sites: list[Site]
    """Every operation with a domain."""
    guarded: list[Site]
    """Those of them that got a guard."""


def guard(
    module: ir.Module, roots: Iterable[str], mode: str, source: Source, polyfill: Polyfill, format: Format = FLOAT32,
    at: Callable[[Site], str] | None = None, chained: bool = True,
) -> Guarded:  # fmt: skip
    """The module with guards where `mode` wants them: `auto` those that are needed, `all` everywhere, `none`.

    `roots` are the keys of the functions that are called from outside. `at` tells what becomes of a single guard:
    `keep`, `drop` it, or `poison`: NaN wherever the guard would have changed anything, to see whether that is reached.
    """
    if mode == "none":
        return Guarded(_without_assumptions(module), [], [])
    found = analyse(module, roots, format, chained)
    chosen = [site for site in found.sites if mode == "all" or not site.proven]
    poisoned = {id(site) for site in chosen if at is not None and at(site) == "poison"}
    chosen = [site for site in chosen if at is None or at(site) != "drop"]
    if not chosen:
        return Guarded(_without_assumptions(module), found.sites, [])
    guarder = _Guarder(module, found, chosen, poisoned, source, polyfill, format)
    return Guarded(guarder.run(), found.sites, chosen)


def _without_assumptions(module: ir.Module) -> ir.Module:
    def restate(stmt: ir.Stmt) -> ir.Block | None:
        return () if isinstance(stmt, ir.Assume) else None

    if not any(isinstance(stmt, ir.Assume) for one in module.functions for stmt in statements(one.body or ())):
        return module
    return rewrite_module(module, lambda expr: expr, restate)


class _Guarder:
    def __init__(
        self, module: ir.Module, found: Findings, chosen: list[Site], poisoned: set[int], source: Source,
        polyfill: Polyfill, format: Format,
    ) -> None:  # fmt: skip
        self.module, self.found, self.format = module, found, format
        self.poisoned, self.source, self.polyfill = poisoned, source, polyfill
        self.sites: dict[int, list[Site]] = {}
        for site in chosen:
            self.sites.setdefault(id(site.node), []).append(site)
        self.keys = {function.key for function in module.functions}
        self.helpers: dict[str, ir.Function] = {}
        self.safe: dict[str, ir.Function] = {}
        """A polyfill's key → the function with its divisions guarded."""

    def run(self) -> ir.Module:
        functions = [
            function if function.body is None else function._replace(body=self.block(function.body))
            for function in self.module.functions
        ]
        return self.module._replace(functions=(*self.helpers.values(), *functions))

    # Statements

    def block(self, block: ir.Block) -> ir.Block:
        new = [self.statement(stmt) for stmt in block if not isinstance(stmt, ir.Assume)]
        same = len(new) == len(block) and all(one is other for one, other in zip(new, block, strict=True))
        return block if same else tuple(new)

    def statement(self, stmt: ir.Stmt) -> ir.Stmt:
        if isinstance(stmt, ir.Declare) and stmt.value is not None:
            value = self.expr(stmt.value)
            return stmt if value is stmt.value else stmt._replace(value=value)
        if isinstance(stmt, ir.Assign):
            return self.assign(stmt)
        if isinstance(stmt, ir.Return) and stmt.value is not None:
            value = self.expr(stmt.value)
            return stmt if value is stmt.value else ir.Return(value, stmt.span)
        if isinstance(stmt, ir.Evaluate):
            call = self.expr(stmt.call)
            return stmt if call is stmt.call else ir.Evaluate(call, stmt.span)
        if isinstance(stmt, ir.If):
            condition = self.expr(stmt.condition)
            return ir.If(condition, self.block(stmt.then), self.block(stmt.otherwise), stmt.span)
        if isinstance(stmt, ir.While):
            return ir.While(self.expr(stmt.condition), self.block(stmt.body), stmt.span)
        if isinstance(stmt, ir.For):
            init = self.statement(stmt.init) if stmt.init is not None else None
            test = self.expr(stmt.condition) if stmt.condition is not None else None
            step = self.statement(stmt.step) if stmt.step is not None else None
            return ir.For(init, test, step, self.block(stmt.body), stmt.span)
        return stmt

    def assign(self, stmt: ir.Assign) -> ir.Stmt:
        target, value = self.expr(stmt.target), self.expr(stmt.value)
        compound = self.found.compounds.get(id(stmt))
        if compound is not None and id(compound) in self.sites:
            plain = ir.Binary(stmt.target.type, stmt.op, target, value, stmt.span)
            return ir.Assign(target, "", self.guarded(plain, self.sites[id(compound)]), stmt.span)
        same = target is stmt.target and value is stmt.value
        return stmt if same else ir.Assign(target, stmt.op, value, stmt.span)

    # Expressions

    def expr(self, node: ir.Expr) -> ir.Expr:
        old = operands(node)
        new = tuple([self.expr(operand) for operand in old])
        result = node
        if any(one is not other for one, other in zip(new, old, strict=True)):
            result = with_operands(node, new)
        sites = self.sites.get(id(node))
        return self.guarded(result, sites) if sites else result

    def guarded(self, node: ir.Expr, sites: list[Site]) -> ir.Expr:
        """A node with its guards: those of its arguments, then those of its result."""
        for site in sorted(sites, key=lambda site: guard_of(site).replaces == "result"):
            safe = self.apply(node, site)
            node = poisoned(node, safe, guard_of(site)) if id(site) in self.poisoned else safe
        return node

    def apply(self, node: ir.Expr, site: Site) -> ir.Expr:
        chosen = guard_of(site)
        if not chosen.text:
            return self.with_safe_divisions(node)
        args = operands(node)
        name = chosen.function or f"safe_{site.what}"
        types = [arg.type for arg in args]
        module, letters = self.source(chosen, name, types, node.type, self.format, site.limits)
        given = (node,) if chosen.replaces == "result" else tuple([args["xyz".index(letter)] for letter in letters])
        made = widened_bound(module, given) or in_place(module, given, node.span, twice=bool(chosen.replaces))
        if made is None:
            function = self.helper(module.functions[-1])
            made = ir.Call(function.result, function.key, given, node.span)
        if chosen.replaces in ("result", ""):
            return made
        at = "xyz".index(chosen.replaces)
        return with_operands(node, (*args[:at], made, *args[at + 1 :]))

    def helper(self, function: ir.Function) -> ir.Function:
        """A guard's function, under a name that the module has not."""
        name, count = function.name, 2
        while True:
            named = function._replace(name=name)
            known = self.helpers.get(named.key)
            if known is not None and known.body is function.body:
                return known
            if known is None and named.key not in self.keys:
                self.helpers[named.key] = named
                return named
            name, count = f"{function.name}_{count}", count + 1

    def with_safe_divisions(self, node: ir.Expr) -> ir.Expr:
        """A builtin as its polyfill, whose divisions have guards."""
        assert isinstance(node, ir.Intrinsic)
        module = self.polyfill(node.name, [arg.type for arg in node.args])
        function = module.functions[-1]

        def change(part: ir.Expr) -> ir.Expr:
            if not isinstance(part, ir.Binary) or part.op != "/":
                return part
            site = Site(part, "/", False, DIVISION, ())
            return self.apply(part, site)

        made = self.safe.get(function.key)
        if made is None:
            made = self.helper(rewrite_function(function, change)._replace(name=f"safe_{node.name}"))
            self.safe[function.key] = made
        return ir.Call(made.result, made.key, node.args, node.span)


def guard_of(site: Site) -> Guard:
    """The guard of a site: the least that its ranges ask for."""
    found = site.guard
    if found is DIVISION and site.args:
        divisor = site.args[1]
        if divisor.low >= 0.0:
            return found._replace(text="max(y, DIVISOR)")
        if divisor.high <= 0.0:
            return found._replace(text="min(y, -DIVISOR)")
    if found is BOUNDS:
        low, high = site.limits
        if site.args[0].high <= high:
            return found._replace(text="max(x, LOW)")
        if site.args[0].low >= low:
            return found._replace(text="min(x, HIGH)")
    return found


def remedy(site: Site, format: Format) -> str:
    """What stands in for the argument, the result or the call, for people."""
    found = guard_of(site)
    text = found.text or found.doc
    text = with_constants(text, format, site.limits, "{:g}".format).replace("genF", spell(site.node.type))
    if found.replaces == "result":
        return f"{text}, x its result"
    return f"{text} in place of {found.replaces or 'the call'}"


def poisoned(plain: ir.Expr, safe: ir.Expr, guard: Guard) -> ir.Expr:
    """`plain` where its guard changes nothing, else NaN, by component; integers and matrices: the plain value."""
    if kind_of(plain.type) != "float" or isinstance(plain.type, Matrix):
        return plain
    span, size = plain.span, components(plain.type)
    before, after = plain, safe
    if guard.replaces in ("x", "y", "z"):
        at = "xyz".index(guard.replaces)
        before, after = operands(plain)[at], operands(safe)[at]
    same = _close(before, after, guard.replaces == "")
    nan: ir.Expr = ir.Intrinsic(FLOAT, "uintBitsToFloat", (ir.Literal(UINT, 0x7FC00000, span),), span)
    if components(before.type) != size:  # one argument for all components
        return ir.Select(plain.type, same, plain, ir.Construct(plain.type, (nan,), span), span)
    if size == 1:
        return ir.Select(plain.type, same, plain, nan, span)
    return ir.Intrinsic(plain.type, "mix", (ir.Construct(plain.type, (nan,), span), plain, same), span)


def _close(one: ir.Expr, other: ir.Expr, roughly: bool) -> ir.Expr:
    """Whether two values are the same, by component; `roughly`: to rounding."""
    size, span = components(one.type), one.span
    result = vector_of("bool", size)
    if not roughly:
        return (
            ir.Binary(BOOL, "==", one, other, span) if size == 1 else ir.Intrinsic(result, "equal", (one, other), span)
        )
    apart = ir.Intrinsic(one.type, "abs", (ir.Binary(one.type, "-", one, other, span),), span)
    part = ir.Binary(one.type, "*", ir.Intrinsic(one.type, "abs", (one,), span), ir.Literal(FLOAT, 1e-3, span), span)
    limit = ir.Intrinsic(one.type, "max", (part, ir.Literal(FLOAT, 1e-6, span)), span)
    if size == 1:
        return ir.Binary(BOOL, "<=", apart, limit, span)
    return ir.Intrinsic(result, "lessThanEqual", (apart, limit), span)
