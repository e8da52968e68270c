"""Measures every builtin on every back end, and writes docs/parity.md: python -m qualification.pages.parity"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from qualification.parity import BACKENDS, FULL, Figure, cases, measure
from qualification.parity_inputs import TEXTURE_LANES
from qualification.wgsl_accuracy import LIMITS, WGSL_BACKENDS, shares
from sssgen.ir.intrinsics import BUILTINS, Builtin
from sssgen.ir.types import kind_of
from sssgen.run import backends

PAGE = Path(__file__).parents[2] / "docs" / "parity.md"

_REASONS = """
- `asin`, `acos`, `atan`: Mesa evaluates polynomials with an absolute error, up to 4e-4 for `asin` and `acos`; in SPIR-V
  (`webgpu`) it uses a better one for `asin` below 0.5.
- `sin`, `cos` in SwiftShader: an approximation with an absolute error of 2e-4.
- `exp`, `sinh`, `cosh`, `pow`: drivers compute exp2(x·log2(e)) and exp2(y·log2(x)), so the error grows with the
  exponent, which is itself rounded by up to 2^-18. Below 1 the error of `exp` is 2.6 ulp.
- `sinh`, `tanh`, `asinh`, `atanh` near 0, `acosh` near 1: the formulas with exp and log cancel there.
- `log`, `log2` near 1: the error of the drivers' polynomials is absolute.
- `textureLod`, `texture`: the weights between texels and levels have eight bits. In GLSL ES a sampler parameter has low
  precision unless the shader declares `precision highp sampler2D`; Mesa then uses 16 bits.
"""


def page() -> str:
    """The page's text, with the figures of this machine."""
    present = [backends.get(name) for name in BACKENDS]
    chosen = cases(FULL)
    figures = {backend.name: measure(backend, chosen) for backend in present}
    of_limit = [shares(backend, chosen) for backend in present if backend.name in WGSL_BACKENDS]
    lanes = sum(case.lanes for case in chosen)
    lines = [
        "# Parity of the builtins",
        "",
        "This page shows the largest deviation of every builtin of the [table](intrinsics.md) from NumPy in float64, "
        "on every back end.",
        "`python -m qualification.pages.parity` writes this page;",
        "`tests/qualification/test_parity_intrinsics.py` checks the limits on every back end.",
        "",
        f"Measured: {len(chosen)} overloads of {len(BUILTINS)} builtins on {lanes} sets of arguments per back end,",
        f"{FULL} per overload ({TEXTURE_LANES} for texture reads and derivatives). "
        "A third are edge cases: zeros, powers of two and",
        "their neighbours, integers, halves, fractions of pi, the ends of the domains, equal arguments; a third are",
        "distributed uniformly in value, a third uniformly in magnitude, from 2^-40 to 2^40. The seeds are fixed, so a",
        "device always gives the same figures.",
        "",
        "The devices:",
        "",
        *(
            f"- `{backend.name}`: {backends.BACKENDS[backend.name].description}; {backend.device()}"
            for backend in present
        ),
        "",
        "A figure is the largest error in ulp (units in the last place) of the float32 result; for a vector, of its",
        "largest component; if terms can cancel, as in `dot`, of the terms (`size` in the table). If a result exceeds",
        "the limit in ulp, the absolute limit applies; the figure is then the largest absolute error of such results,",
        "marked *abs*. *exact*: no result differs. –: the target lacks the builtin. Cases that no language defines are",
        "excluded: arguments outside of the domain, and results too large for float32. Devices can flush denormals to",
        "zero; a result that depends on this is excluded, too.",
        "",
        "*of WGSL's limit*: the largest error of `webgpu`, `browser`, `firefox`, as a share of what its specification",
        "allows at the same arguments, to which the WebGPU conformance tests hold devices; –: there is no such",
        "builtin or limit.",
        "",
        "The causes of the large figures:",
        "",
        _REASONS.strip(),
        "",
        f"| Builtin | Allowed | of WGSL's limit | {' | '.join(backend.name for backend in present)} |",
        f"|---|---|---|{'---|' * len(present)}",
    ]
    for name, row in BUILTINS.items():
        cells = [_cell(row, figures[backend.name].get(name)) for backend in present]
        lines.append(f"| `{name}` | {allowed(row)} | {share_cell(name, of_limit)} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def share_cell(name: str, of_limit: Sequence[Mapping[str, float]]) -> str:
    """The largest error of WGSL's back ends, as a share of the limit in its specification; – where that has none."""
    largest = max((shares.get(name, 0.0) for shares in of_limit), default=0.0)
    return "–" if name not in LIMITS else f"**{largest:.0%}**" if largest > 1.0 else f"{largest:.0%}"


def allowed(row: Builtin) -> str:
    """The limit, and the clause of the specification that states it."""
    if _exact(row):
        return "exact"
    limit = f"{row.ulp:g} ulp" + (f" or {row.absolute:.2g}" if row.absolute else "")
    return f"{limit}: {row.clause}".replace("|", "\\|") if row.clause else limit


def _exact(row: Builtin) -> bool:
    """Whether only the exact result is correct."""
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
