"""Golden pictures: compares a picture with the stored one by FLIP, or replaces the stored one.

`NAME.png` in the golden folder is the reference. For a picture that differs, `NAME.actual.png` and FLIP's map,
`NAME.difference.png`, are written to the folder `sssgen-failures` next to the golden folder.
"""

from __future__ import annotations

import contextlib
import math
import os

import numpy as np
import numpy.typing as npt

from sssgen.scene.arrays import Array
from sssgen.scene.pictures import images
from sssgen.scene.pictures.picture_difference import compare
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.support.file_writer import check_names
from sssgen.support.paths import display_name, posix
from sssgen.testing.outcome import Outcome

FLIP = 0.005
"""The largest mean of FLIP that passes by default.

Measured on the lamp of examples/ci, 96 × 72: all back ends gave the same 8-bit picture, a mean of 0. A difference of
1/255 in 1 % of the values, which another driver's rounding may cause, gave 0.002; a change of 5 % in one parameter gave
0.008 (distortion), 0.019 (power), 0.024 (attenuation_distance) and 0.035 (scale).
"""

FOLDER = "golden"
"""The folder of golden pictures, next to the scenes or the test file."""

FAILURES = "sssgen-failures"
"""The folder, next to the golden one, for pictures that differ."""


def check_limit(flip: float) -> float:
    """The value as a threshold for FLIP. Raises SssgenError if it is not from 0 to 1."""
    if not (math.isfinite(flip) and 0.0 <= flip <= 1.0):
        raise failure(f"{flip} is not a threshold for FLIP", "from 0 (identical) to 1; 0.005 is usual")
    return flip


def compare_golden(
    picture: npt.ArrayLike, folder: str, name: str, limit: float = FLIP, label: str = "", update: str = "--update"
) -> Outcome:
    """Compares an encoded picture, (height, width, 3), with `folder`/`name`.png in 8 bits per channel.

    `label` is part of the names of the files written for a failure; `update` is the option that writes golden pictures.
    Raises SssgenError for a golden picture that cannot be read, and for an array of another shape.
    """
    check_limit(limit)
    path = _path(folder, name)
    actual, shown = _round(picture), posix(path)
    paths = [os.path.join(_failures(folder), f"{name}{label}.{kind}.png") for kind in ("actual", "difference")]
    _clear(paths)  # of an earlier run
    if not os.path.isfile(path):
        message = f"there is no golden picture {shown}: {update} writes it"
        return Outcome("failed", message, _write_failure({paths[0]: actual}))
    golden = _color(images.read(path))
    if golden.shape != actual.shape:
        sizes = [f"{picture.shape[1]} × {picture.shape[0]}" for picture in (actual, golden)]
        message = f"the picture has {sizes[0]} pixels, and the golden one, {shown}, has {sizes[1]}"
        return Outcome("failed", message, _write_failure({paths[0]: actual}))
    difference = compare(actual, golden)
    if difference.flip <= limit:
        return Outcome("passed", f"FLIP {difference.flip:.4f}, at most {limit:g}")
    message = f"FLIP {difference.flip:.4f} is more than {limit:g}: the picture differs from {shown}"
    figures = f"relMSE {difference.relmse:.2e}, p99 {difference.p99:.1f}/255, max {difference.max:.1f}/255"
    return Outcome("failed", message, f"{figures}\n{_write_failure({paths[0]: actual, paths[1]: difference.picture})}")


def update_golden(picture: npt.ArrayLike, folder: str, name: str) -> Outcome:
    """Writes a picture as the golden one. Raises SssgenError where it cannot be written."""
    path = _path(folder, name)
    exists = os.path.isfile(path)
    _write(path, _round(picture))
    return Outcome("passed", f"{'replaced' if exists else 'wrote'} {posix(path)}")


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
        os.rmdir(os.path.dirname(paths[0]))  # removed if it is empty


def _round(picture: npt.ArrayLike) -> Array:
    """The picture rounded to the 8 bits of a file."""
    values = np.asarray(picture, np.float64)
    if values.ndim != 3 or values.shape[2] != 3 or 0 in values.shape:
        raise failure(f"an array of shape {values.shape} is not a picture", "(height, width, 3), encoded, 0..1")
    if np.isnan(values).any():
        raise failure("the picture holds NaN", "find the cause of NaN first")
    rounded: Array = np.rint(np.clip(values, 0.0, 1.0) * 255.0) / 255.0
    return rounded


def _color(picture: Array) -> Array:
    return picture[..., :3] if picture.shape[-1] >= 3 else picture[..., :1].repeat(3, axis=-1)


def _write_failure(pictures: dict[str, Array]) -> str:
    """Writes the pictures of a failure; returns where they are, or why they cannot be written."""
    try:
        for path, picture in pictures.items():
            _write(path, picture)
    except SssgenError as error:
        diagnostic = error.diagnostics[0]
        return f"{diagnostic.message}: {display_name(diagnostic.span.file)}"
    names = [os.path.basename(path) for path in pictures]
    return f"see {' and '.join(names)} in {posix(os.path.dirname(next(iter(pictures))))}"


def _write(path: str, picture: Array) -> None:
    try:
        images.write_png(path, picture)
    except SssgenError as error:  # its hint is for commands with -o
        hint = "check the permissions of the folder"
        raise SssgenError([diagnostic._replace(hint=hint) for diagnostic in error.diagnostics]) from None
