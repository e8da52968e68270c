"""The fluence inside a body: light tracing, its factors, and the textures of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from oracle import Array, close, rng, technique, unit, units
from slow_cases import some_slow
from sssgen.lab.fluence import fluence_field as field
from sssgen.lab.fluence import fluence_volumes as volumes
from sssgen.lab.fluence import traced_body
from sssgen.lab.fluence.factors import factors
from sssgen.lab.fluence.fluence_field import Settings
from sssgen.lab.fluence.photons import scatter
from sssgen.lab.fluence.projection import Projection
from sssgen.lab.fluence.voxels import Grid
from sssgen.scene import octahedron
from sssgen.scene.camera import Camera
from sssgen.scene.geometry import Ball, Box, Torus
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.media import Medium
from sssgen.support.diagnostics import SssgenError

FEW = Settings(voxels=10, side=4, photons=4000)


def body(geometry: Ball | Box | Torus, extinction: float = 4.0, albedo: float = 1.0, ior: float = 1.0) -> MeasuredScene:
    scattering = extinction * albedo
    medium = Medium("test", (extinction - scattering,) * 3, (scattering,) * 3, 0.0, ior, "the test")
    return MeasuredScene("body", "body", geometry, Camera(), (), medium, None)


def scattered_only(scene: MeasuredScene, directions: Array, settings: Settings) -> field.Field:
    return field.of_directions(scene, directions, settings, "", 0, lambda *_: None)


def test_directions_of_the_octahedral_map() -> None:
    directions = octahedron.directions(8)
    close(np.linalg.norm(directions, axis=1), 1.0)
    place = technique("common/octahedron.sss:octahedral_place")
    centres = (np.arange(8) + 0.5) / 8
    y, x = np.meshgrid(centres, centres, indexing="ij")
    close(place(v=directions), np.stack([x.ravel(), y.ravel()], axis=1), atol=1e-12)
    close(place(v=np.zeros((1, 3))), 0.5)


def test_scattered_directions_have_the_mean_cosine() -> None:
    direction = np.tile(unit(np.array([1.0, -2.0, 0.5])), (200_000, 1))
    for anisotropy in (0.0, 0.6, -0.3):
        scattered = scatter(direction, anisotropy, np.random.default_rng(1))
        close(np.linalg.norm(scattered, axis=1), 1.0)
        close((scattered * direction).sum(axis=1).mean(), anisotropy, atol=5e-3)


def test_the_collisions_of_a_thin_body_are_those_of_single_scattering() -> None:
    """Where the body is thin, the second collision follows from the first by an integral over pairs of points."""
    extinction, radius = 0.5, 0.4
    scene, light = body(Ball(radius), extinction), np.array([[0.0, 0.0, 1.0]])
    traced = scattered_only(scene, light, FEW._replace(photons=1000))
    points = rng(3).uniform(-radius, radius, (400_000, 3))
    points = points[np.linalg.norm(points, axis=1) < radius]
    first, second = np.array_split(points, 2)
    first = first[: len(second)]
    volume = 4.0 / 3.0 * np.pi * radius**3
    # fluence at the second points: the first ones scatter what the light has left there, isotropically
    way = np.sqrt(radius**2 - (first[:, :2] ** 2).sum(axis=1)) - first[:, 2]
    apart = np.linalg.norm(first - second, axis=1)
    scattered = extinction * np.exp(-extinction * (way + apart)) / (4.0 * np.pi * apart**2)
    expected = volume * scattered.mean() / 4.0
    grid = traced.grid
    projection = traced_body.projection_of(scene, FEW.voxels)
    hats = projection.integrals(np.ones((1, len(projection.points))))[0]
    close(hats.sum() * grid.volume, volume, rtol=0.01)
    # bodies this thin scatter a third time, too: a tenth of the second
    mean = float(traced.values[0, 0] @ hats / hats.sum())
    assert expected < mean < 1.25 * expected


@pytest.mark.parametrize("ior", [1.0, 1.4])
def test_light_from_everywhere_is_the_same_inside_where_nothing_is_absorbed(ior: float) -> None:
    """The linear system of flights: its mean has no bias, also where it is nearly singular. A refracting surface raises
    the light by the square of the index."""
    traced = field.field(body(Box((0.8, 0.8, 0.8)), 3.0, ior=ior), FEW._replace(voxels=8, photons=8000), processes=0)
    angles = octahedron.solid_angles(FEW.side)
    light = np.einsum("dv,d->v", traced.whole[0], angles) / (np.pi * ior**2)
    inner = np.abs(traced.grid.centres()[:, 0]).max(axis=1) < 0.3
    assert inner.sum() > 100
    # refraction has a sum over few directions that is less even
    close(light[traced.nearest[inner]].mean(), 1.0, rtol=0.01 if ior == 1.0 else 0.03)
    assert light[traced.nearest[inner]].std() < 0.08


@pytest.mark.parametrize(("albedo", "ior"), some_slow([(0.9, 1.0), (0.4, 1.0), (0.9, 1.4)], (0.9, 1.4)))
def test_flights_for_all_directions_give_what_photons_of_each_do(albedo: float, ior: float) -> None:
    """Two ways, in a body with a hole: the same total, and the same light in each third of the body."""
    scene = body(Torus(0.4, 0.15), 6.0, albedo, ior)
    towards = unit(np.array([[1.0, 0.2, 0.1], [0.1, -0.3, 1.0]]))
    settings = FEW._replace(photons=8000)
    traced = scattered_only(scene, towards, settings)
    projection = traced_body.projection_of(scene, settings.voxels)
    tracer, medium = traced_body.tracer(scene, settings.voxels), traced_body.medium_of(scene, 0)
    photons = projection.folded(tracer.trace(medium, towards, 40_000, np.random.default_rng(1)))
    # photons behind a refracting surface count all light
    light = traced.values if ior == 1.0 else traced.whole
    flights = light[0] @ projection.mass.toarray()
    along = tracer.grid.centres()[traced.cells, 0] @ towards.T
    for number in range(len(towards)):
        for part in np.array_split(np.argsort(along[:, number]), 3):
            # the texels are coarse for light that fades over less than two of them
            close(flights[number, part].sum(), photons[number, part].sum(), rtol=0.06)
        close(flights[number].sum(), photons[number].sum(), rtol=0.02)


@pytest.mark.slow
def test_unscattered_light_behind_a_refracting_surface() -> None:
    """In a box that only absorbs, light along the normal fades exponentially; a little comes back from the far side."""
    extinction, ior, side = 4.0, 1.4, 0.8
    box = body(Box((side, side, side)), extinction, 0.0, ior)
    traced = field.of_light(box, np.array([0.0, 0.0, 1.0]), FEW._replace(voxels=8, photons=100_000), processes=0)
    share = ((ior - 1.0) / (ior + 1.0)) ** 2
    heights = np.linspace(traced.grid.low[2], traced.grid.high[2], 9)[1:-1]
    assert np.abs(heights).max() < 0.5 * side

    def layers(traced: field.Field) -> Array:
        """The means over the inner layers of what the texels are interpolated to."""
        texels = traced.values[0, 0][traced.nearest].reshape(8, 8, 8)[:, 2:6, 2:6].mean(axis=(1, 2))
        result: Array = 0.75 * texels[1:-1] + 0.125 * (texels[:-2] + texels[2:])
        return result

    def mean(path: Array) -> Array:
        """Of the light that is left after a path, over each layer."""
        result: Array = np.abs(np.diff(np.exp(-extinction * path)) / (extinction * np.diff(path)))
        return result

    back = share * np.exp(-extinction * side) * mean(0.5 * side + heights)
    close(layers(traced), 0.25 * (1.0 - share) * (mean(0.5 * side - heights) + back), rtol=0.04)
    matched, light = body(Box((side,) * 3), extinction, 0.0), np.array([0.0, 0.0, 1.0])
    assert not scattered_only(matched, light[None], FEW._replace(photons=20)).values.any()
    traced = field.of_light(matched, light, FEW._replace(voxels=8, photons=20), processes=0)
    close(layers(traced), 0.25 * mean(0.5 * side - heights), rtol=0.01)


def test_texels_of_a_linear_field_reproduce_it() -> None:
    """Also where voxels are partly outside; the integral of any field is kept."""
    grid = Grid(np.array([-1.0, -0.5, -0.7]), np.array([1.0, 0.5, 0.7]), (11, 6, 8))
    points = grid.centres(5)
    inside = (points**2 / np.array([0.9, 0.45, 0.6]) ** 2).sum(axis=2) < 1.0
    projection = Projection(grid, inside.astype(float))
    slope, chosen = np.array([0.3, -0.7, 0.2]), points[inside]
    linear = 1.0 + chosen @ slope
    texels = projection.texels(projection.integrals(linear[None]))[0]
    full = np.zeros(grid.voxels)
    full[projection.counting] = texels
    deep = (points[:, 62] ** 2 / np.array([0.5, 0.2, 0.3]) ** 2).sum(axis=1) < 1.0
    assert deep.sum() > 10
    close(full[deep], (1.0 + points[deep, 62] @ slope), rtol=0.01)
    rough = rng(4).uniform(0.0, 1.0, len(chosen))
    integrals = projection.integrals(rough[None])
    hats = projection.integrals(np.ones((1, len(chosen))))
    close(projection.texels(integrals)[0] @ hats[0], integrals[0].sum(), rtol=5e-3)


def test_a_texel_is_chosen_as_often_as_it_counts_in_the_interpolation() -> None:
    grid = Grid(np.zeros(3), np.array([3.0, 2.0, 4.0]), (3, 2, 4))
    projection = Projection(grid, np.ones((grid.voxels, 8)))
    for point in ([1.2, 1.1, 2.9], [0.1, 0.2, 3.95]):
        chosen = grid.texel_of(np.tile(point, (200_000, 1)), np.random.default_rng(1))
        shares = np.bincount(chosen, minlength=grid.voxels) / len(chosen)
        close(shares, projection.hats_at(np.array([point])).toarray()[0], atol=5e-3)


def test_the_volume_of_a_fixed_light_has_the_distance() -> None:
    traced = field.of_light(body(Ball(0.5)), np.array([0.0, 0.0, 1.0]), FEW._replace(photons=20), processes=0)
    stored = volumes.light_volume(traced)
    exact = np.linalg.norm(traced.grid.centres()[:, 0], axis=1) - 0.5
    read = (2.0 * stored.texels[..., 3].ravel() / 255.0 - 1.0) * stored.reach
    close(read, np.clip(exact, -stored.reach, stored.reach), atol=stored.reach / 255.0 + 1e-9)


def test_the_maps_of_a_table_share_texels() -> None:
    maps = rng(2).uniform(0.0, 1.0, (9, 2, 2, 3))
    tiles = volumes.pack_maps(maps)
    assert tiles.shape == (volumes.tiles_of(8), 2, 2, 4) == (7, 2, 2, 4)
    close(tiles[..., :3], maps[:7])
    close(np.moveaxis(tiles[:6, ..., 3].reshape(2, 3, 2, 2), 1, 3), maps[7:])
    assert volumes.tiles_of(4) == 4


def test_the_same_seed_gives_the_same_bytes() -> None:
    light = np.array([0.6, 0.0, 0.8])
    scene = body(Ball(0.5))
    first, second, other = (
        volumes.light_volume(field.of_light(scene, light, FEW._replace(seed=seed, photons=20), processes=0))
        for seed in (5, 5, 6)
    )
    assert first.texels.tobytes() == second.texels.tobytes() != other.texels.tobytes()


def test_factors_of_a_noisy_field() -> None:
    """The weights follow the smooth field: dark rows keep their relative accuracy."""
    left, right = rng(1).uniform(0.1, 1.0, (300, 3)), rng(2).uniform(0.1, 1.0, (3, 80))
    exact = (left * np.logspace(-2, 0, 300)[:, None]) @ right
    noisy = exact * rng(3).uniform(0.5, 1.5, exact.shape)
    u, v = factors(noisy, 3, 1e-4, exact)
    error = np.abs(u @ v / exact - 1.0)
    assert np.median(error) < 0.1
    assert np.median(error[:100]) < 0.12  # the dark rows
    u, v = factors(exact, 3, 1e-6, exact)
    close(u @ v, exact, rtol=1e-4)  # the ridge


def test_the_table_continues_across_the_edges_of_the_map() -> None:
    """A smooth function of the direction is read back, also at the border of its octahedral map."""
    side = 16
    directions = octahedron.directions(side)
    values = 2.0 + directions @ np.array([0.5, -0.7, 0.3])
    tile = volumes.add_border(values.reshape(side, side, 1))
    tests = units(500, 9)
    place = technique("common/octahedron.sss:octahedral_place")(v=tests)
    texels = place * side + 1.0 - 0.5
    low = np.floor(texels).astype(int)
    part = texels - low
    read = sum(
        tile[low[:, 1] + dy, low[:, 0] + dx, 0]
        * (part[:, 0] if dx else 1.0 - part[:, 0])
        * (part[:, 1] if dy else 1.0 - part[:, 1])
        for dx in (0, 1)
        for dy in (0, 1)
    )
    close(read, 2.0 + tests @ np.array([0.5, -0.7, 0.3]), atol=0.05)  # a texel is 13 degrees wide


def test_a_body_without_voxels_inside_is_an_error() -> None:
    with pytest.raises(SssgenError, match="no voxel is inside"):
        field.field(body(Box((1.0, 1.0, 1e-4))), FEW._replace(voxels=4), processes=0)


@pytest.mark.slow
def test_the_bake_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from sssgen.cli.main import main
    from sssgen.scene.pictures.volumes import read

    monkeypatch.chdir(tmp_path)
    small = ["--voxels", "8", "--photons", "40", "--processes", "1"]
    assert main(["bake", "fluence", "cube", "-o", "a.dds", *small]) == 2  # neither a scene file nor a mesh
    lab = Path(__file__).parents[2] / "examples" / "lab"
    assert main(["bake", "fluence", str(lab / "cube.toml"), "-o", "a.dds", "--rank", "4", *small]) == 0
    assert sorted(path.name for path in tmp_path.glob("a*")) == [
        "a_latents_1.dds", "a_latents_1.dds.json", "a_table.exr", "a_table.exr.json",
    ]  # fmt: skip
    assert read("a_latents_1.dds", "a").shape[3] == 4
    for wrong in (["--rank", "5"], ["--voxels", "1"], ["--photons", "0"], ["--medium", "marble"], ["--light", "0,0,0"]):
        assert main(["bake", "fluence", str(lab / "cube.toml"), "-o", "a.dds", *small, *wrong]) == 2, wrong
    assert main(["bake", "fluence", str(lab / "cube.toml"), "-o", "b.npy", "--light", "0,1,0", *small]) == 0
    assert np.load("b.npy").shape[3] == 4


def test_a_bake_of_another_boundary_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A material with a bake through a refracting surface needs a technique that refracts, and the reverse."""
    from sssgen.cli.main import main
    from sssgen.material.material_loading import load_material

    monkeypatch.chdir(tmp_path)
    cube = (Path(__file__).parents[2] / "examples" / "lab" / "cube.toml").read_text(encoding="utf-8")
    assert 'preset = "marble"' in cube
    small = ["--voxels", "6", "--photons", "8", "--processes", "1", "--light", "light.json"]
    (tmp_path / "light.json").write_text('{"direction": [0.3, 0.8, 0.5]}', encoding="utf-8")
    material = '[material]\nname = "m"\n[[thickness]]\ntechnique = "back_face_thickness"\n[[translucency]]\n'
    material += 'technique = "{}"\nfluence_volume = "{}.dds"\n'
    for name, ior in (("matched", ""), ("refracting", "ior = 1.4\n")):
        text = cube.replace('preset = "marble"', ior + 'preset = "marble"')
        (tmp_path / f"{name}.toml").write_text(text, encoding="utf-8")
        assert main(["bake", "fluence", f"{name}.toml", "-o", f"{name}.dds", *small]) == 0

    def loaded(technique: str, volume: str) -> float:

        (tmp_path / "m.toml").write_text(material.format(technique, volume), encoding="utf-8")
        (stage,) = [stage for stage in load_material("m.toml").stages if stage.technique.name == technique]
        return float(stage.values["mean_free_path"][0])

    assert loaded("fluence_fixed", "matched") == loaded("fluence_fixed_refracted", "refracting") > 0.0
    with pytest.raises(
        SssgenError, match=r"index 1\.4, and the technique does not refract[^$]*fluence_fixed_refracted"
    ):
        loaded("fluence_fixed", "refracting")
    with pytest.raises(SssgenError, match=r"index 1, and the technique refracts[^$]*use fluence_fixed"):
        loaded("fluence_fixed_refracted", "matched")
