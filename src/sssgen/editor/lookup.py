"""What the name at a place stands for: a technique, parameter, slot, function, constant, builtin, quantity, file."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

from sssgen.editor import toml_places
from sssgen.editor.analysis import Analysis, function_around
from sssgen.editor.documents import MATERIAL, SCENE, TECHNIQUE, Document, Word
from sssgen.editor.source_files import path_of
from sssgen.ir.nodes import Constant, Declare, Expr, Function, Local, Module, Param, StructDecl, Uniform, Variable
from sssgen.ir.spans import Span
from sssgen.ir.types import Type, spell
from sssgen.ir.walk import all_expressions, statements
from sssgen.lang.check.quantities import QUANTITIES
from sssgen.material import library, slots
from sssgen.material.library import Technique
from sssgen.material.material_loading import examples
from sssgen.material.material_reader import parameter_names
from sssgen.material.medium_look import look_keys
from sssgen.material.model import Material
from sssgen.scene.scene_parameters import uniforms_of
from sssgen.scene.scene_reader import material_beside
from sssgen.support.diagnostics import SssgenError
from sssgen.targets import builtin_facts


class LocalName(NamedTuple):
    """A local variable, or the use of a parameter."""

    name: str
    type: Type


Thing: TypeAlias = (
    Technique | Material | Function | Uniform | Constant | Variable | StructDecl | Param | LocalName | None
)


class Meaning(NamedTuple):
    """What a name stands for."""

    kind: str
    """technique, uniform, function, constant, struct, variable, value, builtin, quantity, material, or file."""
    thing: Thing
    """None for a builtin, a quantity and a file, which the word and the path name."""
    word: Word
    path: str = ""
    """The file that declares it; '' for what no file declares."""

    @property
    def span(self) -> Span | None:
        """The place of the declaration; None where the declaration has no place in a text."""
        thing = self.thing.function if isinstance(self.thing, Technique) else self.thing
        return None if thing is None or isinstance(thing, Material | LocalName) else thing.span


def meaning_at(document: Document, analysis: Analysis, line: int, column: int) -> Meaning | None:
    """What is at a place of a document."""
    if document.kind in (MATERIAL, SCENE):
        return _toml_meaning(document, analysis, line, column)
    include = document.include_at(line)
    if include is not None:
        path = path_of(include.text, document, analysis.files)
        return Meaning("file", None, include, path) if path else None
    word = document.word_at(line, column)
    if word is None or is_in_comment(document, line, word.start):
        return None
    return _code_meaning(document, analysis, word)


def is_in_comment(document: Document, line: int, column: int) -> bool:
    """Whether a place in shader text is in a comment."""
    before = document.line(line)[:column]
    earlier = "\n".join(document.lines[:line])
    return "//" in before or f"{earlier}\n{before}".rfind("/*") > f"{earlier}\n{before}".rfind("*/")


# Shader text


def _code_meaning(document: Document, analysis: Analysis, word: Word) -> Meaning | None:
    module = analysis.module
    if module is not None:
        for meaning in (_local_name(document, module, word), _declaration(document, analysis, module, word)):
            if meaning is not None:
                return meaning
    if word.text in builtin_facts.names():
        return Meaning("builtin", None, word)
    if document.kind == TECHNIQUE and word.text in QUANTITIES:
        return Meaning("quantity", None, word)
    return None


def _declaration(document: Document, analysis: Analysis, module: Module, word: Word) -> Meaning | None:
    functions = [function for function in module.functions if function.name == word.text]
    if functions:
        overload = _overload_at(document, module, word, functions)
        return Meaning("function", overload, word, path_of(overload.span.file, document, analysis.files))
    groups: tuple[tuple[str, Sequence[Uniform | Constant | Variable | StructDecl]], ...] = (
        ("uniform", module.uniforms[::-1]),
        ("constant", module.constants[::-1]),
        ("variable", module.variables[::-1]),
        ("struct", module.structs),
    )
    for kind, declarations in groups:
        for thing in declarations:
            if (spell(thing.type) if isinstance(thing, StructDecl) else thing.name) == word.text:
                return Meaning(kind, thing, word, path_of(thing.span.file, document, analysis.files))
    return None


def _overload_at(document: Document, module: Module, word: Word, named: list[Function]) -> Function:
    """The overload that is called, or declared, at a place; the last one where neither is found."""
    at = (word.line + 1, word.start + 1)
    for function in named:
        if (function.span.line, function.span.column) <= at < (function.span.end_line, function.span.end_column):
            return function
    for expr in _expressions_at(document, module, word):
        key = getattr(expr, "function", "")
        for function in named:
            if function.key == key:
                return function
    return named[-1]


def _expressions_at(document: Document, module: Module, word: Word) -> list[Expr]:
    """The expressions that begin with a word, the smallest first."""
    function = function_around(document, module, word.line)
    if function is None:
        return []
    at = (word.line + 1, word.start + 1)
    found = [
        expr
        for expr in all_expressions(function.body or ())
        if (expr.span.line, expr.span.column) == at and expr.span.file == function.span.file
    ]
    return sorted(found, key=lambda expr: (expr.span.end_line, expr.span.end_column))


def _local_name(document: Document, module: Module, word: Word) -> Meaning | None:
    """A parameter of a function, or a local variable, with its type."""
    enclosing = function_around(document, module, word.line)
    for param in enclosing.params if enclosing else ():
        if param.name == word.text:
            return Meaning("param", param, word, document.path)
    for expr in _expressions_at(document, module, word):
        if isinstance(expr, Local) and expr.name == word.text:
            return Meaning("value", LocalName(word.text, expr.type), word)
    end = (word.line + 1, word.end + 1)
    for statement in statements(enclosing.body or ()) if enclosing else ():
        if isinstance(statement, Declare) and (statement.span.end_line, statement.span.end_column) == end:
            return Meaning("value", LocalName(word.text, statement.type), word)
    return None


# Materials and scenes


def _toml_meaning(document: Document, analysis: Analysis, line: int, column: int) -> Meaning | None:
    place = toml_places.place_at(document, line, column)
    text, start, end = toml_places.text_at(document, line, column)
    key = place.inner_key or place.key
    if place.in_value and text:
        return _text_meaning(document, analysis, key, place, Word(text, line, start, end))
    word = document.word_at(line, column)
    if word is None or place.in_header:
        return None
    if place.in_value and place.key == "bind":
        return _slot_meaning(document, place.table.technique, word)
    uniform = uniforms_at(document, analysis, place).get(word.text)
    if uniform is None:
        return None
    return Meaning("uniform", uniform, word, path_of(uniform.span.file, document, analysis.files))


def _text_meaning(
    document: Document, analysis: Analysis, key: str, place: toml_places.TomlPlace, word: Word
) -> Meaning | None:
    if key == "technique" or place.section == "shell":
        technique = technique_named(word.text, document)
        return Meaning("technique", technique, word, technique.path) if technique else None
    if place.key == "bind":
        return _bound_function(document, place.table.technique, key, word)
    if key == "material" and not place.section:
        beside = material_beside(word.text, document.folder)
        path = beside or examples().get(word.text, os.path.join(document.folder, word.text))
        known = analysis.material if analysis.material and analysis.scene else None
        return Meaning("material", known, word, path) if os.path.isfile(path) else None
    path = os.path.join(document.folder, word.text)
    return Meaning("file", None, word, path) if os.path.isfile(path) else None


def technique_named(name: str, document: Document) -> Technique | None:
    """The technique that a material or scene names; None for an unknown or faulty one."""
    try:
        if name.endswith((".sss", ".glsl")):
            path = os.path.join(document.folder, name)
            return library.load_path(path if os.path.isfile(path) else os.path.join(library.TECHNIQUES, name))
        return library.load(name) if name in library.index() else None
    except SssgenError:
        return None


def slots_of(technique: Technique) -> dict[str, Function]:
    """The slots that a technique calls."""
    return {slot.name: slot for slot in slots.needs(technique.module, technique.function)[1]}


def _slot_meaning(document: Document, name: str, word: Word) -> Meaning | None:
    technique = technique_named(name, document)
    slot = slots_of(technique).get(word.text) if technique else None
    if technique is None or slot is None:
        return None
    return Meaning("function", slot, word, path_of(slot.span.file, document, (technique.path,)))


def _bound_function(document: Document, name: str, slot_name: str, word: Word) -> Meaning | None:
    """The function that a slot is bound to."""
    technique = technique_named(name, document)
    slot = slots_of(technique).get(slot_name) if technique else None
    try:
        if slot is not None:
            _, function = slots.find(word.text, slot, document.folder)
            return Meaning("function", function, word, path_of(function.span.file, document))
    except SssgenError:
        return None
    return None


def uniforms_at(document: Document, analysis: Analysis, place: toml_places.TomlPlace) -> dict[str, Uniform]:
    """The parameters and textures that the table around a place can set, by names and aliases."""
    if document.kind == SCENE:
        if place.section not in ("parameters", "textures") or not analysis.scene or not analysis.material:
            return {}
        return uniforms_of(analysis.scene, analysis.material)
    technique = technique_named(place.table.technique, document)
    if technique is None:
        return {}
    modules = [(technique.module, technique.function), *_bound_functions(document, place, technique)]
    found = {
        uniform.span: uniform
        for module, function in modules
        for uniform in module.uniforms
        if uniform.name in slots.needs(module, function)[0]
    }
    look = look_keys(found.values())
    return {name: uniform for uniform in (*found.values(), *look.values()) for name in parameter_names(uniform)}


def _bound_functions(
    document: Document, place: toml_places.TomlPlace, technique: Technique
) -> list[tuple[Module, Function]]:
    text = "\n".join(document.lines[place.table.first_line + 1 : place.table.last_line + 1])
    found = []
    for name, slot in slots_of(technique).items():
        for bound in toml_places.bound_texts(text, name):
            try:
                found.append(slots.find(bound, slot, document.folder))
            except SssgenError:
                continue
    return found
