"""`sssgen show TECHNIQUE`: what it computes, its parameters, its source."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sssgen.cli.layout import wrap
from sssgen.material import library
from sssgen.material.technique_facts import facts_of, uniform_text

names = library.index
"""The techniques of the library."""


def describe(name: str) -> dict[str, Any]:
    """Everything about a technique of the library, or of a .sss file. Raises SssgenError."""
    return facts_of(library.load(name))


def lines(facts: Mapping[str, Any], width: int) -> list[str]:
    """The facts as text."""

    def indent(text: str, blanks: str) -> list[str]:
        return wrap(text, width, blanks, blanks)

    text = [
        f"{facts['name']} ({facts['role']})",
        *indent(facts["summary"], "  "),
        "",
        f"  {facts['signature']}",
    ]
    for kind, title in (("parameters", "parameters"), ("look", "look, in place of them"), ("textures", "textures")):
        if facts[kind]:
            text += ["", f"{title}:"]
            for uniform in facts[kind]:
                text.append(f"  {uniform['name']}: {uniform_text(uniform)}")
                text += indent(uniform["doc"], "      ")
    if facts["slots"]:
        text += ["", "slots, to be bound by the material:"]
        for slot in facts["slots"]:
            text += [f"  {slot['signature']}", *indent(slot["doc"], "      ")]
            text += indent(f"functions that fit: {', '.join(slot['functions']) or 'none in the library'}", "      ")
    text.append("")
    for key, entry in facts["doc"].items():
        text += [f"{key}:", *indent(entry, "  ")]
    return [*text, "", f"file: {facts['file']}"]
