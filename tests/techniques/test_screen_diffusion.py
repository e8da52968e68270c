"""Light that spreads on the screen, compared with Burley's profile and with path tracing of a head of skin."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import ndimage
from scipy.optimize import nnls

from folders import DOCS
from oracle import Array, close, technique
from sssgen.lab.reference.sampling import Sampling
from sssgen.lab.reference.transport import Light, radiance_along
from sssgen.run import backends
from sssgen.run.render.scene_render import render
from sssgen.scene import scene_loading
from sssgen.scene.measured.media import preset
from sssgen.scene.pictures.picture_difference import EPSILON

SIDE = 256
"""Of a picture of the plane z = 0, from -1 to 1, seen from a parallel view along z."""
VIEW = np.array([[0.5, 0.0, 0.0, 0.5], [0.0, 0.5, 0.0, 0.5], [0.0, 0.0, -1.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
NORMAL = np.array([0.0, 0.0, 1.0])


def picture(light: Array, depth: Array | float = 0.0) -> Array:
    """A picture of light (SIDE, SIDE) and distances from the plane."""
    texels = np.zeros((SIDE, SIDE, 4))
    texels[..., :3], texels[..., 3] = light[..., None], depth
    return texels


def spread(texels: Array, points: Array, d: Any, **values: Any) -> tuple[Array, Array]:
    """Albedo and emission at points of the plane."""
    inputs = {"albedo": np.ones(3), "emission": np.zeros(3), "eye_matrix": VIEW, **values}
    albedo, emission = technique("screen_diffusion")(
        P=points,
        N=NORMAL,
        V=NORMAL,
        matt_light_map=texels,
        spread_length=np.broadcast_to(np.asarray(d, float), 3),
        **inputs,
    )
    return albedo, emission


def along_x(places: Array) -> Array:
    return np.stack([places, np.full_like(places, 0.1), np.zeros_like(places)], axis=-1)


def test_even_light_stays_and_the_albedo_multiplies_it() -> None:
    albedo, emission = spread(
        picture(np.full((SIDE, SIDE), 0.7)), along_x(np.linspace(-0.3, 0.3, 9)), (0.05, 0.03, 0.01),
        albedo=np.array([0.5, 0.25, 0.125]), emission=np.array([1.0, 2.0, 3.0]),
    )  # fmt: skip
    close(albedo, np.zeros_like(albedo))
    close(emission, np.array([1.35, 2.175, 3.0875]) * np.ones((9, 1)), rtol=1e-6)


def test_without_a_picture_the_engines_reflection_stays() -> None:
    albedo, emission = spread(picture(np.ones((SIDE, SIDE))), along_x(np.zeros(2)), 0.05, eye_matrix=np.zeros((4, 4)))
    close(albedo, np.ones_like(albedo))
    close(emission, np.zeros_like(emission))


def test_no_spread_is_the_light_at_the_point() -> None:
    light = np.random.default_rng(3).random((SIDE, SIDE))
    centers = (np.arange(100, 150) + 0.5) / SIDE * 2.0 - 1.0
    points = np.stack([centers, np.full(50, centers[20]), np.zeros(50)], axis=-1)
    _, emission = spread(picture(light), points, 0.0)
    close(emission[:, 0], light[120, 100:150], atol=1e-3)


def test_an_edge_of_light_has_the_profile_of_burley() -> None:
    """Light on one half: the share of the profile that lies there."""
    d = 0.04
    random = np.random.default_rng(5)
    # the profile is the mean of two exponentials in r, with a quarter and three quarters of the light
    radius = np.where(random.random(400_000) < 0.25, 1.0, 3.0) * random.exponential(d, 400_000)
    x = radius * np.cos(2.0 * np.pi * random.random(400_000))
    places = np.linspace(-0.4, 0.4, 81)
    expected = (x[None, :] > -places[:, None]).mean(axis=1)
    half = np.broadcast_to((np.arange(SIDE) >= SIDE // 2).astype(float), (SIDE, SIDE))
    _, emission = spread(picture(half), along_x(places), d)
    error = np.abs(emission[:, 0] - expected)
    print(f"largest error {error.max():.3f}, mean {error.mean():.3f}")
    assert error.max() < 0.12 and error.mean() < 0.03


def test_surfaces_apart_give_each_other_nothing() -> None:
    """The lit half lies ten spreads behind the dark one."""
    columns = np.arange(SIDE) >= SIDE // 2
    light = np.broadcast_to(columns.astype(float), (SIDE, SIDE))
    depth = np.broadcast_to(np.where(columns, 0.3, 0.0), (SIDE, SIDE))
    _, emission = spread(picture(light, depth), along_x(np.linspace(-0.2, -0.02, 20)), 0.01)
    assert emission.max() < 0.02


HEAD = (DOCS / "screen_diffusion" / "head.sss").as_posix()
SCENE = f"""
material = "skin.toml"
size = [300, 400]
samples = 1

[geometry]
kind = "distance"
technique = "{HEAD}"
reach = 1.6

[camera]
position = [0.6, 0.2, 7.0]
target = [0.0, 0.05, 0.0]
field_of_view = 26.0

[[light]]
direction = [0.85, 0.4, 0.35]
color = [1.0, 1.0, 1.0]
"""
SURFACE = """
[material]
name = "skin"

[[surface]]
technique = "base_color"
tint = [{tint}, {tint}, {tint}, 1.0]

[[surface]]
technique = "screen_diffusion"
spread_length = {spread}

[[surface]]
technique = "specular_level"
dielectric_specular = 0.0
"""
OCTAVE = """
[[thickness]]
technique = "march_view"
bind = {{ body_distance = "{head}" }}
reach = {{ value = 3.0, fixed = true }}

[translucency]
technique = "interior_octaves"
bind = {{ light_path = "march_light_traced", body_distance = "{head}" }}
extinction = {extinction}
scattering_albedo = {albedo}
octaves = {octaves}
mean_free_path = {path}
"""
UNIT = 120.0
"""Millimetres: the head is 330 mm high."""
NEAR = 5.0
"""Points that are nearer to the border of a shadow than this, in millimetres, are near it."""


@pytest.mark.slow
def test_a_head_of_skin_near_the_edges_of_shadows(tmp_path: Path) -> None:
    """The error of all light: octaves alone, octaves with a matt share, and with one that spreads."""
    medium = dataclasses.replace(preset("skin1", UNIT), ior=1.0)
    extinction, albedo = np.array(medium.extinction), np.array(medium.albedo)
    mean_free_path = 1.0 / np.sqrt(3.0 * extinction**2 * (1.0 - albedo))  # of the diffused light

    def picture_of(text: str) -> Array:
        (tmp_path / "skin.toml").write_text(text, encoding="utf-8")
        (tmp_path / "scene.toml").write_text(SCENE, encoding="utf-8")
        picture = render(scene_loading.load(str(tmp_path / "scene.toml")), backends.require("gl"))
        covered.append(picture.covered > 0.5)
        return picture.linear

    def octave(number: int) -> Array:
        values = {"extinction": extinction.tolist(), "albedo": albedo.tolist(), "path": 1.0 / extinction[1]}
        octaves = [float(number == other) for other in range(4)]
        black = SURFACE.format(tint=0.0, spread=[0.0] * 3)
        return picture_of(black + OCTAVE.format(head=HEAD, octaves=octaves, **values)) - highlights

    covered: list[Array] = []
    highlights = picture_of(SURFACE.format(tint=0.0, spread=[0.0] * 3))
    sharp = picture_of(SURFACE.format(tint=1.0, spread=[0.0] * 3)) - highlights
    soft = picture_of(SURFACE.format(tint=1.0, spread=(0.65 * mean_free_path).tolist())) - highlights
    octaves = [octave(number) for number in range(4)]

    scene = scene_loading.load(str(tmp_path / "scene.toml"))
    assert scene.geometry is not None
    inner, lit = ndimage.binary_erosion(covered[0], iterations=3), sharp[..., 1] > 1e-4
    border = ndimage.binary_dilation(lit & covered[0]) & ndimage.binary_dilation(covered[0] & ~lit)
    pixel = 2.0 * 7.0 * np.tan(np.radians(13.0)) / 400.0 * UNIT
    close_to_border = (ndimage.distance_transform_edt(~border) * pixel < NEAR) & inner
    random = np.random.default_rng(1)
    near = random.permutation(np.flatnonzero(close_to_border))[:300]
    everywhere = random.permutation(np.flatnonzero(inner))[:300]
    pixels = np.concatenate([near, everywhere])
    origin, directions = scene.camera.rays(300, 400)
    rays = directions[(399 - pixels // 300) * 300 + pixels % 300]  # their row 0 is at the bottom
    towards = np.array(scene.lights[0].direction)
    light = Light((towards[0], towards[1], towards[2]))
    origins = np.broadcast_to(origin, rays.shape)
    traced = radiance_along(scene.geometry, medium, light, origins, rays, Sampling(256), 256)
    weight = 1.0 / (traced.mean**2 + EPSILON)

    def errors(*parts: Array) -> tuple[float, float]:
        """The relative error of all points and of those near borders; octaves have weights, a matt share a colour."""
        columns = [part.reshape(-1, 3)[pixels] for part in parts]
        if len(parts) % 4:  # the last is a matt share
            share = columns.pop()
            columns += [share * np.eye(3)[channel] for channel in range(3)]
        fitted = np.arange(len(pixels)) >= len(near)
        scale = np.sqrt(weight[fitted])
        weights, _ = nnls(
            np.stack([(column[fitted] * scale).ravel() for column in columns], axis=1),
            (traced.mean[fitted] * scale).ravel(),
        )
        value = sum(number * column for number, column in zip(weights, columns, strict=True))
        square = ((value - traced.mean) ** 2 - traced.error**2) * weight
        return float(np.sqrt(square[fitted].mean())), float(np.sqrt(square[~fitted].mean()))

    rows = {
        "octaves alone": errors(*octaves),
        "a matt share alone": errors(sharp),
        "a share that spreads alone": errors(soft),
        "octaves and a matt share": errors(*octaves, sharp),
        "octaves and a share that spreads": errors(*octaves, soft),
    }
    print("error of all light: at all points, near the edges of shadows")
    for name, (whole, edge) in rows.items():
        print(f"{name:34} {whole:.3f} {edge:.3f}")
    assert rows["octaves and a share that spreads"][1] < 0.18
    assert rows["octaves and a share that spreads"][1] < rows["octaves and a matt share"][1]
    assert rows["a share that spreads alone"][1] < 0.9 * rows["a matt share alone"][1]
