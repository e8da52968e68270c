"""Writes the TextMate grammar of the VS Code extension, of the tables that the front end uses itself:
python tools/vscode_grammar.py
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.out_builtins import OUT_BUILTINS
from sssgen.lang.check.quantities import QUANTITIES
from sssgen.lang.check.uniform_hints import HINTS
from sssgen.lang.syntax.lexer import KEYWORDS, TYPES
from sssgen.material.attributes import ATTRIBUTES

PATH = Path(__file__).parent.parent / "editors" / "vscode" / "syntaxes" / "sss.tmLanguage.json"

CONTROL = ["if", "else", "for", "while", "do", "switch", "case", "default", "return", "break", "continue", "discard"]
"""The keywords that are statements; the others declare something."""

ASSUME = "assume"
"""The statement that states a fact to the range analysis."""

Rule = dict[str, Any]


def grammar() -> Rule:
    """The grammar: comments, doc comments with their attributes, includes, uniforms with their hints, code."""
    constants = [word for word, terminal in KEYWORDS.items() if terminal == "BOOL"]
    storage = [word for word in KEYWORDS if word not in {*TYPES, *CONTROL, *constants}]
    expression = [{"include": f"#{name}"} for name in ("comments", "numbers", "words", "signs")]
    return {
        "$schema": "https://raw.githubusercontent.com/martinring/tmlanguage/master/tmlanguage.json",
        "name": "sssgen technique",
        "scopeName": "source.sss",
        "fileTypes": ["sss"],
        "patterns": [{"include": "#include"}, {"include": "#uniform"}, *expression],
        "repository": {
            "comments": {
                "patterns": [
                    {
                        "name": "comment.block.documentation.sss",
                        "begin": r"/\*\*(?!/)",
                        "end": r"\*/",
                        "patterns": [
                            {
                                "match": rf"^[\s*]*({_any(ATTRIBUTES)})(:)",
                                "captures": {
                                    "1": {"name": "keyword.other.attribute.sss"},
                                    "2": {"name": "punctuation.separator.attribute.sss"},
                                },
                            }
                        ],
                    },
                    {"name": "comment.block.sss", "begin": r"/\*", "end": r"\*/"},
                    {"name": "comment.line.double-slash.sss", "match": "//.*$"},
                ]
            },
            "include": {
                "match": r'^\s*(#\s*include)\s*("[^"\n]*"?)',
                "captures": {
                    "1": {"name": "keyword.control.directive.include.sss"},
                    "2": {"name": "string.quoted.double.include.sss"},
                },
            },
            "uniform": {
                "begin": r"\b(uniform)\b",
                "beginCaptures": {"1": {"name": "storage.modifier.sss"}},
                "end": "(?=;)",
                "patterns": [
                    {"name": "keyword.other.hint.sss", "match": rf"(?<=[:,])\s*\b({_any(HINTS)})\b"},
                    {"name": "string.quoted.double.sss", "match": r'"[^"\n]*"'},
                    *expression,
                ],
            },
            "numbers": {
                "name": "constant.numeric.sss",
                "match": r"\b0[xX][0-9a-fA-F]+[uU]?\b|(?:\b\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?:[uUfF]|lf|LF)?(?!\w)",
            },
            "words": {
                "patterns": [
                    {"name": "keyword.control.sss", "match": _word([*CONTROL, ASSUME])},
                    {"name": "constant.language.sss", "match": _word(constants)},
                    {"name": "storage.modifier.sss", "match": _word(storage)},
                    {"name": "storage.type.sss", "match": _word(TYPES)},
                    {"name": "support.function.builtin.sss", "match": rf"{_word([*BUILTINS, *OUT_BUILTINS])}(?=\s*\()"},
                    {"name": "support.type.quantity.sss", "match": rf"{_word(QUANTITIES)}(?=\s+\w)"},
                    {"name": "entity.name.function.sss", "match": r"\b[A-Za-z_]\w*(?=\s*\()"},
                    {"name": "variable.other.member.sss", "match": r"(?<=\.)[A-Za-z_]\w*"},
                    {"name": "variable.other.sss", "match": r"\b[A-Za-z_]\w*"},
                ]
            },
            "signs": {
                "patterns": [
                    {"name": "keyword.operator.sss", "match": r"[-+*/%&|^<>=!~?:]+"},
                    {"name": "punctuation.sss", "match": r"[{}()\[\];,.]"},
                ]
            },
        },
    }


def _any(words: Iterable[str]) -> str:
    """Longer ones first, so that no word hides one that begins with it."""
    return "|".join(sorted(words, key=lambda word: (-len(word), word)))


def _word(words: Iterable[str]) -> str:
    return rf"\b(?:{_any(words)})\b"


def text() -> str:
    return json.dumps(grammar(), indent=2) + "\n"


if __name__ == "__main__":
    PATH.parent.mkdir(parents=True, exist_ok=True)
    PATH.write_text(text(), encoding="utf-8", newline="\n")
