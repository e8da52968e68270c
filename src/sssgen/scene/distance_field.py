"""Geometry from a distance function of the library, or of a technique file: sphere tracing on the CPU.

The numpy target compiles the function to Python, with the parameters folded in; it runs in float64.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from sssgen.ir.nodes import Function, Module, Uniform
from sssgen.ir.types import Sampler
from sssgen.lang.check.module_checker import check
from sssgen.lang.syntax.parser import parse
from sssgen.material import library, slots
from sssgen.material.values import WrongValue, read_value
from sssgen.passes.fold import fold
from sssgen.passes.link import LinkInput, link
from sssgen.pipeline.compiler import transpile
from sssgen.scene.arrays import Array, Bools
from sssgen.scene.geometry_base import Geometry, Hits, planar, spherical, spread, tangent_of, unit
from sssgen.support.diagnostics import SssgenError, did_you_mean, failure
from sssgen.support.file_memo import CachedResult, remember
from sssgen.targets.runtime.numpy_values import precision

PROJECTIONS = {"spherical": spherical, "planar": planar}
"""Points (n, 3) → their uv (n, 2) and the gradients of u and of v, (n, 3) each, up to a positive factor."""

MOST_FUNCTIONS = 32
"""The number of compiled functions that are kept in memory until their files change."""
_functions: dict[str, CachedResult] = {}

_STEPS = 1000
BISECTION_STEPS = 80
"""Enough for the last bit."""
_SHORTEST = 1e-4
"""The shortest step, relative to `reach`: thinner parts may be missed."""


@dataclass(frozen=True)
class Distance(Geometry):
    """The zero set of a distance function, within a ball about the origin.

    The function is `NAME`, `NAME:FUNCTION`, `FILE` or `FILE:FUNCTION`, as in a material's `bind`: it takes one
    position, in this geometry's object space, and must not grow faster than the distance does. uv are longitude and
    latitude about the origin (`spherical`), or x and y (`planar`).
    """

    technique: str = "sphere"
    folder: str = ""
    """The folder where files are searched for before the library."""
    parameters: Mapping[str, object] = field(default_factory=dict)
    """The function's uniforms → TOML values as in a material; the others have their defaults."""
    reach: float = 4.0
    """The ball's radius, in units of object space."""
    projection: str = "spherical"

    def cast(self, origin: Array, directions: Array) -> Hits:
        t, hit = self._march(origin, directions)
        position = origin + t[hit, None] * directions[hit]
        normal = self._gradient(position)
        uv, grows_u, grows_v = PROJECTIONS[self.projection](position)
        return spread(hit, position, normal, tangent_of(normal, grows_u, grows_v), uv)

    def distance(self, points: Array) -> Array:
        """Raises SssgenError for a function that is missing, faulty, or not a distance function."""
        if not len(points):  # the emitted functions need at least one point
            return np.zeros(0)
        distance: Array = np.broadcast_to(np.asarray(self.function(points.T), np.float64), len(points))
        return distance

    @cached_property
    def function(self) -> Callable[[Array], Any]:
        """The function on points (3, n). Raises SssgenError."""
        key = repr((self.technique, self.folder, self.parameters))
        return remember(_functions, key, self._compile, MOST_FUNCTIONS)

    def _compile(self) -> Callable[[Array], Any]:
        module, function = find_function(self.technique, self.folder)
        values = _values(self.technique, uniforms_of(module, function), self.parameters)
        linked = link([LinkInput(function.name, "", module, function, {}, values, frozenset(values))])
        compiled = transpile(fold(linked.module, linked.fixed), "numpy", function.name)
        namespace: dict[str, Any] = {}
        exec(compiled.files[f"{function.name}_functions.py"], namespace)
        code = namespace[compiled.reflection["renames"].get(function.name, function.name)]

        def run(points: Array) -> Any:
            with precision(np.float64):
                return code(points)

        return run

    def _march(self, origin: Array, directions: Array) -> tuple[Array, Bools]:
        """The distance along each ray to the first change of sign, (n,), and whether there is one, (n,)."""
        nearest = -directions @ origin
        closest = origin + nearest[:, None] * directions
        half = self.reach**2 - np.einsum("nc,nc->n", closest, closest)
        end = nearest + np.sqrt(np.maximum(half, 0.0))
        previous = np.maximum(nearest - np.sqrt(np.maximum(half, 0.0)), 0.0)
        hit = np.zeros(len(directions), np.bool_)
        active = np.flatnonzero((half > 0.0) & (end > 0.0))
        t = previous.copy()
        inside = np.zeros(len(directions), np.bool_)
        inside[active] = self._at(origin, directions, t, active) < 0.0
        for _ in range(_STEPS):
            if not len(active):
                break
            value = self._at(origin, directions, t, active)
            crossed = (value < 0.0) != inside[active]
            hit[active[crossed]] = True
            continues = ~crossed & (t[active] < end[active]) & np.isfinite(value)
            active, value = active[continues], value[continues]
            previous[active] = t[active]
            t[active] = np.minimum(t[active] + np.maximum(np.abs(value), _SHORTEST * self.reach), end[active])
        t[hit] = self.bisect(origin, directions[hit], previous[hit], t[hit])
        return t, hit

    def bisect(self, origins: Array, directions: Array, low: Array, high: Array) -> Array:
        """The distance along each ray at which the sign changes, exact to the last bit, between `low` and `high`."""
        negative = self.distance(origins + low[:, None] * directions) < 0.0
        for _ in range(BISECTION_STEPS):
            middle = 0.5 * (low + high)
            if np.all((middle <= low) | (middle >= high)):
                break
            same_sign = (self.distance(origins + middle[:, None] * directions) < 0.0) == negative
            low, high = np.where(same_sign, middle, low), np.where(same_sign, high, middle)
        return high

    def _at(self, origin: Array, directions: Array, t: Array, rays: Any) -> Array:
        return self.distance(origin + t[rays, None] * directions[rays])

    def _gradient(self, points: Array) -> Array:
        """Unit normals by central differences; +z where there is no gradient."""
        step = 1e-5 * self.reach
        slopes = [self.distance(points + step * axis) - self.distance(points - step * axis) for axis in np.eye(3)]
        normal = unit(np.nan_to_num(np.stack(slopes, axis=1)))
        return np.where((normal == 0.0).all(axis=1, keepdims=True), [0.0, 0.0, 1.0], normal)


def find_function(technique: str, folder: str) -> tuple[Module, Function]:
    """The distance function that a scene names, and its module. Raises SssgenError."""
    file = technique if technique.endswith((".sss", ".glsl")) else technique.rpartition(":")[0]
    if file.endswith((".sss", ".glsl")):
        roots = (folder, library.TECHNIQUES)
        if not any(os.path.isfile(os.path.join(root, file)) for root in roots):
            raise failure(f"cannot find the file '{file}'", "it is searched for next to the scene and in the library")
    try:
        module, function = slots.find(technique, _slot("world_position"), folder)
    except SssgenError as error:
        try:
            module, function = slots.find(technique, _slot("object_position"), folder)
        except SssgenError:
            raise error from None
    unbound = slots.needs(module, function)[1]
    if unbound:
        message = f"'{technique}' has the slot '{unbound[0].name}', which a scene cannot bind"
        raise failure(message, "write a function in a file that calls it")
    textures = [name for name, uniform in uniforms_of(module, function).items() if isinstance(uniform.type, Sampler)]
    if textures:
        raise failure(f"'{technique}' reads the texture '{textures[0]}', which a scene's geometry cannot have")
    return module, function


def uniforms_of(module: Module, function: Function) -> dict[str, Uniform]:
    """The parameters that a function reads, by name."""
    names, _ = slots.needs(module, function)
    return {uniform.name: uniform for uniform in module.uniforms if uniform.name in names}


def _slot(quantity: str) -> Function:
    text = f"float distance_of({quantity} p);"
    return check(parse(text, "slot.sss"), text).functions[-1]


def _values(
    technique: str, uniforms: Mapping[str, Uniform], overrides: Mapping[str, object]
) -> dict[str, tuple[float, ...]]:
    """Each parameter's value: its override, or its default."""
    values = {name: uniform.default for name, uniform in uniforms.items()}
    for name, raw in overrides.items():
        if name not in uniforms:
            hint = did_you_mean(name, uniforms) or f"parameters: {', '.join(uniforms) or 'none'}"
            raise failure(f"unknown parameter '{name}' of '{technique}'", hint)
        try:
            values[name] = read_value(uniforms[name], raw)
        except WrongValue as wrong:
            raise failure(wrong.message, wrong.hint) from None
    return values
