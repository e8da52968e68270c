"""Distance functions, cameras and marches, compared with closed forms."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from oracle import UP, Array, close, rng, technique, unit, units
from sssgen.targets.runtime.numpy_textures import Texture

P = rng().uniform(-1.5, 1.5, (400, 3))
CENTER, HALF, START, END = np.array([[0.1, -0.2, 0.3], [0.7, 0.4, 0.5], [-0.6, 0.2, 0.1], [0.5, 0.9, -0.4]])


def box_distance(p: Array, half: Array) -> Array:
    """The distance to a box: outside to its nearest point, inside to the nearest face."""
    nearest = np.clip(p, -half, half)
    faces = np.minimum(half - p, half + p).min(axis=-1)
    result: Array = np.where((nearest == p).all(axis=-1), -faces, np.linalg.norm(p - nearest, axis=-1))
    return result


def cubes_distance(p: Array) -> Array:
    """The distance to two unit cubes that are turned by 45 degrees about y."""
    results = []
    for x in (0.0, 1.45):
        q = p - [x, 0.48, 0.0]
        x_axis, z_axis = np.array([1.0, 0.0, -1.0]) / np.sqrt(2.0), np.array([1.0, 0.0, 1.0]) / np.sqrt(2.0)
        results.append(box_distance(np.stack([q @ x_axis, q[:, 1], q @ z_axis], axis=1), np.full(3, 0.5)))
    return np.minimum(*results)


def points_distance(p: Array, points: Array) -> Array:
    """The distance to the nearest of many points."""
    result: Array = np.sqrt(((p[:, None] - points[None]) ** 2).sum(axis=2).min(axis=1))
    return result


def ring(radius: float) -> Array:
    a = np.linspace(0.0, 2.0 * np.pi, 3000)
    return np.stack([radius * np.cos(a), 0 * a, radius * np.sin(a)], axis=1)


SHAPES: dict[str, tuple[dict[str, Any], Callable[[], Array], float]] = {
    "sphere": ({"center": CENTER, "radius": 0.6}, lambda: np.linalg.norm(P - CENTER, axis=1) - 0.6, 1e-12),
    "box": ({"center": CENTER, "half_size": HALF}, lambda: box_distance(P - CENTER, HALF), 1e-12),
    "torus": (
        {"center": CENTER, "ring_radius": 0.8, "tube_radius": 0.2},
        lambda: points_distance(P, CENTER + ring(0.8)) - 0.2,
        1e-4,
    ),
    "capsule": (
        {"start": START, "end": END, "radius": 0.3},
        lambda: points_distance(P, START + np.linspace(0.0, 1.0, 2000)[:, None] * (END - START)) - 0.3,
        1e-4,
    ),
    "ground_plane": ({}, lambda: P[:, 1], 1e-12),
    "jelly_cubes": ({}, lambda: cubes_distance(P), 1e-7),
    "jelly_scene": ({}, lambda: np.minimum(cubes_distance(P), P[:, 1]), 1e-7),
}


@pytest.mark.parametrize("name", SHAPES)
def test_shapes(name: str) -> None:
    """The distance equals the closed form; its Lipschitz constant is mostly near 1 and at most 1, as marching needs."""
    values, expected, tolerance = SHAPES[name]
    distance = technique(name)
    close(distance(p=P, **values), expected(), atol=tolerance)
    q = P[::-1]
    forward, backward = distance(p=P, **values), distance(p=q, **values)
    assert (np.abs(forward - backward) <= np.linalg.norm(P - q, axis=1) * (1.0 + 1e-7)).all()
    e = 1e-6
    slopes = [(distance(p=P + e * axis, **values) - distance(p=P - e * axis, **values)) / (2 * e) for axis in np.eye(3)]
    assert (np.abs(np.linalg.norm(slopes, axis=0) - 1.0) < 1e-6).mean() > 0.98


@pytest.mark.parametrize("name", ["sphere", "box", "torus", "capsule"])
def test_shapes_in_object_space_have_the_same_distance(name: str) -> None:
    values, expected, tolerance = SHAPES[name]
    close(technique(f"distance/{name}.sss:{name}_object")(p=P, **values), expected(), atol=tolerance)


# Distances from a texture

LOW, HIGH, RANGE = np.array([0.5, 1.0, -2.0]), np.array([2.9, 3.2, 0.4]), 3.0
MIDDLE = (LOW + HIGH) / 2


def baked(distance: Callable[[Array], Array], size: int = 32) -> Texture:
    """A texture [z, y, x, channel] of a field over a box, sampled at the centres of the texels."""
    steps = (np.arange(size) + 0.5) / size
    z, y, x = np.meshgrid(*[LOW[i] + steps * (HIGH[i] - LOW[i]) for i in (2, 1, 0)], indexing="ij")
    field = distance(np.stack([x, y, z], axis=-1))
    return Texture((0.5 + field / (2.0 * RANGE))[..., None], wrap="clamp")


BOX = {"box_min": LOW, "box_max": HIGH, "distance_range": RANGE}


def test_distance_texture() -> None:
    """The texture is exact for a plane, and within about a texel for a ball; outside the box it is clamped."""
    normal = unit([1.0, 2.0, -0.5])
    inside = MIDDLE + rng().uniform(-0.45, 0.45, (200, 3)) * (HIGH - LOW)
    read = technique("distance_texture")
    plane = baked(lambda p: (p - MIDDLE) @ normal)
    close(read(p=inside, distance_map=plane, **BOX), (inside - MIDDLE) @ normal, atol=1e-12)
    ball = baked(lambda p: np.linalg.norm(p - MIDDLE, axis=-1) - 0.8)
    close(read(p=inside, distance_map=ball, **BOX), np.linalg.norm(inside - MIDDLE, axis=1) - 0.8, atol=0.03)
    far = MIDDLE + units(50) * 9.0
    close(read(p=far, distance_map=ball, **BOX), read(p=np.clip(far, LOW, HIGH), distance_map=ball, **BOX))


def test_a_flat_box_is_padded() -> None:
    flat = {"box_min": (-1.0, 0.2, -1.0), "box_max": (1.0, 0.2, 1.0), "distance_range": 1.0}
    # its thickness is 1/1000 of the diagonal: a step of that size crosses the whole texture
    picture = np.linspace(0.0, 1.0, 64)[None, :, None, None] * np.ones((4, 64, 4, 1))
    thickness = 0.001 * np.sqrt(8.0)
    p = np.array([[0.0, 0.2 + part * thickness, 0.0] for part in (-0.25, 0.0, 0.25, 300.0)])
    result = technique("distance_texture")(p=p, distance_map=Texture(picture, wrap="clamp"), **flat)
    close(result, [-0.5, 0.0, 0.5, 1.0], atol=0.02)


def test_distance_texture_in_world_space() -> None:
    """In world space: inside as in object space, outside between 0 and the true distance, never a too large step."""
    turn = np.linalg.qr(rng().normal(size=(3, 3)))[0]
    scale = 1.7
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn / scale, MIDDLE - turn @ np.array([3.0, -1.0, 0.5]) / scale

    def to_world(p: Array) -> Array:
        results: Array = (p - matrix[:3, 3]) @ np.linalg.inv(matrix[:3, :3]).T
        return results

    values = {"distance_map": baked(lambda p: np.linalg.norm(p - MIDDLE, axis=-1) - 0.8), **BOX}
    read = technique("distance_texture_world")
    inside = MIDDLE + rng().uniform(-0.5, 0.5, (100, 3)) * (HIGH - LOW)
    world = {"world_to_object": matrix, "object_scale": scale, **values}
    close(read(p=to_world(inside), **world), scale * technique("distance_texture")(p=inside, **values), atol=1e-9)
    outside = MIDDLE + units(200) * rng().uniform(2.2, 6.0, (200, 1))
    true = scale * (np.linalg.norm(outside - MIDDLE, axis=1) - 0.8)
    result = read(p=to_world(outside), **world)
    assert (result <= true + 0.05).all() and (result > 0.5 * true).all()
    # the bound: the length of (distance to the box, stored distance at the nearest point of the box)
    nearest = np.clip(outside, LOW, HIGH)
    moved = technique("distance_texture")(p=nearest, **values)
    close(result, scale * np.hypot(np.linalg.norm(outside - nearest, axis=1), moved), atol=1e-9)


# Cameras


def test_camera_still() -> None:
    """Each ray passes through the point of its uv on the plane at the focal length; the middle ray hits the target."""
    eye, target = np.array([1.0, 2.0, 3.0]), np.array([0.2, 0.1, -0.4])
    values = {"eye": eye, "look_at": target, "focal_length": 1.5, "aspect": 1.6}
    uv = rng().uniform(size=(60, 2))
    origin, ray = technique("camera_still")(uv=uv, **values)
    close(origin, np.broadcast_to(eye, (60, 3)))
    close(np.linalg.norm(ray, axis=1), 1.0)
    front = unit(target - eye)
    right = unit(np.cross(front, UP))
    up = np.cross(right, front)
    assert up[1] > 0.0
    close(1.5 * (ray @ right) / (ray @ front), 1.6 * (2.0 * uv[:, 0] - 1.0), atol=1e-12)
    close(1.5 * (ray @ up) / (ray @ front), 2.0 * uv[:, 1] - 1.0, atol=1e-12)
    assert (ray @ front > 0.0).all()
    close(technique("camera_still")(uv=(0.5, 0.5), **values)[1], front)


def test_camera_orbit() -> None:
    time = np.array([0.0, np.pi / 2, 4.0])
    uv = rng().uniform(size=(3, 2))
    origin, ray = technique("camera_orbit")(uv=uv, time=time, orbit_radius=2.0, orbit_height=1.2)
    close(origin, np.stack([2.0 * np.cos(time), np.full(3, 1.2), 2.0 * np.sin(time)], axis=1), atol=1e-15)
    close(ray, [technique("camera_still")(uv=point, eye=eye)[1] for point, eye in zip(uv, origin, strict=True)])


# Marches


def ray_to_sphere(o: Array, d: Array) -> Array:
    """The distance along a ray to the unit sphere; NaN if it misses."""
    b, c = (o * d).sum(axis=1), (o * o).sum(axis=1) - 1.0
    with np.errstate(invalid="ignore"):
        result: Array = -b - np.sqrt(b * b - c)
    return np.where(result > 0.0, result, np.nan)


def ray_to_box(o: Array, d: Array) -> Array:
    """The distance along a ray to a box of half size 1/2, by slabs; NaN if it misses."""
    near, far = np.sort([(-0.5 - o) / d, (0.5 - o) / d], axis=0)
    first, last = near.max(axis=1), far.min(axis=1)
    result: Array = np.where((first < last) & (first > 0.0), first, np.nan)
    return result


def box_normal(p: Array) -> Array:
    axis = np.abs(p).argmax(axis=1)
    result: Array = np.eye(3)[axis] * np.sign(p)
    return result


@pytest.mark.parametrize("march", ["raymarch", "cheap_sss_raymarch"])
@pytest.mark.parametrize("shape", ["sphere", "box"])
def test_marches_hit_the_analytic_intersection(march: str, shape: str) -> None:
    origin = 3.0 * units(500, 1)
    ray = unit(1.1 * units(500, 2) - origin)
    solve = ray_to_sphere if shape == "sphere" else ray_to_box
    t = solve(origin, ray)
    hit, p, n, v = technique(march, scene_distance=shape)(ray_origin=origin, ray_direction=ray)
    # the march may stop within its tolerance of the surface
    meets = np.isfinite(t)
    assert 100 < meets.sum() < 400
    if shape == "sphere":
        passing = np.linalg.norm(np.cross(origin, ray), axis=1)
        assert (hit == meets)[np.abs(passing - 1.0) > 2e-3].all()
    assert (hit == meets).mean() > 0.99
    both = hit & meets
    exact = origin[both] + t[both, None] * ray[both]
    slant = np.abs((ray[both] * (exact if shape == "sphere" else box_normal(exact))).sum(axis=1))
    steep = slant > 0.2
    close(p[both][steep], exact[steep], atol=6e-3)
    assert np.percentile(np.linalg.norm(p[both] - exact, axis=1), 50) < 1.2e-3
    normal = exact if shape == "sphere" else box_normal(exact)
    flat = np.sort(np.abs(exact), axis=1)[:, 1] < 0.49 if shape == "box" else np.full(len(exact), True)
    close(n[both][steep & flat], normal[steep & flat], atol=6e-3)
    close(v, -ray)


def test_raymarch_stops_at_its_maximum_distance() -> None:
    values = {"ray_origin": [0.0, 5.0, 0.0], "ray_direction": -UP}
    march = technique("raymarch", scene_distance="ground_plane")
    assert march(max_distance=6.0, **values)[0]
    assert not march(max_distance=4.0, **values)[0]
    on_it = march(ray_origin=[0.0, 0.0, 0.0], ray_direction=-UP)
    assert on_it[0] and not on_it[1].any()
    upwards = technique("cheap_sss_raymarch", scene_distance="ground_plane")(
        ray_origin=[0.0, 5.0, 0.0], ray_direction=UP
    )
    away = march(ray_origin=[0.0, 5.0, 0.0], ray_direction=UP, max_distance=50.0)
    assert not upwards[0] and not away[0]
    assert away[1][1] < 200.0 < 1e9 < upwards[1][1]  # the published march has no far limit


def test_raymarch_ground_meets_the_body_or_the_ground() -> None:
    origin = 4.0 * units(500, 3)
    origin[:, 1] = 0.1 + np.abs(origin[:, 1])
    ray = unit(1.6 * units(500, 4) - origin)
    hit, p, n, v = technique("raymarch_ground", scene_distance="sphere")(
        ray_origin=origin, ray_direction=ray, max_distance=20.0
    )
    to_ball, down = ray_to_sphere(origin, ray), ray[:, 1] < 0.0
    to_ground = np.where(down, origin[:, 1] / np.where(down, -ray[:, 1], 1.0), np.inf)
    ball = np.nan_to_num(to_ball, nan=np.inf) < to_ground
    sure = np.abs(np.linalg.norm(np.cross(origin, ray), axis=1) - 1.0) > 5e-3
    ground = sure & ~ball & (to_ground < 20.0)
    above = sure & ball
    assert min(above.sum(), ground.sum(), (sure & ~ball & ~ground).sum()) > 40
    assert (hit == (ball | (to_ground < 20.0)))[sure].all()
    close(p[ground], origin[ground] + to_ground[ground, None] * ray[ground], atol=1e-9)
    close(n[ground], np.broadcast_to(UP, (int(ground.sum()), 3)))
    steep = above & (np.einsum("nc,nc->n", ray, p) < -0.2)
    close(p[steep], origin[steep] + to_ball[steep, None] * ray[steep], atol=6e-3)
    close(n[steep], p[steep], atol=6e-3)
    close(v, -ray)


def test_normals_of_the_march_are_central_and_those_of_seed_0_one_sided() -> None:
    """On the paraboloid y = x^2, one-sided differences tilt the normal by half the step times the curvature."""
    bowl = "float bowl(world_position p) { return 0.5 * (p.y - p.x * p.x); }"
    x = np.array([0.0, 0.3])
    values = {"ray_origin": np.stack([x, x**2, 0 * x], axis=1), "ray_direction": UP}
    ours = technique("raymarch", scene_distance=bowl)(**values)[2]
    theirs = technique("cheap_sss_raymarch", scene_distance=bowl)(**values)[2]
    slopes = -2.0 * x
    close(ours[:, 0] / ours[:, 1], slopes, atol=1e-6)
    close(theirs[:, 0] / theirs[:, 1], slopes + 0.001, atol=1e-6)
