"""Checks a parsed file and gives its IR module.

Each checker holds the shared CheckContext and the checkers that it calls. Expressions and statements nest in each
other, so their checkers find each other in tables (`methods`), which are complete once all checkers are made.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress

from sssgen.ir import nodes as ir
from sssgen.ir.contracts import of_uniform
from sssgen.ir.types import Struct
from sssgen.lang.check.access_checker import AccessChecker
from sssgen.lang.check.assignment_checker import AssignmentChecker
from sssgen.lang.check.builtin_variables import builtin_variable, check_colors
from sssgen.lang.check.call_checker import CallChecker
from sssgen.lang.check.call_graph import callees_first, calls_in, report_deep_calls, report_recursion
from sssgen.lang.check.constant_values import constant_value
from sssgen.lang.check.context import AlreadyReported, CheckContext, Language
from sssgen.lang.check.declared_names import declare_struct, names_of_file
from sssgen.lang.check.expression_checker import ExpressionChecker
from sssgen.lang.check.function_checker import FunctionChecker
from sssgen.lang.check.global_checker import GlobalChecker
from sssgen.lang.check.implicit_lengths import ImplicitLengths
from sssgen.lang.check.line_textures import without_lines
from sssgen.lang.check.loop_checker import LoopChecker
from sssgen.lang.check.name_scope import GlobalValue
from sssgen.lang.check.operator_checker import OperatorChecker
from sssgen.lang.check.shader_interface import ShaderInterface
from sssgen.lang.check.statement_checker import StatementChecker
from sssgen.lang.check.switch_checker import SwitchChecker
from sssgen.lang.syntax import tree as s
from sssgen.lang.syntax.parser import parse
from sssgen.support.diagnostics import Reporter


def check(file: s.File, text: str, included: ir.Module = ir.Module()) -> ir.Module:  # noqa: B008 - immutable
    """Checks a technique's file; `included` has the declarations that it includes.

    Raises SssgenError with every error.
    """
    reporter = Reporter(file.name, text)
    checker = ModuleChecker(CheckContext(reporter))
    checker.include(included)
    module = checker.module(file)
    reporter.check()
    return module


def check_plain(file: s.File, reporter: Reporter, language: Language) -> ir.Module:
    """Checks a file of plain GLSL. Raises SssgenError with every error."""
    module = ModuleChecker(CheckContext(reporter, True, language)).module(file)
    reporter.check()
    return module


class ModuleChecker:
    """Checks the declarations of one file in order."""

    def __init__(self, context: CheckContext) -> None:
        self.context = context
        expressions = ExpressionChecker(context)
        OperatorChecker(expressions)
        AccessChecker(expressions)
        self.memory = CallChecker(expressions, self.add_function).memory
        statements = StatementChecker(AssignmentChecker(expressions))
        LoopChecker(statements)
        SwitchChecker(statements)
        self.function_checker = FunctionChecker(statements)
        self.globals = GlobalChecker(expressions, ShaderInterface(expressions), self.memory)
        self.functions: dict[str, ir.Function] = {}
        self.added: dict[str, ir.Function] = {}
        """The functions that replace builtins with out parameters, by their keys."""

    def include(self, module: ir.Module) -> None:
        """Declares everything that an included module has."""
        context = self.context
        context.struct_declarations += module.structs
        for struct in module.structs:
            assert isinstance(struct.type, Struct)
            context.structs[struct.type.name] = struct.type
        for constant in module.constants:
            context.globals[constant.name] = GlobalValue(
                constant.type, "", constant_value(context, constant.value), True
            )
        for uniform in module.uniforms:
            context.globals[uniform.name] = GlobalValue(uniform.type, uniform.quantity, extent=of_uniform(uniform)[:2])
        for function in module.functions:
            self.function_checker.include(function)
            self.functions[function.key] = function
        self.globals.constants += module.constants
        self.globals.uniforms += module.uniforms

    def add_function(self, name: str, source: str) -> None:
        """Checks and declares the function that replaces the builtin `name`; it does not see the file's functions."""
        context = self.context
        own, context.functions = context.functions, {}
        for external in parse(source, f"intrinsics/{name}").externals:
            assert isinstance(external, s.FunctionSyntax)
            function = self.function_checker.function(external)
            self.added[function.key] = function
        for added, signatures in context.functions.items():
            own.setdefault(added, []).extend(signatures)
        context.functions = own

    def module(self, file: s.File) -> ir.Module:
        """Checks a file. A function may call only functions that are declared before it."""
        context = self.context
        context.file_names = names_of_file(file)
        if not context.es:
            context.length_by_use = ImplicitLengths(file).of
        for external in file.externals:
            try:
                self.external(external)
            except AlreadyReported:
                context.faulty.update(_declared_names(external))
        functions = self.added | self.functions if context.plain else self.functions
        with suppress(AlreadyReported):
            functions = self.globals.interface.with_starts(functions)
        calls = calls_in(functions)
        report_recursion(functions, calls, context.reporter)
        if context.plain and not context.reporter.diagnostics:
            functions = callees_first(functions, calls, self.function_checker.define_zeros)
        report_deep_calls(functions, calls, context.reporter)
        self.memory.find_stage()
        self.memory.check_stage()
        check_colors(context)
        main = functions.get("main()") if context.language.vertex else None
        if main is not None and "gl_Position" not in context.variables:  # a stage that has it is a vertex shader
            builtin_variable(context, s.Name("gl_Position", main.span))
        module = ir.Module(
            tuple(context.struct_declarations),
            tuple(self.globals.constants),
            (*self.globals.uniforms, *context.draw_uniforms),
            tuple(functions.values()),
            tuple(context.variables.values()),
            context.workgroup,
        )
        return without_lines(module, context) if context.has_lines else module

    def external(self, external: s.External) -> None:
        """Checks one declaration."""
        if isinstance(external, s.StructSyntax):
            declare_struct(self.context, external)
        elif isinstance(external, s.LayoutSyntax):
            self.memory.layout(external)
        elif isinstance(external, s.BlockSyntax):
            self.globals.block(external)
        elif isinstance(external, s.GlobalSyntax):
            self.globals.global_(external)
        else:
            function = self.function_checker.function(external)
            if self.context.plain and function.body is not None:
                self.functions.pop(function.key, None)  # its position is that of its body, not of its prototype
            if function.body is not None or function.key not in self.functions:
                self.functions[function.key] = function


def _declared_names(external: s.External) -> Iterator[str]:
    if isinstance(external, s.GlobalSyntax):
        yield from (declarator.name.text for declarator in external.declaration.declarators)
    else:
        yield external.name.text
