"""The inputs that a scene gives to a measured chain: textures baked from the body, and parameters of its geometry.

Maps are ideal: each point reads its own texel, which has the exact value. So a technique's error excludes bake errors.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache, partial
from typing import Any, NamedTuple

import numpy as np

from sssgen.ir.frame_passes import BACK_FACES, EYE_LAYERS
from sssgen.lab.measure import fluence_inputs
from sssgen.lab.measure.deferred import Deferred
from sssgen.lab.reference import view_harmonics
from sssgen.lab.reference.curvature import normal_curvature
from sssgen.lab.reference.inside_lengths import first_exit, thickness
from sssgen.lab.reference.view_harmonics import LARGEST
from sssgen.run.backends import Array
from sssgen.run.evaluate.evaluation import half
from sssgen.scene.bounds import world_corners
from sssgen.scene.drawn_views import eye_layers
from sssgen.scene.inside_intervals import intervals
from sssgen.scene.light_view import LightView, directional_view, point_view
from sssgen.scene.measured import scene_body as body
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.view_points import points
from sssgen.scene.scene import Light, placement
from sssgen.targets.runtime.numpy_textures import Texture

RAYS = 32
"""Inward rays per point for the mean chord."""
DEPTH_MAP = 256
"""Width and height of a light's depth map, in texels."""
IMAGES = 3
"""The images of a directional map of lengths, with three numbers each."""
CURVATURE_STEP = 0.02
"""The length over which curvatures are measured, relative to the longest side of the body."""


class SceneInputs(NamedTuple):
    """Parameters and textures by their names in techniques."""

    values: Deferred[Any]
    textures: Deferred[Texture]
    inputs: dict[str, Array]
    """What replaces inputs of the points"""


@lru_cache(48)
def of_scene(scene: MeasuredScene) -> SceneInputs:
    """The inputs that do not depend on a light."""
    geometry, visible = scene.geometry, points(scene)
    distances = body.distance_texture(geometry)
    # one lane for all points, so that a vector of three components does not become three lanes
    parameters = body.texture_parameters(distances) | placement(geometry) | {"stored_range": distances.range}
    values = {
        name: np.array(value)[:, None] if isinstance(value, list) else value for name, value in parameters.items()
    }
    values["world_to_volume"] = _to_box(geometry.to_object(), distances.box_min, distances.box_max).T[..., None]
    if scene.medium is not None:
        values |= {
            name: np.array(value)[:, None] if isinstance(value, list) else value
            for name, value in scene.medium.parameters.items()
        }
    for number in range(1, IMAGES + 1):
        values |= {
            f"harmonics_lowest_{number}": np.full((3, 1), -LARGEST),
            f"harmonics_span_{number}": np.full((3, 1), 2.0 * LARGEST),
        }
    computed: dict[str, Callable[[], Any]] = {
        "fluence_reach": partial(fluence_inputs.reach, scene),
        "exact_view_length": partial(view_lengths, scene),
        "mean_curvature": lambda: np.maximum(principal_curvatures(scene).mean(axis=0), 0.0),
        "fade_length": partial(fade_length, scene),
    }
    textures: dict[str, Callable[[], Texture]] = {
        "back_face_map": partial(eye_picture, scene, BACK_FACES),
        "eye_layer_map": partial(eye_picture, scene, EYE_LAYERS),
        "distance_map": lambda: half(Texture(distances.values(geometry), wrap="clamp")),
        "thickness_texture": lambda: _ideal(relative_chord(scene)[:, None]),
        "thinness_texture": lambda: _ideal(1.0 - relative_chord(scene)[:, None]),
        "transmittance_texture": partial(_transmittance, scene),
        **directional_maps(scene),
    }
    return SceneInputs(Deferred(values, computed), Deferred({}, textures), {"uv": _texels(visible.count)})


@lru_cache(48)
def curvature_of(scene: MeasuredScene) -> SceneInputs:
    """The normal curvatures along T and B, as a parameter of each point and as a map."""
    curvatures = principal_curvatures(scene)
    largest = max(float(np.abs(curvatures).max(initial=0.0)), 1e-9)
    values = {"curvature": curvatures, "curvature_range": largest}
    textures = {"curvature_texture": _ideal(0.5 + 0.5 * curvatures.T / largest)}
    return SceneInputs(Deferred(values, {}), Deferred(textures, {}), {"uv": _texels(curvatures.shape[1])})


def _texels(count: int) -> Array:
    """The places of the points in ideal maps, (2, n)."""
    return np.stack([(np.arange(count) + 0.5) / count, np.full(count, 0.5)])


def _ideal(values: Array) -> Texture:
    """A map with one texel per point, without filtering, so that the bake has no error; values are (n, channels)."""
    return Texture(values[None], "nearest", "clamp")


@lru_cache(192)
def of_light(scene: MeasuredScene, light: Light) -> SceneInputs:
    """The inputs that depend on a light: the exact thickness towards it, its depth map, and light from a bake."""
    view = _view(scene, light)
    depth_only = np.zeros((4, 4))  # the depth is the distance from the plane of the light
    depth_only[2], depth_only[3, 3] = view.matrix[2], 1.0
    matrices = {"light_matrix": view.matrix, "light_texture": view.matrix, "light_view": depth_only}
    values = {name: matrix.T[..., None] for name, matrix in matrices.items()}
    textures = {
        "light_depth_map": lambda: Texture(_depth_layers(scene, light)[..., :1], "linear", "clamp"),
        "light_layer_map": lambda: Texture(_depth_layers(scene, light), "linear", "clamp"),
        **fluence_inputs.of_light(scene, light),
    }
    exact: dict[str, Callable[[], Any]] = {"exact_length": partial(lengths_towards, scene, light)}
    return SceneInputs(Deferred(values, exact), Deferred({}, textures), {})


def lengths_towards(scene: MeasuredScene, light: Light) -> Array:
    """The exact length inside the body towards a light: (n,)."""
    geometry, visible = scene.geometry, points(scene)
    towards = np.ascontiguousarray(visible.towards(light)[0].T)
    exact = thickness(geometry, np.ascontiguousarray(visible.inputs["P"].T), towards)
    if light.position is not None:  # what is behind the light does not count
        exact = exact - thickness(geometry, np.broadcast_to(light.position, towards.shape).copy(), towards)
    return exact


def _to_box(to_object: Array, low: Sequence[float], high: Sequence[float]) -> Array:
    """World space to a box in object space, (4, 4): 0 to 1 inside."""
    matrix = np.eye(4)
    size = np.subtract(high, low)
    matrix[:3] = to_object[:3] / size[:, None]
    matrix[:3, 3] -= np.array(low) / size
    return matrix


def relative_chord(scene: MeasuredScene) -> Array:
    """The mean chord relative to the longest one: (n,)."""
    chord = mean_chord(scene)
    relative: Array = chord / max(float(chord.max(initial=0.0)), 1e-9)
    return relative


def _transmittance(scene: MeasuredScene) -> Texture:
    """A map of what a medium transmits whose mean free path is the median of the mean chords."""
    chord = mean_chord(scene)
    typical = max(float(np.median(chord)), 1e-9) if len(chord) else 1.0
    return _ideal(np.exp(-chord / typical)[:, None])


@lru_cache(8)
def mean_chord(scene: MeasuredScene) -> Array:
    """The mean length inside the body over inward directions, weighted by the cosine to −N: (n,)."""
    visible = points(scene)
    frame = np.stack(
        [visible.inputs["T"], np.cross(visible.inputs["N"].T, visible.inputs["T"].T).T, -visible.inputs["N"]]
    )
    # a Fibonacci spiral on the disc, projected to the hemisphere: a cosine-weighted density
    index = np.arange(RAYS)
    radius, angle = np.sqrt((index + 0.5) / RAYS), index * np.pi * (3.0 - np.sqrt(5.0))
    local = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.sqrt(1.0 - radius**2)])
    directions = np.einsum("kr,kcn->rnc", local, frame).reshape(-1, 3)
    origins = np.tile(visible.inputs["P"].T, (RAYS, 1))
    mean: Array = thickness(scene.geometry, origins, np.ascontiguousarray(directions)).reshape(RAYS, -1).mean(axis=0)
    return mean


def principal_curvatures(scene: MeasuredScene) -> Array:
    """The normal curvatures along T and B, (2, n). Their mean is the mean curvature, as T and B are perpendicular."""
    visible = points(scene)
    corners = world_corners(scene.geometry)
    step = CURVATURE_STEP * float(np.ptp(corners, axis=0).max())
    tangent = visible.inputs["T"]
    other = np.cross(visible.inputs["N"].T, tangent.T).T
    positions = visible.inputs["P"]
    return np.stack([normal_curvature(scene.geometry, positions, axis, step) for axis in (tangent, other)])


def view_lengths(scene: MeasuredScene) -> Array:
    """The exact length inside the body along the eye's ray, up to its first exit: (n,)."""
    visible = points(scene)
    origins, rays = (np.ascontiguousarray(part.T) for part in (visible.inputs["P"], -visible.inputs["V"]))
    return first_exit(scene.geometry, origins, rays)


def fade_length(scene: MeasuredScene) -> float:
    """The length with which a directional map of the scene's body stores lengths."""
    mean_free_path = scene.medium.mean_free_path if scene.medium is not None else np.inf
    return view_harmonics.fade_length(scene.geometry, mean_free_path)


def directional_maps(scene: MeasuredScene) -> dict[str, Callable[[], Texture]]:
    """The images of the directional map of lengths, by their names in techniques, computed when a chain reads one."""
    return {f"view_harmonics_{number + 1}": partial(_directional_map, scene, number) for number in range(IMAGES)}


def _directional_map(scene: MeasuredScene, number: int) -> Texture:
    return _ideal(0.5 + 0.5 / LARGEST * view_fit(scene)[:, 3 * number : 3 * number + 3])


@lru_cache(8)
def view_fit(scene: MeasuredScene) -> Array:
    """The numbers of the directional map of lengths at the visible points, (n, 9)."""
    visible = points(scene)
    places, normals = (np.ascontiguousarray(visible.inputs[name].T) for name in ("P", "N"))
    return view_harmonics.of_points(scene.geometry, places, normals, fade_length(scene)).coefficients


def eye_picture(scene: MeasuredScene, name: str) -> Texture:
    """What the pass `name` draws at the pixels of the measured points."""
    visible = points(scene)
    rays = np.ascontiguousarray(-visible.inputs["V"].T)
    layers = eye_layers(scene.geometry, visible.origin, rays, name)
    picture = np.zeros((*visible.valid.shape, layers.shape[1]))
    picture[visible.valid] = layers
    return Texture(picture, "nearest", "clamp")


def _view(scene: MeasuredScene, light: Light) -> LightView:
    """The view of a light on the body."""
    corners, size = world_corners(scene.geometry), (DEPTH_MAP, DEPTH_MAP)
    if light.position is not None:
        return point_view(corners, np.array(light.position), size)
    return directional_view(corners, np.array(light.direction), size)


@lru_cache(8)
def _depth_layers(scene: MeasuredScene, light: Light) -> Array:
    """The distances of four surfaces from the light's plane, (DEPTH_MAP, DEPTH_MAP, 4)."""
    geometry, view = scene.geometry, _view(scene, light)
    to_object = geometry.to_object()
    origins = view.origins @ to_object[:3, :3].T + to_object[:3, 3]
    directions = view.directions @ to_object[:3, :3].T * geometry.scale
    inside = intervals(geometry, origins, directions)
    filled = (inside[..., 1] > inside[..., 0])[..., None]
    parts = np.sort(np.where(filled, inside, np.inf), axis=1) * geometry.scale * view.slopes[:, None, None]
    parts = np.pad(parts, ((0, 0), (0, 2), (0, 0)), constant_values=np.inf)
    layers = parts[:, :2].reshape(len(parts), 4)
    return np.where(np.isfinite(layers), layers, view.far).reshape(DEPTH_MAP, DEPTH_MAP, 4)
