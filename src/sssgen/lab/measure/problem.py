"""What is asked of a chain on a scene: its inputs light by light, and the reference to hold its values against."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from sssgen.harness.backends import Array
from sssgen.lab.measure import scene_inputs
from sssgen.lab.measure.measured_chain import Chain
from sssgen.lab.reference import inlay_refraction as refraction
from sssgen.lab.reference.inside_lengths import thickness
from sssgen.lab.scene.measured_scene import MeasuredScene
from sssgen.lab.scene.view_points import Points, points
from sssgen.support.diagnostics import failure
from sssgen.targets.numpy_textures import Texture

UV_RANGE = 32.0
"""What the probe shown_uv divides texture coordinates by, which are lengths in depths here."""


DEPTH_MAP = "light_depth_map"
"""The texture that each light has its own of."""
WHITE = 0.8
"""Where exposure puts a reference's brightest parts."""

Seen = tuple[Array, Array]
"""A light's reference: the mean and its standard error, (3, n) each, π L / E of a white light."""


class Part(NamedTuple):
    """One light on one view."""

    inputs: dict[str, Array]
    """The chain's inputs, n lanes last"""
    light: dict[str, Array]
    values: dict[str, Any]
    textures: dict[str, Texture]
    color: Array
    """(3, 1): what the light's factor is multiplied by"""


@dataclass(frozen=True, eq=False)
class Problem:
    """What a chain's values should be."""

    role: str
    parts: tuple[Part, ...]
    """Their values stand one after the other, or where `summed` they are added"""
    summed: bool
    target: Array
    """(channels, lanes)"""
    noise: Array
    """The target's standard error, likewise"""
    lambert: Array
    """(channels, lanes): what a white matte surface would reflect; 0 where that is not asked for"""
    keep: Array
    """The lanes that count, of all of the parts' lanes"""
    gain: float = 1.0
    """What values are multiplied by, as target and noise are already: it brings them to about 1"""

    def values(self, chain: Chain, parameters: Mapping[str, Any]) -> Array:
        """What the chain gives: (channels, lanes)."""
        together = not chain.reads(DEPTH_MAP)
        found = []
        for part in [self._together] if together else self.parts:
            chain.set({**part.values, **parameters}, part.textures)
            if self.role == "coordinates":
                found.append(UV_RANGE * (chain.surface(part.inputs, "albedo")[:2] - 0.5))
            else:
                found.append(chain.run(part.inputs, [part.light])[0] * part.color)
        whole = np.concatenate(found, axis=1)
        if self.summed:
            whole = whole.reshape(len(whole), len(self.parts), -1).sum(axis=1)
        read = whole[:1] if self.role == "thickness" else whole
        return read[:, self.keep] * self.gain

    def given(self, name: str, chain: Chain, parameters: Mapping[str, Any]) -> Problem:
        """The same, with what a chain shows in its first channel as the parameter `name` of each part."""
        parts = []
        for part in self.parts:
            chain.set({**part.values, **parameters}, part.textures)
            shown = chain.run(part.inputs, [part.light])[0][0]
            # what follows may have parameters of the same name: they mean the same
            parts.append(part._replace(values={**part.values, **parameters, name: shown}))
        return replace(self, parts=tuple(parts))

    @cached_property
    def _together(self) -> Part:
        """All parts as one, side by side: one run of a chain costs as much as its lanes, and as much again."""
        if len(self.parts) == 1:
            return self.parts[0]
        counts = [part.inputs["P"].shape[1] for part in self.parts]

        def beside(each: Sequence[Mapping[str, Any]], names: Collection[str]) -> dict[str, Any]:
            return {name: _beside([one[name] for one in each], counts) for name in names}

        first = self.parts[0]
        shared = {name for name in first.values if all(one.values[name] is first.values[name] for one in self.parts)}
        values = beside([part.values for part in self.parts], first.values.keys() - shared)
        return Part(
            beside([part.inputs for part in self.parts], first.inputs.keys()),
            beside([part.light for part in self.parts], first.light.keys()),
            {**{name: first.values[name] for name in shared}, **values},
            first.textures,
            np.concatenate(
                [np.broadcast_to(part.color, (3, n)) for part, n in zip(self.parts, counts, strict=True)], 1
            ),
        )

    def thinned(self, most: int) -> Problem:
        """The same on at most so many of its lanes, spread evenly: to fit with."""
        if self.summed or len(self.keep) <= most:
            return self
        chosen = np.unique(np.linspace(0, len(self.keep) - 1, most).astype(int))
        return _selected(self, chosen)


def _selected(problem: Problem, chosen: Array) -> Problem:
    """A problem with only some of its lanes, and parts with no others."""
    lanes = problem.keep[chosen]
    parts, at = [], 0
    for part in problem.parts:
        count = part.inputs["P"].shape[1]
        own = lanes[(lanes >= at) & (lanes < at + count)] - at
        at += count
        if len(own):
            parts.append(_lanes(part, own, count))
    return Problem(
        problem.role, tuple(parts), False, problem.target[:, chosen], problem.noise[:, chosen],
        problem.lambert[:, chosen], np.arange(len(chosen)), problem.gain,
    )  # fmt: skip


def _beside(values: Sequence[Any], counts: Sequence[int]) -> Any:
    """Values of several parts with their lanes one after the other."""
    wide = [np.broadcast_to(value, (*np.shape(value)[:-1], count)) for value, count in zip(values, counts, strict=True)]
    return np.concatenate(wide, axis=-1)


def _lanes(part: Part, own: Array, count: int) -> Part:
    def cut(values: Mapping[str, Any]) -> dict[str, Any]:
        return {
            name: value[..., own] if np.ndim(value) and np.shape(value)[-1] == count else value
            for name, value in values.items()
        }

    return part._replace(inputs=cut(part.inputs), light=cut(part.light), values=cut(part.values))


def of_thickness(scene: MeasuredScene) -> Problem:
    """Thickness towards each light, in parts of its mean, where light has matter to pass."""
    at = points(scene)
    parts = tuple(_part(scene, at, direction, np.ones((3, 1))) for direction in _directions(scene))
    exact = np.concatenate([np.asarray(part.values["exact_length"]) for part in parts])[None]
    keep = np.flatnonzero(exact[0] > 1e-4 * max(float(exact.max(initial=0.0)), 1e-12))
    if not len(keep):
        raise failure(f"no light passes through the body of '{scene.name}'", "light it from behind, too")
    gain = 1.0 / float(exact[:, keep].mean())
    target = gain * exact[:, keep]
    nothing = np.zeros_like(target)
    return Problem("thickness", parts, False, target, nothing, nothing, keep, gain)


def of_light(scene: MeasuredScene, seen: Sequence[Seen]) -> Problem | None:
    """The light that comes through where a light is behind; None where none is."""
    at = points(scene)
    parts = [_part(scene, at, direction, np.ones((3, 1))) for direction in _directions(scene)]
    facing = np.concatenate([np.einsum("cn,cn->n", at.inputs["N"], part.light["L"]) for part in parts])
    keep = np.flatnonzero(facing <= 0.0)
    target, noise = (np.concatenate([one[k] for one in seen], axis=1)[:, keep] for k in (0, 1))
    if not len(keep) or not target.any():
        return None
    gain = exposure(target)
    lambert = np.zeros_like(target)
    return Problem("translucency", tuple(parts), False, gain * target, gain * noise, lambert, keep, gain)


def of_material(scene: MeasuredScene, seen: Sequence[Seen], summed: bool) -> Problem:
    """All light that leaves the surface; the lights' together where `summed`, else one by one."""
    at = points(scene)
    parts, front, colored = [], [], []
    for light, direction, (mean, error) in zip(scene.lights, _directions(scene), seen, strict=True):
        color = np.array(light.color)[:, None] if summed else np.ones((3, 1))
        part = _part(scene, at, direction, color)
        facing = np.maximum(np.einsum("cn,cn->n", at.inputs["N"], part.light["L"]), 0.0)
        parts.append(part)
        front.append(color * facing * _visible(scene, at, direction))
        colored.append((color * mean, color * error))
    if summed:
        target = np.sum([mean for mean, _ in colored], axis=0)
        noise = np.sqrt(np.sum([error**2 for _, error in colored], axis=0))
        lambert = np.sum(front, axis=0)
    else:
        target, noise = (np.concatenate([one[k] for one in colored], axis=1) for k in (0, 1))
        lambert = np.concatenate(front, axis=1)
    gain = exposure(target)
    keep = np.arange(target.shape[1])
    return Problem("material", tuple(parts), summed, gain * target, gain * noise, gain * lambert, keep, gain)


def exposure(target: Array) -> float:
    """What brings all but the brightest hundredth of a reference below WHITE: the same for whatever is compared."""
    bright = float(np.percentile(target.max(axis=0), 99.0))
    return WHITE / bright if bright > 0.0 else 1.0


def of_coordinates(scene: MeasuredScene) -> Problem:
    """Where refraction says that the inlay is seen, in depths along T and B from the point itself."""
    at = points(scene)
    found = refraction.seen(scene, at)
    keep = np.flatnonzero(found.hit)
    if not len(keep):
        raise failure(f"no ray meets the inlay of '{scene.name}'", "it lies deeper than the body is thick")
    inputs = {**at.inputs, "uv": np.zeros_like(at.inputs["uv"])}
    assert scene.inlay is not None
    # with uv 0 at each point and one uv a depth, what comes out is the way in depths
    values = {
        **scene.inlay.parameters, "uv_per_unit": np.full((2, 1), 1.0 / found.depth),
        "depth 1": 1.0, "eta": scene.inlay.outside_ior / scene.inlay.ior,
    }  # fmt: skip
    part = Part(inputs, {}, values, {}, np.ones((3, 1)))
    target = found.offset[:, keep] / found.depth
    nothing = np.zeros_like(target)
    return Problem("coordinates", (part,), False, target, nothing, nothing, keep)


def _part(scene: MeasuredScene, at: Points, direction: tuple[float, float, float], color: Array) -> Part:
    body, light = scene_inputs.of_scene(scene), scene_inputs.of_light(scene, direction)
    return Part(
        {**at.inputs, **body.inputs}, at.light(direction), {**body.values, **light.values},
        {**body.textures, **light.textures}, color,
    )  # fmt: skip


def _visible(scene: MeasuredScene, at: Points, direction: tuple[float, float, float]) -> Array:
    """Whether nothing stands between a point that faces the light and the light: the engine's shadow, (n,)."""
    place = np.ascontiguousarray((at.inputs["P"] + 1e-4 * at.inputs["N"]).T)
    way = np.broadcast_to(np.array(direction), place.shape).copy()
    return (thickness(scene.geometry, place, way) < 1e-3).astype(float)


def _directions(scene: MeasuredScene) -> list[tuple[float, float, float]]:
    return [light.direction for light in scene.lights if light.direction is not None]
