"""The problem that a chain solves on a scene: its inputs for each light, and the reference that it is compared with."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np

from sssgen.lab.measure import fluence_inputs, scene_inputs
from sssgen.lab.measure.deferred import Deferred
from sssgen.lab.measure.error_metric import fit_target
from sssgen.lab.measure.measured_chain import Chain
from sssgen.lab.reference import inlay_refraction as refraction
from sssgen.lab.reference.inside_lengths import thickness
from sssgen.run.backends import Array
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.view_points import Points, points
from sssgen.scene.scene import Light
from sssgen.support.diagnostics import failure
from sssgen.targets.runtime.numpy_textures import Texture

UV_RANGE = 32.0
"""The probe shown_uv divides texture coordinates by this. Here they are lengths in depths of the inlay."""
LENGTHS = ("thickness", "view_thickness")
"""The roles whose value is a length."""
LIGHT_MAPS = ("light_depth_map", "light_layer_map", "fluence_volume", fluence_inputs.INNER)
"""The textures that differ between lights."""
WHITE = 0.8
"""The value to which exposure scales a reference's brightest parts."""

LightReference = tuple[Array, Array]
"""A light's reference, π L / E of a white light: the mean and its standard error, (3, n) each."""


class Part(NamedTuple):
    """A light in a view."""

    inputs: dict[str, Array]
    """The chain's inputs, with n lanes in the last axis"""
    light: dict[str, Array]
    values: Deferred[Any]
    textures: Deferred[Texture]
    color: Array
    """(3, 1) or (3, n): the factor of the light's contribution"""
    plain_color: Array
    """The same without the fall-off of a point light, which volumes of all light have for themselves"""


@dataclass(frozen=True, eq=False)
class Problem:
    """The inputs and the target values of a chain."""

    role: str
    parts: tuple[Part, ...]
    """One per light"""
    summed: bool
    """Whether the values of the parts are added; otherwise they are concatenated"""
    target: Array
    """(channels, lanes)"""
    noise: Array
    """The target's standard error, (channels, lanes)"""
    lambert: Array
    """(channels, lanes): the light that a white matte surface reflects; 0 where the role does not include it"""
    keep: Array
    """Indices of the compared lanes among those of all parts"""
    gain: float = 1.0
    """A factor that normalises values to about 1; target, noise and lambert include it already"""
    together: Part | None = None
    """All lights and the surroundings in one part, for chains that read a volume of all of them; None without such a
    volume"""

    def values(self, chain: Chain, parameters: Mapping[str, Any]) -> Array:
        """The chain's output: (channels, lanes)."""
        outputs, parts = [], self.parts
        if self.together is not None and chain.reads(fluence_inputs.INNER):
            parts = (self.together,)
        for part in parts if any(map(chain.reads, LIGHT_MAPS)) else [self._single_part]:
            chain.set(part.values | parameters, part.textures)
            if self.role == "coordinates":
                outputs.append(UV_RANGE * (chain.surface(part.inputs, "albedo")[:2] - 0.5) - part.inputs["uv"])
            else:
                color = part.plain_color if chain.reads(fluence_inputs.INNER) else part.color
                outputs.append(chain.run(part.inputs, [part.light])[0] * color)
        values = np.concatenate(outputs, axis=1)
        if self.summed:
            values = values.reshape(len(values), len(parts), -1).sum(axis=1)
        if self.role in LENGTHS:
            values = values[:1]
        return values[:, self.keep] * self.gain

    def with_output_of(self, chain: Chain, name: str, parameters: Mapping[str, Any]) -> Problem:
        """The same problem with one more parameter, `name`: the first channel of another chain's output."""
        parts = []
        for part in self.parts:
            chain.set(part.values | parameters, part.textures)
            output = chain.run(part.inputs, [part.light])[0][0]
            # parameters of later techniques with the same names have the same meaning
            parts.append(part._replace(values=part.values | {**parameters, name: output}))
        return replace(self, parts=tuple(parts))

    @cached_property
    def fit_target(self) -> tuple[Array, Array]:
        """The target of a fit and its weights, (channels, lanes) each: `error_metric.fit_target`."""
        return fit_target(self.target, self.noise)

    @cached_property
    def _single_part(self) -> Part:
        """All parts as a single part, with their lanes concatenated: each run of a chain has a large constant cost."""
        if len(self.parts) == 1:
            return self.parts[0]
        counts = [part.inputs["P"].shape[1] for part in self.parts]

        def merge(groups: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
            return {name: _concatenate([values[name] for values in groups], counts) for name in groups[0]}

        def value_of(name: str) -> Any:
            values = [part.values[name] for part in self.parts]
            # a value of each point, such as a curvature, is repeated for each part
            shared = all(value is values[0] for value in values) and np.shape(values[0])[-1:] != (counts[0],)
            return values[0] if shared else _concatenate(values, counts)

        first = self.parts[0]
        return Part(
            merge([part.inputs for part in self.parts]),
            merge([part.light for part in self.parts]),
            Deferred({}, {name: partial(value_of, name) for name in first.values}),
            first.textures,
            _concatenate([part.color for part in self.parts], counts),
            _concatenate([part.plain_color for part in self.parts], counts),
        )

    def thin_out(self, count: int) -> Problem:
        """The same problem on at most `count` of its lanes, evenly spaced, for fitting."""
        if self.summed or len(self.keep) <= count:
            return self
        return _select_lanes(self, np.unique(np.linspace(0, len(self.keep) - 1, count).astype(int)))


def _select_lanes(problem: Problem, indices: Array) -> Problem:
    """The problem with only some of its compared lanes; its parts have no other lanes."""
    lanes = problem.keep[indices]
    parts, start = [], 0
    for part in problem.parts:
        count = part.inputs["P"].shape[1]
        part_lanes = lanes[(lanes >= start) & (lanes < start + count)] - start
        start += count
        if len(part_lanes):
            parts.append(_lanes_of(part, part_lanes, count))
    return Problem(
        problem.role, tuple(parts), False, problem.target[:, indices], problem.noise[:, indices],
        problem.lambert[:, indices], np.arange(len(indices)), problem.gain,
    )  # fmt: skip


def _concatenate(values: Sequence[Any], counts: Sequence[int]) -> Any:
    """The values of several parts, broadcast to their lanes and concatenated."""
    broadcast = [
        np.broadcast_to(value, (*np.shape(value)[:-1], count)) for value, count in zip(values, counts, strict=True)
    ]
    return np.concatenate(broadcast, axis=-1)


def _lanes_of(part: Part, lanes: Array, count: int) -> Part:
    """The part with only some of its `count` lanes."""

    def select(values: Mapping[str, Any], name: str) -> Any:
        value = values[name]
        return value[..., lanes] if np.ndim(value) and np.shape(value)[-1] == count else value

    color = part.color[:, lanes] if part.color.shape[1] == count else part.color
    inputs, light = ({name: select(own, name) for name in own} for own in (part.inputs, part.light))
    values = Deferred({}, {name: partial(select, part.values, name) for name in part.values})
    return part._replace(inputs=inputs, light=light, values=values, color=color, plain_color=part.plain_color)


def thickness_problem(scene: MeasuredScene) -> Problem:
    """Thickness towards each light, relative to its mean, where the light passes through the body."""
    visible = points(scene)
    parts = tuple(_part(scene, visible, light, np.ones((3, 1))) for light in _lights(scene))
    exact = np.concatenate([np.asarray(part.values["exact_length"]) for part in parts])[None]
    keep = _measurable(exact)
    if not len(keep):
        raise failure(f"no light passes through the body of '{scene.name}'", "light it from behind, too")
    return _lengths_problem("thickness", parts, exact, keep)


def view_thickness_problem(scene: MeasuredScene) -> Problem:
    """The length along the eye's ray up to its first exit, relative to its mean, where it is not 0."""
    part = _part(scene, points(scene), _lights(scene)[0], np.ones((3, 1)))
    exact = np.asarray(part.values["exact_view_length"])[None]
    keep = _measurable(exact)
    if not len(keep):
        raise failure(f"no ray of the eye enters the body of '{scene.name}'", "move the camera")
    return _lengths_problem("view_thickness", (part,), exact, keep)


def _measurable(exact: Array) -> Array:
    """The lanes whose length is not a rounding error."""
    return np.flatnonzero(exact[0] > 1e-4 * max(float(exact.max(initial=0.0)), 1e-12))


def _lengths_problem(role: str, parts: tuple[Part, ...], exact: Array, keep: Array) -> Problem:
    gain = 1.0 / float(exact[:, keep].mean())
    target = gain * exact[:, keep]
    zeros = np.zeros_like(target)
    return Problem(role, parts, False, target, zeros, zeros, keep, gain)


def translucency_problem(scene: MeasuredScene, references: Sequence[LightReference]) -> Problem | None:
    """The transmitted light at points that face away from a light; None without such points."""
    visible = points(scene)
    parts = [_part(scene, visible, light, np.ones((3, 1))) for light in scene.lights]
    references = references[: len(parts)]  # an environment shines on every point
    if not parts:
        return None
    facing = np.concatenate([np.einsum("cn,cn->n", visible.inputs["N"], part.light["L"]) for part in parts])
    keep = np.flatnonzero(facing <= 0.0)
    target, noise = (np.concatenate(arrays, axis=1)[:, keep] for arrays in zip(*references, strict=True))
    if not len(keep) or not target.any():
        return None
    gain = exposure(target)
    lambert = np.zeros_like(target)
    return Problem("translucency", tuple(parts), False, gain * target, gain * noise, lambert, keep, gain)


def material_problem(scene: MeasuredScene, references: Sequence[LightReference], summed: bool) -> Problem:
    """All light that leaves the surface; the sum over the lights if `summed`, otherwise light by light.

    An environment is the last reference; for a technique it is a number of lights from afar, which are summed.
    """
    visible = points(scene)
    parts, lit, colored = [], [], []
    for light, (mean, error) in zip(scene.lights, references, strict=False):
        color = np.array(light.color)[:, None] if summed else np.ones((3, 1))
        part, lambert = _lit(scene, visible, light, color)
        parts.append(part)
        lit.append(lambert)
        colored.append((color * mean, color * error))
    if scene.environment is not None and summed:
        for light in scene.environment.lights():
            part, lambert = _lit(scene, visible, light, np.array(light.color)[:, None])
            parts.append(part)
            lit.append(lambert)
        colored.append(references[-1])
    if summed:
        target = np.sum([mean for mean, _ in colored], axis=0)
        noise = np.sqrt(np.sum([error**2 for _, error in colored], axis=0))
        lambert = np.sum(lit, axis=0)
    else:
        target, noise = (np.concatenate(arrays, axis=1) for arrays in zip(*colored, strict=True))
        lambert = np.concatenate(lit, axis=1)
    gain = exposure(target)
    keep = np.arange(target.shape[1])
    together = _together(scene, parts[0]) if summed and scene.medium is not None else None
    return Problem("material", tuple(parts), summed, gain * target, gain * noise, gain * lambert, keep, gain, together)


def exposure(target: Array) -> float:
    """The factor that scales the 99th percentile of a reference to WHITE; it applies to compared values too."""
    bright = float(np.percentile(target.max(axis=0), 99.0))
    return WHITE / bright if bright > 0.0 else 1.0


def coordinates_problem(scene: MeasuredScene) -> Problem:
    """The offset along T and B at which refraction shows the inlay, in depths of the inlay."""
    visible = points(scene)
    inlay = refraction.visible_inlay(scene, visible)
    keep = np.flatnonzero(inlay.hit)
    if not len(keep):
        raise failure(
            f"no ray meets the inlay of '{scene.name}'", "reduce its depth: it is larger than the body's thickness"
        )
    assert scene.inlay is not None
    # the unit of uv is one depth, so its change is the offset in depths
    values = {
        **scene.inlay.parameters, "uv_per_unit": np.full((2, 1), 1.0 / inlay.depth),
        "depth 1": 1.0, "eta": scene.inlay.outside_ior / scene.inlay.ior,
    }  # fmt: skip
    curvature = scene_inputs.curvature_of(scene)
    white = np.ones((3, 1))
    part = Part(
        {**visible.inputs, **curvature.inputs},
        {},
        Deferred(values, {}) | curvature.values,
        curvature.textures,
        white,
        white,
    )
    target = inlay.offset[:, keep] / inlay.depth
    zeros = np.zeros_like(target)
    return Problem("coordinates", (part,), False, target, zeros, zeros, keep)


def _part(scene: MeasuredScene, visible: Points, light: Light, color: Array) -> Part:
    """A light in a view; `color` without the fall-off of a point light."""
    of_body, of_light = scene_inputs.of_scene(scene), scene_inputs.of_light(scene, light)
    distance = visible.towards(light)[1]
    return Part(
        {**visible.inputs, **of_body.inputs}, visible.light(light), of_body.values | of_light.values,
        of_body.textures | of_light.textures,
        color if light.position is None else color / distance**2, color,
    )  # fmt: skip


def _together(scene: MeasuredScene, part: Part) -> Part:
    """A part, with all lights of its scene in the volume."""
    volume = partial(fluence_inputs.inner_light, scene, scene.lights, scene.environment)
    white = np.ones((3, 1))
    textures = part.textures | Deferred({}, {fluence_inputs.INNER: volume})
    return part._replace(textures=textures, color=white, plain_color=white)


def _lights(scene: MeasuredScene) -> Sequence[Light]:
    """The lights of a scene; if it has none, those of its environment."""
    return scene.environment.lights() if scene.environment is not None and not scene.lights else scene.lights


def _lit(scene: MeasuredScene, visible: Points, light: Light, color: Array) -> tuple[Part, Array]:
    """A light in a view, and what a white Lambert surface reflects of it: (3, n)."""
    part = _part(scene, visible, light, color)
    towards, distance = visible.towards(light)
    facing = np.maximum(np.einsum("cn,cn->n", visible.inputs["N"], towards), 0.0)
    origins = np.ascontiguousarray((visible.inputs["P"] + 1e-4 * visible.inputs["N"]).T)
    ways = np.ascontiguousarray(towards.T)
    shadow = thickness(scene.geometry, origins, ways)
    if light.position is not None:
        shadow = shadow - thickness(scene.geometry, np.ascontiguousarray(origins + distance[:, None] * ways), ways)
    return part, part.color * facing * (shadow < 1e-3)
