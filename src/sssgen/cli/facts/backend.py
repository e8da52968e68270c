"""`sssgen show BACKEND`: what it runs, what it needs, and whether this machine has it."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from sssgen.cli.layout import wrap
from sssgen.run.backend_registry import BACKENDS, unknown


def names() -> Collection[str]:
    """The back ends."""
    return BACKENDS


def describe(name: str) -> dict[str, Any]:
    """Everything about a back end. Raises SssgenError."""
    if name not in BACKENDS:
        raise unknown(name, BACKENDS)
    record = BACKENDS[name]
    return {
        "name": name,
        "summary": record.description,
        "target": record.target,
        "bits": record.bits,
        "evaluates": not record.scenes_only,
        "draws": not record.functions_only,
        "half": record.half,
        "needs": record.install,
    }


def lines(facts: Mapping[str, Any], width: int) -> list[str]:
    """The facts as text."""
    uses = ["evaluates functions (sssgen eval, stress)"] if facts["evaluates"] else []
    uses += ["draws scenes (sssgen render, ci)"] if facts["draws"] else []
    text = [*wrap(f"{facts['name']} (back end): {facts['summary']}", width, "", "  "), ""]
    for sentence in (
        f"runs the text of the target {facts['target']}, in floats of {facts['bits']} bits",
        " and ".join(uses),
    ):
        text += wrap(sentence, width, "", "  ")
    if facts["half"]:
        text.append(f"in half precision: {facts['half']}")
    needs = facts["needs"].replace("`", "")
    return [*text, *wrap(f"needs: {needs}", width, "", "  "), "what this machine has: sssgen doctor"]
