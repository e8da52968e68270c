"""Checks a parsed file and gives its IR module: declarations, statements, loops that end, no recursion."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ..diagnostics import Reporter
from ..ir import nodes as ir
from ..ir.intrinsics import BUILTINS
from ..ir.rules import operator_type, returns
from ..ir.types import (
    BOOL,
    FLOAT,
    INT,
    UINT,
    VOID,
    Array,
    Field,
    Matrix,
    Sampler,
    Scalar,
    Struct,
    Type,
    components,
    kind_of,
    spell,
)
from ..ir.walk import callees, subexpressions
from . import quantities as q
from . import syntax as s
from .bounded import cycles, ends, skips
from .expressions import ExpressionChecker, Typed, Untyped
from .hints import check_hints
from .scope import GlobalValue, Scopes, Signature
from .wording import a_type, mixed_hint

# GLSL ES 3.00, section 3.8: what GLSL itself keeps for later. Names that only other targets reserve are renamed there.
RESERVED = frozenset(
    """attribute varying coherent volatile restrict readonly writeonly resource atomic_uint noperspective patch sample
    subroutine common partition active asm class union enum typedef template this goto inline noinline public
    static extern external interface long short long double half fixed unsigned superp input output filter
    sizeof cast namespace using switch case default do layout centroid flat smooth invariant buffer shared
    precise packed const uniform in out inout if else for while break continue return discard struct true
    false precision highp mediump lowp void float int uint bool vec2 vec3 vec4 ivec2 ivec3 ivec4 uvec2 uvec3
    uvec4 bvec2 bvec3 bvec4 dvec2 dvec3 dvec4 fvec2 fvec3 fvec4 hvec2 hvec3 hvec4 mat2 mat3 mat4 mat2x2 mat2x3
    mat2x4 mat3x2 mat3x3 mat3x4 mat4x2 mat4x3 mat4x4""".split()  # noqa: SIM905 - eighty names
)
_RESERVED_TYPES = re.compile(r"[iu]?(sampler|image)([123]D|Cube|Buffer)")


def check(file: s.File, text: str, included: ir.Module = ir.Module()) -> ir.Module:  # noqa: B008 - immutable
    """Checks a file; `included` holds what its includes brought. Raises SssgenError with every error found."""
    reporter = Reporter(file.name, text)
    checker = _FileChecker(reporter)
    checker.bring_in(included)
    module = checker.file(file)
    reporter.check()
    return module


MAX_CALLS = 64
"""How deep calls may go: compilers inline them all, one in the other."""


class _FileChecker(ExpressionChecker):
    """Checks the declarations and statements of one file."""

    def __init__(self, reporter: Reporter) -> None:
        super().__init__(reporter)
        self.included = ir.Module()
        self.result: tuple[Type, str] = (VOID, "")
        self.loops = 0
        self.defined: set[ir.Span] = set()
        """The functions that have a body, by the span of their name."""

    def bring_in(self, module: ir.Module) -> None:
        """Makes an included module's declarations known."""
        self.included = module
        for struct in module.structs:
            assert isinstance(struct.type, Struct)
            self.structs[struct.type.name] = struct.type
        for constant in module.constants:
            self.globals[constant.name] = GlobalValue(constant.type, "", _int_value(constant.value), True)
        for uniform in module.uniforms:
            self.globals[uniform.name] = GlobalValue(uniform.type, uniform.quantity)
        for function in module.functions:
            self.functions.setdefault(function.name, []).append(_signature(function))
            if function.body is not None:
                self.defined.add(function.span)

    def file(self, file: s.File) -> ir.Module:
        """Checks everything in order; a function may call only what stands before it."""
        before = self.included
        structs, constants, uniforms = list(before.structs), list(before.constants), list(before.uniforms)
        functions = {function.key: function for function in before.functions}
        for external in file.externals:
            try:
                if isinstance(external, s.StructSyntax):
                    structs.append(self.struct(external))
                elif isinstance(external, s.UniformSyntax):
                    uniforms.append(self.uniform(external))
                elif isinstance(external, s.ConstantSyntax):
                    constants.extend(self.constant(external))
                elif isinstance(external, s.FunctionSyntax):
                    function = self.function(external)
                    if function.body is not None or function.key not in functions:
                        functions[function.key] = function
            except Untyped:
                self.faulty.update(_declared_names(external))
        for cycle in cycles(functions):
            names = " → ".join(key.split("(")[0] for key in cycle)
            message = f"recursion is not possible in a shader: {names}"
            self.reporter.error(functions[cycle[0]].span, message, "rewrite it as a loop")
        self.limit_calls(functions)
        return ir.Module(tuple(structs), tuple(constants), tuple(uniforms), tuple(functions.values()))

    def limit_calls(self, functions: dict[str, ir.Function]) -> None:
        """Reports the first function whose calls go too deep; a function stands after those it calls."""
        depth: dict[str, int] = {}
        for key, function in functions.items():
            depth[key] = 1 + max([depth.get(callee, 0) for callee in callees(function)], default=0)
            if depth[key] > MAX_CALLS:
                message = f"{function.name} calls functions more than {MAX_CALLS} deep"
                self.reporter.error(function.span, message, "join some of them")
                return

    # Declarations

    def new_name(self, name: s.Name, functions: bool = False) -> str:
        """Checks that a module-level name is free and allowed."""
        self.allowed(name)
        taken = name.text in self.globals or name.text in self.structs or name.text in q.QUANTITIES
        if taken or (not functions and name.text in self.functions):
            raise self.fail(name.span, f"'{name.text}' is already declared")
        return name.text

    def allowed(self, name: s.Name) -> None:
        text = name.text
        if text in RESERVED or _RESERVED_TYPES.match(text) or text.startswith("gl_") or "__" in text:
            other = re.sub("_+", "_", f"{text.removeprefix('gl_')}_value")
            raise self.fail(name.span, f"'{text}' is reserved in GLSL", f"choose another name, such as '{other}'")

    def struct(self, struct: s.StructSyntax) -> ir.StructDecl:
        name = self.new_name(struct.name)
        fields: dict[str, Field] = {}
        for member in struct.members:
            type_, quantity = self.type_named(member.type)
            for declarator in member.declarators:
                if declarator.name.text in fields:
                    raise self.fail(declarator.name.span, f"member '{declarator.name.text}' is declared twice")
                self.allowed(declarator.name)
                field_type = self.array_of(type_, declarator.length)
                if isinstance(field_type, Sampler) or field_type == VOID:
                    raise self.fail(declarator.name.span, f"a member cannot be {a_type(field_type)}")
                fields[declarator.name.text] = Field(declarator.name.text, field_type, quantity)
        type_ = self.structs[name] = Struct(name, tuple(fields.values()))
        return ir.StructDecl(type_, struct.doc, struct.name.span)

    def uniform(self, uniform: s.UniformSyntax) -> ir.Uniform:
        name = self.new_name(uniform.name)
        type_, quantity = self.type_named(uniform.type)
        type_ = self.array_of(type_, uniform.length)
        if type_ == VOID or isinstance(type_.element if isinstance(type_, Array) else type_, Struct):
            raise self.fail(uniform.type.span, f"a uniform cannot be {a_type(type_)}")
        default: tuple[float, ...] = ()
        if uniform.value is not None:
            if isinstance(type_, Sampler):
                hint = "use default_white, default_black, default_gray or default_bump"
                raise self.fail(uniform.value.span, "a texture has no default value", hint)
            value = self.check(uniform.value)
            self.require(value._replace(quantity=""), type_, "", uniform.value.span, f"'{name}'")
            constants = _components(value.expr)
            if constants is None:
                hint = "write it as 0.2 or vec3(1.0, 0.5, 0.0)"
                raise self.fail(uniform.value.span, "a default is made of literals", hint)
            default = constants
        elif not isinstance(type_, Sampler):
            default = _identity(type_)
        hints, held = check_hints(self, uniform, type_, default)
        self.globals[name] = GlobalValue(type_, quantity or held)
        return ir.Uniform(name, type_, default, hints, quantity or held, uniform.doc, uniform.name.span)

    def constant(self, constant: s.ConstantSyntax) -> list[ir.Constant]:
        declaration, found = constant.declaration, []
        type_, quantity = self.type_named(declaration.type)
        for declarator in declaration.declarators:
            name = self.new_name(declarator.name)
            declared = self.array_of(type_, declarator.length)
            if declarator.value is None:
                raise self.fail(declarator.name.span, f"const '{name}' needs a value")
            value = self.check_as(declarator.value, declared, quantity, f"'{name}'")
            if any(self.varies(part) for part in subexpressions(value)):
                message = f"the value of const '{name}' is not constant"
                raise self.fail(declarator.value.span, message, "use literals, other constants and builtins")
            self.globals[name] = GlobalValue(declared, quantity, _int_value(value), True)
            found.append(ir.Constant(name, declared, value, declarator.name.span))
        return found

    def varies(self, part: ir.Expr) -> bool:
        """Whether a part of an expression is not known before the shader runs."""
        if isinstance(part, ir.Intrinsic):
            return BUILTINS[part.name].kind in ("fetch", "derivative")
        return isinstance(part, ir.Call) or (isinstance(part, ir.Global) and not self.globals[part.name].constant)

    def function(self, function: s.FunctionSyntax) -> ir.Function:
        name = function.name
        self.new_name(name, functions=True)
        result, quantity = self.type_named(function.result)
        params = []
        self.scopes = Scopes()
        for index, param in enumerate(function.params):
            type_, held = self.type_named(param.type)
            type_ = self.array_of(type_, param.length)
            if type_ == VOID or (isinstance(type_, Sampler) and param.direction != "in"):
                raise self.fail(param.type.span, f"a parameter cannot be '{param.direction} {spell(type_)}'")
            label = param.name or s.Name(f"unnamed_{index + 1}", param.type.span)
            self.allowed(label)
            if self.scopes.declare(label.text, type_, held, True) is None:
                raise self.fail(label.span, f"parameter '{label.text}' is declared twice")
            params.append(ir.Param(label.text, type_, param.direction, held, label.span))
        made = ir.Function(name.text, tuple(params), result, quantity, None, function.doc, name.span)
        self.declare_function(made, name, function.body is not None)
        if function.body is None:
            return made
        self.result, self.loops = (result, quantity), 0
        errors = len(self.reporter.diagnostics)
        body = self.statements(function.body)
        if result != VOID and not returns(body) and len(self.reporter.diagnostics) == errors:
            message = f"{name.text} can end without returning {a_type(result)}"
            self.reporter.error(name.span, message, "add a return at its end")
        return made._replace(body=body)

    def declare_function(self, made: ir.Function, name: s.Name, has_body: bool) -> None:
        """Makes a function known, unless it is already: a prototype, and then its definition, agree in everything."""
        known, new = self.functions.setdefault(name.text, []), _signature(made)
        earlier = next((one for one in known if one.key == made.key), None)
        if earlier is not None:
            elsewhere = f" of {earlier.span.file}" if earlier.span.file != name.span.file else ""
            there = f"first at line {earlier.span.line}{elsewhere}"
            if has_body and earlier.span in self.defined:
                raise self.fail(name.span, f"{made.key} is already defined", there)
            if earlier._replace(names=new.names, span=new.span) != new:
                raise self.fail(name.span, f"{made.key} is declared differently before", f"{there}; make the two agree")
            if not has_body:
                return
            known.remove(earlier)
        known.append(new)
        if has_body:
            self.defined.add(name.span)

    # Statements

    def block(self, compound: s.Compound, dissolve: bool = False) -> ir.Block:
        """Checks a block in a scope of its own; `dissolve`: its statements become those of the block around it."""
        self.scopes.push()
        result = self.statements(compound)
        self.scopes.pop(dissolve)
        return result

    def statements(self, compound: s.Compound) -> ir.Block:
        return tuple([stmt for statement in compound.statements for stmt in self.statement(statement)])

    def statement(self, statement: s.Statement) -> list[ir.Stmt]:
        """Checks one statement; a faulty one gives nothing and the next goes on."""
        if isinstance(statement, s.Compound):
            return list(self.block(statement, dissolve=True))
        try:
            method = getattr(self, f"_{type(statement).__name__.lower()}")
            result: list[ir.Stmt] = method(statement)
            return result
        except Untyped:
            if isinstance(statement, s.Declaration):
                self.declare_anyway(statement)
            return []

    def declare_anyway(self, declaration: s.Declaration) -> None:
        """After a faulty declaration, makes its names known so that their use is not reported too."""
        for declarator in declaration.declarators:
            try:
                type_, quantity = self.type_named(declaration.type)
                type_ = self.array_of(type_, declarator.length)
                faulty = type_ == VOID or isinstance(type_, Sampler)
            except Untyped:
                type_, quantity, faulty = FLOAT, "", True
            self.scopes.declare(declarator.name.text, type_, quantity, True, faulty)

    def _declaration(self, declaration: s.Declaration) -> list[ir.Stmt]:
        result: list[ir.Stmt] = []
        type_, quantity = self.type_named(declaration.type)
        if type_ == VOID or isinstance(type_, Sampler):
            raise self.fail(declaration.type.span, f"a variable cannot be {a_type(type_)}")
        for declarator in declaration.declarators:
            name = declarator.name
            self.allowed(name)
            declared = self.array_of(type_, declarator.length)
            value = None
            if declarator.value is not None:
                value = self.check_as(declarator.value, declared, quantity, f"'{name.text}'")
            elif declaration.const:
                raise self.fail(name.span, f"const '{name.text}' needs a value")
            variable = self.scopes.declare(name.text, declared, quantity, not declaration.const)
            if variable is None:
                raise self.fail(name.span, f"'{name.text}' is already declared in this block")
            span = ir.Span(name.span.file, declaration.span.line, declaration.span.column, *name.span[3:])
            result.append(ir.Declare(variable.ir_name, declared, value, span))
        return result

    def _assignment(self, assignment: s.Assignment) -> list[ir.Stmt]:
        target, span = self.check(assignment.target), assignment.span
        self.check_writable(target.expr, assignment.target.span)
        type_, op = target.expr.type, assignment.op
        if not op:
            assert assignment.value is not None
            value = self.check_as(assignment.value, type_, target.quantity, "the assignment")
            return [ir.Assign(target.expr, op, value, span)]
        if assignment.value is not None:
            right = self.check(assignment.value)
        elif isinstance(type_, Scalar) and type_.kind != "bool":
            right = Typed(ir.Literal(type_, 1.0 if type_ == FLOAT else 1, span))
        else:
            raise self.fail(span, f"'{op * 2}' is not defined for {a_type(type_)}")
        if operator_type(op, type_, right.expr.type) != type_:
            message = f"'{op}=' is not defined for {a_type(type_)} and {a_type(right.expr.type)}"
            raise self.fail(span, message, mixed_hint(target.expr, right.expr, op))
        quantity = self.combined(op, target, right, span)
        if op not in ("*", "/") or not isinstance(right.expr.type, Scalar):  # scaling in place keeps it
            self.require(target._replace(quantity=quantity), type_, target.quantity, span, "the assignment")
        return [ir.Assign(target.expr, op, right.expr, span)]

    def _expressionstatement(self, statement: s.ExpressionStatement) -> list[ir.Stmt]:
        value = statement.value
        callee = value.callee if isinstance(value, s.CallOf) else None
        if isinstance(callee, s.Name) and callee.text == "assume" and "assume" not in self.functions:
            return self.assumption(value)
        call = self.check(value).expr
        if not isinstance(call, ir.Call):
            raise self.fail(statement.span, "this computes a value and drops it", "assign it, or remove the statement")
        return [ir.Evaluate(call, statement.span)]

    def assumption(self, call: s.Expression) -> list[ir.Stmt]:
        """`assume(condition);`"""
        assert isinstance(call, s.CallOf)
        if len(call.args) != 1:
            raise self.fail(call.span, "assume takes one condition", "write assume(x > 0.0);")
        condition = self.condition(call.args[0])
        if condition is not None and any(isinstance(part, ir.Call) for part in subexpressions(condition)):
            raise self.fail(call.span, "an assumption calls no function", "assume something of a variable's value")
        return [ir.Assume(condition, call.span)] if condition is not None else []

    def _ifstatement(self, statement: s.IfStatement) -> list[ir.Stmt]:
        condition = self.condition(statement.condition)
        then = self.body(statement.then)
        otherwise = self.body(statement.otherwise) if statement.otherwise is not None else ()
        return [ir.If(condition, then, otherwise, statement.span)] if condition is not None else []

    def _forstatement(self, statement: s.ForStatement) -> list[ir.Stmt]:
        errors = len(self.reporter.diagnostics)
        self.scopes.push()
        init = self.header(statement.init)
        condition = self.condition(statement.condition) if statement.condition is not None else None
        step = self.header(statement.step)
        body = self.loop_body(statement.body)
        self.scopes.pop()
        if len(self.reporter.diagnostics) > errors:
            return []
        if condition is None or step is None or not ends(condition, (step,), body, self.out_args):
            raise self.fail(statement.span, "this loop cannot be seen to end", _LOOP_HINT)
        return [ir.For(init, condition, step, body, statement.span)]

    def header(self, statement: s.Statement | None) -> ir.Stmt | None:
        """The init or step of a for loop: one declaration or assignment."""
        found = self.statement(statement) if statement is not None else []
        if len(found) > 1 and statement is not None:
            self.reporter.error(statement.span, "declare one loop counter here, the rest before the loop")
        return found[0] if found else None

    def _whilestatement(self, statement: s.WhileStatement) -> list[ir.Stmt]:
        errors = len(self.reporter.diagnostics)
        condition = self.condition(statement.condition)
        body = self.loop_body(statement.body)
        if condition is None or len(self.reporter.diagnostics) > errors:
            return []
        if skips(body) or not ends(condition, body, (), self.out_args):
            raise self.fail(statement.span, "this loop cannot be seen to end", _LOOP_HINT)
        return [ir.While(condition, body, statement.span)]

    def condition(self, condition: s.Expression) -> ir.Expr | None:
        """A condition, or None once its error is reported: what it governs is checked all the same."""
        try:
            return self.check_as(condition, BOOL, "", "a condition")
        except Untyped:
            return None

    def loop_body(self, statement: s.Statement) -> ir.Block:
        self.loops += 1
        body = self.body(statement)
        self.loops -= 1
        return body

    def out_args(self, call: ir.Call) -> list[ir.Expr]:
        """The arguments of a call that it writes to."""
        overloads = self.functions[call.function.split("(")[0]]
        directions = next(one.directions for one in overloads if one.key == call.function)
        return [arg for arg, direction in zip(call.args, directions, strict=True) if direction != "in"]

    def body(self, statement: s.Statement) -> ir.Block:
        if isinstance(statement, s.Compound):
            return self.block(statement)
        self.scopes.push()
        result = tuple(self.statement(statement))
        self.scopes.pop()
        return result

    def _jump(self, jump: s.Jump) -> list[ir.Stmt]:
        if jump.kind == "return":
            type_, quantity = self.result
            if jump.value is None:
                if type_ != VOID:
                    raise self.fail(jump.span, f"this function returns {spell(type_)}", "write return value;")
                return [ir.Return(None, jump.span)]
            if type_ == VOID:
                raise self.fail(jump.span, "this function returns nothing")
            return [ir.Return(self.check_as(jump.value, type_, quantity, "the return"), jump.span)]
        if jump.kind == "discard":
            return [ir.Discard(jump.span)]
        if self.loops == 0:
            raise self.fail(jump.span, f"{jump.kind} stands outside a loop")
        return [ir.Break(jump.span) if jump.kind == "break" else ir.Continue(jump.span)]


_LOOP_HINT = "write for (int i = 0; i < N; i++) with N that the body does not change, and step the counter nowhere else"


def _signature(function: ir.Function) -> Signature:
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
    )


def _declared_names(external: s.External) -> Iterator[str]:
    if isinstance(external, s.ConstantSyntax):
        yield from (declarator.name.text for declarator in external.declaration.declarators)
    elif not isinstance(external, s.IncludeSyntax):
        yield external.name.text


def _int_value(value: ir.Expr) -> int | None:
    return int(value.value) if isinstance(value, ir.Literal) and value.type in (INT, UINT) else None


def _components(value: ir.Expr) -> tuple[float, ...] | None:
    """The numbers of a constant made of literals, or None."""
    if isinstance(value, ir.Literal):
        return (float(value.value),)
    if not isinstance(value, ir.Construct) or not value.args:
        return None
    parts = [_components(arg) for arg in value.args]
    flat = tuple(number for part in parts if part is not None for number in part)
    if None in parts or (kind_of(value.type) and kind_of(value.type) != kind_of(value.args[0].type)):
        return None
    if len(flat) == 1 and isinstance(value.type, Matrix):
        return tuple(flat[0] * one for one in _identity(value.type))
    if len(flat) == 1:
        flat *= components(value.type)
    return flat if len(flat) == components(value.type) else None


def _identity(type_: Type) -> tuple[float, ...]:
    """What a uniform without a default holds: zeros, or the unit matrix."""
    if isinstance(type_, Matrix):
        return tuple(1.0 if row == column else 0.0 for column in range(type_.size) for row in range(type_.size))
    if isinstance(type_, Array):
        return _identity(type_.element) * type_.length
    return (0.0,) * components(type_)
