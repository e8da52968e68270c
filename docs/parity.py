"""Measures every builtin on every back end, and writes docs/parity.md: python docs/parity.py"""

from __future__ import annotations

from pathlib import Path

from sssgen.harness import backends
from sssgen.harness.parity import BACKENDS, FULL, Figure, cases, measure
from sssgen.ir import signatures
from sssgen.ir.intrinsics import BUILTINS, Builtin

PAGE = Path(__file__).with_name("parity.md")


def page() -> str:
    """The page's text, with the figures of this machine."""
    found = [backends.get(name) for name in BACKENDS]
    chosen = cases(FULL)
    figures = {backend.name: measure(backend, chosen) for backend in found}
    lanes = sum(case.lanes for case in chosen)
    lines = [
        "# Parity of the builtins",
        "",
        "How far every builtin of the [table](intrinsics.md) is from NumPy in float64, on every back end. Made by",
        "`python docs/parity.py`; `tests/test_parity_intrinsics.py` holds every back end to the limits at each run.",
        "",
        f"Measured: {len(chosen)} overloads of {len(BUILTINS)} builtins on {lanes} sets of arguments a back end, {FULL}",
        "an overload (12 for texture reads and derivatives). A third are edges: zeros, powers of two and their",
        "neighbours, integers, halves, parts of pi, the ends of the domains, equal arguments; a third are even in number,",
        "a third in magnitude, from 2^-40 to 2^40. The seeds are fixed, so that the same device gives the same figures.",
        "",
        "The devices:",
        "",
        *(f"- `{backend.name}`: {backends.NAMES[backend.name]}; {backend.device()}" for backend in found),
        "",
        "How to read it: a figure is the largest error in ulp, units in the last place, in float32, of the result (of a",
        "vector: of its largest component; where terms may cancel, as in `dot`, of the terms: the table's `size`). Where",
        "the limit in ulp is passed the absolute limit holds, and the figure is the largest absolute error there, marked",
        "*abs*. *exact*: no lane differs. –: the target lacks it. Left out is what no language defines: arguments outside",
        "of the table's domain, results too large for float32. Denormals may be flushed to zero, and are only",
        "looked at for that.",
        "",
        f"| Builtin | Allowed | {' | '.join(backend.name for backend in found)} |",
        f"|---|---|{'---|' * len(found)}",
    ]
    for name, row in BUILTINS.items():
        cells = [_cell(row, figures[backend.name].get(name)) for backend in found]
        lines.append(f"| `{name}` | {allowed(row)} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def allowed(row: Builtin) -> str:
    """The limit, and the clause that it is from."""
    if _exact(row):
        return "exact"
    limit = f"{row.ulp:g} ulp" + (f" or {row.absolute:.2g}" if row.absolute else "")
    return f"{limit}: {row.clause}".replace("|", "\\|") if row.clause else limit


def _exact(row: Builtin) -> bool:
    """Whether nothing but the exact result is right."""
    results = [signatures.parse(signature)[0] for signature in row.signatures]
    return row.ulp == 0.0 or not any(result.startswith(("float", "vec2", "vec3", "vec4", "mat")) or result.endswith("F") for result in results)


def _cell(row: Builtin, figure: Figure | None) -> str:
    if figure is None:
        return "–"
    if not figure.right:
        return "**wrong**"
    if _exact(row):
        return "exact"
    return f"{figure.absolute:.1e} abs" if figure.absolute else f"{figure.ulp:.2g}" if figure.ulp < 100 else f"{figure.ulp:.0f}"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
    print(f"wrote {PAGE.name}: {len(BUILTINS)} builtins")
