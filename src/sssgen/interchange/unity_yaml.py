"""Reads Unity's text files: YAML with a header and a tag of Unity for each document. Values keep their places.

PyYAML's parser gives events with their places. Its composer, which would give nodes, resolves aliases and nests as
deeply as the file; here both are errors, as are tags: Unity writes plain mappings, lists and scalars.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from sssgen.ir.spans import Span
from sssgen.support.diagnostics import Reporter, SssgenError
from sssgen.support.extras import need
from sssgen.support.paths import posix
from sssgen.support.text_files import read_text

MAX_DEPTH = 32
_HEAD = re.compile(r"^--- !u!(\d+) &(-?\d+)(?: stripped)?[ \t]*$", re.MULTILINE)
_TAGS = re.compile(r"^%(?:YAML|TAG)\b.*$", re.MULTILINE)


@dataclass(frozen=True)
class Value:
    """A mapping, a list or the text of a scalar, with its place and its path in the file."""

    content: dict[str, Value] | list[Value] | str
    source: UnityText
    path: str
    line: int
    column: int

    @property
    def span(self) -> Span:
        """Where the value begins."""
        return self.source.span(self.line, self.column)

    def error(self, message: str, hint: str = "") -> SssgenError:
        """The error at this value; the message gets its path."""
        return self.source.error(self.span, f"{message} ({self.path})", hint)

    @property
    def mapping(self) -> Mapping[str, Value]:
        """The mapping; an empty text, which is Unity's null, is an empty one. Raises SssgenError for anything else."""
        if isinstance(self.content, dict):
            return self.content
        if not self.content:
            return {}
        raise self.error("a mapping is expected here", "it is written as {key: value}")

    @property
    def items(self) -> list[Value]:
        """The list. Raises SssgenError for anything else."""
        if isinstance(self.content, list):
            return self.content
        if not self.content:
            return []
        raise self.error("a list is expected here")

    @property
    def text(self) -> str:
        """The text of a scalar. Raises SssgenError for anything else."""
        if isinstance(self.content, str):
            return self.content
        raise self.error("a number or a text is expected here")

    @property
    def number(self) -> float:
        """The number of a scalar. Raises SssgenError for text and for numbers that are not finite."""
        try:
            number = float(self.text)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            raise self.error(f"'{self.text[:40]}' is not a number")
        return number

    def numbers(self, keys: str) -> tuple[float, ...]:
        """The numbers of a mapping such as {x: 0, y: 1}; `keys` has a letter for each."""
        return tuple(self.require(key).number for key in keys)

    def require(self, key: str) -> Value:
        """The value of a key of a mapping. Raises SssgenError where it is missing."""
        if key not in self.mapping:
            raise self.error(f"the key '{key}' is missing")
        return self.mapping[key]

    def pairs(self) -> Iterator[tuple[str, Value]]:
        """The keys and values of a list of mappings with one key each, as Unity writes the properties of materials."""
        for item in self.items:
            yield from item.mapping.items()


class UnityText:
    """The text of a file, and its name in messages."""

    def __init__(self, path: str) -> None:
        self.name = posix(path)
        self.text = read_text(path, self.name)

    def span(self, line: int, column: int) -> Span:
        """The place of a character."""
        return Span(self.name, line, column, line, column + 1)

    def error(self, span: Span, message: str, hint: str = "") -> SssgenError:
        """The error at a place."""
        reporter = Reporter(self.name, self.text)
        reporter.error(span, message, hint)
        return SssgenError(reporter.diagnostics)


def objects(path: str, kind: str) -> list[Value]:
    """The objects of a class, such as `Material`, in a file.

    Raises SssgenError with the place of what is not Unity's YAML.
    """
    source = UnityText(path)
    heads = list(_HEAD.finditer(source.text))
    if not heads:
        hint = "in Unity, set Asset Serialization to Force Text"
        raise source.error(source.span(1, 1), "this is not a text file of Unity", hint)
    ends = [head.start() for head in heads[1:]] + [len(source.text)]
    values = []
    for head, end in zip(heads, ends, strict=True):
        line = source.text.count("\n", 0, head.end())
        body = _Composer(source, source.text[head.end() : end], line).document()
        values += [value for name, value in body.mapping.items() if name == kind]
    return values


def read_plain(path: str) -> Value:
    """The one mapping of a file without documents, such as a .meta file."""
    source = UnityText(path)
    return _Composer(source, _TAGS.sub("", source.text), 0).document()


class _Composer:
    """Makes values of the events of PyYAML's parser."""

    def __init__(self, source: UnityText, text: str, first_line: int) -> None:
        self.source, self.first_line = source, first_line
        self.yaml = yaml = need("yaml", "pyyaml", "import")
        self.events = yaml.parse(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))

    def document(self) -> Value:
        """The value of the first document; an empty text where there is none."""
        yaml = self.yaml
        try:
            for event in self.events:
                if not isinstance(event, yaml.StreamStartEvent | yaml.DocumentStartEvent | yaml.StreamEndEvent):
                    return self.value(event, "", 0)
        except yaml.MarkedYAMLError as error:
            mark = error.problem_mark or error.context_mark
            raise self.failure(f"this is not YAML: {error.problem or error.context}", mark) from None
        except yaml.YAMLError as error:
            raise self.failure(f"this is not YAML: {error}", None) from None
        return Value("", self.source, "", self.first_line + 1, 1)

    def value(self, event: Any, path: str, depth: int) -> Value:
        yaml = self.yaml
        if isinstance(event, yaml.AliasEvent):
            raise self.failure("an alias (*name) is not read", event.start_mark, "Unity writes none")
        if event.tag is not None:
            raise self.failure(f"the tag '{event.tag}' is not read", event.start_mark, "Unity writes none here")
        if depth > MAX_DEPTH:
            raise self.failure("the values are nested too deeply", event.start_mark)
        content: dict[str, Value] | list[Value] | str
        if isinstance(event, yaml.ScalarEvent):
            content = event.value
        elif isinstance(event, yaml.SequenceStartEvent):
            content = []
            while not isinstance(part := next(self.events), yaml.SequenceEndEvent):
                content.append(self.value(part, f"{path}/{len(content)}", depth + 1))
        else:
            content = {}
            while not isinstance(part := next(self.events), yaml.MappingEndEvent):
                key = self.value(part, path, depth + 1)
                if key.text in content:
                    raise key.error(f"the key '{key.text[:40]}' is there twice")
                content[key.text] = self.value(next(self.events), f"{path}/{key.text}", depth + 1)
        line, column = self.place(event.start_mark)
        return Value(content, self.source, path or "/", line, column)

    def place(self, mark: Any) -> tuple[int, int]:
        if mark is None:
            return self.first_line + 1, 1
        return min(self.first_line + mark.line, self.source.text.count("\n")) + 1, mark.column + 1

    def failure(self, message: str, mark: Any, hint: str = "") -> SssgenError:
        return self.source.error(self.source.span(*self.place(mark)), message, hint)
