"""Normal curvatures: closed forms on balls and rings, in world space."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

from sssgen.lab.measure.scene_inputs import principal_curvatures
from sssgen.lab.reference.curvature import normal_curvature
from sssgen.scene.camera import Camera
from sssgen.scene.geometry import Ball, Box, Geometry, Torus
from sssgen.scene.measured.measured_scene import Inlay, MeasuredScene
from sssgen.scene.measured.view_points import points


def seen(shape: Geometry) -> MeasuredScene:
    eye = (shape.position[0] + 0.4, shape.position[1] + 0.9, shape.position[2] + 4.0)
    return MeasuredScene("one", "One", shape, Camera(eye, shape.position, 30.0), (), None, Inlay(0.02), (16, 16))


@pytest.mark.parametrize("scale", [1.0, 2.5])
def test_a_balls_curvature_is_one_over_its_radius(scale: float) -> None:
    scene = seen(Ball(0.4, position=(0.2, -0.1, 0.3), rotation=(10.0, 40.0, 0.0), scale=scale))
    visible = points(scene)
    for axis in ("T", "B"):
        result = normal_curvature(scene.geometry, visible.inputs["P"], visible.inputs[axis], 1e-3 * scale)
        assert result == pytest.approx(np.full(visible.count, 1.0 / (0.4 * scale)), rel=1e-4)


def test_a_rings_curvatures_are_those_of_its_tube_and_of_its_axis() -> None:
    scene = seen(Torus(0.5, 0.2, rotation=(50.0, 0.0, 20.0)))
    visible = points(scene)
    P, N = visible.inputs["P_object"], visible.inputs["N_object"]
    around = np.stack([P[2], 0.0 * P[0], -P[0]]) / np.hypot(P[0], P[2])  # along the ring
    across = np.cross(N.T, around.T).T
    rotation = scene.geometry.to_world()[:3, :3]
    world = visible.inputs["P"]
    tube = normal_curvature(scene.geometry, world, rotation @ across, 1e-3)
    along = normal_curvature(scene.geometry, world, rotation @ around, 1e-3)
    assert tube == pytest.approx(np.full(visible.count, 5.0), rel=1e-4)
    # Meusnier: the ring's own curvature times the cosine between its plane's normal and the surface's
    from_axis = np.hypot(P[0], P[2])
    assert along == pytest.approx((N[0] * P[0] + N[2] * P[2]) / from_axis**2, abs=1e-3)


def test_flat_sides_have_no_curvature() -> None:
    scene = seen(Box((1.0, 1.0, 1.0)))
    visible = points(scene)
    inner = np.sort(np.abs(visible.inputs["P_object"]), axis=0)[1] < 0.45
    assert inner.sum() > 30
    assert principal_curvatures(scene)[:, inner] == pytest.approx(np.zeros((2, inner.sum())), abs=1e-9)


def test_the_derivatives_of_a_parametrised_ring_give_its_curvatures() -> None:
    """The formulas of docs/materials.md: those of a ring, and those of a mesh by the derivatives along u and v."""
    major, minor, step = 0.5, 0.2, 1e-5
    u, v = np.random.default_rng(3).uniform(0.0, 2.0 * np.pi, (2, 50))  # along the ring, around the tube

    def place(u: npt.NDArray[np.float64], v: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        return np.stack(
            [(major + minor * np.cos(v)) * np.cos(u), minor * np.sin(v), (major + minor * np.cos(v)) * np.sin(u)]
        )

    def normal(u: npt.NDArray[np.float64], v: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        return np.stack([np.cos(v) * np.cos(u), np.sin(v), np.cos(v) * np.sin(u)])

    expected = np.cos(v) / (major + minor * np.cos(v)), np.full(50, 1.0 / minor)
    for (du, dv), by_formula in zip(((step, 0.0), (0.0, step)), expected, strict=True):
        position = (place(u + du, v + dv) - place(u - du, v - dv)) / (2.0 * step)
        turned = (normal(u + du, v + dv) - normal(u - du, v - dv)) / (2.0 * step)
        tangent = position / np.linalg.norm(position, axis=0)
        by_derivatives = (turned * tangent).sum(axis=0) / np.linalg.norm(position, axis=0)
        assert by_derivatives == pytest.approx(by_formula, abs=1e-6)
        measured = normal_curvature(Torus(major, minor), place(u, v), tangent, 1e-3)
        assert measured == pytest.approx(by_formula, abs=1e-3)
