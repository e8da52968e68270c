"""The reference renderer compared with closed forms and published codes: within three standard errors."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from qualification.closed_forms import ball_once, h_function, half_space, henyey_greenstein, slab_once, unscattered
from sssgen.lab.reference import transport
from sssgen.lab.reference.sampling import Sampling
from sssgen.lab.reference.transport import Light, Transport, radiance, radiance_along
from sssgen.lab.reference.transport_mitsuba import Renderer
from sssgen.scene.camera import Camera
from sssgen.scene.geometry import Ball, Box, Distance, Geometry, Slab, Torus
from sssgen.scene.geometry_mesh import mesh_of
from sssgen.scene.measured.media import Medium, preset
from sssgen.support import cache
from sssgen.support.diagnostics import SssgenError

pytest.importorskip("mitsuba")
iadpython = pytest.importorskip("iadpython")

Array = npt.NDArray[np.float64]

SKY = Light(None)
ASKEW: dict[str, Any] = {"position": (0.2, -0.1, 0.3), "rotation": (20.0, 30.0, 40.0)}
CAMERA = Camera(position=(1.5, 1.2, 4.0), target=(0.3, 0.2, 0.1), field_of_view=35.0)


@pytest.fixture(autouse=True)
def no_cache(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(cache, "_folder", None)
    monkeypatch.setenv("SSSGEN_CACHE", "")
    yield
    monkeypatch.setattr(cache, "_folder", None)


def grey(albedo: float, extinction: float = 1.0, anisotropy: float = 0.0) -> Medium:
    absorption, scattering = extinction * (1.0 - albedo), extinction * albedo
    return Medium("grey", (absorption,) * 3, (scattering,) * 3, anisotropy)


def wide_slab(depth: float) -> Slab:
    """A slab below z = 0, so wide that its edges do not matter."""
    return Slab(600.0, 600.0, depth, position=(0.0, 0.0, -0.5 * depth))


def towards(cosine: float) -> tuple[float, float, float]:
    return float(np.sqrt(1.0 - cosine * cosine)), 0.0, cosine


def looking(cosines: Array, azimuth: float = 1.0) -> tuple[Array, Array]:
    """Rays that hit (0, 0, 0) from above at these cosines; from below if they are negative."""
    sine = np.sqrt(1.0 - cosines**2)
    out = np.stack([sine * np.cos(azimuth), sine * np.sin(azimuth), cosines], axis=1)
    return 5.0 * out / np.abs(out[:, 2:]), -out


def assert_agrees(result: Transport, expected: npt.ArrayLike, tightest: float) -> None:
    """Asserts that 99 % of the values are within three standard errors, and errors are at most `tightest`, relative."""
    predicted = np.broadcast_to(np.asarray(expected, np.float64)[:, None], result.mean.shape)[:, 0]
    actual, error = result.mean[:, 0], result.error[:, 0]
    assert (error <= tightest * predicted).all(), (error / predicted).max()
    off = np.abs(actual - predicted) / error
    assert (off > 3.0).sum() <= 0.01 * len(off), f"{off.max():.2f} standard errors\n{actual}\n{predicted}"


# --- closed forms ---


@pytest.mark.parametrize(("albedo", "published"), [(0.5, 1.25126), (0.8, 1.59822), (0.9, 1.85010), (0.99, 2.47279)])
def test_h_is_the_published_one(albedo: float, published: float) -> None:
    assert h_function(albedo, 1.0) == pytest.approx(published, abs=5.1e-6)


@pytest.mark.parametrize("albedo", [0.2, 0.9, 1.0])
def test_h_solves_chandrasekhars_equation(albedo: float) -> None:
    # in his notation: H(μ) = 1 + a/2 μ H(μ) ∫ H(μ′) / (μ + μ′) dμ′; and its zeroth moment 2/a (1 − √(1 − a))
    root, weight = np.polynomial.legendre.leggauss(101)
    nodes, weights = (0.5 * (root + 1.0)) ** 2, 0.5 * (root + 1.0) * weight
    h = h_function(albedo, nodes)
    integral = (weights * h / (nodes[:, None] + nodes)).sum(axis=1)
    assert h == pytest.approx(1.0 + 0.5 * albedo * nodes * h * integral, rel=1e-6)
    assert (weights * h).sum() == pytest.approx(2.0 / albedo * (1.0 - np.sqrt(1.0 - albedo)), rel=1e-6)


def test_the_phase_function_holds_all_light_and_its_mean_cosine() -> None:
    cosine, weight = np.polynomial.legendre.leggauss(200)
    phase = 2.0 * np.pi * weight * henyey_greenstein(0.7, cosine)
    assert phase.sum() == pytest.approx(1.0)
    assert (phase * cosine).sum() == pytest.approx(0.7)


def test_a_ball_lit_along_the_ray_has_a_closed_form() -> None:
    # light from behind travels the whole chord; light from the front travels the depth of the collision twice
    origin, along = np.array([0.3, 0.0, 4.0]), np.array([[0.0, 0.0, -1.0]])
    chord = 2.0 * np.sqrt(1.0 - 0.09)
    behind = ball_once(1.0, 0.4, 0.6, 0.5, (0.0, 0.0, -1.0), origin, along)
    assert behind == pytest.approx(np.pi * 0.6 * henyey_greenstein(0.5, 1.0) * chord * np.exp(-chord))
    front = ball_once(1.0, 0.4, 0.6, 0.5, (0.0, 0.0, 1.0), origin, along)
    assert front == pytest.approx(np.pi * 0.6 * henyey_greenstein(0.5, -1.0) * 0.5 * (1.0 - np.exp(-2.0 * chord)))


# --- comparison with the closed forms ---


def half_space_agrees(albedo: float, cosine_in: float, samples: int, tightest: float) -> None:
    cosines = np.array([1.0, 0.8, 0.5, 0.2])
    estimate = radiance_along(
        wide_slab(80.0), grey(albedo), Light(towards(cosine_in)), *looking(cosines), Sampling(samples)
    )
    assert_agrees(estimate, half_space(albedo, cosine_in, cosines), tightest)


@pytest.mark.parametrize(("albedo", "cosine_in"), [(0.5, 1.0), (0.9, 1.0), (0.9, 0.3), (0.99, 0.7)])
def test_half_space(albedo: float, cosine_in: float) -> None:
    half_space_agrees(albedo, cosine_in, 8192, 0.015)


@pytest.mark.slow
@pytest.mark.parametrize("albedo", [0.5, 0.8, 0.9, 0.99])
@pytest.mark.parametrize("cosine_in", [1.0, 0.6, 0.2])
def test_half_space_closely(albedo: float, cosine_in: float) -> None:
    half_space_agrees(albedo, cosine_in, 65_536, 0.008)


def slab_agrees(depth: float, albedo: float, anisotropy: float, samples: int, tightest: float) -> None:
    """Reflectance and transmittance of normal light, as radiance integrated over the angles, against iadpython."""
    root, weight = np.polynomial.legendre.leggauss(16)
    cosines, weights = 0.5 * (root + 1.0), 0.5 * weight
    geometry, medium = wide_slab(depth), grey(albedo, 1.0, anisotropy)
    fluxes = []
    for side in (1.0, -1.0):
        origins, directions = looking(side * cosines)
        if side < 0.0:
            origins[:, 2] -= depth
        estimate = radiance_along(geometry, medium, Light((0.0, 0.0, 1.0)), origins, directions, Sampling(samples))
        share = 2.0 * weights * cosines
        fluxes.append((share @ estimate.mean[:, 0], np.sqrt(share**2 @ estimate.error[:, 0] ** 2)))
    # more quadrature points than 16 lose energy in this version of iadpython
    conserving = iadpython.Sample(a=1.0, b=depth, g=anisotropy, n=1.0, quad_pts=16).rt()
    assert conserving[0] + conserving[1] == pytest.approx(1.0, abs=1e-4)
    reflected, through, _, _ = iadpython.Sample(a=albedo, b=depth, g=anisotropy, n=1.0, quad_pts=16).rt()
    for (flux, error), predicted in zip(fluxes, (reflected, through - unscattered(depth, 1.0)), strict=True):
        assert error < tightest * predicted
        assert abs(flux - predicted) < 3.0 * error, (
            f"{(flux - predicted) / error:.2f} standard errors: {flux} {predicted}"
        )


@pytest.mark.parametrize(
    ("depth", "albedo", "anisotropy"), [(1.0, 0.9, 0.0), (4.0, 0.99, 0.0), (0.5, 0.5, 0.0), (2.0, 0.95, 0.6)]
)
def test_slabs_by_adding_and_doubling(depth: float, albedo: float, anisotropy: float) -> None:
    slab_agrees(depth, albedo, anisotropy, 4096, 0.01)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("depth", "albedo", "anisotropy"), [(1.0, 0.9, 0.0), (8.0, 1.0, 0.0), (0.5, 0.5, 0.0), (2.0, 0.95, 0.6)]
)
def test_slabs_by_adding_and_doubling_closely(depth: float, albedo: float, anisotropy: float) -> None:
    slab_agrees(depth, albedo, anisotropy, 16_384, 0.008)


def test_without_scattering_beer_and_lambert_hold() -> None:
    cosines = np.array([1.0, 0.7, 0.4])
    estimate = radiance_along(wide_slab(0.8), grey(0.0), SKY, *looking(cosines), Sampling(8192))
    assert_agrees(estimate, unscattered(0.8, cosines), 0.03)


@pytest.mark.parametrize(("anisotropy", "back"), [(0.0, True), (0.7, True), (0.7, False), (-0.4, False)])
def test_once_scattered_in_a_slab(anisotropy: float, back: bool) -> None:
    cosine_in, cosine_out, depth = 0.9, 0.6, 0.7
    origins, directions = looking(np.array([cosine_out if back else -cosine_out]), azimuth=0.5)
    if not back:
        origins[:, 2] -= depth
    sun = np.array(towards(cosine_in))
    estimate = radiance_along(
        wide_slab(depth), grey(0.8, 1.0, anisotropy), Light(towards(cosine_in)), origins, directions,
        Sampling(20_000, scatterings=1),
    )  # fmt: skip
    phase = float(henyey_greenstein(anisotropy, directions[0] @ sun))
    assert_agrees(estimate, [slab_once(depth, 0.8, phase, cosine_in, cosine_out, back)], 0.02)


def test_once_scattered_in_a_ball() -> None:
    sun = np.array([0.6, 0.48, -0.64])
    origin, directions = CAMERA.rays(6, 5)
    ball = Ball(radius=0.9)
    hit = ball.hits(origin, directions).hit
    origins = np.broadcast_to(origin, (int(hit.sum()), 3))
    estimate = radiance_along(
        ball, grey(0.7, 1.5, 0.3), Light((0.6, 0.48, -0.64)), origins, directions[hit], Sampling(16_384, scatterings=1)
    )
    assert hit.sum() > 8
    assert_agrees(estimate, ball_once(0.9, 0.45, 1.05, 0.3, sun, origin, directions[hit]), 0.05)


def test_little_scattering_is_nearly_once() -> None:
    origins, directions = np.array([[0.0, 0.0, 4.0]]), np.array([[0.0, 0.0, -1.0]])
    estimate = radiance_along(
        Ball(radius=0.1), grey(0.05), Light((1.0, 0.0, 0.0)), origins, directions, Sampling(100_000)
    )
    once = ball_once(0.1, 0.95, 0.05, 0.0, (1.0, 0.0, 0.0), origins[0], directions)
    # the light scattered twice is at most albedo × optical diameter of the light scattered once
    assert once[0] - 3.0 * estimate.error[0, 0] < estimate.mean[0, 0] < 1.01 * once[0] + 3.0 * estimate.error[0, 0]
    assert estimate.error[0, 0] < 0.05 * once[0]


SHAPES = [
    Ball(radius=0.7, **ASKEW),
    Box(size=(1.0, 0.6, 1.4), scale=1.1, **ASKEW),
    Slab(1.5, 1.0, 0.3, **ASKEW),
    Torus(0.7, 0.25, **ASKEW),
    Distance(technique="box", reach=1.5, **ASKEW),
]


@pytest.mark.parametrize("geometry", SHAPES, ids=lambda shape: type(shape).__name__)
def test_a_medium_without_absorption_vanishes_in_an_even_sky(geometry: Geometry) -> None:
    estimate = radiance(geometry, grey(1.0, 3.0), SKY, CAMERA, (24, 18), 512, resolution=32)
    hit = geometry.hits(*CAMERA.rays(24, 18)).hit.reshape(18, 24)
    assert hit.any() and not hit.all()
    assert (estimate.mean[~hit] == 0.0).all()
    mean, error = estimate.mean[hit, 0].mean(), np.sqrt((estimate.error[hit, 0] ** 2).sum()) / hit.sum()
    assert error < 0.01
    assert abs(mean - 1.0) < 3.0 * error


@pytest.mark.parametrize("geometry", SHAPES[:3], ids=lambda shape: type(shape).__name__)
def test_each_pixel_looks_along_its_own_ray(geometry: Geometry) -> None:
    # an absorbing medium shows the length of each ray in the body; the rotated shapes would reveal a flipped picture
    origin, directions = CAMERA.rays(24, 18)
    first = geometry.hits(origin, directions)
    far = origin + 20.0 * directions
    last = np.stack([geometry.hits(point, -way[None]).position[0] for point, way in zip(far, directions, strict=True)])
    chord = np.where(first.hit, np.linalg.norm(last - first.position, axis=1), 0.0)
    estimate = radiance(geometry, grey(0.0, 1.5), SKY, CAMERA, (24, 18), 1024)
    expected = np.where(first.hit, unscattered(1.5, 1.0 / np.maximum(chord, 1e-9)), 0.0).reshape(18, 24)
    difference = estimate.mean[..., 0] - expected
    assert (
        np.abs(difference[estimate.error[..., 0] > 0.0] / estimate.error[estimate.error[..., 0] > 0.0][:, 0]).max()
        < 5.0
    )
    assert np.abs(difference).max() < 0.08
    assert np.sqrt((difference**2).mean()) < 0.02


@pytest.mark.slow
def test_a_mesh_of_a_ball_reads_like_the_ball() -> None:
    light, medium = Light((0.6, 0.0, -0.8)), grey(0.9, 4.0)
    camera = Camera(position=(0.0, 0.0, 4.0), field_of_view=25.0)
    exact = radiance(Ball(radius=1.0), medium, light, camera, (10, 10), 2048)
    near = radiance(Distance(technique="sphere", reach=1.2), medium, light, camera, (10, 10), 2048, resolution=48)
    both = np.maximum(np.hypot(exact.error, near.error), 1e-9)[..., 0]
    inner = (exact.mean[..., 0] > 0.0) & (near.mean[..., 0] > 0.0)
    off = ((near.mean - exact.mean)[..., 0] / both)[inner]
    assert inner.sum() > 60
    assert abs(off.mean()) < 3.0 / np.sqrt(len(off))
    assert np.abs(off).max() < 4.5


# --- the noise ---


@pytest.mark.slow
def test_the_error_is_that_of_equal_rays() -> None:
    # 400 equal rays, in 8 and in 64 batches: their means spread by their standard errors
    origins, directions = (np.repeat(part, 400, axis=0) for part in looking(np.array([0.8])))
    for samples in (128, 1024):
        estimate = radiance_along(
            wide_slab(40.0), grey(0.9), Light((0.0, 0.0, 1.0)), origins, directions, Sampling(samples)
        )
        spread = estimate.mean[:, 0].std(ddof=1)
        assert spread == pytest.approx(np.sqrt((estimate.error[:, 0] ** 2).mean()), rel=0.15)
        predicted = half_space(0.9, 1.0, 0.8)
        assert abs(estimate.mean[:, 0].mean() - predicted) < 3.0 * spread / np.sqrt(400)


def test_channels_have_their_own_coefficients() -> None:
    medium = Medium("skin", (0.1, 0.5, 0.1), (0.9, 0.5, 0.9))
    estimate = radiance_along(
        wide_slab(60.0), medium, Light((0.0, 0.0, 1.0)), *looking(np.array([1.0])), Sampling(3072)
    )
    assert (estimate.mean[:, 0] == estimate.mean[:, 2]).all()
    for at, albedo in enumerate(medium.albedo):
        assert abs(estimate.mean[0, at] - half_space(albedo, 1.0, 1.0)) < 3.0 * estimate.error[0, at]


def test_numbers_do_not_depend_on_threads() -> None:
    drjit = pytest.importorskip("drjit")
    threads = drjit.thread_count()
    results = []
    try:
        for count in (1, 2, 5):
            drjit.set_thread_count(count)
            results.append(radiance(SHAPES[0], grey(0.9, 3.0), (0.0, 0.6, -0.8), CAMERA, (20, 15), 128))
    finally:
        drjit.set_thread_count(threads)
    assert all(
        (result.mean == results[0].mean).all() and (result.error == results[0].error).all() for result in results
    )
    other = radiance(SHAPES[0], grey(0.9, 3.0), (0.0, 0.6, -0.8), CAMERA, (20, 15), 128, seed=1)
    assert (other.mean != results[0].mean).any()


# --- boundaries, meshes, errors ---


def test_a_refracting_boundary_conserves_energy() -> None:
    medium = Medium("glassy", (0.0,) * 3, (2.0,) * 3, ior=1.4)
    estimate = radiance(SHAPES[0], medium, SKY, CAMERA, (20, 15), 512)
    hit = SHAPES[0].hits(*CAMERA.rays(20, 15)).hit.reshape(15, 20)
    # every path ends in the same sky with its full weight, so the only noise is rounding
    assert hit.any() and estimate.mean[hit] == pytest.approx(1.0, abs=1e-5)


def test_a_refracting_slab_by_adding_and_doubling() -> None:
    # by reciprocity: the radiance of a slab under an even sky, seen from above, is R + T of a beam along the ray
    medium = Medium("resin", (0.1,) * 3, (0.9,) * 3, ior=1.5)
    estimate = radiance_along(wide_slab(2.0), medium, SKY, *looking(np.array([1.0])), Sampling(40_000))
    reflected, through, _, _ = iadpython.Sample(a=0.9, b=2.0, g=0.0, n=1.5, quad_pts=16).rt()
    assert_agrees(estimate, [reflected + through], 0.01)


def test_a_light_of_small_width_is_nearly_a_point() -> None:
    cosines = np.array([0.9, 0.4])
    narrow = half_space(0.8, 0.7, cosines)
    estimate = radiance_along(
        wide_slab(60.0), grey(0.8), Light(towards(0.7), radius=5.0), *looking(cosines), Sampling(8192)
    )
    assert_agrees(estimate, narrow, 0.02)


@pytest.mark.parametrize("geometry", SHAPES, ids=lambda shape: type(shape).__name__)
def test_meshes_are_closed_and_on_the_surface(geometry: Geometry) -> None:
    trimesh = pytest.importorskip("trimesh")
    vertices, faces = mesh_of(geometry, 40)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    assert mesh.is_watertight and mesh.is_winding_consistent and mesh.volume > 0.0
    matrix = geometry.to_object()
    assert np.abs(geometry.distance(vertices @ matrix[:3, :3].T + matrix[:3, 3])).max() < 1e-3


def test_volumes_are_those_of_the_shapes() -> None:
    trimesh = pytest.importorskip("trimesh")
    for geometry, volume in [
        (Torus(0.7, 0.25, scale=2.0), 2.0 * np.pi**2 * 0.7 * 0.25**2 * 8.0),
        (Box(size=(1.0, 2.0, 3.0)), 6.0),
        (Distance(technique="sphere", reach=1.2), 4.0 / 3.0 * np.pi),
        (Distance(technique="sphere", reach=0.8), 4.0 / 3.0 * np.pi * 0.8**3),
    ]:
        vertices, faces = mesh_of(geometry, 64)
        assert trimesh.Trimesh(vertices, faces, process=False).volume == pytest.approx(volume, rel=5e-3)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"medium": preset("marble")}, "medium.matched()"),
        ({"light_direction": (0.0, 0.0, 2.0)}, "divide it by its length"),
        ({"light_direction": Light((0.0, 0.0, 1.0), radius=90.0)}, "less than 90"),
        ({"samples": 0}, "0 samples are too few"),
        ({"camera": Camera(position=(0.2, 0.1, 0.3))}, "move the camera out"),
    ],
)
def test_invalid_scenes_are_refused(change: dict[str, object], message: str) -> None:
    values: dict[str, object] = {
        "geometry": SHAPES[0], "medium": grey(0.9), "light_direction": (0.0, 0.0, 1.0), "camera": CAMERA,
        "size": (8, 6), "samples": 128,
    }  # fmt: skip
    with pytest.raises(SssgenError) as caught:
        radiance(**{**values, **change})  # type: ignore[arg-type]
    assert message in str(caught.value)


# --- the cache ---


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("SSSGEN_CACHE", str(tmp_path))
    return tmp_path


def render(samples: int, seed: int = 0) -> Transport:
    return radiance(SHAPES[0], grey(0.9, 3.0), (0.0, 0.6, -0.8), CAMERA, (12, 9), samples, seed)


def rendered(monkeypatch: pytest.MonkeyPatch, stop_at: int = 10**9) -> list[int]:
    """Records the numbers of rendered batches; raises an interrupt instead of rendering the batch `stop_at`."""
    numbers: list[int] = []
    batch = Renderer.batch

    def recorded(self: Renderer, number: int, samples: int) -> Array:
        if number == stop_at:
            raise KeyboardInterrupt
        numbers.append(number)
        return batch(self, number, samples)

    monkeypatch.setattr(Renderer, "batch", recorded)
    return numbers


def test_cached_pictures_are_not_rendered_again(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    numbers = rendered(monkeypatch)
    small_render = render(128)
    assert numbers == list(range(8))
    again = render(128)
    assert numbers == list(range(8))
    large_render = render(200)
    assert numbers == list(range(13))
    monkeypatch.setenv("SSSGEN_CACHE", "")
    monkeypatch.setattr(cache, "_folder", None)
    for cached, fresh in ((small_render, render(128)), (again, render(128)), (large_render, render(200))):
        assert (cached.mean == fresh.mean).all() and (cached.error == fresh.error).all()
        assert cached.samples == fresh.samples


def test_an_interrupted_render_continues(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = render(160)
    for entry in folder.iterdir():
        entry.unlink()
    monkeypatch.setattr(transport, "_SECONDS_BETWEEN_WRITES", 0.0)
    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        rendered(patch, stop_at=6)
        render(160)
    numbers = rendered(monkeypatch)
    resumed = render(160)
    assert numbers == [6, 7, 8, 9]
    assert (resumed.mean == whole.mean).all() and (resumed.error == whole.error).all()


def test_a_damaged_entry_is_recomputed(folder: Path) -> None:
    first = render(128)
    (entry,) = folder.glob("reference-*.npz")
    entry.write_bytes(entry.read_bytes()[:1000])
    assert (render(128).mean == first.mean).all()


def test_each_input_has_its_own_entry(folder: Path) -> None:
    render(128)
    render(128, seed=1)
    radiance(Ball(radius=0.71, **ASKEW), grey(0.9, 3.0), (0.0, 0.6, -0.8), CAMERA, (12, 9), 128)
    radiance(SHAPES[0], grey(0.8, 3.0), (0.0, 0.6, -0.8), CAMERA, (12, 9), 128)
    radiance(SHAPES[0], grey(0.9, 3.0), (0.0, 0.8, -0.6), CAMERA, (12, 9), 128)
    radiance(SHAPES[3], grey(0.9, 3.0), (0.0, 0.6, -0.8), CAMERA, (12, 9), 128, resolution=16)
    radiance(SHAPES[3], grey(0.9, 3.0), (0.0, 0.6, -0.8), CAMERA, (12, 9), 128, resolution=17)
    assert len(list(folder.glob("reference-*.npz"))) == 7


def test_versions_and_batches_are_those_of_the_stored_references() -> None:
    # a change of these numbers requires a new transport._VERSION
    assert (transport._VERSION, transport.BATCH, transport.FEWEST_BATCHES) == (1, 16, 8)
