"""`sssgen show`: the documentation of one technique."""

from __future__ import annotations

import textwrap
from argparse import ArgumentParser, Namespace
from typing import Any

from sssgen.cli.output import OK, print_json
from sssgen.ir.nodes import Uniform
from sssgen.ir.types import Sampler, kind_of, spell
from sssgen.material import library, slots
from sssgen.material.library import Technique

WIDTH = 100
_OTHERWISE_SHOWN = ("hint_range", "unit", "alias", "holds", "sample_range", "bound_range")
"""Hints that are shown elsewhere, and those of tests."""


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = "examples:\n  sssgen show beer_lambert\n  sssgen show mine.sss --json"
    parser.add_argument("TECHNIQUE", help="a name from `sssgen list techniques`, or a .sss file")


def run(arguments: Namespace) -> int:
    """Prints the documentation of a technique."""
    facts = describe(library.load(arguments.TECHNIQUE))
    if arguments.json:
        print_json({"ok": True, **facts})
    else:
        print(_text(facts))
    return OK


def describe(technique: Technique) -> dict[str, Any]:
    """Everything about a technique, for JSON."""
    doc = dict(technique.doc)
    names, called = slots.needs(technique.module, technique.function)
    read = [uniform for uniform in technique.uniforms if uniform.name in names]
    return {
        "name": technique.name,
        "role": technique.role,
        "summary": doc.pop("summary", ""),
        "signature": slots.signature(technique.function),
        "parameters": [_uniform(uniform) for uniform in read if not isinstance(uniform.type, Sampler)],
        "textures": [_uniform(uniform) for uniform in read if isinstance(uniform.type, Sampler)],
        "slots": [
            {
                "name": slot.name,
                "signature": slots.signature(slot),
                "doc": slot.doc,
                "functions": slots.candidates(slot),
            }
            for slot in called
        ],
        "doc": {key: text for key, text in doc.items() if key != "role"},
        "baseline": technique.baseline,
        "file": library.shown_name(technique.path),
    }


def _uniform(uniform: Uniform) -> dict[str, Any]:
    hints = dict(uniform.hints)
    facts: dict[str, Any] = {"name": uniform.name, "type": spell(uniform.type)}
    if not isinstance(uniform.type, Sampler):
        facts["default"] = _default(uniform)
    if "hint_range" in hints:
        facts["range"] = list(hints["hint_range"])
    if "unit" in hints:
        facts["unit"] = hints["unit"][0]
    remaining_hints = [name for name in hints if name not in _OTHERWISE_SHOWN]
    if remaining_hints:
        facts["hints"] = remaining_hints
    if uniform.quantity:
        facts["holds"] = uniform.quantity
    return {**facts, "aliases": list(hints.get("alias", ())), "doc": uniform.doc}


def _default(uniform: Uniform) -> list[float] | list[int] | list[bool]:
    kind = kind_of(uniform.type)
    if kind == "bool":
        return [bool(value) for value in uniform.default]
    return [int(value) for value in uniform.default] if kind in ("int", "uint") else list(uniform.default)


def _text(facts: dict[str, Any]) -> str:
    def wrapped(text: str, indent: str) -> list[str]:
        return textwrap.wrap(text, WIDTH, initial_indent=indent, subsequent_indent=indent, break_on_hyphens=False)

    lines = [
        f"{facts['name']} ({facts['role']})",
        *wrapped(facts["summary"], "  "),
        "",
        f"  {facts['signature']}",
    ]
    for kind in ("parameters", "textures"):
        if facts[kind]:
            lines += ["", f"{kind}:"]
            for uniform in facts[kind]:
                lines.append(f"  {uniform['name']}: {_facts_of(uniform)}")
                lines += wrapped(uniform["doc"], "      ")
    if facts["slots"]:
        lines += ["", "slots, to be bound by the material:"]
        for slot in facts["slots"]:
            lines += [f"  {slot['signature']}", *wrapped(slot["doc"], "      ")]
            lines += wrapped(f"functions that fit: {', '.join(slot['functions']) or 'none in the library'}", "      ")
    lines.append("")
    for key, text in facts["doc"].items():
        lines += [f"{key}:", *wrapped(text, "  ")]
    return "\n".join([*lines, "", f"file: {facts['file']}"])


def _facts_of(uniform: dict[str, Any]) -> str:
    parts = [uniform["type"]]
    if "default" in uniform:
        values = [f"{value:g}" for value in uniform["default"]]
        parts.append(f"default {values[0] if len(values) == 1 else '(' + ', '.join(values) + ')'}")
    if "range" in uniform:
        low, high, *step = uniform["range"]
        parts.append(f"{low:g} to {high:g}" + (f" by {step[0]:g}" if step else ""))
    if uniform.get("unit", "1") != "1":
        parts.append(uniform["unit"])
    parts += uniform.get("hints", [])
    if "holds" in uniform:
        parts.append(f"holds {uniform['holds']}")
    if uniform["aliases"]:
        parts.append(f"also called {', '.join(uniform['aliases'])}")
    return ", ".join(parts)
