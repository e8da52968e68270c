"""The forms in which a target has builtins: a function of its own, an operator, or a polyfill. Used by `legalise`."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from sssgen.ir import signatures
from sssgen.ir.constant_evaluation import Value
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.nodes import Binary, Construct, Expr, Intrinsic, Module, Unary
from sssgen.ir.types import Sampler, Scalar, Type, Vector, kind_of
from sssgen.passes.legal.part_stores import Keep
from sssgen.passes.substitute import inline, return_expression
from sssgen.passes.unsupported import MissingBuiltin

Polyfill = Callable[[str, Sequence[Type]], Module]
"""Gives the module whose last function implements a builtin for these argument types."""


class BuiltinForms:
    """The builtins in one dialect of a language."""

    def __init__(self, dialect: str, polyfill: Polyfill) -> None:
        self.dialect = dialect
        self.language = dialect.partition("-")[0]
        self.polyfill = polyfill
        self.texts: dict[tuple[str, tuple[Type, ...]], str] = {}

    def text(self, name: str, types: tuple[Type, ...]) -> str:
        """How the target writes a builtin of these types; '' means by a polyfill."""
        text = self.texts.get((name, types))
        if text is None:
            text = self.texts[name, types] = signatures.text(name, self.dialect, types)
        return text

    def is_constant(self, name: str) -> bool:
        """Whether every compiler of the language computes it in a constant at file scope."""
        return self.language not in BUILTINS[name].not_constant

    def is_outside(self, call: Intrinsic, value: Callable[[Expr], Value | None]) -> bool:
        """Whether constant integers of a call lie outside its domain, whatever the other arguments are; `value` gives
        those of constants."""
        row = BUILTINS[call.name]
        if row.defined is None or not row.samples.integers:
            return False
        given = {index: value(call.args[index]) for index in row.samples.integers}
        if not any(given.values()):
            return False
        numbers = [(given.get(index) or (0,))[0] for index in range(len(call.args))]
        return not row.defined(None, *numbers)

    def spell_call(self, call: Intrinsic, text: str) -> Expr:
        """A call of a builtin that has this text: as an operator, or with the arguments that the function takes."""
        if text.startswith("op:"):
            if len(call.args) == 1:
                return Unary(call.type, text[3:], call.args[0], call.span)
            return Binary(call.type, text[3:], call.args[0], call.args[1], call.span)
        if not isinstance(call.type, Vector) or self.language not in BUILTINS[call.name].splat:
            return call
        args = tuple(
            Construct(Vector(kind_of(arg.type), call.type.size), (arg,), arg.span)
            if isinstance(arg.type, Scalar) and kind_of(arg.type) == call.type.kind
            else arg
            for arg in call.args
        )
        return call._replace(args=args)

    def module(self, call: Intrinsic) -> Module:
        """The polyfill of a builtin without a text. Raises MissingBuiltin."""
        try:
            return self.polyfill(call.name, [arg.type for arg in call.args])
        except KeyError:
            raise MissingBuiltin(call.name, call.span) from None

    def inlinable(self, call: Intrinsic, module: Module, keep: Keep) -> Intrinsic:
        """A call whose polyfill can be inlined, if it is an expression and an argument has to be constant: those of
        functions are not."""
        constants = BUILTINS[call.name].constants([arg.type for arg in call.args])
        if not constants or return_expression(module) is None or inline(module, call.args, call.span) is not None:
            return call
        fixed = [isinstance(arg.type, Sampler) or index in constants for index, arg in enumerate(call.args)]
        kept = [arg if skip else keep(arg, "place") for arg, skip in zip(call.args, fixed, strict=True)]
        return call._replace(args=tuple(kept))
