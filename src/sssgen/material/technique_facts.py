"""What there is to say about a technique and its parameters, for `sssgen show`, the documents and editors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from sssgen.ir.nodes import Uniform
from sssgen.ir.types import Sampler, kind_of, spell
from sssgen.material import slots
from sssgen.material.library import Technique
from sssgen.material.medium_look import look_keys
from sssgen.support.paths import display_name, source_name

_OTHERWISE_SHOWN = ("hint_range", "unit", "alias", "holds", "sample_range", "bound_range")
"""Hints that are shown elsewhere, and those of tests."""


def facts_of(technique: Technique) -> dict[str, Any]:
    """Everything about a loaded technique."""
    doc = dict(technique.doc)
    names, called = slots.needs(technique.module, technique.function)
    read = [uniform for uniform in technique.uniforms if uniform.name in names]
    return {
        "name": technique.name,
        "role": technique.role,
        "summary": doc.pop("summary", ""),
        "signature": slots.signature(technique.function),
        "parameters": [uniform_facts(uniform) for uniform in read if not isinstance(uniform.type, Sampler)],
        "look": [_look_facts(key) for key in look_keys(read).values()],
        "textures": [uniform_facts(uniform) for uniform in read if isinstance(uniform.type, Sampler)],
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
        "file": display_name(source_name(technique.path)),
    }


def uniform_facts(uniform: Uniform) -> dict[str, Any]:
    """Everything about a parameter or a texture."""
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


def _look_facts(key: Uniform) -> dict[str, Any]:
    """Everything about a key of the medium's look; its default is that of the parameter in its place."""
    facts = uniform_facts(key)
    del facts["default"]
    return facts


def _default(uniform: Uniform) -> list[float] | list[int] | list[bool]:
    kind = kind_of(uniform.type)
    if kind == "bool":
        return [bool(value) for value in uniform.default]
    return [int(value) for value in uniform.default] if kind in ("int", "uint") else list(uniform.default)


def value_text(value: Sequence[float]) -> str:
    """`0.5`, or `(1, 0.5, 0)`."""
    numbers = [f"{number:g}" for number in value]
    return numbers[0] if len(numbers) == 1 else f"({', '.join(numbers)})"


def uniform_text(uniform: Mapping[str, Any]) -> str:
    """The type, the default if there is one, the range and the hints of a parameter, on one line."""
    parts = [uniform["type"]]
    if "default" in uniform:
        parts.append(f"default {value_text(uniform['default'])}")
    if "range" in uniform:
        low, high, *step = uniform["range"]
        parts.append(f"{low:g} to {high:g}" + (f" by {step[0]:g}" if step else ""))
    if uniform.get("unit", "1") != "1":
        parts.append(uniform["unit"])
    parts += uniform.get("hints", [])
    if "holds" in uniform:
        parts.append(f"holds {uniform['holds']}")
    if uniform.get("aliases"):
        parts.append(f"also called {', '.join(uniform['aliases'])}")
    return ", ".join(parts)
