"""The precedence-aware printer that GLSL, HLSL and WGSL share. It prints legalised IR and decides nothing.

A language's printer overrides what differs: types, declarations, parameters, calls. Every printed line has the span of
source that it came from.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from sssgen.ir import nodes as ir
from sssgen.ir import signatures
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.memory_operations import MEMORY
from sssgen.ir.operators import PRECEDENCE
from sssgen.ir.types import (
    FLOAT,
    INT,
    UINT,
    VOID,
    Array,
    Image,
    Sampler,
    Scalar,
    Struct,
    Type,
    components,
    spell,
    unnested,
)
from sssgen.passes.scopes import claim, declared
from sssgen.passes.stage.stage_interface import Stage
from sssgen.passes.stage.storage_layout import with_free_bindings
from sssgen.support.diagnostics import failure
from sssgen.targets.descriptor import Target
from sssgen.targets.printers.number_text import float_text
from sssgen.targets.printers.printed_lines import WIDTH, Line, comment_text, is_postfix, summary, wrap
from sssgen.targets.uniform_layout import Member

if TYPE_CHECKING:
    from sssgen.targets.reflection_record import TextureBinding

_COLOR_LETTERS = str.maketrans("xyzw", "rgba")

UNARY, POSTFIX, PRIMARY, TERNARY = 13, 14, 15, -1
_SUM, _RELATIONAL, _EQUALITY = PRECEDENCE["+"], PRECEDENCE["<"], PRECEDENCE["=="]
_ALONE = frozenset(("<<", ">>", "&", "|", "^", "&&", "||"))


Comments = Callable[[str, int], list[str]]
"""Returns the author's comments before a line of a source file."""


def no_comments(file: str, line: int) -> list[str]:
    """For modules without a source."""
    return []


class Printer:
    """Prints one module for one target."""

    constant = "const"
    """The keyword of a module constant's declaration."""
    private = ""
    """The keyword of a module variable's declaration."""

    def __init__(self, target: Target, module: ir.Module) -> None:
        self.target = target
        self.module = module
        self.by_key = {function.key: function for function in module.functions}
        self.module_names = {function.name for function in module.functions}
        declarations = (module.variables, module.uniforms, module.constants)
        self.module_names |= {declaration.name for group in declarations for declaration in group}
        self.function: ir.Function | None = None
        self.chosen: set[str] = set()
        """The names of the current function, once `free_name` gave one."""
        self.comments: Comments = no_comments
        self.comment_behind: Callable[[str, int], str] = lambda file, line: ""
        """Returns the author's comment behind the code of a line."""
        self.source: Callable[[ir.Span], str] = lambda span: ""
        """Returns the line of source that a span begins on."""
        self.printed_comments: set[tuple[str, int]] = set()
        """The lines of the source whose comments are printed in the current function."""
        self.keeps_text = False
        """Whether the author's text is kept: numbers have their digits, and every comment stays."""
        self.texts: dict[tuple[str, tuple[Type, ...]], str] = {}
        self.inlined: Mapping[str, str] = {}
        """The texts of the current function's parameters, where its body is printed into other text."""
        self.groups: Mapping[str, str] = {}
        """A uniform's name → the technique that it belongs to."""
        self.stage: Stage | None = None
        """The interface of a whole shader."""
        self.buffers = [variable for variable in module.variables if variable.storage == "buffer"]
        self.images = [variable for variable in module.variables if variable.storage == "image"]
        self.methods: dict[type, Callable[[Any], tuple[str, int]]] = {
            ir.Literal: self.number_or_bool,
            ir.Local: self.local,
            ir.Global: lambda value: (self.global_value(value), PRIMARY),
            ir.Unary: self.unary,
            ir.Binary: self.binary,
            ir.Select: self.select,
            ir.Call: lambda call: (self.call(call), PRIMARY),
            ir.Intrinsic: self.intrinsic,
            ir.Construct: self.construct,
            ir.Swizzle: self.swizzle,
            ir.Index: self.index,
            ir.Member: self.member,
        }

    # Types and literals

    def type(self, type_: Type) -> str:
        """The type in the target's language."""
        if isinstance(type_, Struct):
            return type_.name
        if isinstance(type_, Array):
            return self.variable(type_, "")
        text = self.target.types.get(spell(type_))
        if text is None:
            raise failure(f"{self.target.title} has no {spell(type_)}")
        return text

    def sampler_type(self, type_: Type) -> str:
        """The type of a texture's separate sampler; one that compares has another type."""
        compares = isinstance(type_, Sampler) and type_.shadow
        return self.target.types.get("samplerShadow" if compares else "sampler", "")

    def variable(self, type_: Type, name: str) -> str:
        """A variable's declaration; in C the length of an array follows the name."""
        innermost, lengths = unnested(type_)
        listed = "".join([f"[{length or ''}]" for length in lengths])
        return f"{self.type(innermost)} {name}{listed}" if name else f"{self.type(innermost)}{listed}"

    def literal(self, literal: ir.Literal) -> str:
        if literal.type == FLOAT:
            return float_text(float(literal.value), self.keeps_text)
        if literal.type == INT:
            return str(literal.value) if literal.value != -2147483648 else "(-2147483647 - 1)"
        if literal.type == UINT:
            # large numbers are bit patterns
            return f"{literal.value:#x}u" if literal.value >= 1 << 16 else f"{literal.value}u"
        return "true" if literal.value else "false"

    # Expressions

    def expr(self, expr: ir.Expr, least: int = TERNARY) -> str:
        """The expression's text, in parentheses if its precedence is below `least`."""
        text, binding = self.bound(expr)
        return text if binding >= least else f"({text})"

    def bound(self, expr: ir.Expr) -> tuple[str, int]:
        """The expression's text and its precedence."""
        return self.methods[expr.__class__](expr)

    def number_or_bool(self, literal: ir.Literal) -> tuple[str, int]:
        text = self.literal(literal)
        return text, UNARY if text[0] == "-" else PRIMARY

    def swizzle(self, swizzle: ir.Swizzle) -> tuple[str, int]:
        return f"{self.expr(swizzle.value, POSTFIX)}.{self.letters(swizzle)}", POSTFIX

    def member(self, member: ir.Member) -> tuple[str, int]:
        return f"{self.expr(member.value, POSTFIX)}.{member.field}", POSTFIX

    def index(self, index: ir.Index) -> tuple[str, int]:
        return f"{self.expr(index.value, POSTFIX)}[{self.expr(index.index)}]", POSTFIX

    def unary(self, unary: ir.Unary) -> tuple[str, int]:
        operand = self.expr(unary.operand, UNARY)
        return f"{unary.op}{f'({operand})' if operand[0] == unary.op else operand}", UNARY

    def letters(self, swizzle: ir.Swizzle) -> str:
        """The letters of a swizzle: colours where the author wrote them, and of a texel, as readers expect."""
        value, colors = swizzle.value, swizzle.components.translate(_COLOR_LETTERS)
        if self.keeps_text and swizzle.span.line == swizzle.span.end_line:
            end = swizzle.span.end_column - 1
            if self.source(swizzle.span)[end - len(colors) : end] == colors:
                return colors
        texel = isinstance(value, ir.Intrinsic) and BUILTINS[value.name].kind == "fetch"
        return colors if texel and components(value.type) == 4 else swizzle.components

    def local(self, local: ir.Local) -> tuple[str, int]:
        text = self.inlined.get(local.name)
        if text is None:
            return local.name, PRIMARY
        return text, PRIMARY if is_postfix(text) else TERNARY

    def global_value(self, value: ir.Global) -> str:
        return value.name

    def binary(self, binary: ir.Binary) -> tuple[str, int]:
        """Parentheses are around operands of lower precedence, and around bitwise operators, shifts, and && next to ||.

        WGSL demands the latter, compilers warn without them, and few readers know these precedences.
        """
        op, level = binary.op, PRECEDENCE[binary.op]
        least, least_right = level, level + 1
        if op in _ALONE:
            chained = op not in ("<<", ">>") and isinstance(binary.left, ir.Binary) and binary.left.op == op
            least_right = _EQUALITY if op in ("&&", "||") else UNARY
            least = level if chained else least_right
        elif level in (_RELATIONAL, _EQUALITY):
            least = least_right = _SUM
        left, right = self.expr(binary.left, least), self.expr(binary.right, least_right)
        if right[0] == "-" and op in "+-":
            right = f"({right})"
        return f"{left} {op} {right}", level

    def select(self, select: ir.Select) -> tuple[str, int]:
        condition = self.expr(select.condition, TERNARY + 1)
        return f"{condition} ? {self.expr(select.yes, TERNARY + 1)} : {self.expr(select.no)}", TERNARY

    def arguments(self, args: tuple[ir.Expr, ...]) -> str:
        return self.join_arguments([self.expr(arg) for arg in args])

    def join_arguments(self, texts: list[str]) -> str:
        """The arguments, separated by commas."""
        return ", ".join(texts)

    def construct(self, construct: ir.Construct) -> tuple[str, int]:
        return f"{self.type(construct.type)}({self.arguments(construct.args)})", PRIMARY

    def call(self, call: ir.Call) -> str:
        function = self.by_key[call.function]
        args = [self.argument(arg, param) for arg, param in zip(call.args, function.params, strict=True)]
        return f"{function.name}({self.join_arguments(args)})"

    def argument(self, arg: ir.Expr, param: ir.Param) -> str:
        """The argument for a parameter of one of the module's own functions."""
        if isinstance(arg.type, Sampler) and isinstance(arg, ir.Global | ir.Local):
            return self.target.textures.argument.format(name=arg.name, sampler=self.sampler(arg.name))
        return self.expr(arg)

    def shell_argument(self, uniform: ir.Local, param: ir.Param) -> str:
        """A uniform or texture as the shell passes it to a function that has it as a parameter."""
        return self.argument(uniform, param)

    def intrinsic(self, call: ir.Intrinsic) -> tuple[str, int]:
        """A builtin, by the intrinsic table's text for this language."""
        text = self.builtin_text(call.name, tuple([arg.type for arg in call.args]))
        if "{" not in text:
            return f"{text}({self.arguments(call.args)})", PRIMARY
        named = {}
        first = call.args[0]
        if isinstance(first, ir.Global | ir.Local) and isinstance(first.type, Sampler):
            texture, sampler, bare = first.name, self.sampler(first.name), self.target.textures.bare
            named = {
                "texture": texture,
                "sampler": sampler,
                "bare_texture": bare.format(name=texture),
                "bare_sampler": self.target.textures.bare_sampler.format(name=sampler),
                "dim": first.type.dim.upper(),
                "channel": _channel(call.args[-1]),
            }
        args = [self.expr(arg) if not isinstance(arg.type, Sampler) else "" for arg in call.args]
        return text.format(*args, type=self.type(call.type), **named), PRIMARY

    def builtin_text(self, name: str, types: tuple[Type, ...]) -> str:
        """The language's text for a builtin of these types."""
        text = self.texts.get((name, types))
        if text is None:
            text = self.texts[name, types] = signatures.text(name, self.target.dialect, types)
        return text

    def sampler(self, texture: str) -> str:
        """The name of a texture's separate sampler."""
        return self.target.textures.sampler.format(name=texture)

    # Statements

    def block(self, block: ir.Block, indent: int) -> list[Line]:
        lines: list[Line] = []
        for stmt in block:
            place = (stmt.span.file, stmt.span.line)
            behind = ""
            if place not in self.printed_comments:
                self.printed_comments.add(place)
                lines += [
                    Line(f"{'    ' * indent}// {comment_text(text)}", stmt.span) for text in self.comments(*place)
                ]
                behind = comment_text(self.comment_behind(*place)) if self.keeps_text else ""
            printed = self.statement(stmt, indent)
            if behind and len(printed[0].text) + len(behind) + 5 <= WIDTH:
                printed[0] = printed[0]._replace(text=f"{printed[0].text}  // {behind}")
            elif behind:
                lines.append(Line(f"{'    ' * indent}// {behind}", stmt.span))
            lines.extend(printed)
        return lines

    def statement(self, stmt: ir.Stmt, indent: int) -> list[Line]:
        """A statement's lines."""
        pad = "    " * indent
        if isinstance(stmt, ir.If):
            lines = wrap(f"{pad}if ({self.expr(stmt.condition)}) {{", stmt.span)
            lines += self.block(stmt.then, indent + 1)
            while len(stmt.otherwise) == 1 and isinstance(stmt.otherwise[0], ir.If):
                stmt = stmt.otherwise[0]
                lines += wrap(f"{pad}}} else if ({self.expr(stmt.condition)}) {{", stmt.span)
                lines += self.block(stmt.then, indent + 1)
            if stmt.otherwise:
                lines += [Line(f"{pad}}} else {{"), *self.block(stmt.otherwise, indent + 1)]
            return [*lines, Line(f"{pad}}}")]
        if isinstance(stmt, ir.For | ir.While):
            head = (
                f"for ({self.loop_header(stmt)})"
                if isinstance(stmt, ir.For)
                else f"while ({self.expr(stmt.condition)})"
            )
            return [*wrap(f"{pad}{head} {{", stmt.span), *self.block(stmt.body, indent + 1), Line(f"{pad}}}")]
        if isinstance(stmt, ir.MemoryOperation):
            return [line for text in self.memory(stmt).split("\n") for line in wrap(f"{pad}{text}", stmt.span)]
        return wrap(f"{pad}{self.simple(stmt)};", stmt.span)

    def memory(self, stmt: ir.MemoryOperation) -> str:
        """An operation on shared memory, by its row's text for this language."""
        pattern = self.memory_text(stmt)
        result = self.expr(stmt.result) if stmt.result is not None else ""
        into, also, first = (f"{result} = ", f", {result}", ".x") if result else ("", "", "")
        typed = stmt.result if stmt.result is not None or not stmt.args else stmt.args[-1]
        type_ = self.type(typed.type) if typed is not None and "{type}" in pattern else ""
        free = self.free_name("extent" if stmt.name == "imageSize" else "swapped") if "{free}" in pattern else ""
        args = [*map(self.place, stmt.args[:1]), *map(self.expr, stmt.args[1:])]
        text = pattern.format(*args, result=result, into=into, also=also, first=first, free=free, type=type_)
        return text if text.endswith("}") else f"{text};"

    def memory_text(self, stmt: ir.MemoryOperation) -> str:
        """The row's text for this language, and for the kind of image."""
        texts, language = MEMORY[stmt.name].texts, self.target.language
        image = stmt.args[0].type if stmt.args else VOID
        shape = f"{image.dim}{'Array' if image.array else ''}" if isinstance(image, Image) else ""
        return texts.get(f"{language}-{shape}", texts[language])

    def place(self, expr: ir.Expr) -> str:
        """A place in memory, without reading it."""
        return self.expr(expr, POSTFIX)

    def free_name(self, name: str) -> str:
        """About this name, which neither the function nor the module has; each call gives another one."""
        assert self.function is not None
        if not self.chosen:
            self.chosen.update(declared(self.function), self.module_names)
        return claim(name, self.chosen)

    def loop_header(self, loop: ir.For) -> str:
        init = self.simple(loop.init) if loop.init is not None else ""
        condition = self.expr(loop.condition) if loop.condition is not None else ""
        step = self.simple(loop.step) if loop.step is not None else ""
        return f"{init}; {condition}; {step}"

    def simple(self, stmt: ir.Stmt) -> str:
        """A statement without inner blocks, without its semicolon."""
        if isinstance(stmt, ir.Declare):
            return self.declare(stmt)
        if isinstance(stmt, ir.Assign):
            target = self.target_of(stmt.target)
            is_one = isinstance(stmt.value, ir.Literal) and stmt.value.value == 1 and stmt.value.type in (INT, UINT)
            if is_one and stmt.op in ("+", "-") and isinstance(stmt.target.type, Scalar):
                return f"{target}{stmt.op * 2}"
            return f"{target} {stmt.op}= {self.expr(stmt.value)}"
        if isinstance(stmt, ir.Return):
            return f"return {self.expr(stmt.value)}" if stmt.value is not None else "return"
        if isinstance(stmt, ir.Evaluate):
            return self.expr(stmt.call)
        if isinstance(stmt, ir.Discard):
            return "discard"
        return "break" if isinstance(stmt, ir.Break) else "continue"

    def target_of(self, target: ir.Expr) -> str:
        return self.expr(target, POSTFIX)

    def declare(self, declare: ir.Declare) -> str:
        text = self.variable(declare.type, declare.name)
        return f"{text} = {self.expr(declare.value)}" if declare.value is not None else text

    # Declarations

    def param(self, param: ir.Param) -> str:
        """A parameter of a function."""
        if isinstance(param.type, Sampler):
            pattern = self.target.textures.parameter
            return pattern.format(
                name=param.name,
                sampler=self.sampler(param.name),
                type=self.type(param.type),
                sampler_type=self.sampler_type(param.type),
                dim=param.type.dim.upper(),
            )
        text = self.variable(param.type, param.name)
        return text if param.direction == "in" else f"{param.direction} {text}"

    def signature(self, function: ir.Function) -> str:
        params = ", ".join([self.param(param) for param in function.params])
        return f"{self.type(function.result)} {function.name}({params})"

    def print_function(self, function: ir.Function) -> list[Line]:
        """A function with the first line of its documentation."""
        self.enter(function)
        lines = [Line(f"// {text}", function.span) for text in self.doc_of(function)]
        lines += wrap(f"{self.signature(function)} {{", function.span)
        lines += self.block(function.body or (), 1)
        lines.append(Line("}"))
        return lines

    def print_body(self, function: ir.Function, texts: Mapping[str, str]) -> list[Line]:
        """The statements of a function, with these texts in place of its parameters.

        Its last statement returns the value, for which the descriptor has the text.
        """
        self.enter(function)
        self.inlined = texts
        *body, last = function.body or ()
        assert isinstance(last, ir.Return) and last.value is not None
        lines = self.block(tuple(body), 0)
        lines += wrap(self.target.fragment_result.format(self.expr(last.value)), last.span)
        self.inlined = {}
        return lines

    def enter(self, function: ir.Function) -> None:
        """Prepares for the text of a function."""
        self.function, self.chosen = function, set()
        self.printed_comments = {(function.span.file, function.span.line)}

    def doc_of(self, function: ir.Function) -> list[str]:
        """The comment before a function: its author's, or the first sentence of its documentation."""
        if not self.keeps_text:
            return summary(function.doc)
        lines = [comment_text(line.rstrip()) for line in function.doc.strip("\n").split("\n")]
        return lines if any(lines) else []

    def print_struct(self, struct: ir.StructDecl) -> list[Line]:
        """A struct; that of a storage buffer is its block in GLSL, and HLSL has elements instead of its members."""
        assert isinstance(struct.type, Struct)
        if any(buffer.type == struct.type for buffer in self.buffers):
            return []
        fields = [Line(f"    {self.variable(field.type, field.name)};", struct.span) for field in struct.type.fields]
        return [Line(f"struct {struct.type.name} {{", struct.span), *fields, Line("};")]

    def print_imports(self) -> list[Line]:
        """What the text imports; after everything else is printed."""
        return []

    def print_layout(self) -> list[Line]:
        """What a whole shader states before its variables."""
        return []

    def buffer_binding(self, buffer: ir.Variable) -> int:
        """The binding of a storage buffer: that of the source, or the next one that no other buffer has."""
        return with_free_bindings([(each.name, each.location) for each in self.buffers])[buffer.name]

    def image_binding(self, image: ir.Variable) -> int:
        """The binding of an image: that of the source, or the next one that no other image has."""
        return with_free_bindings([(each.name, each.location) for each in self.images])[image.name]

    def print_uniforms(self, members: list[Member]) -> list[Line]:
        """The declarations of the uniforms without textures."""
        raise NotImplementedError

    def print_textures(self, textures: list[ir.Uniform]) -> list[Line]:
        """The declarations of the textures."""
        raise NotImplementedError

    def binding(self, index: int) -> TextureBinding:
        """The bindings of the texture at `index`; empty where the text states none."""
        return {}

    def print_constant(self, constant: ir.Constant) -> list[Line]:
        declared = self.variable(constant.type, constant.name)
        return wrap(f"{self.constant} {declared} = {self.expr(constant.value)};", constant.span)

    def print_variable(self, variable: ir.Variable) -> list[Line]:
        """A module variable."""
        value = f" = {self.expr(variable.value)}" if variable.value is not None else ""
        text = f"{self.private}{self.variable(variable.type, variable.name)}{value};"
        return self.with_comments(variable, wrap(text, variable.span))

    def with_comments(self, variable: ir.Variable, lines: list[Line]) -> list[Line]:
        """A declaration after its author's comments."""
        comments = [Line(f"// {comment_text(text)}") for text in self.comments(variable.span.file, variable.span.line)]
        return [*comments, *lines]

    def print_entry(self, name: str) -> list[Line]:
        """The entry function of the stage, where that is not the author's own."""
        return []


def _channel(arg: ir.Expr) -> str:
    """The name of the channel with this literal index; Red for any other expression."""
    number = int(arg.value) if isinstance(arg, ir.Literal) and arg.type == INT else 0
    return ("Red", "Green", "Blue", "Alpha")[number] if 0 <= number < 4 else "Red"
