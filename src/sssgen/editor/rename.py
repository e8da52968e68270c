"""Renames parameters, functions, constants and local variables, with the keys of materials and scenes that name them.

What is renamed stands in the open files and in those of the folder of its declaration. The changed files are read
before the change is answered: one that would cause an error is refused.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import NamedTuple

from sssgen.editor.analysis import Analysis, analyse, function_around, own_names
from sssgen.editor.documents import GLSL, MATERIAL, SCENE, TECHNIQUE, Document, Word
from sssgen.editor.lookup import Meaning, meaning_at
from sssgen.editor.problems import Range
from sssgen.editor.source_files import path_of
from sssgen.ir.nodes import Constant, Declare, Function, Module, Span, Uniform, Variable
from sssgen.ir.walk import statements
from sssgen.lang.syntax.lexer import scan
from sssgen.lang.syntax.tokens import Token
from sssgen.material import library
from sssgen.material.library import Technique
from sssgen.support import unsaved
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.support.paths import stem
from sssgen.support.text_files import read_text

LOCAL, GLOBAL = ("param", "value"), ("uniform", "function", "constant", "variable")
"""The kinds of meanings that can be renamed: those of one function, and those of a file."""

MAX_FILES = 500
"""Files of a folder that are searched."""

_NAME = re.compile(r"[A-Za-z]\w*", re.ASCII)
_NAMING = re.compile(r"^[\s/*]*(?:sets|formula)[ \t]*:")
"""The lines of a doc comment that name parameters."""

Open = Callable[[str], tuple[Document, Analysis] | None]
"""The document that an editor has open for a path, and what was read of it."""


class Edit(NamedTuple):
    """A new text for a part of a document."""

    range: Range
    text: str


class _Declaration(NamedTuple):
    """What is renamed: a declaration of a file, with all its overloads."""

    kind: str
    name: str
    path: str
    places: frozenset[tuple[int, int]]
    """The line and column of each; a file has several names in messages."""


def name_to_rename(document: Document, analysis: Analysis, line: int, column: int) -> Word:
    """The name at a place that can be renamed. Raises SssgenError for what cannot."""
    return _target_at(document, analysis, line, column)[1]


def rename(
    place: tuple[Document, Analysis, int, int], name: str, refresh: Open, paths: Sequence[str]
) -> dict[str, list[Edit]]:
    """The edits of each file; `paths` are those of the open files. Raises SssgenError where the name cannot be used."""
    document, analysis, line, column = place
    meaning, word = _target_at(document, analysis, line, column)
    if not _NAME.fullmatch(name) or "__" in name:
        raise failure(f"'{name}' is not a name", "a letter, then letters, digits and single underscores")
    if name == word.text:
        return {}
    if meaning.kind in LOCAL:
        edits = {document.path: _local_edits(document, analysis, word, name)}
        documents = {document.path: document}
    else:
        edits, documents = _global_edits(_declaration_of(document, analysis, meaning, word), name, refresh, paths)
    _check(edits, documents, name)
    return edits


def _target_at(document: Document, analysis: Analysis, line: int, column: int) -> tuple[Meaning, Word]:
    """What is at a place, and its name there."""
    meaning = meaning_at(document, analysis, line, column)
    if meaning is None or meaning.kind not in LOCAL + GLOBAL or document.kind == GLSL:
        raise failure("nothing here can be renamed", "parameters, functions, constants and variables can")
    word = _name_in(meaning.word)
    if meaning.kind in LOCAL:
        if analysis.technique and word.text in [param.name for param in analysis.technique.function.params]:
            _check_not_of_technique(document, analysis.technique, word)
        return meaning, word
    if not meaning.path:
        raise failure(f"the file that declares '{word.text}' was not found")
    if not meaning.path.endswith(".sss"):
        raise failure(f"'{word.text}' is declared in plain GLSL", "rename it there")
    if meaning.path.startswith(library.TECHNIQUES + os.sep):
        raise failure(f"'{word.text}' is declared in the library", "copy the technique to change it")
    thing = meaning.thing
    if isinstance(thing, Function) and thing.name == stem(meaning.path) and thing.body is not None:
        raise failure(f"'{word.text}' is the technique of its file", "rename the file and the function together")
    if isinstance(thing, Uniform | Function) and document.kind in (MATERIAL, SCENE) and word.text != thing.name:
        raise failure(f"'{word.text}' is another name of '{thing.name}'", "rename it in the technique")
    return meaning, word


def _check_not_of_technique(document: Document, technique: Technique, word: Word) -> None:
    around = function_around(document, technique.module, word.line)
    if around is not None and around.key == technique.function.key:
        hint = f"'{technique.name}' reads it from the chain, or gives it to the chain, under this name"
        raise failure(f"'{word.text}' is a quantity of the chain", hint)


def _name_in(word: Word) -> Word:
    """The name itself where the word is FILE:FUNCTION."""
    start = word.start + word.text.rfind(":") + 1
    return Word(word.text.rpartition(":")[2], word.line, start, word.end)


def _declaration_of(document: Document, analysis: Analysis, meaning: Meaning, word: Word) -> _Declaration:
    span = meaning.span
    assert span is not None  # of a name that can be renamed
    functions = analysis.module.functions if analysis.module is not None and meaning.kind == "function" else ()
    same = [function.span for function in functions if (function.name, function.span.file) == (word.text, span.file)]
    places = frozenset((own.line, own.column) for own in (span, *same))
    return _Declaration(meaning.kind, word.text, meaning.path, places)


# In one function


def _local_edits(document: Document, analysis: Analysis, word: Word, name: str) -> list[Edit]:
    """A parameter or variable of a function: every use of the name in the function."""
    tokens = _tokens(document)
    assert analysis.module is not None
    around = function_around(document, analysis.module, word.line)
    if around is None or _declarations(around, word.text) != 1 or _spans(analysis.module, word.text):
        raise failure(f"'{word.text}' is declared more than once here", "rename one of them by hand")
    first, last = around.span.line, _last_line(document, analysis.module, around)
    uses = [token for token in _uses(tokens, word.text) if first <= token.span.line <= last]
    inside = [token.text for token in tokens if first <= token.span.line <= last]
    if name in inside:
        raise failure(f"'{around.name}' already has the name '{name}'")
    return [_edit(token, name) for token in uses]


def _last_line(document: Document, module: Module, function: Function) -> int:
    own = own_names(document)
    later = [f.span.line for f in module.functions if f.span.file in own and f.span.line > function.span.line]
    return min(later, default=len(document.lines) + 1) - 1


def _declarations(function: Function, name: str) -> int:
    """How many parameters and variables of a function have a name."""
    names = [param.name for param in function.params]
    names += [stmt.name for stmt in statements(function.body or ()) if isinstance(stmt, Declare)]
    return names.count(name)


# In files


def _global_edits(
    declaration: _Declaration, name: str, refresh: Open, paths: Sequence[str]
) -> tuple[dict[str, list[Edit]], dict[str, Document]]:
    edits: dict[str, list[Edit]] = {}
    documents: dict[str, Document] = {}
    for path in _files(declaration, paths):
        entry = refresh(path) or _read_document(path)
        if entry is None or not re.search(rf"\b{declaration.name}\b", entry[0].text):
            continue
        of_kind = {TECHNIQUE: _technique_edits, MATERIAL: _toml_edits, SCENE: _toml_edits}.get(entry[0].kind)
        own = of_kind(*entry, declaration, name) if of_kind else []
        if own:
            edits[path], documents[path] = own, entry[0]
    return edits, documents


def _files(declaration: _Declaration, paths: Sequence[str]) -> list[str]:
    """The open files and those of the declaration's folder."""
    folder = os.path.dirname(declaration.path)
    beside = [os.path.join(folder, file) for file in sorted(os.listdir(folder)) if file.endswith((".sss", ".toml"))]
    if len(beside) > MAX_FILES:
        raise failure(f"{folder} has more than {MAX_FILES} files", "rename by hand")
    return list(dict.fromkeys([*paths, *beside]))


def _read_document(path: str) -> tuple[Document, Analysis] | None:
    try:
        document = Document(path, read_text(path, path).replace("\r\n", "\n"))
    except (SssgenError, OSError):
        return None
    return document, analyse(document)


def _technique_edits(document: Document, analysis: Analysis, declaration: _Declaration, name: str) -> list[Edit]:
    """The uses in a file that declares or includes it."""
    if declaration.path != document.path and declaration.path not in analysis.files:
        return []
    module = analysis.module
    if module is None or any(problem.severity == "error" for problem in analysis.diagnostics):
        raise failure(f"{os.path.basename(document.path)} has errors", "correct them first")
    tokens = _tokens(document)
    if not _declares(document, analysis, module, declaration):
        return []
    for function in module.functions:
        if function.span.file in own_names(document) and _declarations(function, declaration.name):
            raise failure(f"'{function.name}' has a variable '{declaration.name}' of its own", "rename that one first")
    uses = _uses(tokens, declaration.name)
    if uses and any(token.text == name for token in tokens):
        raise failure(f"{os.path.basename(document.path)} already has the name '{name}'")
    return [*(_edit(token, name) for token in uses), *_comment_edits(document, declaration.name, name)]


def _declares(document: Document, analysis: Analysis, module: Module, declaration: _Declaration) -> bool:
    """Whether the name is that of the declaration in a file that may have others of the name."""
    files = [span.file for span in _spans(module, declaration.name)]
    return bool(files) and all(path_of(file, document, analysis.files) == declaration.path for file in files)


def _spans(module: Module, name: str) -> list[Span]:
    """The declarations of a name outside functions."""
    groups: tuple[tuple[Uniform | Function | Constant | Variable, ...], ...] = (
        module.uniforms, module.functions, module.constants, module.variables,
    )  # fmt: skip
    return [thing.span for group in groups for thing in group if thing.name == name]


def _tokens(document: Document) -> list[Token]:
    """The tokens of a technique, without its `#include` lines."""
    return scan(re.sub(r"^[ \t]*#.*", "", document.text, flags=re.MULTILINE), document.display_name)[0]


def _uses(tokens: Sequence[Token], name: str) -> list[Token]:
    """The tokens with a name, without members of structs."""
    return [
        token
        for number, token in enumerate(tokens)
        if token.text == name and (number == 0 or tokens[number - 1].text != ".")
    ]


def _edit(token: Token, name: str) -> Edit:
    line, column = token.span.line - 1, token.span.column - 1
    return Edit(Range(line, column, line, column + len(token.text)), name)


def _comment_edits(document: Document, old: str, name: str) -> Iterator[Edit]:
    """The attributes that name parameters; all other words of comments are left as they are."""
    for number, line in enumerate(document.lines):
        if _NAMING.match(line):
            for match in re.finditer(rf"\b{old}\b", line[line.index(":") :]):
                start = line.index(":") + match.start()
                yield Edit(Range(number, start, number, start + len(old)), name)


def _toml_edits(document: Document, analysis: Analysis, declaration: _Declaration, name: str) -> list[Edit]:
    """The keys and texts that name it."""
    edits = []
    for number, line in enumerate(document.lines):
        for match in re.finditer(rf"\b{declaration.name}\b", line):
            if _ends_in_comment(line[: match.start()]):
                break
            meaning = meaning_at(document, analysis, number, match.start())
            if meaning is None or (meaning.kind, meaning.path) != (declaration.kind, declaration.path):
                continue
            word, span = _name_in(meaning.word), meaning.span
            if (
                span
                and (span.line, span.column) in declaration.places
                and (word.start, word.text)
                == (
                    match.start(),
                    declaration.name,
                )
            ):
                edits.append(Edit(Range(number, word.start, number, word.end), name))
    return edits


def _ends_in_comment(before: str) -> bool:
    return "#" in re.sub(r'"[^"]*"|\'[^\']*\'', "", before)


# The result


def _check(edits: Mapping[str, list[Edit]], documents: Mapping[str, Document], name: str) -> None:
    """Raises SssgenError where a changed file has errors that it did not have."""
    before = {path: _errors(documents[path]) for path in edits}
    with _overlay({path: _apply_edits(documents[path].text, edits[path]) for path in edits}) as changed:
        for path, document in changed.items():
            new = [message for message in _errors(document) if message not in before[path]]
            if new and len(_errors(document)) > len(before[path]):
                raise failure(f"'{name}' does not fit: {os.path.basename(path)}: {new[0]}")


def _errors(document: Document) -> list[str]:
    return [problem.message for problem in analyse(document).diagnostics if problem.severity == "error"]


@contextmanager
def _overlay(texts: Mapping[str, str]) -> Iterator[dict[str, Document]]:
    """Reads the texts in place of the files in the block."""
    before = {path: unsaved.text_of(path) for path in texts}
    try:
        for path, text in texts.items():
            unsaved.keep(path, text)
        yield {path: Document(path, text) for path, text in texts.items()}
    finally:
        for path, earlier in before.items():
            if earlier is None:
                unsaved.drop(path)
            else:
                unsaved.keep(path, earlier)


def _apply_edits(text: str, edits: Sequence[Edit]) -> str:
    lines = text.split("\n")
    for part, new in sorted(edits, reverse=True):
        line = lines[part.line]
        lines[part.line] = line[: part.column] + new + line[part.end_column :]
    return "\n".join(lines)
