"""A skinned body that reads the volume of its rest pose, against path tracing of the bent body.

The body is a round arm of two bones, bent at its elbow by linear blend skinning. Its points carry their rest positions
and their view turned back; in the volume of the rest pose each voxel has the light's direction, turned back by the
rotation that its bones' weights give. What does not turn back: the parts of the arm that shade each other, and the
lengths that change where the elbow is bent.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sssgen.jobs.executor import Item
from sssgen.lab.chart.case_errors import CaseErrors, case_error
from sssgen.lab.chart.charting import Settings, candidate_of, fit_of, results_of
from sssgen.lab.chart.drawn_lights import Case
from sssgen.lab.measure import fluence_inputs, scene_inputs
from sssgen.lab.measure.candidates import Candidate
from sssgen.lab.measure.fitting import FitResult
from sssgen.lab.measure.measured_point import FittedChain
from sssgen.lab.measure.measurement import View, compared_with, problem_of
from sssgen.lab.measure.problem import Problem
from sssgen.run.backends import Array
from sssgen.run.evaluate.evaluation import half
from sssgen.scene.arrays import Indices
from sssgen.scene.camera import Camera
from sssgen.scene.geometry import Mesh
from sssgen.scene.light_response import Incoming, volume
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.media import Medium
from sssgen.scene.measured.view_points import points
from sssgen.scene.mesh_rays import MeshRays
from sssgen.targets.runtime.numpy_textures import Texture

RADIUS, REACH = 0.22, 0.55
"""Of the arm, and from the elbow to the middle of each of its round ends."""
BLENDED = 0.35
"""From the elbow to where a bone alone moves the arm."""
AROUND, RINGS = 48, 24
"""The vertices around the arm, the rings of an end; the tube has four times as many."""


class Pose(NamedTuple):
    """The arm, bent by an angle in degrees."""

    degrees: float
    rest: Array
    """(v, 3)"""
    places: Array
    """(v, 3): bent"""
    corners: Indices

    def weights(self, rest: Array) -> Array:
        """The weights of the second bone at rest positions (n, 3)."""
        part = np.clip(0.5 + 0.5 * rest[:, 1] / BLENDED, 0.0, 1.0)
        return part * part * (3.0 - 2.0 * part)

    def turned_back(self, directions: Array, rest: Array) -> Array:
        """Directions (n or 1, 3) at rest positions (n, 3), from the bent to the rest pose: rotated by the angle of the
        blended bones' matrix."""
        weight, angle = self.weights(rest), np.radians(self.degrees)
        turn = -np.arctan2(weight * np.sin(angle), 1.0 - weight + weight * np.cos(angle))
        return _about_z(directions, np.cos(turn), np.sin(turn))

    def mesh(self) -> Mesh:
        return Mesh(path=f"arm_{self.degrees:g}.obj", data=_obj(self.places, self.corners))


def pose(degrees: float) -> Pose:
    """The arm, bent by linear blend skinning."""
    rest, corners = _tube()
    arm, angle = Pose(degrees, rest, rest, corners), np.radians(degrees)
    weight = arm.weights(rest)[:, None]
    bent = (1.0 - weight) * rest + weight * _about_z(rest, np.cos(angle), np.sin(angle))
    return arm._replace(places=bent)


def _about_z(vectors: Array, cosine: Array | float, sine: Array | float) -> Array:
    x, y, z = vectors.T
    turned = np.broadcast_arrays(cosine * x - sine * y, sine * x + cosine * y, z)
    return np.stack(turned, axis=1)


def _tube() -> tuple[Array, Indices]:
    """A capsule along y."""
    ends = np.linspace(0.0, 0.5 * np.pi, RINGS + 1)[1:]
    tube = np.linspace(-REACH, REACH, 4 * RINGS + 1)
    height = np.concatenate([-REACH - RADIUS * np.sin(ends[:-1][::-1]), tube, REACH + RADIUS * np.sin(ends[:-1])])
    width = RADIUS * np.concatenate([np.cos(ends[:-1][::-1]), np.ones_like(tube), np.cos(ends[:-1])])
    angle = np.arange(AROUND) * (2.0 * np.pi / AROUND)
    rings = [
        np.stack([w * np.cos(angle), np.full(AROUND, y), -w * np.sin(angle)], axis=1)
        for y, w in zip(height, width, strict=True)
    ]
    places = np.concatenate([*rings, [[0.0, -REACH - RADIUS, 0.0], [0.0, REACH + RADIUS, 0.0]]])
    here = np.arange(AROUND)
    beside = (here + 1) % AROUND
    faces = []
    for ring in range(len(height) - 1):
        low, high = ring * AROUND, (ring + 1) * AROUND
        faces += [
            np.stack([low + here, low + beside, high + here], 1),
            np.stack([low + beside, high + beside, high + here], 1),
        ]
    bottom, top, last = len(places) - 2, len(places) - 1, (len(height) - 1) * AROUND
    faces += [
        np.stack([np.full(AROUND, bottom), beside, here], 1),
        np.stack([last + here, last + beside, np.full(AROUND, top)], 1),
    ]
    return places, np.concatenate(faces)


def _obj(places: Array, corners: Indices) -> bytes:
    lines = [f"v {x:.7f} {y:.7f} {z:.7f}" for x, y, z in places]
    lines += [f"f {a} {b} {c}" for a, b, c in corners + 1]
    return "\n".join(lines).encode()


def scene(degrees: float, medium: Medium) -> MeasuredScene:
    """The arm in a pose, without lights."""
    arm = pose(degrees)
    middle = 0.5 * (arm.places.min(axis=0) + arm.places.max(axis=0))
    x, y, z = map(float, middle)
    camera = Camera((x + 0.6, y + 0.5, z + 3.4), (x, y, z), 30.0)
    name = f"arm_{degrees:g}"
    return MeasuredScene(name, name, arm.mesh(), camera, (), medium, None)


def errors_at_rest(
    chain: FittedChain, degrees: float, medium: Medium, cases: Sequence[Case], settings: Settings
) -> CaseErrors:
    """The errors of a chain that reads the volume of the rest pose, in cases of one light from afar on the bent arm.

    Raises SssgenError as `errors` does.
    """
    rest = scene(0.0, medium)
    with settings.progress_bar() as progress:
        fluence_inputs.prepare(rest, settings.scheduler, settings.processes, progress)
    pair = candidate_of(chain), fit_of(chain)
    items = [
        Item(f"{__name__}:measure_at_rest", (*pair, degrees, rest, tuple(case)), f"bent arm, light {number}")
        for number, case in enumerate(cases)
    ]
    return CaseErrors(*map(tuple, zip(*results_of(items, settings), strict=True)))


def measure_at_rest(
    candidate: Candidate, fit: FitResult, degrees: float, rest: MeasuredScene, case: Case
) -> tuple[float, float]:
    """The errors of a case: at all points, and at the edges of shadows."""
    return case_error([values_at_rest(candidate, fit, degrees, rest, view) for view in case], case)


def values_at_rest(
    candidate: Candidate, fit: FitResult, degrees: float, rest: MeasuredScene, view: View
) -> tuple[Array, Problem]:
    """The values on a view of the bent arm, (3, n), and the problem with the reference."""
    problem = _rest_problem(view, pose(degrees), rest)
    return compared_with(problem, candidate, fit, view.scene.geometry), problem


def _rest_problem(view: View, arm: Pose, rest: MeasuredScene) -> Problem:
    """The problem of a view, whose part with all lights reads the volume of the rest pose."""
    problem, visible = problem_of("material", view), points(view.scene)
    assert problem is not None and problem.together is not None
    rays = np.ascontiguousarray(-visible.inputs["V"].T)
    at_rest = _rest_positions(arm, visible.origin, rays)
    turned = {name: arm.turned_back(visible.inputs[name].T, at_rest).T for name in ("V", "N")}
    of_rest = scene_inputs.of_scene(rest).values
    (light,) = view.scene.lights
    response = fluence_inputs.response_of(rest)
    towards = arm.turned_back(np.array([light.direction]), response.places())
    inner = half(Texture(volume(response, [Incoming(towards, np.array([light.color]))]), wrap="clamp"))
    part = problem.together._replace(
        inputs={**problem.together.inputs, **turned, "P": at_rest.T},
        values=problem.together.values | {name: of_rest[name] for name in ("world_to_volume", "fluence_reach")},
        textures=problem.together.textures | {fluence_inputs.INNER: inner},
    )
    return dataclasses.replace(problem, together=part)


def _rest_positions(arm: Pose, eye: Array, rays: Array) -> Array:
    """The rest positions of the points that rays of the eye meet, (n, 3)."""
    starts = np.broadcast_to(eye, rays.shape).copy()
    face, ahead = MeshRays(arm.places, arm.corners).nearest(starts, rays)
    met = starts + ahead[:, None] * rays
    first, second, third = np.moveaxis(arm.places[arm.corners[face]], 1, 0)
    edges = np.stack([second - first, third - first], axis=2)
    shares = np.einsum("nkc,nc->nk", np.linalg.pinv(edges), met - first)
    weights = np.concatenate([1.0 - shares.sum(axis=1, keepdims=True), shares], axis=1)
    positions: Array = np.einsum("nk,nkc->nc", weights, arm.rest[arm.corners[face]])
    return positions
