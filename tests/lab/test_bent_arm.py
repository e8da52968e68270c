"""The arm that is bent by skinning, and the volume of its rest pose."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from oracle import close
from sssgen.lab.chart import bent_arm
from sssgen.lab.chart.charting import Settings, candidate_of, fit_of
from sssgen.lab.chart.drawn_lights import cases_of, drawn_views
from sssgen.lab.measure import fluence_inputs
from sssgen.lab.measure.measured_point import FittedChain
from sssgen.lab.measure.measurement import compared
from sssgen.scene.geometry_mesh import mesh_of
from sssgen.scene.measured import measured_scene

pytestmark = pytest.mark.usefixtures("few_voxels")

RELIT: FittedChain = {
    "role": "material", "name": "relit", "label": "relit", "baseline": False, "settings": {},
    "chain": ["fluence_relit"], "parameters": {}, "scale": [1.0] * 3, "matte": [0.0] * 3, "factor": "",
    "training_error": 0.0,
}  # fmt: skip


@pytest.mark.parametrize("degrees", [0.0, 60.0, 90.0])
def test_a_bone_alone_turns_and_the_other_stays(degrees: float) -> None:
    arm, angle = bent_arm.pose(degrees), np.radians(degrees)
    first, second = (sign * arm.rest[:, 1] >= bent_arm.BLENDED for sign in (-1.0, 1.0))
    close(arm.places[first], arm.rest[first])
    close(np.linalg.norm(arm.places[second], axis=1), np.linalg.norm(arm.rest[second], axis=1))
    top = arm.places[np.argmax(arm.rest[:, 1])]
    close(top, arm.rest[:, 1].max() * np.array([-np.sin(angle), np.cos(angle), 0.0]), atol=1e-9)
    close(arm.turned_back(arm.places[second], arm.rest[second]), arm.rest[second], atol=1e-9)


def test_the_mesh_is_closed_and_its_faces_look_outward() -> None:
    vertices, faces = mesh_of(bent_arm.pose(90.0).mesh())
    first, second, third = np.moveaxis(vertices[faces], 1, 0)
    # a capsule has about this volume, and skinning changes it little
    whole = np.pi * bent_arm.RADIUS**2 * (2.0 * bent_arm.REACH + 4.0 / 3.0 * bent_arm.RADIUS)
    close(np.einsum("nc,nc->n", first, np.cross(second, third)).sum() / 6.0, whole, rtol=0.1)


@pytest.mark.slow
def test_the_straight_arm_reads_its_own_volume() -> None:
    pytest.importorskip("mitsuba", reason="mitsuba is missing: pip install -e '.[reference]'")
    medium = measured_scene.load("capsule").medium
    assert medium is not None
    rest = dataclasses.replace(bent_arm.scene(0.0, medium), size=(12, 12))
    fluence_inputs.prepare(rest, "", 0, lambda *_: None)
    (case,) = cases_of(drawn_views([rest], 1, Settings(samples=64, processes=0))[rest.key])
    candidate, fit = candidate_of(RELIT), fit_of(RELIT)
    values, problem = bent_arm.values_at_rest(candidate, fit, 0.0, rest, case[0])
    own, _ = compared(candidate, fit, case[0])
    assert own.max() > 0.1
    # the places that rays meet are computed in single precision
    close(values, own, rtol=1e-3, atol=1e-4)
    assert np.isfinite(problem.target).all()
