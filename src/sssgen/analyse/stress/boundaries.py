"""Boundary values of each input: 0, -0, the smallest numbers, 1, the contract's ends; in pairs, and all at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

import numpy as np

from sssgen.analyse.stress.contract_inputs import (
    DTYPES,
    clamp_alpha,
    contract,
    fixed_value,
    is_direction,
    sample_inputs,
    texture,
    whole_range,
)
from sssgen.analyse.stress.subject import Specimen
from sssgen.analyse.stress.trial import BOUNDARY, OUTSIDE, Trial
from sssgen.ir.formats import FLOAT32, Format
from sssgen.ir.types import Matrix, Sampler, kind_of
from sssgen.run.backends import Array
from sssgen.run.evaluate.evaluation import Inputs, shape_of
from sssgen.targets.runtime.numpy_textures import Texture

MIXED = 4096
"""The number of lanes in which every input has a boundary value."""

_AXES = np.array([[0, 0, 1], [0, 0, -1], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0.6, 0, 0.8]], np.float32)


def trials(specimen: Specimen, seed: int, format: Format = FLOAT32) -> Iterator[Trial]:
    """Boundary values in the contract, and then beyond it, where faults are reported but do not count."""
    rng = np.random.default_rng([seed, 1])
    for name, beyond in ((BOUNDARY, False), (OUTSIDE, True)):
        by_input = {input_name: values(specimen, input_name, beyond, format) for input_name in specimen.subject.params}
        edges = {input_name: edge_values for input_name, edge_values in by_input.items() if edge_values is not None}
        if edges:
            yield Trial(name, specimen, _pairs(specimen, edges, rng), counts=not beyond, ranged=not beyond)
            yield Trial(name, specimen, _mix(specimen, edges, rng, format), counts=not beyond, ranged=not beyond)


def values(specimen: Specimen, name: str, beyond: bool = False, format: Format = FLOAT32) -> Array | None:
    """The boundary values of an input, lanes last; None for a texture and for a uniform that a material fixes."""
    param, uniform = specimen.subject.params[name], specimen.subject.uniforms.get(name)
    if isinstance(param.type, Sampler) or name in specimen.settings:
        return None
    if kind_of(param.type) != "float":
        low, high = whole_range(param, uniform)
        chosen = [low - 1, 0, high + 1] if beyond and kind_of(param.type) == "int" else [low, low + 1, high]
        return _splat(np.array(chosen).astype(DTYPES[kind_of(param.type)]), shape_of(param.type))
    ends = contract(specimen, name, format)
    shape = shape_of(param.type)
    if is_direction(name, ends) and shape == (3,):
        axes = _AXES.T
        lengths = (2.0, 100.0, 1e4) if beyond else (1.0, 0.0, 1e-45, 1e-38, 1e-20, 1e-4, 0.5, ends.length)
        return np.concatenate([axes * np.float32(length) for length in lengths], axis=1)
    if isinstance(param.type, Matrix):
        return _matrices(shape[0], ends.high * (10.0 if beyond else 1.0))
    if beyond:
        return _splat(np.array(_outer_values(ends.low, ends.high)), shape)
    return clamp_alpha(uniform, _splat(np.array(_inner_values(ends.low, ends.high)), shape))


def _inner_values(low: float, high: float) -> list[float]:
    special = [0.0, -0.0, 1e-45, -1e-45, 1.2e-38, 1e-20, -1e-20, 1e-6, -1e-6, 0.5, 1.0, -1.0, 1e6, -1e6]
    return [low, high, *(value for value in special if low <= value <= high)]


def _outer_values(low: float, high: float) -> list[float]:
    step = max(abs(high), abs(low)) * 1e-3
    candidates = [high + step, low - step, 10.0 * high, 10.0 * low, -high, -1.0]
    return [value for value in dict.fromkeys(candidates) if not low <= value <= high and abs(value) < 3e38] or [high]


def _splat(numbers: Array, shape: tuple[int, ...]) -> Array:
    """Each number in all components and, for a vector, also in one component with the others 0."""
    numbers = numbers.astype(np.float32) if numbers.dtype.kind == "f" else numbers
    if not shape:
        return numbers
    uniform = np.broadcast_to(numbers, (*shape, len(numbers)))
    single = np.zeros((*shape, len(numbers)), numbers.dtype)
    single[np.arange(len(numbers)) % shape[0], np.arange(len(numbers))] = numbers
    return np.concatenate([uniform, single], axis=-1)


def _matrices(size: int, largest: float) -> Array:
    identity = np.eye(size, dtype=np.float32)
    matrices = [
        identity,
        -identity,
        0.0 * identity,
        largest * identity,
        np.full_like(identity, largest),
        1e-20 * identity,
        np.ones_like(identity),
    ]
    return np.stack(matrices, axis=-1).astype(np.float32)


def _pairs(specimen: Specimen, edges: dict[str, Array], rng: np.random.Generator) -> Inputs:
    """Each pair of inputs with each pair of their values; the other inputs have their defaults or random values."""
    names = list(edges)
    lanes: dict[str, list[Array]] = {name: [] for name in names}
    for first, second in list(combinations(names, 2)) or [(names[0], names[0])]:
        first_count, second_count = edges[first].shape[-1], edges[second].shape[-1]
        chosen = {
            first: np.repeat(np.arange(first_count), second_count),
            second: np.tile(np.arange(second_count), first_count),
        }
        for name in names:
            indices = (
                chosen[name] if name in chosen else rng.integers(0, edges[name].shape[-1], first_count * second_count)
            )
            lanes[name].append(edges[name][..., indices])
    joined = {name: np.concatenate(parts, axis=-1) for name, parts in lanes.items()}
    count = next(iter(joined.values())).shape[-1]
    half: Array = np.less(rng.random(count), 0.5)
    for name in (
        specimen.subject.uniforms.keys() & joined.keys()
    ):  # the other uniforms have their defaults in half of the lanes
        keep = half & ~np.isin(np.arange(count), _lanes_of(names, edges, name))
        joined[name][..., keep] = fixed_value(specimen, name)
    return _with_rest(specimen, joined, rng)


def _lanes_of(names: Sequence[str], edges: dict[str, Array], name: str) -> Array:
    """The lanes in which `name` is one of the pair."""
    lanes, start = [np.zeros(0, np.int64)], 0
    for first, second in list(combinations(names, 2)) or [(names[0], names[0])]:
        count = edges[first].shape[-1] * edges[second].shape[-1]
        if name in (first, second):
            lanes.append(np.arange(start, start + count))
        start += count
    return np.concatenate(lanes)


def _mix(specimen: Specimen, edges: dict[str, Array], rng: np.random.Generator, format: Format) -> Inputs:
    """Boundary values of all inputs; in a fifth of the lanes an input has a random value instead."""
    random = sample_inputs(specimen, MIXED, rng, format).values
    mixture: dict[str, Array] = {}
    for name, edge_values in edges.items():
        edge = edge_values[..., rng.integers(0, edge_values.shape[-1], MIXED)]
        mixture[name] = np.where(rng.random(MIXED) < 0.2, random[name], edge)
    return _with_rest(specimen, mixture, rng)


def _with_rest(specimen: Specimen, values: dict[str, Array], rng: np.random.Generator) -> Inputs:
    """The values with textures and the uniforms that the material fixes."""
    textures: dict[str, Texture] = {}
    lanes = next(iter(values.values())).shape[-1]
    for name, param in specimen.subject.params.items():
        if isinstance(param.type, Sampler):
            textures[name] = texture(specimen.subject.uniforms.get(name), param.type.dim, rng)
        elif name not in values:
            values[name] = fixed_value(specimen, name)
    return Inputs(values, textures, lanes)
