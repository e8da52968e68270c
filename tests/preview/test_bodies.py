"""The bodies of the preview: meshes from the page's own bytes, shapes as large as the scene's body."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from sssgen.preview import bodies
from sssgen.preview.bodies import OWN_MESH, dropped_mesh, extent, fit, frame
from sssgen.preview.body_triangles import body_triangles
from sssgen.preview.page_frames import unpack
from sssgen.preview.page_messages import PageMessages
from sssgen.preview.pane import Pane
from sssgen.scene.geometry import Ball, Box, Mesh
from sssgen.support.diagnostics import SssgenError

pytest.importorskip("trimesh")

PYRAMID = """v 0 0 0
v 4 0 0
v 0 0 4
v 0 6 0
vt 0 0
vt 1 0
vt 0 1
f 1/1 3/2 4/3
f 1/1 4/2 2/3
f 1/1 2/2 3/3
f 2/1 4/2 3/3
"""
MATERIAL = '[material]\nname = "stone"\nshading = "lit"\n[[surface]]\ntechnique = "base_color"\n'


@pytest.fixture
def talk(tmp_path: Path) -> PageMessages:
    path = tmp_path / "stone.toml"
    path.write_text(MATERIAL, encoding="utf-8")
    return PageMessages(Pane(str(path)))


def corners(talk: PageMessages) -> np.ndarray:
    data = talk.piece(talk.messages()[0]["picture"]["body"])
    return np.frombuffer(data or b"", "<f4").reshape(-1, 8)


def test_the_ball_is_closed_and_has_its_normals_and_a_whole_turn_of_u() -> None:
    ball = body_triangles(Ball(radius=2.0))
    volume = np.einsum("nc,nc->", ball.position[:, 0], np.cross(ball.position[:, 1], ball.position[:, 2])) / 6.0
    assert volume == pytest.approx(4.0 / 3.0 * np.pi * 8.0, rel=2e-3)
    assert np.allclose(ball.normal * 2.0, ball.position)
    assert (ball.uv.min(), ball.uv.max()) == (0.0, 1.0) and np.ptp(ball.uv[..., 0], axis=1).max() < 0.01


def test_a_dropped_mesh_is_the_body_and_keeps_its_uv(talk: PageMessages) -> None:
    talk.answer({"kind": "mesh", "name": "pyramid.obj"}, PYRAMID.encode())
    picture = talk.messages()[0]["picture"]
    assert (picture["shape"], picture["mesh"]) == (OWN_MESH, "pyramid.obj") and OWN_MESH in picture["shapes"]
    assert {tuple(uv) for uv in corners(talk)[:, 6:].tolist()} == {(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)}
    matrix = np.array(picture["model"]).reshape(4, 4).T
    placed = corners(talk)[:, :3] @ matrix[:3, :3].T + matrix[:3, 3]
    assert np.ptp(placed, axis=0).max() == pytest.approx(2.0)  # the diameter of the scene's ball
    assert 0.5 * (placed.min(axis=0) + placed.max(axis=0)) == pytest.approx([0.0] * 3, abs=1e-6)


@pytest.mark.parametrize(
    ("name", "data", "message"),
    [
        ("a.obj", b"v 0 0 0\n", "holds no triangles"),
        ("a.glb", b"glTF and no more", "not a valid .glb"),
        ("a.glb", b"", "the file is empty"),
        ("a.exe", b"MZ", "not a mesh file's suffix"),
        ("../../x.png", PYRAMID.encode(), "not a mesh file's suffix"),
    ],
)
def test_a_faulty_mesh_is_refused_and_the_picture_stays(
    talk: PageMessages, name: str, data: bytes, message: str
) -> None:
    before = talk.messages()
    with pytest.raises(SssgenError, match=message):
        talk.answer({"kind": "mesh", "name": name}, data)
    assert talk.messages() == before


def test_a_dropped_mesh_reads_no_other_file(talk: PageMessages, tmp_path: Path) -> None:
    content = {
        "asset": {"version": "2.0"},
        "buffers": [{"uri": str(tmp_path / "secret.bin"), "byteLength": 36}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0}],
        "scenes": [{"nodes": [0]}],
    }
    triangle = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "<f4").tobytes()
    (tmp_path / "secret.bin").write_bytes(triangle)
    (tmp_path / "here.gltf").write_text(json.dumps(content), encoding="utf-8")
    assert len(Mesh(path=str(tmp_path / "here.gltf")).triangles.corners) == 1  # a file on disk may name others
    with pytest.raises(SssgenError, match="cannot be read"):
        talk.answer({"kind": "mesh", "name": "here.gltf"}, json.dumps(content).encode())


def test_too_many_triangles_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bodies, "MOST_TRIANGLES", 3)
    with pytest.raises(SssgenError, match="4 triangles"):
        dropped_mesh("pyramid.obj", PYRAMID.encode())


def test_shapes_are_as_large_as_the_scenes_body_and_wholly_seen() -> None:
    own = Box(size=(1.0, 4.0, 1.0), position=(5.0, 0.0, 0.0))
    shape = fit(Ball(radius=1.0), own)
    assert extent(shape).size == pytest.approx(4.0, rel=1e-3) and extent(shape).center == pytest.approx([5, 0, 0])
    eye, target = frame(shape, [0.0, 0.0, 3.0], 30.0)
    assert target == pytest.approx([5.0, 0.0, 0.0])
    assert np.degrees(np.arcsin(2.0 / (eye[2] - target[2]))) < 15.0 < np.degrees(np.arcsin(2.6 / eye[2]))


def test_a_frame_is_a_line_of_json_and_the_file() -> None:
    assert unpack(b'{"kind": "mesh"}\na\nb') == ({"kind": "mesh"}, b"a\nb")
    for faulty in (b"", b"[]\n", b"\xff\n", b"{" + b" " * (1 << 20) + b"}\n"):
        with pytest.raises(ValueError):
            unpack(faulty)
