"""Macros and their expansion, as C does it (C11, section 6.10.3; GLSL 4.60, section 3.3, without stringification).

What was expanded is looked at again, together with the words behind it. A name that came out of its own expansion
stays: each word carries the set of the macros that it must not be expanded by, its hide set (Prosser, "Complete macro
expansion algorithm", X3J11/86-196, 1986).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from sssgen.ir.spans import NOWHERE, Span
from sssgen.lang.preprocess.if_conditions import Fault
from sssgen.lang.syntax.tokens import Token

MAX_EXPANSION = 100_000
"""How many words one use of a macro may become. Tables in macros have some thousands."""

MAX_TOKENS = 1_000_000
"""How many words a text may have when its macros are expanded."""

MAX_NESTED = 100
"""How deeply macros may stand in each other, and uses in the arguments of uses."""

MAX_JOINED = 1024
"""How long a word may be that `##` makes; no longer name is a name in GLSL (GLSL ES 3.20, section 3.8)."""

_Word = tuple[Token, frozenset[str]]
"""A word and its hide set."""

_NONE: frozenset[str] = frozenset()


class Macro(NamedTuple):
    """What #define says. `params` is None for a macro without brackets; a `##` in the body has the type PASTE."""

    name: str
    params: tuple[str, ...] | None
    body: tuple[Token, ...]
    pastes: bool = False
    """Whether there is a `##` in the body."""

    def same_as(self, other: Macro) -> bool:
        """Whether both say the same, wherever they stand."""
        return self.params == other.params and [t.text for t in self.body] == [t.text for t in other.body]


_LINE = Macro("__LINE__", None, ())
"""The builtin macro that is the number of the line that uses it."""


def builtin_macros(version: int, profile: str) -> dict[str, Macro]:
    """What the language itself defines, for what #version says (0 and '' without)."""
    profile = profile or ("core" if version == 0 or version >= 150 else "")
    values = {"__FILE__": 0, "__VERSION__": version or 450, "GL_FRAGMENT_PRECISION_HIGH": 1}
    values |= {"GL_ES": 1} if profile == "es" else {}
    values |= {f"GL_{profile}_profile": 1} if profile else {}
    made = {name: Macro(name, None, (Token("INT", str(value), NOWHERE),)) for name, value in values.items()}
    return {**made, _LINE.name: _LINE}


def definition(words: Sequence[Token], place: Span) -> Macro:
    """The macro that the words behind a #define say; `place` is the directive's. Raises Fault."""
    if not words or not words[0].text.isidentifier():
        raise Fault(words[0].span if words else place, "#define needs a name")
    name, params, body = words[0], None, words[1:]
    if body and body[0].text == "(" and body[0].span[1:3] == name.span[3:5]:
        params = _params(body)
        body = body[max(2, 1 + 2 * len(params)) :]
    for edge in (*body[:1], *body[-1:]):
        if edge.type == "PASTE":
            raise Fault(edge.span, "'##' must be between two tokens")
    return Macro(name.text, params, tuple(body), any(token.type == "PASTE" for token in body))


def _params(words: Sequence[Token]) -> tuple[str, ...]:
    """The names in the brackets that the words begin with."""
    found: list[str] = []
    for at, word in enumerate(words[1:]):
        if word.text == ")" and (at == 0 or at % 2):
            return tuple(found)
        if at % 2 == 0 and word.text.isidentifier() and word.text not in found:
            found.append(word.text)
        elif at % 2 == 0 or word.text != ",":
            raise Fault(word.span, f"'{word.text}' is not expected here", "write #define name(first, second) …")
    raise Fault(words[0].span, "these parameters are not closed")


class TooMuch(Fault):
    """An expansion that is too large to go on with."""


class Expander:
    """The macros at one point of a text, and what they make of words.

    `join` makes the word that `##` puts together, and `report` notes errors. `kept` are names of macros that are not
    expanded in code; which of them were met is in `used`, and those that `##` joined when
    they should have been expanded in `joined`.
    """

    def __init__(self, join: Callable[[str, Span], Token], report: Callable[[Span, str, str], None]) -> None:
        self.macros: dict[str, Macro] = {}
        self.kept: set[str] = set()
        self.used: set[str] = set()
        self.joined: set[str] = set()
        self.join = join
        self.report = report
        self.made = 0
        self.limit = 0
        self.held: _Word | None = None  # a macro's name at the end of the last words: its arguments may follow

    def expand(self, tokens: Sequence[Token]) -> list[Token]:
        """The words with their macros expanded; the last may be held back for the next call or for `rest`.

        Raises TooMuch at the use of a macro that grows without end.
        """
        held, macros = self.held, self.macros
        if not tokens or (held is None and macros.keys().isdisjoint([token[1] for token in tokens])):
            return list(tokens)
        out: list[Token] = []
        at = 0
        if held is not None:
            self.held = None
            at = self._use(held, tokens, 0, out)
        while at < len(tokens):
            token = tokens[at]
            at += 1
            if token[1] in macros:
                at = self._use((token, _NONE), tokens, at, out)
            else:
                out.append(token)
        return out

    def rest(self) -> list[Token]:
        """The word that was held back, if there is one."""
        held, self.held = self.held, None
        return [held[0]] if held is not None else []

    def condition(self, tokens: Sequence[Token]) -> list[Token]:
        """The words of an #if: what stands behind `defined` is left as it is, and `kept` is expanded, too."""
        self.limit = self.made + MAX_EXPANSION
        return [word[0] for word in self._run(_Stream([(token, _NONE) for token in reversed(tokens)]), 0, True)]

    def _use(self, word: _Word, tokens: Sequence[Token], at: int, out: list[Token]) -> int:
        """Expands one use whose arguments may be read from the tokens; says where what is left of them begins."""
        self.limit = self.made + MAX_EXPANSION
        stream = _Stream([word], tokens, at)
        words = self._run(stream, 0)
        if words and stream.at == len(tokens) and self._takes_arguments(words[-1]):
            self.held = words.pop()
        out += [token for token, _ in words]
        return stream.at

    def _takes_arguments(self, word: _Word) -> bool:
        macro = self.macros.get(word[0].text)
        return macro is not None and macro.params is not None and macro.name not in word[1]

    def _run(self, stream: _Stream, depth: int, condition: bool = False) -> list[_Word]:
        """Expands until nothing is left that was put back."""
        out: list[_Word] = []
        back = stream.back
        while back:
            word = back.pop()
            token, hidden = word
            name = token.text
            macro = self.macros.get(name)
            if condition and name == "defined":
                out += [word, *stream.asked_for()]
                continue
            if macro is None or name in hidden:
                out.append(word)
                continue
            if name in self.kept and not condition:
                self.used.add(name)
                out.append((token, hidden | {name}))  # as if it were expanded
                continue
            arguments: list[list[_Word]] = []
            if macro.params is not None:
                if stream.next_text() != "(":
                    out.append(word)
                    continue
                found = self._arguments(macro, token.span, stream)
                if found is None:
                    continue
                arguments, hidden = found[0], hidden & found[1]
            hidden |= {name}
            if len(hidden) > MAX_NESTED or depth > MAX_NESTED:
                raise TooMuch(token.span, f"macros nest more than {MAX_NESTED} levels deep")
            made = self._substituted(macro, arguments, hidden, token.span, depth)
            self._count(len(made) + 1, token.span)
            back += reversed(made)
        return out

    def _count(self, words: int, place: Span) -> None:
        self.made += words
        if self.made > MAX_TOKENS:
            raise TooMuch(place, f"macros expand to more than {MAX_TOKENS} tokens", "use functions instead")
        if self.made > self.limit:
            raise TooMuch(place, f"this macro expands to more than {MAX_EXPANSION} tokens", "use a function instead")

    def _arguments(self, macro: Macro, place: Span, stream: _Stream) -> tuple[list[list[_Word]], frozenset[str]] | None:
        """The arguments of a use, and the hide set of the bracket that closes them; nothing after an error."""
        stream.take()
        arguments: list[list[_Word]] = [[]]
        depth, count = 1, 0
        while True:
            word = stream.take()
            if word is None:
                hint = "a directive cannot be between a macro's arguments"
                self.report(place, f"the arguments of '{macro.name}' are not closed", hint)
                return None
            text = word[0].text
            if text == "(":
                depth += 1
            elif text == ")":
                depth -= 1
                if depth == 0:
                    break
            if text == "," and depth == 1:
                arguments.append([])
            else:
                arguments[-1].append(word)
            count += 1
        self._count(count, place)
        assert macro.params is not None
        wanted = len(macro.params)
        if wanted == 0 and arguments == [[]]:
            return [], word[1]
        if wanted != len(arguments):
            takes = f"{wanted} argument{'s' * (wanted != 1)}"
            self.report(place, f"'{macro.name}' takes {takes}, but gets {len(arguments)}", "")
            return None
        return arguments, word[1]

    def _substituted(
        self, macro: Macro, arguments: list[list[_Word]], hidden: frozenset[str], place: Span, depth: int
    ) -> list[_Word]:
        """The body with its arguments, each expanded by itself, but not beside `##`."""
        if macro is _LINE:
            return [(Token("INT", str(place.line), place), hidden)]
        if not arguments and not macro.pastes:
            return [(tuple.__new__(Token, (token[0], token[1], place)), hidden) for token in macro.body]
        raw = dict(zip(macro.params or (), arguments, strict=True))
        expanded: dict[str, list[_Word]] = {}
        body, made = macro.body, list[_Word]()
        start = 0  # where in `made` the left side of the next `##` begins
        for at, token in enumerate(body):
            if token.type == "PASTE":
                continue
            pasted = at > 0 and body[at - 1].type == "PASTE"
            beside = pasted or (at + 1 < len(body) and body[at + 1].type == "PASTE")
            name = token.text
            if name not in raw:
                words = [(Token(token.type, name, place), hidden)]
            elif beside:
                words = _hiding(raw[name], hidden)
            else:
                if name not in expanded:
                    expanded[name] = _hiding(self._run(_Stream(raw[name][::-1]), depth + 1), hidden)
                words = expanded[name]
            if not pasted:
                start = len(made)
            elif words and len(made) > start:
                (left, one), (right, other) = made.pop(), words[0]
                if len(left.text) + len(right.text) > MAX_JOINED:
                    raise TooMuch(place, f"'##' makes a token of more than {MAX_JOINED} characters")
                self.joined |= self.kept & ({left.text} & one | {right.text} & other)
                made.append((self.join(left.text + right.text, place), (one & other) | hidden))
                words = words[1:]
            made += words
            if len(made) > MAX_EXPANSION:
                break  # _count says so
        return made


class _Stream:
    """Words to be looked at: what was put back, its last first, and behind it what is written."""

    def __init__(self, back: list[_Word], written: Sequence[Token] = (), at: int = 0) -> None:
        self.back = back
        self.written = written
        self.at = at

    def next_text(self) -> str:
        """The word that comes next, '' at the end."""
        if self.back:
            return self.back[-1][0].text
        return self.written[self.at].text if self.at < len(self.written) else ""

    def take(self) -> _Word | None:
        if self.back:
            return self.back.pop()
        if self.at == len(self.written):
            return None
        self.at += 1
        return self.written[self.at - 1], _NONE

    def asked_for(self) -> list[_Word]:
        """What stands behind `defined`: a name, or one in brackets."""
        words = [self.take() for _ in range(3 if self.next_text() == "(" else 1)]
        return [word for word in words if word is not None]


def _hiding(words: list[_Word], hidden: frozenset[str]) -> list[_Word]:
    return [(word, hides | hidden if hides else hidden) for word, hides in words]
