"""Measures every builtin on every back end, and writes docs/parity.md: python -m qualification.pages.parity"""

from __future__ import annotations

from pathlib import Path

from qualification.parity import BACKENDS, FULL, Figure, cases, measure
from qualification.parity_inputs import FEW
from sssgen.harness import backends
from sssgen.ir.intrinsics import BUILTINS, Builtin
from sssgen.ir.types import kind_of

PAGE = Path(__file__).parents[2] / "docs" / "parity.md"

_REASONS = """
- `asin`, `acos`, `atan`: Mesa has polynomials whose error is absolute, up to 4e-4 for `asin` and `acos`; in SPIR-V
  (`webgpu`) it has a better one for `asin` below 0.5.
- `sin`, `cos` in SwiftShader: an approximation with an absolute error of 2e-4.
- `exp`, `sinh`, `cosh`, `pow`: drivers take exp2(x·log2(e)) and exp2(y·log2(x)), so the error grows with the exponent,
  whose own rounding is up to 2^-18. Below 1 `exp` has 2.6 ulp.
- `sinh`, `tanh`, `asinh`, `atanh` near 0, `acosh` near 1: their formulas with exp and log cancel there.
- `log`, `log2` near 1: the error of the drivers' polynomials is absolute.
- `textureLod`, `texture`: the weights between texels and levels have eight bits. In GLSL ES a sampler that is a
  parameter has low precision where the shader does not say `precision highp sampler2D`; Mesa takes 16 bits then.
"""


def page() -> str:
    """The page's text, with the figures of this machine."""
    found = [backends.get(name) for name in BACKENDS]
    chosen = cases(FULL)
    figures = {backend.name: measure(backend, chosen) for backend in found}
    lanes = sum(case.lanes for case in chosen)
    lines = [
        "# Parity of the builtins",
        "",
        "How far every builtin of the [table](intrinsics.md) is from NumPy in float64, on every back end.",
        "`python -m qualification.pages.parity` writes this page;",
        "`tests/qualification/test_parity_intrinsics.py` checks the limits on every back end.",
        "",
        f"Measured: {len(chosen)} overloads of {len(BUILTINS)} builtins on {lanes} sets of arguments a back end,",
        f"{FULL} an overload ({FEW} for texture reads and derivatives). A third are edges: zeros, powers of two and",
        "their neighbours, integers, halves, parts of pi, the ends of the domains, equal arguments; a third are even",
        "in value, a third in magnitude, from 2^-40 to 2^40. The seeds are fixed: the same device gives the same",
        "figures.",
        "",
        "The devices:",
        "",
        *(f"- `{one.name}`: {backends.BACKENDS[one.name].description}; {one.device()}" for one in found),
        "",
        "How to read it: a figure is the largest error in ulp, units in the last place, in float32, of the result (of",
        "a vector: of its largest component; where terms may cancel, as in `dot`, of the terms: the table's `size`).",
        "Where a result passes the limit in ulp the absolute limit holds; then the figure is the largest absolute",
        "error of such results, marked *abs*. *exact*: nothing differs. –: the target lacks it. Left out is what no",
        "language defines: arguments outside of the domain, and results too large for float32. Denormals may be",
        "flushed to zero; where they occur a result may be that of zeros, and is in no figure.",
        "",
        "What is behind the large figures:",
        "",
        _REASONS.strip(),
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
    return row.ulp == 0.0 or all(kind_of(case.result) != "float" for case in cases(1) if case.name == row.name)


def _cell(row: Builtin, figure: Figure | None) -> str:
    if figure is None:
        return "–"
    if not figure.right:
        return "**wrong**"
    if _exact(row):
        return "exact"
    if figure.absolute:
        return f"{figure.absolute:.1e} abs"
    return f"{figure.ulp:.2g}" if figure.ulp < 100.0 else f"{figure.ulp:.0f}"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
    print(f"wrote {PAGE.name}: {len(BUILTINS)} builtins")
