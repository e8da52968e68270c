"""The explanation of what is at a place, in Markdown."""

from __future__ import annotations

from typing import NamedTuple

from sssgen.editor import explanations, toml_places
from sssgen.editor.analysis import Analysis
from sssgen.editor.documents import MATERIAL, Document, Word
from sssgen.editor.lookup import Meaning, meaning_at
from sssgen.ir.types import spell
from sssgen.lang.source_lines import source_line
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
    if meaning.kind == "technique":
        return explanations.explain_technique(thing)
    if meaning.kind == "uniform":
        return explanations.explain_uniform(thing, _value(document, analysis, thing.name, line, column))
    if meaning.kind == "function":
        technique = analysis.technique
        if technique is not None and technique.function.key == thing.key and thing.body is not None:
            return explanations.explain_technique(technique)
        return explanations.explain_function(thing)
    if meaning.kind == "param":
        return explanations.code_block(f"{thing.quantity or spell(thing.type)} {thing.name}")
    if meaning.kind == "value":
        return explanations.code_block(f"{spell(thing[1])} {thing[0]}")
    if meaning.kind == "variable":
        return "\n\n".join(filter(None, (explanations.code_block(f"{spell(thing.type)} {thing.name}"), thing.doc)))
    if meaning.kind in ("constant", "struct"):
        return explanations.code_block(source_line(thing.span).strip() or meaning.word.text)
    if meaning.kind == "builtin":
        return explanations.explain_builtin(thing)
    if meaning.kind == "quantity":
        return explanations.explain_quantity(thing)
    if meaning.kind == "material" and thing is not None:
        return f"**{thing.title}**: {thing.doc}"
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
