"""Rewriting IR: one transformer that knows every statement, and short functions for changes of expressions alone.

A node keeps its identity when nothing below it changed, so that a pass with nothing to do costs no memory.
"""

from __future__ import annotations

from collections.abc import Callable
from operator import is_
from typing import TypeAlias

from sssgen.ir import nodes as ir
from sssgen.ir.walk import operands, with_operands

RewriteExpr: TypeAlias = Callable[[ir.Expr], ir.Expr]
RewriteStmt: TypeAlias = Callable[[ir.Stmt], "ir.Block | None"]


class Transformer:
    """Rebuilds functions. A pass is a subclass that overrides the methods of the nodes that it changes.

    The method of a statement returns the new statement, or None to remove it. Statements that a method appends to
    `out` are executed before the new one.
    """

    def __init__(self) -> None:
        self.out: list[ir.Stmt] = []
        """The new statements of the current block."""
        self.scope: dict[str, ir.Declare | ir.Param] = {}
        """The variables that are visible at the current statement, with their new declarations."""

    def function(self, function: ir.Function) -> ir.Function:
        if function.body is None:
            return function
        self.scope = {param.name: param for param in function.params}
        body = self.block(function.body)
        return function if body is function.body else function._replace(body=body)

    # Statements

    def block(self, block: ir.Block) -> ir.Block:
        """The statements of a block, in the current scope."""
        outer, self.out = self.out, []
        for stmt in block:
            new = self.statement(stmt)
            if new is not None:
                self.out.append(new)
        result, self.out = self.out, outer
        return block if len(result) == len(block) and all(map(is_, result, block)) else tuple(result)

    def inner(self, block: ir.Block) -> ir.Block:
        """A block with a scope of its own."""
        if not block:
            return block
        outer, self.scope = self.scope, self.scope.copy()
        new = self.block(block)
        self.scope = outer
        return new

    def statement(self, stmt: ir.Stmt) -> ir.Stmt | None:
        if isinstance(stmt, ir.Declare):
            return self.declare(stmt)
        if isinstance(stmt, ir.Assign):
            return self.assign(stmt)
        if isinstance(stmt, ir.Return):
            return self.leave(stmt)
        if isinstance(stmt, ir.If):
            return self.branch(stmt)
        if isinstance(stmt, ir.For):
            return self.for_loop(stmt)
        if isinstance(stmt, ir.Evaluate):
            return self.evaluate(stmt)
        if isinstance(stmt, ir.While):
            return self.while_loop(stmt)
        if isinstance(stmt, ir.Assume):
            return self.assume(stmt)
        if isinstance(stmt, ir.MemoryOperation):
            return self.memory(stmt)
        return stmt

    def declare(self, stmt: ir.Declare) -> ir.Stmt | None:
        value = self.expression(stmt.value) if stmt.value is not None else None
        new = stmt if value is stmt.value else ir.Declare(stmt.name, stmt.type, value, stmt.span)
        self.scope[stmt.name] = new
        return new

    def assign(self, stmt: ir.Assign) -> ir.Stmt | None:
        target, value = self.expression(stmt.target), self.expression(stmt.value)
        same = target is stmt.target and value is stmt.value
        return stmt if same else ir.Assign(target, stmt.op, value, stmt.span)

    def leave(self, stmt: ir.Return) -> ir.Stmt | None:
        value = self.expression(stmt.value) if stmt.value is not None else None
        return stmt if value is stmt.value else ir.Return(value, stmt.span)

    def evaluate(self, stmt: ir.Evaluate) -> ir.Stmt | None:
        call = self.expression(stmt.call)
        return stmt if call is stmt.call else ir.Evaluate(call, stmt.span)

    def assume(self, stmt: ir.Assume) -> ir.Stmt | None:
        condition = self.expression(stmt.condition)
        return stmt if condition is stmt.condition else ir.Assume(condition, stmt.span)

    def memory(self, stmt: ir.MemoryOperation) -> ir.Stmt | None:
        args = tuple([self.expression(arg) for arg in stmt.args])
        result = self.expression(stmt.result) if stmt.result is not None else None
        same = result is stmt.result and all(map(is_, args, stmt.args))
        return stmt if same else ir.MemoryOperation(stmt.name, args, result, stmt.span)

    def branch(self, stmt: ir.If) -> ir.Stmt | None:
        condition = self.expression(stmt.condition)
        then, otherwise = self.inner(stmt.then), self.inner(stmt.otherwise)
        same = condition is stmt.condition and then is stmt.then and otherwise is stmt.otherwise
        return stmt if same else ir.If(condition, then, otherwise, stmt.span)

    def for_loop(self, stmt: ir.For) -> ir.Stmt | None:
        outer, self.scope = self.scope, self.scope.copy()
        init = self.header(stmt.init)
        condition = self.expression(stmt.condition) if stmt.condition is not None else None
        body, step = self.inner(stmt.body), self.header(stmt.step)
        self.scope = outer
        same = init is stmt.init and condition is stmt.condition and body is stmt.body and step is stmt.step
        return stmt if same else ir.For(init, condition, step, body, stmt.span)

    def header(self, stmt: ir.Stmt | None) -> ir.Stmt | None:
        """The init or step of a loop. What a step appends to `out` is lost to the loop."""
        return self.statement(stmt) if stmt is not None else None

    def while_loop(self, stmt: ir.While) -> ir.Stmt | None:
        condition, body = self.expression(stmt.condition), self.inner(stmt.body)
        return stmt if condition is stmt.condition and body is stmt.body else ir.While(condition, body, stmt.span)

    # Expressions

    def expression(self, expr: ir.Expr) -> ir.Expr:
        """An expression with its operands transformed."""
        if type(expr) is ir.Binary:
            left, right = self.expression(expr.left), self.expression(expr.right)
            same = left is expr.left and right is expr.right
            return expr if same else ir.Binary(expr.type, expr.op, left, right, expr.span)
        old = operands(expr)
        if not old:
            return expr
        new = tuple([self.expression(operand) for operand in old])
        return expr if all(map(is_, old, new)) else with_operands(expr, new)


class _Rewriter(Transformer):
    """Passes each expression through one function, and each statement through another."""

    def __init__(self, change: RewriteExpr, restate: RewriteStmt | None) -> None:
        super().__init__()
        self.change, self.restate = change, restate

    def statement(self, stmt: ir.Stmt) -> ir.Stmt | None:
        new = super().statement(stmt)
        block = self.restate(new) if self.restate is not None and new is not None else None
        if block is None:
            return new
        self.out += block[:-1]
        return block[-1] if block else None

    def expression(self, expr: ir.Expr) -> ir.Expr:
        return rewrite(expr, self.change)


def rewrite(expr: ir.Expr, change: RewriteExpr) -> ir.Expr:
    """Rebuilds `expr` bottom-up, passing every node through `change`."""
    old = operands(expr)
    if old:
        new = tuple([rewrite(operand, change) for operand in old])
        if not all(map(is_, old, new)):
            expr = with_operands(expr, new)
    return change(expr)


def rewrite_block(block: ir.Block, change: RewriteExpr, restate: RewriteStmt | None = None) -> ir.Block:
    """Rewrites every statement of a block: its expressions, then its inner blocks, then the statement itself.

    `restate` may return a block to put in the statement's place, or None to keep it.
    """
    return _Rewriter(change, restate).block(block)


def rewrite_function(function: ir.Function, change: RewriteExpr, restate: RewriteStmt | None = None) -> ir.Function:
    """Rewrites a function's body."""
    return _Rewriter(change, restate).function(function)


def rewrite_module(module: ir.Module, change: RewriteExpr, restate: RewriteStmt | None = None) -> ir.Module:
    """Rewrites the body of every function (not the values of constants)."""
    functions = tuple([rewrite_function(function, change, restate) for function in module.functions])
    same = all(map(is_, functions, module.functions))
    return module if same else module._replace(functions=functions)
