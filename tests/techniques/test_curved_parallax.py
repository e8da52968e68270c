"""Parallax below curved surfaces: exact rays in balls, hollows and cylinders, bounds, and the limit of a plane."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from oracle import Array, close, rng, technique, unit, units

X, Y, Z = np.eye(3)
CURVED = ("parallax_curved", "parallax_curved_map", "parallax_curved_orthonormal")
FLAT = {"uv": (0.0, 0.0), "uv_per_unit": (1.0, 1.0)}
FRAME = {"T": X, "B": Y, "N": Z}
IOR = 1.4
UNBENT = {"parallax_refracted": "ior", "parallax_curved": "ior", "parallax_curved_map": "ior"}
"""Techniques and their parameter for the index; those that are not here call it relative_ior and take no normal"""


def views(count: int = 200) -> Array:
    """Directions to the eye in front of the surface, at most 75° from the normal."""
    v = units(4 * count)
    facing: Array = v[v[:, 2] > np.cos(np.radians(75.0))][:count]
    return facing


def offsets(name: str, v: Array, depth: float, curvature: Any = (0.0, 0.0), **values: Any) -> Array:
    """The offset in world units, (n, 2)."""
    frame = {**FRAME, **values} if name in UNBENT else {key: FRAME[key] for key in "TB"}
    if name == "parallax_curved_map":
        widest = max(float(np.abs(curvature).max()), 1.0)
        texel = 0.5 + 0.5 * np.array([*curvature, 0.0]) / widest
        frame |= {"curvature_texture": texel.reshape(1, 1, 3), "curvature_range": widest}
    elif name in CURVED:
        frame["curvature"] = curvature
    result: Array = technique(name)(V=v, depth=depth, **{UNBENT.get(name, "relative_ior"): IOR}, **frame, **FLAT)
    return result


def refracted(v: Array) -> Array:
    """Snell's law at the plane with the normal Z."""
    across = -v[:, :2] / IOR
    return np.concatenate([across, -np.sqrt(1.0 - (across**2).sum(axis=1, keepdims=True))], axis=1)


def below_a_ball(v: Array, depth: float, radius: float) -> Array:
    """The exact offset; a negative radius is a spherical hollow, whose layer lies outside of it."""
    ray = refracted(v)
    start, layer = np.array([0.0, 0.0, radius]), radius - depth
    along = ray @ start
    half = np.sqrt(along**2 - radius**2 + layer**2)
    at = start + ray * np.where(radius > 0.0, -along - half, -along + half)[:, None]
    angle = np.arctan2(np.hypot(at[:, 0], at[:, 1]), np.sign(radius) * at[:, 2])
    way: Array = unit(at[:, :2]) * (abs(radius) * angle)[:, None]
    return way


def below_a_cylinder(v: Array, depth: float, radius: float) -> Array:
    """The exact offset; the axis is parallel to Y."""
    ray = refracted(v)
    a, b = (ray[:, [0, 2]] ** 2).sum(axis=1), ray[:, 2] * radius
    t = (-b - np.sqrt(b**2 - a * (radius**2 - (radius - depth) ** 2))) / a
    around = radius * np.arctan2(ray[:, 0] * t, radius + ray[:, 2] * t)
    return np.stack([around, ray[:, 1] * t], axis=1)


def error(result: Array, exact: Array) -> float:
    return float(np.sqrt(((result - exact) ** 2).mean() / (exact**2).mean()))


@pytest.mark.parametrize("name", CURVED)
def test_below_a_ball_the_error_is_a_tenth_of_that_of_a_plane(name: str) -> None:
    v, radius, depth = views(), 0.7, 0.07
    exact = below_a_ball(v, depth, radius)
    flat = error(offsets("parallax_refracted", v, depth), exact)
    assert error(offsets(name, v, depth, (1.0 / radius,) * 2), exact) < 0.1 * flat
    assert flat > 0.08


@pytest.mark.parametrize("name", CURVED)
def test_below_a_hollow_the_error_is_a_tenth_of_that_of_a_plane(name: str) -> None:
    v, radius, depth = views(), -0.7, 0.07
    exact = below_a_ball(v, depth, radius)
    flat = error(offsets("parallax_refracted", v, depth), exact)
    assert error(offsets(name, v, depth, (1.0 / radius,) * 2), exact) < 0.1 * flat
    assert flat > 0.08


@pytest.mark.parametrize("name", CURVED)
def test_below_a_cylinder_each_axis_has_its_own_curvature(name: str) -> None:
    v, radius, depth = views(), 0.7, 0.07
    exact = below_a_cylinder(v, depth, radius)
    flat = error(offsets("parallax_refracted", v, depth), exact)
    own = error(offsets(name, v, depth, (1.0 / radius, 0.0)), exact)
    assert own < 0.1 * flat
    assert error(offsets(name, v, depth, (0.0, 1.0 / radius)), exact) > flat  # the axes are not interchangeable


@pytest.mark.parametrize("name", CURVED)
def test_the_error_is_of_the_second_order_in_depth(name: str) -> None:
    """Half the depth has a quarter of the relative error."""
    v = views()
    coarse, fine = (error(offsets(name, v, d, (1.0, 1.0)), below_a_ball(v, d, 1.0)) for d in (0.08, 0.04))
    assert 3.5 < coarse / fine < 5.0


@pytest.mark.parametrize("name", CURVED)
def test_without_curvature_it_is_the_plane(name: str) -> None:
    close(offsets(name, views(), 0.3), offsets("parallax_refracted", views(), 0.3), atol=1e-12)


@pytest.mark.parametrize("name", ["parallax_curved", "parallax_curved_map"])
def test_from_behind_a_ball_is_a_hollow(name: str) -> None:
    v = views() * (1.0, 1.0, -1.0)
    turned = views()
    expected = offsets(name, turned, 0.07, (-1.4, -1.4))
    close(offsets(name, v, 0.07, (1.4, 1.4)), expected, atol=1e-12)


@pytest.mark.parametrize("name", CURVED)
def test_any_curvature_gives_at_most_four_times_the_offset_of_a_plane(name: str) -> None:
    flat = np.abs(offsets("parallax_refracted", views(), 0.1))
    for curvature in rng().uniform(-1000.0, 1000.0, (20, 2)):
        bent = np.abs(offsets(name, views(), 0.1, tuple(curvature)))
        assert np.isfinite(bent).all() and (bent <= 4.0 * flat * (1.0 + 1e-9) + 1e-12).all()


def test_sheared_and_mirrored_frames_of_a_plane() -> None:
    skewed = {"T": unit(np.array([1.0, 0.2, 0.0])), "B": unit(np.array([0.3, -1.0, 0.0])), "N": Z}
    flat = technique("parallax_refracted")(V=views(), depth=0.2, ior=IOR, **skewed, **FLAT)
    close(technique("parallax_curved")(V=views(), depth=0.2, ior=IOR, **skewed, **FLAT), flat, atol=1e-12)
