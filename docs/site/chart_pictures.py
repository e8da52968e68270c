"""Pictures of charted chains beside path tracing: what is missing in the one is the limit of the techniques."""

from __future__ import annotations

import dataclasses
import functools

import numpy as np

from picture import Picture
from sssgen.lab.chart import charting
from sssgen.lab.chart.record import Point
from sssgen.lab.measure.measurement import View, pictures_of
from sssgen.run.backends import Array
from sssgen.scene.measured import measured_scene
from sssgen.scene.pictures.images import encode_srgb

SIDE = 112
"""Pixels along each side of a picture."""
SAMPLES = 160
"""Of the reference, per ray and channel."""
ENLARGED = 2
GAP = 8
BACKGROUND = 0.05
BRIGHT = 0.7
"""The linear light of the brightest hundredth of the reference."""


@functools.cache
def _view(scene: str) -> View:
    """The scene with its reference, which is the same for all chains."""
    seen = dataclasses.replace(measured_scene.load(scene), size=(SIDE, SIDE))
    settings = charting.Settings(samples=SAMPLES)
    return charting.with_references({scene: [("picture", seen)]}, settings)[scene][0]


def beside_path_tracing(point: Point) -> Picture:
    """The chain of a point, and the path-traced scene, in the same scale."""
    view = _view(str(point["scene"]))
    drawn, reference = pictures_of(charting.candidate_of(point), charting.fit_of(point), view)
    scale = BRIGHT / max(float(np.percentile(reference[reference.any(axis=2)], 99)), 1e-3)
    pair = [_enlarged(encode_srgb(_with_background(one, reference, scale))) for one in (drawn, reference)]
    between = np.ones((pair[0].shape[0], GAP, 3))
    chain = " → ".join(point["chain"]) + (f" with {point['path']}" if point.get("path") else "")
    error = f"{point['error']['value']:.2f}"
    caption = f"What remains: the most accurate chain with this technique on a scene of the chart, {chain}, with the "
    caption += f"error {error} (left), and path traced (right, with its noise)"
    return Picture(np.concatenate([pair[0], between, pair[1]], axis=1), caption)


def _with_background(light: Array, reference: Array, scale: float) -> Array:
    covered = reference.any(axis=2, keepdims=True)
    return np.where(covered, light * scale, BACKGROUND)


def _enlarged(colors: Array) -> Array:
    return colors.repeat(ENLARGED, axis=0).repeat(ENLARGED, axis=1)
