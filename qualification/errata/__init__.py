"""The errata of the published sources in numbers: the baseline as published, and the technique that replaces it.

    for erratum in ERRATA:
        as_published(erratum, backends.get("gl"))       # wrong, as theory predicts
        as_corrected(erratum, backends.get("gl"))          # within the bounds of `erratum.right`

docs/errata.md says it in words, docs/stability.md shows it; `TEXT_ERRATA` has what no number can show,
`OPEN` what ours does not keep either.
"""

from __future__ import annotations

from qualification.errata.absorption import ABSORPTION
from qualification.errata.distance_fields import CHEAP_SSS, OPEN
from qualification.errata.erratum import Erratum, Measure, Right, as_corrected, as_published, holds, shows
from qualification.errata.lobes import ALISAVAKIS, UNITY_ICE
from qualification.errata.marches import DISTANCE_FIELDS
from qualification.errata.parallax import SUBSURFACE_PARALLAX
from qualification.errata.text_errata import TEXT_ERRATA, WITHOUT_ERRATA, TextErratum

__all__ = [
    "BACKENDS", "CHAPTERS", "ERRATA", "OPEN", "TEXT_ERRATA", "WITHOUT_ERRATA", "Erratum", "Measure", "Right",
    "TextErratum", "as_corrected", "as_published", "holds", "shows",
]  # fmt: skip

BACKENDS = ("numpy-f32", "gl", "webgpu", "hlsl", "browser")
"""Those that are measured: all in float32, with four compilers and two drivers below them."""

CHAPTERS: dict[str, tuple[Erratum, ...]] = {
    "Cheap SSS": CHEAP_SSS,
    "Alisavakis": ALISAVAKIS,
    "3D Distance Fields": DISTANCE_FIELDS,
    "Unity ice": UNITY_ICE,
    "Subsurface Parallax": SUBSURFACE_PARALLAX,
    "absorption": ABSORPTION,
}

ERRATA: tuple[Erratum, ...] = tuple(erratum for chapter in CHAPTERS.values() for erratum in chapter)
