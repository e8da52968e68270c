"""Errors of chains under lights that are drawn at random, of lamps close by, of several, and of surroundings."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from oracle import close
from sssgen.lab.chart import drawn_lights
from sssgen.lab.chart.case_errors import errors, measure
from sssgen.lab.chart.charting import Settings, candidate_of, fit_of, two_views, with_references
from sssgen.lab.measure.measured_point import FittedChain
from sssgen.lab.measure.measurement import compared
from sssgen.scene.environment import Environment
from sssgen.scene.geometry import Capsule
from sssgen.scene.measured import measured_scene
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.scene import Light

pytestmark = pytest.mark.usefixtures("few_voxels")

EMPTY: FittedChain = {
    "role": "material", "name": "none", "label": "none", "baseline": False, "settings": {}, "chain": [],
    "parameters": {}, "scale": [1.0] * 3, "matte": [0.2] * 3, "factor": "", "training_error": 0.0,
}  # fmt: skip
RELIT: FittedChain = {**EMPTY, "chain": ["fluence_relit"], "label": "relit", "matte": [0.0] * 3}


def small_capsule(ior: float = 1.0) -> MeasuredScene:
    pytest.importorskip("mitsuba", reason="mitsuba is missing: pip install -e '.[reference]'")
    capsule = measured_scene.load("capsule")
    assert capsule.medium is not None
    return dataclasses.replace(capsule, size=(8, 6), medium=dataclasses.replace(capsule.medium, ior=ior))


def test_directions_are_uniform_and_the_first_ones_stay() -> None:
    directions = np.array(drawn_lights.directions(4000))
    close(np.linalg.norm(directions, axis=1), 1.0)
    close(directions.mean(axis=0), 0.0, atol=0.04)
    close(np.array(drawn_lights.directions(3)), directions[:3])


@pytest.mark.parametrize("ior", [1.0, pytest.param(1.4, marks=pytest.mark.slow)])
def test_each_light_is_measured_alone(ior: float) -> None:
    """Whether the references of the lights are traced together or one by one."""
    scene, settings = small_capsule(ior), Settings(samples=64, processes=0)
    views = drawn_lights.drawn_views([scene], 2, settings)[scene.key]
    measured = errors([scene], [EMPTY], {scene.key: drawn_lights.cases_of(views)}, settings)[scene.key][0]
    assert measured.worst == max(measured.values) and measured.median == np.mean(measured.values)
    for direction, value in zip(drawn_lights.directions(2), measured.values, strict=True):
        alone = dataclasses.replace(scene, lights=(Light(None, direction, (1.0, 1.0, 1.0)),))
        case = with_references({"": two_views(alone)}, settings._replace(samples=16))[""]
        assert value == pytest.approx(measure([(candidate_of(EMPTY), fit_of(EMPTY))], case)[0][0], rel=0.15)


@pytest.mark.slow
def test_lamps_are_at_one_radius_from_the_surface() -> None:
    scene = small_capsule()
    views = drawn_lights.lamp_views([scene], 3, Settings(samples=8, processes=0))[scene.key]
    geometry = scene.geometry
    for lamp in views[0].scene.lights:
        assert lamp.position is not None and isinstance(geometry, Capsule)
        place = geometry.to_object() @ [*lamp.position, 1.0]
        close(geometry.distance(place[None, :3]), geometry.radius + 0.5 * geometry.length, rtol=1e-5)


@pytest.mark.slow
def test_several_lights_have_one_volume_whose_light_is_their_sum() -> None:
    scene, settings = small_capsule(), Settings(samples=64, processes=0)
    views = drawn_lights.drawn_views([scene], 3, settings)[scene.key]
    assert len(drawn_lights.cases_of(views, 2)) == 1
    (both,) = drawn_lights.cases_of(views, 2)
    single = drawn_lights.cases_of(views)
    pictures = [_picture(case) for case in (*single[:2], both)]
    close(pictures[0] + pictures[1], pictures[2], rtol=2e-3)


def _picture(case: drawn_lights.Case) -> np.ndarray:
    values, problem = compared(candidate_of(RELIT), fit_of(RELIT), case[0])
    return values / problem.gain


@pytest.mark.slow
def test_even_surroundings_are_those_of_a_white_furnace() -> None:
    """The light that is scattered, and what is seen through the body."""
    scene = small_capsule()
    scattered, whole = drawn_lights.environment_cases(
        [scene], [Environment((1.0, 1.0, 1.0))], Settings(samples=64, processes=0)
    )
    assert scene.medium is not None
    for part, all_light in zip(scattered[scene.key][0], whole[scene.key][0], strict=True):
        (value,), (total,) = part.references, all_light.references
        assert (value[0] < total[0]).all() and total[0].max() <= 1.001
    measured = errors([scene], [RELIT], scattered, Settings(processes=0))[scene.key][0]
    assert measured.worst < 0.1 and np.isnan(measured.edge)
