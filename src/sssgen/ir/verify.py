"""The verifier: reports where a module breaks the rules on which every pass and every printer relies.

Each rule looks at one node and the types of its operands, so that a fault is reported once, where it is. In tests it
runs after every pass. Its messages are for developers of passes; the checker has those for users.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import isfinite

from sssgen.ir import nodes as ir
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.memory_operations import MEMORY
from sssgen.ir.rules import FLOAT_MAX, constructs, element_type, inferred, is_type, operator_type, returns
from sssgen.ir.types import (
    BOOL,
    FLOAT,
    INT,
    UINT,
    VOID,
    Sampler,
    Struct,
    Type,
    components,
    kind_of,
    spell,
    unnested,
    with_article,
)
from sssgen.ir.walk import callees, operands, subexpressions


class InvalidIR(AssertionError):
    """A module that breaks the rules listed in `problems`."""

    def __init__(self, problems: list[str]) -> None:
        self.problems = problems
        super().__init__("invalid IR:\n" + "\n".join(problems))


def check_module(module: ir.Module, linked: bool = False) -> None:
    """Raises InvalidIR if a module breaks a rule."""
    problems = verify(module, linked)
    if problems:
        raise InvalidIR(problems)


def verify(module: ir.Module, linked: bool = False) -> list[str]:
    """The faults of a module, with their positions. `linked`: no slots are left, and callees come first."""
    verifier = _Verifier(module, linked)
    verifier.signatures()
    if not verifier.problems:  # otherwise the functions have no keys
        verifier.module()
    return verifier.problems


class _Verifier:
    def __init__(self, module: ir.Module, linked: bool) -> None:
        self.checked = module
        self.linked = linked
        self.problems: list[str] = []
        self.structs: dict[str, Struct] = {}
        self.globals: dict[str, Type] = {}
        self.written: set[str] = set()
        """The module variables that can be written."""
        self.functions: dict[str, ir.Function] = {}
        self.function_at_hand: ir.Function | None = None
        self.scopes: list[dict[str, Type]] = []

    def report(self, span: ir.Span, message: str) -> None:
        place = f"{span.file}:{span.line}:{span.column}: " if span.file else ""
        inside = f" (in {self.function_at_hand.key})" if self.function_at_hand is not None else ""
        self.problems.append(f"{place}{message}{inside}")

    # Declarations

    def signatures(self) -> None:
        """The types of parameters and results are types of the IR."""
        for function in self.checked.functions:
            for type_ in (function.result, *(param.type for param in function.params)):
                if not is_type(type_):
                    self.report(function.span, f"not a type: {type_!r} (in {function.name})")

    def module(self) -> None:
        whole = self.checked
        self.functions = {function.key: function for function in whole.functions}
        self.unique(
            [(struct.type.name, struct.span) for struct in whole.structs if isinstance(struct.type, Struct)]
            + [(constant.name, constant.span) for constant in whole.constants]
            + [(uniform.name, uniform.span) for uniform in whole.uniforms]
            + [(variable.name, variable.span) for variable in whole.variables]
            + list({function.name: (function.name, function.span) for function in whole.functions}.values()),
            "is declared twice in the module",
        )
        self.unique([(function.key, function.span) for function in whole.functions], "is defined twice")
        for struct in whole.structs:
            if not isinstance(struct.type, Struct) or not is_type(struct.type):
                self.report(struct.span, f"not a struct type: {struct.type!r}")
                continue
            for field in struct.type.fields:
                innermost, lengths = unnested(field.type)
                self.type(innermost if lengths[:1] == (0,) else field.type, struct.span)
            self.structs[struct.type.name] = struct.type
        for uniform in whole.uniforms:
            self.uniform(uniform)
        constants = set()
        for constant in whole.constants:
            self.type(constant.type, constant.span)
            self.expression(constant.value)
            self.same(constant.value.type, constant.type, constant.span, f"constant '{constant.name}'")
            for part in subexpressions(constant.value):
                reads = isinstance(part, ir.Intrinsic) and BUILTINS[part.name].reads_neighbours_or_textures
                varies = isinstance(part, ir.Global) and part.name not in constants
                if reads or varies or isinstance(part, ir.Local | ir.Call):
                    self.report(part.span, f"the value of '{constant.name}' is not constant")
            constants.add(constant.name)
            self.globals[constant.name] = constant.type
        for variable in whole.variables:
            self.variable(variable)
        self.calls()
        for function in whole.functions:
            self.function_at_hand = function
            self.function(function)
            self.function_at_hand = None

    def unique(self, names: Iterable[tuple[str, ir.Span]], message: str) -> None:
        seen = set()
        for name, span in names:
            if name in seen:
                self.report(span, f"'{name}' {message}")
            seen.add(name)

    def type(self, type_: Type, span: ir.Span, excluded: tuple[type, ...] = ()) -> None:
        """A type that is used: it is valid, its structs are declared, and it is none of the `excluded` classes."""
        if isinstance(type_, excluded) or not is_type(type_):
            self.report(span, f"this cannot be {type_!r}")
            return
        innermost, _ = unnested(type_)
        if isinstance(innermost, Struct) and self.structs.get(innermost.name) != innermost:
            self.report(span, f"struct '{innermost.name}' is not declared with these fields")

    def uniform(self, uniform: ir.Uniform) -> None:
        type_, span, name = uniform.type, uniform.span, uniform.name
        self.globals[name] = type_
        self.type(type_, span, (type(VOID),))
        innermost, _ = unnested(type_)
        if isinstance(innermost, Struct):
            if self.linked:
                self.report(span, f"uniform '{name}' is made of structs")
        elif len(uniform.default) != components(type_):
            self.report(span, f"'{name}' has {len(uniform.default)} defaults, not {components(type_)}")
        elif not all(_fits(value, kind_of(innermost)) for value in uniform.default):
            self.report(span, f"'{name}' has a default that is not a value of {spell(innermost)}: {uniform.default}")

    def variable(self, variable: ir.Variable) -> None:
        name, span = variable.name, variable.span
        self.type(variable.type, span, (Sampler, type(VOID)))
        if variable.storage not in ("private", "in", "out", "shared", "buffer", "image"):
            self.report(span, f"'{variable.storage}' is not a storage")
        if variable.interpolation not in ("", "flat", "noperspective", "centroid"):
            self.report(span, f"'{variable.interpolation}' is not an interpolation")
        if variable.value is not None:
            if variable.storage != "private":
                self.report(span, f"'{name}' is {variable.storage} and has a value")
            self.expression(variable.value)
            self.same(variable.value.type, variable.type, span, f"'{name}'")
            for part in subexpressions(variable.value):
                if isinstance(part, ir.Call):
                    self.report(part.span, f"the value of '{name}' contains a call")
        self.globals[name] = variable.type
        if variable.storage != "in":
            self.written.add(name)

    def calls(self) -> None:
        """There is no recursion; if linked, functions call only earlier ones."""
        position = {function.key: index for index, function in enumerate(self.checked.functions)}
        pending = {key: position.keys() & callees(self.functions[key]) for key in position}
        if self.linked:
            for function in self.checked.functions:
                late = [name for name in pending[function.key] if position[name] >= position[function.key]]
                for name in sorted(late):
                    self.report(function.span, f"{function.key} calls {name}, which is declared after it")
        while ready := [key for key, wanted in pending.items() if not wanted]:
            for key in ready:
                del pending[key]
            for wanted in pending.values():
                wanted.difference_update(ready)
        for key in pending:
            self.report(self.functions[key].span, f"{key} is recursive, or calls a recursive function")

    def function(self, function: ir.Function) -> None:
        span = function.span
        self.type(function.result, span, (Sampler,))
        self.scopes = [{}]
        for param in function.params:
            self.type(param.type, param.span, (type(VOID),))
            if param.direction not in ("in", "out", "inout"):
                self.report(param.span, f"'{param.direction}' is not a direction")
            if isinstance(param.type, Sampler) and param.direction != "in":
                self.report(param.span, f"a sampler cannot be {param.direction}")
            self.declare(param.name, param.type, param.span)
        if function.body is None:
            if self.linked:
                self.report(span, f"slot {function.key} is not bound")
            return
        self.block(function.body, loop=False)
        if function.result != VOID and not returns(function.body):
            self.report(span, "the end is reachable without a return")

    # Statements

    def declare(self, name: str, type_: Type, span: ir.Span) -> None:
        if self.local(name) is not None:
            self.report(span, f"'{name}' hides a variable of the same name")
        self.scopes[-1][name] = type_

    def local(self, name: str) -> Type | None:
        return next((scope[name] for scope in reversed(self.scopes) if name in scope), None)

    def block(self, block: ir.Block, loop: bool) -> None:
        for stmt in block:
            self.statement(stmt, loop)

    def inner(self, block: ir.Block, loop: bool) -> None:
        self.scopes.append({})
        self.block(block, loop)
        self.scopes.pop()

    def statement(self, stmt: ir.Stmt, loop: bool) -> None:
        if isinstance(stmt, ir.Declare):
            self.type(stmt.type, stmt.span, (Sampler, type(VOID)))
            if stmt.value is not None:
                self.expression(stmt.value)
                self.same(stmt.value.type, stmt.type, stmt.span, f"'{stmt.name}'")
            self.declare(stmt.name, stmt.type, stmt.span)
        elif isinstance(stmt, ir.Assign):
            self.assign(stmt)
        elif isinstance(stmt, ir.Evaluate):
            if not isinstance(stmt.call, ir.Call):
                self.report(stmt.span, f"{with_article(type(stmt.call).__name__)} is evaluated and dropped")
            self.expression(stmt.call, nothing=True)
        elif isinstance(stmt, ir.Assume):
            self.condition(stmt.condition)
        elif isinstance(stmt, ir.If):
            self.condition(stmt.condition)
            self.inner(stmt.then, loop)
            self.inner(stmt.otherwise, loop)
        elif isinstance(stmt, ir.While):
            self.condition(stmt.condition)
            self.inner(stmt.body, True)
        elif isinstance(stmt, ir.For):
            self.loop(stmt)
        elif isinstance(stmt, ir.Break | ir.Continue):
            if not loop:
                self.report(stmt.span, f"{type(stmt).__name__.lower()} outside a loop")
        elif isinstance(stmt, ir.Return):
            self.leave(stmt)
        elif isinstance(stmt, ir.MemoryOperation):
            self.memory(stmt)
        elif not isinstance(stmt, ir.Discard):
            self.report(ir.Span("", 0, 0, 0, 0), f"not a statement: {stmt!r}")

    def assign(self, stmt: ir.Assign) -> None:
        self.expression(stmt.target)
        self.expression(stmt.value)
        self.writable(stmt.target)
        target, value = stmt.target.type, stmt.value.type
        if not stmt.op:
            self.same(value, target, stmt.span, "an assignment")
        elif operator_type(stmt.op, target, value) != target or target == BOOL:
            self.report(stmt.span, f"'{stmt.op}=' is not defined for {_name(target)} and {_name(value)}")

    def memory(self, stmt: ir.MemoryOperation) -> None:
        row = MEMORY[stmt.name]
        for arg in stmt.args:
            self.expression(arg)
        if len(stmt.args) != row.has_place + row.values:
            self.report(stmt.span, f"{stmt.name} has {len(stmt.args)} arguments")
        if stmt.result is not None:
            self.expression(stmt.result)
            self.writable(stmt.result)

    def loop(self, stmt: ir.For) -> None:
        self.scopes.append({})
        for part in (stmt.init, stmt.step):
            if part is not None:
                allowed = ir.Assign | ir.Evaluate if part is stmt.step else ir.Declare | ir.Assign | ir.Evaluate
                if isinstance(part, allowed):
                    self.statement(part, False)
                else:
                    self.report(stmt.span, f"{with_article(type(part).__name__)} in the head of a for")
        if stmt.condition is not None:
            self.condition(stmt.condition)
        self.inner(stmt.body, True)
        self.scopes.pop()

    def leave(self, stmt: ir.Return) -> None:
        wanted = self.function_at_hand.result if self.function_at_hand is not None else VOID
        if stmt.value is not None:
            self.expression(stmt.value)
        returned = stmt.value.type if stmt.value is not None else VOID
        self.same(returned, wanted, stmt.span, "the return")

    def condition(self, expr: ir.Expr) -> None:
        self.expression(expr)
        self.same(expr.type, BOOL, expr.span, "a condition")

    def same(self, actual: Type, wanted: Type, span: ir.Span, subject: str) -> None:
        if actual != wanted:
            self.report(span, f"{subject} is {_a_type(wanted)}, but gets {_a_type(actual)}")

    # Expressions

    def writable(self, target: ir.Expr) -> None:
        inner = target
        while isinstance(inner, ir.Swizzle | ir.Index | ir.Member):
            if isinstance(inner, ir.Swizzle) and len(set(inner.components)) != len(inner.components):
                self.report(target.span, f"'.{inner.components}' is assigned to, and names a component twice")
            inner = inner.value
        variable = isinstance(inner, ir.Local) or (isinstance(inner, ir.Global) and inner.name in self.written)
        if not variable or isinstance(target.type, Sampler):
            place = f"{with_article(type(inner).__name__)} of type {_name(target.type)}"
            self.report(target.span, f"{place} cannot be assigned to")

    def expression(self, expr: ir.Expr, nothing: bool = False) -> None:
        """An expression and its operands; with `nothing` it may be a call without a result."""
        if expr.type == VOID and not nothing:
            self.report(expr.span, "a call without a result is used as a value")
        for node in subexpressions(expr):
            for problem in self.node(node):
                self.report(node.span, problem)
            for operand in operands(node):
                if operand.type == VOID:
                    self.report(operand.span, "a call without a result is used as a value")
                passed = isinstance(node, ir.Call | ir.Intrinsic) and isinstance(operand, ir.Local | ir.Global)
                if isinstance(operand.type, Sampler) and not passed:
                    self.report(operand.span, "a sampler can only be named, and only as an argument")

    def node(self, node: ir.Expr) -> Iterator[str]:
        """The faults of one node, on the assumption that its operands are valid."""
        if isinstance(node, ir.Literal):
            if node.type not in (FLOAT, INT, UINT, BOOL) or not _is_value(node.value, kind_of(node.type)):
                yield f"{node.value!r} is not a value of type {_name(node.type)}"
        elif isinstance(node, ir.Local):
            yield from self.named(node, self.local(node.name) if self.scopes else None)
        elif isinstance(node, ir.Global):
            yield from self.named(node, self.globals.get(node.name))
        elif isinstance(node, ir.Construct):
            if not constructs(node.type, [arg.type for arg in node.args]):
                yield f"{_name(node.type)} cannot be constructed from {_names(node.args)}"
        elif isinstance(node, ir.Call):
            yield from self.call(node)
        else:
            wanted = inferred(node)
            if wanted is None:
                yield f"{_operation(node)} is not defined for {_names(operands(node))}"
            elif wanted != node.type:
                types = _names(operands(node))
                yield f"{_operation(node)} of {types} is {_a_type(wanted)}, not {_a_type(node.type)}"
            elif isinstance(node, ir.Index) and isinstance(node.index, ir.Literal):
                elements = element_type(node.value.type)
                if elements is not None and not 0 <= node.index.value < (elements[1] or node.index.value + 1):
                    yield f"index {node.index.value} is outside {_name(node.value.type)}"

    def named(self, node: ir.Local | ir.Global, declared: Type | None) -> Iterator[str]:
        if declared is None:
            yield f"'{node.name}' is not declared here"
        elif declared != node.type:
            yield f"'{node.name}' is {_a_type(declared)}, not {_a_type(node.type)}"

    def call(self, node: ir.Call) -> Iterator[str]:
        function = self.functions.get(node.function)
        if function is None:
            yield f"there is no function {node.function}"
            return
        if [param.type for param in function.params] != [arg.type for arg in node.args]:
            yield f"{node.function} is called with {_names(node.args)}"
        if function.result != node.type:
            yield f"{node.function} returns {_a_type(function.result)}, not {_a_type(node.type)}"
        for param, arg in zip(function.params, node.args, strict=False):
            if param.direction != "in":
                self.writable(arg)


def _is_value(value: object, kind: str) -> bool:
    """Whether a literal's value has the Python type and the range of its kind."""
    if kind == "float":
        return type(value) is float and _fits(value, kind)
    if kind == "bool":
        return type(value) is bool
    return type(value) is int and _fits(value, kind)


def _fits(value: float, kind: str) -> bool:
    """Whether a number lies in the range of a kind."""
    if kind == "float":
        return isfinite(value) and abs(value) <= FLOAT_MAX
    low, high = {"bool": (0, 1), "int": (-(2**31), 2**31 - 1), "uint": (0, 2**32 - 1)}[kind]
    return low <= value <= high and value == int(value)


def _name(type_: Type) -> str:
    return spell(type_) if is_type(type_) else repr(type_)


def _a_type(type_: Type) -> str:
    return with_article(_name(type_))


def _names(args: Iterable[ir.Expr]) -> str:
    return f"({', '.join(_name(arg.type) for arg in args)})"


def _operation(node: ir.Expr) -> str:
    """A short name of a node, for messages."""
    if isinstance(node, ir.Unary | ir.Binary):
        return f"'{node.op}'"
    if isinstance(node, ir.Intrinsic):
        return node.name
    if isinstance(node, ir.Swizzle):
        return f"'.{node.components}'"
    if isinstance(node, ir.Member):
        return f"'.{node.field}'"
    return "an index" if isinstance(node, ir.Index) else "a choice"
