"""The explanation of what is at a place, in Markdown."""

from __future__ import annotations

from typing import NamedTuple

from sssgen.editor import explanations, toml_places
from sssgen.editor.analysis import Analysis
from sssgen.editor.documents import MATERIAL, Document, Word
from sssgen.editor.lookup import LocalName, Meaning, meaning_at
from sssgen.ir.nodes import Constant, Function, Param, StructDecl, Uniform, Variable
from sssgen.ir.types import spell
from sssgen.lang.source_lines import source_line
from sssgen.material.library import Technique
from sssgen.material.model import Material
from sssgen.material.technique_facts import value_text
from sssgen.support.paths import posix


class Hover(NamedTuple):
    """An explanation, and the word that it is about."""

    markdown: str
    word: Word


def hover_at(document: Document, analysis: Analysis, line: int, column: int) -> Hover | None:
    """The explanation of what is at a place."""
    meaning = meaning_at(document, analysis, line, column)
    text = _text(document, analysis, meaning, line, column) if meaning else ""
    text = text.replace(f"{posix(document.folder)}/", "")
    return Hover(text, meaning.word) if meaning and text else None


def _text(document: Document, analysis: Analysis, meaning: Meaning, line: int, column: int) -> str:
    thing = meaning.thing
    if isinstance(thing, Technique):
        return explanations.explain_technique(thing)
    if isinstance(thing, Uniform):
        return explanations.explain_uniform(thing, _value(document, analysis, thing.name, line, column))
    if isinstance(thing, Function):
        technique = analysis.technique
        if technique is not None and technique.function.key == thing.key and thing.body is not None:
            return explanations.explain_technique(technique)
        return explanations.explain_function(thing)
    if isinstance(thing, Param):
        return explanations.code_block(f"{thing.quantity or spell(thing.type)} {thing.name}")
    if isinstance(thing, LocalName):
        return explanations.code_block(f"{spell(thing.type)} {thing.name}")
    if isinstance(thing, Variable):
        return "\n\n".join(filter(None, (explanations.code_block(f"{spell(thing.type)} {thing.name}"), thing.doc)))
    if isinstance(thing, Constant | StructDecl):
        return explanations.code_block(source_line(thing.span).strip() or meaning.word.text)
    if isinstance(thing, Material):
        return f"**{thing.title}**: {thing.doc}"
    if meaning.kind == "builtin":
        return explanations.explain_builtin(meaning.word.text)
    if meaning.kind == "quantity":
        return explanations.explain_quantity(meaning.word.text)
    return meaning.path


def _value(document: Document, analysis: Analysis, name: str, line: int, column: int) -> str:
    """The value that a material's stage gives to a parameter."""
    if document.kind != MATERIAL or analysis.material is None:
        return ""
    first = toml_places.place_at(document, line, column).table.first_line
    for stage in analysis.material.stages:
        if stage.span.line - 1 >= first and name in stage.values:
            return value_text(stage.values[name])
    return ""
