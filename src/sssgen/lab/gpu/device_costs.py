"""The cost of operators on a device, measured once: nanoseconds of a chain without drawing it.

A device's file has the nanoseconds per pixel of an operation, a transcendental, a texture fetch and a distance
evaluation. `measured_device` finds them from the times of a shader for each (operators/). The predicted cost of a chain
is their sum over its static counts; `ordered` says how often it orders chains as their times do.
"""

from __future__ import annotations

import os
import tomllib
from collections.abc import Mapping, Sequence
from functools import cache
from itertools import combinations
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np

from sssgen.lab.chart.record import fronts_of
from sssgen.lab.gpu.chart_times import EMPTY, timed
from sssgen.lab.gpu.gpu_timing import Device as Driver
from sssgen.lab.measure.candidates import Candidate
from sssgen.lab.measure.measurement import chain_of, static_cost
from sssgen.run.backends import Array
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.scene_body import body
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.extras import need

FOLDER = os.path.join(os.path.dirname(__file__), "devices")
PROGRAMS = os.path.join(os.path.dirname(__file__), "operators")
OPERATORS = ("operations", "transcendentals", "fetches", "distance_evaluations")
"""The static counts of a chain that have a cost; PROGRAMS has a technique for each."""
ROUNDS = (64, 128)
"""The rounds of the loops in these techniques; times grow with the rounds, also where the loop itself costs time."""
TYPICAL = 10.0
"""The percentile of a chain's times that counts: other programs on the machine only lengthen times."""
LEAST = 1e-3
"""The least predicted cost, in nanoseconds: an empty chain costs nothing."""

Point = Mapping[str, Any]


class Device(NamedTuple):
    """What operators cost on a device."""

    name: str
    renderer: str
    driver: str
    software: bool
    """Whether it is a rasteriser on the CPU: its costs order chains there, and say nothing about GPUs"""
    ns: tuple[float, ...]
    """Nanoseconds per pixel, in the order of OPERATORS"""

    def predicted(self, cost: Mapping[str, Any]) -> float:
        """The nanoseconds per pixel of a chain with these static counts."""
        return max(sum(ns * float(cost[name]) for name, ns in zip(OPERATORS, self.ns, strict=True)), LEAST)

    def text(self) -> str:
        """The device's file."""
        lines = [
            f'renderer = "{self.renderer}"',
            f'driver = "{self.driver}"',
            f"software = {str(self.software).lower()}",
        ]
        lines += ["", "[ns]"]
        return "\n".join([*lines, *(f"{name} = {ns:.5g}" for name, ns in zip(OPERATORS, self.ns, strict=True))]) + "\n"


@cache
def names() -> tuple[str, ...]:
    """The devices with a file."""
    return tuple(sorted(file.removesuffix(".toml") for file in os.listdir(FOLDER) if file.endswith(".toml")))


def load(name: str) -> Device:
    """A device by its name, or by the path of its file. Raises SssgenError."""
    path = name if name.endswith(".toml") else os.path.join(FOLDER, f"{name}.toml")
    if not os.path.isfile(path):
        listed = f"devices: {', '.join(names())}; benchmarks/device_costs.py measures another one"
        raise failure(f"unknown device '{name}'", did_you_mean(name, names()) or listed)
    try:
        with open(path, "rb") as file:
            data = tomllib.load(file)
        ns = tuple(float(data["ns"][operator]) for operator in OPERATORS)
        about = (str(data["renderer"]), str(data["driver"]), bool(data["software"]))
    except (OSError, tomllib.TOMLDecodeError, KeyError, TypeError, ValueError) as error:
        raise failure(
            f"'{name}' is not the file of a device: {error}", "benchmarks/device_costs.py writes one"
        ) from None
    if not all(0.0 <= cost < float("inf") for cost in ns):
        raise failure(f"'{name}' has a cost below 0 or without a limit")
    return Device(os.path.basename(path).removesuffix(".toml"), *about, ns)


def by_device(record: Mapping[str, Any], device: Device) -> dict[str, Any]:
    """The record with the predicted nanoseconds as the cost, for drawing and picking."""
    points = [
        {**point, "cost": {**point["cost"], "static": point["cost"]["value"], "value": device.predicted(point["cost"])}}
        for point in record["points"]
    ]
    about = {**record["record"], "device": device.renderer, "driver": device.driver, "software": device.software}
    unit = f"ns per pixel on {device.name}, predicted"
    return fronts_of({**record, "record": about, "points": points, "cost": "device", "cost_unit": unit})


class TimedChains(NamedTuple):
    """Chains with their times."""

    labels: tuple[str, ...]
    counts: tuple[Mapping[str, int], ...]
    """By the names of OPERATORS"""
    ns: Array
    """Nanoseconds per pixel, (chains, rounds), without the shader around the chain"""
    driver: Driver


def time_chains(
    candidates: Sequence[Candidate], scene: MeasuredScene, size: tuple[int, int], rounds: int
) -> TimedChains:
    """The times of chains with their default parameters on a scene's points. Raises SssgenError without OpenGL."""
    shape = body(scene.geometry)
    points = [_unfitted(candidate) for candidate in candidates]
    with TemporaryDirectory() as folder:
        counts = [static_cost(chain_of(candidate, shape, folder))._asdict() for candidate in candidates]
    times = timed(scene, points, size, rounds)
    per_pixel, bare = 1e6 / (size[0] * size[1]), np.percentile(times.net_times[EMPTY], TYPICAL)
    ns = [per_pixel * (times.net_times[str(index)] - bare) for index in range(len(points))]
    labels = tuple(candidate.label for candidate in candidates)
    return TimedChains(labels, tuple(counts), np.array(ns), times.device)


def _unfitted(candidate: Candidate) -> dict[str, Any]:
    """The candidate as a point whose parameters have their defaults."""
    return {
        "role": candidate.role, "name": candidate.name, "label": candidate.label, "baseline": candidate.baseline,
        "settings": dict(candidate.settings), "chain": list(candidate.techniques), "path": candidate.path,
        "path_settings": dict(candidate.path_settings), "parameters": {}, "factor": "", "scale": [],
    }  # fmt: skip


def operator_chains() -> list[Candidate]:
    """Chains that consist of one kind of operator and little else, with two numbers of rounds each."""
    return [
        Candidate("translucency", name, f"{name}, {rounds} rounds", (("rounds", rounds),), (_program(name),))
        for name in OPERATORS
        for rounds in ROUNDS
    ]


def _program(operator: str) -> str:
    return os.path.join(PROGRAMS, f"{operator}.sss")


def measured_device(name: str, chains: TimedChains) -> Device:
    """The costs, at least 0, that explain the times of `operator_chains`, by least squares of the relative error."""
    nnls = need("scipy.optimize", "scipy", "chart").nnls
    times = np.percentile(chains.ns, TYPICAL, axis=1)
    if not (times > 0.0).all():
        raise failure("a program is too fast for the clock of this device", "time a larger picture, or more rounds")
    counts = np.array([[count[operator] for operator in OPERATORS] for count in chains.counts], float)
    ns = nnls(counts / times[:, None], np.ones(len(times)))[0]
    driver = chains.driver
    return Device(name, driver.renderer, driver.version, driver.software, tuple(map(float, ns)))


class Ordered(NamedTuple):
    """How a prediction orders pairs of chains."""

    pairs: int
    agree: int
    """The pairs whose predicted order is that of the times"""
    distinct: int
    """The pairs whose times differ by more than their spread: the 10th to 90th percentiles of the rounds are apart"""
    distinct_agree: int


def ordered(chains: TimedChains, predicted: Sequence[float]) -> Ordered:
    """Counts the pairs of chains in the measured order. Chains that are predicted equal are not in order."""
    typical, high = np.percentile(chains.ns, [TYPICAL, 90.0], axis=1)
    pairs, agree, distinct, distinct_agree = 0, 0, 0, 0
    for a, b in combinations(range(len(typical)), 2):
        first, second = (a, b) if typical[a] <= typical[b] else (b, a)
        right = predicted[first] < predicted[second]
        apart = high[first] < typical[second]
        pairs, agree = pairs + 1, agree + right
        distinct, distinct_agree = distinct + bool(apart), distinct_agree + bool(apart and right)
    return Ordered(pairs, int(agree), distinct, distinct_agree)
