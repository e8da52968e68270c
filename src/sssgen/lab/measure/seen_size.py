"""The error of a picture at the size at which the body is seen from further away: boxes of pixels are averaged."""

from __future__ import annotations

import numpy as np

from sssgen.lab.measure.error_metric import compare
from sssgen.lab.measure.measured_point import ViewError
from sssgen.run.backends import Array
from sssgen.scene.arrays import Bools


def error_at(rows: int, valid: Bools, values: Array, reference: Array, noise: Array) -> ViewError:
    """The error of `values` (k, n) where the screen shows the whole view in `rows` rows of pixels.

    `valid`, (height, width), are the n pixels of the view that show the body; elsewhere both pictures are black.
    `noise` (k, n) is the reference's standard error, independent from pixel to pixel. A view with fewer rows is
    compared as it is.
    """
    boxes = _boxes(valid.shape, rows)
    inside, sizes = boxes[valid], np.bincount(boxes.ravel())
    shown = np.unique(inside)

    def means(pixels: Array) -> Array:
        return np.stack([np.bincount(inside, channel, len(sizes))[shown] / sizes[shown] for channel in pixels])

    error = compare(means(values), means(reference), np.sqrt(means(noise**2) / sizes[shown]))
    return {"value": error["value"], "low": error["low"], "high": error["high"]}


def _boxes(shape: tuple[int, ...], rows: int) -> Array:
    """The number of each pixel's box, (height, width)."""
    height, width = shape
    rows = min(rows, height)
    columns = max(1, round(width * rows / height))
    down, across = np.arange(height) * rows // height, np.arange(width) * columns // width
    return np.asarray(down[:, None] * columns + across)
