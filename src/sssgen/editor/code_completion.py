"""Completions in techniques and plain GLSL: builtins, what the file declares and includes, quantities, hints, roles."""

from __future__ import annotations

import os
import re

from sssgen.editor import explanations
from sssgen.editor.analysis import Analysis, function_around
from sssgen.editor.completion_item import Item, items_of
from sssgen.editor.documents import TECHNIQUE, Document
from sssgen.editor.lookup import is_in_comment
from sssgen.ir.frame_passes import FRAME_PASSES
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.nodes import Declare
from sssgen.ir.out_builtins import OUT_BUILTINS
from sssgen.ir.projective_reads import PROJECTIVE_READS
from sssgen.ir.types import spell
from sssgen.ir.walk import statements
from sssgen.lang.check.quantities import QUANTITIES, SCALARS
from sssgen.lang.check.uniform_hints import HINTS
from sssgen.lang.syntax.lexer import KEYWORDS
from sssgen.material import library
from sssgen.material.attributes import ATTRIBUTES, REQUIREMENTS, SHAPES
from sssgen.material.library import ROLES
from sssgen.material.slots import signature
from sssgen.material.technique_facts import uniform_facts, uniform_text
from sssgen.support.paths import posix

_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+"[^"]*$')
_ATTRIBUTE = re.compile(r"^[\s/*]*(?P<word>[a-z_]*)$")
_ATTRIBUTE_VALUE = re.compile(r"^[\s/*]*(?P<key>[a-z_]+)[ \t]*:")
_HINT = re.compile(r"^[ \t]*uniform\b[^;=]*:[^;=]*$")
_HINT_ARGUMENT = re.compile(r"^[ \t]*uniform\b[^;=]*:[^;=]*\b(?P<hint>drawn|holds)\(\w*$")
_MEMBER = re.compile(r"\.\w*$")
_OF_ATTRIBUTES = {"role": ROLES, "shape": SHAPES, "requires": REQUIREMENTS}


def code_items(document: Document, analysis: Analysis, line: int, column: int) -> list[Item]:
    """Completions in shader text."""
    before = document.line(line)[:column]
    technique = document.kind == TECHNIQUE
    if _INCLUDE.match(before):
        return items_of(_include_names(document), "file") if technique else []
    if is_in_comment(document, line, column):
        return _comment_items(before) if technique else []
    if _MEMBER.search(before):
        return []
    argument = _HINT_ARGUMENT.match(before) if technique else None
    if argument is not None:
        return items_of(FRAME_PASSES if argument["hint"] == "drawn" else SCALARS, "value")
    if technique and _HINT.match(before):
        return items_of(HINTS, "keyword")
    items = [*_local_items(document, analysis, line), *_declared_items(analysis)]
    if technique:
        items += [Item(name, "type", explanations.explain_quantity(name).partition(": ")[2]) for name in QUANTITIES]
    items += [
        Item(row.name, "function", row.signatures[0].replace("(", f" {row.name}(", 1), row.doc, rank=1)
        for row in BUILTINS.values()
    ]
    items += items_of((*OUT_BUILTINS, *PROJECTIVE_READS), "function", rank=1)
    if technique:
        items.append(Item("assume", "keyword", "states a fact: assume(x > 0.0);", text="assume()", rank=2))
    return items + items_of(KEYWORDS, "keyword", rank=2)


def _comment_items(before: str) -> list[Item]:
    value = _ATTRIBUTE_VALUE.match(before)
    if value is not None:
        return items_of(_OF_ATTRIBUTES.get(value["key"], ()), "value")
    return [Item(name, "keyword", text=f"{name}: ") for name in ATTRIBUTES] if _ATTRIBUTE.match(before) else []


def _include_names(document: Document) -> list[str]:
    """The files that `#include` finds: beside the document, and in the library."""
    names = []
    for root, folders in ((document.folder, ("",)), (library.TECHNIQUES, sorted(os.listdir(library.TECHNIQUES)))):
        for folder in folders:
            path = os.path.join(root, folder)
            found = sorted(os.listdir(path)) if os.path.isdir(path) else []
            names += [posix(os.path.join(folder, name)) for name in found if name.endswith(".sss")]
    return [name for name in dict.fromkeys(names) if name != os.path.basename(document.path)]


def _declared_items(analysis: Analysis) -> list[Item]:
    module = analysis.module
    if module is None:
        return []
    items = [Item(function.name, "function", signature(function), function.doc) for function in module.functions]
    items += [
        Item(uniform.name, "parameter", uniform_text(uniform_facts(uniform)), uniform.doc)
        for uniform in module.uniforms
    ]
    items += [Item(constant.name, "constant", spell(constant.type)) for constant in module.constants]
    items += [Item(variable.name, "parameter", spell(variable.type), variable.doc) for variable in module.variables]
    items += [Item(spell(struct.type), "type", "struct", struct.doc) for struct in module.structs]
    return list({item.label: item for item in items}.values())


def _local_items(document: Document, analysis: Analysis, line: int) -> list[Item]:
    """The parameters and variables of the function around a line, as it was when the text was last right."""
    around = function_around(document, analysis.module, line) if analysis.module is not None else None
    if around is None:
        return []
    items = [Item(param.name, "parameter", param.quantity or spell(param.type)) for param in around.params]
    items += [
        Item(statement.name, "parameter", spell(statement.type))
        for statement in statements(around.body or ())
        if isinstance(statement, Declare) and statement.span.line <= line + 1
    ]
    return list({item.label: item for item in items}.values())
