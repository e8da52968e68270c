"""The attributes of a technique: `key: text` sections of its doc comment, checked when the file is loaded.

docs/language.md has the table of them. The program knows a technique only by its attributes, not by its name.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import NamedTuple

from sssgen.lang.check.quantities import SCALARS
from sssgen.support.diagnostics import SssgenError, did_you_mean, failure

TEXTS = (
    "role",
    "formula",
    "source",
    "units",
    "limits",
    "corrects",
    "baseline",
    "uncharted",
    "glows",
    "legend",
    "calibrated",
    "matched",
)
"""Attributes of free text; `role` is checked by the library."""

_VALUES = ("superseded_by", "suggested", "shape", "sets", "requires", "bake", "deviation", "deviation_bounds")
ATTRIBUTES = (*TEXTS, *_VALUES)

SHAPES = ("box", "sphere", "torus", "texture")
"""The values of `shape`, the body that a distance function describes."""

REQUIREMENTS = (
    "bake", "depth-map", "depth-layers", "back-faces", "eye-layers", "matt-light", "inner-light", "rest-pose",
    "rigid", "fixed-light",
)  # fmt: skip
"""What `requires` can name: a texture baked from the body; the light's depth map; that map with further layers; a
picture of the body's back faces from the eye; that picture with what lies behind them; a picture of what the body
reflects if it is white; a volume of the light inside it; a mesh that is rigid, or whose rest pose the engine knows; a
rigid mesh; a light that does not move relative to the body."""

OMISSIONS = REQUIREMENTS[:5]
"""Those that `chart` and `pick` can leave out: of what they measure, engines may not provide these."""

BOUNDS = ("largest", "share", "bound_share")
"""What `deviation_bounds` can bound."""

_FILE = re.compile(r" -o (\{name\}\.\w+)$")
_CONVERSION = re.compile(r"(\w+) to (\w+)")
_SETTING = re.compile(r"(\w+) by (\w+)")
_BOUND = re.compile(r"(\w+) ([0-9.e+-]+)")


class Bake(NamedTuple):
    """How `sssgen bake` makes the textures of a technique."""

    arguments: str
    """Behind `sssgen bake`, with `{mesh}`, `{scene}`, `{light}`, `{name}` and parameters in braces"""
    files: tuple[str, ...]
    """Of each texture, in the order of their declarations, as `{name}_table.exr`"""


class Attributes(NamedTuple):
    """The attributes of a technique that are more than text."""

    baseline: bool = False
    """A formula as its source published it."""
    superseded_by: tuple[str, ...] = ()
    """The techniques to use in place of this baseline, which is kept only for comparison."""
    uncharted: bool = False
    """It measures nothing, so that charts cannot compare it with a reference."""
    glows: bool = False
    """Its light is not a factor on a lamp's colour: it is added once, to the emission."""
    calibrated: bool = False
    """Its light has the right scale and colour without a fit: the data that it reads contain them."""
    matched: bool = False
    """It refracts, and reads light that is baked for a refractive index of 1, too."""
    suggested: tuple[str, str] | None = None
    """(source, target): error messages suggest it where this conversion is missing."""
    legend: str = ""
    """What a chart's legend adds to the name of a chain with this conversion."""
    shape: str = ""
    """The body whose distance it gives, one of `SHAPES`."""
    sets: Mapping[str, str] = {}
    """Value of the surface → the uniform that is its value, as long as textures have their defaults."""
    requires: tuple[str, ...] = ()
    """What the engine has to provide, where declarations do not show it: of `REQUIREMENTS`."""
    bake: Bake | None = None
    """What makes its textures; None for textures that no bake makes"""
    deviation: str = ""
    """Why back ends may deviate from the reference by more than the goal."""
    deviation_bounds: Mapping[str, Mapping[str, float]] = {}
    """Back end ('' for all) → the bounds that hold in place of the usual ones."""


def sections(doc: str, shown: str = "") -> dict[str, str]:
    """A doc comment's first paragraph as `summary`, and its `key: text` sections. Raises SssgenError."""
    texts: dict[str, str] = {}
    key = "summary"
    for line in doc.splitlines():
        word, colon, rest = line.partition(":")
        if colon and word.isidentifier() and word.islower() and not line.startswith(" "):
            key = word
            if key not in ATTRIBUTES:
                raise _wrong(f"unknown attribute '{key}'", key, ATTRIBUTES, "attributes", shown)
            if key in texts:
                raise failure(f"attribute '{key}' is given twice", "", shown)
            texts[key] = rest.strip()
        elif line.strip():
            texts[key] = f"{texts.get(key, '')} {line.strip()}".strip()
    return texts


def read_attributes(texts: Mapping[str, str], shown: str) -> Attributes:
    """The values of a doc comment's sections. Raises SssgenError where one does not follow its grammar."""
    bounds = _bounds(texts["deviation_bounds"], shown) if "deviation_bounds" in texts else {}
    if bounds and "deviation" not in texts:
        raise failure("deviation_bounds without deviation", "write the reason: `deviation: TEXT`", shown)
    shape = texts.get("shape", "")
    if shape and shape not in SHAPES:
        raise _wrong(f"unknown shape '{shape}'", shape, SHAPES, "shapes", shown)
    superseded_by = tuple(name.strip() for name in texts.get("superseded_by", "").split(",") if name.strip())
    if superseded_by and "baseline" not in texts:
        raise failure("superseded_by is for baselines", "write `baseline: TEXT`, too", shown)
    return Attributes(
        baseline="baseline" in texts,
        superseded_by=superseded_by,
        uncharted="uncharted" in texts,
        glows="glows" in texts,
        calibrated="calibrated" in texts,
        matched="matched" in texts,
        suggested=_conversion(texts["suggested"], shown) if "suggested" in texts else None,
        legend=texts.get("legend", ""),
        shape=shape,
        sets=_settings(texts["sets"], shown) if "sets" in texts else {},
        requires=_requirements(texts["requires"], shown) if "requires" in texts else (),
        bake=_bake(texts["bake"], shown) if "bake" in texts else None,
        deviation=texts.get("deviation", ""),
        deviation_bounds=bounds,
    )


def _conversion(text: str, shown: str) -> tuple[str, str]:
    """`thinness to thickness`."""
    match = _CONVERSION.fullmatch(text)
    if match is None:
        raise failure(f"'{text}' is not a conversion", "write, for example, `suggested: thinness to thickness`", shown)
    for quantity in match.groups():
        if quantity not in SCALARS:
            raise _wrong(f"unknown quantity '{quantity}'", quantity, SCALARS, "quantities", shown)
    return match[1], match[2]


def _settings(text: str, shown: str) -> dict[str, str]:
    """`metallic by metalness, roughness by surface_roughness`."""
    settings = {}
    for item in text.split(","):
        match = _SETTING.fullmatch(item.strip())
        if match is None:
            raise failure(f"'{item.strip()}' is not a setting", "write, for example, `sets: albedo by tint`", shown)
        settings[match[1]] = match[2]
    return settings


def _requirements(text: str, shown: str) -> tuple[str, ...]:
    """`depth-map, fixed-light`."""
    names = tuple(name.strip() for name in text.split(","))
    for name in names:
        if name not in REQUIREMENTS:
            raise _wrong(f"unknown requirement '{name}'", name, REQUIREMENTS, "requirements", shown)
    return names


def _bake(text: str, shown: str) -> Bake:
    """`thickness {mesh} -o {name}.png`, or `… -o {name}.png; {name}_1.png, {name}_2.png` for several files."""
    arguments, _, files = (part.strip() for part in text.partition(";"))
    output = _FILE.search(arguments)
    if output is None:
        hint = "write, for example, `bake: thickness {mesh} -o {name}.png`"
        raise failure(f"'{text}' are not the arguments of sssgen bake", hint, shown)
    return Bake(arguments, tuple(file.strip() for file in files.split(",")) if files else (output[1],))


def _bounds(text: str, shown: str) -> dict[str, dict[str, float]]:
    """`largest 0.001, share 0.7; browser: largest 0.5`: clauses, each for all back ends or for the one named."""
    bounds: dict[str, dict[str, float]] = {}
    for clause in text.split(";"):
        backend, _, rest = clause.rpartition(":")
        own = bounds.setdefault(backend.strip(), {})
        for item in rest.split(","):
            match = _BOUND.fullmatch(item.strip())
            if match is None:
                raise failure(
                    f"'{item.strip()}' is not a bound", "write, for example, `largest 0.001, share 0.02`", shown
                )
            if match[1] not in BOUNDS:
                raise _wrong(f"unknown bound '{match[1]}'", match[1], BOUNDS, "bounds", shown)
            try:
                own[match[1]] = float(match[2])
            except ValueError:
                raise failure(f"'{match[2]}' is not a number", "", shown) from None
    return bounds


def _wrong(message: str, word: str, names: tuple[str, ...], kind: str, shown: str) -> SssgenError:
    return failure(message, did_you_mean(word, names) or f"{kind}: {', '.join(names)}", shown)
