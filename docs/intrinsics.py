"""Writes docs/intrinsics.md from the intrinsic table: python docs/intrinsics.py"""

from __future__ import annotations

from pathlib import Path

from sssgen.ir.formats import FLOAT32
from sssgen.ir.intrinsics import BUILTINS, Builtin, with_constants

LANGUAGES = ("glsl", "hlsl", "wgsl")
DIALECTS = ("glsl-330", "hlsl-dx9", "hlsl-macros")
PAGE = Path(__file__).with_name("intrinsics.md")


def page() -> str:
    """The page's text."""
    lines = [
        "# The builtins",
        "",
        "Made from the intrinsic table (`src/sssgen/ir/intrinsics/`) by `python docs/intrinsics.py`.",
        "",
        "`genF` stands for float, vec2, vec3 and vec4 alike, `vecF` for the vectors; likewise I, U, B. A language that",
        "has the builtin under its own name shows it; *polyfill* means that a definition in our own language takes its",
        "place, written out where it is short; `op <` means the operator. Dialects are shown where they differ:",
        "`glsl-330` lacks some of what GLSL ES 3.00 has, `hlsl-dx9` is Unity's built-in pipeline, `hlsl-macros` its",
        "URP and Shader Graph. NumPy has a function of each name.",
        "",
        "Domain: where the result is defined, with x, y, z for the arguments in their order. Limit: the float32 error",
        "allowed against float64, in units in the last place, where it is more than 4. The [guards](#guards) follow.",
        "",
        "| Builtin | GLSL | HLSL | WGSL | Domain | Limit |",
        "|---|---|---|---|---|---|",
    ]
    for row in BUILTINS.values():
        cells = [_signatures(row)]
        for language in LANGUAGES:
            dialects = [name for name in DIALECTS if name.startswith(f"{language}-") and _has(row, name)]
            cells.append("<br>".join([_text(row, language), *(f"{name}: {_text(row, name)}" for name in dialects)]))
        limit = f"{row.ulp:g} ulp" if row.ulp > 4 else ""
        if row.absolute:
            limit = f"{limit or '4 ulp'} or {row.absolute:.2g}"
        cells += [_domain(row), f"{limit}: {_escaped(row.clause)}" if row.clause else limit]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join([*lines, *_guards()]) + "\n"


def _guards() -> list[str]:
    """The section on guards."""
    names = ("TINY", "DIVISOR", "SQUARE", "EPSILON", "EXPONENT", "LARGEST", "ROOT")
    named = [f"{name} = {with_constants(name, FLOAT32, (0.0, 0.0), '{:g}'.format)}" for name in names]
    lines = [
        "",
        "## Guards",
        "",
        "What replaces a call or one of its arguments where the range pass cannot prove that nothing goes wrong",
        f"([guards.md](guards.md)). In float32: {', '.join(named)}.",
        "",
        "| Builtin | Goes wrong | In place of | Guard |",
        "|---|---|---|---|",
    ]
    for row in BUILTINS.values():
        for guard in row.guards:
            problem = guard.problem if guard.safe is not None else f"{guard.problem} (always guarded)"
            place = {"": "the call", "result": "the result, x"}.get(guard.replaces, guard.replaces)
            text = f"`{_escaped(guard.text)}`" if guard.text else "its polyfill, whose divisions are guarded"
            lines.append(f"| `{row.name}` | {problem} | {place} | {text} |")
    return lines


def _domain(row: Builtin) -> str:
    return "uniform control flow" if row.uniform_flow else _escaped(row.domain)


def _signatures(row: Builtin) -> str:
    declared = [signature.replace("(", f" {row.name}(", 1) for signature in row.signatures]
    return "<br>".join(f"`{one}`" for one in declared) + f"<br>{_escaped(row.doc)}"


def _has(row: Builtin, dialect: str) -> bool:
    """Whether a dialect has a text of its own."""
    return any(key.partition("/")[0] == dialect for key in row.texts)


def _text(row: Builtin, language: str) -> str:
    """How a language writes the builtin, with what differs for some of its signatures."""
    found = {"": row.texts[language]} if language in row.texts else {"": row.name} if language in LANGUAGES else {}
    found |= {key.partition("/")[2]: text for key, text in row.texts.items() if key.startswith(f"{language}/")}
    shown = []
    for params, text in found.items():
        if text.startswith("op:"):
            word = f"`op {_escaped(text[3:])}`"
        else:
            word = f"`{_escaped(text)}`" if text else ("*polyfill*" if row.polyfill else "*refused*")
        shown.append(f"({params}) {word}" if params else word)
    return "<br>".join(shown)


def _escaped(text: str) -> str:
    return text.replace("|", "\\|")


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
    print(f"wrote {PAGE.name}: {len(BUILTINS)} builtins")
