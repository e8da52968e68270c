"""The shader cases of VK-GL-CTS: files such as `data/gles*/shaders/*.test`, as their owner publishes them.

A file has groups of cases. A case has the texts of its stages, what a compiler has to do with them, and the values of
inputs and outputs, where it has any.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

_TOKEN = re.compile(
    r'(?P<skip>\s+|#[^\n]*)|""(?P<text>.*?)""|"(?P<line>[^"\n]*)"|(?P<word>[A-Za-z_][\w.-]*)'
    r"|(?P<number>[-+]?(?:0[xX][0-9a-fA-F]+|\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+)[uUfF]?)|(?P<mark>[{}\[\]()|,;=:<>])",
    re.DOTALL,
)
BOTH = "both"
"""The stage of a text that is a vertex shader and a fragment shader."""


class Value(NamedTuple):
    """An input, an output or a uniform of a case."""

    kind: str
    """`input`, `output` or `uniform`; of the runner, `initial`: what the text gives to its own variable"""
    type: str
    name: str
    rows: tuple[tuple[float, ...], ...]
    """One value for each run: the numbers of a scalar or vector, or of a matrix column by column"""


class Case(NamedTuple):
    """One case."""

    name: str
    """`gles3/functions.datatypes.float_float`"""
    version: str
    """Such as `300 es`"""
    expects: str
    """`pass`, `build_successful`, `compile_fail`, `link_fail`, …"""
    requires: tuple[str, ...]
    """What a driver must have to run it, such as `extension GL_A | GL_B in vertex, fragment`"""
    values: tuple[Value, ...]
    stages: dict[str, str]
    """Stage → text, with the marks that `deqp_programs` replaces"""


class SuiteFormatError(Exception):
    """A file that is not as this module expects."""


def read(path: Path, group: str) -> Iterator[Case]:
    """The cases of a file, whose names begin with `group`. Raises SuiteFormatError."""
    reader = _Reader(path.read_text("utf-8", errors="replace"), str(path))
    yield from reader.cases([group])
    if reader.next[0]:
        raise SuiteFormatError(f"{path}: {reader.next[1][:40]!r} is no group and no case")


class _Facts(NamedTuple):
    """What the clauses of a case say so far."""

    words: list[tuple[str, str]]
    requires: list[str]
    values: list[Value]
    stages: dict[str, str]


class _Reader:
    def __init__(self, text: str, path: str) -> None:
        self.path = path
        self.tokens: list[tuple[str, str]] = []
        position = 0
        while position < len(text):
            match = _TOKEN.match(text, position)
            if match is None:
                raise SuiteFormatError(f"{path}: {text[position : position + 40]!r}")
            kind = match.lastgroup or ""
            if kind != "skip":
                self.tokens.append((kind, match[kind]))
            position = match.end()
        self.place = 0

    @property
    def next(self) -> tuple[str, str]:
        return self.tokens[self.place] if self.place < len(self.tokens) else ("", "")

    def take(self) -> tuple[str, str]:
        token = self.next
        self.place += 1
        return token

    def accept(self, text: str) -> bool:
        """Whether the next token is this word or mark, which is then read."""
        if self.next[0] in ("word", "mark") and self.next[1] == text:
            self.place += 1
            return True
        return False

    def expect(self, text: str) -> None:
        if not self.accept(text):
            raise SuiteFormatError(f"{self.path}: {text!r} is expected, not {self.next[1][:40]!r}")

    def cases(self, groups: list[str]) -> Iterator[Case]:
        """The cases up to the end of a group."""
        while self.next[0]:
            if self.accept("group"):
                name = self.take()[1]
                if self.next[0] in ("line", "text"):
                    self.take()
                yield from self.cases([*groups, name])
                self.expect("end")
            elif self.accept("import"):
                self.take()
            elif self.accept("case"):
                yield self.case(groups)
            elif self.next == ("word", "end"):
                return
            else:
                raise SuiteFormatError(f"{self.path}: {self.next[1][:40]!r} is no group and no case")

    def case(self, groups: list[str]) -> Case:
        name = self.take()[1]
        facts = _Facts([], [], [], {})
        self.clauses(facts, f"{'.'.join(groups)}.{name}")
        version, expects = (
            dict(facts.words).get(key, default) for key, default in (("version", ""), ("expect", "pass"))
        )
        return Case(
            ".".join([*groups, name]), version, expects, tuple(facts.requires), tuple(facts.values), facts.stages
        )

    def clauses(self, facts: _Facts, name: str) -> None:
        """What is between a case's name, or `pipeline_program`, and its `end`."""
        while not self.accept("end"):
            word = self.take()[1]
            if word == "version":
                version = self.take()[1]
                if self.next[1] in ("es", "core", "compatibility"):
                    version += " " + self.take()[1]
                facts.words.append((word, version))
            elif word == "expect":
                facts.words.append((word, self.take()[1]))
            elif word == "desc":
                self.take()
            elif word in ("require", "active_stages"):
                facts.requires.extend(self.requirement(word))
            elif word == "values":
                facts.values.extend(self.values())
            elif word == "pipeline_program":
                facts.requires.append(word)
                self.clauses(facts, name)
            elif self.next[0] in ("text", "line"):
                facts.stages[word] = _unindented(self.take()[1])
            else:
                raise SuiteFormatError(f"{self.path}: {name}: {word!r}")

    def requirement(self, word: str) -> list[str]:
        if word == "active_stages" or self.next == ("mark", "{"):
            names = self.listed()
            return names if word == "require" else [word]
        required = [self.take()[1]]
        if required[0] == "limit":
            required += [self.take()[1] for _ in range(3)]
        if required[0] == "extension":
            required += self.listed() if self.next == ("mark", "{") else [self.take()[1]]
        if self.accept("in"):
            required += ["in", *self.listed()]
        return [" ".join(required)]

    def listed(self) -> list[str]:
        """The words and marks between braces."""
        words = []
        self.expect("{")
        while not self.accept("}"):
            words.append(self.take()[1])
        return words

    def values(self) -> Iterator[Value]:
        self.expect("{")
        while not self.accept("}"):
            kind, type_, name = (self.take()[1] for _ in range(3))
            while self.accept("."):
                name += "." + self.take()[1]
            self.expect("=")
            rows = []
            if self.accept("["):
                rows.append(self.row())
                while self.accept("|"):
                    rows.append(self.row())
                self.expect("]")
            else:
                rows.append(self.row())
            self.expect(";")
            yield Value(kind, type_, name, tuple(rows))

    def row(self) -> tuple[float, ...]:
        """A number, or the numbers of a constructor."""
        kind, text = self.take()
        if kind == "number":
            return (_number(text),)
        if text in ("true", "false"):
            return (float(text == "true"),)
        self.expect("(")
        numbers: list[float] = []
        while not self.accept(")"):
            numbers += self.row()
            self.accept(",")
        return tuple(numbers)


def _number(text: str) -> float:
    text = text.rstrip("uU")
    return float(int(text, 16)) if "0x" in text.lower() else float(text.rstrip("fF"))


def _unindented(text: str) -> str:
    """Without the empty line at the start: `#version` has to be the first line."""
    lines = text.replace("\\\\", "\\").strip("\n").split("\n")  # a backslash is written twice
    depth = min((len(line) - len(line.lstrip()) for line in lines if line.strip()), default=0)
    return "\n".join(line[depth:] for line in lines).strip() + "\n"
