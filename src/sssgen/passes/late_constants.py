"""Has the device compute constants without a finite value: 1.0 / 0.0, log(-1.0), 1 << 32.

Why: GLSL leaves their value to the device, and a program may not depend on it; but WGSL refuses a module that holds
one. Their operands are read from module variables, which no compiler takes for constants. Place: where the text stays
as its author wrote it, before module variables get their initial values.
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.transform import rewrite, rewrite_module
from sssgen.ir.types import spell
from sssgen.ir.walk import operands, subexpressions, with_operands
from sssgen.passes.scopes import claim, names_of
from sssgen.passes.undefined_constants import ConstantChecker
from sssgen.passes.unsupported import Note

_NAME = "late"
_HINT = "the device computes it; another device may have another value"


def late_constants(module: ir.Module) -> tuple[ir.Module, list[Note]]:
    """The module without constant expressions that have no value, and a note for each of these."""
    checker = ConstantChecker(module, partly=True)
    notes = [Note(message, span, _HINT) for message, span in checker.undefined.values()]
    return (_Late(module, checker).result() if notes else module), notes


class _Late:
    """The rewriting of one module."""

    def __init__(self, module: ir.Module, checker: ConstantChecker) -> None:
        self.module, self.checker = module, checker
        self.taken = names_of(module)
        self.operands: dict[str, ir.Variable] = {}
        """By the type and the value, as text."""

    def result(self) -> ir.Module:
        module = rewrite_module(self.module, self.change, self.restate)
        kept, computed = [], dict[str, ir.Variable]()
        for constant in module.constants:
            value = rewrite(constant.value, self.change)
            if value is constant.value and not _reads(value, computed):
                kept.append(constant)
            else:
                name, type_, _, span = constant
                computed[name] = ir.Variable(name, type_, "private", value, "", "", -1, "", span)
        own = [
            variable._replace(value=rewrite(variable.value, self.change)) if variable.value is not None else variable
            for variable in module.variables
        ]
        variables = (*self.operands.values(), *computed.values(), *own)
        return module._replace(constants=tuple(kept), variables=variables)

    def change(self, expr: ir.Expr) -> ir.Expr:
        """An expression without a value, with its operands from variables."""
        if expr.span not in self.checker.undefined or not isinstance(expr, ir.Binary | ir.Intrinsic | ir.Construct):
            return expr
        return with_operands(expr, tuple([self.operand(operand) for operand in operands(expr)]))

    def restate(self, stmt: ir.Stmt) -> ir.Block | None:
        """An assignment such as `x /= 0`, likewise."""
        if isinstance(stmt, ir.Assign) and stmt.op and stmt.span in self.checker.undefined:
            return (stmt._replace(value=self.operand(stmt.value)),)
        return None

    def operand(self, operand: ir.Expr) -> ir.Expr:
        """The variable that holds an operand; an operand that is no constant stays."""
        value = self.checker.value(operand)
        if value is None:
            return operand
        key = f"{spell(operand.type)} {value!r}"
        if key not in self.operands:
            name = claim(_NAME, self.taken)
            variable = ir.Variable(name, operand.type, "private", operand, "", "", -1, "", operand.span)
            self.operands[key] = variable
        return ir.Global(operand.type, self.operands[key].name, operand.span)


def _reads(value: ir.Expr, variables: dict[str, ir.Variable]) -> bool:
    return any(isinstance(part, ir.Global) and part.name in variables for part in subexpressions(value))
