"""What is said about techniques, parameters, builtins and functions, in Markdown: the facts of `sssgen show`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sssgen.ir.nodes import Function, Uniform
from sssgen.ir.types import spell
from sssgen.lang.check.quantities import QUANTITIES, words
from sssgen.material.library import Technique
from sssgen.material.slots import signature
from sssgen.material.technique_facts import facts_of, uniform_facts, uniform_text
from sssgen.support.paths import display_name
from sssgen.targets import builtin_facts

_SHOWN_ATTRIBUTES = ("formula", "units", "limits", "source", "corrects")


def code_block(text: str) -> str:
    """A block of GLSL."""
    return f"```glsl\n{text}\n```"


def explain_technique(technique: Technique) -> str:
    """A technique: what it computes, its signature, its parameters, its source."""
    facts = facts_of(technique)
    parts = [f"**{facts['name']}** ({facts['role']})", facts["summary"], code_block(facts["signature"])]
    rows = [
        f"- `{uniform['name']}`: {uniform_text({**uniform, 'aliases': ()})}"
        for uniform in (*facts["parameters"], *facts["look"], *facts["textures"])
    ]
    rows += [f"- slot `{slot['signature']}`" for slot in facts["slots"]]
    if rows:
        parts.append("\n".join(rows))
    parts += [f"*{key}*: {_escape(facts['doc'][key])}" for key in _SHOWN_ATTRIBUTES if key in facts["doc"]]
    return "\n\n".join(part for part in parts if part)


def explain_uniform(uniform: Uniform, value: str = "") -> str:
    """A parameter or texture: type, default, range, unit, what it means, the file that declares it."""
    facts = uniform_facts(uniform)
    head = f"**{facts['name']}**: {uniform_text(facts)}"
    file = uniform.span.file  # '' for a key that no file declares
    declared = f"*declared in* {display_name(file)}" if file else ""
    parts = [head, facts["doc"], f"here: {value}" if value else "", declared]
    return "\n\n".join(part for part in parts if part)


def explain_builtin(name: str) -> str:
    """A builtin function: signatures, domain, error, guards."""
    facts: Mapping[str, Any] = builtin_facts.describe(name)
    old = f", an old name of {facts['new_name']}" if facts["new_name"] != facts["name"] else ""
    parts = [f"**{name}** (builtin{old})", facts["summary"], code_block("\n".join(facts["signatures"]))]
    if facts.get("domain"):
        parts.append(f"*defined for*: {_escape(facts['domain'])}")
    if facts.get("uniform_flow"):
        parts.append("Called in uniform control flow only: it compares neighbouring pixels.")
    if "ulp" in facts:
        parts.append(f"*error of float32*: at most {facts['ulp']:g} ulp")
    parts += [f"*guard*: {_escape(guard['problem'])}" for guard in facts["guards"]]
    return "\n\n".join(part for part in parts if part)


def explain_function(function: Function) -> str:
    """A function of a file: its signature and its comment."""
    slot = "" if function.body is not None else "A slot: a material binds a function to it."
    return "\n\n".join(part for part in (code_block(signature(function)), slot, function.doc) if part)


def explain_quantity(name: str) -> str:
    """A quantity type."""
    return f"**{name}**: {words(name)}, a `{spell(QUANTITIES[name])}` that is not mixed with other quantities"


def _escape(text: str) -> str:
    """A text without Markdown's marks: `a * b * c` is no emphasis."""
    return text.replace("*", r"\*").replace("_", r"\_")
