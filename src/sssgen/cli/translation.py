"""What both forms of `sssgen transpile` share: the target, macros, a translation's name, renamed identifiers."""

from __future__ import annotations

import keyword
import re
import sys
from collections.abc import Mapping

from sssgen.cli.emit import chosen_targets
from sssgen.cli.output import print_warnings
from sssgen.lang.plain_glsl import GlslFile
from sssgen.support.diagnostics import Diagnostic, failure
from sssgen.targets.registry import load, names

REFLECTION = ".reflection.json"


def one_target(text: str | None, wrong: list[Diagnostic]) -> list[str]:
    """The one target of `--target`, in a list; what is wrong with it is added to `wrong`."""
    if text is None:
        hint = "write --target wgsl, or another of: sssgen list targets"
        wrong.append(Diagnostic("error", "the target is missing", hint=hint))
        return []
    chosen = chosen_targets(text, wrong)
    if len(chosen) > 1:
        message = "transpile takes one target"
        wrong.append(Diagnostic("error", message, hint=f"write --target {chosen[0]}"))
    return chosen


def macros(definitions: list[str]) -> dict[str, str]:
    """The macros of `-D NAME=VALUE`; without a value it is 1, as in C compilers."""
    macros = {}
    for text in definitions:
        name, sign, value = text.partition("=")
        if not re.fullmatch(r"[A-Za-z_]\w*", name, re.ASCII):
            raise failure(f"-D {text}: '{name}' is not a macro's name", "write -D NAME or -D NAME=VALUE")
        macros[name] = value if sign else "1"
    return macros


def explain_renames(
    renames: Mapping[str, str], target: str, loaded: GlslFile | None, files: dict[str, str]
) -> list[dict[str, str]]:
    """The renames that a user sees, each with its reason."""
    return [
        {"from": old, "to": new, "why": _rename_reason(old, target)}
        for old, new in renames.items()
        if _concerns(old, new, loaded, files)
    ]


def title(stem: str) -> str:
    """The name of the translation: the file's name, without its suffix, as an identifier."""
    name = re.sub(r"\W", "_", stem, flags=re.ASCII)
    return name if name[:1].isalpha() else f"file_{name}"


def _concerns(old: str, new: str, loaded: GlslFile | None, files: dict[str, str]) -> bool:
    """Whether the author wrote the name, and the output contains the new one."""
    bare = _bare(old)
    if bare in ("main", "mainImage") or bare.startswith("gl_"):
        return False
    output = [text for name, text in files.items() if not name.endswith(REFLECTION)]
    written = loaded is None or any(re.search(rf"\b{bare}\b", text) for text in loaded.texts.values())
    return written and any(re.search(rf"\b{re.escape(new)}\b", text) for text in output)


def _bare(old: str) -> str:
    """A name without the function or struct that it is in, and without a function's parameters."""
    return old.partition("(")[0].rpartition(".")[2]


def _rename_reason(old: str, target: str) -> str:
    """Why a name was changed, in a few words."""
    bare = _bare(old)
    if "(" in old:
        return "each overload needs its own name there"
    language = load(target).language
    ordered = sorted(names(), key=lambda name: (name != target, load(name).language != language))
    reserving = [name for name in ordered if bare in load(name).names.exact]
    if target == "numpy" and keyword.iskeyword(bare):
        return "Python reserves it"
    if reserving:
        return f"{reserving[0]} reserves it"
    if "__" in bare or bare.startswith("gl_"):
        return "other languages do not allow such a name"
    return "the name is taken there"


def print_changes(warnings: list[Diagnostic], renamed: list[dict[str, str]]) -> None:
    """Prints warnings and renamed identifiers to the standard error stream."""
    print_warnings(warnings)
    for row in renamed:
        print(f"renamed: {row['from']} → {row['to']} ({row['why']})", file=sys.stderr)
