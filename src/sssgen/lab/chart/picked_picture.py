"""The pictures of picked chains beside the path traced one."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from sssgen.jobs.executor import Item
from sssgen.lab.chart.charting import Settings, candidate_of, fit_of, results_of, with_references
from sssgen.lab.measure.measured_point import FittedChain
from sssgen.run.backends import Array
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.pictures.images import encode_srgb

SIDE = 160
"""Pixels along the longer side of each picture."""
SAMPLES = 128
"""The most samples of the path traced picture: its noise is seen, but not measured."""
GAP = 4
"""Pixels between both."""


def side_by_side(scene: MeasuredScene, chains: Sequence[FittedChain], settings: Settings) -> Array:
    """The path traced picture on the left, then those of the chains, exposed alike, as encoded sRGB.

    Shape (height, the widths with GAP between them, 3). Raises SssgenError as `charting.chart_record`.
    """
    scale = SIDE / max(scene.size)
    width, height = (max(8, round(scale * side)) for side in scene.size)
    larger = dataclasses.replace(scene, size=(width, height))
    few = settings._replace(samples=min(settings.samples, SAMPLES))
    (view,) = with_references({"": [("picture", larger)]}, few)[""]
    items = [
        Item(
            "sssgen.lab.measure.measurement:pictures_of",
            (candidate_of(chain), fit_of(chain), view),
            f"picture of {chain['label']}",
        )
        for chain in chains
    ]
    results = results_of(items, settings)
    between = np.ones((height, GAP, 3))
    parts = [encode_srgb(results[0][1])]
    for picture, _ in results:
        parts += [between, encode_srgb(picture)]
    return np.concatenate(parts, axis=1)
