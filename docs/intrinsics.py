"""Writes docs/intrinsics.md from the intrinsic table: python docs/intrinsics.py"""

from __future__ import annotations

from pathlib import Path

from sssgen.ir.formats import FLOAT32
from sssgen.ir.intrinsics import BUILTINS, Builtin, with_constants

LANGUAGES = ("glsl", "hlsl", "wgsl")
DIALECTS = ("glsl-330", "hlsl-dx9", "hlsl-macros", "hlsl-unreal")
PAGE = Path(__file__).with_name("intrinsics.md")


def page() -> str:
    """The page's text."""
    lines = [
        "# The builtins",
        "",
        "`python docs/intrinsics.py` writes this page from the intrinsic table (`src/sssgen/ir/intrinsics/`).",
        "",
        "`genF` stands for float, vec2, vec3 and vec4, `vecF` for the vectors; likewise I, U, B for int, uint, bool.",
        "`matCR` stands for all matrices, of C columns and R rows; `mat` for the square ones.",
        "The columns show the text in each language; *polyfill* means that a function in sssgen's own language",
        "replaces the builtin, inlined if it is one expression; `op <` means the operator. A dialect is listed if it",
        "differs: `glsl-330` lacks some builtins of GLSL ES 3.00, `hlsl-dx9` is Unity's built-in pipeline, `hlsl-",
        "macros` is Unity's URP and Shader Graph, `hlsl-unreal` is Unreal. NumPy has a function with each name.",
        "",
        "Domain: the arguments (x, y, z in their order) for which the result is defined. Limit: the error of float32",
        "that is allowed relative to float64, in units in the last place, if it is more than 4. The [guards](#guards)",
        "follow.",
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
        "A guard replaces a call or one of its arguments if the range pass cannot prove that the call is safe",
        f"([guards.md](guards.md)). In float32: {', '.join(named)}.",
        "",
        "| Builtin | Problem | Kind | Replaces | Guard |",
        "|---|---|---|---|---|",
    ]
    for row in BUILTINS.values():
        for guard in row.guards:
            problem = guard.problem if guard.safe is not None else f"{guard.problem} (always guarded)"
            place = {"": "the call", "result": "the result, x"}.get(guard.replaces, guard.replaces)
            text = f"`{_escaped(guard.text)}`" if guard.text else "its polyfill, with guarded divisions"
            lines.append(f"| `{row.name}` | {problem} | {guard.kind} | {place} | {text} |")
    return lines


def _domain(row: Builtin) -> str:
    return "uniform control flow" if row.uniform_flow else _escaped(row.domain)


def _signatures(row: Builtin) -> str:
    declared = [signature.replace("(", f" {row.name}(", 1) for signature in row.signatures]
    return "<br>".join(f"`{text}`" for text in declared) + f"<br>{_escaped(row.doc)}"


def _has(row: Builtin, dialect: str) -> bool:
    """Whether a dialect has its own text."""
    return any(key.partition("/")[0] == dialect for key in row.texts)


def _text(row: Builtin, language: str) -> str:
    """The text of the builtin in a language, with the signatures that have another text."""
    texts = {"": row.texts[language]} if language in row.texts else {"": row.name} if language in LANGUAGES else {}
    texts |= {key.partition("/")[2]: text for key, text in row.texts.items() if key.startswith(f"{language}/")}
    cells = []
    for params, text in texts.items():
        if text.startswith("op:"):
            cell = f"`op {_escaped(text[3:])}`"
        else:
            cell = f"`{_escaped(text)}`" if text else ("*polyfill*" if row.polyfill else "*refused*")
        cells.append(f"({params}) {cell}" if params else cell)
    return "<br>".join(cells)


def _escaped(text: str) -> str:
    return text.replace("|", "\\|")


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
    print(f"wrote {PAGE.name}: {len(BUILTINS)} builtins")
