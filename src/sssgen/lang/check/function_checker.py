"""Checks functions: their signatures, overloads and bodies."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.constant_expressions import zero
from sssgen.ir.rules import returns
from sssgen.ir.signatures import resolve
from sssgen.ir.types import VOID, Sampler, spell
from sssgen.lang.check.context import FunctionContext
from sssgen.lang.check.declared_names import check_global_name, check_not_reserved
from sssgen.lang.check.name_scope import Signature
from sssgen.lang.check.statement_checker import StatementChecker
from sssgen.lang.check.type_names import array_type, holds_array, named_type
from sssgen.lang.check.wording import a_type
from sssgen.lang.syntax import tree as s
from sssgen.lang.version_rules import first_version


class FunctionChecker:
    """Checks the functions of one file."""

    def __init__(self, statements: StatementChecker) -> None:
        self.context = statements.context
        self.statements = statements
        self.defined: set[ir.Span] = set()
        """The functions with a body, by the span of their name."""

    def function(self, function: s.FunctionSyntax) -> ir.Function:
        """Checks a function and declares it; a prototype has no body in the IR either."""
        outer = self.context.function
        try:
            return self._function(function)
        finally:
            self.context.function = outer

    def _function(self, function: s.FunctionSyntax) -> ir.Function:
        context, name = self.context, function.name
        check_global_name(context, name, overloads=True)
        result, quantity = named_type(context, function.result)
        context.function = FunctionContext(result, quantity)
        params = tuple([self.parameter(index, param) for index, param in enumerate(function.params)])
        declaration = ir.Function(name.text, params, result, quantity, None, function.doc, name.span)
        if context.plain and name.text == "main" and (params or result != VOID):
            raise context.fail(name.span, "main takes nothing and returns nothing", "write void main()")
        if context.es and not name.span.file.startswith("intrinsics/"):
            self.check_es(declaration)
        self.declare(declaration, function)
        if function.body is None:
            return declaration
        errors = len(context.reporter.diagnostics)
        if context.plain and context.es < 300 and not context.language.desktop:
            context.function.scopes.push()  # GLSL ES 1.00 lets a variable hide a parameter
        body = self.statements.statements(function.body.statements)
        reaches_end = not returns(body)
        if result != VOID and not returns(body[-1:]) and (context.plain or not reaches_end):
            # GLSL leaves this value undefined; naga asks for it also where what returned is not the last statement
            body = (*body, ir.Return(zero(result, name.span), name.span))
        is_correct = len(context.reporter.diagnostics) == errors and not context.function.has_faults
        if result != VOID and not returns(body) and is_correct:
            message = f"{name.text} can end without returning {a_type(result)}"
            context.reporter.error(name.span, message, "add a return at its end")
        return declaration._replace(body=body)

    def check_es(self, function: ir.Function) -> None:
        """Reports what GLSL ES does not let a function be."""
        context, name = self.context, function.name
        first = first_version(name)
        if context.es >= 300 and 0 < first <= context.es:
            hint = "give it another name: from version 3.00 on GLSL ES does not allow this"
            raise context.fail(function.span, f"'{name}' is a builtin function", hint)
        if context.es == 100:
            if first == 100 and resolve(name, [param.type for param in function.params]) is not None:
                raise context.fail(function.span, f"'{function.key}' is a builtin function", "give it another name")
            if holds_array(function.result):
                message = f"a function of GLSL ES 1.00 cannot return {a_type(function.result)}, which has an array"
                raise context.fail(function.span, message, "return it by an out parameter, or write #version 300 es")

    def parameter(self, index: int, param: s.Parameter) -> ir.Param:
        """Checks and declares a parameter."""
        context = self.context
        type_, quantity = named_type(context, param.type)
        type_ = array_type(context, type_, param.lengths)
        if type_ == VOID or (isinstance(type_, Sampler) and param.direction != "in"):
            raise context.fail(param.type.span, f"a parameter cannot be '{param.direction} {spell(type_)}'")
        name, scopes = param.name, context.function.scopes
        if name is None:
            variable = scopes.invent(f"unnamed_{index + 1}", type_)
            return ir.Param(variable.ir_name, type_, param.direction, quantity, param.type.span)
        check_not_reserved(context, name)
        declared = scopes.declare(name.text, type_, quantity, not (param.const and context.plain))
        if declared is None:
            raise context.fail(name.span, f"parameter '{name.text}' is declared twice")
        return ir.Param(declared.ir_name, type_, param.direction, quantity, name.span)

    def declare(self, function: ir.Function, written: s.FunctionSyntax) -> None:
        """Declares a function. A prototype and the definition must agree in everything but parameter names."""
        context, span, has_body = self.context, function.span, written.body is not None
        constants = tuple([param.const for param in written.params]) if context.es else ()
        overloads, new = context.functions.setdefault(function.name, []), _signature(function, constants)
        earlier = next((signature for signature in overloads if signature.key == function.key), None)
        if earlier is not None:
            elsewhere = f" of {earlier.span.file}" if earlier.span.file != span.file else ""
            there = f"the first is at line {earlier.span.line}{elsewhere}"
            if has_body and earlier.span in self.defined:
                raise context.fail(span, f"{function.key} is already defined", there)
            if earlier._replace(names=new.names, span=new.span) != new:
                message = f"{function.key} differs from its first declaration"
                raise context.fail(span, message, f"{there}; make both agree")
            if not has_body:
                if context.es == 100:
                    raise context.fail(span, f"{function.key} is already declared", f"{there}; leave this line out")
                return
            overloads.remove(earlier)
        overloads.append(new)
        if has_body:
            self.defined.add(span)

    def include(self, function: ir.Function) -> None:
        """Declares a function of an included module."""
        self.context.functions.setdefault(function.name, []).append(_signature(function))
        if function.body is not None:
            self.defined.add(function.span)

    def define_zeros(self, function: ir.Function) -> ir.Function:
        """A body of zeros for a function that the including file must define, with a warning."""
        span = function.span
        message = f"'{function.name}' is declared and called, but has no body in this file: it returns zeros"
        hint = "write its body in the translation, or include the file that defines it"
        self.context.reporter.warn(span, message, hint)
        body: list[ir.Stmt] = [
            ir.Assign(ir.Local(param.type, param.name, span), "", zero(param.type, span), span)
            for param in function.params
            if param.direction == "out"
        ]
        if function.result != VOID:
            body.append(ir.Return(zero(function.result, span), span))
        return function._replace(body=tuple(body), doc=function.doc or "Write this: the file only declares it.")


def _signature(function: ir.Function, constants: tuple[bool, ...] = ()) -> Signature:
    params = function.params
    return Signature(
        function.key,
        tuple(param.name for param in params),
        tuple(param.type for param in params),
        tuple(param.direction for param in params),
        tuple(param.quantity for param in params),
        function.result,
        function.quantity,
        function.span,
        constants,
    )
