"""What can be written at a place."""

from __future__ import annotations

from sssgen.editor.analysis import Analysis
from sssgen.editor.code_completion import code_items
from sssgen.editor.completion_item import Item
from sssgen.editor.documents import GLSL, MATERIAL, SCENE, TECHNIQUE, Document
from sssgen.editor.toml_completion import material_items, scene_items

TRIGGERS = ('"', "[", "/")
"""The characters after which an editor asks for completions of its own accord."""


def completions_at(document: Document, analysis: Analysis, line: int, column: int) -> list[Item]:
    """What can be written at a place, the best first."""
    if document.kind == MATERIAL:
        return material_items(document, analysis, line, column)
    if document.kind == SCENE:
        return scene_items(document, analysis, line, column)
    return code_items(document, analysis, line, column) if document.kind in (TECHNIQUE, GLSL) else []
