"""The passes of a material in a program with moderngl, compared with rays that are cast on the CPU."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sssgen
from skips import or_skip
from sssgen.ir.frame_passes import BACK_FACES, EYE_LAYERS, FAR
from sssgen.run import backends
from sssgen.run.backends import Array
from sssgen.run.backends.backend_interface import VERTEX_SIZE
from sssgen.run.moderngl_passes import SIDE, Body, Passes
from sssgen.scene.camera import Camera
from sssgen.scene.drawn_views import eye_layers, light_layers, matt_light
from sssgen.scene.solids import Torus
from torus_cases import PICTURES, torus_mesh

SIZE = (160, 120)
CAMERA = Camera((0.2, 0.5, 4.0), (0.0, 0.0, 0.0), 34.0)
LIGHTS = [((1.6, -0.4, -1.4, 1.0), (4.0, 2.0, 1.0)), ((0.96, 0.0, 0.28, 0.0), (0.2, 0.3, 0.6))]
TORUS = Torus(0.78, 0.3, rotation=(116.0, 0.0, 12.0), scale=1.2, position=(0.1, 0.0, -0.1))
LAYERED = """
[material]
name = "made"

[translucency]
technique = "fluence_fixed_layers"
"""


@pytest.fixture(scope="module")
def context() -> Iterator[Any]:
    context = or_skip(backends.require, "gl").context
    with context:
        yield context


class Pictures:
    """What the passes draw of a torus."""

    def __init__(self, context: Any, folder: Path, material: str, torus: Torus = TORUS) -> None:
        (folder / "made.toml").write_text(material, encoding="utf-8")
        reflection = sssgen.compile(str(folder / "made.toml"), "glsl-330").reflection
        self.torus = torus
        vertices, triangles = torus_mesh(self.torus)
        vertices = vertices.reshape(-1, VERTEX_SIZE)
        body = Body(context, vertices[:, :3], vertices[:, 3:6], triangles, self.torus.to_world())
        projection = CAMERA.view_projection(SIZE[0] / SIZE[1]) @ np.linalg.inv(CAMERA.view())
        passes = Passes(context, reflection)
        for _ in range(2):  # the second frame has the pictures of the first
            drawn = passes.draw(body, CAMERA.view(), projection, LIGHTS, (0.05, 0.1, 0.2), SIZE)
        self.values = drawn.values
        self.pictures = {name: self.texels(texture) for name, texture in drawn.textures.items()}

    @staticmethod
    def texels(texture: Any) -> Array:
        """(rows, columns, channels)."""
        width, height = texture.size
        result: Array = np.frombuffer(texture.read(), np.float32).reshape(height, width, -1)
        return result


@pytest.fixture(scope="module")
def pictures(context: Any, tmp_path_factory: pytest.TempPathFactory) -> Pictures:
    return Pictures(context, tmp_path_factory.mktemp("passes"), PICTURES)


def test_back_faces(pictures: Pictures) -> None:
    origin, directions = CAMERA.rays(*SIZE)
    expected = eye_layers(pictures.torus, origin, directions, BACK_FACES).reshape(SIZE[1], SIZE[0])
    picture = pictures.pictures["back_face_map"][..., 0]
    assert (expected > 0.0).sum() > 2000
    assert np.quantile(np.abs(picture - expected), 0.98) < 2e-3
    assert ((picture > 0.0) == (expected > 0.0)).mean() > 0.98


def test_eye_layers(context: Any, tmp_path: Path) -> None:
    pictures = Pictures(context, tmp_path, LAYERED, Torus(0.78, 0.3, rotation=(-8.0, 0.0, 12.0), scale=1.2))
    origin, directions = CAMERA.rays(*SIZE)
    expected = eye_layers(pictures.torus, origin, directions, EYE_LAYERS).reshape(SIZE[1], SIZE[0], 3)
    picture = pictures.pictures["eye_layer_map"][..., :3]
    for layer in range(3):
        there = expected[..., layer] < FAR
        assert there.sum() > 500
        assert ((picture[..., layer] < FAR) == there).mean() > 0.98
        assert np.quantile(np.abs(picture - expected)[..., layer][there], 0.97) < 4e-3


def test_layers_of_two_lights(pictures: Pictures) -> None:
    layers = ("entry 1", "exit 1", "entry 2", "exit 2")
    matrices, expected = light_layers(pictures.torus, np.array([light for light, _ in LIGHTS]), layers)
    picture = pictures.pictures["light_layer_map"]
    for name, matrix in zip(("light_matrix", "light_matrix_2"), matrices, strict=True):
        np.testing.assert_allclose(pictures.values[name], matrix, atol=1e-6)
    assert not pictures.values["light_matrix_3"].any()
    step, seconds = picture.shape[0] // expected.shape[0], 0
    for column in range(2):
        own = picture[:SIDE, column * SIDE : (column + 1) * SIDE][step // 2 :: step, step // 2 :: step]
        side = expected.shape[0] // 2
        other = expected[:side, column * side : (column + 1) * side]
        # beside a surface one has the end of the body for this light, the other that for all lights
        surface = other < other.max() - 1e-3
        assert surface[..., 0].sum() > 1000
        seconds += surface[..., 3].sum()
        # the texels of the larger picture lie beside those of the smaller one
        assert np.quantile(np.abs(own - other)[surface], 0.9) < 0.02
        assert ((own < own.max() - 1e-3) == surface).mean() > 0.97
    assert seconds > 1000


def test_light_on_a_white_body(pictures: Pictures) -> None:
    origin, directions = CAMERA.rays(*SIZE)
    hits = pictures.torus.hits(origin, directions)
    positions, colors = (np.array(part) for part in zip(*LIGHTS, strict=True))
    expected = matt_light(pictures.torus, hits.position[hits.hit], hits.normal[hits.hit], positions, colors)
    expected += (0.05, 0.1, 0.2)
    picture = pictures.pictures["matt_light_map"].reshape(-1, 4)[hits.hit]
    # the body does not shadow itself here: it does in few places of the ring
    assert np.quantile(np.abs(picture[:, :3] - expected).max(axis=1), 0.6) < 0.01
    assert (picture[:, :3] > expected - 0.02).mean() > 0.97
    matrix = pictures.values["eye_matrix"]
    depth = hits.position[hits.hit] @ matrix[2, :3] + matrix[2, 3]
    assert np.quantile(np.abs(picture[:, 3] - depth), 0.98) < 5e-3
    assert (pictures.pictures["matt_light_map"].reshape(-1, 4)[~hits.hit, 3] > 100.0).mean() > 0.98
