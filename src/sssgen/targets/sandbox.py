"""Jinja's sandbox with a bound on what a template may do: neither its time nor its memory is without end.

Work is counted, not timed, so that a template is refused on every machine or on none. A round of a loop, a call and an
included file cost `STEP` and the characters that stand in them; what is printed, kept in a variable or handed to a
function or a filter costs its size. What would make much of little at one stroke (`"x" * 10**9`) is refused
before it is done.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from contextvars import ContextVar
from functools import wraps
from typing import Any

from jinja2 import Environment, nodes, pass_context
from jinja2.exceptions import SecurityError
from jinja2.runtime import Context
from jinja2.sandbox import SandboxedEnvironment

MAX_WORK = 4 << 20
"""What one file may cost. The project's own templates cost up to a few ten thousand."""

STEP = 8
"""What one round or one call costs: about as long as so many characters take."""

MAX_MADE = 1 << 25
"""How large, at the utmost, what one operation makes may be, in characters or elements."""

MAX_BITS = 1024
"""How large a power may be."""

_BODIES = (nodes.Block, nodes.Macro, nodes.CallBlock, nodes.For)
_MULTIPLY = {"batch", "center", "format", "indent", "join", "pprint", "replace", "slice", "tojson", "wordwrap"}
"""The filters whose result may be as large as the product of what they are given."""
_PAID: dict[type[nodes.Node], str] = {
    nodes.Assign: "node", nodes.Compare: "expr", nodes.Operand: "expr", nodes.Test: "node", nodes.For: "iter",
    nodes.Getitem: "node",
}  # fmt: skip
"""The nodes that take as long as what they are given is large, and the field that holds it."""
_JINJAS = (Context, Environment, nodes.EvalContext)
"""What filters may be given by Jinja itself."""
_WIDE = re.compile(r"[0-9]{5}")

_left: ContextVar[int] = ContextVar("left", default=MAX_WORK)


class Sandbox(SandboxedEnvironment):
    """An environment for templates that nobody has looked at. `begin` stands before each rendering."""

    intercepted_binops = frozenset({"+", "*", "**", "%"})

    def __init__(self, **options: Any) -> None:
        super().__init__(finalize=_spent_on, **options)
        self.globals.pop("lipsum")  # makes any amount of text, another each time
        self.filters = {name: _guarded(name, one) for name, one in self.filters.items()}
        self.filters["spend"] = pass_context(lambda context, cost: _spend(cost))  # not to be computed beforehand
        self.filters["spent_on"] = pass_context(lambda context, value: _spent_on(value))

    def _parse(self, source: str, name: str | None, filename: str | None) -> nodes.Template:
        tree = super()._parse(source, name, filename)
        for joined in list(tree.find_all(nodes.Concat)):
            joined.nodes = [_filtered(part, "spent_on") for part in joined.nodes]
        for paid in list(tree.find_all(tuple(_PAID))):
            if not isinstance(paid, nodes.Getitem) or isinstance(paid.arg, nodes.Slice):
                field = _PAID[type(paid)]
                setattr(paid, field, _filtered(getattr(paid, field), "spent_on"))
        for body in [tree, *tree.find_all(_BODIES)]:
            _charge(body)
        return tree.set_environment(self)  # type: ignore[return-value]  # it gives the node itself back

    def call(__self, __context: Context, __obj: Any, *args: Any, **kwargs: Any) -> Any:
        owner = getattr(getattr(__obj, "__wrapped__", __obj), "__self__", None)
        given = [owner if isinstance(owner, str | bytes | list) else "", *args, *kwargs.values()]
        _check(given, getattr(__obj, "__name__", "") in ("format", "format_map"))
        return _spent_on(super().call(__context, __obj, *args, **kwargs))

    def call_binop(self, context: Context, operator: str, left: Any, right: Any) -> Any:
        numbers = isinstance(left, int | float) and isinstance(right, int | float)
        if operator == "**" and isinstance(left, int) and left.bit_length() * abs(right) > MAX_BITS:
            raise SecurityError("this makes a number that is too large")
        if operator in ("*", "%") and not numbers:
            _check([left, right], operator == "%")
        return _spent_on(super().call_binop(context, operator, left, right))


def begin() -> None:
    """Gives the rendering that comes its whole budget."""
    _left.set(MAX_WORK)


def _charge(body: nodes.Node) -> None:
    """Lets every run of a body cost what stands in it."""
    cost = STEP + sum(len(data.data) for data in body.find_all(nodes.TemplateData))
    statement = nodes.ExprStmt(_filtered(nodes.Const(cost), "spend"), lineno=body.lineno)
    body.body.insert(0, statement)  # type: ignore[attr-defined]  # each of _BODIES has one


def _filtered(value: nodes.Expr, name: str) -> nodes.Filter:
    return nodes.Filter(value, name, [], [], None, None, lineno=value.lineno)


def _guarded(name: str, filter_: Callable[..., Any]) -> Callable[..., Any]:
    """The filter, its arguments looked at before and its result counted."""

    @wraps(filter_)
    def guarded(*args: Any, **kwargs: Any) -> Any:
        given = [one for one in (*args, *kwargs.values()) if not isinstance(one, _JINJAS)]
        if name in _MULTIPLY:
            _check(given, name == "format")
        else:
            _spend(STEP + sum(map(_size, given)))
        return _spent_on(filter_(*args, **kwargs))

    return guarded


def _check(given: list[Any], formats: bool) -> None:
    """Refuses an operation whose result may be too large: at most the product of the first and another of its parts."""
    sizes = [_size(value) for value in given]
    factors = [abs(value) if isinstance(value, int) else size for value, size in zip(given, sizes, strict=True)]
    wide = formats and isinstance(given[0], str) and _WIDE.search(given[0])
    if wide or (factors[0] + 1) * (1 + max(factors[1:], default=0)) > MAX_MADE:
        raise SecurityError("this may make a text or a list that is too large")
    _spend(STEP + sum(sizes))


def _spent_on(value: Any) -> Any:
    """The value, its size paid for."""
    _spend(_size(value))
    return value


def _spend(cost: int) -> None:
    left = _left.get() - cost
    _left.set(left)
    if left < 0:
        raise SecurityError("the template does too much: its loops have too many rounds, or its texts are too long")


def _size(value: Any) -> int:
    """The characters and elements in a value, those of the lists in it, too; no more are counted than may be made."""
    count, waiting = 0, [value]
    while waiting and count <= MAX_WORK:
        part = waiting.pop()
        if isinstance(part, str | bytes | range):
            count += len(part)
        elif isinstance(part, int):
            count += 1 + part.bit_length() // 3
        elif isinstance(part, list | tuple | set | frozenset):
            count += 1 + len(part)
            waiting.extend(part)
        elif isinstance(part, Mapping):
            count += 1 + len(part)
            waiting.extend(part.keys())
            waiting.extend(part.values())
    return count
