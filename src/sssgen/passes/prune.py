"""Removes what a material does not use: functions, uniforms, constants, structs, and statements without
effect.

Why: what a material leaves out must not appear in its shader, and an artist should not read dead code.
Place: after `fold`, which makes branches and uniforms unused; before `hoist`, `parameters` and `names`, which
then meet only what is there, callees before callers. It may run again after a pass that leaves remains.

A statement is kept if it has an effect (it returns, discards, leaves a kept loop, or writes an out
parameter or a module variable), if it writes a variable that a kept statement mentions, or if it contains a
kept statement. Loops end (the checker has seen to it), so an unkept loop has no effect.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from sssgen.ir.nodes import (
    Assign,
    Assume,
    Binary,
    Block,
    Call,
    Construct,
    Declare,
    Discard,
    Evaluate,
    Expr,
    For,
    Function,
    Global,
    If,
    Intrinsic,
    Literal,
    Local,
    Member,
    Module,
    Param,
    Return,
    Select,
    Stmt,
    Swizzle,
    Unary,
    While,
)
from sssgen.ir.types import Array, Struct, Type
from sssgen.ir.walk import all_expressions, callees, root, statements, subexpressions

if TYPE_CHECKING:
    from typing import TypeVar

    _T = TypeVar("_T")


def prune(module: Module, roots: Iterable[str]) -> Module:
    """The part of a module that the functions with the keys `roots` use, without dead statements.

    What a stage is given and gives (in and out variables) stays: other stages count on it.

    Functions come out with callees before callers, otherwise in the order they had. Raises KeyError for a
    root that the module does not have.
    """
    cleaner = _Cleaner(module)
    reached = set(roots)
    pending = list(reached)
    while pending:
        for callee in cleaner.cleaned(pending.pop()).needs.calls:
            if callee not in reached and callee in cleaner.functions:
                reached.add(callee)
                pending.append(callee)
    kept: dict[str, _Cleaned] = {}
    for key in cleaner.functions:
        if key in reached:
            _place(key, cleaner, kept)
    names, types = set[str](), set[Type]()
    for cleaned in kept.values():
        names |= cleaned.needs.globals
        types |= cleaned.needs.types
    variables = []
    for variable in reversed(module.variables):
        if variable.name in names or variable.storage != "private":
            variables.append(variable)
            needs = _needs_of(variable.value, variable.type)
            names |= needs.globals
            types |= needs.types
    constants = []
    for constant in reversed(module.constants):
        if constant.name in names:
            constants.append(constant)
            needs = _needs_of(constant.value, constant.type)
            names |= needs.globals
            types |= needs.types
    structs = set(_structs(types))
    return Module(
        _same(module.structs, [struct for struct in module.structs if struct.type in structs]),
        _same(module.constants, constants[::-1]),
        _same(module.uniforms, [uniform for uniform in module.uniforms if uniform.name in names]),
        _same(module.functions, [cleaned.function for cleaned in kept.values()]),
        _same(module.variables, variables[::-1]),
    )


def only(module: Module, roots: Iterable[str]) -> Module:
    """The module with the functions alone that `roots` call, themselves or through others; all else as it was.

    Raises KeyError for a root that the module does not have.
    """
    functions = {function.key: function for function in module.functions}
    reached: set[str] = set()
    pending = list(roots)
    while pending:
        key = pending.pop()
        if key not in reached:
            reached.add(key)
            pending += callees(functions[key])
    return module._replace(functions=tuple([one for key, one in functions.items() if key in reached]))


def used(module: Module) -> Module:
    """The module with the declarations alone that its functions mention, themselves or through others."""
    names: set[str] = set()
    pending = [expr for function in module.functions for expr in all_expressions(function.body or ())]
    values = {constant.name: constant.value for constant in module.constants}
    values |= {one.name: one.value for one in module.variables if one.value is not None}
    types: set[Type] = set()
    for function in module.functions:
        types |= {function.result, *(param.type for param in function.params)}
        types |= {stmt.type for stmt in statements(function.body or ()) if isinstance(stmt, Declare)}
    while pending:
        expr = pending.pop()
        types.add(expr.type)
        if isinstance(expr, Global) and expr.name not in names:
            names.add(expr.name)
            if expr.name in values:
                pending += subexpressions(values[expr.name])
    structs = set(_structs(types))
    return module._replace(
        structs=tuple([one for one in module.structs if one.type in structs]),
        constants=tuple([one for one in module.constants if one.name in names]),
        uniforms=tuple([one for one in module.uniforms if one.name in names]),
        variables=tuple([one for one in module.variables if one.name in names]),
    )


def _same(old: tuple[_T, ...], new: list[_T]) -> tuple[_T, ...]:
    """`new` as a tuple; `old` itself where it holds the same."""
    same = len(old) == len(new) and all(one is other for one, other in zip(old, new, strict=True))
    return old if same else tuple(new)


def _structs(types: Iterable[Type]) -> Iterator[Type]:
    """The structs that these types are or hold."""
    for type_ in types:
        if isinstance(type_, Array):
            yield from _structs((type_.element,))
        elif isinstance(type_, Struct):
            yield type_
            yield from _structs(field.type for field in type_.fields)


class _Needs(NamedTuple):
    """What a function mentions of its module."""

    calls: dict[str, None]
    globals: set[str]
    types: set[Type]


class _Cleaned(NamedTuple):
    function: Function
    needs: _Needs
    acts: bool


def _place(key: str, cleaner: _Cleaner, kept: dict[str, _Cleaned]) -> None:
    """Adds a function after those it calls."""
    if key in kept or key not in cleaner.functions:
        return
    cleaned = cleaner.cleaned(key)
    callees = cleaned.needs.calls
    if not all(callee in kept for callee in callees):
        for callee in cleaner.functions:
            if callee in callees:
                _place(callee, cleaner, kept)
    kept[key] = cleaned


class _Unit:
    """A statement, with what decides whether it is kept."""

    __slots__ = ("jumps", "kept", "needs", "otherwise", "parent", "stmt", "then", "variables")

    def __init__(self, stmt: Stmt, parent: _Unit | None) -> None:
        self.stmt = stmt
        self.parent = parent
        self.kept = False
        self.variables: list[int] = []
        """The variables that the statement itself reads or writes."""
        self.needs: list[Call | Global | Construct | Declare] = []
        self.then: Sequence[_Unit] = ()
        """The units of an if's first arm or a loop's body."""
        self.otherwise: Sequence[_Unit] = ()
        """The units of an if's second arm or a for's init and step."""
        self.jumps: list[_Unit] | None = None
        """The breaks and continues of a loop."""


class _Cleaner:
    """Cleans the functions of a module, each when it is first asked for."""

    def __init__(self, module: Module) -> None:
        self.functions = {function.key: function for function in module.functions}
        self.done: dict[str, _Cleaned] = {}
        self.outs: dict[str, tuple[int, ...]] = {
            key: tuple([index for index, param in enumerate(function.params) if param.direction != "in"])
            for key, function in self.functions.items()
        }

    def cleaned(self, key: str) -> _Cleaned:
        found = self.done.get(key)
        if found is None:
            function = self.functions[key]
            self.done[key] = _Cleaned(function, _Needs({}, set(), set()), True)
            found = self.done[key] = _FunctionCleaner(self, function).run()
        return found

    def reads(self, key: str) -> set[str]:
        """The uniforms, textures and constants that a function reads, itself or through what it calls."""
        if key not in self.functions:
            return set()
        needs = self.cleaned(key).needs
        return needs.globals.union(*(self.reads(callee) for callee in needs.calls))

    def acts(self, key: str) -> bool:
        """Whether a call may drop the fragment or write a module variable; so may what is not known."""
        return key not in self.functions or self.cleaned(key).acts


class _FunctionCleaner:
    """Finds and drops what has no effect in one function.

    Variables are numbered by declaration, as sibling blocks may use one name for several. In the IR no
    visible variable is hidden, so a name stands for its latest declaration.
    """

    def __init__(self, cleaner: _Cleaner, function: Function) -> None:
        self.cleaner = cleaner
        self.function = function
        self.numbers: dict[str, int] = {}
        self.stores: list[list[_Unit]] = []
        self.live: list[bool] = []
        self.jumps: list[_Unit] | None = None
        self.essential: list[_Unit] = []
        self.assumptions: list[_Unit] = []
        self.units: list[_Unit] = []
        self.acts = function.body is None

    def run(self) -> _Cleaned:
        function = self.function
        for param in function.params:
            self.number(param.name, param.direction != "in")
        units, _ = self.block(function.body or (), None)
        self.keep(self.essential)
        if self.assumptions:
            self.keep_assumptions()
        needs = _Needs({}, set(), set())
        _note_types(needs, function.result, function.params)
        body = self.rebuild(units, function.body or (), needs)
        if function.body is not None and body is not function.body:
            function = function._replace(body=body)
        return _Cleaned(function, needs, self.acts)

    def keep_assumptions(self) -> None:
        """Keeps those that speak of what is there anyway: they keep nothing alive."""
        kept = [need for unit in self.units if unit.kept for need in unit.needs]
        read = {need.name for need in kept if isinstance(need, Global)}
        read.update(*(self.cleaner.reads(need.function) for need in kept if isinstance(need, Call)))
        for unit in self.assumptions:
            known = all(need.name in read for need in unit.needs if isinstance(need, Global))
            live = all(self.live[number] for number in unit.variables)
            unit.kept = known and live and (unit.parent is None or unit.parent.kept)

    def number(self, name: str, live: bool = False) -> int:
        self.numbers[name] = len(self.stores)
        self.stores.append([])
        self.live.append(live)
        return len(self.stores) - 1

    # Finding what each statement reads and writes

    def block(self, block: Block, parent: _Unit | None) -> tuple[list[_Unit], bool]:
        """The units of a block, up to where it is left for good; and whether it is."""
        units = []
        for stmt in block:
            unit = _Unit(stmt, parent)
            units.append(unit)
            self.units.append(unit)
            if self.statement(stmt, unit):
                return units, True
        return units, False

    def statement(self, stmt: Stmt, unit: _Unit) -> bool:
        """Fills a statement's unit; whether nothing after the statement is reached."""
        if isinstance(stmt, Declare):
            if stmt.value is not None:
                self.expression(stmt.value, unit)
            number = self.number(stmt.name)
            unit.variables.append(number)
            unit.needs.append(stmt)
            self.stores[number].append(unit)
        elif isinstance(stmt, Assign):
            self.expression(stmt.target, unit)
            self.expression(stmt.value, unit)
            self.store(stmt.target, unit)
        elif isinstance(stmt, If):
            self.expression(stmt.condition, unit)
            unit.then, then_ends = self.block(stmt.then, unit)
            unit.otherwise, otherwise_ends = self.block(stmt.otherwise, unit)
            return then_ends and otherwise_ends
        elif isinstance(stmt, For):
            unit.otherwise = header = []
            for part in (stmt.init, stmt.step):
                if part is not None:
                    header.append(_Unit(part, unit))
                    self.statement(part, header[-1])
            if stmt.condition is not None:
                self.expression(stmt.condition, unit)
            self.loop(stmt.body, unit)
        elif isinstance(stmt, While):
            self.expression(stmt.condition, unit)
            self.loop(stmt.body, unit)
        elif isinstance(stmt, Return):
            if stmt.value is not None:
                self.expression(stmt.value, unit)
            self.essential.append(unit)
            return True
        elif isinstance(stmt, Evaluate):
            self.expression(stmt.call, unit)
        elif isinstance(stmt, Assume):
            self.expression(stmt.condition, unit)
            self.assumptions.append(unit)
        elif isinstance(stmt, Discard):
            # a target may still want a return after it, so what follows stays
            self.acts = True
            self.essential.append(unit)
        elif self.jumps is not None:
            self.jumps.append(unit)
            return True
        return False

    def loop(self, body: Block, unit: _Unit) -> None:
        outer = self.jumps
        self.jumps = unit.jumps = []
        unit.then, _ = self.block(body, unit)
        self.jumps = outer

    def expression(self, expr: Expr, unit: _Unit) -> None:
        """Notes what an expression reads, and what its calls write."""
        variables, numbers = unit.variables, self.numbers
        stack: list[Any] = [expr]
        while stack:
            node = stack.pop()
            kind = type(node)
            if kind is Local:
                number = numbers.get(node.name)
                if number is not None:
                    variables.append(number)
            elif kind is Binary:
                stack += (node.left, node.right)
            elif kind is Literal:
                pass
            elif kind is Intrinsic:
                stack += node.args
            elif kind is Global:
                unit.needs.append(node)
            elif kind is Swizzle or kind is Member:
                stack.append(node.value)
            elif kind is Call or kind is Construct:
                stack += node.args
                unit.needs.append(node)
                if kind is Call:
                    self.call(node, unit)
            elif kind is Unary:
                stack.append(node.operand)
            elif kind is Select:
                stack += (node.condition, node.yes, node.no)
            else:
                stack += (node.value, node.index)

    def call(self, call: Call, unit: _Unit) -> None:
        for index in self.cleaner.outs.get(call.function, ()):
            self.store(call.args[index], unit)
        if self.cleaner.acts(call.function):
            self.acts = True
            self.essential.append(unit)

    def store(self, target: Expr, unit: _Unit) -> None:
        """Notes that a statement writes a variable; what is no variable of the function is an effect."""
        variable = root(target)
        number = self.numbers.get(variable.name) if variable is not None else None
        self.acts = self.acts or variable is None
        if number is None or self.live[number]:
            self.essential.append(unit)
        else:
            self.stores[number].append(unit)

    # Keeping what matters

    def keep(self, pending: list[_Unit]) -> None:
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

    def rebuild(self, units: Sequence[_Unit], block: Block, needs: _Needs) -> Block:
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
            new: Stmt = stmt
            if isinstance(stmt, If):
                then = self.rebuild(unit.then, stmt.then, needs)
                otherwise = self.rebuild(unit.otherwise, stmt.otherwise, needs)
                if otherwise and not then:
                    new = If(_negated(stmt.condition), otherwise, (), stmt.span)
                elif then is not stmt.then or otherwise is not stmt.otherwise:
                    new = If(stmt.condition, then, otherwise, stmt.span)
            elif isinstance(stmt, For):
                body = self.rebuild(unit.then, stmt.body, needs)
                header = self.rebuild(unit.otherwise, (), needs)
                init, step = (part if any(part is kept for kept in header) else None for part in (stmt.init, stmt.step))
                if body is not stmt.body or init is not stmt.init or step is not stmt.step:
                    new = For(init, stmt.condition, step, body, stmt.span)
            elif isinstance(stmt, While):
                body = self.rebuild(unit.then, stmt.body, needs)
                if body is not stmt.body:
                    new = While(stmt.condition, body, stmt.span)
            changed = changed or new is not stmt
            result.append(new)
        return tuple(result) if changed else block


_OPPOSITE = {"==": "!=", "!=": "=="}


def _negated(condition: Expr) -> Expr:
    """The opposite of a condition. `<` has none among the operators, because of NaN."""
    if isinstance(condition, Unary) and condition.op == "!":
        return condition.operand
    if isinstance(condition, Binary) and condition.op in _OPPOSITE:
        return condition._replace(op=_OPPOSITE[condition.op])
    return Unary(condition.type, "!", condition, condition.span)


def _note(needs: _Needs, node: Expr | Declare) -> None:
    """Adds what a node mentions."""
    if isinstance(node, Call):
        needs.calls[node.function] = None
    elif isinstance(node, Global):
        needs.globals.add(node.name)
    elif isinstance(node.type, (Struct, Array)):
        needs.types.add(node.type)


def _note_types(needs: _Needs, result: Type, params: tuple[Param, ...]) -> None:
    for type_ in (result, *[param.type for param in params]):
        if isinstance(type_, (Struct, Array)):
            needs.types.add(type_)


def _needs_of(value: Expr | None, type_: Type) -> _Needs:
    """What a constant or a variable mentions."""
    needs = _Needs({}, set(), {type_})
    if value is None:
        return needs
    unit = _Unit(Return(value, value.span), None)
    empty = Function("", (), type_, "", (), "", value.span)
    _FunctionCleaner(_Cleaner(Module()), empty).expression(value, unit)
    for node in unit.needs:
        _note(needs, node)
    return needs
