"""Integrals from few evaluations of a distance: their errors compared with the full integral, and their cost.

Errors are root mean squares over points that rays find on shapes, relative to the root mean square of the value.
`python tests/techniques/test_fewer_evaluations.py` prints them beside those of the techniques with even steps.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest

from ir_interpreter import Interpreter
from oracle import Array, rng, technique, unit, units
from sssgen.ir import nodes as ir
from sssgen.ir.nodes import Module
from sssgen.ir.transform import rewrite_module
from sssgen.run.evaluate.probes import subject
from sssgen.scene.geometry import Ball, Box, Geometry, Slab, Torus

REACH, WAY = 0.4, 2.0
TWO_BALLS_AND_A_WALL = """
float two_balls_and_a_wall(world_position p) {
    float balls = length(vec3(p.x, abs(p.y) - 0.4, p.z)) - 0.3;
    vec3 q = abs(p - vec3(0.5, 0.0, 0.0)) - vec3(0.075, 0.6, 0.25);
    return min(balls, length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0));
}
"""


class Shape(NamedTuple):
    """A body with a distance in the language and in the harness."""

    body: Geometry
    function: str
    values: dict[str, Any]


SHAPES = {
    "ball": Shape(Ball(0.3), "sphere", {"radius": 0.3}),
    "slab": Shape(Slab(1.2, 1.2, 0.3), "box", {"half_size": (0.6, 0.6, 0.15)}),
    "cube": Shape(Box((1.0, 1.0, 1.0)), "box", {"half_size": (0.5, 0.5, 0.5)}),
    "torus": Shape(Torus(0.5, 0.2), "torus", {"ring_radius": 0.5, "tube_radius": 0.2}),
}
shapes = pytest.mark.parametrize("name", SHAPES)


class Points(NamedTuple):
    """Points on a surface, each with a light."""

    P: Array
    N: Array
    L: Array


@cache
def points(name: str, count: int = 150) -> Points:
    """Points that rays from eight sides hit; most lights are behind."""
    eyes = 4.0 * units(8)
    aimed = rng(3).uniform(-0.6, 0.6, (8, count // 4, 3))
    hits = [SHAPES[name].body.hits(eye, unit(at - eye)) for eye, at in zip(eyes, aimed, strict=True)]
    p = np.concatenate([eye_hits.position[eye_hits.hit] for eye_hits in hits])
    n = np.concatenate([eye_hits.normal[eye_hits.hit] for eye_hits in hits])
    p, n = p[:count], n[:count]
    light = units(len(p), 9)
    before = (n * light).sum(axis=1) > 0.0
    light[before & (rng(4).random(len(p)) < 0.7)] *= -1.0
    return Points(p, n, light)


def relative_error(result: Array, right: Array) -> float:
    """The error, relative to the exact values."""
    return float(np.sqrt(((result - right) ** 2).mean() / (right**2).mean()))


def thinness(name: str, method: str, taps: int) -> Array:
    shape, (p, n, _) = SHAPES[name], points(name)
    function: Array = technique(method, body_distance=shape.function)(P=p, N=n, reach=REACH, taps=taps, **shape.values)
    return function


@cache
def integral(name: str) -> Array:
    """The integral that the taps approximate, with their clamping, by 4000 midpoints; 1 in empty space."""
    body, (p, n, _) = SHAPES[name].body, points(name)
    depths = REACH * (np.arange(4000) + 0.5) / 4000
    result: Array = sum(np.clip(d + body.distance(p - n * d), 0.0, 2.0 * d) for d in depths) / 4000 / REACH
    return result


def marched(name: str, method: str, steps: int) -> Array:
    shape, (p, _, light) = SHAPES[name], points(name)
    function: Array = technique(method, body_distance=shape.function)(
        P=p, L=light, reach=WAY, steps=steps, **shape.values
    )
    return function


class CountingInterpreter(Interpreter):
    """Runs a technique for one point with real branches, and counts its evaluations of the distance."""

    def __init__(self, module: Module, values: dict[str, Any], slot: str, body: Geometry) -> None:
        super().__init__(module, values)
        self.slot, self.body = slot, body
        self.count = 0

    def called(self, call: ir.Call) -> Any:
        if self.functions[call.function].name != self.slot:
            return super().called(call)
        self.count += 1
        return float(self.body.distance(np.array([self.value(call.args[0])]))[0])


@cache
def linked(method: str, function: str) -> tuple[Module, str, tuple[str, ...]]:
    """The technique with its slot bound, without assumptions; its key; the names of its parameters."""
    result = subject(method, {"body_distance": function})
    bare = rewrite_module(result.module, lambda expr: expr, lambda stmt: () if isinstance(stmt, ir.Assume) else None)
    (chosen,) = [function for function in bare.functions if function.name == method]
    return bare, chosen.key, tuple(param.name for param in chosen.params)


def evaluations(method: str, name: str, **values: Any) -> float:
    """The mean number of evaluations of the distance per point."""
    shape, places = SHAPES[name], points(name)._asdict()
    module, key, params = linked(method, shape.function)
    uniforms = {uniform.name: uniform.default[0] for uniform in module.uniforms if len(uniform.default) == 1} | values
    run = CountingInterpreter(module, uniforms, shape.function, shape.body)
    chosen = range(0, len(places["P"]), 3)
    for at in chosen:
        run.call(key, *[tuple(map(float, places[param][at])) for param in params])
    return run.count / len(chosen)


# Thinness


@shapes
def test_four_taps_equal_the_integral(name: str) -> None:
    assert relative_error(thinness(name, "thinness_traced", 4), integral(name)) <= 0.01
    assert relative_error(thinness(name, "thinness_uniform", 29), integral(name)) > 0.01


@shapes
def test_taps_are_counted(name: str) -> None:
    """At most four taps; one tap in the middle of a thick body."""
    assert evaluations("thinness_traced", name, reach=REACH, taps=4) <= 4.0
    deep = technique("thinness_traced", body_distance="ground_plane")
    assert evaluations("thinness_traced", "ball", reach=0.2, taps=4) == 1.0
    assert deep(P=np.zeros(3), N=np.array([0.0, 1.0, 0.0])) == 0.0


@pytest.mark.parametrize("taps", [1, 2, 3, 5, 16])
@pytest.mark.parametrize("width", [0.05, 0.3, 0.79, 0.9])
def test_a_wide_slab_needs_one_tap(taps: int, width: float) -> None:
    """The value is (1 - D / (2 reach))^2 if the slope is 2 everywhere, also with the last tap on the surface."""
    across = {"center": (0.0, -width / 2, 0.0), "half_size": (50.0, width / 2, 50.0)}
    up = np.array([0.0, 1.0, 0.0])
    function = technique("thinness_traced", body_distance="box")(P=np.zeros(3), N=up, reach=REACH, taps=taps, **across)
    assert function == pytest.approx(max(1.0 - width / (2.0 * REACH), 0.0) ** 2, abs=1e-12)


@pytest.mark.parametrize("outside", [-9e-4, 5e-4, 1e-3])
def test_hits_off_the_surface_add_no_noise(outside: float) -> None:
    """A raymarched hit is within its tolerance of the surface, which must not add noise."""
    p, n, _ = points("cube")
    function = technique("thinness_traced", body_distance="box")
    result = function(P=p + outside * n, N=n, reach=REACH, **SHAPES["cube"].values)
    assert np.abs(result - integral("cube")).max() < 0.01


def test_bent_normals_converge() -> None:
    """With normals that a normal map bends, the error decreases with more taps."""
    p, n, _ = points("torus")
    bent = unit(n + 0.3 * units(len(n), 5))
    body = SHAPES["torus"].body
    depths = REACH * (np.arange(4000) + 0.5) / 4000
    right = sum(np.clip(d + body.distance(p - bent * d), 0.0, 2.0 * d) for d in depths) / 4000 / REACH
    function = technique("thinness_traced", body_distance="torus")
    errors = [
        relative_error(function(P=p, N=bent, reach=REACH, taps=taps, **SHAPES["torus"].values), right)
        for taps in (2, 4, 8, 16)
    ]
    assert errors[0] > errors[1] > errors[2] > errors[3] and errors[1] < 0.02 and errors[3] < 0.005, errors


# The march to the light


@shapes
def test_a_traced_march_is_more_accurate_with_fewer_evaluations(name: str) -> None:
    right = marched(name, "march_light", 4000)
    assert relative_error(marched(name, "march_light_traced", 16), right) <= 0.01
    assert relative_error(marched(name, "march_light", 32), right) > 0.015
    assert evaluations("march_light_traced", name, reach=WAY, steps=16) < 15.0


@pytest.mark.slow
def test_a_traced_march_improves_the_front() -> None:
    """With the same number of evaluations, at least 7, the error over all shapes is little more than half."""

    def count_and_error(method: str, steps: int) -> tuple[float, float]:
        errors = [relative_error(marched(name, method, steps), marched(name, "march_light", 4000)) for name in SHAPES]
        counts = [evaluations(method, name, reach=WAY, steps=steps) for name in SHAPES]
        return float(np.mean(counts)), float(np.mean(errors))

    traced = [count_and_error("march_light_traced", steps) for steps in (4, 6, 8, 12, 16)]
    for count, error in [count_and_error("march_light", steps) for steps in (8, 12, 16, 24, 32)]:
        assert min(result for evaluated, result in traced if evaluated <= count) < 0.6 * error


def test_a_body_of_several_parts() -> None:
    """Two balls and a wall: gaps do not count, the matter behind them counts."""
    p = 0.3 * units(150) + np.where(units(150)[:, 1:2] > 0.0, 1.0, -1.0) * [0.0, 0.4, 0.0]
    light = units(150, 9)
    even = technique("march_light", body_distance=TWO_BALLS_AND_A_WALL)
    traced = technique("march_light_traced", body_distance=TWO_BALLS_AND_A_WALL)
    right = even(P=p, L=light, steps=4000)
    assert (
        relative_error(traced(P=p, L=light, steps=24), right)
        < 0.02
        < relative_error(even(P=p, L=light, steps=32), right)
    )


@pytest.mark.parametrize("method", ["march_light", "march_light_traced"])
@pytest.mark.parametrize("steps", [1, 16])
def test_a_march_ends_if_no_matter_can_follow(method: str, steps: int) -> None:
    """Away from the body, the march ends if a distance exceeds the rest of the way."""
    function = technique(method, body_distance="ground_plane")
    up = np.array([0.0, 1.0, 0.0])
    assert function(P=up * 0.0, L=up, steps=steps) == 0.0
    assert function(P=up * 0.0, L=-up, steps=steps) == pytest.approx(WAY, rel=1e-12)
    assert evaluations(method, "ball", reach=0.01, steps=steps) <= steps + 2


def table() -> str:
    lines = ["Thinness: error % (rms) on " + ", ".join(SHAPES) + "; evaluations"]
    for method, settings in (("thinness_uniform", (3, 4, 5, 6, 8, 29)), ("thinness_traced", (3, 4, 5, 6, 8))):
        for taps in settings:
            errors = [100.0 * relative_error(thinness(name, method, taps), integral(name)) for name in SHAPES]
            counts = np.mean([evaluations(method, name, reach=REACH, taps=taps) for name in SHAPES])
            lines.append(f"  {method:19}{taps:3}" + "".join(f"{error:8.2f}" for error in errors) + f"{counts:8.1f}")
    lines.append("March: error % (rms); evaluations")
    for method in ("march_light", "march_light_traced"):
        for steps in (2, 4, 6, 8, 12, 16, 24, 32):
            errors = [
                100.0 * relative_error(marched(name, method, steps), marched(name, "march_light", 4000))
                for name in SHAPES
            ]
            counts = np.mean([evaluations(method, name, reach=WAY, steps=steps) for name in SHAPES])
            lines.append(f"  {method:19}{steps:3}" + "".join(f"{error:8.2f}" for error in errors) + f"{counts:8.1f}")
    return "\n".join(lines)


if __name__ == "__main__":
    print(table())
