"""Masks: the lanes in which a bool variable is true, or false. Used by `predicate`."""

from __future__ import annotations

from typing import NamedTuple

from sssgen.ir.nodes import Binary, Expr, Local, Select, Span, Unary
from sssgen.ir.types import BOOL


class Mask(NamedTuple):
    """The lanes where a bool variable is true, or where it is false."""

    name: str
    inverted: bool = False

    def expr(self, span: Span) -> Expr:
        local = Local(BOOL, self.name, span)
        return Unary(BOOL, "!", local, span) if self.inverted else local

    def also(self, condition: Expr) -> Expr:
        """The lanes of the mask in which a condition holds."""
        return Binary(BOOL, "&&", self.expr(condition.span), condition, condition.span)

    def choose(self, inside: Expr, outside: Expr, span: Span) -> Expr:
        """One value in the lanes of the mask, another outside."""
        if self.inverted:
            inside, outside = outside, inside
        return Select(inside.type, Local(BOOL, self.name, span), inside, outside, span)


def without_not(condition: Expr) -> tuple[Expr, bool]:
    """A condition without its outer `!`, and whether these leave it negated."""
    inverted = False
    while isinstance(condition, Unary):
        condition, inverted = condition.operand, not inverted
    return condition, inverted
