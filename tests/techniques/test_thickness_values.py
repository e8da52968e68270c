"""Thickness, thinness and transmittance, compared with closed forms, published facts and formulas in NumPy."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from oracle import UP, Array, close, lowbias32, rng, technique, unit, units
from sssgen.targets.runtime.numpy_textures import Texture

ORIGIN = np.zeros(3)
HALF_SPACE = "ground_plane"
VOID = "float nothing(world_position p) { return 1000.0; }"
FULL = "float everywhere(world_position p) { return -1000.0; }"
TWO_SLABS = """
float slab_between(float y, float low, float high) { return max(low - y, y - high); }
float two_slabs(world_position p) { return min(slab_between(p.y, 0.0, 0.3), slab_between(p.y, 0.7, 1.2)); }
"""


def slab(thickness: float) -> dict[str, Any]:
    """The parameters of a box below y = 0, much wider than thick."""
    return {"center": (0.0, -thickness / 2, 0.0), "half_size": (50.0, thickness / 2, 50.0)}


def torus_distance(p: Array) -> Array:
    return np.hypot(np.hypot(p[:, 0], p[:, 2]) - 1.0, p[:, 1]) - 0.25


def on_torus(count: int) -> tuple[Array, Array]:
    """Points on the torus, with slightly changed normals (exact normals pass through the middle of the tube)."""
    a, b = rng().uniform(0.0, 2.0 * np.pi, (2, count))
    n = np.stack([np.cos(a) * np.cos(b), np.sin(b), np.sin(a) * np.cos(b)], axis=1)
    ring = np.stack([np.cos(a), 0 * a, np.sin(a)], axis=1)
    return ring + 0.25 * n, unit(n + 0.8 * units(count))


# Taps along the normal

OURS = 0.8 * 14.5 / 30.0  # 42yeah's mean without any matter: sum(2 d_i) / 30


@pytest.mark.parametrize(("thickness", "raw"), [(0.01, 0.37700), (0.1, 0.29467), (0.4, 0.09333), (0.774, 0.0)])
@pytest.mark.parametrize("ball", [False, True], ids=["slab", "ball"])
def test_thinness_of_a_slab_and_of_a_ball_half_as_large(thickness: float, raw: float, ball: bool) -> None:
    shape: dict[str, Any] = {"center": (0.0, -thickness / 2, 0.0), "radius": thickness / 2} if ball else slab(thickness)
    name = "sphere" if ball else "box"
    published = technique("cheap_sss_thinness", body_distance=name)(P=ORIGIN, N=UP, **shape)
    close(published, raw, atol=6e-6)
    close(technique("thinness_uniform", body_distance=name)(P=ORIGIN, N=UP, **shape), published / OURS, atol=1e-12)


@pytest.mark.parametrize(("edge", "raw"), [(0.0, 0.19333), (0.2, 0.04667)])
def test_thinness_of_a_cube_depends_on_the_nearest_edge(edge: float, raw: float) -> None:
    at = np.array([[0.5 - edge, 0.5, 0.0], [0.1, 0.5, edge - 0.5]])
    close(technique("cheap_sss_thinness", body_distance="box")(P=at, N=UP), raw, atol=6e-6)
    close(technique("thinness_uniform", body_distance="box")(P=at, N=UP), raw / OURS, atol=2e-5)


def test_seed_0_attenuated_reads_matter_where_there_is_none() -> None:
    close(technique("cheap_sss_attenuated", body_distance=HALF_SPACE)(P=ORIGIN, N=UP), 0.160681, atol=6e-7)
    close(technique("cheap_sss_thinness", body_distance=HALF_SPACE)(P=ORIGIN, N=UP), 0.0, atol=1e-15)
    weights = 0.9 ** np.arange(30)
    d = 0.4 * np.arange(30) / 30
    p, n = on_torus(50)
    taps = torus_distance((p[None] - n[None] * d[:, None, None]).reshape(-1, 3)).reshape(30, -1)
    expected = np.mean(d[:, None] + weights[:, None] * taps, axis=0)
    close(technique("cheap_sss_attenuated", body_distance="torus")(P=p, N=n), expected)
    # the mean of the source, which is not normalised, is 0.22844 th; here it is over the 29 taps that count
    right = (weights[:, None] * (d[:, None] + taps))[1:].sum(axis=0) / weights[1:].sum()
    close(right, 0.22844 * technique("thinness_attenuated", body_distance="torus")(P=p, N=n), rtol=2e-5)


def uniform_weights(depths: Array, **_: Any) -> Array:
    return np.ones_like(depths)


def attenuated_weights(depths: Array, decay: float = 0.9, **_: Any) -> Array:
    return decay ** np.arange(len(depths))


def xt95_weights(depths: Array, falloff: float = 1.5, **_: Any) -> Array:
    return (1.0 + depths) ** -falloff


def even_depths(reach: float = 0.4, taps: int = 29, **_: Any) -> Array:
    return reach * np.arange(1, taps + 1) / (taps + 1)


def hashed_depths(reach: float = 0.4, **_: Any) -> Array:
    return np.array([reach * (i + (lowbias32(i + 1) >> 8) / 2**24) / 6 for i in range(6)])


TAPS: dict[str, tuple[Callable[..., Array], Callable[..., Array], list[dict[str, Any]]]] = {
    "thinness_uniform": (even_depths, uniform_weights, [{}, {"reach": 0.9, "taps": 7}, {"taps": 1}]),
    "thinness_attenuated": (even_depths, attenuated_weights, [{}, {"reach": 0.7, "taps": 11, "decay": 0.6}]),
    "thinness_xt95": (hashed_depths, xt95_weights, [{}, {"reach": 1.3, "falloff": 4.0}, {"falloff": 0.0}]),
}


@pytest.mark.parametrize("name", TAPS)
def test_taps_along_the_normal(name: str) -> None:
    depths_of, weights_of, cases = TAPS[name]
    p, n = on_torus(64)
    for case in cases:
        d = depths_of(**case)[:, None]
        w = weights_of(d, **case) if name == "thinness_xt95" else weights_of(d[:, 0], **case)[:, None]
        inside = torus_distance((p[None] - n[None] * d[..., None]).reshape(-1, 3)).reshape(len(d), -1)
        expected = (w * (d + inside)).sum(axis=0) / (2.0 * w * d).sum()
        close(technique(name, body_distance="torus")(P=p, N=n, **case), expected, atol=1e-12)


@pytest.mark.parametrize("name", [*TAPS, "thinness_hemisphere", "thinness_traced"])
@pytest.mark.parametrize(("body", "expected"), [(HALF_SPACE, 0.0), (VOID, 1.0), (FULL, 0.0)])
def test_thinness_is_0_in_deep_matter_and_1_in_air(name: str, body: str, expected: float) -> None:
    """The bounds also hold for fields that are not distances, because each tap is clamped."""
    close(technique(name, body_distance=body)(P=ORIGIN, N=UP), expected, atol=1e-15)


def test_the_published_xt95_formula() -> None:
    p, n = on_torus(40)
    hashes = np.sin(np.arange(6.0)) * 3538.5453
    lengths = 6.0 * (hashes - np.floor(hashes))
    total = sum((x + torus_distance(p - n * x)) / (1.0 + x) ** 1.5 for x in lengths)
    expected = np.clip(1.0 - total / 6.0, 0.0, 1.0)
    close(technique("xt95_thickness", body_distance="torus")(P=p, N=n), expected, atol=1e-9)
    assert expected.min() < expected.max()
    for body, limit in ((HALF_SPACE, 1.0), (VOID, 0.0)):
        close(technique("xt95_thickness", body_distance=body)(P=ORIGIN, N=UP), limit)


@pytest.mark.parametrize("thickness", [0.05, 0.2, 0.35])
def test_hemisphere_of_rays(thickness: float) -> None:
    """A slab D gives 1 - (D / reach)^2. In a ball, a share (reach / 2 R)^2 of the rays leaves within the reach."""
    n = units(32)
    count = 128
    slab_along = technique("thinness_hemisphere", body_distance="box")(P=ORIGIN, N=UP, rays=count, **slab(thickness))
    close(slab_along, 1.0 - (thickness / 0.4) ** 2, atol=0.02)
    through = technique("thinness_hemisphere", body_distance="sphere")
    ball = through(P=n * 0.5, N=n, radius=0.5, rays=count, reach=thickness)
    close(ball, thickness**2, atol=0.02)


def test_hemisphere_counts_rays_that_leave() -> None:
    """Each ray is compared with the exact chord of a ball."""
    n = units(16)
    rays = 24
    i = np.arange(rays)
    z = (i + 0.5) / rays
    r = np.sqrt(1 - z * z)
    turn = np.pi * (3.0 - np.sqrt(5.0)) * i
    spiral = np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=1)
    cosine = np.abs(n @ spiral.T)
    expected = (cosine * (2.0 * 0.3 * cosine < 0.4)).sum(axis=1) / cosine.sum(axis=1)
    margin = np.abs(0.6 * cosine - 0.4).min(axis=1) > 0.002  # without rays that end near the surface
    result = technique("thinness_hemisphere", body_distance="sphere")(P=n * 0.3, N=n, radius=0.3)
    assert margin.sum() > 8
    close(result[margin], expected[margin], atol=1e-8)  # the cosine of the angle has nine digits


# Marches


def ball_chord(n: Array, l: Array, radius: float) -> Array:  # noqa: E741 - the light's usual letter
    chord: Array = 2.0 * radius * np.maximum(-(n * l).sum(axis=1), 0.0)
    return chord


def test_march_of_a_ball_converges_to_the_chord() -> None:
    n, light = units(60), units(60)[::-1]
    march = technique("march_light", body_distance="sphere")
    errors = [
        np.abs(march(P=n * 0.7, L=light, radius=0.7, steps=steps) - ball_chord(n, light, 0.7)).max()
        for steps in (16, 32, 64, 128)
    ]
    assert errors[0] > 2.0 * errors[1] > 4.0 * errors[2] > 8.0 * errors[3], errors
    assert errors[3] < 2e-3


@pytest.mark.parametrize("degrees", [0.0, 35.0, 60.0])
def test_march_through_flat_faces_is_exact(degrees: float) -> None:
    angle = np.radians(degrees)
    light = np.array([np.sin(angle), -np.cos(angle), 0.0])
    march = technique("march_light", body_distance="box")
    close(march(P=ORIGIN, L=light, **slab(0.5)), 0.5 / np.cos(angle), atol=1e-12)
    close(march(P=ORIGIN, L=-light, **slab(0.5)), 0.0, atol=1e-12)
    close(technique("march_light", body_distance=HALF_SPACE)(P=ORIGIN, L=light, reach=0.25), 0.25)  # at most the reach


def test_the_march_sums_the_inside_lengths() -> None:
    """Two slabs of 0.3 and 0.5 with a gap; a depth map of this body counts the gap as matter."""
    slabs = technique("march_light", body_distance=TWO_SLABS)
    close(slabs(P=ORIGIN, L=UP, steps=50), 0.8, atol=1e-12)
    slanted = np.array([0.6, 0.8, 0.0])
    close(slabs(P=ORIGIN, L=slanted, steps=80), 0.8 / 0.8, atol=1e-12)
    close(slabs(P=UP * 1.2, L=-UP, steps=50), 0.8, atol=1e-12)
    traced = technique("march_light_traced", body_distance=TWO_SLABS)
    close(traced(P=ORIGIN, L=UP), 0.8, atol=1e-12)
    close(traced(P=ORIGIN, L=slanted, steps=32), 0.8 / 0.8, atol=1e-2)


WIDE = {"box_min": (-2.0, -1.0, -2.0), "box_max": (2.0, 1.0, 2.0), "half_size": (1.9, 0.3, 1.9)}


@pytest.mark.parametrize("degrees", [0.0, 40.0, 60.0])
@pytest.mark.parametrize("scale", [1.0, 2.5])
def test_mean_way_of_the_light_in_a_plate(degrees: float, scale: float) -> None:
    """A plate D, viewed along its normal, lit from the front: on average D/2 / cos from the light, D/2 to the eye."""
    angle = np.radians(degrees)
    light = np.array([np.sin(angle), np.cos(angle), 0.0])
    march = technique("march_distance_texture", distance_at="box:box_object")
    common = {"P_object": UP * 0.3, "V_object": UP, "view_steps": 24, "light_steps": 24, "object_scale": scale, **WIDE}
    close(march(L_object=light, **common), scale * (0.3 + 0.3 / np.cos(angle)), atol=1e-9)
    close(march(L_object=light * [1, -1, 1], **common), scale * (0.3 + 0.3 / np.cos(angle)), atol=1e-9)


def test_mean_way_with_light_opposite_the_eye_is_the_chord() -> None:
    n = units(40)
    v = unit(n + 0.9 * units(40)[::-1])
    march = technique("march_distance_texture", distance_at="sphere:sphere_object")
    box = {"box_min": (-1.2,) * 3, "box_max": (1.2,) * 3}
    chord = ball_chord(n, -v, 1.0)
    assert (chord > 0.5).all()
    errors = [
        np.abs(march(P_object=n, V_object=v, L_object=-v, view_steps=k, light_steps=k, **box) - chord).max()
        for k in (8, 64)
    ]
    assert errors[1] < 2e-3 < errors[0] < 0.15
    # a grazing view leaves at once, so only the way to the light remains
    grazing = march(P_object=n, V_object=-n, L_object=-n, view_steps=8, light_steps=64, **box)
    close(march(P_object=n, V_object=n, L_object=n, view_steps=64, light_steps=64, **box), 2.0, atol=3e-3)
    close(grazing, 2.0, atol=0.05)


def ball_texture(size: int, low: Array, high: Array, center: Array, radius: float, reach: float) -> Texture:
    """A texture [z, y, x, channel] of the distance to a ball over a box, sampled at the centres of the texels."""
    axes = [low[i] + (np.arange(size) + 0.5) / size * (high[i] - low[i]) for i in range(3)]
    z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
    distance = np.sqrt((x - center[0]) ** 2 + (y - center[1]) ** 2 + (z - center[2]) ** 2) - radius
    return Texture((0.5 + distance / (2.0 * reach))[..., None], wrap="clamp")


def test_march_through_a_texture_of_a_box_off_the_origin() -> None:
    """For a box above 0 that is not a cube, (p + |min|) / size, as in the article, gives the wrong place."""
    low, high, center = np.array([0.5, 1.0, -2.0]), np.array([2.9, 3.2, 0.4]), np.array([1.7, 2.1, -0.8])
    n = units(30)
    values = {"box_min": low, "box_max": high, "distance_range": 3.0, "view_steps": 32, "light_steps": 32}
    picture = ball_texture(48, low, high, center, 0.9, 3.0)
    march = technique("march_distance_texture", distance_at="distance_texture")
    result = march(P_object=center + 0.9 * n, V_object=n, L_object=-n, distance_map=picture, **values)
    close(result, 1.8, atol=0.02)


def test_the_march_ends_at_the_side_of_the_box() -> None:
    low, high = np.array([0.5, 1.0, -2.0]), np.array([2.9, 3.2, 0.4])
    p, direction = low + rng().uniform(size=(50, 3)) * (high - low), units(50)
    exits = np.maximum((low - p) / direction, (high - p) / direction).min(axis=1)
    end = technique("thickness/march_distance_texture.sss:box_exit")
    close(end(p=p, direction=direction, box_min=low, box_max=high), exits)
    close(end(p=p, direction=UP, box_min=low, box_max=high), high[1] - p[:, 1])
    close(end(p=high + 0.1, direction=UP, box_min=low, box_max=high), 0.0)


def test_march_in_a_flat_box_is_finite() -> None:
    plate = "float plate(object_position p) { return abs(p.y) - 0.0001; }"
    march = technique("march_distance_texture", distance_at=plate)
    box = {"box_min": (-1.0, 0.0, -1.0), "box_max": (1.0, 0.0, 1.0)}
    result = march(P_object=[[0.0, 1e-4, 0.0]], V_object=UP, L_object=-UP, **box)
    close(result, 2e-4, atol=5e-5)


def test_the_published_seed_2_formula() -> None:
    """Its sums; deep voxels count least, so that more matter gives a smaller value; its uvw for a box above 0."""
    march = technique("distance_field_march", distance_at="sphere:sphere_object")
    p, v, light = 0.4 * units(20), units(20)[::-1], np.roll(units(20), 3, axis=0)
    box = {"box_min": np.array([-1.0, -1.0, -1.0]), "box_max": np.array([1.0, 2.0, 3.0])}
    uvw = (p + 1.0) / (box["box_max"] - box["box_min"])
    expected = np.zeros(20)
    for i in range(8):
        for j in range(8):
            at = (uvw - v * i / 8 * 0.5 + light * j / 8 * 0.5) * [2.0, 3.0, 4.0] - 1.0
            stored = np.clip(0.5 + 0.5 * (np.linalg.norm(at, axis=1) - 0.5) / 1.2, 0.0, 1.0)
            expected += np.where(stored < 0.5, stored, 0.0) / 8
    assert expected.max() > 0.1
    values = {"radius": 0.5, "stored_range": 1.2, "march_length": 0.5, **box}
    close(march(P_object=p, V_object=v, L_object=light, **values), expected, atol=1e-12)

    depths = np.array([0.1, 0.4, 0.8])[:, None]
    ball = {"radius": 1.0, "steps": 1, "box_min": (-1.5,) * 3, "box_max": (1.5,) * 3}
    deep = march(P_object=UP * (1.0 - depths), V_object=UP, L_object=UP, **ball)
    close(deep, [0.45, 0.3, 0.1])


# Maps


def test_maps_are_read_at_the_texel() -> None:
    texels = rng().uniform(size=(4, 8, 3))
    y, x = np.divmod(np.arange(32), 8)
    uv = np.stack([(x + 0.5) / 8, (y + 0.5) / 4], axis=1)
    red = texels[..., 0].reshape(-1)
    halfway = (red + np.roll(texels[..., 0], -1, axis=1).reshape(-1)) / 2
    maps: dict[str, tuple[str, dict[str, float], float]] = {
        "thickness_map": ("thickness_texture", {"thickness_factor": 0.3}, 0.3),
        "thinness_map": ("thinness_texture", {}, 1.0),
        "transmittance_map": ("transmittance_texture", {}, 1.0),
    }
    for name, (picture, values, factor) in maps.items():
        close(technique(name)(uv=uv, **{picture: texels}, **values), factor * red)
        close(technique(name)(uv=uv + np.array([0.5 / 8, 0.0]), **{picture: texels}, **values), factor * halfway)


def test_constant_thickness() -> None:
    close(technique("constant_thickness")(), 0.1)
    close(technique("constant_thickness")(thickness_factor=0.7), 0.7)


def lights_view() -> tuple[Array, Array, Array, Array, Array]:
    """Points, a perspective matrix, a depth map, and for each point its (u, v, z) and its texel."""
    p = rng().uniform(-1.0, 1.0, (300, 3)) * [3.0, 3.0, 1.0] + [0.0, 0.0, 3.0]
    matrix = np.array([[0.6, 0.1, 0.5, 0.1], [0.0, 0.7, 0.5, -0.2], [0.1, 0.0, 1.0, 0.25], [0.0, 0.0, 1.0, 0.0]])
    clip = np.concatenate([p, np.ones((300, 1))], axis=1) @ matrix.T
    at = np.concatenate([clip[:, :2] / clip[:, 3:], clip[:, 2:3]], axis=1)
    depths = rng().uniform(2.0, 4.0, (16, 16, 1))
    x, y = np.clip((at[:, :2] * 16).astype(int), 0, 15).T
    return p, matrix, depths, at, depths[y, x, 0]


def test_thickness_from_the_lights_depth_map() -> None:
    """The thickness is 0 for points in front of the surface of the map, and outside of the map."""
    p, matrix, depths, at, entry = lights_view()
    on_map = ((at[:, :2] > 0.0) & (at[:, :2] < 1.0)).all(axis=1)
    expected = np.where(on_map, np.maximum(at[:, 2] - entry - 0.05, 0.0), 0.0)
    assert 30 < (expected > 0.0).sum() < 200 and (~on_map).sum() > 30
    values = {"light_matrix": matrix, "bias": 0.05, "light_depth_map": Texture(depths, "nearest", "clamp")}
    close(technique("depth_map_thickness")(P=p, **values), expected, atol=1e-12)


def test_each_light_has_its_view_of_the_layers() -> None:
    """Two slabs across the axes of two lights, one from afar and one at the origin; a third light has no view."""
    p = rng().uniform([-0.4, -0.4, 0.8], [0.4, 0.4, 2.8], (200, 3))
    layers = np.array([1.0, 1.5, 2.0, 2.6])
    afar = np.array([[0.25, 0.0, 0.0, 0.25], [0.0, 0.25, 0.0, 0.25], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
    near = np.array([[0.25, 0.0, 0.75, 0.0], [0.0, 0.25, 0.25, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 1.0, 0.0]])
    picture = np.broadcast_to(layers, (8, 8, 4))
    values = {"light_matrix": afar, "light_matrix_3": near, "light_layer_map": Texture(picture, "nearest", "clamp")}
    axial = np.clip(p[:, 2], 1.0, 1.5) - 1.0 + np.clip(p[:, 2], 2.0, 2.6) - 2.0
    towards = -p / np.linalg.norm(p, axis=1, keepdims=True)
    lengths = technique("light_layers_path")
    close(lengths(P=p, L=np.array([0.0, 0.0, -1.0]), **values), axial, atol=1e-12)
    close(lengths(P=p, L=towards, **values), axial / -towards[:, 2], atol=1e-12)
    for other in ([0.0, 0.0, 1.0], [0.6, 0.0, -0.8]):
        close(lengths(P=p, L=np.array(other), **values), np.full(200, 1e4))


def test_a_beam_of_light_has_the_mean_of_its_rays() -> None:
    """The rays stay in the tile of their light: the others have no layers here."""
    p = rng().uniform([-0.9, -0.9, 0.8], [0.9, 0.9, 2.8], (200, 3))
    view = np.array([[0.25, 0.0, 0.0, 0.25], [0.0, 0.25, 0.0, 0.75], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
    picture = np.full((64, 64, 4), 6e4)
    picture[32:, :32] = np.array([1.0, 1.5, 2.0, 2.6]) + rng().uniform(0.0, 0.2, (32, 32, 4))
    values = {"light_matrix_2": view, "light_layer_map": Texture(picture, "linear", "clamp")}
    along = {"L": np.array([0.0, 0.0, -1.0]), **values}
    single, beam = technique("light_layers_path"), technique("light_layers_path_soft")
    close(beam(P=p, beam_radius=0.0, **along), single(P=p, **along), atol=1e-9)
    expected = np.zeros(len(p))
    for across in beam_places(0.1):
        moved = p.copy()
        moved[:, :2] = np.clip(p[:, :2] + across, -1.0 + 0.008, 1.0 - 0.008)
        expected += single(P=moved, **along) / 8.0
    close(beam(P=p, beam_radius=0.1, **along), expected, atol=1e-5)
    assert expected.min() == 0.0 and expected.max() > 1.0
    close(beam(P=p, L=np.array([0.0, 0.0, 1.0]), beam_radius=0.1, **values), np.full(200, 1e4))


def beam_places(radius: float) -> Array:
    """The places of a beam's eight rays across its axis, (8, 2)."""
    turn = np.arange(8) * np.pi * (3.0 - np.sqrt(5.0))
    return radius * np.sqrt((np.arange(8) + 0.5) / 8.0)[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)


def test_a_beam_of_the_eye_counts_what_is_behind_the_surface() -> None:
    """A picture of 40 × 20: a step from a thin to a thick part, and a part that is nearer than the surface."""
    depth = np.zeros((20, 40, 1))
    depth[:, 10:20], depth[:, 20:30], depth[:, 30:35] = 2.5, 3.5, 1.5
    place = np.stack([(np.arange(40) + 0.5) / 40.0, np.full(40, 0.525)], axis=1)
    values = {"back_face_map": Texture(depth, "nearest", "clamp"), "eye_distance": 2.0}
    beam = technique("back_face_thickness_soft")
    total, weight = technique("back_face_thickness")(screen_uv=place, **values), np.ones(40)
    for across in beam_places(0.2 / 2.0):
        moved = np.clip(place + across * [0.68, 1.2], 0.0, 0.999)
        inside = np.maximum(depth[(moved[:, 1] * 20).astype(int), (moved[:, 0] * 40).astype(int), 0] - 2.0, 0.0)
        share = np.minimum(inside / 0.2, 1.0)
        total, weight = total + share * inside, weight + share
    lengths = beam(screen_uv=place, beam_radius=0.2, **values)
    close(lengths, total / weight, atol=1e-5)
    assert (lengths[12:18] == 0.5).any() and ((lengths > 0.6) & (lengths < 1.4)).sum() > 2 and lengths[36:].max() == 0.0


def test_the_published_depth_map_absorption() -> None:
    """The result has no upper bound; it may be greater than 1."""
    p, matrix, depths, _, entry = lights_view()
    view = np.array([[0.0, 1.0, 0.0, 0.5], [-1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.25], [0.0, 0.0, 0.0, 1.0]])
    distance = np.linalg.norm(p @ view[:3, :3].T + view[:3, 3], axis=1)
    picture = Texture(depths, "nearest", "clamp")
    values = {"light_view": view, "light_texture": matrix, "sigma_t": 1.5, "light_depth_map": picture}
    result = technique("depth_map_absorption")(P=p, **values)
    close(result, np.exp(-1.5 * (distance - entry)))
    assert result.max() > 1.0


# Conversions

TENTHS = np.linspace(0.0, 1.0, 11)
CONVERSIONS: list[tuple[str, dict[str, float], Any, Any]] = [
    ("beer_lambert", {"attenuation_distance": 0.4}, TENTHS, np.exp(-TENTHS / 0.4)),
    ("beer_lambert", {"attenuation_distance": 0.0}, [-1.0, 0.0, 1e-3, 5.0], [1.0, 1.0, 0.0, 0.0]),
    ("beer_lambert", {"attenuation_distance": 1e-3}, [0.0, 0.05, 0.079, 0.5], np.exp([0.0, -50.0, -79.0, -80.0])),
    ("thickness_from_transmittance", {"attenuation_distance": 0.4}, TENTHS[1:], -0.4 * np.log(TENTHS[1:])),
    ("thickness_from_transmittance", {"attenuation_distance": 0.4}, [-1.0, 0.0, 2.0], [2.4858432, 2.4858432, 0.0]),
    ("thinness_from_thickness", {"opaque_thickness": 0.5}, [-1.0, 0.0, 0.2, 0.5, 9.0], [1.0, 1.0, 0.6, 0.0, 0.0]),
    ("thickness_from_thinness", {"opaque_thickness": 0.5}, [0.0, 0.6, 1.0], [0.5, 0.2, 0.0]),
    ("slab_from_thinness", {"reach": 0.5}, [0.0, 0.25, 1.0], [1.0, 0.5, 0.0]),
    ("transmittance_from_thinness", {}, TENTHS, TENTHS),
    ("thinness_from_transmittance", {}, TENTHS, TENTHS),
]


@pytest.mark.parametrize("case", CONVERSIONS, ids=lambda case: case[0])
def test_conversions(case: tuple[str, dict[str, float], Any, Any]) -> None:
    name, values, inputs, expected = case
    close(convert(name, inputs, **values), expected, rtol=1e-6, atol=1e-30)


def convert(name: str, inputs: Any, **values: float) -> Array:
    """The result of a conversion, whose only parameter has its own name in each technique."""
    function = technique(name)
    result: Array = function(**{next(iter(function.types)): inputs}, **values)
    return result


@pytest.mark.parametrize(
    ("forward", "backward"),
    [
        ("beer_lambert", "thickness_from_transmittance"),
        ("thickness_from_transmittance", "beer_lambert"),
        ("thinness_from_thickness", "thickness_from_thinness"),
        ("thickness_from_thinness", "thinness_from_thickness"),
        ("transmittance_from_thinness", "thinness_from_transmittance"),
    ],
)
def test_conversions_invert_each_other(forward: str, backward: str) -> None:
    values = np.linspace(0.01, 0.99, 21)
    close(convert(backward, convert(forward, values)), values, atol=1e-12)


def test_slab_from_thinness() -> None:
    """The error is at most 7 % of the reach with 29 taps, as its notes state, and decreases with more taps."""
    inputs = np.linspace(0.0, 0.8, 1001)
    half = np.stack([0 * inputs, inputs / 2, 0 * inputs], axis=1)
    read = technique("thinness_uniform", body_distance="box")
    errors = []
    for taps in (29, 64):
        th = read(P=ORIGIN, N=UP, taps=taps, center=-half, half_size=half + np.array([50.0, 0.0, 50.0]))
        errors.append(np.abs(convert("slab_from_thinness", th, reach=0.4) - inputs).max() / 0.4)
    assert errors[1] < errors[0] < 0.07
    assert errors[0] > 0.06  # the figure of the notes is not too large
