"""What there is to say about a builtin function, for `sssgen show` and editors."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from typing import Any

from sssgen.ir import signatures
from sssgen.ir.intrinsics import BUILTINS, Builtin
from sssgen.ir.old_names import OLD_NAMES
from sssgen.ir.out_builtins import OUT_BUILTINS
from sssgen.ir.projective_reads import PROJECTIVE_READS
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.targets import registry


def names() -> Collection[str]:
    """The builtin functions, with their names in old versions of GLSL."""
    return (*BUILTINS, *OUT_BUILTINS, *PROJECTIVE_READS, *OLD_NAMES)


def describe(name: str) -> dict[str, Any]:
    """Everything about a builtin function. Raises SssgenError."""
    if name not in names():
        raise failure(f"unknown builtin '{name}'", did_you_mean(name, names()) or "see: sssgen list builtins")
    new = OLD_NAMES[name][0] if name in OLD_NAMES else name
    if new in PROJECTIVE_READS:
        divided = f"As {PROJECTIVE_READS[new]}, at the coordinate divided by its last component."
        return {"name": name, "new_name": new, **_of_row(BUILTINS[PROJECTIVE_READS[new]]), "summary": divided}
    facts = _of_function(new) if new in OUT_BUILTINS else _of_row(BUILTINS[new])
    return {"name": name, "new_name": new, **facts}


def _of_function(name: str) -> dict[str, Any]:
    """A builtin that is written as a function wherever it is called: it has out parameters."""
    text = OUT_BUILTINS[name].strip()
    heads = re.findall(rf"^(\w+ {name}\([^)]*\))", text, re.MULTILINE)
    return {"summary": "", "signatures": heads, "languages": {}, "polyfill": text, "guards": []}


def _of_row(row: Builtin) -> dict[str, Any]:
    return {
        "summary": row.doc,
        "signatures": [signature.replace("(", f" {row.name}(", 1) for signature in row.signatures],
        "domain": row.domain,
        "uniform_flow": row.uniform_flow,
        "cost_kind": row.kind,
        "operations_per_component": row.cost,
        "ulp": row.ulp,
        "absolute": row.absolute,
        "clause": row.clause,
        "languages": _languages(row),
        "polyfill": row.polyfill.strip(),
        "guards": [
            {
                "problem": guard.problem,
                "kind": guard.kind,
                "replaces": guard.replaces or "call",
                "text": guard.text,
            }
            for guard in row.guards
        ],
    }


def _languages(row: Builtin) -> dict[str, dict[str, str]]:
    """Language or dialect of a target → the parameters of a signature → the text; '' for a polyfill or none.

    A dialect is left out if it writes the same as its language.
    """
    dialects = {registry.load(target).dialect for target in registry.names()}
    languages = sorted(dialects | {dialect.partition("-")[0] for dialect in dialects})
    texts = {language: signatures.texts(row.name, language) for language in languages}
    return {language: text for language, text in texts.items() if _is_own(language, texts)}


def _is_own(language: str, texts: Mapping[str, Mapping[str, str]]) -> bool:
    base = language.partition("-")[0]
    return language == base or texts[language] != texts[base]
