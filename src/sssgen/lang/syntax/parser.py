"""Tokens → syntax tree, by the tables of grammar.lark.

A syntax error does not hide others: the faulty declaration is removed and the rest is parsed again.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from sssgen.lang.syntax import grammar_tables
from sssgen.lang.syntax import tree as s
from sssgen.lang.syntax.doc_comments import attach_docs
from sssgen.lang.syntax.lalr import Unexpected, run
from sssgen.lang.syntax.lexer import scan
from sssgen.lang.syntax.tokens import Comment, Token
from sssgen.lang.syntax.tree_builder import Builder
from sssgen.support.diagnostics import Diagnostic, Reporter, SssgenError
from sssgen.support.gc_pause import pause_gc

MAX_DEPTH = 100
"""The deepest nesting of expressions and statements together. Hand-written shaders stay below 30; passes and printers
are recursive, and Python's default stack of 1000 frames must be enough for them."""

_TOO_DEEP = (
    f"nested more than {MAX_DEPTH} levels deep",
    "move a part of it to a local variable or a function",
)

MAX_OPERATORS = 1000
"""The largest number of operators of one expression outside its brackets."""

MAX_SYNTAX_ERRORS = 20

_TOKEN_NAMES = {
    "NAME": "a name", "INT": "a number", "FLOAT": "a number", "TYPE": "a type", "SEMICOLON": "';'", "LPAR": "'('",
    "RPAR": "')'", "LBRACE": "'{'", "RBRACE": "'}'", "RSQB": "']'", "COMMA": "','", "ASSIGN": "'='", "COLON": "':'",
    "DOT": "'.'", "LSQB": "'['", "OPERATOR": "an operator", "STRING": "a string", "WHILE": "'while'",
}  # fmt: skip

_DIRECTIVE = re.compile(r'^[ \t]*#[ \t]*(?:include[ \t]+"[^"\n]*"|version[^\n]*)', re.MULTILINE)


def parse(text: str, file: str) -> s.File:
    """Parses a technique's source. Raises `SssgenError` with every syntax error found.

    Its only directives are `#include "file"`, which the loader follows, and `#version`, which is ignored.
    """
    with pause_gc():
        try:
            tokens, comments = scan(_DIRECTIVE.sub(lambda match: " " * len(match.group()), text), file)
        except SssgenError as error:
            raise SssgenError([_without_directives(diagnostic) for diagnostic in error.diagnostics]) from None
        return parse_tokens(tokens, {file: comments}, Reporter(file, text))


def _without_directives(diagnostic: Diagnostic) -> Diagnostic:
    """The lexer's error; the one about a `#` is reworded for a technique's author."""
    if not diagnostic.message.startswith("'#'"):
        return diagnostic
    hint = 'only #include "file.sss" is possible; write a const, a function or a uniform instead'
    return diagnostic._replace(message="a technique has no preprocessor", hint=hint)


def parse_tokens(
    tokens: Sequence[Token], comments: Mapping[str, Sequence[Comment]], reporter: Reporter, plain: bool = False
) -> s.File:
    """Parses the tokens of a file and of those that it includes; `comments` are by file.

    `plain`: any comment before a function is its documentation. Raises `SssgenError` with every syntax error found.
    """
    _check_shape(tokens, reporter)
    remaining = list(_as_names(tokens))
    for _ in range(MAX_SYNTAX_ERRORS):
        builder = Builder(MAX_DEPTH)
        try:
            externals = run(grammar_tables.load(), remaining, builder.methods) if remaining else []
            break
        except Unexpected as error:
            without = _without_attributes(remaining) if plain and _begins_attribute(remaining, error.index) else None
            if without is not None:
                remaining = without
                continue
            _report(error, remaining, reporter)
            remaining = _without_declaration(remaining, error.index)
    for place, message in builder.wrong:
        reporter.error(place, message)
    reporter.check()
    if builder.too_deep is not None:
        reporter.error(builder.too_deep, *_TOO_DEEP)
        reporter.check()
    lines = {file: reporter.texts.get(file, "").split("\n") for file in comments}
    lines[reporter.file] = reporter.lines
    return s.File(reporter.file, attach_docs(externals, comments, lines, plain))


_BEGINNING = frozenset(
    "IF FOR WHILE DO SWITCH RETURN BREAK CONTINUE DISCARD CONST UNIFORM STRUCT RBRACE".split()  # noqa: SIM905
)
"""The terminals that begin a statement or a declaration, or follow the last one."""
_ENDING = frozenset("NAME INT FLOAT BOOL RPAR RSQB INCDEC RETURN BREAK CONTINUE DISCARD".split())  # noqa: SIM905
"""The terminals that end a statement, before its semicolon."""

_OPENED = frozenset(("LPAR", "LSQB", "LBRACE"))
_CLOSED = frozenset(("RPAR", "RSQB", "RBRACE"))
_OPERATORS = frozenset(("OPERATOR", "PLUSMINUS", "NOT", "ASSIGN", "QMARK"))
_SHAPING = _OPERATORS | _OPENED | _CLOSED | {"SEMICOLON", "COMMA"}


def _check_shape(tokens: Sequence[Token], reporter: Reporter) -> None:
    """Refuses too deep brackets and too long expressions before they are parsed."""
    depth = operators = 0
    for token in tokens:
        kind = token[0]
        if kind not in _SHAPING:
            continue
        if kind in _OPERATORS:
            operators += 1
            if operators > MAX_OPERATORS:
                message = f"more than {MAX_OPERATORS} operators in one expression"
                reporter.error(token.span, message, _TOO_DEEP[1])
                break
        elif kind in _OPENED:
            depth += 1
            operators = 0
            if depth > MAX_DEPTH:
                reporter.error(token.span, *_TOO_DEEP)
                break
        elif kind in _CLOSED:
            depth = max(0, depth - 1)
            operators = 0
        else:
            operators = 0
    reporter.check()


_LATER = frozenset(("QUALIFIER", "BUFFER", "SHARED"))
"""Keywords of later versions of GLSL, which are names in older files: `vec4 sample = texture2D(…);`."""
_BEFORE_TYPE = frozenset(
    "NAME TYPE QUALIFIER IN OUT INOUT UNIFORM VARYING CONST PRECISION LAYOUT STRUCT BUFFER SHARED".split()  # noqa: SIM905
)


def _is_qualifier(tokens: Sequence[Token], index: int) -> bool:
    """Whether a keyword of later versions is a qualifier: it is before a type, or alone, as in `layout(…) buffer;`."""
    following = tokens[index + 1].type if index + 1 < len(tokens) else ""
    alone = following == "SEMICOLON" and index > 0 and tokens[index - 1].type == "RPAR"
    return alone or following in _BEFORE_TYPE


def _as_names(tokens: Sequence[Token]) -> Sequence[Token]:
    """The tokens; keywords of later versions become names where a qualifier is impossible."""
    places = [index for index, token in enumerate(tokens) if token.type in _LATER and not _is_qualifier(tokens, index)]
    if not places:
        return tokens
    changed = list(tokens)
    for index in places:
        changed[index] = tokens[index]._replace(type="NAME")
    return changed


def _report(error: Unexpected, tokens: list[Token], reporter: Reporter) -> None:
    """Reports the unexpected token, and what would fit."""
    index, accepted = error.index, error.accepted
    before = tokens[index - 1].span if index else None
    if index >= len(tokens):
        last = tokens[-1].span
        place = last._replace(line=last.end_line, column=max(1, last.end_column - 1))
        reporter.error(place, "the file ends too early", "is a '}' or ';' missing?")
        return
    token = tokens[index]
    complete = index > 0 and tokens[index - 1].type in _ENDING
    ended = before is not None and (before.end_line < token.span.line or (complete and token.type in _BEGINNING))
    if before is not None and ended and "SEMICOLON" in accepted and "LBRACE" not in accepted:
        end = before._replace(line=before.end_line, column=before.end_column, end_column=before.end_column + 1)
        reporter.error(end, "a ';' is missing here")
        return
    wanted = sorted({_TOKEN_NAMES[name] for name in accepted if name in _TOKEN_NAMES})
    message = f"'{_shorten(token.text)}' is not expected here"
    if 0 < len(wanted) <= 4:
        message += f"; expected {' or '.join(wanted)}"
    hint = "it is a keyword of GLSL: choose another name" if "NAME" in accepted and token.text[0].isalpha() else ""
    reporter.error(token.span, message, hint)


def _begins_attribute(tokens: Sequence[Token], place: int) -> bool:
    return [token.type for token in tokens[place : place + 2]] == ["LSQB", "LSQB"]


def _without_attributes(tokens: Sequence[Token]) -> list[Token] | None:
    """The tokens without attributes such as `[[unroll]]`: they advise a compiler, and other languages lack them.

    None where one does not end.
    """
    kept: list[Token] = []
    depth = 0
    for index, token in enumerate(tokens):
        if depth == 0 and not _begins_attribute(tokens, index):
            kept.append(token)
        elif token.type in ("LSQB", "RSQB"):
            depth += 1 if token.type == "LSQB" else -1
    return None if depth else kept


def _shorten(text: str, limit: int = 40) -> str:
    return text if len(text) <= limit else text[:limit] + "…"


def _without_declaration(tokens: list[Token], place: int) -> list[Token]:
    """The tokens without the top-level declaration around one of them."""
    start, depth = 0, 0
    for index, token in enumerate(tokens):
        if token.type == "LBRACE":
            depth += 1
        elif token.type == "RBRACE":
            depth = max(0, depth - 1)
        if depth == 0 and token.type in ("RBRACE", "SEMICOLON"):
            if index >= place:
                return tokens[:start] + tokens[index + 1 :]
            start = index + 1
    return tokens[:start]
