"""`sssgen bake sdf`: distances and signs against closed forms, all triangles and rays' votes; what is stored."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import bake_meshes as meshes
from bake_meshes import SPOT, SUZANNE, Array, MeshData, joined, needs_meshes, write
from oracle import technique
from slow_cases import diagonal
from sssgen.support.diagnostics import SssgenError

pytest.importorskip("trimesh", reason="trimesh is missing: pip install -e '.[bake]'")
pytest.importorskip("igl", reason="libigl is missing: pip install -e '.[bake]'")
pytest.importorskip("embreex", reason="embreex is missing: pip install -e '.[bake]'")

from sssgen.bake.distance_encoding import ENCODINGS
from sssgen.bake.distance_texture import Volume, sdf
from sssgen.bake.voxel_distance import distances, inside
from sssgen.bake.voxel_grid import Grid, around
from sssgen.lab.reference.inside_lengths import thickness
from sssgen.scene.mesh import Mesh
from sssgen.scene.mesh_distance import INSIDE, MeshDistance
from sssgen.targets.runtime.numpy_textures import Texture

pytestmark = pytest.mark.usefixtures("in_folder")


def decode(texels: npt.NDArray[Any], reach: float, name: str) -> Array:
    """The distances that texels encode, as the technique distance_texture reads them."""
    result: Array = (2.0 * texels.astype(np.float64) / ENCODINGS[name].unit - 1.0) * reach
    return result


def rng(seed: int = 5) -> np.random.Generator:
    return np.random.default_rng(seed)


def solid(result: MeshData) -> MeshDistance:
    return Mesh(path=write(Path("body.ply"), result)).solid


def grid_about(body: MeshDistance, resolution: int = 24, padding: float = 0.1) -> Grid:
    return around(body.places.min(axis=0), body.places.max(axis=0), [resolution], padding)


def centers(grid: Grid) -> Array:
    """The centres of the voxels, (z y x, 3), computed independently."""
    z, y, x = np.mgrid[: grid.counts[2], : grid.counts[1], : grid.counts[0]]
    result: Array = grid.low + (np.stack([x, y, z], axis=-1).reshape(-1, 3) + 0.5) * grid.voxel
    return result


def signed(body: MeshDistance, grid: Grid) -> Array:
    """As they are baked, before they are encoded: (z y x,)."""
    unsigned = distances(body, grid)
    return np.where(inside(body, grid, unsigned), -1.0, 1.0).ravel() * unsigned.ravel()


# Closed forms


def to_ball(points: Array, radius: float) -> Array:
    result: Array = np.linalg.norm(points, axis=1) - radius
    return result


def to_torus(points: Array, major: float, minor: float) -> Array:
    result: Array = np.hypot(np.hypot(points[:, 0], points[:, 2]) - major, points[:, 1]) - minor
    return result


def to_box(points: Array, half: npt.ArrayLike) -> Array:
    beyond = np.abs(points) - half
    result: Array = np.linalg.norm(np.maximum(beyond, 0.0), axis=1) + np.minimum(beyond.max(axis=1), 0.0)
    return result


@pytest.mark.parametrize("size", [(1.0, 1.0, 1.0), (1.0, 2.0, 0.3)])
@pytest.mark.parametrize("middle", [(0.0, 0.0, 0.0), (13.0, -7.0, 100.0)])
def test_a_box_has_its_distance(size: Any, middle: Any) -> None:
    body = solid(meshes.box(size).moved(middle))
    grid = grid_about(body)
    exact = to_box(centers(grid) - middle, 0.5 * np.array(size))
    assert np.abs(signed(body, grid) - exact).max() <= 2e-7 * grid.diagonal
    assert (exact < 0.0).mean() > 0.2


def dent(result: MeshData, exact: Any) -> float:
    """The distance of the triangles from the exact surface, at 66 places of each."""
    weights = np.array([(i, j, 10 - i - j) for i in range(11) for j in range(11 - i)]) / 10.0
    worst = 0.0
    for some in np.array_split(result.faces, max(1, len(result.faces) // 20_000)):
        worst = max(
            worst, float(np.abs(exact(np.einsum("wv,fvc->fwc", weights, result.vertices[some]).reshape(-1, 3))).max())
        )
    return worst


@pytest.mark.parametrize("level", [1, 4])
def test_the_error_of_a_coarse_ball_is_that_of_its_triangles(level: int) -> None:
    mesh = meshes.icosphere(0.9, level)
    body = solid(mesh)
    grid = grid_about(body)
    depth = 0.9 - float(np.abs(np.einsum("fc,fc->f", mesh.triangles[:, 0], normals(mesh))).min())
    error = signed(body, grid) - to_ball(centers(grid), 0.9)
    assert error.min() >= -1e-7 and error.max() <= depth + 1e-7  # the mesh lies within the ball
    assert error.max() > 0.3 * depth


def normals(built: MeshData) -> Array:
    a, b, c = np.moveaxis(built.triangles, 1, 0)
    across = np.cross(b - a, c - a)
    result: Array = across / np.linalg.norm(across, axis=1, keepdims=True)
    return result


@pytest.mark.slow
@pytest.mark.parametrize("shape", ["ball", "torus"])
def test_a_fine_mesh_has_the_closed_forms_distance(shape: str) -> None:
    """Within 1e-6 of the diagonal, of which its triangles take the most: their corners stand a little outside."""
    if shape == "ball":
        mesh = meshes.icosphere(1.0 + 1.8e-6, 8)

        def exact(points: Array) -> Array:
            return to_ball(points, 1.0)

    else:
        mesh = meshes.torus(1.0, 0.4 + 3.4e-6 * 0.75, 1600, 800)

        def exact(points: Array) -> Array:
            return to_torus(points, 1.0, 0.4)

    body = solid(mesh)
    grid = grid_about(body, 40, 0.05)
    assert dent(mesh, exact) <= 0.95e-6 * grid.diagonal
    expected = exact(centers(grid))
    error = np.abs(signed(body, grid) - expected).max()
    print(f"{shape}: {len(mesh.faces)} triangles, worst error {error / grid.diagonal:.2e} of the diagonal")
    assert error <= 1e-6 * grid.diagonal
    assert 0.1 < (expected < 0.0).mean() < 0.9


# All triangles, one by one


def to_triangles(points: Array, triangles: Array) -> Array:
    """The distance of points (n, 3) to the nearest of triangles: to their planes, or to their edges."""
    nearest = np.full(len(points), np.inf)
    for corners in triangles:
        edges = np.roll(corners, -1, axis=0) - corners
        normal = np.cross(edges[0], edges[1])
        normal /= np.linalg.norm(normal)
        ways = points[:, None] - corners
        above = np.einsum("nvc,vc->nv", ways, np.cross(normal, edges)) >= 0.0
        along = np.clip(np.einsum("nvc,vc->nv", ways, edges) / np.einsum("vc,vc->v", edges, edges), 0.0, 1.0)
        to_edges = np.linalg.norm(ways - along[..., None] * edges, axis=2).min(axis=1)
        nearest = np.minimum(nearest, np.where(above.all(axis=1), np.abs(ways[:, 0] @ normal), to_edges))
    return nearest


def turns(points: Array, triangles: Array) -> Array:
    """The winding number: the sum of the solid angles (Van Oosterom and Strackee 1983)."""
    total = np.zeros(len(points))
    for corners in triangles:
        a, b, c = np.moveaxis(corners - points[:, None], 1, 0)
        la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
        volume = np.einsum("nc,nc->n", a, np.cross(b, c))
        dots = [np.einsum("nc,nc->n", *pair) for pair in ((a, b), (b, c), (c, a))]
        total += 2.0 * np.arctan2(volume, la * lb * lc + dots[0] * lc + dots[1] * la + dots[2] * lb)
    result: Array = total / (4.0 * np.pi)
    return result


def tilted(result: MeshData, by: float) -> MeshData:
    """Turned about y and a little about x, so that no voxel's centre lies in a face."""
    y, x = np.radians([by, 0.4 * by])
    about_y = np.array([[np.cos(y), 0.0, np.sin(y)], [0.0, 1.0, 0.0], [-np.sin(y), 0.0, np.cos(y)]])
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, np.cos(x), -np.sin(x)], [0.0, np.sin(x), np.cos(x)]])
    return result._replace(vertices=result.vertices @ about_y.T @ about_x.T)


def noisy(result: MeshData, by: float) -> MeshData:
    return result._replace(vertices=result.vertices + rng().normal(scale=by, size=result.vertices.shape))


CUBE = meshes.box()
HOLLOW = joined(CUBE, meshes.box((0.5, 0.5, 0.5)).inverted())
FIN = MeshData(np.array([[-0.5, 0.5, -0.5], [0.5, 0.5, -0.5], [0.0, 0.9, -0.5]]), np.array([[0, 1, 2]]))
BALL = meshes.icosphere(0.7, 2)
ODD = {
    "closed": tilted(CUBE, 20.0),
    "a missing face": tilted(CUBE.without(4, 5), 20.0),
    "a missing triangle": tilted(CUBE.without(7), 20.0),
    "inside out": tilted(CUBE, 20.0).inverted(),
    "open and inside out": tilted(CUBE.without(0), 20.0).inverted(),
    "self-intersecting": noisy(meshes.icosphere(0.6, 2), 0.15),
    "two that overlap": joined(tilted(CUBE, 20.0), tilted(CUBE, 50.0).moved((0.4, 0.3, 0.2))),
    "two apart": joined(tilted(CUBE, 20.0), tilted(meshes.box((0.3, 0.3, 0.3)), 10.0).moved((1.2, 0.3, 0.2))),
    "hollow": tilted(HOLLOW, 20.0),
    "hollow and open": tilted(HOLLOW.without(3, 20), 20.0),
    "a fin": tilted(joined(CUBE, FIN), 20.0),  # three triangles at an edge
    "every face twice": tilted(joined(CUBE, CUBE), 20.0),
    "half a ball": BALL.without(*np.flatnonzero(BALL.triangles.mean(axis=1)[:, 1] > 0.05)),
    "two thirds of its faces": BALL.without(*range(0, 320, 3)),
}


@pytest.mark.parametrize("name", ODD)
def test_distance_and_sign_of_odd_meshes_are_those_of_all_their_triangles(name: str) -> None:
    result = ODD[name]
    body = solid(result)
    grid = grid_about(body, 14)
    points = centers(grid)
    unsigned = distances(body, grid)
    exact = to_triangles(points, result.triangles)
    assert np.abs(unsigned.ravel() - exact).max() <= 2e-7 * grid.diagonal
    turn = turns(points, result.triangles)
    turn = -turn if name in ("inside out", "open and inside out") else turn
    results = inside(body, grid, unsigned).ravel()
    clear = np.abs(turn - INSIDE) > 0.02  # the error of the fast winding number
    assert (results == (turn > INSIDE))[clear].all()
    assert clear.mean() > 0.9 and 0.01 < results.mean() < 0.9


@pytest.mark.parametrize("name", ODD)
@pytest.mark.parametrize("resolution", [9, 29])
def test_blocks_have_the_sign_of_every_voxel_in_them(name: str, resolution: int) -> None:
    body = solid(ODD[name])
    grid = grid_about(body, resolution)
    assert (inside(body, grid, distances(body, grid)).ravel() == (body.winding_number(centers(grid)) > INSIDE)).all()


def test_a_cavity_is_outside() -> None:
    grid = grid_about(solid(HOLLOW), 21)
    result = signed(solid(HOLLOW), grid)
    places = centers(grid)
    assert (result[np.abs(places).max(axis=1) < 0.24] > 0.0).all()
    assert (result[(np.abs(places).max(axis=1) > 0.26) & (np.abs(places).max(axis=1) < 0.49)] < 0.0).all()


def vote(result: Array, points: Array, rays: int) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
    """Which points all of so many random rays call outside, and which most of them call inside, by their parity."""
    odd = np.zeros(len(points), np.int64)
    for seed in range(rays):
        ways = rng(seed).normal(size=points.shape)
        _, met = meshes.crossings(result, points, ways / np.linalg.norm(ways, axis=1, keepdims=True))
        odd += met.sum(axis=1) % 2
    return odd == 0, 2 * odd > rays


def leak(path: Path, resolution: int, rays: int) -> tuple[float, float]:
    """The share of voxels that all rays call outside which are inside; and of those most rays call inside, outside."""
    mesh = Mesh(path=str(path))
    grid = grid_about(mesh.solid, resolution, 0.05)
    result = inside(mesh.solid, grid, distances(mesh.solid, grid)).ravel()
    outside, within = vote(mesh.triangles.places[mesh.triangles.corners], centers(grid), rays)
    return float(result[outside].mean()), float(1.0 - result[within].mean())


@pytest.mark.slow
@needs_meshes
def test_suzanne_does_not_leak() -> None:
    outside, within = leak(SUZANNE, 18, 7)
    assert outside <= 1e-3, outside
    assert within < 0.1, within


@pytest.mark.slow
@needs_meshes
def test_suzanne_does_not_leak_in_fine_voxels() -> None:
    outside, within = leak(SUZANNE, 48, 7)
    print(f"Suzanne: {outside:.4%} of the exterior is inside, {within:.3%} of the interior is outside")
    assert outside <= 1e-3, outside
    assert within < 0.1, within


# The grid, and what the JSON says


def test_a_coarse_grid_has_voxels_outside() -> None:
    """Where there is padding, a voxel of it on every side."""
    volume = sdf(write(Path("body.obj"), meshes.box((1.0, 2.0, 1.0))), (6,), encoding="r32f")
    signs = decode(volume.texels, volume.reach, "r32f") > 0.0
    shell = np.ones(signs.shape, np.bool_)
    shell[1:-1, 1:-1, 1:-1] = False
    assert signs[shell].all() and not signs.all()


def test_an_uncertain_sign_is_reported() -> None:
    whole, box = meshes.box(), meshes.box()
    cut = box._replace(faces=box.faces[2:])
    assert "but" not in sdf(write(Path("whole.obj"), whole), (12,)).facts["error"]
    assert "holes" in sdf(write(Path("cut.obj"), cut), (12,)).facts["error"]["but"]


def test_voxels_are_cubes_and_the_box_is_padded() -> None:
    path = write(Path("body.obj"), meshes.box((1.0, 2.0, 0.5)).moved((5.0, 0.0, -3.0)))
    volume = sdf(path, (40,), padding=0.1)
    voxel = volume.grid.voxel
    assert voxel == pytest.approx(np.full(3, 2.4 / 40.0))
    assert volume.grid.counts == (24, 40, 15)  # (1 + 0.4) / 0.06 and (0.5 + 0.4) / 0.06, and up
    assert volume.texels.shape == (15, 40, 24)
    assert volume.grid.low[1] == pytest.approx(-1.2) and volume.grid.high[1] == pytest.approx(1.2)
    assert (volume.grid.low <= np.array([4.5, -1.0, -3.25]) - 0.2 + 1e-12).all()
    assert (volume.grid.high >= np.array([5.5, 1.0, -2.75]) + 0.2 - 1e-12).all()
    assert 0.5 * (volume.grid.low + volume.grid.high) == pytest.approx([5.0, 0.0, -3.0])


def test_three_counts_set_the_resolution() -> None:
    volume = sdf(write(Path("body.obj"), meshes.box((1.0, 2.0, 0.5))), (8, 16, 9), padding=0.25)
    assert volume.texels.shape == (9, 16, 8)
    assert volume.facts["texels"] == [8, 16, 9]
    assert volume.grid.high - volume.grid.low == pytest.approx([2.0, 3.0, 1.5])
    assert volume.facts["voxel"] == pytest.approx([2.0 / 8, 3.0 / 16, 1.5 / 9])


def test_the_facts_describe_the_texture() -> None:
    path = write(Path("body.obj"), meshes.box((1.0, 2.0, 0.5)).moved((5.0, 0.0, -3.0)).without(0))
    volume = sdf(path, (20,), encoding="r8")
    facts = volume.facts
    assert facts["box_min"] == volume.grid.low.tolist() and facts["box_max"] == volume.grid.high.tolist()
    assert facts["parameters"] == {
        "box_min": facts["box_min"], "box_max": facts["box_max"], "distance_range": facts["range"]
    }  # fmt: skip
    assert facts["mesh"]["triangles"] == 11 and not facts["mesh"]["closed"] and not facts["mesh"]["inside_out"]
    assert facts["mesh"]["box_min"] == [4.5, -1.0, -3.25] and facts["mesh"]["box_max"] == [5.5, 1.0, -2.75]
    body = Mesh(path=path).solid
    exact = signed(body, volume.grid)
    assert facts["range"] == pytest.approx(np.abs(exact).max())
    assert facts["inside"] == pytest.approx((exact < 0.0).mean(), abs=1e-6)
    assert facts["beyond_range"] == 0.0
    near = sdf(path, (20,), reach=0.1)
    assert near.facts["range"] == 0.1
    assert near.facts["beyond_range"] == pytest.approx((np.abs(exact) > 0.1).mean(), abs=1e-6)


def test_vertices_of_no_triangle_do_not_widen_the_box() -> None:
    stray = MeshData(np.array([[50.0, 0.0, 0.0]]), np.zeros((0, 3), np.int64))
    assert sdf(write(Path("body.ply"), joined(CUBE, stray)), (8,)).facts["mesh"]["box_max"] == [0.5, 0.5, 0.5]


def test_a_thin_plate_has_cubic_voxels() -> None:
    volume = sdf(write(Path("body.obj"), meshes.box((1.0, 0.02, 1.0))), (64,), padding=0.05)
    assert volume.grid.voxel == pytest.approx(np.full(3, 1.1 / 64.0))
    assert volume.grid.counts == (64, 7, 64)
    exact = to_box(centers(volume.grid), [0.5, 0.01, 0.5])
    assert np.abs(stored(volume) - exact).max() <= volume.facts["error"]["at_texels"]


def test_a_sheet_has_the_requested_thickness() -> None:
    square = MeshData(
        np.array([[-0.5, 0, -0.5], [-0.5, 0, 0.5], [0.5, 0, 0.5], [0.5, 0, -0.5]], float),
        np.array([[0, 1, 2], [0, 2, 3]]),
    )
    path = write(Path("sheet.obj"), square)
    with pytest.raises(SssgenError, match="flat sheet"):
        sdf(path, (16,))
    volume = sdf(path, (32,), thin=0.2)
    exact = to_box(centers(volume.grid), [0.5, 0.0, 0.5]) - 0.1
    assert np.abs(stored(volume) - exact).max() <= volume.facts["error"]["at_texels"]
    assert volume.facts["inside"] == pytest.approx((exact < 0.0).mean(), abs=1e-6) and volume.facts["inside"] > 0.05


def test_padding_0_still_has_a_box() -> None:
    volume = sdf(write(Path("body.obj"), CUBE), (8,), padding=0.0)
    assert volume.facts["box_min"] == [-0.5, -0.5, -0.5] and volume.facts["inside"] == 1.0


def test_an_inverted_mesh_is_reported_and_has_the_right_sign() -> None:
    volume = sdf(write(Path("body.obj"), CUBE.inverted()), (12,))
    assert volume.facts["mesh"]["inside_out"] and volume.facts["mesh"]["closed"]
    assert np.array_equal(volume.texels, sdf(write(Path("right.obj"), CUBE), (12,)).texels)


# What is stored


def stored(built: Volume) -> Array:
    """The distances that the texels encode, (z y x,)."""
    result: Array = decode(built.texels, built.reach, built.facts["encoding"]).ravel()
    return result


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("reach", [None, 0.2])
def test_the_error_is_within_the_reported_bound(encoding: str, reach: float | None) -> None:
    volume = sdf(write(Path("body.obj"), tilted(meshes.box((1.0, 0.7, 0.4)), 25.0)), (30,), 0.2, encoding, reach)
    mesh = Mesh(path="body.obj")
    exact = np.clip(mesh.distance(centers(volume.grid)), -volume.reach, volume.reach)
    message = volume.facts["error"]
    off = np.abs(stored(volume) - exact)
    assert off.max() <= message["at_texels"]
    # the bound is no wish: the steps are as coarse as that
    floor = {"r8": 0.5, "r16": 0.5, "r16f": 0.5, "r32f": 0.0}[encoding]
    assert off.max() >= floor * message["at_texels"]
    points = rng().uniform(
        volume.grid.low + 0.5 * volume.grid.voxel, volume.grid.high - 0.5 * volume.grid.voxel, (20_000, 3)
    )
    between = np.abs(sampled(volume, points) - np.clip(mesh.distance(points), -volume.reach, volume.reach))
    assert between.max() <= message["between_texels"] + message["at_texels"]


def sampled(result: Volume, points: Array) -> Array:
    """The distance by the library's technique."""
    function: Array = technique("distance_texture")(
        p=points, distance_map=texture(result), **result.facts["parameters"]
    )
    return function


def texture(result: Volume) -> Texture:
    texels = result.texels.astype(np.float64) / ENCODINGS[result.facts["encoding"]].unit
    return Texture(texels[..., None], "linear", "clamp")


# The march through the texture


def on_the_surface(mesh: Mesh, count: int, seed: int = 3) -> tuple[Array, Array]:
    """Places that are spread over the triangles, and directions to lights, of which the most are behind."""
    corners = mesh.triangles.places[mesh.triangles.corners]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    face = rng(seed).choice(len(area), count, p=area / area.sum())
    weights = rng(seed + 1).dirichlet([1.0, 1.0, 1.0], count)
    ways = rng(seed + 2).normal(size=(count, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    before = np.einsum("nc,nc->n", ways, mesh.triangles.flat[face]) > 0.0
    ways[before & (rng(seed + 3).random(count) < 0.8)] *= -1.0
    return np.einsum("nv,nvc->nc", weights, corners[face]), ways


def marched(result: Volume, points: Array, ways: Array, method: str = "march_light", steps: int = 400) -> Array:
    function: Array = technique(method, body_distance="distance_texture_world")(
        P=points,
        L=ways,
        reach=result.grid.diagonal,
        steps=steps,
        distance_map=texture(result),
        **result.facts["parameters"],
    )
    return function


@needs_meshes
@pytest.mark.parametrize(
    ("path", "method", "steps"),
    diagonal(
        [pytest.param(SPOT, id="spot"), pytest.param(SUZANNE, id="suzanne")],
        [pytest.param("march_light", 400), pytest.param("march_light_traced", 64)],
    ),
)
def test_the_marched_thickness_is_right_to_a_voxel(path: Path, method: str, steps: int) -> None:
    mesh = Mesh(path=str(path))
    points, ways = on_the_surface(mesh, 2000)
    exact = thickness(mesh, points, ways)
    volume = sdf(str(path), (64,))
    error = np.abs(marched(volume, points, ways, method, steps) - exact) / volume.grid.voxel.max()
    print(f"{path.stem}, {method}: median {np.median(error):.3f} voxels, 90 % within {np.percentile(error, 90):.2f}")
    assert np.median(exact) > 5.0 * volume.grid.voxel.max()
    assert np.median(error) <= 1.0


def test_added_matter_never_reduces_thickness() -> None:
    """But for what texels leave open: where a ray is steep on all faces, a wall that moves by less than a voxel."""
    first, second = tilted(CUBE, 20.0), tilted(meshes.box((0.6, 0.6, 1.6)), 50.0).moved((0.3, 0.2, 0.1))
    ends = [meshes.box((0.01, 0.01, 0.01)).moved(place) for place in (np.full(3, -1.0), np.full(3, 1.2))]
    alone = Mesh(path=write(Path("alone.ply"), first))
    before = sdf(write(Path("one.ply"), joined(first, *ends)), (64,))
    after = sdf(write(Path("both.ply"), joined(first, second, *ends)), (64,))
    assert np.array_equal(before.grid.low, after.grid.low)  # the ends are there for this
    points, ways = on_the_surface(alone, 4000)
    less = (marched(before, points, ways) - marched(after, points, ways)) / after.grid.voxel.max()
    steep = np.abs(ways @ np.concatenate([normals(first), normals(second)]).T).min(axis=1) > 0.2
    assert less[steep].max() <= 2.0 and steep.sum() > 500
    assert np.percentile(less, 99) <= 1.0
    assert less.min() < -0.3 / after.grid.voxel.max()  # thicker where the other is in the way
