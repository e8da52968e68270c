"""The local names of a function: finding, replacing and renaming them. Used by the passes that move or name code.

In the IR no visible variable is hidden by another; sibling blocks may use one name each. A pass that moves statements
to another block puts this right again with `separate`.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator, Mapping

from ..ir.nodes import Assign, Block, Declare, Evaluate, Expr, For, Function, If, Local, Return, Stmt, While
from ..ir.walk import RewriteExpr, inner_statements, rewrite


def declared(function: Function) -> set[str]:
    """The names of a function's parameters and of all its variables."""
    names = {param.name for param in function.params}
    stack = list(function.body or ())
    while stack:
        stmt = stack.pop()
        if isinstance(stmt, Declare):
            names.add(stmt.name)
        elif isinstance(stmt, (If, For, While)):
            stack.extend(inner_statements(stmt))
    return names


def fresh(name: str, taken: Container[str]) -> str:
    """`name`, or the first of `name_2`, `name_3`, … that is not taken."""
    new, count = name, 2
    while new in taken:
        new, count = f"{name.rstrip('_')}_{count}", count + 1
    return new


def substitute(expr: Expr, values: Mapping[str, Expr]) -> Expr:
    """`expr` with variables replaced by expressions."""

    def change(node: Expr) -> Expr:
        return values.get(node.name, node) if type(node) is Local else node

    return rewrite(expr, change)


def separate(function: Function) -> Function:
    """The function with every variable renamed that stands where its name is visible already."""
    return rename_locals(function, lambda name: False, fresh)[0]


def rename_locals(
    function: Function,
    bad: Callable[[str], bool],
    choose: Callable[[str, Container[str]], str],
    change: RewriteExpr | None = None,
) -> tuple[Function, dict[str, str]]:
    """Renames variables whose name is `bad`, or visible already where they are declared; says which.

    `choose` gives a new name that is not among those taken. `change` is applied to the nodes of all expressions that
    are not local names.
    """
    planner = _Planner(function, bad, choose)
    renamed = {old: new for old, new in planner.plan if old != new}
    if not renamed and change is None:
        return function, renamed
    body = _Renamer(iter(planner.plan), bool(renamed), change).function(function)
    return body, renamed


class _Planner:
    """Gives every declaration of a function its name, in the order of the text."""

    def __init__(
        self, function: Function, bad: Callable[[str], bool], choose: Callable[[str, Container[str]], str]
    ) -> None:
        self.function, self.bad, self.choose = function, bad, choose
        self.plan: list[tuple[str, str]] = []
        self.taken: set[str] | None = None
        visible = set[str]()
        for param in function.params:
            self.declare(param.name, visible)
        self.block(function.body or (), visible)

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
        if name in visible or self.bad(name):
            if self.taken is None:
                self.taken = declared(self.function)
            new = self.choose(name, self.taken)
            self.taken.add(new)
        visible.add(new)
        self.plan.append((name, new))


class _Renamer:
    """Rewrites a function to the planned names."""

    def __init__(self, plan: Iterator[tuple[str, str]], renames: bool, change: RewriteExpr | None) -> None:
        self.plan, self.renames, self.inner = plan, renames, change
        self.names: dict[str, str] = {}

    def function(self, function: Function) -> Function:
        params = tuple([param._replace(name=self.declare()) for param in function.params])
        params = function.params if params == function.params else params
        body = self.block(function.body) if function.body is not None else None
        if params is function.params and body is function.body:
            return function
        return function._replace(params=params, body=body)

    def declare(self) -> str:
        old, new = next(self.plan)
        self.names[old] = new
        return new

    def change(self, node: Expr) -> Expr:
        if type(node) is Local:
            new = self.names.get(node.name, node.name)
            return node if new is node.name else node._replace(name=new)
        return node if self.inner is None else self.inner(node)

    def expression(self, expr: Expr) -> Expr:
        return rewrite(expr, self.change if self.renames or self.inner is None else self.inner)

    def scope(self, block: Block) -> Block:
        outer = dict(self.names) if self.renames else self.names
        new = self.block(block)
        self.names = outer
        return new

    def block(self, block: Block) -> Block:
        new = [self.statement(stmt) for stmt in block]
        same = all(one is other for one, other in zip(new, block, strict=True))
        return block if same else tuple(new)

    def statement(self, stmt: Stmt) -> Stmt:
        if isinstance(stmt, Declare):
            value = self.expression(stmt.value) if stmt.value is not None else None
            name = self.declare()
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
        return stmt

    def loop(self, stmt: For) -> For:
        outer = dict(self.names) if self.renames else self.names
        init = self.statement(stmt.init) if stmt.init is not None else None
        condition = self.expression(stmt.condition) if stmt.condition is not None else None
        step = self.statement(stmt.step) if stmt.step is not None else None
        body = self.block(stmt.body)
        self.names = outer
        new = For(init, condition, step, body, stmt.span)
        return stmt if all(one is other for one, other in zip(new, stmt, strict=True)) else new
