"""Errors of chains under lights that are drawn at random."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from oracle import close
from sssgen.lab.chart import drawn_lights
from sssgen.lab.chart.charting import Settings, candidate_of, fit_of, two_views, with_references
from sssgen.lab.measure.measured_point import FittedChain
from sssgen.lab.measure.measurement import measure_candidate
from sssgen.scene.measured import measured_scene
from sssgen.scene.scene import Light

EMPTY: FittedChain = {
    "role": "material", "name": "none", "label": "none", "baseline": False, "settings": {}, "chain": [],
    "parameters": {}, "scale": [1.0] * 3, "matte": [0.2] * 3, "factor": "", "training_error": 0.0,
}  # fmt: skip


def test_directions_are_uniform_and_the_first_ones_stay() -> None:
    directions = np.array(drawn_lights.directions(4000))
    close(np.linalg.norm(directions, axis=1), 1.0)
    close(directions.mean(axis=0), 0.0, atol=0.04)
    close(np.array(drawn_lights.directions(3)), directions[:3])


@pytest.mark.parametrize("ior", [1.0, 1.4])
def test_each_light_is_measured_alone(ior: float) -> None:
    """Whether the references of the lights are traced together or one by one."""
    pytest.importorskip("mitsuba", reason="mitsuba is missing: pip install -e '.[reference]'")
    capsule = measured_scene.load("capsule")
    assert capsule.medium is not None
    scene = dataclasses.replace(capsule, size=(8, 6), medium=dataclasses.replace(capsule.medium, ior=ior))
    settings = Settings(samples=64, processes=0)
    measured = drawn_lights.errors([scene], {scene.key: [EMPTY]}, 2, settings)[scene.key][0]
    assert measured.worst == max(measured.values) and measured.median == np.mean(measured.values)
    for direction, value in zip(drawn_lights.directions(2), measured.values, strict=True):
        alone = dataclasses.replace(scene, lights=(Light(None, direction, (1.0, 1.0, 1.0)),))
        views = with_references({"": two_views(alone)}, settings._replace(samples=16))[""]
        point = measure_candidate(candidate_of(EMPTY), fit_of(EMPTY), views)
        assert value == pytest.approx(point["error"]["value"], rel=0.15)
