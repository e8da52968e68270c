"""The names in a function: finding, replacing and renaming them. Used by the passes that move or name code.

In the IR no visible variable is hidden by another; sibling blocks may use one name each. A pass that moves
statements to another block puts this right again with `separate`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Container, Iterable, Mapping
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
    Intrinsic,
    Literal,
    Local,
    Return,
    Stmt,
    While,
)
from sssgen.ir.transform import rewrite
from sssgen.ir.walk import calls_of, expressions, inner_statements, operands, root, statements, with_operands

_NONE: Mapping[str, str] = {}


def declared(function: Function) -> list[str]:
    """The names of a function's parameters and variables, each as often as it is declared."""
    names = [param.name for param in function.params]
    stack = list(function.body or ())
    while stack:
        stmt = stack.pop()
        if isinstance(stmt, Declare):
            names.append(stmt.name)
        elif isinstance(stmt, (If, For, While)):
            stack.extend(inner_statements(stmt))
    return names


def mentions(function: Function) -> tuple[set[str], set[str]]:
    """The names of the uniforms and constants that a function reads, and the keys of the functions it
    calls."""
    globals_, calls = set[str](), set[str]()
    for stmt in statements(function.body or ()):
        stack: list[Any] = [*expressions(stmt)]
        while stack:
            node = stack.pop()
            kind = type(node)
            if kind is Local or kind is Literal:
                continue
            if kind is Global:
                globals_.add(node.name)
                continue
            if kind is Call:
                calls.add(node.function)
            stack += operands(node)
    return globals_, calls


def outs_of(functions: Iterable[Function]) -> dict[str, tuple[int, ...]]:
    """The keys of the functions that write through parameters, and the positions of these."""
    found = {}
    for function in functions:
        places = tuple([index for index, param in enumerate(function.params) if param.direction != "in"])
        if places:
            found[function.key] = places
    return found


def assigned(function: Function, outs: Mapping[str, tuple[int, ...]]) -> set[str]:
    """The parameters and variables of a function that its statements write; not where they are declared.

    `outs` is what `outs_of` says of the module's functions.
    """
    targets: list[Expr] = []
    for stmt in statements(function.body or ()):
        if type(stmt) is Assign:
            targets.append(stmt.target)
        for call in calls_of(stmt) if outs else ():
            targets += [call.args[index] for index in outs.get(call.function, ())]
    return {variable.name for variable in map(root, targets) if variable is not None}


def fresh(name: str, taken: Container[str]) -> str:
    """`name`, or the first of `name_2`, `name_3`, … that is not taken."""
    if name not in taken:
        return name
    base, _, count = name.rpartition("_")
    if not base or not count.isdecimal():
        base = name.rstrip("_")
    number = 2
    while f"{base}_{number}" in taken:
        number += 1
    return f"{base}_{number}"


def substitute(expr: Expr, values: Mapping[str, Expr]) -> Expr:
    """`expr` with variables replaced by expressions."""

    def change(node: Expr) -> Expr:
        return values.get(node.name, node) if type(node) is Local else node

    return rewrite(expr, change)


def separate(function: Function) -> Function:
    """The function with every variable renamed that is declared where its name is visible already."""
    return rename_locals(function, (), fresh)[0]


def rename_locals(
    function: Function,
    bad: Collection[str],
    choose: Callable[[str, Container[str]], str],
    globals: Mapping[str, str] = _NONE,
    calls: Mapping[str, str] = _NONE,
) -> tuple[Function, dict[str, str]]:
    """Renames variables whose name is `bad`, or visible already where they are declared; says which.

    `choose` gives a new name that is not among those taken. The module's declarations that the function uses
    are renamed along: uniforms and constants by `globals`, the keys of functions by `calls`.
    """
    names = declared(function)
    renamer = Renamer(globals, calls)
    if bad or len(set(names)) < len(names):
        renamer.plan = _Planner(bad, choose, set(names)).function(function)
    renamed = {old: new for old, new in renamer.plan if old != new}
    if renamed or globals or calls:
        function = renamer.function(function, bool(renamed))
    return function, renamed


class _Planner:
    """Gives every declaration of a function its name, in the order of the text."""

    def __init__(self, bad: Container[str], choose: Callable[[str, Container[str]], str], taken: set[str]) -> None:
        self.bad, self.choose, self.taken = bad, choose, taken
        self.plan: list[tuple[str, str]] = []

    def function(self, function: Function) -> list[tuple[str, str]]:
        visible = set[str]()
        for param in function.params:
            self.declare(param.name, visible)
        self.block(function.body or (), visible)
        return self.plan

    def block(self, block: Block, visible: set[str]) -> None:
        for stmt in block:
            if isinstance(stmt, Declare):
                self.declare(stmt.name, visible)
            elif isinstance(stmt, If):
                self.block(stmt.then, set(visible))
                self.block(stmt.otherwise, set(visible))
            elif isinstance(stmt, While):
                self.block(stmt.body, set(visible))
            elif isinstance(stmt, For):
                inner = set(visible)
                if isinstance(stmt.init, Declare):
                    self.declare(stmt.init.name, inner)
                self.block(stmt.body, inner)

    def declare(self, name: str, visible: set[str]) -> None:
        new = name
        if name in visible or name in self.bad:
            new = self.choose(name, self.taken)
            self.taken.add(new)
        visible.add(new)
        self.plan.append((name, new))


class Renamer:
    """Rewrites a function to other names.

    The tables come first, as the lookups are all it does: it runs over every node for every target.
    """

    def __init__(self, globals: Mapping[str, str], calls: Mapping[str, str]) -> None:
        self.globals, self.calls = globals, calls
        self.plan: list[tuple[str, str]] = []
        """The old and new name of each variable, in the order of the text."""
        self.locals: dict[str, str] = {}
        """The variables in scope that have a new name."""
        self.position = -1

    def function(self, function: Function, locals: bool) -> Function:
        """The function with new names; `locals` says whether the plan holds any."""
        if function.body is None:
            return function
        if not locals:
            self.position, self.plan = -1, []
        params = function.params
        if locals:
            params = tuple([param._replace(name=self.declare(param.name)) for param in params])
        body = self.block(function.body)
        return function if body is function.body and not locals else function._replace(params=params, body=body)

    def declare(self, name: str) -> str:
        if not self.plan:
            return name
        self.position += 1
        old, new = self.plan[self.position]
        if old != new:
            self.locals[old] = new
        else:
            self.locals.pop(old, None)
        return new

    def expression(self, expr: Any) -> Any:
        """The expression with new names."""
        kind = type(expr)
        if kind is Local:
            new = self.locals.get(expr.name)
            return expr if new is None else Local(expr.type, new, expr.span)
        if kind is Literal:
            return expr
        if kind is Binary:
            left, right = self.expression(expr.left), self.expression(expr.right)
            if left is expr.left and right is expr.right:
                return expr
            return Binary(expr.type, expr.op, left, right, expr.span)
        if kind is Global:
            new = self.globals.get(expr.name)
            return expr if new is None else Global(expr.type, new, expr.span)
        if kind is Intrinsic or kind is Construct or kind is Call:
            args, old = tuple([self.expression(arg) for arg in expr.args]), expr.args
            same = all(one is other for one, other in zip(args, old, strict=True))
            if kind is Call:
                key = self.calls.get(expr.function)
                if key is not None or not same:
                    return Call(expr.type, key or expr.function, args, expr.span)
            if same:
                return expr
            if kind is Construct:
                return Construct(expr.type, args, expr.span)
            return Intrinsic(expr.type, expr.name, args, expr.span)
        old = operands(expr)
        parts = tuple([self.expression(part) for part in old])
        same = all(one is other for one, other in zip(parts, old, strict=True))
        return expr if same else with_operands(expr, parts)

    def scope(self, block: Block) -> Block:
        """A block with a scope of its own."""
        if not self.plan:
            return self.block(block)
        outer = dict(self.locals)
        new = self.block(block)
        self.locals = outer
        return new

    def block(self, block: Block) -> Block:
        new = [self.statement(stmt) for stmt in block]
        return block if all(one is other for one, other in zip(new, block, strict=True)) else tuple(new)

    def statement(self, stmt: Stmt) -> Stmt:
        if isinstance(stmt, Declare):
            value = self.expression(stmt.value) if stmt.value is not None else None
            name = self.declare(stmt.name)
            if value is not stmt.value or name != stmt.name:
                return Declare(name, stmt.type, value, stmt.span)
        elif isinstance(stmt, Assign):
            target, value = self.expression(stmt.target), self.expression(stmt.value)
            if target is not stmt.target or value is not stmt.value:
                return Assign(target, stmt.op, value, stmt.span)
        elif isinstance(stmt, If):
            condition = self.expression(stmt.condition)
            then, otherwise = self.scope(stmt.then), self.scope(stmt.otherwise)
            if condition is not stmt.condition or then is not stmt.then or otherwise is not stmt.otherwise:
                return If(condition, then, otherwise, stmt.span)
        elif isinstance(stmt, For):
            return self.loop(stmt)
        elif isinstance(stmt, While):
            condition, body = self.expression(stmt.condition), self.scope(stmt.body)
            if condition is not stmt.condition or body is not stmt.body:
                return While(condition, body, stmt.span)
        elif isinstance(stmt, Return):
            value = self.expression(stmt.value) if stmt.value is not None else None
            if value is not stmt.value:
                return Return(value, stmt.span)
        elif isinstance(stmt, Evaluate):
            call = self.expression(stmt.call)
            if call is not stmt.call:
                return Evaluate(call, stmt.span)
        elif isinstance(stmt, Assume):
            condition = self.expression(stmt.condition)
            if condition is not stmt.condition:
                return Assume(condition, stmt.span)
        return stmt

    def loop(self, stmt: For) -> For:
        outer = dict(self.locals)
        init = self.statement(stmt.init) if stmt.init is not None else None
        condition = self.expression(stmt.condition) if stmt.condition is not None else None
        step = self.statement(stmt.step) if stmt.step is not None else None
        body = self.block(stmt.body)
        self.locals = outer
        new = For(init, condition, step, body, stmt.span)
        return stmt if all(one is other for one, other in zip(new, stmt, strict=True)) else new
