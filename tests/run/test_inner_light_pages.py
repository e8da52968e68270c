"""The light inside a body that a page computes from a bake: its picture is that of NumPy."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import sssgen
from engine_cases import BLACK, ENGINES, pages
from relit_cases import EXAMPLES, drawn_by_numpy, linear_sky, turned, write_body, write_example
from skips import or_skip
from sssgen.run.backends.backend_interface import VERTEX_SIZE
from sssgen.run.backends.engine_page import EngineDrawing, EnginePage
from sssgen.run.render import inner_light, page_values
from sssgen.scene import scene_loading
from sssgen.scene.arrays import Array
from sssgen.scene.geometry import Mesh
from sssgen.scene.light_response import Incoming, LightResponse, from_light
from sssgen.scene.scene import Light

FROM_ABOVE = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)
"""The light of a hemispheric lamp, and of an environment whose upper half is white."""
SKY = (0.22, 0.25, 0.3), (0.08, 0.06, 0.05)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("relit")
    write_body(folder)
    return folder


@pytest.fixture(scope="module")
def refracting(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("refracting")
    write_body(folder, 1.4)
    return folder


@pytest.fixture(scope="module", params=pages(("threejs", "webgpu")))
def page(request: pytest.FixtureRequest) -> Iterator[EnginePage]:
    target, name = request.param
    renderer: EnginePage = or_skip(partial(EnginePage, ENGINES[target], seconds=400.0), name)
    yield renderer
    renderer.page.close()


def like_playcanvas(response: LightResponse, light: Light, to_object: Array) -> Incoming:
    """A lamp with PlayCanvas's fall-off within the range of the page's lamps."""
    incoming = from_light(response, light, to_object)
    if light.position is None:
        return incoming
    square = light.color[0] / incoming.irradiance[:, :1]
    share = 16.0 / (square + 1.0) * np.clip(1.0 - (square / 50.0**2) ** 2, 0.0, 1.0) ** 2
    return incoming._replace(irradiance=np.array([light.color]) * share)


def check(page: EnginePage, folder: Path, within: float, **changes: Any) -> None:
    """The page's picture of the scene is NumPy's, on 95 % of the body's pixels: the picture of the eye's layers is
    coarse at the silhouette. `changes`: of the scene; `stage` is the page's. `bones`: what two bones do to the body,
    which then stands where they bring it back."""
    target = page.engine.target
    stage = {"stage": changes.pop("stage")} if "stage" in changes else {}
    bones: Array = changes.pop("bones", np.eye(4))
    scene, placed, expected = drawn_by_numpy(folder, **changes)
    body, shell = scene.geometry, placed.shell
    assert isinstance(body, Mesh)
    vertices = np.zeros((len(body.triangles.places), VERTEX_SIZE), np.float32)
    vertices[:, :3], vertices[:, 3:6] = body.triangles.places, body.triangles.normals
    response = {
        "response": base64.b64encode((folder / "body.bin").read_bytes()).decode(),
        "facts": json.loads((folder / "body.bin.json").read_text("utf-8")),
    }
    drawing = EngineDrawing(
        page_values.modules_of(sssgen.compile(scene.material, target)), placed.size, vertices, body.triangles.corners,
        placed.shell.view_projection, shell.camera_position, shell.model @ np.linalg.inv(bones),
        shell.light_positions, shell.light_colors,
        ambient=shell.ambient, properties=BLACK[target] | {"innerLight": response} | stage,
    )  # fmt: skip
    differences = np.abs(page.draw(drawing) - expected)[..., :3].max(axis=-1)[placed.hit]
    reached = 255.0 * float(np.quantile(differences, 0.95))
    title = f"{folder.name}, {target}, {page.name}"
    print(f"{title}: {reached:.2f}/255 on 95 % of the pixels, of light up to {expected.max():.2f}")
    assert np.median(expected[placed.hit][:, :3].max(axis=-1)) > 0.1
    assert reached <= within


def test_two_lamps_and_ambient_light(page: EnginePage, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """PlayCanvas's light is brighter, and so is the deviation."""
    other_fall = page.engine.target == "playcanvas"
    if other_fall:
        monkeypatch.setattr(inner_light, "from_light", like_playcanvas)
    check(page, folder, 3.0 if other_fall else 1.0)


def test_a_refracting_surface(page: EnginePage, refracting: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The index and the distance from the surface come from the file."""
    other_fall = page.engine.target == "playcanvas"
    if other_fall:
        monkeypatch.setattr(inner_light, "from_light", like_playcanvas)
    check(page, refracting, 4.0 if other_fall else 2.0)


def test_light_from_above(page: EnginePage, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A hemispheric light; in PlayCanvas an environment, whose texels come later."""
    monkeypatch.setattr(inner_light, "surroundings", linear_sky(FROM_ABOVE))
    check(page, folder, 1.5, lights=(), ambient=(0.0, 0.0, 0.0), stage={"around": "hemisphere", "later": True})


@pytest.mark.slow
@pytest.mark.parametrize("angle", [0.0, 130.0])
def test_bones_that_turn_the_whole_body(
    page: EnginePage, folder: Path, refracting: Path, angle: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A skinned body that its bones do not bend is lit as one without bones in the same place."""
    if page.engine.target != "threejs":
        pytest.skip("this engine does not know the rest pose yet")
    monkeypatch.setattr(inner_light, "surroundings", linear_sky(SKY))
    around = np.radians(angle) * np.array([0.3, -0.8, 0.52])
    bones = np.eye(4)
    bones[:3, :3] = Rotation.from_rotvec(around).as_matrix()
    bones[:3, 3] = np.sin(np.radians(angle)) * np.array([0.4, -0.1, 0.2])
    stage: dict[str, Any] = {"around": "hemisphere", "above": SKY[0], "below": SKY[1]}
    stage["bones"] = {"weights": [0.3] * 512, "matrices": [bones.T.ravel().tolist()] * 2}
    for body, within in ((folder, 1.0), (refracting, 2.0)):
        check(page, body, within, ambient=(0.0, 0.0, 0.0), stage=stage, bones=bones)


@pytest.fixture(scope="module", params=EXAMPLES)
def example(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    folder = tmp_path_factory.mktemp(request.param)
    write_example(request.param, folder)
    return request.param, folder


@pytest.mark.slow
def test_an_example_under_lamps_that_move(
    page: EnginePage, example: tuple[str, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Before and behind their move, in one scene of the page, which has a sky, too."""
    name, folder = example
    if page.engine.target != "threejs":
        pytest.skip("the ring covers this engine; the examples take minutes, and are drawn in three.js and Godot")
    monkeypatch.setattr(inner_light, "surroundings", linear_sky(SKY))
    lights = scene_loading.load(str(folder / "scene.toml")).lights
    stage: dict[str, Any] = {"around": "hemisphere", "above": SKY[0], "below": SKY[1]}
    changes: dict[str, Any] = {"ambient": (0.0, 0.0, 0.0), "size": EXAMPLES[name]}
    check(page, folder, 1.0, **changes, lights=lights, stage=stage)
    before = [light.position or light.direction for light in lights]
    check(page, folder, 1.0, **changes, lights=turned(lights, 2.0), stage=stage | {"before": before})
