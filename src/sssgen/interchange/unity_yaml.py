"""Reads Unity's text files: YAML with a header and a tag of Unity for each document. Values keep their places.

Only what Unity writes is read: plain mappings, lists and scalars. Other tags are errors, and so are aliases, which
could make a small file endless.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from sssgen.ir.spans import Span
from sssgen.support.diagnostics import Diagnostic, Reporter, SssgenError
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
    file: UnityFile
    path: str
    line: int
    column: int

    @property
    def span(self) -> Span:
        """Where the value begins."""
        return Span(self.file.shown, self.line, self.column, self.line, self.column + 1)

    def error(self, message: str, hint: str = "") -> SssgenError:
        """The error at this value; the message gets its path."""
        reporter = Reporter(self.file.shown, self.file.text)
        reporter.error(self.span, f"{message} ({self.path})", hint)
        return SssgenError(reporter.diagnostics)

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
        return tuple(self.required(key).number for key in keys)

    def required(self, key: str) -> Value:
        """The value of a key of a mapping. Raises SssgenError where it is missing."""
        if key not in self.mapping:
            raise self.error(f"the key '{key}' is missing")
        return self.mapping[key]

    def pairs(self) -> Iterator[tuple[str, Value]]:
        """The keys and values of a list of mappings with one key each, as Unity writes the properties of materials."""
        for item in self.items:
            yield from item.mapping.items()


class UnityDocument(NamedTuple):
    """An object of a file: `kind` is Unity's number of its class, `name` the class."""

    kind: int
    name: str
    body: Value


class UnityFile:
    """The documents of a text file of Unity."""

    def __init__(self, path: str) -> None:
        """Reads a file. Raises SssgenError with the place of what is not Unity's YAML."""
        self.path, self.shown = path, posix(path)
        self.text = read_text(path, self.shown)
        self.documents: list[UnityDocument] = []
        yaml = need("yaml", "pyyaml", "import")
        heads = list(_HEAD.finditer(self.text))
        if not heads:
            place = Span(self.shown, 1, 1, 1, 2)
            hint = "in Unity, set Asset Serialization to Force Text"
            first = self.text.partition("\n")[0]
            raise SssgenError([Diagnostic("error", "this is not a text file of Unity", place, hint, first)])
        ends = [head.start() for head in heads[1:]] + [len(self.text)]
        for head, end in zip(heads, ends, strict=True):
            line = self.text.count("\n", 0, head.end())
            body = _Composer(self, yaml, self.text[head.end() : end], line).document()
            self.documents += [UnityDocument(int(head[1]), name, value) for name, value in body.mapping.items()]

    def of_kind(self, name: str) -> list[Value]:
        """The objects of a class, such as `Material`."""
        return [document.body for document in self.documents if document.name == name]


def read_plain(path: str) -> Value:
    """The one mapping of a file without documents, such as a .meta file."""
    file = UnityFile.__new__(UnityFile)
    file.path, file.shown = path, posix(path)
    file.text = read_text(path, file.shown)
    return _Composer(file, need("yaml", "pyyaml", "import"), _TAGS.sub("", file.text), 0).document()


class _Composer:
    """Makes values of the events of PyYAML's parser."""

    def __init__(self, file: UnityFile, yaml: Any, text: str, first_line: int) -> None:
        self.file, self.yaml, self.first_line = file, yaml, first_line
        self.events = yaml.parse(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))

    def document(self) -> Value:
        yaml = self.yaml
        try:
            for event in self.events:
                if isinstance(event, yaml.StreamEndEvent):
                    break
                if not isinstance(event, yaml.StreamStartEvent | yaml.DocumentStartEvent | yaml.DocumentEndEvent):
                    return self.value(event, "", 0)
        except yaml.MarkedYAMLError as error:
            mark = error.problem_mark or error.context_mark
            raise self.failure(f"this is not YAML: {error.problem or error.context}", mark) from None
        except yaml.YAMLError as error:
            raise self.failure(f"this is not YAML: {error}", None) from None
        return Value("", self.file, "", self.first_line + 1, 1)

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
        return Value(content, self.file, path or "/", line, column)

    def place(self, mark: Any) -> tuple[int, int]:
        if mark is None:
            return self.first_line + 1, 1
        return min(self.first_line + mark.line, self.file.text.count("\n")) + 1, mark.column + 1

    def failure(self, message: str, mark: Any, hint: str = "") -> SssgenError:
        line, column = self.place(mark)
        reporter = Reporter(self.file.shown, self.file.text)
        reporter.error(Span(self.file.shown, line, column, line, column + 1), message, hint)
        return SssgenError(reporter.diagnostics)
