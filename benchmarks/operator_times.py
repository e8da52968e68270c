"""Times of chains on a GPU: what operators cost there, and whether predicted costs order chains as their times do.

`measured_device` finds the cost of each operator from the times of shaders that consist of one kind of operator
(operators/) and of whole materials. `order_of_pairs` says how often a prediction orders two chains as their times do.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np

from sssgen.lab.gpu.chart_times import EMPTY, time_points
from sssgen.lab.gpu.device_costs import OPERATORS, Device
from sssgen.lab.gpu.gpu_timing import Device as Driver
from sssgen.lab.measure.candidates import Candidate
from sssgen.lab.measure.measured_point import FittedChain
from sssgen.lab.measure.measurement import chain_of, static_cost
from sssgen.run.backends import Array
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.scene_body import body
from sssgen.support.diagnostics import failure
from sssgen.support.extras import need

PROGRAMS = Path(__file__).with_name("operators")
"""A technique for each of OPERATORS."""
ROUNDS = (64, 128)
"""The rounds of the loops in these techniques; times grow with the rounds, also where the loop itself costs time."""
TYPICAL = 10.0
"""The percentile of a chain's times that counts: other programs on the machine only lengthen times."""


class TimedChains(NamedTuple):
    """Chains with their times."""

    labels: tuple[str, ...]
    counts: tuple[Mapping[str, int], ...]
    """By the names of OPERATORS"""
    ns: Array
    """Nanoseconds per pixel, (chains, rounds), without the shader around the chain"""
    driver: Driver

    @property
    def typical(self) -> Array:
        """(chains,): the time of each chain that counts, in nanoseconds per pixel."""
        times: Array = np.percentile(self.ns, TYPICAL, axis=1)
        return times


def time_chains(
    candidates: Sequence[Candidate], scene: MeasuredScene, size: tuple[int, int], rounds: int
) -> TimedChains:
    """The times of chains with their default parameters on a scene's points. Raises SssgenError without OpenGL."""
    shape = body(scene.geometry)
    points = [_unfitted(candidate) for candidate in candidates]
    with TemporaryDirectory() as folder:
        counts = [static_cost(chain_of(candidate, shape, folder))._asdict() for candidate in candidates]
    times = time_points(scene, points, size, rounds)
    per_pixel, bare = 1e6 / (size[0] * size[1]), np.percentile(times.net_times[EMPTY], TYPICAL)
    ns = [per_pixel * (times.net_times[str(index)] - bare) for index in range(len(points))]
    labels = tuple(candidate.label for candidate in candidates)
    return TimedChains(labels, tuple(counts), np.array(ns), times.device)


def union(first: TimedChains, second: TimedChains) -> TimedChains:
    """Chains that were timed with the same rounds on the same device."""
    return TimedChains(
        first.labels + second.labels, first.counts + second.counts, np.concatenate([first.ns, second.ns]), first.driver
    )


def subset(chains: TimedChains, numbers: Sequence[int]) -> TimedChains:
    """The chains with these numbers."""
    labels, counts = (chains.labels[number] for number in numbers), (chains.counts[number] for number in numbers)
    return TimedChains(tuple(labels), tuple(counts), chains.ns[list(numbers)], chains.driver)


def _unfitted(candidate: Candidate) -> FittedChain:
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
    return str(PROGRAMS / f"{operator}.sss")


def measured_device(name: str, chains: TimedChains) -> Device:
    """The costs, at least 0, that explain the times of chains, by least squares of the relative error.

    Raises SssgenError for a program that takes no time.
    """
    nnls = need("scipy.optimize", "scipy", "chart").nnls
    times = chains.typical
    if not (times > 0.0).all():
        raise failure("a program is too fast for the clock of this device", "time a larger picture, or more rounds")
    counts = np.array([[count[operator] for operator in OPERATORS] for count in chains.counts], float)
    ns = nnls(counts / times[:, None], np.ones(len(times)))[0]
    driver = chains.driver
    return Device(name, driver.renderer, driver.version, driver.software, tuple(map(float, ns)))


class PairOrder(NamedTuple):
    """How a prediction orders pairs of chains."""

    pairs: int
    agree: int
    """The pairs whose predicted order is that of the times"""
    distinct: int
    """The pairs whose times differ by more than their spread: the 10th to 90th percentiles of the rounds are apart"""
    distinct_agree: int


def order_of_pairs(chains: TimedChains, predicted: Sequence[float]) -> PairOrder:
    """Counts the pairs of chains in the measured order. Chains that are predicted equal are not in order."""
    typical, high = chains.typical, np.percentile(chains.ns, 90.0, axis=1)
    pairs, agree, distinct, distinct_agree = 0, 0, 0, 0
    for a, b in combinations(range(len(typical)), 2):
        first, second = (a, b) if typical[a] <= typical[b] else (b, a)
        right = predicted[first] < predicted[second]
        apart = high[first] < typical[second]
        pairs, agree = pairs + 1, agree + right
        distinct, distinct_agree = distinct + bool(apart), distinct_agree + bool(apart and right)
    return PairOrder(pairs, int(agree), distinct, distinct_agree)
