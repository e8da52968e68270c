"""Finds and removes the statements of a function that have no effect. Used by `prune`.

A statement is kept if it has an effect (it returns, discards, leaves a kept loop, or writes an out
parameter or a module variable), if it writes a variable that a kept statement mentions, or if it contains a
kept statement. Loops end (the checker makes sure), so an unkept loop has no effect.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from sssgen.ir import nodes as ir
from sssgen.ir.types import Array, Struct, Type
from sssgen.ir.walk import expressions, operands, root, subexpressions
from sssgen.passes.scopes import outs_of


class Needs(NamedTuple):
    """What a function mentions of its module."""

    calls: dict[str, None]
    globals: set[str]
    types: set[Type]


class CleanFunction(NamedTuple):
    function: ir.Function
    needs: Needs
    acts: bool


class Unit:
    """A statement, with the data that decide whether it is kept."""

    __slots__ = ("jumps", "kept", "needs", "otherwise", "parent", "stmt", "then", "variables")

    def __init__(self, stmt: ir.Stmt, parent: Unit | None) -> None:
        self.stmt = stmt
        self.parent = parent
        self.kept = False
        self.variables: list[int] = []
        """The variables that the statement itself reads or writes."""
        self.needs: list[ir.Call | ir.Global | ir.Construct | ir.Declare] = []
        self.then: Sequence[Unit] = ()
        """The units of an if's first arm or a loop's body."""
        self.otherwise: Sequence[Unit] = ()
        """The units of an if's second arm or a for's init and step."""
        self.jumps: list[Unit] | None = None
        """The breaks and continues of a loop."""


class Cleaner:
    """Cleans the functions of a module, each at its first use."""

    def __init__(self, module: ir.Module) -> None:
        self.functions = {function.key: function for function in module.functions}
        self.results: dict[str, CleanFunction] = {}
        self.outs = outs_of(module.functions)

    def clean(self, key: str) -> CleanFunction:
        cleaned = self.results.get(key)
        if cleaned is None:
            function = self.functions[key]
            self.results[key] = CleanFunction(function, Needs({}, set(), set()), True)
            cleaned = self.results[key] = FunctionCleaner(self, function).run()
        return cleaned

    def reads(self, key: str) -> set[str]:
        """The uniforms, textures and constants that a function and its callees read."""
        if key not in self.functions:
            return set()
        needs = self.clean(key).needs
        return needs.globals.union(*(self.reads(callee) for callee in needs.calls))

    def acts(self, key: str) -> bool:
        """Whether a call may drop the fragment or write a module variable; so may an unknown function."""
        return key not in self.functions or self.clean(key).acts


class FunctionCleaner:
    """Finds and removes the statements of one function that have no effect.

    Variables are numbered by declaration, as sibling blocks may use one name for several. In the IR no
    visible variable is hidden, so a name means its latest declaration.
    """

    def __init__(self, cleaner: Cleaner, function: ir.Function) -> None:
        self.cleaner = cleaner
        self.function = function
        self.numbers: dict[str, int] = {}
        self.stores: list[list[Unit]] = []
        self.live: list[bool] = []
        self.jumps: list[Unit] | None = None
        self.essential: list[Unit] = []
        self.assumptions: list[Unit] = []
        self.units: list[Unit] = []
        self.acts = function.body is None

    def run(self) -> CleanFunction:
        function = self.function
        for param in function.params:
            self.number(param.name, param.direction != "in")
        units, _ = self.block(function.body or (), None)
        self.keep(self.essential)
        if self.assumptions:
            self.keep_assumptions()
        needs = Needs({}, set(), set())
        _note_types(needs, function.result, function.params)
        body = self.rebuild(units, function.body or (), needs)
        if function.body is not None and body is not function.body:
            function = function._replace(body=body)
        return CleanFunction(function, needs, self.acts)

    def keep_assumptions(self) -> None:
        """Keeps the assumptions about values that are live without them."""
        kept = [need for unit in self.units if unit.kept for need in unit.needs]
        read = {need.name for need in kept if isinstance(need, ir.Global)}
        read.update(*(self.cleaner.reads(need.function) for need in kept if isinstance(need, ir.Call)))
        for unit in self.assumptions:
            read_anyway = all(need.name in read for need in unit.needs if isinstance(need, ir.Global))
            live = all(self.live[number] for number in unit.variables)
            unit.kept = read_anyway and live and (unit.parent is None or unit.parent.kept)

    def number(self, name: str, live: bool = False) -> int:
        self.numbers[name] = len(self.stores)
        self.stores.append([])
        self.live.append(live)
        return len(self.stores) - 1

    # Finding what each statement reads and writes

    def block(self, block: ir.Block, parent: Unit | None) -> tuple[list[Unit], bool]:
        """The units of a block up to its first statement that always leaves it, and whether there is one."""
        units = []
        for stmt in block:
            unit = Unit(stmt, parent)
            units.append(unit)
            self.units.append(unit)
            if self.statement(stmt, unit):
                return units, True
        return units, False

    def statement(self, stmt: ir.Stmt, unit: Unit) -> bool:
        """Fills a statement's unit; returns whether the statements after it are unreachable."""
        if isinstance(stmt, ir.For):
            self.header(stmt, unit)
        for expr in expressions(stmt):
            self.expression(expr, unit)
        if isinstance(stmt, ir.Declare):
            number = self.number(stmt.name)
            unit.variables.append(number)
            unit.needs.append(stmt)
            self.stores[number].append(unit)
        elif isinstance(stmt, ir.Assign):
            self.store(stmt.target, unit)
        elif isinstance(stmt, ir.If):
            unit.then, then_ends = self.block(stmt.then, unit)
            unit.otherwise, otherwise_ends = self.block(stmt.otherwise, unit)
            return then_ends and otherwise_ends
        elif isinstance(stmt, ir.For | ir.While):
            self.loop(stmt.body, unit)
        elif isinstance(stmt, ir.Return):
            self.essential.append(unit)
            return True
        elif isinstance(stmt, ir.Assume):
            self.assumptions.append(unit)
        elif isinstance(stmt, ir.Discard | ir.MemoryOperation):
            # a target may require a return after a discard, so the statements after it are kept
            self.acts = True
            self.essential.append(unit)
        elif isinstance(stmt, ir.Break | ir.Continue) and self.jumps is not None:
            self.jumps.append(unit)
            return True
        return False

    def header(self, loop: ir.For, unit: Unit) -> None:
        unit.otherwise = header = []
        for part in (loop.init, loop.step):
            if part is not None:
                header.append(Unit(part, unit))
                self.statement(part, header[-1])

    def loop(self, body: ir.Block, unit: Unit) -> None:
        outer = self.jumps
        self.jumps = unit.jumps = []
        unit.then, _ = self.block(body, unit)
        self.jumps = outer

    def expression(self, expr: ir.Expr, unit: Unit) -> None:
        """Notes the variables that an expression reads, and those that its calls write."""
        variables, numbers = unit.variables, self.numbers
        stack: list[Any] = [expr]
        while stack:
            node = stack.pop()
            kind = type(node)
            if kind is ir.Local:
                number = numbers.get(node.name)
                if number is not None:
                    variables.append(number)
            elif kind is not ir.Literal:
                stack += operands(node)
                if kind is ir.Call or kind is ir.Global or kind is ir.Construct:
                    unit.needs.append(node)
                if kind is ir.Call:
                    self.call(node, unit)

    def call(self, call: ir.Call, unit: Unit) -> None:
        for index in self.cleaner.outs.get(call.function, ()):
            self.store(call.args[index], unit)
        if self.cleaner.acts(call.function):
            self.acts = True
            self.essential.append(unit)

    def store(self, target: ir.Expr, unit: Unit) -> None:
        """Notes that a statement writes a variable; a write of a module variable is an effect."""
        variable = root(target)
        number = self.numbers.get(variable.name) if variable is not None else None
        self.acts = self.acts or variable is None
        if number is None or self.live[number]:
            self.essential.append(unit)
        else:
            self.stores[number].append(unit)

    # Keeping what matters

    def keep(self, pending: list[Unit]) -> None:
        """Keeps these units and all they need."""
        live, stores = self.live, self.stores
        while pending:
            unit = pending.pop()
            if unit.kept:
                continue
            unit.kept = True
            if unit.parent is not None:
                pending.append(unit.parent)
            for number in unit.variables:
                if not live[number]:
                    live[number] = True
                    pending += stores[number]
            if unit.jumps is not None:
                pending += unit.jumps

    def rebuild(self, units: Sequence[Unit], block: ir.Block, needs: Needs) -> ir.Block:
        """The block that the kept units make."""
        result = []
        changed = len(units) != len(block)
        for unit in units:
            if not unit.kept:
                changed = True
                continue
            for node in unit.needs:
                _note(needs, node)
            stmt = unit.stmt
            new: ir.Stmt = stmt
            if isinstance(stmt, ir.If):
                then = self.rebuild(unit.then, stmt.then, needs)
                otherwise = self.rebuild(unit.otherwise, stmt.otherwise, needs)
                if otherwise and not then:
                    new = ir.If(_negate(stmt.condition), otherwise, (), stmt.span)
                elif then is not stmt.then or otherwise is not stmt.otherwise:
                    new = ir.If(stmt.condition, then, otherwise, stmt.span)
            elif isinstance(stmt, ir.For):
                body = self.rebuild(unit.then, stmt.body, needs)
                header = self.rebuild(unit.otherwise, (), needs)
                init, step = (part if any(part is kept for kept in header) else None for part in (stmt.init, stmt.step))
                if body is not stmt.body or init is not stmt.init or step is not stmt.step:
                    new = ir.For(init, stmt.condition, step, body, stmt.span)
            elif isinstance(stmt, ir.While):
                body = self.rebuild(unit.then, stmt.body, needs)
                if body is not stmt.body:
                    new = ir.While(stmt.condition, body, stmt.span)
            changed = changed or new is not stmt
            result.append(new)
        return tuple(result) if changed else block


_OPPOSITE = {"==": "!=", "!=": "=="}


def _negate(condition: ir.Expr) -> ir.Expr:
    """The opposite of a condition. `<` has none among the operators, because of NaN."""
    if isinstance(condition, ir.Unary) and condition.op == "!":
        return condition.operand
    if isinstance(condition, ir.Binary) and condition.op in _OPPOSITE:
        return condition._replace(op=_OPPOSITE[condition.op])
    return ir.Unary(condition.type, "!", condition, condition.span)


def _note(needs: Needs, node: ir.Expr | ir.Declare) -> None:
    """Adds what a node mentions."""
    if isinstance(node, ir.Call):
        needs.calls[node.function] = None
    elif isinstance(node, ir.Global):
        needs.globals.add(node.name)
    elif isinstance(node.type, (Struct, Array)):
        needs.types.add(node.type)


def _note_types(needs: Needs, result: Type, params: tuple[ir.Param, ...]) -> None:
    for type_ in (result, *[param.type for param in params]):
        if isinstance(type_, (Struct, Array)):
            needs.types.add(type_)


def needs_of(value: ir.Expr | None, type_: Type) -> Needs:
    """What a constant or a variable mentions."""
    needs = Needs({}, set(), {type_})
    if value is None:
        return needs
    for part in subexpressions(value):
        if isinstance(part, ir.Call | ir.Global | ir.Construct):
            _note(needs, part)
    return needs
