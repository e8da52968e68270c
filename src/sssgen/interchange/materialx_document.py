"""Reads MaterialX documents safely: with the places of their elements, and with includes that stay in their folder."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from functools import lru_cache
from typing import Any, NamedTuple
from xml.parsers import expat

from sssgen.ir.spans import Span
from sssgen.support.diagnostics import Diagnostic, Reporter, SssgenError, failure
from sssgen.support.extras import need
from sssgen.support.paths import posix
from sssgen.support.text_files import read_text

MAX_DEPTH = 16
"""How deeply elements may nest. MaterialX itself needs 4."""
MAX_ELEMENTS = 50_000
MAX_INCLUDES = 100
_TOKEN = re.compile('<(UDIM|UVTILE|[a-z_]+)>(?=[^<>]*")')
"""A part of a file name in attributes, which MaterialX reads although XML does not allow it."""
_ROOT, _INCLUDE = "materialx", "xi:include"


class Include(NamedTuple):
    """An element that includes another file."""

    href: str
    place: Span


class MaterialXDocument:
    """A document with all that it includes, and the library of MaterialX.

    `document` is MaterialX's own; old versions are upgraded. `folder` is the one of the file, `root` the folder that no
    path may leave.
    """

    def __init__(self, path: str, root: str = "") -> None:
        """Reads a file. Raises SssgenError with the place of the first error."""
        self.module = need("MaterialX", "MaterialX", "import")
        self.path = path
        self.folder = os.path.dirname(os.path.abspath(path))
        self.root = os.path.realpath(root or self.folder)
        self.places: dict[str, Span] = {}
        self._texts: dict[str, str] = {}
        self._included = 0
        self.document = self._read(path, posix(path), ())
        self.document.setDataLibrary(_library())

    def error(self, element: Any, message: str, hint: str = "") -> SssgenError:
        """The error at an element of the document."""
        path = element.getNamePath()
        return self._error_at(self.place(path), message if path in message else f"{message} ({path})", hint)

    def place(self, path: str) -> Span:
        """Where an element is, by its path of names; else where the nearest one around it is."""
        while path and path not in self.places:
            path = path.rpartition("/")[0]
        return self.places.get(path, Span(posix(self.path), 0, 0, 0, 0))

    def file_beside(self, element: Any, name: str) -> str:
        """The path of a file that an element names. Raises SssgenError where the name leaves the root folder."""
        folder = os.path.dirname(element.getActiveSourceUri()) or self.folder
        return self._inside(folder, name, self.place(element.getNamePath()), element.getNamePath())

    def _read(self, path: str, file_name: str, parents: tuple[str, ...]) -> Any:
        text = read_text(path, file_name)
        self._texts[file_name] = text
        scan = _Scan(text, file_name)
        for name, place in scan.places.items():
            self.places.setdefault(name, place)
        options = self.module.XmlReadOptions()
        options.readXIncludeFunction = None  # the includes are read below, where their paths are checked
        document = self.module.createDocument()
        try:
            self.module.readFromXmlString(document, text, self.module.FileSearchPath(), options)
        except Exception as error:  # MaterialX has its own classes of errors
            raise failure(f"MaterialX cannot read the document: {error}", file=file_name) from None
        self._check_version(document, file_name)
        document.setSourceUri(os.path.abspath(path))
        chain = (*parents, os.path.realpath(path))
        for include in scan.includes:
            document.importLibrary(self._included_document(include, path, chain))
        return document

    def _included_document(self, include: Include, path: str, chain: tuple[str, ...]) -> Any:
        self._included += 1
        if self._included > MAX_INCLUDES:
            raise self._error_at(include.place, f"the document includes more than {MAX_INCLUDES} files")
        target = self._inside(os.path.dirname(os.path.abspath(path)), include.href, include.place)
        if os.path.realpath(target) in chain:
            raise self._error_at(include.place, f"'{include.href}' includes itself", "remove this include")
        if not os.path.isfile(target):
            raise self._error_at(include.place, f"no such file: '{include.href}'", "the path is relative to this file")
        return self._read(target, posix(os.path.relpath(target)), chain)

    def _inside(self, folder: str, name: str, place: Span, path: str = "") -> str:
        target = os.path.normpath(os.path.join(folder, name.replace("\\", "/")))
        if os.path.isabs(name) or not _is_in(os.path.realpath(target), self.root):
            hint = "name a folder that has all files of the material with --root"
            element = f" ({path})" if path else ""
            raise self._error_at(place, f"'{name}' leaves the folder {posix(self.root)}{element}", hint)
        return target

    def _check_version(self, document: Any, file_name: str) -> None:
        wanted = tuple(document.getVersionIntegers())
        newest = tuple(self.module.getVersionIntegers()[:2])
        if not (1, 22) <= wanted <= newest:
            message = f"the version '{document.getVersionString()}' of MaterialX cannot be read"
            raise failure(message, f"versions 1.22 to {newest[0]}.{newest[1]} are read", file_name)

    def _error_at(self, place: Span, message: str, hint: str = "") -> SssgenError:
        text = self._texts.get(place.file, "")
        reporter = Reporter(place.file, text)
        reporter.error(place, message, hint)
        return SssgenError(reporter.diagnostics)


@lru_cache(maxsize=1)
def _library() -> Any:
    """MaterialX's library of nodes, with its own default values. It takes .2 s to read."""
    module = need("MaterialX", "MaterialX", "import")
    library = module.createDocument()
    module.loadLibraries(module.getDefaultDataLibraryFolders(), module.getDefaultDataSearchPath(), library)
    return library


def _is_in(path: str, root: str) -> bool:
    return os.path.commonpath([path, root]) == root


class _Scan:
    """What MaterialX's reader does not give: the elements' places. It also refuses what that reader takes silently.

    Raises SssgenError for text that is no XML, entities, elements that nest too deeply, two elements of one name.
    """

    def __init__(self, text: str, file_name: str) -> None:
        self.places: dict[str, Span] = {}
        self.includes: list[Include] = []
        self._file_name, self._lines = file_name, text.split("\n")
        self._path: list[str] = []
        self._parser = parser = expat.ParserCreate()
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.StartDoctypeDeclHandler = self._doctype
        try:
            parser.Parse(_TOKEN.sub(r"[\1]", text), True)
        except expat.ExpatError as error:
            line, column = error.lineno, error.offset + 1
            message = f"this is not XML: {expat.ErrorString(error.code)}"
            raise self._error(message, Span(file_name, line, column, line, column + 1)) from None

    def _start(self, tag: str, attributes: Mapping[str, str]) -> None:
        place = self._place()
        if not self._path and tag != _ROOT:
            raise self._error(
                f"this is not a MaterialX document: its root is <{tag}>", place, "the root is <materialx>"
            )
        if len(self._path) >= MAX_DEPTH or len(self.places) >= MAX_ELEMENTS:
            raise self._error("the elements are nested too deeply, or are too many", place)
        self._path.append(attributes.get("name", "") if len(self._path) else "")
        if tag == _INCLUDE:
            self.includes.append(Include(attributes.get("href", ""), place))
        elif len(self._path) > 1 and self._path[-1]:
            path = "/".join(self._path[1:])
            if path in self.places:
                raise self._error(f"two elements have the name '{path}'", place, "give each its own name")
            self.places[path] = place

    def _end(self, tag: str) -> None:
        self._path.pop()

    def _doctype(self, *_: object) -> None:
        raise self._error("a document type or an entity is not read", self._place(), "remove <!DOCTYPE …>")

    def _place(self) -> Span:
        line, column = self._parser.CurrentLineNumber, self._parser.CurrentColumnNumber + 1
        text = self._lines[line - 1]
        end = text.find(">", column - 1)
        return Span(self._file_name, line, column, line, end + 2 if end >= 0 else len(text) + 1)

    def _error(self, message: str, place: Span, hint: str = "") -> SssgenError:
        line = self._lines[place.line - 1] if place.line <= len(self._lines) else ""
        return SssgenError([Diagnostic("error", message, place, hint, line)])
