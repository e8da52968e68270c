"""Macros and their expansion, as in C (C11, section 6.10.3; GLSL 4.60, section 3.3, without stringification).

An expansion is scanned again, together with the tokens after it. A macro's name in its own expansion is not expanded:
each token has a hide set, the macros that must not expand it (Prosser, "Complete macro expansion algorithm",
X3J11/86-196, 1986).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import NamedTuple

from sssgen.ir.spans import NOWHERE, Span
from sssgen.lang.preprocess.if_conditions import Fault
from sssgen.lang.syntax.tokens import Token

MAX_EXPANSION = 100_000
"""How many tokens one use of a macro may expand to. Tables in macros have some thousands."""

MAX_TOKENS = 1_000_000
"""How many tokens a text may have after macro expansion."""

MAX_NESTED = 100
"""How deeply macros may nest in each other's bodies and arguments."""

MAX_JOINED = 1024
"""The longest token that `##` may make; GLSL allows no longer names (GLSL ES 3.20, section 3.8)."""

_Item = tuple[Token, frozenset[str]]
"""A token and its hide set."""

_NONE: frozenset[str] = frozenset()


class Macro(NamedTuple):
    """A macro. `params` is None for a macro without parentheses; a `##` in the body has the type PASTE."""

    name: str
    params: tuple[str, ...] | None
    body: tuple[Token, ...]
    pastes: bool = False
    """Whether there is a `##` in the body."""
    fault: tuple[Span, str, str] | None = None
    """What is wrong with its body, which is an error where the macro is used."""

    def same_as(self, other: Macro) -> bool:
        """Whether both have the same definition, wherever it is written, with blanks at the same places."""
        same = self.params == other.params and [t.text for t in self.body] == [t.text for t in other.body]
        return same and _blanks(self.body) == _blanks(other.body)


def _blanks(tokens: Sequence[Token]) -> list[bool]:
    """Behind which tokens there are blanks."""
    return [before.span[3:5] != token.span[1:3] for before, token in pairwise(tokens)]


_LINE = Macro("__LINE__", None, ())
"""The builtin macro that expands to the number of the line that uses it."""

_FILE = Macro("__FILE__", None, ())
"""The builtin macro that expands to the number that `#line` gave to the text that uses it."""


def builtin_macros(version: int, profile: str) -> dict[str, Macro]:
    """The macros that the language defines, for the arguments of #version (0 and '' without one)."""
    profile = profile or ("core" if version == 0 or version >= 150 else "")
    values = {"__VERSION__": version or 450, "GL_FRAGMENT_PRECISION_HIGH": 1}
    values |= {"GL_ES": 1} if profile == "es" else {}
    values |= {"GL_ANDROID_extension_pack_es31a": 1} if profile == "es" and version >= 310 else {}
    values |= {f"GL_{profile}_profile": 1} if profile else {}
    macros = {name: Macro(name, None, (Token("INT", str(value), NOWHERE),)) for name, value in values.items()}
    return {**macros, _LINE.name: _LINE, _FILE.name: _FILE}


def definition(tokens: Sequence[Token], place: Span) -> Macro:
    """The macro that the tokens after #define define; `place` is the directive's. Raises Fault."""
    if not tokens or not tokens[0].text.isidentifier():
        raise Fault(tokens[0].span if tokens else place, "#define needs a name")
    name, params, body = tokens[0], None, tokens[1:]
    if body and body[0].text == "(" and body[0].span[1:3] == name.span[3:5]:
        params = _params(body)
        body = body[max(2, 1 + 2 * len(params)) :]
    for edge in (*body[:1], *body[-1:]):
        if edge.type == "PASTE":
            raise Fault(edge.span, "'##' must be between two tokens")
    for mark, token in pairwise(body):
        if mark.type == "HASH" and token.text in (params or ()):
            raise Fault(mark.span, "GLSL has no operator '#': it has no texts")
    return Macro(name.text, params, tuple(body), any(token.type == "PASTE" for token in body))


def _params(tokens: Sequence[Token]) -> tuple[str, ...]:
    """The names in the parentheses that the tokens begin with."""
    names: list[str] = []
    for index, token in enumerate(tokens[1:]):
        if token.text == ")" and (index == 0 or index % 2):
            return tuple(names)
        if index % 2 == 0 and token.text.isidentifier() and token.text not in names:
            names.append(token.text)
        elif index % 2 == 0 or token.text != ",":
            raise Fault(token.span, f"'{token.text}' is not expected here", "write #define name(first, second) …")
    raise Fault(tokens[0].span, "these parameters are not closed")


class Numbering(NamedTuple):
    """What `#line` sets: how much larger a line's number is than that in the file, and the number of the text."""

    shift: int = 0
    text: int = 0


class TooMuch(Fault):
    """An expansion that exceeds a limit."""


class Expander:
    """The macros at one point of a text, and their expansion.

    `join` makes the token that `##` joins, `report` reports errors. `constants` are the names of macros that are not
    expanded in code; `used` are those of them that were found, `joined` those that `##` joined with another token.
    """

    def __init__(self, join: Callable[[str, Span], Token], report: Callable[[Span, str, str], None]) -> None:
        self.macros: dict[str, Macro] = {}
        self.constants: set[str] = set()
        self.used: set[str] = set()
        self.joined: set[str] = set()
        self.join = join
        self.report = report
        self.numbering = Numbering()
        self.count = 0
        self.limit = 0
        self.pending: _Item | None = None  # a macro's name at the end of the last tokens: its arguments may follow

    def expand(self, tokens: Sequence[Token]) -> list[Token]:
        """The tokens with their macros expanded; the last may be held back for the next call or for `rest`.

        Raises TooMuch at the use of a macro that grows without end.
        """
        pending, macros = self.pending, self.macros
        out: list[Token] = []
        start = 0
        if pending is not None and tokens:
            self.pending = None
            start = self._use(pending, tokens, 0, out)
        for index in [index for index, token in enumerate(tokens) if token[1] in macros]:
            if index >= start:  # it is no argument of the use before
                out += tokens[start:index]
                start = self._use((tokens[index], _NONE), tokens, index + 1, out)
        out += tokens[start:]
        return out

    def rest(self) -> list[Token]:
        """The token that was held back, if there is one."""
        pending, self.pending = self.pending, None
        return [pending[0]] if pending is not None else []

    def condition(self, tokens: Sequence[Token]) -> list[Token]:
        """The tokens of an #if: the operand of `defined` is not expanded, and `constants` are, too."""
        self.limit = self.count + MAX_EXPANSION
        return [item[0] for item in self._run(_Stream([(token, _NONE) for token in reversed(tokens)]), 0, True)]

    def _use(self, item: _Item, tokens: Sequence[Token], index: int, out: list[Token]) -> int:
        """Expands one use whose arguments may be in the tokens; gives the index of the first token after it."""
        self.limit = self.count + MAX_EXPANSION
        stream = _Stream([item], tokens, index)
        items = self._run(stream, 0)
        if items and stream.index == len(tokens) and self._takes_arguments(items[-1]):
            self.pending = items.pop()
        out += [token for token, _ in items]
        return stream.index

    def _takes_arguments(self, item: _Item) -> bool:
        macro = self.macros.get(item[0].text)
        return macro is not None and macro.params is not None and macro.name not in item[1]

    def _run(self, stream: _Stream, depth: int, condition: bool = False) -> list[_Item]:
        """Expands until the stream has no tokens left that were put back."""
        out: list[_Item] = []
        back = stream.back
        while back:
            item = back.pop()
            token, hidden = item
            name = token.text
            macro = self.macros.get(name)
            if condition and name == "defined":
                out += [item, *stream.operand_of_defined()]
                continue
            if macro is None or name in hidden:
                out.append(item)
                continue
            if name in self.constants and not condition:
                self.used.add(name)
                out.append((token, hidden | {name}))  # as if it had been expanded
                continue
            arguments: list[list[_Item]] = []
            if macro.params is not None:
                if stream.next_text() != "(":
                    out.append(item)
                    continue
                call = self._arguments(macro, token.span, stream)
                if call is None:
                    continue
                arguments, hidden = call[0], hidden & call[1]
            if macro.fault is not None:
                self.report(*macro.fault)
            hidden |= {name}
            if len(hidden) > MAX_NESTED or depth > MAX_NESTED:
                raise TooMuch(token.span, f"macros nest more than {MAX_NESTED} levels deep")
            body = self._substitute(macro, arguments, hidden, token.span, depth)
            self._add(len(body) + 1, token.span)
            back += reversed(body)
        return out

    def _add(self, tokens: int, place: Span) -> None:
        """Counts tokens, and reports where a limit is exceeded."""
        self.count += tokens
        if self.count > MAX_TOKENS:
            raise TooMuch(place, f"macros expand to more than {MAX_TOKENS} tokens", "use functions instead")
        if self.count > self.limit:
            raise TooMuch(place, f"this macro expands to more than {MAX_EXPANSION} tokens", "use a function instead")

    def _arguments(self, macro: Macro, place: Span, stream: _Stream) -> tuple[list[list[_Item]], frozenset[str]] | None:
        """The arguments of a use, and the hide set of the closing parenthesis; None after an error."""
        stream.take()
        arguments: list[list[_Item]] = [[]]
        depth, count = 1, 0
        while True:
            item = stream.take()
            if item is None:
                hint = "a directive cannot be between a macro's arguments"
                self.report(place, f"the arguments of '{macro.name}' are not closed", hint)
                return None
            text = item[0].text
            if text == "(":
                depth += 1
            elif text == ")":
                depth -= 1
                if depth == 0:
                    break
            if text == "," and depth == 1:
                arguments.append([])
            else:
                arguments[-1].append(item)
            count += 1
        self._add(count, place)
        assert macro.params is not None
        expected = len(macro.params)
        if expected == 0 and arguments == [[]]:
            return [], item[1]
        if expected != len(arguments):
            takes = f"{expected} argument{'s' * (expected != 1)}"
            self.report(place, f"'{macro.name}' takes {takes}, but gets {len(arguments)}", "")
            return None
        return arguments, item[1]

    def _substitute(
        self, macro: Macro, arguments: list[list[_Item]], hidden: frozenset[str], place: Span, depth: int
    ) -> list[_Item]:
        """The body with its arguments, which are expanded on their own, except next to `##`."""
        if macro is _LINE or macro is _FILE:
            number = place.line + self.numbering.shift if macro is _LINE else self.numbering.text
            return [(Token("INT", str(number), place), hidden)]
        if not arguments and not macro.pastes:
            return [(tuple.__new__(Token, (token[0], token[1], place)), hidden) for token in macro.body]
        raw = dict(zip(macro.params or (), arguments, strict=True))
        expanded: dict[str, list[_Item]] = {}
        body, result = macro.body, list[_Item]()
        start = 0  # where in `result` the left side of the next `##` begins
        for index, token in enumerate(body):
            if token.type == "PASTE":
                continue
            pasted = index > 0 and body[index - 1].type == "PASTE"
            is_raw = pasted or (index + 1 < len(body) and body[index + 1].type == "PASTE")
            name = token.text
            if name not in raw:
                items = [(Token(token.type, name, place), hidden)]
            elif is_raw:
                items = _hiding(raw[name], hidden)
            else:
                if name not in expanded:
                    expanded[name] = _hiding(self._run(_Stream(raw[name][::-1]), depth + 1), hidden)
                items = expanded[name]
            if not pasted:
                start = len(result)
            elif items and len(result) > start:
                (left, left_hidden), (right, right_hidden) = result.pop(), items[0]
                if len(left.text) + len(right.text) > MAX_JOINED:
                    raise TooMuch(place, f"'##' makes a token of more than {MAX_JOINED} characters")
                self.joined |= self.constants & ({left.text} & left_hidden | {right.text} & right_hidden)
                joined = self.join(left.text + right.text, place)
                result.append((joined, (left_hidden & right_hidden) | hidden))
                items = items[1:]
            result += items
            if len(result) > MAX_EXPANSION:
                break  # _add reports it
        return result


class _Stream:
    """Tokens to expand: those that were put back, the last one first, and after them those of the text."""

    def __init__(self, back: list[_Item], tokens: Sequence[Token] = (), index: int = 0) -> None:
        self.back = back
        self.tokens = tokens
        self.index = index

    def next_text(self) -> str:
        """The text of the next token, '' at the end."""
        if self.back:
            return self.back[-1][0].text
        return self.tokens[self.index].text if self.index < len(self.tokens) else ""

    def take(self) -> _Item | None:
        if self.back:
            return self.back.pop()
        if self.index == len(self.tokens):
            return None
        self.index += 1
        return self.tokens[self.index - 1], _NONE

    def operand_of_defined(self) -> list[_Item]:
        """The tokens after `defined`: a name, or a name in parentheses."""
        items = [self.take() for _ in range(3 if self.next_text() == "(" else 1)]
        return [item for item in items if item is not None]


def _hiding(items: list[_Item], hidden: frozenset[str]) -> list[_Item]:
    return [(item, hides | hidden if hides else hidden) for item, hides in items]
