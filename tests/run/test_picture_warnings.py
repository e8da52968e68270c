"""Pictures that show something else than what was meant: each has a warning at its line of the scene."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sssgen.material.baked import BakeFile
from sssgen.run.render.baked_body import check_body, check_lights
from sssgen.run.render.picture_warnings import exposure_warnings, warnings_of
from sssgen.scene import scene_loading
from sssgen.scene.body_identity import measures
from sssgen.scene.geometry import Ball, Mesh
from sssgen.scene.scene import Scene
from sssgen.support.diagnostics import SssgenError

SCENE = """material = "ice"
[geometry]
kind = "ball"
[camera]
position = [0.0, 0.0, 3.0]
target = [0.0, 0.0, 0.0]
[[light]]
direction = [0.0, 1.0, 0.0]
color = [1.0, 1.0, 1.0]
"""

MESH = """v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
f 1 3 2
f 1 2 4
f 2 3 4
f 3 1 4
"""


@pytest.fixture
def scene(tmp_path: Path) -> Callable[[str], Scene]:
    def load(text: str) -> Scene:
        (tmp_path / "body.obj").write_text(MESH)
        (tmp_path / "scene.toml").write_text(text)
        return scene_loading.load(tmp_path / "scene.toml")

    return load


def messages(scene: Scene, hit: bool = True, front: bool = True) -> list[tuple[str, int]]:
    shape = (2, 2)
    found = warnings_of(scene, np.full(shape, hit), np.full(shape, front))
    return [(warning.message, warning.span.line) for warning in found]


def test_a_picture_as_it_was_meant_has_no_warnings(scene: Callable[[str], Scene]) -> None:
    assert messages(scene(SCENE)) == []


def test_a_body_that_is_not_seen(scene: Callable[[str], Scene]) -> None:
    assert messages(scene(SCENE), hit=False) == [("the camera does not see the body", 6)]


def test_a_camera_in_the_body(scene: Callable[[str], Scene]) -> None:
    inside = scene(SCENE.replace("[0.0, 0.0, 3.0]", "[0.0, 0.0, 0.1]"))
    assert messages(inside) == [("the camera is inside the body", 5)]


def test_a_camera_in_a_mesh(scene: Callable[[str], Scene]) -> None:
    mesh = scene(SCENE.replace('kind = "ball"', 'kind = "mesh"\nfile = "body.obj"'))
    assert messages(mesh, front=False) == [("the camera is inside the body", 6)]
    assert messages(mesh) == []


def test_a_black_picture(scene: Callable[[str], Scene]) -> None:
    black, shown = np.zeros((2, 2, 3)), np.array([[True, False], [False, False]])
    (warning,) = exposure_warnings(scene(SCENE), black, shown)
    assert "no light reaches what the camera sees" in warning.message and warning.span.line == 7
    (warning,) = exposure_warnings(scene(SCENE[: SCENE.index("[[light]]")]), black, shown)
    assert warning.message == "the picture is black: the scene has no light"
    assert exposure_warnings(scene(SCENE), black, np.zeros((2, 2), bool)) == []
    assert exposure_warnings(scene(SCENE), black + 0.1, shown) == []


def test_a_white_picture(scene: Callable[[str], Scene]) -> None:
    color, shown = np.full((2, 20, 3), 3.0), np.ones((2, 20), bool)
    (warning,) = exposure_warnings(scene(SCENE), color, shown)
    assert warning.message.startswith("the picture is white: it is overexposed")
    color[:, :2, 2] = 0.9
    assert exposure_warnings(scene(SCENE), color, shown) == []


def test_a_black_light(scene: Callable[[str], Scene]) -> None:
    assert messages(scene(SCENE.replace("[1.0, 1.0, 1.0]", "[0.0, 0.0, 0.0]"))) == [("this light is black", 9)]


def sidecar(kind: str, triangles: int) -> BakeFile:
    return BakeFile(kind, "", {}, {}, {"mesh": {"triangles": triangles}})


def test_a_thickness_map_of_an_older_version_of_the_mesh_is_refused(tmp_path: Path) -> None:
    (tmp_path / "body.obj").write_text(MESH)
    (tmp_path / "edited.obj").write_text(MESH.replace("v 0 0 1", "v 0 0 1.1"))
    (tmp_path / "rounded.obj").write_text(MESH.replace("v 0 0 1", "v 0 0 0.999999"))
    body, edited, rounded = (Mesh(path=str(tmp_path / f"{name}.obj")) for name in ("body", "edited", "rounded"))
    noted = {"triangles": 4, **measures(body.triangles.places, body.triangles.corners)}
    for kind in ("thickness", "transmittance"):
        map_of_body = BakeFile(kind, "", {}, {}, {"mesh": noted})
        check_body(map_of_body, body, "t.png")
        check_body(map_of_body, rounded, "t.png")
        with pytest.raises(SssgenError, match=r"'t\.png' is baked for another mesh than edited\.obj"):
            check_body(map_of_body, edited, "t.png")


def test_a_thickness_map_of_another_mesh_is_refused(tmp_path: Path) -> None:
    (tmp_path / "body.obj").write_text(MESH)
    mesh = Mesh(path=str(tmp_path / "body.obj"))
    check_body(sidecar("thickness", 4), mesh, "t.png")
    check_body(sidecar("distance", 5), mesh, "d.npy")  # of a finer mesh of the same body
    check_body(sidecar("thickness", 5), Ball(), "t.png")
    with pytest.raises(SssgenError, match=r"'t\.png' is baked for a mesh of 5 triangles; body\.obj has 4"):
        check_body(sidecar("thickness", 5), mesh, "t.png")


@pytest.mark.parametrize("kind", ["thickness", "transmittance", "depth"])
def test_lengths_towards_another_light_are_refused(kind: str, scene: Callable[[str], Scene]) -> None:
    lights = scene(SCENE).lights
    check_lights(BakeFile(kind, "", {}, {}, {"light": {"direction": [0.0, 1.0, 0.0]}}), Ball(), lights, "t.png")
    check_lights(BakeFile(kind, "", {}, {}, {"light": None}), Ball(), lights, "t.png")
    other = BakeFile(kind, "", {}, {}, {"light": {"direction": [1.0, 0.0, 0.0]}})
    with pytest.raises(SssgenError, match=r"'t\.png' is baked for a light from \(1, 0, 0\)"):
        check_lights(other, Ball(), lights, "t.png")
