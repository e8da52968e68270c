"""The mean length inside a mesh as an integral over its triangles, against closed forms, quadrature and rays."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import bake_meshes as meshes
from bake_meshes import SPOT, Array, MeshData, by_quadrature, needs_meshes, write

pytest.importorskip("trimesh", reason="trimesh is missing: pip install -e '.[bake]'")
pytest.importorskip("embreex", reason="embreex is missing: pip install -e '.[bake]'")
pytest.importorskip("scipy", reason="SciPy is missing: pip install -e '.[bake]'")

from sssgen.bake.atlas import atlas
from sssgen.bake.chord_lengths import inward, mean
from sssgen.bake.mean_length import MeanLength, in_halves
from sssgen.scene.inside_intervals import alternate
from sssgen.scene.mesh import Mesh

pytestmark = pytest.mark.usefixtures("in_folder")


def middles(mesh: MeshData) -> tuple[Array, Array]:
    """The centres of the triangles, and their normals."""
    triangles = mesh.triangles
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return triangles.mean(axis=1), normals / np.linalg.norm(normals, axis=1, keepdims=True)


def test_a_ball_is_four_thirds_of_its_radius() -> None:
    ball = meshes.icosphere(0.8, 5)
    value, error = MeanLength(ball.vertices, ball.faces).at(*(part[::40] for part in middles(ball)))
    assert value == pytest.approx(np.full(len(value), 4.0 / 3.0 * 0.8), rel=1e-3)
    assert 0.0 < error.max() < 0.01


@pytest.mark.parametrize("size", [(1.0, 1.4, 0.6), (2.0, 0.05, 2.0)])
def test_a_box_is_in_closed_form(size: tuple[float, float, float]) -> None:
    """Its 12 triangles are all near; points next to an edge see a triangle from next to its plane."""
    mesh = meshes.box(size)
    generator = np.random.default_rng(3)
    faces = np.arange(0, 12, 3)
    weights = generator.dirichlet((0.3, 0.3, 0.3), len(faces))
    places, normals = np.einsum("nv,nvc->nc", weights, mesh.triangles[faces]), middles(mesh)[1][faces]
    value, _ = MeanLength(mesh.vertices, mesh.faces).at(places, normals)
    expected = [
        by_quadrature(np.array(size), place, normal, np.asarray, 700)
        for place, normal in zip(places, normals, strict=True)
    ]
    assert value == pytest.approx(np.array(expected), rel=5e-3)


def test_groups_hold_every_point_once_and_are_small() -> None:
    points = np.random.default_rng(1).uniform(size=(1000, 3)) * (4.0, 1.0, 1.0)
    groups = in_halves(points, 70)
    assert groups.shape[1] <= 70 and len(groups) == 16
    assert np.sort(groups.ravel()).tolist() == list(range(groups.size)) and groups.size - 1000 < len(groups)
    sides = np.ptp(points[np.minimum(groups, 999)], axis=1)
    assert np.median(sides[:, 0]) < 1.0


def test_rays_alternate_where_parts_do_not_overlap() -> None:
    ball, way = meshes.icosphere(1.0, 3), np.array([[1.0, 0.02, 0.01]]) / np.linalg.norm([1.0, 0.02, 0.01])

    def sound(mesh: MeshData) -> bool:
        places = write(Path("ball.obj"), mesh)
        return bool(alternate(Mesh(path=places), np.array([[-0.99, 0.0, 0.0]]), way)[0])

    small = meshes.icosphere(0.4, 3)
    assert sound(ball)
    assert sound(meshes.joined(ball, small.moved((3.0, 0.0, 0.0))))
    assert sound(meshes.joined(ball, small.inverted()))  # a cavity
    assert not sound(meshes.joined(ball, small))
    assert not sound(meshes.joined(ball, ball.moved((1.0, 0.0, 0.0))))
    assert not sound(ball.without(*np.flatnonzero(ball.triangles[..., 0].min(axis=1) > 0.8)))


def test_only_a_mesh_without_overlaps_is_integrated() -> None:
    ball, small = meshes.icosphere(1.0, 3), meshes.icosphere(0.5, 3)
    places, normals = (part[::10][None] for part in middles(ball))
    for name, part, rays in (
        ("cavity", small.inverted(), 0),
        ("nested", small, 256),
        ("overlap", small.moved((0.9, 0.0, 0.0)), 256),
    ):
        result = mean(write(Path(f"{name}.obj"), meshes.joined(ball, part)), name, places, normals, 256, (0, 0))
        assert (result.rays == rays).all(), name
        if name == "nested":  # the inner ball is in the outer one, and counts once
            assert result.value.mean() == pytest.approx(4.0 / 3.0, rel=0.01)


def test_rays_replace_the_integral_only_near_an_overlap() -> None:
    """Two balls that cross each other, and far from them, behind a wide plate, a third one."""
    ball, plate = meshes.icosphere(0.3, 3), meshes.box((4.0, 0.1, 4.0)).moved((0.0, -1.0, 0.0))
    mesh = meshes.joined(ball, ball.moved((0.3, 0.0, 0.0)), ball.moved((0.0, -8.0, 0.0)), plate._replace(uv=None))
    path = write(Path("parts.obj"), mesh)
    number = np.concatenate([np.arange(0, 1280, 20), 2560 + np.arange(0, 1280, 20)])
    places, normals = (part[number].reshape(2, 64, 3) for part in middles(mesh))
    result = mean(path, "parts", places, normals, 256, (0, 0))
    crossed, apart = np.split(result.rays, 2)
    assert (crossed == 256).all() and (apart == 0).all()
    rays = inward(path, "parts", places[1], normals[1], 1024, 0.0, (1, 0))
    assert (np.abs(result.value[64:] - rays.value) <= 5.0 * rays.error + 0.01 * rays.value).all()


@needs_meshes
def test_spot_has_the_mean_of_her_rays() -> None:
    mesh = Mesh(path=str(SPOT)).triangles
    assert mesh.uv is not None
    texels = atlas(mesh, mesh.uv, (64, 64), str(SPOT))
    places, flat = texels.places[::20], texels.flat[::20]
    value, error = MeanLength(mesh.places, mesh.corners).at(places, flat)
    rays = inward(str(SPOT), "spot", places, flat, 2048, 0.0, (0, 0))
    z = (value - rays.value) / np.hypot(rays.error, error)
    assert np.sqrt((z**2).mean()) < 1.3 and np.abs(z).max() < 5.0
    assert (value - rays.value).mean() == pytest.approx(0.0, abs=2e-3 * value.mean())
