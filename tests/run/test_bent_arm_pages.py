"""An arm that an engine of the web bends by skinning: its light inside is the lab's, which turns voxels itself."""

from __future__ import annotations

import base64
import dataclasses
import json
from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np
import pytest

import sssgen
from engine_cases import BLACK
from relit_cases import MATERIAL
from skips import or_skip
from sssgen.bake import baked_files, relit
from sssgen.lab.chart import bent_arm
from sssgen.lab.chart.charting import candidate_of, fit_of
from sssgen.lab.fluence import fluence_field as field
from sssgen.lab.measure import fluence_inputs
from sssgen.lab.measure.measured_point import FittedChain
from sssgen.lab.measure.measurement import View
from sssgen.run.backends.backend_interface import VERTEX_SIZE
from sssgen.run.backends.engine_page import EngineDrawing, EnginePage
from sssgen.run.backends.web_engines import BABYLON, PLAYCANVAS, THREE
from sssgen.run.render import page_values
from sssgen.scene.measured import measured_scene
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.view_points import points
from sssgen.scene.scene import Light

SIZE = (96, 72)
RELIT: FittedChain = {
    "role": "material", "name": "relit", "label": "relit", "baseline": False, "settings": {},
    "chain": ["fluence_relit"], "parameters": {}, "scale": [1.0] * 3, "matte": [0.0] * 3, "factor": "",
    "training_error": 0.0,
}  # fmt: skip
LIGHTS = ((0.9, 0.3, -0.3), (-0.5, 0.3, 0.8))
"""Towards it: in the plane of the bend, and in front of the arm."""
pytestmark = pytest.mark.slow


@pytest.fixture(
    scope="module",
    params=[(engine, renderer) for engine in (THREE, BABYLON, PLAYCANVAS) for renderer in engine.renderers],
    ids=lambda param: f"{param[0].title}, {param[1]}",
)
def page(request: pytest.FixtureRequest) -> Iterator[EnginePage]:
    engine, name = request.param
    renderer: EnginePage = or_skip(partial(EnginePage, engine, seconds=400.0), name)
    yield renderer
    renderer.page.close()


@pytest.fixture(scope="module")
def baked(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[MeasuredScene, dict[str, Any], str]]:
    """The arm at rest, its bake as a page takes it, and the file of its material; the lab's volume is as coarse."""
    pytest.importorskip("trimesh", reason="trimesh is missing: pip install -e '.[bake]'")
    folder = tmp_path_factory.mktemp("arm")
    (folder / "relit.toml").write_text(MATERIAL, "utf-8")
    medium = measured_scene.load("capsule").medium
    assert medium is not None
    mesh = bent_arm.pose(0.0).mesh()
    assert mesh.data is not None
    (folder / "arm.obj").write_bytes(mesh.data)
    geometry = dataclasses.replace(mesh, path=str(folder / "arm.obj"))
    rest = dataclasses.replace(bent_arm.scene(0.0, medium), geometry=geometry, size=SIZE)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(field, "settings_for", lambda _: field.Settings(voxels=16, side=8, photons=4000))
        data, facts = relit.bake(rest.body_alone(), fluence_inputs.RANK, field.settings_for(rest), processes=0)
        baked_files.write_response(str(folder / "arm.bin"), data, facts)
        described = json.loads((folder / "arm.bin.json").read_text("utf-8"))
        yield rest, {"response": base64.b64encode(data).decode(), "facts": described}, str(folder / "relit.toml")


@pytest.mark.parametrize("degrees", [0.0, 60.0, 90.0])
@pytest.mark.parametrize("towards", LIGHTS)
def test_a_bent_arm(
    page: EnginePage, baked: tuple[MeasuredScene, dict[str, Any], str], degrees: float,
    towards: tuple[float, float, float],
) -> None:  # fmt: skip
    rest, response, material = baked
    arm, way = bent_arm.pose(degrees), np.array(towards) / np.linalg.norm(towards)
    light = Light(None, tuple(map(float, way)), (2.0, 1.6, 1.2))
    assert rest.medium is not None
    scene = dataclasses.replace(bent_arm.scene(degrees, rest.medium), size=SIZE, lights=(light,))
    seen = points(scene)
    nothing = np.zeros((3, seen.count))  # in place of the reference, which sets the exposure
    values, problem = bent_arm.values_at_rest(
        candidate_of(RELIT), fit_of(RELIT), degrees, rest, View("arm", scene, ((nothing, nothing),))
    )
    expected = values / problem.gain
    drawn = page.draw(_drawing(page, arm, scene, material, response))[seen.valid][:, :3].T
    differences = 255.0 * np.abs(drawn - expected).max(axis=0)
    reached = float(np.quantile(differences, 0.95))
    print(f"arm at {degrees:g} degrees, {page.name}: {reached:.2f}/255 on 95 % of the pixels")
    assert np.median(expected.max(axis=0)) > 0.1
    assert reached <= 1.0


def _drawing(
    page: EnginePage, arm: bent_arm.Pose, scene: MeasuredScene, material: str, response: dict[str, Any]
) -> EngineDrawing:
    """The arm at rest with two bones, which bend it."""
    angle = np.radians(arm.degrees)
    bent = np.eye(4)
    bent[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    matrices = [matrix.T.ravel().tolist() for matrix in (np.eye(4), bent)]
    vertices = np.zeros((len(arm.rest), VERTEX_SIZE), np.float32)
    vertices[:, :3], vertices[:, 3:6] = arm.rest, arm.rest * [1.0, 0.0, 1.0]
    (light,) = scene.lights
    assert light.direction is not None
    stage = {"bones": {"weights": arm.weights(arm.rest).tolist(), "matrices": matrices}}
    return EngineDrawing(
        page_values.modules_of(sssgen.compile(material, page.engine.target)), SIZE, vertices, arm.corners,
        scene.camera.view_projection(SIZE[0] / SIZE[1]), scene.camera.position, np.eye(4),
        np.array([[*light.direction, 0.0]]), np.array([light.color]),
        properties=BLACK[page.engine.target] | {"innerLight": response, "stage": stage},
    )  # fmt: skip
