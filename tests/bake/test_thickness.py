"""`sssgen bake thickness` and `depth` against closed forms, quadrature and every triangle; errors, seams, new uv."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bake_meshes as meshes
from bake_meshes import SPOT, SUZANNE, Array, MeshData, by_quadrature, needs_meshes, to_exit, write
from oracle import technique
from slow_cases import diagonal, some_slow
from sssgen.support.diagnostics import SssgenError

pytest.importorskip("trimesh", reason="trimesh is missing: pip install -e '.[bake]'")
pytest.importorskip("embreex", reason="embreex is missing: pip install -e '.[bake]'")
pytest.importorskip("scipy", reason="SciPy is missing: pip install -e '.[bake]'")
pytest.importorskip("xatlas", reason="xatlas is missing: pip install -e '.[bake]'")
pytest.importorskip("psutil", reason="psutil is missing: pip install -e '.[bake]'")

from sssgen.bake import texture_unwrap as unwrap
from sssgen.bake.atlas import Atlas, atlas
from sssgen.bake.bake_light import BakeLight
from sssgen.bake.chord_lengths import Chords, inward
from sssgen.bake.depth_map import depth_map
from sssgen.bake.thickness_map import Map, Request, thickness_map, warnings
from sssgen.jobs.executor import Failure, run
from sssgen.scene.body_identity import has_measures
from sssgen.scene.mesh import Mesh
from sssgen.targets.runtime.numpy_textures import Texture

pytestmark = pytest.mark.usefixtures("in_folder")


def rng(seed: int = 5) -> np.random.Generator:
    return np.random.default_rng(seed)


def unit(vectors: Any) -> Array:
    result: Array = np.asarray(vectors, float) / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return result


def shown(path: str, size: tuple[int, int]) -> Atlas:
    mesh = Mesh(path=path).triangles
    assert mesh.uv is not None
    return atlas(mesh, mesh.uv, size, path)


def sampled(path: str, at: Atlas, rays: int, attenuation: float = 0.0, seed: int = 0) -> Chords:
    return inward(path, str(Path(path).resolve()), at.places, at.flat, rays, attenuation, (seed, 0))


def baked(path: str, size: tuple[int, int], expected: Request, unwrap: bool = False) -> Map:
    return thickness_map(path, size, expected, unwrap, processes=0)


def lengths(built: Map, at: Atlas) -> Array:
    """The places that the texels of an atlas cover."""
    result: Array = built.values.ravel()[at.texels] * built.facts["range"][1]
    return result


def assert_sound(value: Array, exact: Any, error: Array, bias: float = 0.0) -> None:
    """The errors are within the reported standard errors, as often as expected."""
    z = (value - exact) / error
    assert abs(z.mean()) <= 4.0 / np.sqrt(len(z)) + bias / error.mean(), z.mean()
    assert 0.85 <= np.sqrt((z**2).mean()) <= 1.3
    assert (np.abs(z) > 3.0).mean() <= 0.02  # 0.0027 of a normal distribution, and a margin for estimated errors
    assert (np.abs(value - exact) <= 6.0 * error + bias).all()


# A ball


@pytest.fixture(scope="module")
def globe(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Radius 0.8; its normals are off by 0.03 at most, and its lengths by about the square of that."""
    return write(tmp_path_factory.mktemp("globe") / "globe.obj", meshes.globe(0.8, 160, 80))


BIAS = 3e-4
"""Of lengths in the tessellated ball."""


def test_a_ball_is_four_thirds_of_its_radius(globe: str) -> None:
    texels = shown(globe, (32, 16))
    assert len(texels.texels) == 32 * 16
    samples = sampled(globe, texels, 256)
    assert_sound(samples.value, 4.0 / 3.0 * 0.8, samples.error, BIAS)
    assert samples.lost.max() <= 0.01


@pytest.mark.parametrize("depth", some_slow([0.3, 1.0, 20.0], 1.0))
def test_a_ball_has_its_analytic_transmittance(globe: str, depth: float) -> None:
    """With chords 2 R cos, weighted by the cosine: 2 (1 - (1 + a) exp(-a)) / a², a = 2 R / depth."""
    a = 2.0 * 0.8 / depth
    samples = sampled(globe, shown(globe, (24, 12)), 512, depth)
    exact = 2.0 * (1.0 - (1.0 + a) * np.exp(-a)) / a**2
    assert_sound(samples.value, exact, samples.error, BIAS * min(1.0, 1.0 / depth))
    mean = sampled(globe, shown(globe, (24, 12)), 512).value
    assert (samples.value >= np.exp(-mean / depth) - 1e-9).all() and (samples.value <= 1.0).all()  # Jensen


def test_the_standard_error_is_the_spread_over_seeds(globe: str) -> None:
    texels = shown(globe, (12, 6))
    runs = [sampled(globe, texels, 64, seed=seed) for seed in range(40)]
    spread = np.var([run.value for run in runs], axis=0, ddof=1)
    output = np.mean([run.error**2 for run in runs], axis=0)
    assert spread.mean() == pytest.approx(output.mean(), rel=0.08)  # of 39 · 72 degrees of freedom: 2.7 %
    assert not np.array_equal(runs[0].value, runs[1].value)


def test_four_times_the_rays_halve_the_error_or_better(globe: str) -> None:
    texels = shown(globe, (16, 8))
    few, many = sampled(globe, texels, 64).error.mean(), sampled(globe, texels, 256).error.mean()
    assert many < 0.55 * few


def test_the_facts_of_a_map(globe: str) -> None:
    result = baked(globe, (32, 16), Request(rays=64))
    assert result.facts["mean"] == pytest.approx(4.0 / 3.0 * 0.8, rel=2e-3)
    assert result.facts["parameters"] == {"thickness_factor": result.facts["range"][1]}
    assert result.values.max() == 1.0 and result.values.min() > 0.98
    assert result.facts["holds"] == "thickness" and not result.mesh
    assert result.facts["rays"] == 0 and result.facts["by_rays"] == 0.0


def test_the_facts_of_a_map_by_rays(globe: str) -> None:
    result, at = baked(globe, (32, 16), Request("transmittance", rays=64, attenuation=0.7)), shown(globe, (32, 16))
    assert result.facts["rays"] == 64 and result.facts["by_rays"] == 1.0 and result.facts["parameters"] == {}
    message = result.facts["error"]
    exact = sampled(globe, at, 64, 0.7)  # one block of work, with the same rays
    assert lengths(result, at) == pytest.approx(exact.value, abs=1e-12)
    assert message["mean_standard_error"] == pytest.approx(exact.error.mean())
    assert message["largest_standard_error"] == pytest.approx(exact.error.max())


# A box, and a wide plate


@pytest.mark.parametrize(
    ("depth", "size"), diagonal([0.0, 0.4], [pytest.param((1.0, 1.4, 0.6)), pytest.param((2.0, 0.05, 2.0))])
)
def test_a_box_has_its_integral(size: Any, depth: float) -> None:
    path = write(Path("box.obj"), meshes.box(size))
    texels = shown(path, (48, 32))
    some = rng().choice(len(texels.texels), 150, replace=False)
    samples = sampled(path, texels._replace(places=texels.places[some], flat=texels.flat[some]), 512, depth)

    def light(length: Array) -> Array:
        return np.exp(-length / depth) if depth else length

    pairs = zip(texels.places[some], texels.flat[some], strict=True)
    exact = np.array([by_quadrature(np.array(size), place, flat, light) for place, flat in pairs])
    assert_sound(samples.value, exact, samples.error, 2e-4)


def test_the_middle_of_a_wide_plate_is_twice_its_thickness() -> None:
    """2 t for an infinite one; what is beyond the radius r is missing: t²/r at most, in the mean over its disk."""
    path = write(Path("plate.obj"), meshes.box((10.0, 0.05, 10.0)))
    texels = shown(path, (96, 64))
    middle = (np.abs(texels.flat[:, 1]) == 1.0) & (np.hypot(*texels.places[:, [0, 2]].T) < 3.0)
    samples = sampled(path, texels._replace(places=texels.places[middle], flat=texels.flat[middle]), 1024)
    assert middle.sum() > 200
    assert samples.value.mean() == pytest.approx(
        0.1, abs=4.0 * samples.error.mean() / np.sqrt(middle.sum()) + 0.05**2 / 2.0
    )


def test_straight_in_is_exact() -> None:
    size = np.array([1.0, 2.0, 3.0])
    path = write(Path("box.obj"), meshes.box(size))
    made, at = baked(path, (60, 40), Request("chord")), shown(path, (60, 40))
    assert lengths(made, at) == pytest.approx(np.abs(at.flat) @ size, abs=1e-6)
    assert made.facts["error"]["largest_standard_error"] == 0.0 and made.facts["rays"] == 1


@pytest.mark.parametrize(
    "light", [BakeLight(unit([0.3, 0.9, -0.4]), True), BakeLight(np.array([2.0, 3.0, 4.0]), False)]
)
@pytest.mark.parametrize("depth", [0.0, 0.7])
def test_thickness_towards_a_light_is_exact(light: BakeLight, depth: float) -> None:
    size = np.array([1.0, 2.0, 3.0])
    path = write(Path("box.obj"), meshes.box(size).moved((0.1, 0.2, 0.3)))
    expected = Request("transmittance" if depth else "mean", light, attenuation=depth)
    result, at = baked(path, (60, 40), expected), shown(path, (60, 40))
    ways = np.tile(light.place, (len(at.places), 1)) if light.afar else unit(light.place - at.places)
    lit = np.einsum("nc,nc->n", ways, at.flat) > 0.0
    exact = np.where(lit, 0.0, to_exit(size, at.places - [0.1, 0.2, 0.3], ways))
    assert lengths(result, at) == pytest.approx(np.exp(-exact / depth) if depth else exact, abs=1e-5)
    assert 0.1 < lit.mean() < 0.9


def test_an_inverted_mesh_has_the_same_thickness() -> None:
    ring = meshes.torus(1.0, 0.4, 24, 12)
    turned = ring._replace(faces=ring.faces[:, ::-1], uv=None if ring.uv is None else ring.uv[:, ::-1])
    right, wrong = (
        thickness_map(write(Path(name), one), (48, 48), Request(rays=64), True, processes=0)
        for name, one in (("ring.obj", ring), ("turned.obj", turned))
    )
    assert wrong.facts["mesh"]["inside_out"] and not right.facts["mesh"]["inside_out"]
    assert wrong.facts["lost_rays"] < 0.01 and wrong.facts["mean"] == pytest.approx(right.facts["mean"], rel=0.02)
    (warning,) = warnings(wrong.facts)
    assert (
        warning == "the mesh is inside out: all its triangles are turned for the bake and in the mesh that is written"
    )
    Path("written.obj").write_text(wrong.mesh, encoding="utf-8")
    written = Mesh(path="written.obj").triangles
    assert Mesh(path="turned.obj").triangles.reversed and not written.reversed
    assert has_measures(wrong.facts["mesh"], written.places, written.corners)
    again = thickness_map("written.obj", (48, 48), Request(rays=64), processes=0)
    assert again.values == pytest.approx(wrong.values, abs=1e-3) and warnings(again.facts) == []


def test_an_inverted_mesh_with_a_hole_is_written_outwards() -> None:
    box = meshes.box()
    path = write(Path("box.obj"), box._replace(faces=box.faces[:-2, ::-1], uv=None))
    assert Mesh(path=path).inside_out
    Path("written.obj").write_text(thickness_map(path, (24, 16), Request(rays=64), processes=0).mesh, encoding="utf-8")
    assert not Mesh(path="written.obj").inside_out


def test_a_hole_is_reported_and_its_rays_do_not_count() -> None:
    path = write(Path("box.obj"), meshes.box()._replace(faces=meshes.box().faces[:-2], uv=meshes.box().uv[:-2]))
    result = baked(path, (24, 16), Request(rays=64))
    assert 0.05 < result.facts["lost_rays"] < 0.5
    assert result.facts["by_rays"] == 1.0 and result.facts["rays"] == 64


# A mesh of many triangles


@needs_meshes
def test_spot_has_the_integral_over_all_her_triangles() -> None:
    """She is closed: a ray that starts inward is inside up to the first triangle, and again from the second on."""
    texels = shown(str(SPOT), (64, 64))
    some = rng().choice(len(texels.texels), 5, replace=False)
    places, flat = texels.places[some], texels.flat[some]
    samples = sampled(str(SPOT), texels._replace(places=places, flat=flat), 8192)
    mesh = Mesh(path=str(SPOT)).triangles
    for at_texel, (place, normal) in enumerate(zip(places, flat, strict=True)):
        # uniform on the ball that touches the surface: weighted by the cosine about −normal
        ways = unit(unit(rng(at_texel).normal(size=(400, 3))) - normal)
        t, met = meshes.crossings(mesh.places[mesh.corners], np.tile(place, (len(ways), 1)), ways)
        met &= t > 1e-6
        crossings = np.sort(np.where(met, t, np.inf), axis=1)[:, :12]
        assert (np.isfinite(crossings).sum(axis=1) % 2 == 1).mean() > 0.99
        ends = np.where(np.isfinite(crossings), crossings, 0.0)
        length = (ends * np.where(np.arange(12) % 2 == 0, 1.0, -1.0)).sum(axis=1)
        error = np.hypot(samples.error[at_texel], length.std() / np.sqrt(len(length)))
        assert abs(length.mean() - samples.value[at_texel]) <= 4.0 * error + 1e-3 * length.mean()


# Texture coordinates


def on_edges(result: MeshData, count: int = 60) -> tuple[Array, Array]:
    """uv on the edges of every face's triangle, (n, 2), and the faces they are of."""
    assert result.uv is not None
    along = np.linspace(0.0, 1.0, count)[:, None]
    points = [(1.0 - along) * face[a] + along * face[b] for face in result.uv for a, b in ((0, 1), (1, 2), (2, 0))]
    return np.concatenate(points), np.repeat(np.arange(len(result.uv)), 3 * count)


def test_seams_mix_nothing_in() -> None:
    """A box whose three pairs of faces have a length each: what is sampled on a chart's edge is its own."""
    size = np.array([1.0, 2.0, 3.0])
    mesh = meshes.box(size)
    baked_map = baked(write(Path("box.obj"), mesh), (60, 40), Request("chord"))
    assert baked_map.values.min() > 0.3  # no texel is left empty
    uv, faces = on_edges(mesh)
    texture = Texture(np.flipud(baked_map.values)[..., None], "linear", "repeat")
    result = texture.sample(uv.T)[0] * baked_map.facts["range"][1]
    normal = np.cross(*(mesh.triangles[:, 1:] - mesh.triangles[:, :1]).transpose(1, 0, 2))
    assert result == pytest.approx(np.abs(unit(normal)[faces]) @ size, abs=1e-5)


def test_a_ball_has_no_seam(globe: str) -> None:
    result = baked(globe, (32, 16), Request(rays=256))
    texture = Texture(np.flipud(result.values)[..., None], "linear", "clamp")
    along = np.linspace(0.0, 1.0, 200)
    for uv in (np.array([0.0 * along, along]), np.array([0.0 * along + 1.0, along]), np.array([along, 0.0 * along])):
        assert texture.sample(uv)[0] * result.facts["range"][1] == pytest.approx(4.0 / 3.0 * 0.8, rel=0.03)


def covered(uv: Array, size: int) -> Any:
    """The number of triangles that contain each texel's centre, (size, size)."""
    count = np.zeros((size, size), np.int64)
    for corners in uv * size - 0.5:
        low, high = np.ceil(corners.min(axis=0)).astype(int), np.floor(corners.max(axis=0)).astype(int)
        x, y = np.meshgrid(np.arange(low[0], high[0] + 1), np.arange(low[1], high[1] + 1))
        edges = np.roll(corners, -1, axis=0) - corners
        sides = [
            edge[0] * (y - start[1]) - edge[1] * (x - start[0]) for start, edge in zip(corners, edges, strict=True)
        ]
        within = np.all([side > 1e-6 for side in sides], axis=0) | np.all([side < -1e-6 for side in sides], axis=0)
        count[low[1] : high[1] + 1, low[0] : high[0] + 1] += within
    return count


@needs_meshes
def test_suzanne_gets_texture_coordinates() -> None:
    result = baked(str(SUZANNE), (128, 128), Request(rays=16))
    assert result.facts["mesh"]["new_uv"] and result.facts["mesh"]["shared_texels"] < 0.02
    Path("new.obj").write_text(result.mesh, encoding="utf-8")
    old, new = Mesh(path=str(SUZANNE)).triangles, Mesh(path="new.obj").triangles
    assert new.places[new.corners] == pytest.approx(old.places[old.corners], abs=1e-6)
    assert new.uv is not None and new.uv.min() >= 0.0 and new.uv.max() <= 1.0
    count = covered(new.uv, 512)
    assert count.max() == 1 and (count == 1).mean() > 0.4
    assert result.values.min() > 0.0  # no texel is left empty
    # the map fits the mesh that was written: baked on that, it is the same
    again = baked("new.obj", (128, 128), Request(rays=16))
    assert not again.facts["mesh"]["new_uv"]
    assert np.median(np.abs(again.values - result.values)) < 0.02


def test_texture_coordinates_on_another_tile_are_accepted(globe: str) -> None:
    mesh = meshes.box((1.0, 2.0, 3.0))
    here = baked(write(Path("here.obj"), mesh), (30, 20), Request("chord"))
    assert mesh.uv is not None
    moved = baked(
        write(Path("there.obj"), mesh._replace(uv=mesh.uv + np.array([0.5, -0.25]))), (30, 20), Request("chord")
    )
    assert moved.values == pytest.approx(np.roll(here.values, (5, 15), axis=(0, 1)), abs=1e-6)


@pytest.mark.parametrize(("scale", "message"), [(10.0, "repeat the map"), (0.0, "no area")])
def test_texture_coordinates_that_do_not_fit(scale: float, message: str) -> None:
    mesh = meshes.box()
    assert mesh.uv is not None
    path = write(Path("box.obj"), mesh._replace(uv=scale * mesh.uv))
    with pytest.raises(SssgenError, match=message):
        baked(path, (16, 16), Request("chord"))
    assert baked(path, (64, 64), Request("chord"), unwrap=True).facts["mean"] == pytest.approx(1.0, abs=1e-5)


def test_overlapping_charts_are_reported() -> None:
    mesh = meshes.box()
    assert mesh.uv is not None
    once = np.concatenate([mesh.uv[:2]] * 6)
    facts = baked(write(Path("box.obj"), mesh._replace(uv=once)), (60, 40), Request("chord")).facts
    assert facts["mesh"]["shared_texels"] == pytest.approx(5.0 / 6.0, abs=0.02)


# Depth


@pytest.mark.parametrize(
    "light",
    [BakeLight(unit([0.3, 0.9, -0.4]), True), BakeLight(np.array([2.0, 1.0, 1.5]), False)],
    ids=["afar", "near"],
)
def test_the_depth_map_of_a_ball_is_its_chord(globe: str, light: BakeLight) -> None:
    """By the library's technique: how far behind the first surface a place lies, along the light's axis."""
    count = 256
    depth, facts = depth_map(globe, light, (count, count))
    places = 0.8 * unit(rng().normal(size=(4000, 3)))
    ways = np.tile(light.place, (len(places), 1)) if light.afar else unit(light.place - places)
    slope = np.einsum("nc,nc->n", ways, unit(places))
    function = technique("depth_map_thickness")(
        P=places,
        light_depth_map=Texture(np.flipud(depth)[..., None], "linear", "clamp"),
        light_matrix=np.reshape(facts["parameters"]["light_matrix"], (4, 4)).T,
        bias=0.0,
    )
    axis = light.place if light.afar else unit(light.place)
    exact = np.where(slope < 0.0, -2.0 * 0.8 * slope, 0.0) * (ways @ axis)
    # a texel of the map, on the side that the light meets: how much deeper is the next one
    texel = 1.1 * 1.6 * (1.0 if light.afar else 1.5) / count
    clear = np.abs(slope) > 0.3
    assert np.abs(function - exact)[clear].max() <= texel / 0.3
    assert np.median(np.abs(function - exact)[clear]) <= 0.3 * texel
    assert clear.sum() > 2000
    assert facts["nothing"] == depth.max() and 0.3 < facts["covered"] < 0.9


def test_a_light_in_the_body_is_refused(globe: str) -> None:
    for place in ((0.0, 0.0, 0.0), (0.0, 0.1, 0.2), (0.5, 0.5, 0.2)):
        with pytest.raises(SssgenError, match="inside the body"):
            depth_map(globe, BakeLight(np.array(place), False), (8, 8))


def test_gltf_keeps_its_parts_and_their_texture_coordinates() -> None:
    trimesh = pytest.importorskip("trimesh", reason="trimesh is missing: pip install -e '.[bake]'")
    solid_mesh = meshes.box((1.0, 0.6, 0.4))
    assert solid_mesh.uv is not None
    corners = solid_mesh.triangles.reshape(-1, 3)
    visual = trimesh.visual.TextureVisuals(uv=solid_mesh.uv.reshape(-1, 2))
    part = trimesh.Trimesh(corners, np.arange(len(corners)).reshape(-1, 3), visual=visual, process=False)
    scene = trimesh.Scene()
    mirrored = np.diag([-2.0, 1.0, 1.0, 1.0])
    mirrored[:3, 3] = 5.0, 0.0, 0.0
    scene.add_geometry(part, node_name="first")
    scene.add_geometry(part, node_name="second", transform=mirrored)
    for suffix in ("glb", "gltf"):
        scene.export(f"parts.{suffix}")
        mesh = Mesh(path=f"parts.{suffix}")
        assert len(mesh.triangles.corners) == 24 and mesh.triangles.uv is not None
        expected = np.concatenate([solid_mesh.uv, solid_mesh.uv])
        assert np.sort(mesh.triangles.uv.ravel()) == pytest.approx(np.sort(expected.ravel()), abs=1e-6)
        assert mesh.triangles.places.max(axis=0)[0] == pytest.approx(6.0, abs=1e-6)
        assert not mesh.inside_out and mesh.solid.rim == 0.0
        volume = mesh.solid.winding_number(np.array([[0.0, 0.0, 0.0], [5.0, 0.0, 0.0], [2.5, 0.0, 0.0]]))
        assert volume == pytest.approx([1.0, 1.0, 0.0], abs=0.02)


@pytest.mark.slow
def test_a_mesh_that_xatlas_loses_is_unwrapped_in_parts(monkeypatch: pytest.MonkeyPatch, globe: str) -> None:
    requests: list[int] = []

    def once_lost(items: Any, **options: Any) -> list[Any]:
        requests.append(len(np.unique(items[0].arguments[2])))
        return [Failure("texture coordinates", "its process crashed")] if len(requests) == 1 else run(items, **options)

    monkeypatch.setattr(unwrap, "run", once_lost)
    mesh = Mesh(path=globe).triangles
    uv = unwrap.unwrap_mesh(mesh)
    assert requests == [1, 6] and uv.shape == (len(mesh.corners), 3, 2) and uv.min() >= 0.0 and uv.max() <= 1.0
    assert atlas(mesh, uv, (256, 256), globe).shared < 0.05
    monkeypatch.setattr(unwrap, "run", lambda *_, **__: [Failure("texture coordinates", "its process crashed")])
    with pytest.raises(SssgenError, match="finds no texture coordinates"):
        unwrap.unwrap_mesh(mesh)


@pytest.mark.slow
def test_a_ball_that_xatlas_crashes_on() -> None:
    trimesh = pytest.importorskip("trimesh", reason="trimesh is missing: pip install -e '.[bake]'")
    trimesh.creation.icosphere(subdivisions=6).export("ball.ply")
    result = thickness_map("ball.ply", (64, 64), Request(mode="chord"))
    assert result.facts["mean"] == pytest.approx(2.0, rel=1e-2) and result.facts["mesh"]["new_uv"]
