"""Exact thickness: closed forms, sampling of the distance along random rays, winding numbers of meshes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from folders import MESHES
from sssgen.ir.frame_passes import BACK_FACES
from sssgen.lab.reference.inside_lengths import first_exit, thickness
from sssgen.scene.drawn_views import eye_layers
from sssgen.scene.geometry import Ball, Box, Capsule, Distance, Geometry, Mesh, Slab, Torus, Union
from sssgen.scene.inside_intervals import intervals, merge

Array = npt.NDArray[np.float64]

SPOT = MESHES / "spot.obj"
ASKEW: dict[str, Any] = {"position": (0.3, -0.2, 0.5), "rotation": (20.0, -30.0, 65.0), "scale": 1.7}
Z = (0.0, 0.0, 1.0)

PARTS = (
    Box(size=(1.2, 0.3, 0.5), position=(0.0, -0.4, 0.0)),
    Box(size=(0.3, 1.1, 0.5), position=(-0.45, 0.0, 0.0), rotation=(0.0, 0.0, 10.0)),
    Ball(0.4, position=(0.4, 0.3, 0.1), scale=0.8),
)
BODIES: list[Geometry] = [
    Ball(0.9),
    Box(size=(1.0, 1.4, 0.7)),
    Slab(1.5, 2.0, 0.2),
    Torus(0.8, 0.3),
    Capsule(0.3, 0.7),
    Capsule(0.4, 0.0),
    Union(PARTS),
    Union((Torus(0.6, 0.2), Capsule(0.25, 0.9, rotation=(0.0, 0.0, 90.0)))),
]


def chord(shape: Geometry, origin: npt.ArrayLike, way: npt.ArrayLike) -> float:
    """The thickness along one ray."""
    direction = np.array(way, float)
    return float(thickness(shape, np.array([origin], float), direction[None] / np.linalg.norm(direction))[0])


def rays(count: int, spread: float, seed: int = 1) -> tuple[Array, Array]:
    """Random rays that start inside and near a ball of radius `spread`."""
    generator = np.random.default_rng(seed)
    ways = generator.normal(size=(count, 3))
    return generator.uniform(-spread, spread, (count, 3)), ways / np.linalg.norm(ways, axis=1, keepdims=True)


def rays_through(shape: Geometry, count: int, seed: int = 2) -> tuple[Array, Array]:
    """Random rays from outside towards points inside and near a shape that fits into a ball of radius 1.2."""
    generator = np.random.default_rng(seed)
    origins = generator.normal(size=(count, 3))
    origins *= 4.0 / np.linalg.norm(origins, axis=1, keepdims=True)
    ways = generator.uniform(-0.9, 0.9, (count, 3)) - origins
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    matrix = shape.to_world()
    return origins @ matrix[:3, :3].T + matrix[:3, 3], ways @ matrix[:3, :3].T / shape.scale


def sampled_thickness(shape: Geometry, origins: Array, ways: Array, reach: float, count: int) -> Array:
    """The thickness, estimated by counting the inside points among `count` evenly spaced points of each ray."""
    step = reach / count
    inwards = shape.to_object()
    total = np.zeros(len(origins))
    for steps in np.array_split((np.arange(count) + 0.5) * step, max(count // 200, 1)):
        places = (origins + steps[:, None, None] * ways).reshape(-1, 3) @ inwards[:3, :3].T + inwards[:3, 3]
        total += (shape.distance(places) < 0.0).reshape(len(steps), -1).sum(axis=0)
    return total * step


# --- closed forms ---


def test_a_ball_has_twice_its_radius_times_the_cosine() -> None:
    angle = np.radians([0.0, 20.0, 50.0, 80.0, 89.9])
    ways = np.stack([np.sin(angle), np.zeros(5), -np.cos(angle)], axis=1)
    origins = np.tile([0.0, 0.0, 0.7], (5, 1))
    assert thickness(Ball(0.7), origins, ways) == pytest.approx(2.0 * 0.7 * np.cos(angle), abs=1e-12)
    assert thickness(Ball(0.7), origins, -ways) == pytest.approx(np.zeros(5), abs=1e-12)  # away from it
    assert chord(Ball(0.7), (0.0, 0.0, 0.2), Z) == pytest.approx(0.5)  # from inside: the remaining length
    assert chord(Ball(0.7), (0.7001, 0.0, -3.0), Z) == 0.0


def test_a_slab_has_its_thickness_over_the_cosine() -> None:
    angle = np.radians([0.0, 30.0, 60.0, 75.0])
    ways = np.stack([np.sin(angle), np.zeros(4), -np.cos(angle)], axis=1)
    assert thickness(Slab(100.0, 100.0, 0.2), np.tile([0.0, 0.0, 0.1], (4, 1)), ways) == pytest.approx(
        0.2 / np.cos(angle)
    )


def test_the_thickness_of_a_box() -> None:
    box = Box(size=(1.0, 2.0, 4.0))
    assert [chord(box, -3.0 * axis, axis) for axis in np.eye(3)] == pytest.approx([1.0, 2.0, 4.0])
    assert chord(box, (-2.0, -2.0, 0.0), (1.0, 1.0, 0.0)) == pytest.approx(np.sqrt(2.0))
    assert chord(box, (-2.0, -2.4, 0.3), (1.0, 1.0, 0.0)) == pytest.approx(
        np.sqrt(2.0)
    )  # enters at the front, leaves at the top
    assert chord(box, (0.4, -1.9, 0.0), (1.0, 1.0, 0.0)) == 0.0  # past the edge
    assert chord(Box(size=(1.0, 1.0, 1.0)), (-5.0, -5.0, -5.0), (1.0, 1.0, 1.0)) == pytest.approx(np.sqrt(3.0))
    # parallel to a pair of faces: between them, and outside
    assert chord(box, (0.49, -9.0, 0.0), (0.0, 1.0, 0.0)) == pytest.approx(2.0)
    assert chord(box, (0.51, -9.0, 0.0), (0.0, 1.0, 0.0)) == 0.0


@pytest.mark.parametrize("offset", [0.0, 0.1, 0.29])
def test_a_torus_along_its_axis(offset: float) -> None:
    torus, half = Torus(0.8, 0.3), np.sqrt(0.3**2 - offset**2)
    for x in (0.8 + offset, -0.8 + offset):
        assert chord(torus, (x, 5.0, 0.0), (0.0, -1.0, 0.0)) == pytest.approx(2.0 * half, abs=1e-7)
    assert chord(torus, (0.0, 5.0, 0.0), (0.0, -1.0, 0.0)) == 0.0  # through its hole


@pytest.mark.parametrize("height", [0.0, 0.15, -0.25])
@pytest.mark.parametrize("aside", [0.0, 0.3, 0.55, 0.7, 1.0])
def test_a_torus_across(height: float, aside: float) -> None:
    # the cross-section here is a ring; the line at x = aside is inside the outer circle, outside the inner one
    half = np.sqrt(0.3**2 - height**2)
    outer, inner = 0.8 + half, 0.8 - half
    expected = 2.0 * (np.sqrt(max(outer**2 - aside**2, 0.0)) - np.sqrt(max(inner**2 - aside**2, 0.0)))
    assert chord(Torus(0.8, 0.3), (aside, height, -5.0), Z) == pytest.approx(expected, abs=1e-9)


def test_a_torus_along_its_tube() -> None:
    # from the middle line of the tube, along its tangent: to the outer circle
    assert chord(Torus(0.8, 0.3), (0.8, 0.0, 0.0), Z) == pytest.approx(np.sqrt(1.1**2 - 0.8**2))
    # at an angle through the centre: the line crosses the tube twice, and the gap does not count
    turned = np.radians(15.0)
    way = (np.cos(turned), np.sin(turned), 0.0)
    expected = 2.0 * np.sqrt(0.3**2 - (0.8 * np.sin(turned)) ** 2)
    assert chord(Torus(0.8, 0.3), -4.0 * np.array(way), way) == pytest.approx(2.0 * expected)


def test_a_capsule() -> None:
    capsule = Capsule(0.3, 1.0)
    assert chord(capsule, (0.0, -4.0, 0.0), (0.0, 1.0, 0.0)) == pytest.approx(1.6)
    assert chord(capsule, (0.2, -4.0, 0.0), (0.0, 1.0, 0.0)) == pytest.approx(1.0 + 2.0 * np.sqrt(0.05))
    assert chord(capsule, (0.0, 0.3, -4.0), Z) == pytest.approx(0.6)
    assert chord(capsule, (0.1, 0.3, -4.0), Z) == pytest.approx(2.0 * np.sqrt(0.08))
    assert chord(capsule, (0.0, 0.7, -4.0), Z) == pytest.approx(2.0 * np.sqrt(0.05))  # through the upper end
    assert chord(capsule, (0.0, 0.81, -4.0), Z) == 0.0
    turned = np.radians(60.0)  # through the middle; the line leaves at the sides
    assert chord(capsule, (0.0, 0.0, 0.0), (np.sin(turned), np.cos(turned), 0.0)) == pytest.approx(0.3 / np.sin(turned))
    assert chord(Capsule(0.3, 0.0), (0.1, -4.0, 0.0), (0.0, 1.0, 0.0)) == pytest.approx(
        2.0 * np.sqrt(0.08)
    )  # a capsule without length is a ball


def test_a_union_counts_overlaps_once_and_no_gaps() -> None:
    apart = Union((Ball(0.5, position=(-1.0, 0.0, 0.0)), Ball(0.25, position=(1.0, 0.0, 0.0))))
    assert chord(apart, (-5.0, 0.0, 0.0), (1.0, 0.0, 0.0)) == pytest.approx(1.5)
    assert chord(apart, (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)) == pytest.approx(
        0.5
    )  # matter behind the origin does not count
    overlapping = Union((Ball(0.5), Ball(0.5, position=(0.5, 0.0, 0.0)), Box(size=(0.1, 0.1, 0.1))))
    assert chord(overlapping, (-5.0, 0.0, 0.0), (1.0, 0.0, 0.0)) == pytest.approx(1.5)
    touching = Union((Box(size=(1.0, 1.0, 1.0)), Box(size=(1.0, 1.0, 1.0), position=(1.0, 0.0, 0.0))))
    assert chord(touching, (-5.0, 0.2, 0.1), (1.0, 0.0, 0.0)) == pytest.approx(2.0)
    # a nested union with its own transform
    nested = Union((Union((Ball(0.5, scale=2.0),), scale=0.5, position=(0.0, 3.0, 0.0)),), scale=3.0)
    assert chord(nested, (0.0, 9.0, -9.0), Z) == pytest.approx(3.0)


def test_a_ray_leaves_a_union_where_no_part_continues() -> None:
    parts = (
        Box(size=(1.0, 1.0, 1.0)),
        Box(size=(1.0, 1.0, 1.0), position=(0.7, 0.0, 0.0)),
        Ball(0.2, position=(3, 0, 0)),
    )
    origin, way = np.array([[-0.5, 0.1, 0.0], [-0.5, 2.0, 0.0]]), np.array([[1.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    # the overlap from 0.2 to 0.5 has no exit, the gap before the ball has one, and the second ray does not enter
    assert first_exit(Union(parts), origin, way) == pytest.approx([1.7, 0.0])
    assert first_exit(Union(parts, scale=2.0), 2.0 * origin, way) == pytest.approx([3.4, 0.0])
    assert eye_layers(Union(parts), np.array([-2.0, 0.1, 0.0]), way[:1], BACK_FACES)[0] == pytest.approx([3.2])


def test_merged_intervals_are_disjoint_sorted_and_cover_the_same() -> None:
    generator = np.random.default_rng(7)
    ends = np.sort(generator.uniform(0.0, 1.0, (300, 5, 2)), axis=2)
    ends[:, 2] = 0.0  # an empty interval
    result = merge(ends)
    at = np.linspace(0.0, 1.0, 3001)
    for before, after in zip(ends, result, strict=True):
        inside = ((before[:, :1] <= at) & (at < before[:, 1:])).any(axis=0)
        again = ((after[:, :1] <= at) & (at < after[:, 1:])).sum(axis=0)
        assert (again == inside).all()
        filled = after[after[:, 0] < after[:, 1]]
        assert (filled[1:, 0] > filled[:-1, 1]).all()
    touching = np.array([[[0.0, 1.0], [1.0, 2.0], [3.0, 4.0]]])
    assert merge(touching).tolist() == [[[0.0, 2.0], [0.0, 0.0], [3.0, 4.0]]]


@pytest.mark.parametrize("shape", BODIES, ids=repr)
def test_intervals_end_at_the_surface(shape: Geometry) -> None:
    """No interval ends inside the body, so that the first end is the first exit."""
    origins, ways = rays_through(shape, 400)
    ends = intervals(shape, origins, ways)
    filled = ends[..., 0] < ends[..., 1]
    assert filled.any(axis=1).sum() > 50
    for side in (0, 1):
        at = (origins[:, None] + ends[..., side, None] * ways[:, None])[filled & (ends[..., side] > 0.0)]
        assert np.abs(shape.distance(at)).max() < 1e-4


# --- transforms ---


@pytest.mark.parametrize("shape", BODIES, ids=repr)
def test_thickness_follows_rotation_scale_and_translation(shape: Geometry) -> None:
    origins, ways = rays(400, 1.0)
    placed = replace(shape, **ASKEW)
    matrix = placed.to_world()
    moved = thickness(placed, origins @ matrix[:3, :3].T + matrix[:3, 3], ways @ matrix[:3, :3].T / 1.7)
    lengths = thickness(shape, origins, ways)
    assert (lengths > 0.05).sum() > 20
    assert moved == pytest.approx(1.7 * lengths, abs=1e-6)


@pytest.mark.parametrize("shape", [*BODIES, *(replace(body, **ASKEW) for body in BODIES)], ids=repr)
def test_thickness_equals_that_of_distance_samples(shape: Geometry) -> None:
    origins, ways = rays_through(shape, 150)
    reach = 8.0 * shape.scale
    exact = thickness(shape, origins, ways)
    assert (exact > 0.0).sum() > 20
    # at each of at most six ends, the count of samples is uncertain by one
    assert np.abs(exact - sampled_thickness(shape, origins, ways, reach, 4000)).max() < 6.0 * reach / 4000
    starts, onwards = (
        origins + 0.5 * reach * ways,
        ways,
    )  # half of the range is behind the start; some rays start inside
    rest = thickness(shape, starts, onwards)
    assert (rest < exact - 0.05).sum() > 10
    assert np.abs(rest - sampled_thickness(shape, starts, onwards, reach, 4000)).max() < 6.0 * reach / 4000


def test_another_part_never_reduces_thickness() -> None:
    origins, ways = rays(2000, 1.5)
    parts: tuple[Geometry, ...] = ()
    before = np.zeros(len(origins))
    for part in (*PARTS, Torus(0.7, 0.2, rotation=(40.0, 0.0, 0.0)), Capsule(0.2, 1.0)):
        parts = (*parts, part)
        after = thickness(Union(parts), origins, ways)
        assert (after >= before - 1e-12).all()
        assert (after <= before + thickness(part, origins, ways) + 1e-12).all()
        assert (after > before + 0.01).any()
        before = after


# --- distance functions ---


@pytest.mark.parametrize(
    ("function", "solid"),
    [
        (Distance("sphere", parameters={"radius": 0.8}, reach=1.2), Ball(0.8)),
        (Distance("torus", parameters={"ring_radius": 0.8, "tube_radius": 0.25}, reach=1.5), Torus(0.8, 0.25)),
    ],
)
@pytest.mark.parametrize("placed", [False, True])
def test_a_distance_function_has_the_thickness_of_the_solid(function: Distance, solid: Geometry, placed: bool) -> None:
    if placed:
        function, solid = replace(function, **ASKEW), replace(solid, **ASKEW)
    origins, ways = rays_through(solid, 400)
    exact = thickness(solid, origins, ways)
    result = thickness(function, origins, ways)
    # lengths below the shortest step may be missed
    missed = (result == 0.0) & (exact > 0.0)
    assert exact[missed].max(initial=0.0) < 0.05
    assert result[~missed] == pytest.approx(exact[~missed], abs=1e-3)
    assert np.median(np.abs(result - exact)) < 1e-9
    assert (np.abs(result - exact) < 1e-6).mean() > 0.98
    # from the surface into the body
    at = origins + intervals_of(solid, origins, ways)[:, None] * ways
    hit = exact > 0.1
    assert thickness(function, at[hit], ways[hit]) == pytest.approx(exact[hit], abs=1e-3)


def intervals_of(shape: Geometry, origins: Array, ways: Array) -> Array:
    """The distance to the first surface ahead, in world units; 0 if there is none."""
    inwards = shape.to_object()
    result = intervals(shape, origins @ inwards[:3, :3].T + inwards[:3, 3], ways @ inwards[:3, :3].T * shape.scale)
    first: Array = np.where(result[..., 1] > result[..., 0], result[..., 0], np.inf).min(axis=1) * shape.scale
    return np.where(np.isfinite(first), first, 0.0)


# --- meshes ---


def mesh(path: Path, result: object) -> Mesh:
    result.export(path)  # type: ignore[attr-defined]
    return Mesh(path=str(path))


def test_a_mesh_of_a_box_is_the_box(tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("embreex")
    box = mesh(tmp_path / "box.ply", trimesh.creation.box((1.0, 1.4, 0.7)))
    exact = Box(size=(1.0, 1.4, 0.7))
    for placed, solid in ((box, exact), (replace(box, **ASKEW), replace(exact, **ASKEW))):
        origins, ways = rays_through(solid, 2000)
        expected = thickness(solid, origins, ways)
        assert thickness(placed, origins, ways) == pytest.approx(expected, abs=2e-4)
        inside = origins + (intervals_of(solid, origins, ways) + 0.3 * expected)[:, None] * ways
        deep = expected > 0.1
        assert thickness(placed, inside[deep], ways[deep]) == pytest.approx(0.7 * expected[deep], abs=2e-4)
    # through the diagonal that two triangles share: the line enters once and leaves once
    assert chord(box, (0.0, 0.0, -3.0), Z) == pytest.approx(0.7, abs=1e-5)
    assert chord(box, (0.0, 0.0, -0.35), Z) == pytest.approx(0.7, abs=1e-5)  # from the surface
    assert chord(box, (0.0, 0.0, 0.35), Z) == 0.0  # away from it


def test_a_mesh_of_a_ball_is_nearly_the_ball(tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("embreex")
    ball = mesh(tmp_path / "ball.ply", trimesh.creation.icosphere(5, 0.9))
    origins, ways = rays_through(ball, 2000)
    exact = thickness(Ball(0.9), origins, ways)
    deep = exact > 0.2
    # triangles with edges of 0.04 are inside the ball by at most c² / 8r = 2e-4; oblique rays see more
    assert thickness(ball, origins, ways)[deep] == pytest.approx(exact[deep], abs=6e-3)
    assert (thickness(ball, origins, ways)[exact == 0.0] == 0.0).all()


def test_nested_parts_of_a_mesh_count_once(tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("embreex")
    whole, part = trimesh.creation.box((2.0, 2.0, 2.0)), trimesh.creation.box((2.0, 0.5, 0.5))
    part.apply_translation((1.5, 0.1, 0.2))  # half inside the first part
    result = mesh(tmp_path / "two.ply", trimesh.util.concatenate([whole, part]))
    same = Union((Box(size=(2.0, 2.0, 2.0)), Box(size=(2.0, 0.5, 0.5), position=(1.5, 0.1, 0.2))))
    origins, ways = rays_through(same, 2000)
    assert thickness(result, origins, ways) == pytest.approx(thickness(same, origins, ways), abs=2e-4)


@pytest.mark.skipif(not SPOT.is_file(), reason="the meshes of shared/data/meshes are not part of the project")
def test_the_thickness_of_spot_agrees_with_the_winding_number() -> None:
    for package in ("trimesh", "embreex", "igl"):
        pytest.importorskip(package)
    spot = Mesh(path=str(SPOT))
    low, high = spot.bounds()
    assert low == pytest.approx(spot.triangles.places.min(axis=0))
    generator = np.random.default_rng(3)
    count, steps = 40, 400
    origins = generator.normal(size=(count, 3))
    origins = 0.5 * (low + high) + 3.0 * origins / np.linalg.norm(origins, axis=1, keepdims=True)
    ways = generator.uniform(low, high, (count, 3)) - origins
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    exact = thickness(spot, origins, ways)
    assert (exact > 0.1).sum() > 20
    assert np.abs(exact - sampled_thickness(spot, origins, ways, 6.0, steps)).max() < 8.0 * 6.0 / steps
