"""Functions that return what they write, for languages with neither `out` parameters nor pointers.

`float trace(vec3 ray, out vec3 normal)` returns a struct `TraceResult` of `value` and `normal`; a function that returns
nothing and writes one parameter returns that. Place: after `legalise`, to which only these forms of such a call are
left: `x = f(…)`, `T x = f(…)` and `f(…)` alone, with variables for what it writes.
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.transform import Transformer
from sssgen.ir.types import VOID, Array, Field, Struct, Type
from sssgen.passes.scopes import claim, declared, fresh, names_of
from sssgen.passes.unsupported import Unsupported

VALUE = "value"


def result_structs(module: ir.Module) -> ir.Module:
    """The module without `out` and `inout` parameters. Raises Unsupported."""
    if all(param.direction == "in" for function in module.functions for param in function.params):
        return module
    return _Results(module).run()


class _Results(Transformer):
    """Rewrites the functions in their order: each comes after those that it calls."""

    def __init__(self, module: ir.Module) -> None:
        super().__init__()
        self.module = module
        self.old = {function.key: function for function in module.functions}
        self.new: dict[str, ir.Function] = {}
        """The new functions by their old keys."""
        self.structs: list[ir.StructDecl] = []
        self.taken = names_of(module)
        self.names: set[str] = set()
        self.returned: list[ir.Local] = []
        """What the current function returns behind its value."""
        self.result: Type = VOID

    def run(self) -> ir.Module:
        for key, function in self.old.items():
            self.new[key] = self.function(function)
        module = self.module
        return module._replace(structs=(*module.structs, *self.structs), functions=tuple(self.new.values()))

    def function(self, function: ir.Function) -> ir.Function:
        self.names = set(declared(function))
        self.returned = [ir.Local(param.type, param.name, param.span) for param in function.params if _writes(param)]
        if not self.returned:
            return super().function(function)
        begin: list[ir.Stmt] = []
        params: list[ir.Param] = []
        for param in function.params:
            if not _writes(param):
                params.append(param)
                continue
            value = None
            if param.direction == "inout":
                params.append(param._replace(name=claim(f"{param.name}_in", self.names), direction="in"))
                value = ir.Local(param.type, params[-1].name, param.span)
            begin.append(ir.Declare(param.name, param.type, value, param.span))
        self.result = self.result_type(function)
        new = function._replace(params=tuple(params), result=self.result)
        others = {*self.old, *(other.key for other in self.new.values())} - {function.key}
        while new.key in others:
            new = new._replace(name=f"{new.name}_")
        body = self.block(function.body or ())
        if function.result == VOID and not (body and isinstance(body[-1], ir.Return)):
            body = (*body, ir.Return(self.results(None, function.span), function.span))
        return new._replace(body=(*begin, *body))

    def result_type(self, function: ir.Function) -> Type:
        """The type that holds all that a function returns and writes."""
        fields = [Field(place.name, place.type) for place in self.returned]
        if function.result == VOID and len(fields) == 1:
            return fields[0].type
        if function.result != VOID:
            fields.insert(0, Field(fresh(VALUE, {field.name for field in fields}), function.result))
        for field in fields:
            if isinstance(field.type, Array):
                hint = "put the array into a loop of the caller, or return one value at a time"
                raise Unsupported("an array is among several results", function.span, hint=hint)
        name = claim(f"{function.name[0].upper()}{function.name[1:]}Result", self.taken)
        struct = Struct(name, tuple(fields))
        self.structs.append(ir.StructDecl(struct, "", function.span))
        return struct

    # Statements

    def leave(self, stmt: ir.Return) -> ir.Stmt | None:
        return stmt._replace(value=self.results(stmt.value, stmt.span)) if self.returned else stmt

    def results(self, value: ir.Expr | None, span: ir.Span) -> ir.Expr:
        parts = (*([] if value is None else [value]), *self.returned)
        return parts[0] if len(parts) == 1 else ir.Construct(self.result, parts, span)

    def statement(self, stmt: ir.Stmt) -> ir.Stmt | None:
        call = stmt.call if isinstance(stmt, ir.Evaluate) else getattr(stmt, "value", None)
        if isinstance(call, ir.Call) and any(map(_writes, self.old[call.function].params)):
            self.out += self.call(stmt, call)
            return None
        return super().statement(stmt)

    def call(self, stmt: ir.Stmt, call: ir.Call) -> list[ir.Stmt]:
        """The call, and the assignments of what it returns."""
        old, new, span = self.old[call.function], self.new[call.function], call.span
        arguments = list(zip(call.args, old.params, strict=True))
        places = [arg for arg, param in arguments if _writes(param)]
        value: ir.Expr = ir.Call(
            new.result, new.key, tuple([arg for arg, param in arguments if param.direction != "out"]), span
        )
        if old.result == VOID and len(places) == 1:
            return [ir.Assign(places[0], "", value, span)]
        assert isinstance(new.result, Struct)
        name = claim(f"{old.name}_result", self.names)
        result = ir.Local(new.result, name, span)
        parts: list[ir.Expr] = [ir.Member(field.type, result, field.name, span) for field in new.result.fields]
        stmts: list[ir.Stmt] = [ir.Declare(name, new.result, value, span)]
        if old.result != VOID:
            first = parts.pop(0)
            stmts += [] if isinstance(stmt, ir.Evaluate) else [stmt._replace(value=first)]  # type: ignore[call-arg]
        return stmts + [ir.Assign(place, "", part, span) for place, part in zip(places, parts, strict=True)]


def _writes(param: ir.Param) -> bool:
    return param.direction != "in"
