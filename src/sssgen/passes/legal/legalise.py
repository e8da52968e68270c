"""Rewrites a module until the target can express every node; printing is then a table and a few methods.

Last of the passes that change structure: the others see one language-neutral form. What a target can express is its
descriptor's `[capabilities]`; which builtins it has is the intrinsic table's. Knows no target by its name. Here are the
module and its functions; `legal_statements` and `legal_expressions` rewrite what is in them.
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.types import Array
from sssgen.ir.walk import calls_of, written_root
from sssgen.passes.capabilities import Capabilities
from sssgen.passes.legal.array_results import by_out_parameter
from sssgen.passes.legal.builtin_forms import Polyfill
from sssgen.passes.legal.ends import with_return
from sssgen.passes.legal.legal_statements import LegalStatements, OutOfOrderError
from sssgen.passes.legal.part_stores import parts_of
from sssgen.passes.lift_calls import Calls, lift, order_conflicts, reads_too_late
from sssgen.passes.scopes import assigned
from sssgen.passes.stage.storage_layout import byte_buffers
from sssgen.passes.unsupported import Unsupported


def legalise(module: ir.Module, dialect: str, capabilities: Capabilities, polyfill: Polyfill) -> ir.Module:
    """The module as the target can express it. Raises Unsupported."""
    return _Legaliser(module, dialect, capabilities, polyfill).run()


class _Legaliser(LegalStatements):
    """Rewrites the functions of a module, and the values of its constants and variables."""

    def run(self) -> ir.Module:
        constants = tuple([self.constant(constant) for constant in self.module.constants])
        functions, errors = list[ir.Function](), list[Unsupported]()
        for function in self.module.functions:
            try:
                functions.append(self.function(function))
            except Unsupported as error:
                errors.append(error)
        if errors:
            raise Unsupported(errors[0].message, errors[0].span, errors[1:])
        variables = tuple([self.variable(variable) for variable in self.module.variables])
        functions = [*self.helpers.values(), *functions]
        return self.module._replace(constants=constants, functions=tuple(functions), variables=variables)

    def constant(self, constant: ir.Constant) -> ir.Constant:
        value = self.file_scope_value(constant.value)
        numbers = self.integers.value(value) if self.integers is not None else None
        if self.integers is not None and numbers is not None:
            self.integers.constants[constant.name] = numbers
        return constant if value is constant.value else constant._replace(value=value)

    def variable(self, variable: ir.Variable) -> ir.Variable:
        value = self.file_scope_value(variable.value) if variable.value is not None else None
        return variable if value is variable.value else variable._replace(value=value)

    def file_scope_value(self, value: ir.Expr) -> ir.Expr:
        """The value of a declaration at file scope; its numbers where the target cannot compute it there."""
        try:
            return self.initial_value(value)
        except Unsupported:
            numbers = self.constant_calls.literals(value)
            if numbers is None:
                raise
            return self.initial_value(numbers)

    def function(self, function: ir.Function) -> ir.Function:
        """A function of the module, or one of a polyfill, which is called while another function is rewritten."""
        outer = self.names, self.current, self.ordered, self.counters
        self.counters = []
        new = self.in_order(function)
        self.names, self.current, self.ordered, self.counters = outer
        fills = isinstance(new.result, Array) and not self.capabilities.array_constructors
        return by_out_parameter(new) if fills else new

    def in_order(self, function: ir.Function) -> ir.Function:
        """A function whose writing calls are executed in their order."""
        if not self.writing or not self.calls.changing(function):
            return self.legal_function(function)
        if not self.capabilities.out_parameters:
            return self.legal_function(lift(function, self.calls))
        stmts = order_conflicts(function, self.calls)
        lifts = stmts and (
            not self.capabilities.operand_order
            or order_conflicts(function, Calls(self.functions))
            or reads_too_late(function, self.calls)
        )
        if lifts or self.writes_parts(function):
            return self.legal_function(lift(function, self.calls))
        self.ordered = {id(stmt) for stmt in stmts}
        out = self.out
        try:
            return self.legal_function(function)
        except OutOfOrderError:
            self.ordered, self.out, self.counters = set(), out, []
            return self.legal_function(lift(function, self.calls))

    def writes_parts(self, function: ir.Function) -> bool:
        """Whether a call writes a part of a variable into which the target has no store or reference."""
        places = [
            call.args[index] for call in calls_of(function.body or ()) for index in self.outs.get(call.function, ())
        ]
        return any(
            self.is_in_bytes(place) or any(self.lacks_store(part) for part in parts_of(place)) for place in places
        )

    def is_in_bytes(self, place: ir.Expr) -> bool:
        """Whether a place is in a storage buffer that the target has as bytes."""
        base = written_root(place)
        buffers = byte_buffers(self.module, self.capabilities) if isinstance(base, ir.Global) else ()
        return base is not None and any(buffer.name == base.name for buffer in buffers)

    def legal_function(self, function: ir.Function) -> ir.Function:
        """A function whose writing calls are where the target can have them."""
        self.names, self.current = set(), function
        if not self.capabilities.mutable_parameters:
            function = self.copy_parameters(function)
        if not self.capabilities.discard_ends:
            function = with_return(function)
        return super().function(function)

    def copy_parameters(self, function: ir.Function) -> ir.Function:
        """Gives each `in` parameter that is assigned a variable of its own name; the parameter is renamed."""
        written = assigned(function, self.outs)
        if written.isdisjoint([param.name for param in function.params]):
            return function
        params, copies = [], []
        for param in function.params:
            if param.direction == "in" and param.name in written:
                name = self.new_name(f"{param.name}_in")
                copies.append(ir.Declare(param.name, param.type, ir.Local(param.type, name, param.span), param.span))
                param = param._replace(name=name)
            params.append(param)
        return function._replace(params=tuple(params), body=(*copies, *(function.body or ())))
