"""Puts the body of small functions in the place of their calls.

Why: a polyfill of one expression reads better in place, and some targets cannot call every function.
Place: right after whatever brings such functions, and before `prune`, which drops those that nothing calls any more.

Only functions that are one `return` are inlined. An argument takes its parameter's place where the parameter is used at
most once, or where the argument costs nothing (a literal, a name, or components of one).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from ..ir.nodes import (
    Assign,
    Binary,
    Block,
    Call,
    Declare,
    Evaluate,
    Expr,
    For,
    Function,
    Global,
    If,
    Literal,
    Local,
    Member,
    Module,
    Return,
    Select,
    Stmt,
    Swizzle,
    While,
)
from ..ir.walk import operands, rewrite, subexpressions, with_operands
from .divergence import Summary, implicit, summaries
from .scopes import declared, fresh, substitute


class _Body(NamedTuple):
    """A function that can be inlined."""

    value: Expr
    uses: dict[str, int]
    """How often each parameter is used; one use in an arm that may not be evaluated counts as two."""
    sometimes: set[str]
    """The parameters that are used in such an arm."""
    params: tuple[str, ...]


def inline(module: Module, should_inline: Callable[[Function], bool], insist: bool = False) -> Module:
    """The module with the functions of one `return` that `should_inline` chooses put in place of their calls.

    With `insist`, arguments that cannot take their parameter's place are held in a variable before the statement;
    otherwise such a call stays. A call in a loop's own condition or step stays in any case where that is needed. The
    inlined functions themselves remain.
    """
    chosen = {
        function.key: function
        for function in module.functions
        if _expression_of(function) is not None and should_inline(function)
    }
    if not chosen:
        return module
    inliner = _Inliner(chosen, summaries(module), insist)
    functions = tuple([inliner.function(function) for function in module.functions])
    return module._replace(functions=functions)


def _expression_of(function: Function) -> Expr | None:
    """The value of a function that is one `return` and has only `in` parameters."""
    body = function.body
    if body is None or len(body) != 1 or any(param.direction != "in" for param in function.params):
        return None
    return body[0].value if isinstance(body[0], Return) else None
