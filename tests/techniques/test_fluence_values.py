"""Light from baked fluence volumes, compared with the numbers in the volumes and with closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from oracle import Array, close, rng, technique, unit, units
from slow_cases import some_slow
from sssgen.lab.fluence import fluence_field as field
from sssgen.lab.fluence import fluence_volumes as volumes
from sssgen.lab.fluence.fluence_field import Settings
from sssgen.scene.camera import Camera
from sssgen.scene.geometry import Ball
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.media import Medium
from sssgen.targets.runtime.numpy_textures import Texture

SIDE = 34
"""The texels along a map's side, with its border."""
NUMBER = 400
"""Of a direction of the map"""


def maps_of(table: Array, rank: int) -> Array:
    """The rank + 1 maps of a table: those beside each other, and those in their alphas."""
    tiles = table.reshape(SIDE, -1, SIDE, 4).transpose(1, 0, 2, 3)
    count = rank + 1 - len(tiles)
    alphas = [
        np.stack([tiles[3 * number + channel, ..., 3] for channel in range(3)], axis=2) for number in range(count)
    ]
    maps: Array = np.concatenate([tiles[..., :3], alphas])
    return maps


@pytest.fixture(scope="module")
def traced() -> field.Field:
    """The light inside a small ball."""
    medium = Medium("test", (0.6,) * 3, (5.4,) * 3, 0.0, 1.0, "the test")
    scene = MeasuredScene("body", "body", Ball(0.5), Camera(), (), medium, None)
    return field.field(scene, Settings(voxels=8, side=SIDE - 2, photons=300), processes=0)


@pytest.mark.parametrize("name", some_slow(["fluence_factored_4", "fluence_factored_8"], "fluence_factored_8"))
def test_the_techniques_read_what_the_bake_writes(name: str, traced: field.Field) -> None:
    pytest.importorskip("scipy", reason="SciPy is missing: pip install -e '.[chart]'")
    rank = int(name[-1])
    stored = volumes.factor_field(traced, rank)
    names = {f"fluence_table_{rank}": Texture(stored.table, wrap="clamp")}
    for number in range(rank // 4):
        latents = stored.latents[..., 4 * number : 4 * number + 4] / 255.0
        names[f"fluence_latents_{rank}_{number + 1}"] = Texture(latents, "nearest", "clamp")
    size = traced.grid.high - traced.grid.low
    matrix = np.eye(4)
    matrix[[0, 1, 2], [0, 1, 2]], matrix[:3, 3] = 1.0 / size, -traced.grid.low / size
    constant = "thickness blocked(world_position p, world_direction l) { return thickness(1000.0); }"
    lit = technique(name, light_path=constant)
    centres = traced.grid.centres()[:, 0]
    chosen = np.flatnonzero(np.linalg.norm(centres, axis=1) < 0.3)[::7]
    light = traced.directions[NUMBER]
    zeros = np.zeros((len(chosen), 3))
    result = lit(
        d=np.full(len(chosen), 1e9), P=centres[chosen], V=zeros, L=zeros, L_object=np.tile(light, (len(chosen), 1)),
        extinction=(6.0,) * 3, scattering_albedo=(0.9,) * 3, world_to_volume=matrix, **names,
    )  # fmt: skip
    numbers = stored.latents.reshape(-1, rank)[chosen] / 255.0
    tiles = maps_of(stored.table, rank)[:, 1 + NUMBER // (SIDE - 2), 1 + NUMBER % (SIDE - 2)]
    close(result, 0.9 * np.maximum(tiles[0] + numbers @ tiles[1:], 0.0), rtol=1e-6)
    exact = 0.9 * traced.smooth[:, NUMBER][:, traced.nearest[chosen]].T
    assert np.median(np.abs(result / exact - 1.0)) < 0.25


@pytest.mark.parametrize("name", ["fluence_factored_4", "fluence_factored_8"])
def test_the_unscattered_light_of_two_nodes(name: str) -> None:
    """Without a volume: the mean of what is left at both nodes, exactly so for a medium of one colour."""
    rank = int(name[-1])
    path = "thickness height(world_position p, world_direction l) { return thickness(2.0 - 0.5 * p.z); }"
    lit = technique(name, light_path=path)
    length, zeros = np.array([0.1, 0.7, 50.0]), np.zeros((3, 3))
    ups = np.tile([0.0, 0.0, -1.0], (3, 1))
    names = {f"fluence_table_{rank}": Texture(np.zeros((SIDE, SIDE * (4 if rank == 4 else 7), 4)), wrap="clamp")}
    names |= {f"fluence_latents_{rank}_{number + 1}": Texture(np.zeros((2, 2, 2, 4))) for number in range(rank // 4)}
    values = {"d": length, "P": zeros, "V": ups, "L": zeros, "L_object": ups, "scattering_albedo": (1.0,) * 3, **names}
    nodes = np.minimum(-0.25 * np.log([0.7886751, 0.2113249]), length[:, None] * [0.2113249, 0.7886751])
    for sigma in ((4.0, 4.0, 4.0), (3.0, 4.0, 5.0)):
        left = 0.125 * np.exp(-np.array(sigma) * (2.0 - 0.5 * nodes)[..., None]).sum(axis=1)
        expected = (1.0 - np.exp(-np.array(sigma) * length[:, None])) * left
        result = lit(extinction=sigma, mean_free_path=0.25, **values)
        close(result, expected, rtol=1e-5 if sigma[0] == 4.0 else 0.06)


FIXED = ("fluence_fixed", "fluence_fixed_gaps")


@pytest.mark.parametrize("name", FIXED)
def test_the_techniques_of_a_fixed_light_in_even_light(name: str) -> None:
    """Where the volume is even, the light is the part of the eye's ray that is seen times what is there."""
    sigma, albedo, length = np.array([1.0, 3.0, 5.0]), np.array([0.9, 0.5, 0.1]), np.array([0.0, 0.1, 0.7, 1e9])
    zeros, eyes = np.zeros((4, 3)), np.tile([0.0, 0.0, -1.0], (4, 1))
    texel = np.array([0.5, 0.5, 0.5, 1.0])  # outside everywhere, behind the first exit
    result = technique(name)(
        d=length, P=zeros + 0.5, V=eyes, extinction=sigma, scattering_albedo=albedo,
        mean_free_path=1.0 / 3.0, fluence_volume=Texture(np.tile(texel, (2, 2, 2, 1)), wrap="clamp"),
        fluence_scale=(1.0, 2.0, 4.0), world_to_volume=np.eye(4),
    )  # fmt: skip
    close(result, albedo * (1.0 - np.exp(-sigma * length[:, None])) * 0.25 * np.array([1.0, 2.0, 4.0]), rtol=1e-6)


@pytest.mark.parametrize("name", FIXED)
def test_the_techniques_of_a_fixed_light_along_a_slope(name: str) -> None:
    """Light that fades along the ray, in channels of different extinction: near the integral over the ray."""
    count, sigma, length = 256, np.array([2.0, 4.0, 6.0]), np.array([0.2, 0.5, 0.9])
    z = (np.arange(count) + 0.5) / count
    texels = np.ones((count, 1, 1, 4))
    texels[..., :3] = np.sqrt(np.exp(-2.0 * z))[:, None, None, None]
    places, eyes = np.tile([0.5, 0.5, 0.0], (3, 1)), np.tile([0.0, 0.0, -1.0], (3, 1))
    result = technique(name)(
        d=length, P=places, V=eyes, extinction=sigma, mean_free_path=0.25,
        scattering_albedo=(1.0,) * 3, fluence_volume=Texture(texels, wrap="clamp"), fluence_scale=(1.0,) * 3,
        world_to_volume=np.eye(4),
    )  # fmt: skip
    total = sigma + 2.0
    close(result, sigma / total * (1.0 - np.exp(-total * length[:, None])), rtol=0.03)


def test_light_behind_a_gap() -> None:
    """Two plates with a gap: the second one scatters light that is seen through the first. A march is near it."""
    count, walls = 64, (0.2, 0.5, 0.75)
    z = (np.arange(count) + 0.5) / count
    distance = np.max([np.minimum(z - walls[0], walls[1] - z), z - walls[2]], axis=0)
    distance = np.where(z < walls[0], z - walls[0], distance)
    texels = np.full((count, 1, 1, 4), np.sqrt(0.5))
    texels[..., 3] = (0.5 + 0.5 * distance / 0.25)[:, None, None]
    sigma, way = np.array([2.0, 4.0, 6.0]), np.array([0.6, 0.0, 0.8])
    values = {"d": np.array([walls[0] / 0.8]), "P": np.array([[0.0, 0.5, 0.0]]), "V": -way[None], "extinction": sigma,
              "mean_free_path": 0.25, "scattering_albedo": (1.0,) * 3, "world_to_volume": np.eye(4),
              "fluence_volume": Texture(texels, wrap="clamp"), "fluence_scale": (1.0, 1.0, 2.0)}  # fmt: skip
    first = np.exp(-sigma * walls[0] / 0.8)
    second = np.exp(-sigma * (walls[2] - walls[1]) / 0.8)
    level = 0.5 * np.array([1.0, 1.0, 2.0])
    close(technique("fluence_fixed")(**values)[0], level * (1.0 - first), rtol=1e-6)
    behind = technique("fluence_fixed_gaps")(**values, fluence_reach=0.25)[0] - level * (1.0 - first)
    close(behind, level * first * (1.0 - second), rtol=0.02)
    ends = Texture(1.0 + np.array(walls)[None, None] / 0.8)  # the eye is at the distance 1 from the first plate
    seen: dict[str, Any] = {"screen_uv": np.array([[0.5, 0.5]]), "eye_distance": np.array([1.0]), "eye_layer_map": ends}
    seen |= {name: value for name, value in values.items() if name != "d"}
    behind = technique("fluence_fixed_layers")(**seen)[0] - level * (1.0 - first)
    close(behind, level * first * (1.0 - second), rtol=1e-6)
    # the volume of all lights has no scale: its texels are the light itself
    summed = Texture(np.array([0.5, 0.5, 1.0]) * np.ones((count, 1, 1, 3)), wrap="clamp")
    relit = {name: value for name, value in seen.items() if name not in ("fluence_volume", "fluence_scale")}
    behind = technique("fluence_relit")(**relit, inner_light=summed)[0] - level * (1.0 - first)
    close(behind, level * first * (1.0 - second), rtol=1e-6)
    # a ray along the plates meets no other one
    along = values | {"V": np.array([[-1.0, 0.0, 0.0]]), "P": np.array([[0.0, 0.5, 0.35]]), "d": np.array([0.0])}
    close(technique("fluence_fixed_gaps")(**along, fluence_reach=0.25), 0.0, atol=1e-6)


RADIUS = 0.7


def refracted_in_ball(ior: float, count: int) -> tuple[Array, Array, Array, Array, Array]:
    """Points on a ball, directions to an eye, the refracted rays and their chords, and the factor of radiance."""
    normal = units(count, 3)
    view = unit(normal + 0.9 * units(count, 4))
    cosine = np.einsum("nc,nc->n", normal, view)
    side = view - cosine[:, None] * normal
    sine = np.linalg.norm(side, axis=1) / ior
    ray = -(np.sqrt(1.0 - sine**2)[:, None] * normal + side / ior)
    # Fresnel's equations with the cosines on both sides
    beyond = np.sqrt(1.0 - sine**2)
    across = (cosine - ior * beyond) / (cosine + ior * beyond)
    along = (beyond - ior * cosine) / (beyond + ior * cosine)
    share = (1.0 - 0.5 * (across**2 + along**2)) / ior**2
    return normal, view, ray, 2.0 * RADIUS * np.sqrt(1.0 - sine**2), share


@pytest.mark.parametrize("ior", [1.0, 1.4, 2.0])
def test_the_technique_of_a_fixed_light_behind_a_refracting_surface(ior: float) -> None:
    """In light that is linear along each axis, three nodes are near the integral over the ray; in even light, exact."""
    normal, view, ray, chord, share = refracted_in_ball(ior, 200)
    sigma, albedo = 4.0, np.array([0.9, 0.5, 0.1])
    slope, level = np.array([0.3, -0.2, 0.25]), 1.1
    # a volume of square roots: 64 texels along each axis, of which the filter interpolates linearly
    count = 64
    axis = (np.arange(count) + 0.5) / count * 2.0 - 1.0
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
    root = np.sqrt((level + x * slope[0] + y * slope[1] + z * slope[2]) / 4.0)
    matrix = np.diag([0.5, 0.5, 0.5, 1.0])
    matrix[:3, 3] = 0.5
    values = {"P": RADIUS * normal, "V": view, "N": normal, "ior": ior, "scattering_albedo": albedo,
              "d": 2.0 * RADIUS * np.einsum("nc,nc->n", normal, view), "mean_free_path": 1.0 / sigma,
              "fluence_scale": (4.0, 4.0, 8.0), "world_to_volume": matrix}  # fmt: skip
    lit = technique("fluence_fixed_refracted")
    result = lit(
        extinction=(sigma,) * 3, fluence_volume=Texture(np.repeat(root[..., None], 3, axis=3), wrap="clamp"), **values
    )
    parts = (np.arange(4000) + 0.5) / 4000
    length = chord[:, None] * parts
    light = level + (RADIUS * normal) @ slope
    along = light[:, None] + (ray @ slope)[:, None] * length
    seen = (sigma * np.exp(-sigma * length) * along).mean(axis=1) * chord
    expected = (share * seen)[:, None] * albedo * (1.0, 1.0, 2.0)
    # three nodes leave a remainder: the logarithm of their place is not a polynomial
    close(result, expected, rtol=1.2e-2)
    channels = np.array([2.0, 4.0, 6.0])
    even = lit(extinction=channels, fluence_volume=Texture(np.full((2, 2, 2, 3), 0.5), wrap="clamp"), **values)
    expected = share[:, None] * albedo * (1.0 - np.exp(-channels * chord[:, None])) * (1.0, 1.0, 2.0)
    close(even, expected, rtol=1e-9)


def inner_reflectance(cosine: Array, ior: float) -> Array:
    """A ramp from nearly all light to that at a right angle, about the critical angle."""
    critical = np.sqrt(max(1.0 - ior**-2, 1e-6))
    result: Array = np.interp(cosine / critical, [0.75, 1.25], [0.999, ((ior - 1.0) / (ior + 1.0)) ** 2])
    return result


@pytest.mark.parametrize("ior", [1.0, 1.4])
def test_light_that_is_reflected_back_where_the_ray_leaves(ior: float) -> None:
    """In even light in a ball, whose distance a volume has: the exit and the angle there follow from it."""
    normal, view, _, chord, share = refracted_in_ball(ior, 200)
    count, reach, sigma = 96, 0.125, np.array([1.0, 2.0, 4.0])
    axis = (np.arange(count) + 0.5) / count * 2.0 - 1.0
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
    texels = np.full((count,) * 3 + (4,), 0.5)
    texels[..., 3] = np.clip(0.5 + 0.5 * (np.sqrt(x * x + y * y + z * z) - RADIUS) / reach, 0.0, 1.0)
    matrix = np.diag([0.5, 0.5, 0.5, 1.0])
    matrix[:3, 3] = 0.5
    straight = 2.0 * RADIUS * np.einsum("nc,nc->n", normal, view)
    none = np.full(len(view), 6.0e4)
    ends = Texture(np.stack([1.0 + straight, none, none], axis=1)[None], "nearest", "clamp")
    places = np.stack([(np.arange(len(view)) + 0.5) / len(view), np.full(len(view), 0.5)], axis=1)
    result = technique("fluence_relit_refracted")(
        P=RADIUS * normal, V=view, N=normal, ior=ior, scattering_albedo=(0.9, 0.5, 0.1), extinction=sigma,
        mean_free_path=0.4, world_to_volume=matrix, inner_light=Texture(texels, wrap="clamp"), fluence_reach=reach,
        eye_layer_map=ends, screen_uv=places, eye_distance=np.ones(len(view)),
    )  # fmt: skip
    cosine = 0.5 * chord / RADIUS
    back = inner_reflectance(cosine, ior)[:, None]
    passes = np.exp(-sigma * chord[:, None])
    seen = 1.0 - passes + back * passes * (1.0 - passes) / (1.0 - back * passes)
    error = np.abs(result / (share[:, None] * np.array([0.9, 0.5, 0.1]) * 0.5 * seen) - 1.0)
    # a small error of the angle counts where total reflection begins
    assert np.quantile(error, 0.95) < 0.01 and error.max() < 0.1
    assert ior == 1.0 or (back * passes).max() > 0.05


@pytest.mark.parametrize("name", ["fluence_factored_4_refracted", "fluence_factored_8_refracted"])
def test_the_factored_techniques_behind_a_refracting_surface(name: str) -> None:
    rank, ior, mean_free_path = int(name.split("_")[2]), 1.4, 0.2
    normal, view, ray, chord, share = refracted_in_ball(ior, 60)
    sigma, albedo = np.array([3.0, 5.0, 7.0]), np.array([0.9, 0.6, 0.4])
    latents = rng(5).uniform(0.0, 1.0, (6, 5, 4, rank))
    table = rng(6).uniform(-0.2, 1.0, (SIDE, SIDE * (4 if rank == 4 else 7), 4))
    names = {f"fluence_table_{rank}": Texture(table, wrap="clamp")}
    for number in range(rank // 4):
        names[f"fluence_latents_{rank}_{number + 1}"] = Texture(
            latents[..., 4 * number : 4 * number + 4], "nearest", "clamp"
        )
    matrix = np.diag([0.5, 0.5, 0.5, 1.0])
    matrix[:3, 3] = 0.5
    result = technique(name)(
        d=2.0 * RADIUS * np.einsum("nc,nc->n", normal, view), P=RADIUS * normal, V=view, N=normal, ior=ior,
        L_object=np.tile([0.0, 0.0, 1.0], (60, 1)), extinction=sigma, scattering_albedo=albedo,
        mean_free_path=mean_free_path, world_to_volume=matrix, **names,
    )  # fmt: skip
    place = RADIUS * normal + np.minimum(np.log(2.0) * mean_free_path, 0.5 * chord)[:, None] * ray
    x, y, z = (np.clip((0.5 * place + 0.5) * (4, 5, 6), 0, (3, 4, 5)).astype(int)).T
    # the direction +z is in the middle of each tile: between four texels
    tiles = maps_of(table, rank)[:, SIDE // 2 - 1 : SIDE // 2 + 1, SIDE // 2 - 1 : SIDE // 2 + 1].mean(axis=(1, 2))
    light = np.maximum(tiles[0] + latents[z, y, x] @ tiles[1:], 0.0)
    close(result, share[:, None] * albedo * (1.0 - np.exp(-sigma * chord[:, None])) * light, rtol=1e-5, atol=1e-9)
    assert (light > 0.0).all(axis=1).any()


@pytest.mark.parametrize("ior", [1.0, 1.4])
def test_the_volume_of_all_lights_at_one_place(ior: float) -> None:
    mean_free_path, sigma, albedo = 0.2, np.array([3.0, 5.0, 7.0]), np.array([0.9, 0.6, 0.4])
    normal, view, ray, chord, share = refracted_in_ball(ior, 60)
    texels = rng(7).uniform(0.0, 1.0, (6, 5, 4, 4))
    matrix = np.diag([0.5, 0.5, 0.5, 1.0])
    matrix[:3, 3] = 0.5
    result = technique("fluence_relit_once")(
        d=2.0 * RADIUS * np.einsum("nc,nc->n", normal, view), P=RADIUS * normal, V=view, N=normal, ior=ior,
        extinction=sigma, scattering_albedo=albedo, mean_free_path=mean_free_path, world_to_volume=matrix,
        inner_light=Texture(texels, "nearest", "clamp"),
    )  # fmt: skip
    place = RADIUS * normal + np.minimum(np.log(2.0) * mean_free_path, 0.5 * chord)[:, None] * ray
    x, y, z = (np.clip((0.5 * place + 0.5) * (4, 5, 6), 0, (3, 4, 5)).astype(int)).T
    light = texels[z, y, x, :3]
    close(result, share[:, None] * albedo * (1.0 - np.exp(-sigma * chord[:, None])) * light, rtol=1e-5, atol=1e-9)
