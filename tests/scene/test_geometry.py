"""Intersections of rays with geometry, compared with closed forms, implicit functions and finite differences."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from folders import MESHES
from sssgen.scene.camera import Camera
from sssgen.scene.geometry import Ball, Box, Capsule, Distance, Geometry, Mesh, Slab, Torus, Union
from sssgen.support.diagnostics import SssgenError

CAMERA = Camera((0.7, 1.9, 3.1), (0.0, 0.0, 0.0), 45.0)

PARTS = (Ball(0.8, position=(-0.5, 0.0, 0.0)), Capsule(0.3, 1.6, rotation=(0.0, 0.0, 60.0)))

SOLIDS: list[Geometry] = [
    Ball(1.2),
    Box(size=(1.0, 1.4, 0.7)),
    Slab(1.5, 2.0, 0.2),
    Torus(1.0, 0.4),
    Torus(1.0, 0.99),
    Torus(1.0, 0.05),
    Ball(0.5, position=(0.2, -0.1, 0.4), scale=1.7, rotation=(20.0, 30.0, 40.0)),
    Box(size=(1.0, 1.4, 0.7), rotation=(10.0, 20.0, 30.0), position=(0.1, 0.2, -0.3)),
    Torus(1.0, 0.3, rotation=(70.0, -20.0, 15.0), position=(-0.2, 0.1, 0.3), scale=0.8),
    Capsule(0.4, 1.2),
    Capsule(0.7, 0.0),
    Capsule(0.3, 0.9, rotation=(15.0, 25.0, 70.0), position=(0.1, -0.2, 0.2), scale=1.3),
    Union(PARTS),
    Union(
        (Torus(0.8, 0.25, scale=1.1), Union((Ball(0.4, position=(0.0, 0.6, 0.0)),), rotation=(0.0, 0.0, 50.0))),
        rotation=(70.0, -20.0, 15.0), position=(-0.2, 0.1, 0.3), scale=0.9,
    ),
]  # fmt: skip


def surface_points(shape: Geometry, width: int = 80, height: int = 60) -> tuple[Any, ...]:
    """For the rays that hit: object position, world position, directions, N, T, w, uv."""
    origin, directions = CAMERA.rays(width, height)
    hits = shape.hits(origin, directions)
    hit = hits.hit
    assert hit.any()
    assert not any(part[~hit].any() for part in hits[1:])
    inwards = shape.to_object()
    local = hits.position[hit] @ inwards[:3, :3].T + inwards[:3, 3]
    tangent = hits.tangent[hit]
    return local, hits.position[hit], directions[hit], hits.normal[hit], tangent[:, :3], tangent[:, 3], hits.uv[hit]


def test_a_ray_and_a_ball_in_closed_form() -> None:
    hits = Ball(1.0).hits((0.5, 0.0, 5.0), [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    assert hits.hit.tolist() == [True, False, False]
    assert hits.position[0] == pytest.approx([0.5, 0.0, np.sqrt(0.75)], abs=1e-15)
    assert hits.uv[0] == pytest.approx([0.5 + 30.0 / 360.0, 0.5])
    assert hits.tangent[0] == pytest.approx([np.sqrt(0.75), 0.0, -0.5, 1.0])


@pytest.mark.parametrize("shape", [Ball(1.0), Box(size=(2.0, 2.0, 2.0)), Slab(4.0, 4.0, 2.0)])
def test_a_ray_from_inside_hits_the_far_side_and_the_normal_points_outward(shape: Geometry) -> None:
    hits = shape.hits((0.0, 0.0, 0.5), [[0.0, 0.0, -1.0]])
    assert hits.position[0] == pytest.approx([0.0, 0.0, -1.0])
    assert hits.normal[0] == pytest.approx([0.0, 0.0, -1.0])


def test_a_torus_along_its_axis_and_across() -> None:
    along = Torus(1.0, 0.4).hits((1.0, 5.0, 0.0), [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]])
    assert along.hit.tolist() == [True, False]
    assert along.position[0] == pytest.approx([1.0, 0.4, 0.0], abs=1e-9)
    across = Torus(1.0, 0.4).hits((0.0, 0.0, 0.0), [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
    assert across.hit.tolist() == [True, False]
    assert across.position[0] == pytest.approx([0.0, 0.0, 0.6], abs=1e-12)
    tube = Torus(1.0, 0.4).hits((0.0, 0.0, 1.0), [[0.0, 0.0, 1.0]])
    assert tube.position[0] == pytest.approx([0.0, 0.0, 1.4], abs=1e-12)


@pytest.mark.parametrize("shape", SOLIDS)
def test_points_are_the_first_hits_of_their_rays(shape: Geometry) -> None:
    local, world, directions, *_ = surface_points(shape)
    assert np.abs(shape.distance(local)).max() < 1e-9
    assert np.abs(np.cross(world - CAMERA.position, directions)).max() < 1e-9
    assert (np.einsum("nc,nc->n", world - CAMERA.position, directions) > 0.0).all()
    inwards = shape.to_object()
    for part in np.linspace(0.0, 0.999, 200):
        between = CAMERA.position + part * (world - CAMERA.position)
        assert (shape.distance(between @ inwards[:3, :3].T + inwards[:3, 3]) > -1e-12).all()


@pytest.mark.parametrize("shape", SOLIDS)
def test_rays_that_miss_stay_outside(shape: Geometry) -> None:
    origin, directions = CAMERA.rays(40, 30)
    missed = directions[~shape.hits(origin, directions).hit]
    inwards = shape.to_object()
    assert len(missed)
    for t in np.linspace(0.0, 8.0, 400):
        assert (shape.distance((origin + t * missed) @ inwards[:3, :3].T + inwards[:3, 3]) > 0.0).all()


@pytest.mark.parametrize("shape", SOLIDS)
def test_normals_are_the_gradient_of_the_distance(shape: Geometry) -> None:
    local, _, _, normal, *_ = surface_points(shape)
    step = 1e-6
    outside = (
        local + 1e-4 * normal @ shape.to_world()[:3, :3] / shape.scale
    )  # near the edge of a box the nearest face changes
    slopes = [shape.distance(outside + step * way) - shape.distance(outside - step * way) for way in np.eye(3)]
    turned = np.stack(slopes, axis=1) @ shape.to_world()[:3, :3].T / (2.0 * step * shape.scale)
    assert np.abs(turned - normal).max() < 1e-5


@pytest.mark.parametrize(
    "shape", [*SOLIDS, Distance("torus"), Distance("sphere", projection="planar"), Union(PARTS, "planar")]
)
def test_frames_are_orthonormal_and_follow_uv(shape: Geometry) -> None:
    _, world, directions, normal, tangent, w, uv = surface_points(shape)
    assert np.abs(np.linalg.norm(normal, axis=1) - 1.0).max() < 1e-12
    assert np.abs(np.linalg.norm(tangent, axis=1) - 1.0).max() < 1e-12
    assert np.abs(np.einsum("nc,nc->n", normal, tangent)).max() < 1e-9
    assert set(np.unique(w)) <= {-1.0, 1.0}
    # a neighbouring point along T has the same v and a larger u; a neighbouring point along B has a larger v
    step = 1e-5
    bitangent = np.cross(normal, tangent) * w[:, None]
    facing = np.einsum("nc,nc->n", normal, directions) < -0.2
    for way, grows in ((tangent, 0), (bitangent, 1)):
        towards = world + step * way - CAMERA.position
        towards /= np.linalg.norm(towards, axis=1, keepdims=True)
        near = shape.hits(CAMERA.position, towards)
        change = near.uv - uv
        smooth = facing & near.hit & (np.abs(change) < 0.01).all(axis=1)
        smooth &= (np.abs(near.position - world - step * way) < 1e-7).all(
            axis=1
        )  # both points are on the same side of an edge
        assert smooth.sum() > 0.3 * len(uv)
        assert (change[smooth, grows] > 0.0).all()
        if grows == 0:
            assert np.abs(change[smooth, 1]).max() < 1e-6


def test_box_faces_have_upright_uv() -> None:
    hits = Box(size=(2.0, 4.0, 2.0)).hits((0.5, 1.0, 9.0), [[0.0, 0.0, -1.0]])
    assert hits.uv[0] == pytest.approx([0.75, 0.75])
    assert hits.tangent[0].tolist() == [1.0, 0.0, 0.0, 1.0]


def test_a_ray_and_a_capsule_in_closed_form() -> None:
    capsule = Capsule(0.5, 2.0)
    side = capsule.hits((0.3, 0.5, 5.0), [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]])
    assert side.hit.tolist() == [True, False]
    assert side.position[0] == pytest.approx([0.3, 0.5, 0.4], abs=1e-12)
    assert side.normal[0] == pytest.approx([0.6, 0.0, 0.8])
    cap = capsule.hits((0.3, 5.0, 0.0), [[0.0, -1.0, 0.0]])  # along its axis a ray never hits the side
    assert cap.position[0] == pytest.approx([0.3, 1.4, 0.0], abs=1e-12)
    assert cap.normal[0] == pytest.approx([0.6, 0.8, 0.0])
    inside = capsule.hits((0.0, 0.0, 0.0), [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
    assert inside.position == pytest.approx(np.array([[0.0, 1.5, 0.0], [0.5, 0.0, 0.0]]))
    # a capsule without length is a ball, and has its uv
    origin, directions = CAMERA.rays(40, 30)
    for capsule_hits, ball_hits in zip(
        Capsule(0.8, 0.0).hits(origin, directions), Ball(0.8).hits(origin, directions), strict=True
    ):
        assert capsule_hits == pytest.approx(ball_hits, abs=1e-7)


def test_a_ray_hits_the_nearest_part_of_a_union_with_the_uv_of_that_part() -> None:
    origin, directions = CAMERA.rays(60, 45)
    parts = (
        Ball(0.6, position=(-0.4, 0.0, 0.0)),
        Box(size=(0.8, 0.8, 0.8), rotation=(0.0, 30.0, 0.0)),
        Torus(1.2, 0.2),
    )
    whole = Union(parts).hits(origin, directions)
    alone = [part.hits(origin, directions) for part in parts]
    rays_of_part = [0, 0, 0]
    for ray in range(len(directions)):
        ways = [
            np.linalg.norm(part_hits.position[ray] - origin) if part_hits.hit[ray] else np.inf for part_hits in alone
        ]
        nearest = int(np.argmin(ways))
        assert whole.hit[ray] == np.isfinite(ways[nearest])
        for actual, expected in zip(whole, alone[nearest], strict=True):
            assert (actual[ray] == expected[ray]).all()
        rays_of_part[nearest] += bool(whole.hit[ray])
    assert min(rays_of_part) > 50  # rays hit every part
    planar = Union(parts, "planar").hits(origin, directions)
    assert (planar.position == whole.position).all()
    assert planar.uv[planar.hit] == pytest.approx(planar.position[planar.hit][:, :2] + 0.5)


def test_the_distance_of_a_union_is_exact_outside_and_at_most_the_depth_inside() -> None:
    union = Union((Ball(0.6), Ball(0.5, position=(0.5, 0.0, 0.0), scale=1.2)))
    at = np.array([[-1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.25, 2.0, 0.0], [0.3, 0.0, 0.0]])
    two = np.minimum(np.linalg.norm(at, axis=1) - 0.6, np.linalg.norm(at - [0.5, 0.0, 0.0], axis=1) - 0.6)
    assert union.distance(at) == pytest.approx(two)
    # the balls have equal radii, so their surfaces intersect in the plane between them
    assert -union.distance(at[3:]) < np.hypot(0.3 - 0.25, np.sqrt(0.6**2 - 0.25**2))


def test_rotation_is_about_x_then_y_then_z() -> None:
    turned = Ball(rotation=(90.0, 90.0, 0.0)).to_world()[:3, :3] @ [0.0, 1.0, 0.0]
    assert turned == pytest.approx([1.0, 0.0, 0.0], abs=1e-12)  # y → z → x
    shape = SOLIDS[-1]
    assert shape.to_object() @ shape.to_world() == pytest.approx(np.eye(4), abs=1e-12)


# Meshes


@pytest.fixture
def needs_trimesh() -> None:
    for package in ("trimesh", "embreex"):
        pytest.importorskip(package, reason=f"{package} is missing: pip install -e '.[render]'")


def write_ball(path: Path, rings: int = 48, with_uv: bool = True) -> None:
    """Writes a ball as .obj: a grid of longitudes and latitudes, with the uv of Ball."""
    lines, columns = [], 2 * rings
    for row in range(rings + 1):
        for column in range(columns + 1):
            u, v = column / columns, row / rings
            longitude, latitude = (u - 0.5) * 2 * np.pi, (v - 0.5) * np.pi
            ring = np.cos(latitude) if 0 < row < rings else 0.0
            x, y, z = ring * np.sin(longitude), np.sin(latitude), ring * np.cos(longitude)
            lines.append(f"v {x:.12f} {y:.12f} {z:.12f}")
            lines.append(f"vt {u:.12f} {v:.12f}")
    for row in range(rings):
        for column in range(columns):
            a = row * (columns + 1) + column + 1
            b, c, d = a + 1, a + columns + 2, a + columns + 1
            corners = ([f"{i}/{i}" if with_uv else f"{i}" for i in face] for face in ((a, b, c), (a, c, d)))
            lines += ["f " + " ".join(face) for face in corners]
    path.write_text("\n".join(lines if with_uv else [x for x in lines if x[:2] != "vt"]) + "\n", encoding="utf-8")


@pytest.mark.usefixtures("needs_trimesh")
@pytest.mark.parametrize("with_uv", [True, False])
def test_a_mesh_of_a_ball_is_close_to_the_ball(tmp_path: Path, with_uv: bool) -> None:
    write_ball(tmp_path / "ball.obj", with_uv=with_uv)
    origin, directions = CAMERA.rays(80, 60)
    mesh = Mesh(path=str(tmp_path / "ball.obj"), rotation=(5.0, 20.0, 0.0), scale=1.1)
    mesh_hits, ball_hits = (
        mesh.hits(origin, directions),
        Ball(rotation=(5.0, 20.0, 0.0), scale=1.1).hits(origin, directions),
    )
    assert (mesh_hits.hit != ball_hits.hit).sum() < 0.02 * ball_hits.hit.sum()
    both = mesh_hits.hit & ball_hits.hit & (np.einsum("nc,nc->n", ball_hits.normal, directions) < -0.3)
    both &= (np.abs(ball_hits.uv[:, 1] - 0.5) < 0.4) & (
        np.abs(ball_hits.uv[:, 0] - 0.5) < 0.48
    )  # without the poles and the seam
    assert both.sum() > 500
    assert np.abs(mesh_hits.position - ball_hits.position)[both].max() < 0.01
    assert np.abs(mesh_hits.normal - ball_hits.normal)[both].max() < 0.005
    assert np.abs(mesh_hits.tangent - ball_hits.tangent)[both].max() < 0.05
    assert np.abs(mesh_hits.uv - ball_hits.uv)[both].max() < 0.005


@pytest.mark.usefixtures("needs_trimesh")
def test_mirrored_uv_turns_the_handedness(tmp_path: Path) -> None:
    path = tmp_path / "quad.obj"
    corners = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
    path.write_text(corners + "vt 1 0\nvt 0 0\nvt 0 1\nvt 1 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n", encoding="utf-8")
    hits = Mesh(path=str(path)).hits((0.5, 0.25, 4.0), [[0.0, 0.0, -1.0]])
    assert hits.tangent[0] == pytest.approx([-1.0, 0.0, 0.0, -1.0])
    assert hits.uv[0] == pytest.approx([0.25, 0.625])
    assert hits.position[0] == pytest.approx([0.5, 0.25, 0.0], abs=1e-12)


@pytest.mark.usefixtures("needs_trimesh")
@pytest.mark.skipif(not MESHES.is_dir(), reason="the meshes of shared/data/meshes are not part of the project")
@pytest.mark.parametrize(("name", "centre"), [("spot.obj", (0.0, 0.0, 0.0)), ("suzanne.obj", (2.5, -1.2, -4.0))])
def test_real_meshes(name: str, centre: tuple[float, float, float]) -> None:
    mesh = Mesh(path=str(MESHES / name), position=centre)
    local, world, directions, normal, tangent, w, _ = surface_points(mesh)
    assert np.abs(np.cross(world - CAMERA.position, directions)).max() < 1e-9
    assert np.abs(np.einsum("nc,nc->n", normal, tangent)).max() < 1e-9
    assert set(np.unique(w)) <= {-1.0, 1.0}
    pytest.importorskip("igl", reason="libigl is missing: pip install -e '.[render]'")
    assert np.abs(mesh.distance(local)).max() < 1e-6


@pytest.mark.usefixtures("needs_trimesh")
def test_faulty_meshes(tmp_path: Path) -> None:
    def wrong(name: str, text: str | None = None) -> str:
        if text is not None:
            (tmp_path / name).write_text(text, encoding="utf-8")
        with pytest.raises(SssgenError) as caught:
            Mesh(path=str(tmp_path / name)).hits((0.0, 0.0, 4.0), [[0.0, 0.0, -1.0]])
        return str(caught.value)

    triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
    assert "cannot find the mesh" in wrong("none.obj")
    assert "not a mesh file's suffix" in wrong("ball.fbx", "")
    assert "no triangles" in wrong("empty.obj", "")
    assert "no triangles" in wrong("text.stl", "hello")
    assert "cannot be read" in wrong("text.ply", "hello")
    assert "cannot be read" in wrong("text.glb", "hello")
    assert "refers to vertex 9" in wrong("index.obj", triangle + "f 1 2 9\n")
    assert "not a number" in wrong("nan.obj", triangle.replace("1", "nan", 1) + "f 1 2 3\n")
    assert "no triangle has an area" in wrong("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")


# Distance functions


@pytest.mark.parametrize("name", ["sphere", "sphere:sphere_object"])
def test_a_distance_function_equals_the_solid(name: str) -> None:
    origin, directions = CAMERA.rays(60, 45)
    field_hits, ball_hits = (
        Distance(name, parameters={"radius": 0.8}).hits(origin, directions),
        Ball(0.8).hits(origin, directions),
    )
    assert (field_hits.hit == ball_hits.hit).all()
    facing = np.einsum("nc,nc->n", ball_hits.normal, directions) < -0.1
    assert np.abs(field_hits.position - ball_hits.position)[facing].max() < 1e-9
    assert np.abs(field_hits.normal - ball_hits.normal)[facing].max() < 1e-6
    assert np.abs(field_hits.uv - ball_hits.uv)[facing].max() < 1e-6
    inside = Distance(name, parameters={"radius": 0.8}).hits((0.0, 0.0, 0.0), [[0.0, 0.0, 1.0]])
    assert inside.position[0] == pytest.approx([0.0, 0.0, 0.8])


def test_a_distance_function_of_a_file(tmp_path: Path) -> None:
    text = "float egg(vec3 p)\n{\n    return length(p * vec3(1.0, 0.5, 1.0)) - 0.5;\n}\n"
    (tmp_path / "egg.sss").write_text(text, encoding="utf-8")
    hits = Distance("egg.sss:egg", folder=str(tmp_path)).hits((0.0, 3.0, 0.0), [[0.0, -1.0, 0.0]])
    assert hits.position[0] == pytest.approx([0.0, 1.0, 0.0])


@pytest.mark.parametrize(
    ("shape", "message"),
    [
        (Distance("spere"), "did you mean"),
        (Distance("none.sss"), "cannot find the file"),
        (Distance("lobe_exp2"), "does not fit"),
        (Distance("distance_texture"), "reads the texture 'distance_map'"),
        (Distance("sphere", parameters={"radios": 1.0}), "did you mean 'radius'"),
        (Distance("sphere", parameters={"radius": "big"}), "'radius' takes a number"),
    ],
)
def test_faulty_distance_functions(shape: Distance, message: str) -> None:
    with pytest.raises(SssgenError, match=message):
        shape.hits((0.0, 0.0, 4.0), [[0.0, 0.0, -1.0]])
