"""The apparent place of an inlay: closed form on the plane, two-dimensional construction on the ball, transforms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from sssgen.lab.reference.inlay_refraction import plane_offset, refract, visible_inlay
from sssgen.scene.camera import Camera
from sssgen.scene.geometry import Ball, Box, Geometry, Slab
from sssgen.scene.measured.measured_scene import Inlay, MeasuredScene
from sssgen.scene.measured.view_points import points

ANGLES = np.radians([15.0, 30.0, 45.0, 60.0, 75.0, 85.0])
PUBLISHED = {
    1.5: [0.17517, 0.35355, 0.53452, 0.70711, 0.84169, 0.88833],
    1.33: [0.19839, 0.40570, 0.62773, 0.85796, 1.05650, 1.13051],
}
"""offset / depth at these angles"""


def looking_at(shape: Geometry, eye: tuple[float, float, float], inlay: Inlay, view: float = 24.0) -> MeasuredScene:
    camera = Camera(eye, shape.position, view)
    return MeasuredScene("one", "One", shape, camera, (), None, inlay, (24, 24))


@pytest.mark.parametrize("n", PUBLISHED)
def test_the_planes_offsets_are_the_published_ones(n: float) -> None:
    assert plane_offset(np.sin(ANGLES), 1.0, n) == pytest.approx(PUBLISHED[n], abs=6e-6)
    assert plane_offset(np.sin(ANGLES), 0.3, n) == pytest.approx(0.3 * np.array(PUBLISHED[n]), abs=2e-6)


@pytest.mark.parametrize("n", [1.0, 1.33, 1.5, 2.4])
def test_refracted_rays_keep_snells_law(n: float) -> None:
    generator = np.random.default_rng(5)
    V, N = (vectors / np.linalg.norm(vectors, axis=0) for vectors in generator.normal(size=(2, 3, 200)))
    N = N * np.sign((N * V).sum(axis=0))
    inside = refract(V, N, 1.0 / n)
    assert np.linalg.norm(inside, axis=0) == pytest.approx(np.ones(200))
    assert ((inside * N).sum(axis=0) < 0.0).all()
    # n sin θ' = sin θ with its direction: the tangential component is unchanged
    assert n * np.cross(inside.T, N.T) == pytest.approx(-np.cross(V.T, N.T), abs=1e-12)


def test_past_the_critical_angle_no_ray_is_refracted() -> None:
    angle = np.radians([40.0, 41.7, 41.9, 80.0])  # asin(1 / 1.5) = 41.81°
    V = np.stack([np.sin(angle), np.zeros(4), np.cos(angle)])
    length = np.linalg.norm(refract(V, np.tile([[0.0], [0.0], [1.0]], 4), 1.5), axis=0)
    assert length == pytest.approx([1.0, 1.0, 0.0, 0.0])


@pytest.mark.parametrize("placed", [False, True])
@pytest.mark.parametrize("n", [1.0, 1.33, 1.5])
def test_on_a_plane_it_is_the_closed_form(n: float, placed: bool) -> None:
    plate = Slab(60.0, 60.0, 3.0, position=(0.0, 0.0, -1.5))
    if placed:
        plate = replace(plate, rotation=(20.0, -30.0, 50.0), scale=1.6, position=(0.2, 0.1, -0.4))
    normal = plate.to_world()[:3, 2] / plate.scale
    eye = np.array(plate.position) + 3.0 * plate.scale * normal + plate.to_world()[:3, 0] * 4.0
    inlay = Inlay(0.2, 1.2 * n, 1.2)  # only the ratio of the two indices counts
    camera = looking_at(plate, tuple(map(float, eye)), inlay, 40.0)
    surface = points(camera)
    result = visible_inlay(camera, surface)
    N, V = surface.inputs["N"], surface.inputs["V"]
    top = N.T @ normal > 0.999
    assert top.sum() > 300
    assert result.hit[top].all()
    cosine = (N * V).sum(axis=0)
    sine = np.sqrt(1.0 - cosine**2)
    assert np.ptp(sine[top]) > 0.1
    length = np.linalg.norm(result.offset, axis=0)
    assert length[top] == pytest.approx(plane_offset(sine[top], 0.2, n), abs=1e-8)
    # away from the eye: against V along the surface
    away = (N * cosine - V) / sine
    along = np.stack([(away * surface.inputs["T"]).sum(axis=0), (away * surface.inputs["B"]).sum(axis=0)])
    assert result.offset[:, top] == pytest.approx((along * length)[:, top], abs=1e-8)


def arc_on_a_ball(sine: np.ndarray, radius: float, depth: float, n: float) -> np.ndarray:
    """The arc on a ball from the point that a ray hits to the point above its hit on the layer.

    The point is (R, 0), and the ray continues at the angle θ' to the normal: the line R − t cos θ', t sin θ' meets the
    circle of radius R − depth. NaN if it misses the circle.
    """
    inner = radius - depth
    below = np.arcsin(sine / n)
    half = radius * np.cos(below)
    with np.errstate(invalid="ignore"):
        t = half - np.sqrt(half**2 - radius**2 + inner**2)
    return radius * np.arctan2(t * np.sin(below), radius - t * np.cos(below))


@pytest.mark.parametrize(("depth", "n"), [(0.06, 1.5), (0.15, 1.33), (0.4, 1.1), (0.3, 1.0)])
@pytest.mark.parametrize("scale", [1.0, 2.5])
def test_on_a_ball_it_is_the_construction_in_two_dimensions(depth: float, n: float, scale: float) -> None:
    ball = Ball(0.6, position=(0.3, -0.2, 0.1), rotation=(10.0, 50.0, 20.0), scale=scale)
    camera = looking_at(ball, (0.6, 1.0 * scale, 4.0 * scale), Inlay(depth * scale, n))
    surface = points(camera)
    result = visible_inlay(camera, surface)
    cosine = (surface.inputs["N"] * surface.inputs["V"]).sum(axis=0)
    expected = arc_on_a_ball(np.sqrt(np.maximum(1.0 - cosine**2, 0.0)), 0.6 * scale, depth * scale, n)
    assert (result.hit == np.isfinite(expected)).all()
    assert result.hit.sum() > 25
    length = np.linalg.norm(result.offset, axis=0)
    assert length[result.hit] == pytest.approx(expected[result.hit], rel=1e-5, abs=1e-6)
    assert np.isfinite(result.offset).all()
    # the offset is away from the eye: along the frame, against V
    towards = np.stack([(surface.inputs["V"] * surface.inputs[name]).sum(axis=0) for name in ("T", "B")])
    cosines = (result.offset * towards).sum(axis=0) / np.maximum(length * np.linalg.norm(towards, axis=0), 1e-12)
    assert cosines[result.hit & (length > 1e-3)] == pytest.approx(-1.0, abs=1e-6)


def test_a_ray_may_pass_the_layer_at_a_curved_edge() -> None:
    # without refraction and with a deep layer: a ray that misses the inner circle sees nothing
    camera = looking_at(Ball(0.6), (0.0, 0.0, 4.0), Inlay(0.3, 1.0))
    surface = points(camera)
    aside = np.linalg.norm(
        np.cross(surface.inputs["P"].T, surface.inputs["V"].T), axis=1
    )  # the ray's distance to the centre
    assert (visible_inlay(camera, surface).hit == (aside < 0.3)).all()
    assert (aside > 0.3).any()


def test_seen_from_above_nothing_moves() -> None:
    camera = looking_at(Box(size=(1.0, 1.0, 1.0)), (0.0, 0.0, 300.0), Inlay(0.1, 1.5), 0.15)
    surface = points(camera)
    assert surface.count > 100
    assert np.abs(visible_inlay(camera, surface).offset).max() < 2e-4
