"""What is wrong in the published sources, shown by numbers: the baseline as published, and the technique in its place.

    for erratum in ERRATA:
        as_published(erratum, backends.get("gl"))       # off, in the way that theory says
        as_mended(erratum, backends.get("gl"))          # within the bounds of `erratum.right`

docs/errata.md says it in words, docs/stability.md shows it; `UNSHOWN` has what no number can show,
`OPEN` what ours does not keep either.
"""

from __future__ import annotations

from qualification.errata.absorption import ABSORPTION
from qualification.errata.distance_fields import OPEN, SEED_0
from qualification.errata.erratum import Erratum, Measure, Right, as_mended, as_published, holds, shows
from qualification.errata.lobes import SEED_1, SEED_3
from qualification.errata.marches import SEED_2
from qualification.errata.parallax import SEED_4
from qualification.errata.unshown import UNSHOWN, Unshown

__all__ = [
    "BACKENDS", "CHAPTERS", "ERRATA", "OPEN", "UNSHOWN", "Erratum", "Measure", "Right", "Unshown", "as_mended",
    "as_published", "holds", "shows",
]  # fmt: skip

BACKENDS = ("numpy-f32", "gl", "webgpu", "hlsl", "browser")
"""Those that are measured: all in float32, with four compilers and two drivers beneath."""

CHAPTERS: dict[str, tuple[Erratum, ...]] = {
    "seed 0": SEED_0,
    "seed 1": SEED_1,
    "seed 2": SEED_2,
    "seed 3": SEED_3,
    "seed 4": SEED_4,
    "absorption": ABSORPTION,
}

ERRATA: tuple[Erratum, ...] = tuple(one for chapter in CHAPTERS.values() for one in chapter)
