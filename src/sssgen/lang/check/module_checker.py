"""Checks a parsed file and gives its IR module: its declarations, functions in order, no recursion."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

from sssgen.ir import nodes as ir
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.rules import returns
from sssgen.ir.types import INT, UINT, VOID, Array, Field, Matrix, Sampler, Struct, Type, components, kind_of, spell
from sssgen.ir.walk import callees, subexpressions
from sssgen.lang.check import quantities as q
from sssgen.lang.check.expression_checker import Untyped
from sssgen.lang.check.name_scope import GlobalValue, Scopes, Signature
from sssgen.lang.check.shader_interface import BUILTIN_VARIABLES, Interface
from sssgen.lang.check.statement_checker import StatementChecker, zero
from sssgen.lang.check.termination import cycles
from sssgen.lang.check.uniform_hints import check_hints
from sssgen.lang.check.wording import a_type
from sssgen.lang.syntax import tree as s
from sssgen.support.diagnostics import Reporter

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
    """Checks a technique's file; `included` holds what its includes brought. Raises SssgenError with every error."""
    reporter = Reporter(file.name, text)
    checker = _FileChecker(reporter)
    checker.bring_in(included)
    module = checker.file(file)
    reporter.check()
    return module


def check_plain(file: s.File, reporter: Reporter, vertex: bool) -> ir.Module:
    """Checks a file of plain GLSL; `vertex` says which stage its inputs are of. Raises SssgenError with every error."""
    checker = _FileChecker(reporter, True, vertex)
    module = checker.file(file)
    reporter.check()
    return module


MAX_CALLS = 64
"""How deep calls may go: compilers inline them all, one in the other."""


class _FileChecker(StatementChecker):
    """Checks the declarations of one file."""

    def __init__(self, reporter: Reporter, plain: bool = False, vertex: bool = False) -> None:
        super().__init__(reporter, plain)
        self.included = ir.Module()
        self.defined: set[ir.Span] = set()
        """The functions that have a body, by the span of their name."""
        self.struct_declarations: list[ir.StructDecl] = []
        self.brought: dict[str, ir.Function] = {}
        """The functions that stand for builtins with out parameters, by their keys."""
        self.interface = Interface(self, vertex)

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
        """Checks everything in order; a function may call only what stands before it, or has a prototype there."""
        before = self.included
        self.struct_declarations += before.structs
        constants, uniforms = list(before.constants), self.interface.uniforms
        uniforms += before.uniforms
        functions = {function.key: function for function in before.functions}
        for external in file.externals:
            try:
                if isinstance(external, s.StructSyntax):
                    self.struct(external)
                elif isinstance(external, s.BlockSyntax):
                    members = self.interface.members(external)
                    for member in members:
                        self.global_(member)
                    self.interface.name_instance(external, members)
                elif isinstance(external, s.GlobalSyntax):
                    constants.extend(self.global_(external))
                else:
                    function = self.function(external)
                    if self.plain and function.body is not None:
                        functions.pop(function.key, None)  # its place is that of its body
                    if function.body is not None or function.key not in functions:
                        functions[function.key] = function
            except Untyped:
                self.faulty.update(_declared_names(external))
        for cycle in cycles(functions):
            names = " → ".join(key.split("(")[0] for key in cycle)
            message = f"recursion is not possible in a shader: {names}"
            self.reporter.error(functions[cycle[0]].span, message, "rewrite it as a loop")
        if self.plain:
            functions = self.in_order(self.brought | functions)
        self.limit_calls(functions)
        return ir.Module(
            tuple(self.struct_declarations),
            tuple(constants),
            tuple(uniforms),
            tuple(functions.values()),
            tuple(self.interface.variables.values()),
        )

    def in_order(self, functions: dict[str, ir.Function]) -> dict[str, ir.Function]:
        """The functions that have a body, each after those that it calls, otherwise as they stand."""
        if self.reporter.diagnostics:
            return functions
        calls = {key: callees(function) for key, function in functions.items()}
        for key in dict.fromkeys(callee for found in calls.values() for callee in found):
            if functions[key].body is None:
                functions[key] = self.stand_in(functions[key])
        found: dict[str, ir.Function] = {}
        for start in functions:
            pending = [start]
            while pending:
                key = pending[-1]
                function = functions[key]
                missing = [callee for callee in calls[key] if callee not in found]
                if not missing:
                    pending.pop()
                    if function.body is not None:
                        found[key] = function
                pending += missing
        return found

    def stand_in(self, function: ir.Function) -> ir.Function:
        """A function that the file expects from whoever includes it: it gives zeros, and the author is told."""
        span = function.span
        message = f"'{function.name}' is declared and called, but has no body in this file: it gives zeros"
        hint = "write its body in the translation, or give the file that has it"
        self.reporter.warn(span, message, hint)
        outs = [param for param in function.params if param.direction == "out"]
        body: list[ir.Stmt] = [
            ir.Assign(ir.Local(param.type, param.name, span), "", zero(param.type, span), span) for param in outs
        ]
        if function.result != VOID:
            body.append(ir.Return(zero(function.result, span), span))
        return function._replace(body=tuple(body), doc=function.doc or "Write this: the file only declares it.")

    def limit_calls(self, functions: dict[str, ir.Function]) -> None:
        """Reports the first function whose calls go too deep; a function stands after those it calls."""
        depth: dict[str, int] = {}
        for key, function in functions.items():
            depth[key] = 1 + max([depth.get(callee, 0) for callee in callees(function)], default=0)
            if depth[key] > MAX_CALLS:
                message = f"{function.name} calls functions more than {MAX_CALLS} deep"
                self.reporter.error(function.span, message, "join some of them")
                return

    def builtin_variable(self, name: s.Name) -> GlobalValue | None:
        return self.interface.builtin(name) if self.plain else None

    def bring_builtin(self, name: str, source: str) -> None:
        from sssgen.lang.syntax.parser import parse

        outer = self.scopes, self.result, self.loops, self.fallen, self.prelude
        for external in parse(source, f"intrinsics/{name}").externals:
            assert isinstance(external, s.FunctionSyntax)
            function = self.function(external)
            self.brought[function.key] = function
        self.scopes, self.result, self.loops, self.fallen, self.prelude = outer

    # Declarations

    def new_name(self, name: s.Name, functions: bool = False) -> str:
        """Checks that a module-level name is free and allowed."""
        self.allowed(name)
        taken = name.text in self.globals or name.text in self.structs
        taken = taken or (name.text in q.QUANTITIES and not self.plain)
        if taken or (not functions and name.text in self.functions):
            raise self.fail(name.span, f"'{name.text}' is already declared")
        return name.text

    def local_struct(self, struct: s.StructSyntax) -> None:
        self.struct(struct)

    def allowed(self, name: s.Name) -> None:
        text = name.text
        if self.plain:
            if text.startswith("gl_") and text not in BUILTIN_VARIABLES:
                raise self.fail(name.span, f"'{text}' is reserved in GLSL")
            return
        if text in RESERVED or _RESERVED_TYPES.match(text) or text.startswith("gl_") or "__" in text:
            other = re.sub("_+", "_", f"{text.removeprefix('gl_')}_value")
            raise self.fail(name.span, f"'{text}' is reserved in GLSL", f"choose another name, such as '{other}'")

    def struct(self, struct: s.StructSyntax) -> None:
        """A struct; one that a function declares is the module's, as other languages have no others."""
        name = self.new_name(struct.name)
        fields: dict[str, Field] = {}
        for member in struct.members:
            if member.type.struct is not None:
                self.struct(member.type.struct)
            type_, quantity = self.type_named(member.type)
            for declarator in member.declarators:
                if declarator.name.text in fields:
                    raise self.fail(declarator.name.span, f"member '{declarator.name.text}' is declared twice")
                self.allowed(declarator.name)
                field_type = self.array_of(type_, declarator.lengths)
                if isinstance(field_type, Sampler) or field_type == VOID:
                    raise self.fail(declarator.name.span, f"a member cannot be {a_type(field_type)}")
                fields[declarator.name.text] = Field(declarator.name.text, field_type, quantity)
        type_ = self.structs[name] = Struct(name, tuple(fields.values()))
        self.struct_declarations.append(ir.StructDecl(type_, struct.doc, struct.name.span))

    def global_(self, external: s.GlobalSyntax) -> list[ir.Constant]:
        """What stands at file scope, as its qualifiers say; gives the constants."""
        declaration, words = external.declaration, external.declaration.qualifiers.words
        if not declaration.declarators and declaration.type.struct is None:
            if "invariant" in words or "precise" in words:
                return []  # no other language has it
            raise self.fail(declaration.type.span, "this declares nothing", "a type and a name are wanted")
        if declaration.type.struct is not None:
            self.struct(declaration.type.struct)
        if "uniform" in words:
            for declarator in declaration.declarators:
                for one in self.interface.textures(declaration, declarator):
                    self.interface.uniforms.append(self.uniform(declaration, one, external.doc))
            return []
        if "const" in words:
            return self.constant(declaration)
        if not self.plain:
            message = "a variable of the module is not in the language of techniques"
            raise self.fail(declaration.type.span, message, "make it const, a uniform, or a parameter")
        self.interface.declare(declaration, external.doc)
        return []

    def uniform(self, declaration: s.Declaration, declarator: s.Declarator, doc: str) -> ir.Uniform:
        name = self.new_name(declarator.name)
        type_, quantity = self.type_named(declaration.type)
        type_ = self.array_of(type_, declarator.lengths)
        whole = isinstance(type_.element if isinstance(type_, Array) else type_, Struct)
        if type_ == VOID or (whole and not self.plain):
            raise self.fail(declaration.type.span, f"a uniform cannot be {a_type(type_)}")
        default: tuple[float, ...] = ()
        written = declarator.value
        if written is not None:
            if isinstance(type_, Sampler):
                hint = "use default_white, default_black, default_gray or default_bump"
                raise self.fail(written.span, "a texture has no default value", hint)
            value = self.require(self.check(written)._replace(quantity=""), type_, "", written.span, f"'{name}'")
            constants = _components(value)
            if constants is None:
                hint = "write it as 0.2 or vec3(1.0, 0.5, 0.0)"
                raise self.fail(written.span, "a default is made of literals", hint)
            default = constants
        elif not isinstance(type_, Sampler):
            default = _identity(type_)
        hints, held = check_hints(self, declarator, type_, default)
        self.globals[name] = GlobalValue(type_, quantity or held)
        return ir.Uniform(name, type_, default, hints, quantity or held, doc, declarator.name.span)

    def constant(self, declaration: s.Declaration) -> list[ir.Constant]:
        found = []
        of_macro = declaration.type.name == "auto"
        type_, quantity = (VOID, "") if of_macro else self.type_named(replace(declaration.type, lengths=()))
        for declarator in declaration.declarators:
            name = self.new_name(declarator.name)
            if declarator.value is None:
                raise self.fail(declarator.name.span, f"const '{name}' needs a value")
            if of_macro:
                value = self.check(declarator.value).expr
                declared = value.type
            else:
                declared = self.declared_type(type_, declaration.type, declarator)
                value = self.check_as(declarator.value, declared, quantity, f"'{name}'")
            if any(self.varies(part) for part in subexpressions(value)):
                message = f"the value of const '{name}' is not constant"
                raise self.fail(declarator.value.span, message, "use literals, other constants and builtins")
            whole = self.constant_int(declarator.value) if declared in (INT, UINT) else None
            self.globals[name] = GlobalValue(declared, quantity, whole, True)
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
            type_ = self.array_of(type_, param.lengths)
            if type_ == VOID or (isinstance(type_, Sampler) and param.direction != "in"):
                raise self.fail(param.type.span, f"a parameter cannot be '{param.direction} {spell(type_)}'")
            label = param.name or s.Name(f"unnamed_{index + 1}", param.type.span)
            self.allowed(label)
            writable = not (param.const and self.plain)
            if self.scopes.declare(label.text, type_, held, writable) is None:
                raise self.fail(label.span, f"parameter '{label.text}' is declared twice")
            params.append(ir.Param(label.text, type_, param.direction, held, label.span))
        made = ir.Function(name.text, tuple(params), result, quantity, None, function.doc, name.span)
        self.declare_function(made, name, function.body is not None)
        if function.body is None:
            return made
        self.result, self.loops, self.fallen = (result, quantity), 0, 0
        errors, faults = len(self.reporter.diagnostics), self.faults
        if self.plain:
            self.scopes.push()  # older GLSL lets a variable hide a parameter
        body = self.statements(function.body.statements)
        if result != VOID and self.plain and not returns(body):
            body = (*body, ir.Return(zero(result, name.span), name.span))  # what it gives there is undefined
        whole = len(self.reporter.diagnostics) == errors and self.faults == faults
        if result != VOID and not returns(body) and whole:
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
    if isinstance(external, s.GlobalSyntax):
        yield from (declarator.name.text for declarator in external.declaration.declarators)
    else:
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
