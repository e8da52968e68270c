"""The length along the eye's ray as harmonics: closed forms of ball and slab, exactness, and the maps of charts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from measured_views import small
from oracle import Array, close, rng, unit, units
from sssgen.lab.measure import candidates, scene_inputs
from sssgen.lab.measure import measurement as measure
from sssgen.lab.measure.fitting import FitResult
from sssgen.lab.measure.measurement import View
from sssgen.lab.reference import view_harmonics
from sssgen.scene.geometry import Ball, Box, Capsule, Slab
from sssgen.scene.measured.media import Medium

UNFITTED = FitResult({}, (1.0, 1.0, 1.0), (0.0, 0.0, 0.0), 0.0)


def test_directions_are_inward_with_the_density_of_their_cosine() -> None:
    normals = units(5, 3)
    directions = view_harmonics.inward(normals, 400)
    close(np.linalg.norm(directions, axis=2), 1.0)
    cosines = -np.einsum("nkc,nc->nk", directions, normals)
    assert cosines.min() > 0.0
    # moments of the cosine's own density 2 c
    for power in (1, 2, 3):
        close((cosines**power).mean(axis=1), 2.0 / (power + 2), rtol=2e-3)


def test_a_function_of_the_harmonics_is_fitted_exactly() -> None:
    exact = rng(4).normal(size=(20, 9))
    directions = view_harmonics.inward(units(20, 5), 32)
    values = np.einsum("nki,ni->nk", view_harmonics.harmonics(directions), exact)
    some = rng(6).random(values.shape) < 0.8
    close(view_harmonics.fit_coefficients(np.where(some, values, 99.0), directions, some), exact, atol=1e-6)


def test_the_harmonics_are_orthogonal_over_the_sphere() -> None:
    height, weight = np.polynomial.legendre.leggauss(6)
    angle = np.arange(8) * np.pi / 4.0
    radius = np.sqrt(1.0 - height**2)[:, None]
    directions = np.stack([radius * np.cos(angle), radius * np.sin(angle), height[:, None] + 0.0 * angle], axis=-1)
    terms = view_harmonics.harmonics(directions).reshape(-1, 9)
    gram = np.einsum("ni,nj,n->ij", terms, terms, np.repeat(weight, 8))
    close(gram - np.diag(np.diag(gram)), 0.0, atol=1e-12)
    assert (np.diag(gram) > 0.1).all()


def best(share: Callable[[Array], Array]) -> Callable[[Array], Array]:
    """The best fit to a function of the cosine: the harmonics that turn with it are 1, c and 3 c² - 1.

    Quadrature over the hemisphere, weighted by the cosine, in place of rays.
    """
    node, weight = np.polynomial.legendre.leggauss(64)
    cosine, root = 0.5 * (1.0 + node), np.sqrt(0.5 * weight * 0.5 * (1.0 + node))
    basis = np.stack([np.ones_like(cosine), cosine, 3.0 * cosine**2 - 1.0], axis=1)
    solution = np.linalg.lstsq(root[:, None] * basis, root * share(cosine), rcond=None)[0]
    return lambda c: np.stack([np.ones_like(c), c, 3.0 * c * c - 1.0], axis=-1) @ solution


@pytest.mark.parametrize("mean_free_path", [0.1, 0.5, 3.0])
def test_a_ball_has_its_closed_form(mean_free_path: float) -> None:
    ball = Ball(0.8, position=(0.3, 0.1, -0.2), rotation=(20.0, 50.0, 10.0), scale=1.5)
    normals = units(7, 8)
    fit = view_harmonics.of_points(ball, 1.2 * normals + ball.position, normals, mean_free_path, 8192)
    expected = best(lambda c: 1.0 - np.exp(-2.4 * c / mean_free_path))
    ways = view_harmonics.inward(normals, 50)
    shares = np.einsum("nki,ni->nk", view_harmonics.harmonics(in_object(ball, ways)), fit.coefficients)
    cosines = -np.einsum("nkc,nc->nk", ways, normals)
    close(shares, expected(cosines), atol=4e-3)
    assert fit.lost.max() == 0.0
    cosine = np.sqrt((np.arange(20000) + 0.5) / 20000)  # with the density of the cosine
    exact = 1.0 - np.exp(-2.4 * cosine / mean_free_path)
    close(fit.error, np.sqrt(((expected(cosine) - exact) ** 2).mean()), rtol=0.03)
    assert fit.error.max() < 0.06


def in_object(geometry: Ball | Slab, directions: Array) -> Array:
    result: Array = directions @ geometry.to_object()[:3, :3].T * geometry.scale
    return result


def test_a_slab_has_its_closed_form() -> None:
    slab = Slab(400.0, 400.0, 0.3, rotation=(30.0, 0.0, 40.0))
    normal = slab.to_world()[:3, :3] @ [0.0, 0.0, 1.0]
    point = 0.15 * normal
    fit = view_harmonics.of_points(slab, point[None], normal[None], 0.2, 1024)
    expected = best(lambda c: 1.0 - np.exp(-0.3 / (0.2 * c)))
    ways = view_harmonics.inward(normal[None], 200)
    shares = np.einsum("nki,ni->nk", view_harmonics.harmonics(in_object(slab, ways)), fit.coefficients)
    close(shares[0], expected(-ways[0] @ normal), atol=4e-3)


def test_the_fit_is_the_same_for_a_turned_body() -> None:
    """It is in object space: the body's placement changes neither coefficients nor, but for the unit, lengths."""
    at, normals = np.array([[0.3, 0.05, 0.2], [-0.3, 0.1, 0.0]]), np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    first = Box(size=(0.6, 0.8, 1.0))
    turned = replace(first, position=(1.0, 2.0, 3.0), rotation=(0.0, 0.0, 90.0), scale=2.0)
    matrix = turned.to_world()
    places = at @ matrix[:3, :3].T + matrix[:3, 3]
    expected = view_harmonics.of_points(first, at, normals, 0.3, 4096)
    result = view_harmonics.of_points(turned, places, unit(normals @ matrix[:3, :3].T), 0.6, 4096)
    # directions are others, so values between the harmonics agree to the accuracy of the fit
    ways = view_harmonics.inward(normals, 40)
    shares = [np.einsum("nki,ni->nk", view_harmonics.harmonics(ways), fit.coefficients) for fit in (expected, result)]
    close(*shares, atol=5e-3)


def test_in_a_clear_medium_lengths_are_stored_relative_to_the_body() -> None:
    assert view_harmonics.fade_length(Ball(0.8, scale=2.0), 0.1) == 0.1
    assert view_harmonics.fade_length(Ball(0.8, scale=2.0), 1e6) == pytest.approx(0.8)


def test_charts_read_the_fit_of_each_point() -> None:
    """The technique has the error of the nine numbers, and none of a bake."""
    medium = Medium("test", (0.5,) * 3, (2.0,) * 3)
    scene = replace(small("capsule"), geometry=Capsule(0.4, 0.5, rotation=(0.0, 30.0, 60.0)), medium=medium)
    (candidate,) = [one for one in candidates.view_thickness() if one.name == "view_thickness_map"]
    point = measure.measure_candidate(candidate, UNFITTED, [View("shown", scene)])
    assert point["requires"] == ["bake", "rigid"] and point["bytes"] == 9 * 512 * 512 and not point["failed"]
    surface = measure.points(scene)
    exact = scene_inputs.view_lengths(scene)
    ways = -surface.inputs["V_object"].T
    shares = np.einsum("ni,ni->n", view_harmonics.harmonics(ways), scene_inputs.view_fit(scene))
    length = -0.4 * np.log(1.0 - np.clip(shares, 0.02, 0.9999))
    assert point["error"]["value"] == pytest.approx(
        measure.metrics.compare(length[None] / exact.mean(), exact[None] / exact.mean())["value"], rel=1e-6
    )
    assert 0.01 < point["error"]["value"] < 0.25


def test_whole_chains_take_the_map() -> None:
    chains = {
        one.techniques for one in candidates.materials([], candidates.view_thickness(), candidates.default_paths())
    }
    for technique in ("interior_sample", "interior_octaves", "fluence_factored_8"):
        assert ("view_thickness_map", technique) in chains
