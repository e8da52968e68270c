"""`sssgen show BUILTIN`: its signatures, where it is defined, and how each language writes it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sssgen.cli.layout import wrap
from sssgen.targets.builtin_facts import describe as describe
from sssgen.targets.builtin_facts import names as names


def lines(facts: Mapping[str, Any], width: int) -> list[str]:
    """The facts as text."""
    old = f", an old name of {facts['new_name']}" if facts["new_name"] != facts["name"] else ""
    text = [f"{facts['name']} (builtin){old}", *wrap(facts["summary"], width, "  ", "  "), ""]
    text += [f"  {signature}" for signature in facts["signatures"]]
    if not facts["languages"]:
        function = [f"  {line}" for line in facts["polyfill"].split("\n")]
        return [*text, "", "in every language, this function:", *function]
    text.append("")
    if facts["domain"]:
        text += wrap(f"defined for: {facts['domain']}", width, "", "  ")
    if facts["uniform_flow"]:
        text.append("called in uniform control flow only: it compares neighbouring pixels")
    limit = f"{facts['ulp']:g} ulp" + (f" or {facts['absolute']:.2g}" if facts["absolute"] else "")
    clause = f" ({facts['clause']})" if facts["clause"] else ""
    text += wrap(f"error of float32: at most {limit}{clause}", width, "", "  ")
    text += ["", "as each language writes it:"]
    longest = max(map(len, facts["languages"]))
    for language, texts in facts["languages"].items():
        same = len(set(texts.values())) == 1
        for index, (parameters, written) in enumerate(texts.items()):
            if index == 0 or not same:
                head = language if index == 0 else ""
                which = "" if same else f"({parameters.replace(',', ', ')})  "
                text.append(f"  {head:{longest}}  {which}{_language_text(written, bool(facts['polyfill']))}")
    if facts["polyfill"]:
        text += ["", "polyfill:", *(f"  {line}" for line in facts["polyfill"].split("\n"))]
    if facts["guards"]:
        text += ["", "guards, where a call is not proven safe:"]
        for guard in facts["guards"]:
            instead = f"{guard['replaces']} becomes {guard['text']}" if guard["text"] else "the polyfill, guarded"
            text += wrap(f"{guard['problem']}: {instead}", width, "  ", "      ")
    return text


def _language_text(text: str, polyfill: bool) -> str:
    if text.startswith("op:"):
        return f"operator {text[3:]}"
    return text or ("polyfill" if polyfill else "not available")
