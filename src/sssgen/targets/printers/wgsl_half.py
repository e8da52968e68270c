"""WGSL with an f16 for every float: not a target for users; tests run it in half precision. It has only the
functions form: uniform blocks hold float32.

Builtins that WGSL has for float32 alone (texture reads, derivatives, bits of numbers) are computed in it and rounded.
"""

from __future__ import annotations

import math

from sssgen.ir import nodes as ir
from sssgen.ir.formats import FLOAT16
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.types import FLOAT, Sampler, kind_of
from sssgen.support.diagnostics import Diagnostic, SssgenError, failure
from sssgen.targets.descriptor import Target
from sssgen.targets.printers.number_text import shortest
from sssgen.targets.printers.printed_lines import Line
from sssgen.targets.printers.printer import PRIMARY
from sssgen.targets.printers.wgsl import WgslPrinter
from sssgen.targets.registry import load
from sssgen.targets.uniform_layout import Member


class WgslHalfPrinter(WgslPrinter):
    """Literals are halves, and calls of builtins that exist in float32 alone convert their arguments and result."""

    def __init__(self, target: Target, module: ir.Module) -> None:
        super().__init__(target, module)
        self.single = WgslPrinter(load(target.half_of), module)

    def literal(self, literal: ir.Literal) -> str:
        if literal.type != FLOAT:
            return super().literal(literal)
        nearest = FLOAT16.rounded(float(literal.value))
        if math.isinf(nearest):
            message = f"{literal.value:.9g} is beyond the largest half, {FLOAT16.largest:g}"
            raise SssgenError([Diagnostic("error", message, literal.span, "write the formula with smaller numbers")])
        return half_text(nearest)

    def intrinsic(self, call: ir.Intrinsic) -> tuple[str, int]:
        if not in_single(call.name):
            return super().intrinsic(call)
        text, binding = self.single.intrinsic(call._replace(args=tuple([self.widened(arg) for arg in call.args])))
        return (f"{self.type(call.type)}({text})", PRIMARY) if kind_of(call.type) == "float" else (text, binding)

    def widened(self, arg: ir.Expr) -> ir.Expr:
        """An argument in float32, as a variable with the argument's text for a name, which is printed unchanged."""
        if isinstance(arg.type, Sampler):
            return arg
        text = self.expr(arg)
        if kind_of(arg.type) == "float":
            text = f"{self.single.type(arg.type)}({text})"
        return ir.Local(arg.type, text, arg.span)

    def print_uniforms(self, members: list[Member]) -> list[Line]:
        raise failure("in half precision there are functions only, no whole shader", "sssgen eval runs functions")


def in_single(name: str) -> bool:
    """Whether WGSL has the builtin for float32 alone."""
    return BUILTINS[name].float32_bits or BUILTINS[name].reads_neighbours_or_textures


def half_text(value: float) -> str:
    """A finite half in WGSL: the shortest decimal that reads back to it."""
    return f"{shortest(value, FLOAT16) if value else math.copysign(0.0, value)}h"
