"""Golden pictures: a picture against the one that was kept, by FLIP; and how that one is kept anew.

`NAME.png` in the golden folder is the reference. Of a picture that differs, `NAME.actual.png` and FLIP's map,
`NAME.difference.png`, are written into the folder `sssgen-failures` beside the golden folder.
"""

from __future__ import annotations

import contextlib
import math
import os

import numpy as np
import numpy.typing as npt

from sssgen.harness.pictures import images
from sssgen.harness.pictures.images import Array
from sssgen.harness.pictures.picture_difference import compare
from sssgen.harness.testing.outcome import Outcome
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.support.file_writer import check_names
from sssgen.support.paths import posix

FLIP = 0.005
"""The largest mean of FLIP that passes, unless another one is given.

Measured on the lamp of examples/ci, 96 × 72: all back ends that draw gave the same 8 bits, which is 0; 1/255 more or
less in 1 % of the values, as another driver may round, is 0.002. A change of 5 % in one parameter gave 0.008
(distortion), 0.019 (power), 0.024 (attenuation_distance) and 0.035 (scale).
"""

FOLDER = "golden"
"""The folder of golden pictures, beside the scenes or the test file."""

FAILURES = "sssgen-failures"
"""The folder, beside the golden one, for pictures that differ."""


def check_limit(flip: float) -> float:
    """A threshold for FLIP. Raises SssgenError where it is none."""
    if not (math.isfinite(flip) and 0.0 <= flip <= 1.0):
        raise failure(f"{flip} is no threshold for FLIP", "from 0, which is the same, to 1; 0.005 is usual")
    return flip


def compared(
    picture: npt.ArrayLike, folder: str, name: str, limit: float = FLIP, label: str = "", update: str = "--update"
) -> Outcome:
    """An encoded picture, (height, width, 3), against `folder`/`name`.png; both have 8 bits a channel.

    `label` goes into the names of what is written of a failure; `update` is the option that makes golden pictures.
    Raises SssgenError for a golden picture that cannot be read, and for what is no picture.
    """
    check_limit(limit)
    path = _path(folder, name)
    actual, shown = _rounded(picture), posix(path)
    kept = [os.path.join(_failures(folder), f"{name}{label}.{what}.png") for what in ("actual", "difference")]
    _clear(kept)  # of an earlier run: they would be taken for this one's
    if not os.path.isfile(path):
        told = f"there is no golden picture {shown}: {update} writes it"
        return Outcome("failed", told, _written({kept[0]: actual}))
    golden = _color(images.read(path))
    if golden.shape != actual.shape:
        sizes = [f"{one.shape[1]} × {one.shape[0]}" for one in (actual, golden)]
        told = f"the picture has {sizes[0]} pixels, and the golden one, {shown}, has {sizes[1]}"
        return Outcome("failed", told, _written({kept[0]: actual}))
    found = compare(actual, golden)
    if found.flip <= limit:
        return Outcome("passed", f"FLIP {found.flip:.4f}, at most {limit:g}")
    told = f"FLIP {found.flip:.4f} is more than {limit:g}: the picture differs from {shown}"
    figures = f"relMSE {found.relmse:.2e}, p99 {found.p99:.1f}/255, max {found.max:.1f}/255"
    return Outcome("failed", told, f"{figures}\n{_written({kept[0]: actual, kept[1]: found.picture})}")


def updated(picture: npt.ArrayLike, folder: str, name: str) -> Outcome:
    """Keeps a picture as the golden one. Raises SssgenError where it cannot be written."""
    path = _path(folder, name)
    there = os.path.isfile(path)
    _write(path, _rounded(picture))
    return Outcome("passed", f"{'replaced' if there else 'wrote'} {posix(path)}")


def _path(folder: str, name: str) -> str:
    check_names([f"{name}.png"])
    return os.path.join(folder, f"{name}.png")


def _failures(folder: str) -> str:
    return os.path.join(os.path.dirname(os.path.normpath(folder)), FAILURES)


def _clear(paths: list[str]) -> None:
    for path in paths:
        with contextlib.suppress(OSError):
            os.unlink(path)
    with contextlib.suppress(OSError):
        os.rmdir(os.path.dirname(paths[0]))  # if that was all


def _rounded(picture: npt.ArrayLike) -> Array:
    """The picture in a file's 8 bits, so that it is compared as it would be kept."""
    values = np.asarray(picture, np.float64)
    if values.ndim != 3 or values.shape[2] != 3 or 0 in values.shape:
        raise failure(f"an array of shape {values.shape} is no picture", "(height, width, 3), encoded, 0..1")
    if np.isnan(values).any():
        raise failure("the picture holds NaN", "see where it comes from before comparing")
    rounded: Array = np.rint(np.clip(values, 0.0, 1.0) * 255.0) / 255.0
    return rounded


def _color(picture: Array) -> Array:
    return picture[..., :3] if picture.shape[-1] >= 3 else picture[..., :1].repeat(3, axis=-1)


def _written(pictures: dict[str, Array]) -> str:
    """Writes what helps to see a failure; where that cannot be done the failure is told all the same."""
    try:
        for path, picture in pictures.items():
            _write(path, picture)
    except SssgenError as error:
        found = error.diagnostics[0]
        return f"{found.message}: {found.span.file}"
    names = [os.path.basename(path) for path in pictures]
    return f"see {' and '.join(names)} in {posix(os.path.dirname(next(iter(pictures))))}"


def _write(path: str, picture: Array) -> None:
    try:
        images.write_png(path, picture)
    except SssgenError as error:  # its hint is for commands with -o
        raise SssgenError(
            [found._replace(hint="may you write to that folder?") for found in error.diagnostics]
        ) from None
