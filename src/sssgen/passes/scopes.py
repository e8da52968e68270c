"""The names in a function: finding, replacing and renaming them. Used by the passes that move or name code.

In the IR no visible variable is hidden by another; sibling blocks may use one name each. A pass that moves
statements to another block restores this with `separate`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Container, Iterable, Mapping
from typing import Any

from sssgen.ir import nodes as ir
from sssgen.ir.transform import Transformer
from sssgen.ir.types import spell
from sssgen.ir.walk import calls_of, inner_parts, inner_statements, root, statements, written_places

_NONE: Mapping[str, str] = {}


def declared(function: ir.Function) -> list[str]:
    """The names of a function's parameters and variables, each as often as it is declared."""
    names = [param.name for param in function.params]
    stack = list(function.body or ())
    while stack:
        stmt = stack.pop()
        if isinstance(stmt, ir.Declare):
            names.append(stmt.name)
        elif isinstance(stmt, (ir.If, ir.For, ir.While)):
            stack.extend(inner_statements(stmt))
    return names


def globals_of(function: ir.Function) -> set[str]:
    """The names of the uniforms, constants and module variables that a function mentions."""
    return {part.name for part in inner_parts(function.body or (), ir.Global)}


def names_of(module: ir.Module) -> set[str]:
    """The names that a module declares, those of structs among them."""
    declared = (module.constants, module.uniforms, module.variables, module.functions)
    names = {declaration.name for group in declared for declaration in group}
    return names | {spell(struct.type) for struct in module.structs}


def qualified_name(variable: ir.Local | ir.Global) -> str:
    """A variable's name, with `$` for one of the module, as in the IR's text form."""
    return variable.name if isinstance(variable, ir.Local) else f"${variable.name}"


def out_positions(function: ir.Function) -> tuple[int, ...]:
    """The positions of a function's out and inout parameters."""
    return tuple([index for index, param in enumerate(function.params) if param.direction != "in"])


def outs_of(functions: Iterable[ir.Function]) -> dict[str, tuple[int, ...]]:
    """The keys of the functions that write through parameters, and the positions of these."""
    return {function.key: positions for function in functions if (positions := out_positions(function))}


def assigned(function: ir.Function, outs: Mapping[str, tuple[int, ...]]) -> set[str]:
    """The parameters and variables of a function that its statements write; declarations do not count.

    `outs` is the result of `outs_of` for the module's functions.
    """
    body = function.body or ()
    targets: list[ir.Expr] = [place for stmt in statements(body) for place in written_places(stmt)]
    for call in calls_of(body) if outs else ():
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


def claim(name: str, taken: set[str]) -> str:
    """A fresh name, which is taken from now on."""
    name = fresh(name, taken)
    taken.add(name)
    return name


def separate(function: ir.Function) -> ir.Function:
    """The function with every variable renamed that is declared where its name is visible already."""
    return rename_locals(function, (), fresh)[0]


def rename_locals(
    function: ir.Function,
    bad: Collection[str],
    choose: Callable[[str, Container[str]], str],
    globals: Mapping[str, str] = _NONE,
    calls: Mapping[str, str] = _NONE,
    loop_scope: bool = True,
    taken: Iterable[str] = (),
) -> tuple[ir.Function, dict[str, str]]:
    """Renames variables whose name is `bad`, or visible already where they are declared; returns old name → new name.

    `choose` gives a new name that is not among those taken: the function's own, and those in `taken`. The module's
    declarations that the function uses are renamed with them: uniforms and constants by `globals`, the keys of
    functions by `calls`. Without `loop_scope` the variable of a loop's head is visible behind the loop for declarations
    of its block.
    """
    names = declared(function)
    if bad or len(set(names)) < len(names):
        renamer = Renamer(globals, calls, bad, choose, {*names, *taken}, loop_scope)
    elif globals or calls:
        renamer = Renamer(globals, calls)
    else:
        return function, {}
    return renamer.function(function), renamer.renamed


class Renamer(Transformer):
    """Rewrites a function to other names; variables only with `choose`. This runs over every node for every target."""

    def __init__(
        self,
        globals: Mapping[str, str],
        calls: Mapping[str, str],
        bad: Container[str] = (),
        choose: Callable[[str, Container[str]], str] | None = None,
        taken: Iterable[str] = (),
        loop_scope: bool = True,
    ) -> None:
        super().__init__()
        self.globals, self.calls = globals, calls
        self.bad, self.choose, self.taken = bad, choose, set(taken)
        self.loop_scope = loop_scope
        self.heads: set[str] = set()
        """The variables of the loops before the current statement of a block."""
        self.renamed: dict[str, str] = {}
        """The variables renamed so far: old name → new name."""

    def function(self, function: ir.Function) -> ir.Function:
        if function.body is None:
            return function
        self.scope, params = {}, []
        for param in function.params:
            name = self.new_name(param.name)
            new = self.scope[param.name] = param if name == param.name else param._replace(name=name)
            params.append(new)
        body = self.block(function.body)
        same = body is function.body and not self.renamed
        return function if same else function._replace(params=tuple(params), body=body)

    def new_name(self, name: str) -> str:
        """The name of a variable that is declared here."""
        if self.choose is None or not (name in self.scope or name in self.bad or name in self.heads):
            return name
        new = self.renamed[name] = self.choose(name, self.taken)
        self.taken.add(new)
        return new

    def block(self, block: ir.Block) -> ir.Block:
        outer, self.heads = self.heads, set()
        new = super().block(block)
        self.heads = outer
        return new

    def for_loop(self, stmt: ir.For) -> ir.Stmt | None:
        outer, self.heads = self.heads, set()  # heads may have the same variable
        new = super().for_loop(stmt)
        self.heads = outer
        if not self.loop_scope and isinstance(new, ir.For) and isinstance(new.init, ir.Declare):
            self.heads.add(new.init.name)
        return new

    def declare(self, stmt: ir.Declare) -> ir.Stmt:
        value = self.expression(stmt.value) if stmt.value is not None else None
        name = self.new_name(stmt.name)
        same = value is stmt.value and name == stmt.name
        new = self.scope[stmt.name] = stmt if same else ir.Declare(name, stmt.type, value, stmt.span)
        return new

    def expression(self, expr: Any) -> Any:
        kind = type(expr)
        if kind is ir.Local:
            new = self.scope[expr.name].name if self.renamed else expr.name
            return expr if new == expr.name else ir.Local(expr.type, new, expr.span)
        if kind is ir.Literal:
            return expr
        if kind is ir.Global:
            new = self.globals.get(expr.name, expr.name)
            return expr if new == expr.name else ir.Global(expr.type, new, expr.span)
        if kind is ir.Binary:
            left, right = self.expression(expr.left), self.expression(expr.right)
            same = left is expr.left and right is expr.right
            return expr if same else ir.Binary(expr.type, expr.op, left, right, expr.span)
        if kind is ir.Call and expr.function in self.calls:
            expr = ir.Call(expr.type, self.calls[expr.function], expr.args, expr.span)
        return super().expression(expr)
