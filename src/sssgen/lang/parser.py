"""Source text → syntax tree, with lark's LALR parser.

A syntax error does not hide the next: the faulty declaration is blanked out and the rest is parsed again.
"""

from __future__ import annotations

import os
import re
from typing import TYPE_CHECKING, Any

from ..diagnostics import Reporter
from ..ir.nodes import Span
from ..ir.operators import PRECEDENCE
from . import syntax as s
from .comments import attach_docs

if TYPE_CHECKING:
    from lark import Lark, Token

MAX_DEPTH = 100
"""How deeply expressions and statements may nest, together. Hand-written shaders stay below 30; passes and printers
recurse over what is nested, and a stack of Python's own 1000 frames must be enough for them."""

_TOO_DEEP = (
    f"nested more than {MAX_DEPTH} levels deep",
    "name a part of it in a local variable or a function of its own",
)

MAX_OPERATORS = 1000
"""How many operators one expression may have outside its brackets."""

MAX_SYNTAX_ERRORS = 20

_TOKEN_NAMES = {
    "NAME": "a name", "INT": "a number", "FLOAT": "a number", "TYPE": "a type", "SEMICOLON": "';'", "LPAR": "'('",
    "RPAR": "')'", "LBRACE": "'{'", "RBRACE": "'}'", "RSQB": "']'", "COMMA": "','", "ASSIGN": "'='", "COLON": "':'",
    "DOT": "'.'", "LSQB": "'['", "OPERATOR": "an operator", "STRING": "a quoted text",
}  # fmt: skip


def parse(text: str, file: str) -> s.File:
    """Parses a source file. Raises `SssgenError` with every syntax error found."""
    from lark.exceptions import UnexpectedCharacters, UnexpectedToken

    reporter = Reporter(file, text)
    _check_nesting(text, reporter)
    reporter.check()
    remaining = text
    for _ in range(MAX_SYNTAX_ERRORS):
        builder = _Builder(file)
        try:
            externals = _parser(builder).parse(remaining)
            break
        except UnexpectedToken as error:
            position, span, message, hint = _describe(error, remaining, file)
        except UnexpectedCharacters as error:
            position = error.pos_in_stream or 0
            message, hint = _describe_character(remaining, position)
            span = _place(remaining, position, file)
        reporter.error(span, message, hint)
        remaining = _blank_declaration(remaining, position)
        if not remaining.strip():
            break
    reporter.check()
    if builder.too_deep is not None:
        reporter.error(builder.too_deep, *_TOO_DEEP)
        reporter.check()
    return s.File(file, attach_docs(externals, builder.comments, reporter.lines), tuple(builder.comments))


_cached: Lark | None = None


def _parser(builder: _Builder) -> Any:
    """The LALR parser, its tables kept on disk between processes and in memory between calls."""
    global _cached
    if _cached is None:
        from importlib.resources import files

        from lark import Lark

        from ..cache import folder

        kept = folder()
        _cached = Lark(
            files(__package__).joinpath("grammar.lark").read_text("utf-8"),
            parser="lalr",
            cache=os.path.join(kept, "grammar.lark.cache") if kept else False,
            transformer=_Relay(),
            lexer_callbacks={"COMMENT": lambda token: _Relay.target.comment(token)},
        )
    _Relay.target = builder
    return _cached


class _Relay:
    """Hands lark's callbacks to the builder of the parse at hand, so that one parser serves every parse."""

    target: _Builder

    def __getattr__(self, rule: str) -> Any:
        method = getattr(_Builder, rule)  # raises AttributeError for what lark only probes
        return lambda children: method(_Relay.target, children)


class _Builder:
    """Builds the syntax tree; one method a rule of the grammar, given the rule's children."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.comments: list[tuple[int, int, str]] = []
        self.too_deep: Span | None = None

    def comment(self, token: Token) -> Token:
        self.comments.append((_line(token), _end_line(token), str(token)))
        return token

    # Spans and depth

    def at(self, token: Any) -> Span:
        return Span(self.file, token.line, token.column, token.end_line, token.end_column)

    def deeper(self, span: Span, *parts: Any) -> int:
        depth = 1 + max([getattr(part, "depth", 0) for part in parts], default=0)
        if depth > MAX_DEPTH and self.too_deep is None:
            self.too_deep = span
        return depth

    def name_of(self, token: Any) -> s.Name:
        return s.Name(str(token), self.at(token))

    # Declarations

    def start(self, children: list[Any]) -> list[Any]:
        return [child for child in children if child is not None]

    def version(self, children: list[Any]) -> None:
        return None

    def precision(self, children: list[Any]) -> None:
        return None

    def include(self, children: list[Any]) -> s.IncludeSyntax:
        return s.IncludeSyntax(str(children[1])[1:-1], self.at(children[1]))

    def function(self, children: list[Any]) -> s.FunctionSyntax:
        result, name, params, body = children
        return s.FunctionSyntax(result, self.name_of(name), params or (), body, "")

    def prototype(self, children: list[Any]) -> s.FunctionSyntax:
        result, name, params = children
        return s.FunctionSyntax(result, self.name_of(name), params or (), None, "")

    def params(self, children: list[Any]) -> tuple[s.Parameter, ...]:
        if len(children) == 1 and children[0].name is None and children[0].type.name == "void":
            return ()
        return tuple(children)

    def param(self, children: list[Any]) -> s.Parameter:
        *qualifiers, type_, name, length = children
        direction = next((word for word in qualifiers if word != "const"), "in")
        return s.Parameter(direction, type_, self.name_of(name) if name is not None else None, length)

    def qualifier(self, children: list[Any]) -> str:
        return str(children[0])

    def uniform(self, children: list[Any]) -> s.UniformSyntax:
        type_, name, length, hints, value = children
        return s.UniformSyntax(type_, self.name_of(name), length, hints or (), value, "")

    def hints(self, children: list[Any]) -> tuple[s.Hint, ...]:
        return tuple(children)

    def hint(self, children: list[Any]) -> s.Hint:
        name, *args = children
        return s.Hint(self.name_of(name), tuple(arg for arg in args if arg is not None))

    def hint_arg(self, children: list[Any]) -> float | str:
        token = children[-1]
        if token.type == "STRING":
            return str(token)[1:-1]
        if token.type == "NAME":
            return str(token)
        text = str(token)
        hexadecimal = text[:2] in ("0x", "0X")
        value = float(int(text[:40].rstrip("uU"), 16)) if hexadecimal else float(text.rstrip("fFuU"))
        return -value if children[0] is not None and str(children[0]) == "-" else value

    def constant(self, children: list[Any]) -> s.ConstantSyntax:
        type_, declarators = children
        return s.ConstantSyntax(s.Declaration(True, type_, declarators, type_.span))

    def struct(self, children: list[Any]) -> s.StructSyntax:
        return s.StructSyntax(self.name_of(children[0]), tuple(children[1:]), "")

    def member(self, children: list[Any]) -> s.Declaration:
        type_, declarators = children
        return s.Declaration(False, type_, declarators, type_.span)

    def type(self, children: list[Any]) -> s.TypeName:
        token = children[1]
        length = children[2] if len(children) > 2 else None
        return s.TypeName(str(token), length, self.at(token))

    def array(self, children: list[Any]) -> Any:
        length, end = children
        return length if length is not None else s.Number("0", False, self.at(end))

    def declarators(self, children: list[Any]) -> tuple[s.Declarator, ...]:
        return tuple(children)

    def declarator(self, children: list[Any]) -> s.Declarator:
        name, length, value = children
        return s.Declarator(self.name_of(name), length, value)

    # Statements

    def block(self, children: list[Any]) -> s.Compound:
        statements = tuple([self.as_statement(child) for child in children[1:-1] if child is not None])
        span = _join(self.at(children[0]), self.at(children[-1]))
        return s.Compound(statements, span, self.deeper(span, *statements))

    def empty(self, children: list[Any]) -> None:
        return None

    def as_statement(self, child: Any) -> Any:
        if child is None or isinstance(child, s.Statement):
            return child
        return s.ExpressionStatement(child, child.span, getattr(child, "depth", 0))

    def declaration(self, children: list[Any]) -> s.Declaration:
        const, type_, declarators = children
        span = _join(type_.span, declarators[-1].name.span)
        depth = self.deeper(span, *[declarator.value for declarator in declarators])
        return s.Declaration(const is not None, type_, declarators, span, depth)

    def assignment(self, children: list[Any]) -> s.Assignment:
        target, op, value = children
        span = _join(target.span, value.span)
        return s.Assignment(target, str(op)[:-1], value, span, self.deeper(span, target, value))

    def step(self, children: list[Any]) -> s.Assignment:
        first, second = children
        token, target = (second, first) if hasattr(first, "span") else (first, second)
        span = _join(target.span, self.at(token))
        return s.Assignment(target, str(token)[0], None, span, self.deeper(span, target))

    def if_(self, children: list[Any]) -> s.IfStatement:
        keyword, condition, then, *rest = children
        span = self.at(keyword)
        then, otherwise = self.body(then, span), self.as_statement(rest[0]) if rest else None
        return s.IfStatement(condition, then, otherwise, span, self.deeper(span, condition, then, otherwise))

    def body(self, child: Any, span: Span) -> Any:
        return s.Compound((), span, 0) if child is None else self.as_statement(child)

    def for_(self, children: list[Any]) -> s.ForStatement:
        keyword, init, condition, step, body = children
        span = self.at(keyword)
        body = self.body(body, span)
        init, step = self.as_statement(init), self.as_statement(step)
        return s.ForStatement(init, condition, step, body, span, self.deeper(span, init, condition, step, body))

    def while_(self, children: list[Any]) -> s.WhileStatement:
        keyword, condition, body = children
        span = self.at(keyword)
        body = self.body(body, span)
        return s.WhileStatement(condition, body, span, self.deeper(span, condition, body))

    def jump(self, children: list[Any]) -> s.Jump:
        value = children[1] if len(children) > 1 else None
        span = self.at(children[0])
        whole = _join(span, value.span) if value is not None else span
        return s.Jump(str(children[0]), value, whole, self.deeper(span, value))

    return_ = break_ = continue_ = discard_ = jump

    # Expressions

    def binary(self, children: list[Any]) -> Any:
        """Groups `unary (operator unary)*` by precedence."""
        operands: list[Any] = [children[0]]
        operators: list[str] = []

        def reduce() -> None:
            right, left, op = operands.pop(), operands.pop(), operators.pop()
            span = _join(left.span, right.span)
            operands.append(s.Infix(op, left, right, span, self.deeper(span, left, right)))

        for index in range(1, len(children), 2):
            op = str(children[index])
            while operators and PRECEDENCE[operators[-1]] >= PRECEDENCE[op]:
                reduce()
            operators.append(op)
            operands.append(children[index + 1])
        while operators:
            reduce()
        return operands[0]

    def conditional(self, children: list[Any]) -> s.Conditional:
        condition, yes, no = children
        span = _join(condition.span, no.span)
        return s.Conditional(condition, yes, no, span, self.deeper(span, *children))

    def prefix(self, children: list[Any]) -> Any:
        token, operand = children
        span = _join(self.at(token), operand.span)
        return s.Prefix(str(token), operand, span, self.deeper(span, operand))

    def index(self, children: list[Any]) -> s.IndexOf:
        value, index, end = children
        span = _join(value.span, self.at(end))
        return s.IndexOf(value, index, span, self.deeper(span, value, index))

    def member_of(self, children: list[Any]) -> s.MemberOf:
        value, token = children
        span = _join(value.span, self.at(token))
        return s.MemberOf(value, self.name_of(token), span, self.deeper(span, value))

    def call(self, children: list[Any]) -> s.CallOf:
        name, arguments, end = children
        return self.call_of(self.name_of(name), arguments, end)

    def construct(self, children: list[Any]) -> s.CallOf:
        token, length, arguments, end = children
        return self.call_of(s.TypeName(str(token), length, self.at(token)), arguments, end)

    def call_of(self, callee: s.Name | s.TypeName, arguments: Any, end: Any) -> s.CallOf:
        span = _join(callee.span, self.at(end))
        args = arguments or ()
        return s.CallOf(callee, args, span, self.deeper(span, *args))

    def arguments(self, children: list[Any]) -> tuple[s.Expression, ...]:
        return tuple(children)

    def integer(self, children: list[Any]) -> s.Number:
        return s.Number(str(children[0]), False, self.at(children[0]))

    def number(self, children: list[Any]) -> s.Number:
        return s.Number(str(children[0]), True, self.at(children[0]))

    def boolean(self, children: list[Any]) -> s.Boolean:
        return s.Boolean(str(children[0]) == "true", self.at(children[0]))

    def name(self, children: list[Any]) -> s.Name:
        return self.name_of(children[0])


def _join(first: Span, last: Span) -> Span:
    return Span(first.file, first.line, first.column, last.end_line, last.end_column)


def _line(token: Any) -> int:
    return int(token.line)


def _end_line(token: Any) -> int:
    return int(token.line) + str(token).count("\n")


def _describe(error: Any, text: str, file: str) -> tuple[int, Span, str, str]:
    """For an unexpected token: its position, its span, the words for it, and what to do."""
    token = error.token
    if token.type == "$END":
        position = len(text.rstrip())
        last = _place(text, max(0, position - 1), file)
        return position, last, "the file ends too early", "is a '}' or ';' missing?"
    position = token.start_pos
    for start in (position, position - 1):
        if text.startswith("/*", max(0, start)):
            return start, _place(text, start, file), "this comment is not closed", "add */ at its end"
    accepted = error.accepts or error.expected
    end = _end_of_code(text, position)
    if "SEMICOLON" in accepted and "LBRACE" not in accepted and "\n" in text[end:position]:
        return position, _place(text, end, file), "a ';' is missing here", ""
    wanted = sorted({_TOKEN_NAMES[name] for name in accepted if name in _TOKEN_NAMES})
    message = f"'{_shorten(str(token))}' is not expected here"
    if 0 < len(wanted) <= 4:
        message += f"; expected {' or '.join(wanted)}"
    hint = "an assignment is a statement of its own" if token.type in ("ASSIGN", "INCDEC") else ""
    word = re.search(r"\b(do|switch|case|default)\b[^;{}]*$", text[max(0, end - 100) : end])
    if word is not None:
        hint = _MISSING[word[1]]
    return position, Span(file, token.line, token.column, token.end_line, token.end_column), message, hint


_MISSING = {"do": "there is no do-while: write while (…) { … }"}
_MISSING |= dict.fromkeys(("switch", "case", "default"), "there is no switch: write if (…) … else if (…) …")


def _describe_character(text: str, position: int) -> tuple[str, str]:
    """The words for a character that begins no token, and what to do."""
    if text.startswith('"', position):
        return "this text is not closed on its line", ""
    if text.startswith("#", position):
        return "there is no preprocessor", 'but for #include "file.sss"; write a const, a function or a uniform instead'
    return f"{text[position]!r} has no meaning here", ""


def _end_of_code(text: str, position: int) -> int:
    """Where the last token before a position ends: behind it there are but spaces and comments."""
    end = 0
    for match in re.finditer(r"//[^\n]*|/\*[\s\S]*?\*/|\s+|[^\s/]+|/", text[:position]):
        if not match.group().isspace() and not match.group().startswith(("//", "/*")):
            end = match.end()
    return end


def _shorten(text: str, limit: int = 40) -> str:
    return text if len(text) <= limit else text[:limit] + "…"


_SKELETON = re.compile(r'//[^\n]*|/\*[\s\S]*?\*/|"[^"\n]*"|[{}()\[\];,\n]|[-+*/%<>=!&|^?]+')


def _check_nesting(text: str, reporter: Reporter) -> None:
    """Refuses, before the parser builds a tree of them, deep brackets and endless expressions."""
    operators = [0]  # of the expression at hand and those around it
    for match in _SKELETON.finditer(text):
        token = match.group()
        if token in "{([":
            operators.append(0)
            if len(operators) > MAX_DEPTH + 1:
                reporter.error(_place(text, match.start(), reporter.file), *_TOO_DEEP)
                return
        elif token in "})]" and len(operators) > 1:
            operators.pop()
        elif token in ",;})]":
            operators[-1] = 0
        elif token[0] in "-+*/%<>=!&|^?" and not token.startswith(("//", "/*")):
            operators[-1] += 1
            if operators[-1] > MAX_OPERATORS:
                message = f"more than {MAX_OPERATORS} operators in one expression"
                reporter.error(_place(text, match.start(), reporter.file), message, _TOO_DEEP[1])
                return


def _place(text: str, position: int, file: str) -> Span:
    """The span of the character at a position."""
    line, column = text.count("\n", 0, position) + 1, position - text.rfind("\n", 0, position)
    return Span(file, line, column, line, column + 1)


def _blank_declaration(text: str, place: int) -> str:
    """Replaces the top-level declaration around a position by blanks, keeping its line breaks."""
    start, depth, end = 0, 0, len(text)
    for match in _SKELETON.finditer(text):
        token = match.group()
        if token == "{":
            depth += 1
        elif token == "}":
            depth = max(0, depth - 1)
        if depth == 0 and token in "};":
            if match.start() >= place:
                end = match.end()
                break
            start = match.end()
    return text[:start] + re.sub(r"[^\n]", " ", text[start:end]) + text[end:]
