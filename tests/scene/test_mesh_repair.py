"""Seams of rounding are no holes, and triangles that face the other way are turned."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from sssgen.scene.geometry_mesh import is_closed
from sssgen.scene.mesh import Mesh
from sssgen.scene.mesh_distance import volume_of
from sssgen.scene.mesh_repair import flipped, has_inside, welded

pytest.importorskip("igl")
trimesh = pytest.importorskip("trimesh")
BALL = trimesh.creation.icosphere(2)


def soup(noise: float) -> tuple[np.ndarray, np.ndarray]:
    """The ball with own corners for each triangle, which differ by noise."""
    corners = BALL.vertices[BALL.faces].reshape(-1, 3)
    moved = corners + noise * np.random.default_rng(0).uniform(-1.0, 1.0, corners.shape)
    return moved, np.arange(len(moved)).reshape(-1, 3)


def write(path: Path, vertices: np.ndarray, faces: np.ndarray) -> Mesh:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]
    path.write_text("\n".join(lines), encoding="utf-8")
    return Mesh(path=str(path))


@pytest.mark.parametrize("noise", [0.0, 2e-16, 1e-7])
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e5])
def test_a_seam_of_rounding_is_no_hole(noise: float, scale: float) -> None:
    vertices, faces = soup(noise)
    places, place_of = welded(scale * vertices, faces)
    assert len(places) == len(BALL.vertices) and has_inside(place_of[faces])
    assert np.abs(places[place_of] - scale * vertices).max() <= 1e-5 * scale


def test_details_and_holes_stay() -> None:
    vertices, faces = soup(1e-3)
    assert len(welded(vertices, faces)[0]) == len(vertices)
    places, place_of = welded(BALL.vertices, BALL.faces[1:])
    assert len(places) == len(BALL.vertices) and not has_inside(place_of[BALL.faces[1:]])


def test_a_fine_open_mesh_is_not_merged() -> None:
    points = np.random.default_rng(1).uniform(0.0, 1.0, (30000, 3))
    faces = np.arange(30000).reshape(-1, 3)
    assert len(welded(points, faces)[0]) > 29990


def test_the_smaller_part_is_turned(tmp_path: Path) -> None:
    faces = BALL.faces.copy()
    wrong = np.zeros(len(faces), bool)
    wrong[[3, 50, 51, 200]] = True
    faces[wrong] = faces[wrong][:, ::-1]
    assert (flipped(faces, np.ones(len(faces))) == wrong).all()
    mesh = write(tmp_path / "mixed.obj", BALL.vertices, faces)
    assert mesh.triangles.turned == 4 and is_closed(mesh) and not mesh.inside_out
    assert volume_of(mesh.triangles.places, mesh.triangles.corners) == pytest.approx(BALL.volume)
    outwards = (mesh.triangles.flat * mesh.triangles.places[mesh.triangles.corners].mean(axis=1)).sum(axis=1)
    assert (outwards > 0.9).all()


def test_a_strip_without_sides_stays_as_it_is(tmp_path: Path) -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
    across = np.stack([np.cos(angle / 2) * np.cos(angle), np.cos(angle / 2) * np.sin(angle), np.sin(angle / 2)], axis=1)
    middle = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    low, high = np.arange(40), np.arange(40) + 40
    next_low, next_high = np.r_[low[1:], high[0]], np.r_[high[1:], low[0]]
    faces = np.r_[np.c_[low, high, next_high], np.c_[low, next_high, next_low]]
    strip = write(tmp_path / "strip.obj", np.r_[middle + 0.3 * across, middle - 0.3 * across], faces)
    assert strip.triangles.turned == 0 and not is_closed(strip)


def test_a_mesh_that_is_inside_out_is_that_of_its_other_side(tmp_path: Path) -> None:
    """It is turned with its normals, whether these face as its triangles do or outwards; an open mesh stays."""
    ball = trimesh.creation.icosphere(2)
    inverted = ball.copy()
    inverted.invert()
    for name, normals in (("along", inverted.vertex_normals), ("outwards", ball.vertex_normals)):
        mesh = trimesh.Trimesh(inverted.vertices, inverted.faces, vertex_normals=normals, process=False)
        path = tmp_path / f"{name}.glb"
        mesh.export(path, include_normals=True)
        triangles = Mesh(path=str(path)).triangles
        middle = triangles.places[triangles.corners].mean(axis=1)
        assert triangles.reversed and triangles.own_normals is not None
        for directions in (triangles.flat, triangles.own_normals.mean(axis=1)):
            assert (np.einsum("fc,fc->f", directions, middle) > 0.0).all()
        assert (np.einsum("vc,vc->v", triangles.normals, triangles.places) > 0.0).all()
    half = trimesh.Trimesh(inverted.vertices, inverted.faces[inverted.triangles_center[:, 2] > 0.0])
    half.export(tmp_path / "half.stl")
    assert not Mesh(path=str(tmp_path / "half.stl")).triangles.reversed
