"""Inserts guards around operations that the range pass could not prove safe, and removes the author's assumptions.

The intrinsic table has the guards. A guard replaces an argument, the result, or the whole call.
Place: after `hoist`, on whose result the ranges are computed; before `uniform_parameters` and `legalise`, which
treat guards as ordinary code.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

from sssgen.ir import nodes as ir
from sssgen.ir.formats import FLOAT32, Format
from sssgen.ir.intrinsics import BUILTINS, Guard, by_column, with_constants
from sssgen.ir.transform import Transformer, rewrite_function
from sssgen.ir.types import BOOL, FLOAT, UINT, Matrix, Type, components, kind_of, spell, vector_of
from sssgen.ir.walk import operands, statements, subexpressions, with_operands
from sssgen.passes.ranges.range_pass import Findings, analyse
from sssgen.passes.ranges.sites import DIVISION, ELEMENT, WHOLE_DIVISION, Site
from sssgen.passes.substitute import inline, with_larger_bound

Source = Callable[[Guard, str, Sequence[Type], Type, Format, tuple[float, float]], tuple[ir.Module, str]]
"""Returns the module of a guard's function, and the letters of the arguments that it takes."""
Polyfill = Callable[[str, Sequence[Type]], ir.Module]


class GuardedModule(NamedTuple):
    """A module with its guards."""

    module: ir.Module
    sites: list[Site]
    """Every operation with a domain."""
    guarded: list[Site]
    """Those that have a guard."""


def guard(
    module: ir.Module, roots: Iterable[str], mode: str, source: Source, polyfill: Polyfill, format: Format = FLOAT32,
    at: Callable[[Site], str] | None = None, chained: bool = True,
) -> GuardedModule:  # fmt: skip
    """The module with guards where `mode` wants them: `auto` those that are needed, `all` everywhere, `none`.

    `roots` are the keys of the functions called from outside. `at` decides about each guard: `keep`, `drop`, or
    `poison`: NaN wherever the guard would change anything, which shows whether that is reached.
    """
    if mode == "none":
        return GuardedModule(_without_assumptions(module), [], [])
    findings = analyse(module, roots, format, chained)
    chosen = [site for site in findings.sites if mode == "all" or not site.proven]
    poisoned = {id(site) for site in chosen if at is not None and at(site) == "poison"}
    chosen = [site for site in chosen if at is None or at(site) != "drop"]
    if not chosen:
        return GuardedModule(_without_assumptions(module), findings.sites, [])
    guarder = _Guarder(module, findings, chosen, poisoned, source, polyfill, format)
    return GuardedModule(guarder.run(), findings.sites, chosen)


def _without_assumptions(module: ir.Module) -> ir.Module:
    bodies = [function.body or () for function in module.functions]
    if not any(isinstance(stmt, ir.Assume) for body in bodies for stmt in statements(body)):
        return module
    remover = _AssumptionRemover()
    return module._replace(functions=tuple([remover.function(function) for function in module.functions]))


class _AssumptionRemover(Transformer):
    def assume(self, stmt: ir.Assume) -> None:
        return None

    def expression(self, expr: ir.Expr) -> ir.Expr:
        return expr


class _Guarder(Transformer):
    """Inserts the guards of the chosen sites, and removes assumptions."""

    def __init__(
        self, module: ir.Module, findings: Findings, chosen: list[Site], poisoned: set[int], source: Source,
        polyfill: Polyfill, format: Format,
    ) -> None:  # fmt: skip
        super().__init__()
        self.module, self.findings, self.format = module, findings, format
        self.poisoned, self.source, self.polyfill = poisoned, source, polyfill
        self.sites: dict[int, list[Site]] = {}
        for site in chosen:
            self.sites.setdefault(id(site.node), []).append(site)
        self.keys = {function.key for function in module.functions}
        self.helpers: dict[str, ir.Function] = {}
        self.safe: dict[str, ir.Function] = {}
        """A polyfill's key → the function with its divisions guarded."""

    def run(self) -> ir.Module:
        functions = [self.function(function) for function in self.module.functions]
        return self.module._replace(functions=(*self.helpers.values(), *functions))

    def assume(self, stmt: ir.Assume) -> None:
        return None

    def assign(self, stmt: ir.Assign) -> ir.Stmt | None:
        compound = self.findings.compounds.get(id(stmt))
        sites = self.sites.get(id(compound)) if compound is not None else None
        if not sites:
            return super().assign(stmt)
        target, value = self.expression(stmt.target), self.expression(stmt.value)
        operation = ir.Binary(stmt.target.type, stmt.op, target, value, stmt.span)
        return ir.Assign(target, "", self.guarded(operation, sites), stmt.span)

    def expression(self, expr: ir.Expr) -> ir.Expr:
        result = super().expression(expr)
        sites = self.sites.get(id(expr))
        return self.guarded(result, sites) if sites else result

    def guarded(self, node: ir.Expr, sites: list[Site]) -> ir.Expr:
        """A node with its guards: those of its arguments, then those of its result."""
        for site in sorted(sites, key=lambda site: site.guard.replaces == "result"):
            safe = self.apply(node, site)
            node = poisoned(node, safe, site.guard) if id(site) in self.poisoned else safe
        return node

    def apply(self, node: ir.Expr, site: Site) -> ir.Expr:
        guard = guard_of(site, self.format)
        if not guard.text:
            return self.with_safe_divisions(node)
        args = operands(node)
        if isinstance(node, ir.Intrinsic) and guard.replaces in ("x", "y", "z"):
            guard = _of_whole_call(guard, node)
        name = guard.function or f"safe_{site.operation}"
        types = [arg.type for arg in args]
        module, letters = self.source(guard, name, types, node.type, self.format, site.limits)
        passed = (node,) if guard.replaces == "result" else tuple([args["xyz".index(letter)] for letter in letters])
        safe = with_larger_bound(module, passed) or inline(module, passed, node.span, may_repeat=bool(guard.replaces))
        if safe is None:
            function = self.helper(module.functions[-1])
            safe = ir.Call(function.result, function.key, passed, node.span)
        if guard.replaces in ("result", ""):
            return safe
        index = "xyz".index(guard.replaces)
        return with_operands(node, (*args[:index], safe, *args[index + 1 :]))

    def helper(self, function: ir.Function) -> ir.Function:
        """A guard's function, under a name that is unique in the module."""
        name, count = function.name, 2
        while True:
            named = function._replace(name=name)
            existing = self.helpers.get(named.key)
            if existing is not None and existing.body is function.body:
                return existing
            if existing is None and named.key not in self.keys:
                self.helpers[named.key] = named
                return named
            name, count = f"{function.name}_{count}", count + 1

    def with_safe_divisions(self, node: ir.Expr) -> ir.Expr:
        """A builtin replaced by its polyfill, whose divisions have guards."""
        assert isinstance(node, ir.Intrinsic)
        module = self.polyfill(node.name, [arg.type for arg in node.args])
        function = module.functions[-1]

        def change(part: ir.Expr) -> ir.Expr:
            if not isinstance(part, ir.Binary) or part.op != "/":
                return part
            site = Site(part, "/", (DIVISION,), DIVISION, ())
            return self.apply(part, site)

        safe = self.safe.get(function.key)
        if safe is None:
            safe = self.helper(rewrite_function(function, change)._replace(name=f"safe_{node.name}"))
            self.safe[function.key] = safe
        return ir.Call(safe.result, safe.key, node.args, node.span)


def guard_of(site: Site, format: Format) -> Guard:
    """The guard of a site: the weakest one that its ranges require."""
    guard = site.guard
    if guard is DIVISION and site.args:
        divisor = site.args[1]
        if divisor.low >= 0.0:
            return guard._replace(text="max(y, DIVISOR)")
        if divisor.high <= 0.0:
            return guard._replace(text="min(y, -DIVISOR)")
    if guard is WHOLE_DIVISION and kind_of(operands(site.node)[1].type) == "uint":
        return guard._replace(text="max(y, 1u)")
    if guard is ELEMENT and operands(site.node)[1].type == UINT:
        return guard._replace(text="min(y, uint(LAST))")
    return guard._replace(text=_one_sided(guard, site, format))


def _one_sided(guard: Guard, site: Site, format: Format) -> str:
    """The text of a guard that is a `clamp`: `min` or `max` where the range of what it replaces needs no more."""
    clamp = _CLAMP.fullmatch(guard.text)
    if clamp is None or not site.args:
        return guard.text
    is_builtin = isinstance(site.node, ir.Intrinsic) and site.operation == site.node.name
    if is_builtin and (guard.replaces == "result" or not BUILTINS[site.operation].componentwise):
        return guard.text  # the ranges are those of the arguments, or of their lengths
    range_ = site.args[min("xyz".index(clamp[1]), len(site.args) - 1)]  # of an index or a result there is only one
    low, high = [_number(with_constants(bound, format, site.limits)) for bound in clamp.groups()[1:]]
    if (range_.low >= low) == (range_.high <= high):
        return guard.text
    return f"min({clamp[1]}, {clamp[3]})" if range_.low >= low else f"max({clamp[1]}, {clamp[2]})"


_CLAMP = re.compile(r"clamp\(([xyz]), ([^(),]+), ([^(),]+)\)")


def _number(text: str) -> float:
    """The value of a number, or of a difference of two."""
    first, *others = map(float, text.split(" - "))
    return first - sum(others)


def _of_whole_call(guard: Guard, node: ir.Intrinsic) -> Guard:
    """The guard of one argument, or, if its text repeats another one that calls a function, of the whole call."""
    letters = "xyz"[: len(node.args)]
    repeated = [arg for letter, arg in zip(letters, node.args, strict=True)
                if letter != guard.replaces and re.search(rf"\b{letter}\b", guard.text)]  # fmt: skip
    if not any(isinstance(part, ir.Call) for arg in repeated for part in subexpressions(arg)):
        return guard
    args = ", ".join([guard.text if letter == guard.replaces else letter for letter in letters])
    return guard._replace(text=f"{node.name}({args})", replaces="", scalar="")


def remedy(site: Site, format: Format, guard: Guard | None = None) -> str:
    """What replaces the argument, the result or the call, for people; `guard` is that of one of the failures."""
    guard = guard_of(site if guard is None else site._replace(guard=guard), format)
    if guard.advice is not None:
        return with_constants(guard.advice(*site.args), format, site.limits, "{:g}".format)
    text = guard.text or guard.doc
    text = with_constants(text, format, site.limits, "{:g}".format)
    replaced = operands(site.node)["xyz".index(guard.replaces)] if guard.replaces in ("x", "y", "z") else site.node
    if isinstance(replaced.type, Matrix) and guard.text:
        text = by_column(text, replaced.type, guard.replaces if replaced is not site.node else "x")
    text = text.replace("genF", spell(site.node.type))
    if guard.replaces == "result":
        return f"{text}, x its result"
    return f"{text} in place of {guard.replaces or 'the call'}"


def poisoned(plain: ir.Expr, safe: ir.Expr, guard: Guard) -> ir.Expr:
    """`plain` where its guard changes nothing, else NaN, per component. Integers and matrices stay plain."""
    if kind_of(plain.type) != "float" or isinstance(plain.type, Matrix):
        return plain
    span, size = plain.span, components(plain.type)
    before, after = plain, safe
    if guard.replaces in ("x", "y", "z"):
        index = "xyz".index(guard.replaces)
        before, after = operands(plain)[index], operands(safe)[index]
    same = _close(before, after, guard.replaces == "")
    nan: ir.Expr = ir.Intrinsic(FLOAT, "uintBitsToFloat", (ir.Literal(UINT, 0x7FC00000, span),), span)
    if components(before.type) != size:  # one argument for all components
        return ir.Select(plain.type, same, plain, ir.Construct(plain.type, (nan,), span), span)
    if size == 1:
        return ir.Select(plain.type, same, plain, nan, span)
    return ir.Intrinsic(plain.type, "mix", (ir.Construct(plain.type, (nan,), span), plain, same), span)


def _close(first: ir.Expr, second: ir.Expr, roughly: bool) -> ir.Expr:
    """Whether two values are equal, per component; `roughly`: except for rounding."""
    size, span = components(first.type), first.span
    result = vector_of("bool", size)
    if not roughly:
        return (
            ir.Binary(BOOL, "==", first, second, span)
            if size == 1
            else ir.Intrinsic(result, "equal", (first, second), span)
        )
    difference = ir.Intrinsic(first.type, "abs", (ir.Binary(first.type, "-", first, second, span),), span)
    part = ir.Binary(
        first.type, "*", ir.Intrinsic(first.type, "abs", (first,), span), ir.Literal(FLOAT, 1e-3, span), span
    )
    limit = ir.Intrinsic(first.type, "max", (part, ir.Literal(FLOAT, 1e-6, span)), span)
    if size == 1:
        return ir.Binary(BOOL, "<=", difference, limit, span)
    return ir.Intrinsic(result, "lessThanEqual", (difference, limit), span)
