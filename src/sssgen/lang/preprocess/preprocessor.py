"""The preprocessor of GLSL (GLSL 4.60, section 3.3; ARB_shading_language_include): text → tokens.

The code between directives is split into tokens once, and macros are expanded only where it names one. Code in inactive
branches is not read.

The alternative would be the library pcpp, C's preprocessor in Python. On 85 kB of GLSL with a hundred macros it takes
four times as long (0.5 MB/s), and a token from a macro has the line of its use, but the column of the definition.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import NamedTuple

from sssgen.ir.spans import Span
from sssgen.lang.preprocess.directives import BLANK, Branch, SourceFile, directives, plain, with_whole_tokens
from sssgen.lang.preprocess.if_conditions import Fault, evaluate
from sssgen.lang.preprocess.macro_constants import MacroConstants
from sssgen.lang.preprocess.macros import MAX_TOKENS, Expander, Numbering, TooMuch, builtin_macros, definition
from sssgen.lang.syntax.lexer import KEYWORDS, Lexer, Report
from sssgen.lang.syntax.tokens import Comment, Token
from sssgen.support.diagnostics import Diagnostic, Reporter, SssgenError, did_you_mean

MAX_INCLUDED = 50
"""How deeply files may include files."""

MAX_INCLUDES = 5000
"""How many includes a text may have, with those of the files that it includes."""

MAX_CHARACTERS = 20_000_000
"""How long a text may be with all files that it includes."""

MAX_CONDITIONALS = 200
"""How deeply #if may nest."""

Find = Callable[[str, Span, bool], tuple[str, str]]
"""Finds an included file: (its name, the place of the name, whether it is in `<>`) → its name in messages and its text.
Raises SssgenError where there is none."""


class PreprocessedText(NamedTuple):
    """A text and all that it includes after preprocessing, for the parser."""

    tokens: list[Token]
    comments: dict[str, list[Comment]]
    """For each file, by its name in messages, its comments outside of inactive branches, in order."""
    version: int
    """The number of #version, or 0."""
    profile: str
    """`core`, `compatibility` or `es` (also for #version 100), or ''."""
    texts: dict[str, str]
    """The text of every file."""
    extensions: list[str]
    """The arguments of each #extension: `GL_OES_standard_derivatives : enable`."""
    macros: list[str]
    """The macros that became constants."""
    pragmas: list[str]
    expanded: frozenset[str]
    """The macros that were expanded, if they are still defined at the end."""


def preprocess(
    text: str, file: str, find: Find, defines: Mapping[str, str] | None = None, language: tuple[int, str] | None = None
) -> PreprocessedText:
    """Executes the directives of a text and of all that it includes, and expands its macros.

    `defines` are macros without parameters, defined before the first line. A token has the place where it is written; a
    token from a macro's body has the place of the macro's use. `#line` sets `__LINE__` and `__FILE__` alone: messages
    show the real lines. Macros that are names of numbers become constants (macro_constants.py).

    `language` is the version and the profile of the macros of a text without #version. By default, a text that sets a
    precision outside of any #if is GLSL ES 1.00: the GLSL 1.10 of desktops, the other language without a version, has
    no precision. Engines rely on its `GL_ES`.

    Raises SssgenError with every error found, also where a limit is exceeded (those here and in macros.py).
    """
    language = language or ((100, "es") if _sets_precision(text) else (0, ""))
    barred: frozenset[str] = frozenset()
    for keep in (True, True, False):
        run = _Run(find, defines or {}, MacroConstants(barred) if keep else None, language)
        run.read(text, file)
        run.finish()
        if run.constants is None:
            break
        names = run.constants.in_use(run.tokens) if run.constants.values else []
        conflicts = run.expander.joined | run.constants.conflicts(names, run.tokens)
        if not conflicts:
            return run.result(run.constants.with_declarations(names, run.tokens), names)
        barred |= conflicts  # they are expanded everywhere; repeat, as macros that use them are then expanded, too
    return run.result(run.tokens, [])


_ES_VERSIONS = (300, 310, 320)
_VERSIONS = (100, 110, 120, 130, 140, 150, 330, 400, 410, 420, 430, 440, 450, 460)
_EXTENSION = re.compile(r"(?!all\b)[A-Za-z_]\w* ?: ?(?:require|enable|warn|disable)|all ?: ?(?:warn|disable)")
_PRECISION = re.compile(r"\bprecision\s+(?:low|medium|high)p\s+\w+\s*;")


def _sets_precision(text: str) -> bool:
    """Whether a text without #version has a statement such as `precision highp float;` outside of any #if."""
    if "precision" not in text:
        return False
    depth = start = 0
    for directive in directives(text):
        if directive["name"] == "version" or (depth == 0 and _PRECISION.search(plain(text[start : directive.start()]))):
            return directive["name"] != "version"
        depth += {"if": 1, "ifdef": 1, "ifndef": 1, "endif": -1}.get(directive["name"], 0)
        start = directive.end()
    return depth == 0 and _PRECISION.search(plain(text[start:])) is not None


_QUOTED = re.compile(rf'"[^"\n]*"{BLANK}$')
"""The file's name that some tools write behind `#line 10`."""
_INCLUDED = re.compile(rf'{BLANK}(?:"(?P<quoted>[^"\n]+)"|<(?P<angled>[^>\n]+)>)')

_KNOWN = (
    "define", "undef", "if", "ifdef", "ifndef", "elif", "else", "endif", "error", "line", "version", "extension",
    "pragma", "include",
)  # fmt: skip


class _Run:
    """One run over a text and all that it includes."""

    def __init__(
        self, find: Find, defines: Mapping[str, str], constants: MacroConstants | None, language: tuple[int, str]
    ) -> None:
        self.find = find
        self.constants = constants
        self.lexer = Lexer()
        self.directive_lexer = Lexer({**KEYWORDS, "##": "PASTE", "#": "HASH"})
        self.expander = Expander(self.join, self.error)
        self.tokens: list[Token] = []
        self.comments: dict[str, list[Comment]] = {}
        self.texts: dict[str, str] = {}
        self.repeated: set[str] = set()  # files that were read more than once
        self.version, self.profile, self.version_file = 0, "", ""
        self.text_macros: set[str] = set()  # that the text itself defines
        self.extensions: list[str] = []
        self.pragmas: list[str] = []
        self.chain: list[SourceFile] = []
        self.once: set[str] = set()
        self.included = self.characters = 0
        self.depth = self.depth_at = 0  # how many brackets are open, and in how many tokens they were counted
        self.reporters: dict[str, Reporter] = {}
        self.expander.macros |= builtin_macros(*language)
        for name, value in defines.items():
            label = f"the definition of {name}"
            tokens = self.split(self.directive_lexer, f"{name} {value}", label, 1, 1)
            self.define(tokens, Span(label, 1, 1, 1, 1), keep=False)

    # Errors

    def error(self, span: Span, message: str, hint: str = "") -> None:
        reporter = self.reporters.get(span.file)
        if reporter is None:
            reporter = self.reporters[span.file] = Reporter(span.file, self.texts.get(span.file, ""))
        reporter.error(span, message, hint)

    def check(self) -> None:
        """Raises the errors of every file."""
        diagnostics: list[Diagnostic] = []
        for reporter in self.reporters.values():
            diagnostics += sorted(reporter.diagnostics, key=lambda diagnostic: diagnostic.span[1:3])
        if diagnostics:
            raise SssgenError(diagnostics)

    def stop(self, span: Span, message: str, hint: str = "") -> None:
        """Reports an error after which reading cannot continue."""
        self.error(span, message, hint)
        self.check()

    # Files

    def read(self, text: str, label: str) -> None:
        """Reads a file to its end."""
        if label in self.texts:
            self.repeated.add(label)
        self.texts[label] = text
        text = with_whole_tokens(text)
        file = SourceFile(text, label)
        self.characters += len(text)
        self.chain.append(file)
        outer, self.expander.numbering = self.expander.numbering, Numbering()
        start = 0
        for match in directives(text):
            if file.live:
                self.code(file, start, match.start("mark"))
            self.directive(file, match)
            start = match.end()
        if file.live:
            self.code(file, start, len(text))
        for branch in file.branches:
            self.error(branch.place, "this condition is not closed", "an #endif is missing")
        self.chain.pop()
        self.expander.numbering = outer

    def code(self, file: SourceFile, start: int, end: int) -> None:
        """Reads the code between directives."""
        if start == end:
            return
        line, column = file.place(start, start)[1:3]
        tokens = self.split(self.lexer, file.text[start:end], file.label, line, column)
        try:
            self.tokens += self.expander.expand(tokens)
        except TooMuch as fault:
            self.stop(*fault.details)
        if len(self.tokens) > MAX_TOKENS:
            self.stop(tokens[-1].span, f"more than {MAX_TOKENS} tokens, with all included files")

    def split(
        self, lexer: Lexer, text: str, label: str, line: int, column: int, report: Report | None = None
    ) -> list[Token]:
        tokens, comments = lexer.scan(text, label, line, column, report or self.error)
        if comments:
            self.comments.setdefault(label, []).extend(comments)
        return tokens

    def finish(self) -> None:
        """Ends the token list, and raises the errors."""
        self.tokens += self.expander.rest()
        self.check()

    def result(self, tokens: list[Token], constants: list[str]) -> PreprocessedText:
        comments = self.comments
        for label in self.repeated & comments.keys():
            comments[label] = sorted(dict.fromkeys(comments[label]), key=lambda comment: comment.first)
        return PreprocessedText(
            tokens, comments, self.version, self.profile, self.texts, self.extensions, constants, self.pragmas,
            frozenset(self.expander.macros) - set(constants),
        )  # fmt: skip

    @property
    def is_es(self) -> bool:
        """Whether the text says that it is GLSL ES. One without `#version` may be a part of a text that an engine
        completes."""
        return self.version > 0 and self.profile == "es"

    # Directives

    def directive(self, file: SourceFile, match: re.Match[str]) -> None:
        """Executes a directive; in inactive branches only those that open and close conditions."""
        name, rest = match["name"], match["rest"]
        place = file.place(match.start("mark"), match.end("name"))
        if name in ("if", "ifdef", "ifndef", "elif", "else", "endif"):
            self.condition(file, name, rest, place)
        elif not file.live:
            return
        elif name == "define":
            faults: list[tuple[Span, str, str]] = []
            tokens = self.tokens_of(file, rest, place, lambda *fault: faults.append(fault))
            self.define(tokens, place, keep=True, fault=faults[0] if faults else None)
        elif name == "undef":
            macro = self.macro_name(self.tokens_of(file, rest, place), place, name)
            if macro is not None:
                of_language = macro.text == "defined" and "defined" not in self.expander.macros
                if self.version and (of_language or macro.text.startswith("GL_")):
                    self.error(macro.span, f"'{macro.text}' belongs to the language, which defines it")
                self.undefine(macro.text)
        elif name == "include":
            self.include(file, rest, place, match.start("rest"))
        elif name == "line":
            self.set_line(
                self.tokens_of(file, _QUOTED.sub("", rest), place), place, place.end_line + rest.count("\n") + 1
            )
        elif name == "error":
            self.error(place, f"#error {plain(rest)}".rstrip())
        elif name == "version":
            self.set_version(plain(rest), place)
        elif name == "extension":
            self.extensions.append(plain(rest))
            if self.version and not _EXTENSION.fullmatch(self.extensions[-1]):
                hint = "write #extension NAME : enable; the others are require, warn and disable"
                self.error(place, f"'{self.extensions[-1]}' is no extension with a behaviour", hint)
            elif self.is_es and self.tokens:
                self.error(place, "#extension must be above all declarations in GLSL ES")
        elif name == "pragma":
            self.pragmas.append(plain(rest))
            if self.pragmas[-1] == "once":
                self.once.add(file.label)
        elif name or plain(rest):
            self.error(place, f"there is no directive '#{name}'", did_you_mean(name, _KNOWN))

    def tokens_of(self, file: SourceFile, rest: str, place: Span, report: Report | None = None) -> list[Token]:
        return self.split(self.directive_lexer, rest, file.label, place.end_line, place.end_column, report)

    def macro_name(self, tokens: list[Token], place: Span, directive: str) -> Token | None:
        """The macro's name that must be the only argument of a directive."""
        if tokens and tokens[0].text.isidentifier():
            if len(tokens) > 1:
                hint = "to test several, write #if defined(…) && …" if directive != "undef" else ""
                self.error(tokens[1].span, f"'{tokens[1].text}' is not expected here", hint)
            return tokens[0]
        self.error(tokens[0].span if tokens else place, f"#{directive} needs the name of a macro")
        return None

    def condition(self, file: SourceFile, name: str, rest: str, place: Span) -> None:
        """Executes #if, #ifdef, #ifndef, #elif, #else or #endif."""
        branches = file.branches
        if name in ("if", "ifdef", "ifndef"):
            if len(branches) >= MAX_CONDITIONALS:
                self.stop(place, f"conditions nested more than {MAX_CONDITIONALS} deep")
            branch = Branch(place, file.live)
            branch.live = branch.taken = branch.outside and self.holds(file, name, rest, place)
            branches.append(branch)
            return
        if not branches:
            self.error(place, f"there is no #if before this #{name}")
            return
        branch = branches[-1]
        if name != "elif" and self.version and plain(rest):
            self.error(place, f"'{plain(rest)}' is not expected after #{name}", "write it as a comment: // …")
        if name == "endif":
            branches.pop()
            return
        if branch.last:
            self.error(place, f"#{name} after #else", "#else must be the last branch")
        branch.last = branch.last or name == "else"
        branch.live = False
        if branch.outside and not branch.taken:
            branch.live = branch.taken = name == "else" or self.holds(file, "if", rest, place)

    def holds(self, file: SourceFile, name: str, rest: str, place: Span) -> bool:
        """Whether the condition of a directive holds."""
        tokens = self.tokens_of(file, rest, place)
        if name != "if":
            macro = self.macro_name(tokens, place, name)
            return macro is not None and (macro.text in self.expander.macros) == (name == "ifdef")
        if not tokens:
            self.error(place, "a condition is missing here")
            return False
        try:
            defined = self.expander.macros.__contains__
            return evaluate(self.expander.condition(tokens), defined, place, self.is_es) != 0
        except TooMuch as fault:
            self.stop(*fault.details)
        except Fault as fault:
            self.error(*fault.details)
        return False

    def include(self, file: SourceFile, rest: str, place: Span, start: int) -> None:
        match = _INCLUDED.match(rest)
        if match is None or plain(rest[match.end() :]):
            self.error(place, '#include needs a file: "name" or <name>')
            return
        angled = match["quoted"] is None
        group = "angled" if angled else "quoted"
        where = file.place(start + match.start(group), start + match.end(group))
        try:
            label, text = self.find(match[group], where, angled)
        except SssgenError as error:
            for diagnostic in error.diagnostics:
                self.error(diagnostic.span, diagnostic.message, diagnostic.hint)
            return
        if label in self.once:
            return
        self.included += 1
        chain = [including.label for including in self.chain]
        if len(chain) > MAX_INCLUDED:
            message = f"files include files more than {MAX_INCLUDED} deep"
            if label in chain:
                circle = " → ".join([*chain[len(chain) - 1 - chain[::-1].index(label) :], label])
                message = f"'{label}' includes itself: {circle}"
            self.stop(where, message, "write #pragma once in a file to include it only once")
        if self.included > MAX_INCLUDES or self.characters + len(text) > MAX_CHARACTERS:
            self.stop(where, "too much is included", "write #pragma once in a file to include it only once")
        self.read(text, label)

    def set_line(self, tokens: list[Token], place: Span, following: int) -> None:
        """Executes `#line LINE` or `#line LINE TEXT`, whose next line is `following` in the file."""
        numbers = self.numbers(tokens, place)
        if numbers is None:
            self.error(place, "#line needs the number of a line", "write #line 10, or #line 10 2 for the text 2")
            return
        line, text = numbers
        is_old = 0 < self.version < 330 and self.profile != "es"  # there it is the number of the directive's own line
        self.expander.numbering = Numbering(line + is_old - following, text)

    def numbers(self, tokens: list[Token], place: Span) -> tuple[int, int] | None:
        """The line and the text's number that `#line` is given; None where they are none."""
        defined = self.expander.macros.__contains__
        try:
            tokens = self.expander.condition(tokens)
        except TooMuch as fault:
            self.stop(*fault.details)
        if any(token.text.isidentifier() for token in tokens):
            return None
        for line, text in ((tokens, ()), (tokens[:-1], tokens[-1:])):  # both may be expressions; the second rarely is
            with suppress(Fault):
                first = evaluate(line, defined, place)
                second = evaluate(text, defined, place) if text else self.expander.numbering.text
                return (first, second) if 0 <= first < 1 << 31 and 0 <= second < 1 << 31 else None
        return None

    def set_version(self, arguments: str, place: Span) -> None:
        match = re.fullmatch(r"(\d{3})(?: (core|compatibility|es))?", arguments)
        if match is None:
            self.error(place, f"'{arguments}' is not a version", "write #version 330 core or #version 300 es")
            return
        versions = _ES_VERSIONS if match[2] == "es" else _VERSIONS
        if int(match[1]) not in versions:
            hint = f"the versions{' of GLSL ES' if match[2] == 'es' else ''} are {', '.join(map(str, versions))}"
            self.error(place, f"there is no version {arguments}", hint)
        if self.version not in (0, int(match[1])) or (self.is_es and place.file == self.version_file):
            self.error(place, f"the version is already {self.version}")
        elif self.tokens or self.text_macros:
            self.error(place, "#version must be the first line", "only comments may be above it")
        self.version, self.version_file = int(match[1]), place.file
        self.profile = "es" if self.version == 100 else match[2] or ""
        for name in builtin_macros(0, ""):
            self.expander.macros.pop(name, None)
        self.expander.macros |= builtin_macros(self.version, self.profile)

    # Macros

    def define(self, tokens: list[Token], place: Span, keep: bool, fault: tuple[Span, str, str] | None = None) -> None:
        """Defines a macro; `fault`: its body has text that is no token, which a macro may have that is not used."""
        try:
            macro = definition(tokens, place)._replace(fault=fault)
        except Fault as fault:
            self.error(*fault.details)
            return
        macros, constants = self.expander.macros, self.constants
        if macro.name in macros and macros[macro.name].same_as(macro):
            return
        if keep and self.version and macro.name.startswith("GL_"):
            self.error(tokens[0].span, f"'{macro.name}' is reserved in GLSL: choose a name without GL_")
        if keep and self.is_es and macro.pastes:
            self.error(place, "GLSL ES has no '##'")
        if keep and self.version and macro.name in self.text_macros:
            self.error(tokens[0].span, f"'{macro.name}' is already defined as something else", f"#undef {macro.name}")
        self.undefine(macro.name)
        if keep:
            self.text_macros.add(macro.name)
        macros[macro.name] = macro
        if keep and constants is not None and fault is None and self.between_declarations():
            constants.add(macro, tokens[0], self.expander.constants, len(self.tokens))

    def undefine(self, name: str) -> None:
        if self.constants is not None:
            self.constants.end(name, self.expander.constants, self.expander.used, len(self.tokens))
        self.expander.macros.pop(name, None)
        self.text_macros.discard(name)

    def between_declarations(self) -> bool:
        """Whether a declaration may be inserted here."""
        for token in self.tokens[self.depth_at :]:
            if token.type in ("LBRACE", "LPAR", "LSQB"):
                self.depth += 1
            elif token.type in ("RBRACE", "RPAR", "RSQB"):
                self.depth -= 1
        self.depth_at = len(self.tokens)
        ends = not self.tokens or self.tokens[-1].type in ("SEMICOLON", "RBRACE")
        return self.depth == 0 and ends and self.expander.pending is None

    def join(self, text: str, place: Span) -> Token:
        """The token that `##` makes of two."""
        faults: list[str] = []
        tokens, _ = self.lexer.scan(text, place.file, 1, 1, lambda span, message, hint: faults.append(message))
        if len(tokens) == 1 and not faults and tokens[0].text == text:
            return Token(tokens[0].type, text, place)
        self.error(place, f"'##' makes '{text}' here, which is not a token")
        return Token("NAME", text, place)
