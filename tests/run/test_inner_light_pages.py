"""The light inside a body that a page computes from a bake: its picture is that of NumPy."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import sssgen
from engine_cases import BLACK, ENGINES
from relit_cases import drawn_by_numpy, write_body
from skips import or_skip
from sssgen.run.backends.backend_interface import VERTEX_SIZE
from sssgen.run.backends.engine_page import EngineDrawing, EnginePage
from sssgen.run.backends.web_engines import THREE
from sssgen.run.render import page_values
from sssgen.scene.geometry import Mesh


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("relit")
    write_body(folder)
    return folder


@pytest.fixture(scope="module", params=list(THREE.renderers))
def page(request: pytest.FixtureRequest) -> Iterator[EnginePage]:
    renderer: EnginePage = or_skip(partial(EnginePage, ENGINES["threejs"], seconds=400.0), request.param)
    yield renderer
    renderer.page.close()


def test_two_lamps_and_ambient_light(page: EnginePage, folder: Path) -> None:
    """Within 1/255 on 95 % of the body's pixels: the picture of the eye's layers is coarse at the silhouette."""
    scene, placed, expected = drawn_by_numpy(folder)
    body, shell = scene.geometry, placed.shell
    assert isinstance(body, Mesh)
    compiled = sssgen.compile(scene.material, "threejs")
    vertices = np.zeros((len(body.triangles.places), VERTEX_SIZE), np.float32)
    vertices[:, :3], vertices[:, 3:6] = body.triangles.places, body.triangles.normals
    response = {
        "response": base64.b64encode((folder / "body.bin").read_bytes()).decode(),
        "facts": json.loads((folder / "body.bin.json").read_text("utf-8")),
    }
    drawing = EngineDrawing(
        page_values.modules_of(compiled), placed.size, vertices, body.triangles.corners, placed.shell.view_projection,
        shell.camera_position, shell.model, shell.light_positions, shell.light_colors, ambient=shell.ambient,
        properties=BLACK["threejs"] | {"innerLight": response},
    )  # fmt: skip
    picture = page.draw(drawing)
    differences = np.abs(picture - expected)[..., :3].max(axis=-1)[placed.hit]
    reached = 255.0 * float(np.quantile(differences, 0.95))
    print(f"{page.name}: {reached:.2f}/255 on 95 % of the pixels, of light up to {expected.max():.2f}")
    assert np.median(expected[placed.hit][:, :3]) > 0.1
    assert reached <= 1.0
