"""The reference with a refracting surface, compared with closed forms, adding and doubling, and Mitsuba."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from qualification.closed_forms import henyey_greenstein
from slow_cases import some_slow
from sssgen.lab.reference import dielectric
from sssgen.lab.reference.dielectric import Dielectric, axes, fresnel
from sssgen.lab.reference.eye_paths import BATCHES, Eye, Readings, Sky, readings
from sssgen.lab.reference.first_light import Lamp, Voxels, first_light, voxels_of
from sssgen.lab.reference.sampling import Sampling
from sssgen.lab.reference.surface_rays import SurfaceRays
from sssgen.lab.reference.transport import Light, radiance_along
from sssgen.lab.reference.transport_mitsuba import mitsuba
from sssgen.scene.camera import Camera
from sssgen.scene.geometry import Ball, Box, Distance, Geometry, Slab, Torus
from sssgen.scene.measured.media import Medium
from sssgen.support import cache
from sssgen.support.diagnostics import SssgenError

pytest.importorskip("mitsuba")
pytest.importorskip("embreex")
iadpython = pytest.importorskip("iadpython")

Array = npt.NDArray[np.float64]

ASKEW: dict[str, Any] = {"position": (0.2, -0.1, 0.3), "rotation": (20.0, 30.0, 40.0)}
CAMERA = Camera(position=(1.5, 1.2, 4.0), target=(0.3, 0.2, 0.1), field_of_view=35.0)
CUBE = Box(size=(1.0, 0.8, 1.2), **ASKEW)
BALL = Ball(radius=0.7, **ASKEW)


@pytest.fixture(autouse=True)
def no_cache(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(cache, "_folder", None)
    monkeypatch.setenv("SSSGEN_CACHE", "")
    yield
    monkeypatch.setattr(cache, "_folder", None)


def even(directions: Array) -> Array:
    """An environment that is the same everywhere."""
    return np.ones((len(directions), 3))


def above(directions: Array) -> Array:
    """An environment above the plane z = 0 only."""
    return np.where(directions[:, 2:] > 0.0, np.ones(3), 0.0)


def grey(albedo: float, ior: float, extinction: float = 1.0, anisotropy: float = 0.0, rough: float = 0.0) -> Medium:
    absorption, scattering = extinction * (1.0 - albedo), extinction * albedo
    return Medium("grey", (absorption,) * 3, (scattering,) * 3, anisotropy, ior, "", rough)


def seen(geometry: Geometry, width: int = 12, height: int = 9) -> Eye:
    """What the camera sees of a geometry."""
    origin, directions = CAMERA.rays(width, height)
    hits = geometry.hits(origin, directions)
    keep = hits.hit & (np.abs(np.einsum("nc,nc->n", hits.normal, directions)) > 0.02)
    return Eye(hits.position[keep], hits.normal[keep], directions[keep])


def on_top(cosines: Array, azimuth: float = 0.4) -> Eye:
    """Views of the point (0, 0, 0) of a plane that faces z, at these cosines."""
    sine = np.sqrt(1.0 - cosines**2)
    directions = -np.stack([sine * np.cos(azimuth), sine * np.sin(azimuth), cosines], axis=1)
    normal = np.tile([0.0, 0.0, 1.0], (len(cosines), 1))
    return Eye(np.zeros_like(directions), normal, directions)


def slab(depth: float, width: float = 60.0) -> Slab:
    return Slab(width, width, depth, position=(0.0, 0.0, -0.5 * depth))


def transmitted(cosine: Array, ior: float) -> tuple[Array, Array]:
    """The share of light that enters, and the cosine inside."""
    reflected, inside = fresnel(cosine, np.full_like(cosine, 1.0 / ior))
    return 1.0 - reflected, inside


def assert_agrees(result: Readings, expected: npt.ArrayLike, tightest: float, light: int = 0) -> None:
    """Asserts that the values are within three standard errors, and these within `tightest` of the values."""
    actual, error, expected = result.mean[light, :, 0], result.error[light, :, 0], np.asarray(expected)
    assert (error <= tightest * expected).all(), (error / expected).max()
    assert (np.abs(actual - expected) <= 3.0 * error + 1e-9).all(), f"{actual} {expected} {error}"


# --- the surface ---


def test_fresnel_has_its_known_values() -> None:
    reflected, inside = fresnel(np.array([1.0, np.cos(np.arctan(1.5))]), np.full(2, 1.0 / 1.5))
    assert reflected[0] == pytest.approx(0.04) and inside[0] == pytest.approx(1.0)
    # at Brewster's angle only the half that is polarised along the surface is reflected
    assert reflected[1] == pytest.approx(0.5 * ((1.5**2 - 1.0) / (1.5**2 + 1.0)) ** 2)
    beyond = fresnel(np.array([np.sqrt(1.0 - (1.01 / 1.5) ** 2)]), np.array([1.5]))
    assert (beyond[0][0], beyond[1][0]) == (1.0, 0.0)


@pytest.mark.parametrize("roughness", [0.0, 0.3, 0.6])
@pytest.mark.parametrize("outward", [True, False])
def test_directions_obey_the_surface(roughness: float, outward: bool) -> None:
    rng = np.random.default_rng(1)
    normal = rng.normal(size=(4000, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    direction = rng.normal(size=(4000, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    direction *= np.sign(np.einsum("nc,nc->n", direction, normal))[:, None] * (1.0 if outward else -1.0)
    turn = Dielectric(1.4, roughness).reflect_or_refract(direction, normal, rng)
    assert np.linalg.norm(turn.direction, axis=1) == pytest.approx(1.0)
    valid = turn.weight > 0.0
    assert valid.all() and turn.weight.max() <= 1.0
    before, after = (np.einsum("nc,nc->n", way, normal) for way in (direction, turn.direction))
    assert ((before * after > 0.0) == turn.crosses)[valid].all()
    if roughness == 0.0:
        ratio = 1.4 if outward else 1.0 / 1.4
        sine = np.sqrt(1.0 - before**2) * ratio
        assert np.sqrt(1.0 - after**2)[turn.crosses] == pytest.approx(sine[turn.crosses], abs=1e-6)
        assert (after + before)[~turn.crosses] == pytest.approx(0.0, abs=1e-9)


def test_a_surface_with_little_roughness_is_nearly_smooth() -> None:
    direction = np.tile([0.6, 0.0, -0.8], (20_000, 1))
    normal = np.tile([0.0, 0.0, 1.0], (20_000, 1))
    smooth, rough = (
        Dielectric(1.5, roughness).reflect_or_refract(direction, normal, np.random.default_rng(2))
        for roughness in (0.0, 0.05)
    )
    assert rough.crosses.mean() == pytest.approx(smooth.crosses.mean(), abs=0.005)
    for side in (True, False):
        means = [turn.direction[turn.crosses == side].mean(axis=0) for turn in (smooth, rough)]
        assert means[0] == pytest.approx(means[1], abs=0.01)


def test_axes_are_perpendicular() -> None:
    normal = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.6, 0.0, 0.8], [0.0, -1.0, 0.0]])
    first, second = axes(normal)
    for pair in ((first, second), (first, normal), (second, normal)):
        assert np.einsum("nc,nc->n", *pair) == pytest.approx(0.0, abs=1e-12)
    assert np.cross(first, second) == pytest.approx(normal)


@pytest.mark.parametrize("geometry", [CUBE, BALL], ids=["box", "ball"])
def test_exact_crossings_are_those_of_the_mesh(geometry: Geometry) -> None:
    rng = np.random.default_rng(3)
    surface = SurfaceRays(geometry)
    origins = np.array(geometry.position) + rng.uniform(-1.2, 1.2, (2000, 3))
    directions = rng.normal(size=(2000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    exact = surface.next(origins, directions)
    faces, ahead = surface._rays.nearest(origins, directions)
    clear = exact.found & (faces >= 0)
    assert ((faces >= 0) == exact.found).mean() > 0.99 and clear.sum() > 300
    same = np.abs(ahead - exact.ahead)[clear] < 5e-3
    assert same.mean() > 0.98
    cosine = np.einsum("nc,nc->n", exact.normal[clear], surface._normals[faces[clear]])
    assert cosine[same].min() > 0.99


@pytest.mark.parametrize(
    ("geometry", "volume"),
    [(CUBE, 0.96), (BALL, 4.0 / 3.0 * np.pi * 0.7**3), (Torus(0.7, 0.25, scale=2.0), 16.0 * np.pi**2 * 0.7 * 0.25**2)],
    ids=["box", "ball", "torus"],
)
def test_voxels_hold_the_volume(geometry: Geometry, volume: float) -> None:
    voxels = Voxels(SurfaceRays(geometry), (20, 15, 17))
    assert voxels.volume.sum() == pytest.approx(volume, rel=2e-3)
    assert voxels.volume.min() >= 0.0
    if isinstance(geometry, Box):
        assert voxels.volume == pytest.approx(volume / voxels.count)


# --- closed forms ---


@pytest.mark.parametrize("ior", [1.0, 1.3, 1.5])
@pytest.mark.parametrize("geometry", [CUBE, BALL, Distance(technique="box", reach=1.5, **ASKEW)])
def test_white_furnace(geometry: Geometry, ior: float) -> None:
    # without absorption, under an even sky, each point shows the transmitted share; what is missing is its reflection
    eye = seen(geometry, 16, 12)
    result = readings(geometry, grey(1.0, ior, 3.0), eye, [], [Sky(even)], Sampling(16))
    cosine = -np.einsum("nc,nc->n", eye.normal, eye.direction)
    assert len(cosine) > 8
    assert result.mean[0, :, 0] == pytest.approx(transmitted(cosine, ior)[0], abs=1e-4)


PLANES = [
    (0.7, 0.5, 0.6),
    *(pytest.param(*case, marks=pytest.mark.slow) for case in [(0.8, 0.6, 0.0), (0.4, 0.9, 0.0)]),
]


@pytest.mark.parametrize(("cosine_in", "cosine_out", "anisotropy"), PLANES)
def test_once_scattered_below_a_plane(cosine_in: float, cosine_out: float, anisotropy: float) -> None:
    # a deep slab: the light enters with T μ / μ', fades along both refracted rays, and leaves with T / η²
    ior, albedo = 1.5, 0.8
    sun = np.array([np.sqrt(1.0 - cosine_in**2), 0.0, cosine_in])
    eye = on_top(np.array([cosine_out]))
    medium, lamp = grey(albedo, ior, 1.0, anisotropy), Lamp((sun[0], sun[1], sun[2]))
    result = readings(slab(12.0, 400.0), medium, eye, [lamp], [], Sampling(5_000, scatterings=1), shape=(3, 3, 240))
    (share_in, share_out), (inner_in, inner_out) = transmitted(np.array([cosine_in, cosine_out]), ior)
    before = np.array([-sun[0], -sun[1], 0.0]) / ior - [0.0, 0.0, inner_in]
    after = np.array([*(-eye.direction[0, :2] / ior), inner_out])
    phase = henyey_greenstein(anisotropy, float(before @ after))
    fluence = share_in * cosine_in / inner_in
    expected = np.pi * share_out / ior**2 * albedo * phase * fluence / (1.0 + inner_out / inner_in)
    assert_agrees(result, [expected], 0.035)


def unscattered(depth: float, ior: float) -> tuple[float, float]:
    """The shares of normal light that leave a slab unscattered on the lit and on the other side."""
    r = ((ior - 1.0) / (ior + 1.0)) ** 2
    fading = np.exp(-depth)
    behind = (1.0 - r) ** 2 * fading / (1.0 - (r * fading) ** 2)
    return r + r * fading * behind, behind


SLABS = [(2.0, 0.9, 0.0, 1.5), (1.0, 0.95, 0.0, 1.3), (1.0, 0.9, 0.6, 1.4)]


@pytest.mark.parametrize(("depth", "albedo", "anisotropy", "ior"), some_slow(SLABS, SLABS[-1]))
def test_slabs_under_a_sky_by_adding_and_doubling(depth: float, albedo: float, anisotropy: float, ior: float) -> None:
    # by reciprocity: a sky above shows R of a beam along the ray, an even sky R + T, both without the first reflection
    medium = grey(albedo, ior, 1.0, anisotropy)
    reflected, through, _, _ = iadpython.Sample(a=albedo, b=depth, g=anisotropy, n=ior, quad_pts=24).rt()
    eye = on_top(np.array([1.0]))
    first = ((ior - 1.0) / (ior + 1.0)) ** 2
    assert_agrees(readings(slab(depth), medium, eye, [], [Sky(above)], Sampling(100_000, 1)), [reflected - first], 0.01)
    assert_agrees(
        readings(slab(depth), medium, eye, [], [Sky(even)], Sampling(100_000, 1)), [reflected + through - first], 0.01
    )


def fluxes(depth: float, medium: Medium, samples: int) -> list[tuple[float, float]]:
    """The scattered flux of normal light on the lit and on the other side of a slab, with its error."""
    root, weight = np.polynomial.legendre.leggauss(12)
    cosines, weights = 0.5 * (root + 1.0), 0.5 * weight
    share = 2.0 * weights * cosines
    results = []
    for lamp in (Lamp((0.0, 0.0, 1.0)), Lamp((0.0, 0.0, -1.0))):
        result = readings(slab(depth), medium, on_top(cosines), [lamp], [], Sampling(samples), shape=(3, 3, 60))
        # the points share the voxels of a batch, so that their errors add up
        results.append((float(share @ result.mean[0, :, 0]), float(share @ result.error[0, :, 0])))
    return results


@pytest.mark.slow
@pytest.mark.parametrize(("depth", "albedo", "anisotropy", "ior"), SLABS)
def test_slabs_in_a_beam_by_adding_and_doubling(depth: float, albedo: float, anisotropy: float, ior: float) -> None:
    reflected, through, _, _ = iadpython.Sample(a=albedo, b=depth, g=anisotropy, n=ior, quad_pts=24).rt()
    front, back = unscattered(depth, ior)
    medium = grey(albedo, ior, 1.0, anisotropy)
    for (flux, error), expected in zip(fluxes(depth, medium, 1600), (reflected - front, through - back), strict=True):
        assert error < 0.04 * expected
        assert abs(flux - expected) < 2.0 * error, f"{flux} {expected} {error}"


@pytest.mark.slow
def test_energy_is_conserved() -> None:
    # without absorption all light of a beam leaves: scattered, or unscattered, or reflected at first
    scattered = fluxes(1.0, grey(1.0, 1.5), 1600)
    left = sum(flux for flux, _ in scattered) + sum(unscattered(1.0, 1.5))
    assert left == pytest.approx(1.0, abs=2.0 * sum(error for _, error in scattered))


@pytest.mark.slow
@pytest.mark.parametrize("rough", [0.3, 0.6])
def test_a_rough_surface_conserves_energy(rough: float) -> None:
    # a deep slab without absorption: all light of a beam leaves on the lit side, at once or scattered. The eye's paths
    # and the light's rays meet the surface from opposite sides, so that this also tests reciprocity
    medium, normal = grey(1.0, 1.5, 1.0, 0.0, rough), np.tile([0.0, 0.0, 1.0], (100_000, 1))
    first = Dielectric(1.5, rough).reflect_or_refract(-normal, normal, np.random.default_rng(5))
    reflected = float((~first.crosses).mean())
    assert first.weight.min() == 1.0
    (front, error), (back, _) = fluxes(4.0, medium, 1600)
    assert front + back + reflected == pytest.approx(1.0 - np.exp(-4.0) * 0.9, abs=2.0 * error + 0.01)


def test_a_rough_furnace_is_white() -> None:
    eye = on_top(np.array([0.95, 0.3]))
    result = readings(slab(2.0), grey(1.0, 1.5, 1.0, 0.0, 0.5), eye, [], [Sky(even)], Sampling(20_000))
    entered = [
        Dielectric(1.5, 0.5).refract(np.repeat(way[None], 20_000, 0), np.repeat(up[None], 20_000, 0), rng).weight.mean()
        for way, up, rng in zip(eye.direction, eye.normal, map(np.random.default_rng, (6, 7)), strict=True)
    ]
    assert result.mean[0, :, 0] == pytest.approx(entered, abs=0.01)


def test_the_light_that_is_seen_through_a_slab_is_what_is_not_scattered() -> None:
    cosines = np.array([1.0, 0.5])
    skies = [Sky(even, seen_through) for seen_through in (True, False)]
    whole, scattered = readings(slab(1.5), grey(0.9, 1.0), on_top(cosines), [], skies, Sampling(20_000)).mean[..., 0]
    assert whole - scattered == pytest.approx(np.exp(-1.5 / cosines), abs=0.005)


# --- Mitsuba ---


@pytest.mark.parametrize(
    ("geometry", "anisotropy"),
    [
        (CUBE, 0.0),
        pytest.param(BALL, 0.0, marks=pytest.mark.slow),
        pytest.param(CUBE, 0.5, marks=pytest.mark.slow),
        pytest.param(Torus(0.7, 0.3), 0.0, marks=pytest.mark.slow),
    ],
)
def test_a_matched_boundary_is_that_of_mitsuba(geometry: Geometry, anisotropy: float) -> None:
    medium, sun = grey(0.95, 1.0, 5.0, anisotropy), (0.6, 0.0, -0.8)
    eye = seen(geometry)
    result = readings(geometry, medium, eye, [Lamp(sun)], [], Sampling(1024))
    other = radiance_along(
        geometry, medium, Light(sun), eye.position - 3.0 * eye.direction, eye.direction, Sampling(1024)
    )
    error = np.hypot(result.error[0], other.error)[:, 0]
    off = (result.mean[0] - other.mean)[:, 0]
    assert abs(off.sum()) < 4.0 * np.sqrt((error**2).sum())
    assert np.sqrt((off**2).mean()) < 1.5 * np.sqrt((error**2).mean())
    assert np.sqrt((error**2).mean()) < 0.1 * np.sqrt((other.mean**2).mean())


def mitsuba_sky(medium: Medium, eye: Eye, samples: int) -> Array:
    """Mitsuba's readings of CUBE with a rough surface under an even sky, with the reflection of the surface."""
    mi = mitsuba()
    half = 0.5 * np.array(CUBE.size)
    sensors = {
        f"ray{i:04}": {
            "type": "radiancemeter", "origin": (p - 2.0 * d).tolist(), "direction": d.tolist(),
            "film": {"type": "hdrfilm", "width": 1, "height": 1, "rfilter": {"type": "box"}},
        }
        for i, (p, d) in enumerate(zip(eye.position, eye.direction, strict=True))
    }  # fmt: skip
    film = {"type": "hdrfilm", "width": len(sensors), "height": 1, "rfilter": {"type": "box"}, "pixel_format": "rgb"}
    scene = mi.load_dict({
        "type": "scene",
        "integrator": {"type": "volpath", "max_depth": -1, "rr_depth": 1000},
        "sensor": {"type": "batch", "film": film, "sampler": {"type": "independent"}, **sensors},
        "body": {
            "type": "cube", "to_world": mi.ScalarTransform4f(CUBE.to_world() @ np.diag([*half, 1.0])),
            "bsdf": {
                "type": "roughdielectric", "distribution": "ggx", "alpha": medium.roughness**2,
                "int_ior": medium.ior, "ext_ior": 1.0,
            },
            "interior": {
                "type": "homogeneous", "sigma_t": medium.extinction[0], "albedo": medium.albedo[0],
                "has_spectral_extinction": False,
            },
        },
        "light": {"type": "constant", "radiance": 1.0},
    })  # fmt: skip
    readings: Array = np.array(mi.render(scene, spp=samples, seed=1))[0, :, 0].astype(np.float64)
    return readings


def test_a_rough_surface_is_that_of_mitsuba(monkeypatch: pytest.MonkeyPatch) -> None:
    # Mitsuba's model has one facet, and loses the light of a second; minus the reflection alone, of a body that
    # absorbs everything
    eye = seen(CUBE)
    medium = grey(0.9, 1.5, 4.0, 0.0, 0.6)
    through = mitsuba_sky(medium, eye, 4096) - mitsuba_sky(grey(0.0, 1.5, 1e5, 0.0, 0.6), eye, 4096)
    monkeypatch.setattr(dielectric, "MOST_FACETS", 1)
    result = readings(CUBE, medium, eye, [], [Sky(even)], Sampling(2048))
    assert len(through) > 8
    assert result.mean[0, :, 0].mean() == pytest.approx(through.mean(), rel=0.01)
    assert result.mean[0, :, 0] == pytest.approx(through, rel=0.1)


# --- lights ---


@pytest.mark.slow
def test_a_distant_point_is_a_light_from_afar() -> None:
    sun = np.array([0.6, 0.0, -0.8])
    place, eye = 300.0 * sun, seen(CUBE)
    lamps = [Lamp((0.6, 0.0, -0.8)), Lamp(None, (float(place[0]), float(place[1]), float(place[2])))]
    result = readings(CUBE, grey(0.95, 1.4, 5.0), eye, lamps, [], Sampling(256))
    # both read the same paths, and differ by their voxels only
    assert 300.0**2 * result.mean[1].mean() == pytest.approx(result.mean[0].mean(), rel=0.01)


def test_a_near_point_falls_off() -> None:
    # a small ball far from the light reads 1 / d² of it, whichever way the light's rays are started
    eye, medium = seen(BALL, 8, 6), grey(0.9, 1.3, 2.0)
    lamps = [Lamp(None, (0.2, -0.1, 0.3 - z)) for z in (8.0, 16.0)]
    result = readings(BALL, medium, eye, lamps, [], Sampling(256), rays=10_000)
    near, far = result.mean[:, :, 0].mean(axis=1)
    assert near / far == pytest.approx(4.0, rel=0.05)


@pytest.mark.slow
def test_a_sky_is_the_sum_of_its_lights() -> None:
    # the same light by two estimators: paths that leave the body, and voxels of light from many directions
    rng = np.random.default_rng(4)
    count = 48
    height, angle = (np.arange(count) + 0.5) / count * 2.0 - 1.0, np.arange(count) * np.pi * (3.0 - np.sqrt(5.0))
    sine = np.sqrt(1.0 - height**2)
    ways = np.stack([sine * np.cos(angle), sine * np.sin(angle), height], axis=1)

    def sky(directions: Array) -> Array:
        return np.repeat(1.0 + directions[:, :1], 3, axis=1)

    lamps = [Lamp((float(x), float(y), float(z))) for x, y, z in ways]
    eye, medium = seen(CUBE, 8, 6), grey(0.9, 1.4, 6.0)
    result = readings(CUBE, medium, eye, lamps, [Sky(sky)], Sampling(512, int(rng.integers(100))), rays=8000)
    # each lamp has the irradiance π L · 4 / count of its part of the sphere; readings of lamps are π L / E
    total = (result.mean[:-1, :, 0] * (1.0 + ways[:, :1]) * 4.0 / count).sum(axis=0)
    assert total.mean() == pytest.approx(result.mean[-1, :, 0].mean(), rel=0.02)


# --- noise and errors ---


def test_the_same_arguments_give_the_same_numbers() -> None:
    eye, medium = seen(CUBE, 6, 5), grey(0.9, 1.4, 4.0)
    first, second, other = (
        readings(CUBE, medium, eye, [Lamp((0.0, 0.6, -0.8))], [Sky(even)], Sampling(32, seed), rays=2000)
        for seed in (0, 0, 1)
    )
    assert (first.mean == second.mean).all() and (first.error == second.error).all()
    assert (first.mean != other.mean).any() and BATCHES >= 8


def test_voxels_are_smaller_than_the_free_path() -> None:
    surface = SurfaceRays(CUBE)
    coarse, fine = voxels_of(surface, 1.0), voxels_of(surface, 9.0)
    assert coarse.shape.max() == 48 and fine.shape.max() == 90
    assert list(fine.shape) == [75, 60, 90]


@pytest.mark.parametrize("geometry", [Ball(0.5), Torus(0.45, 0.2)])
def test_slivers_of_voxels_have_no_flashes(geometry: Geometry) -> None:
    """Rounding leaves parts of 1e-16 inside; the light in them is that of their neighbours, about 1, with noise."""
    voxels = Voxels(SurfaceRays(geometry), (48, 48, 48))
    cell = float(np.prod((voxels.high - voxels.low) / voxels.shape))
    assert ((voxels.volume > 0.0) & (voxels.volume < 1e-9 * cell)).any()
    lamp, rng = Lamp((0.0, 0.0, 1.0)), np.random.default_rng(1)
    light = first_light(voxels, Dielectric(1.4), np.array([3.0]), lamp, 60_000, rng).fluence[0]
    # a ball focuses light on its axis
    assert np.percentile(light, 99.0) < 3.0 and light.max() < 12.0


def test_impossible_arguments_are_refused() -> None:
    eye, medium = seen(CUBE, 6, 5), grey(0.9, 1.4, 4.0)
    with pytest.raises(SssgenError, match="inside the body"):
        readings(CUBE, medium, eye, [Lamp(None, (0.2, -0.1, 0.3))], [], Sampling(32))
    with pytest.raises(SssgenError, match="too few"):
        readings(CUBE, medium, eye, [], [Sky(even)], Sampling(0))
    with pytest.raises(SssgenError, match="roughness"):
        grey(0.9, 1.4, rough=1.5)
