"""Random inputs over the whole contract, in float32, fast: most of ordinary size, many at and near special values.

Unlike `samples`, which draws what scenes contain, it covers everything that `ir.contracts` allows.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from sssgen.analyse.stress.subject import Specimen
from sssgen.ir import contracts
from sssgen.ir.formats import FLOAT32, Format
from sssgen.ir.nodes import Param, Uniform
from sssgen.ir.types import Matrix, Sampler, kind_of
from sssgen.ir.vector_ranges import LENGTH, Contract
from sssgen.run.backends import Array
from sssgen.run.evaluate.evaluation import Inputs, default_of, shape_of
from sssgen.targets.runtime.numpy_textures import Texture

TINY = 1e-45
"""The smallest random number: float32's smallest subnormal."""
ORDINARY = 2.0
"""In a wide range half of the numbers are at most this large."""
TEXELS = 16
DTYPES: dict[str, Any] = {"float": np.float32, "int": np.int32, "uint": np.uint32, "bool": np.bool_}
"""The types of inputs."""


def sample_inputs(specimen: Specimen, lanes: int, rng: np.random.Generator, format: Format = FLOAT32) -> Inputs:
    """`lanes` random inputs of the contract; integers and textures are the same for all lanes, as in a draw call."""
    values: dict[str, Array] = {}
    textures: dict[str, Texture] = {}
    line = _unit(rng.standard_normal((3, lanes), np.float32))
    for name, param in specimen.subject.params.items():
        uniform = specimen.subject.uniforms.get(name)
        if isinstance(param.type, Sampler):
            textures[name] = texture(uniform, param.type.dim, rng)
        elif name in specimen.settings:
            values[name] = fixed_value(specimen, name)
        elif kind_of(param.type) == "float":
            size = (*shape_of(param.type), lanes)
            values[name] = _floats(size, contract(specimen, name, format), param, uniform, line, rng)
        else:
            values[name] = _whole(param, uniform, rng)
    return Inputs(values, textures, lanes)


def contract(specimen: Specimen, name: str, format: Format = FLOAT32) -> Contract:
    """The contract of an input."""
    uniform = specimen.subject.uniforms.get(name)
    if uniform is not None:
        return contracts.of_uniform(uniform, format)
    return contracts.of_param(specimen.subject.params[name], format, specimen.subject.chained)


def outer_contract(specimen: Specimen, name: str, format: Format = FLOAT32) -> Contract:
    """The range of an input if the caller does not keep quantities in their ranges."""
    if name in specimen.subject.uniforms:
        return contract(specimen, name, format)
    return contracts.from_outside(specimen.subject.params[name], format, specimen.subject.chained)


def fixed_value(specimen: Specimen, name: str) -> Array:
    """A uniform's value in this material or technique, one lane."""
    uniform = specimen.subject.uniforms[name]
    value = np.array(specimen.settings.get(name, uniform.default), np.float64)
    return value.reshape(*shape_of(uniform.type), 1).astype(DTYPES[kind_of(uniform.type)])


def whole_range(param: Param, uniform: Uniform | None) -> tuple[int, int]:
    """The whole numbers that make sense for an input."""
    if kind_of(param.type) == "bool":
        return 0, 1
    if uniform is None or "hint_range" not in dict(uniform.hints):
        return 0, 9
    ends = contracts.of_uniform(uniform)
    return int(ends.low), int(ends.high)


def is_direction(name: str, ends: Contract) -> bool:
    """Whether an input is a direction."""
    return ends.length == LENGTH


def _floats(
    size: tuple[int, ...], ends: Contract, param: Param, uniform: Uniform | None, line: Array, rng: np.random.Generator
) -> Array:
    if is_direction(param.name, ends):
        return directions(size, line, rng)
    if isinstance(param.type, Matrix) and uniform is not None:
        near = np.array(uniform.default, np.float32).reshape(*size[:-1], 1)
        moved = near + rng.uniform(-1.0, 1.0, size).astype(np.float32)
        mixture: Array = np.where(rng.random(size[-1]) < 0.5, moved, numbers(size, ends, rng))
        return mixture
    return clamp_alpha(uniform, numbers(size, ends, rng))


def clamp_alpha(uniform: Uniform | None, values: Array) -> Array:
    """Values of a colour, with its opacity clamped to 0..1."""
    alpha = contracts.alpha_at(uniform) if uniform is not None else None
    if alpha is not None:
        values[alpha] = np.clip(values[alpha], 0.0, 1.0)
    return values


def numbers(size: tuple[int, ...], ends: Contract, rng: np.random.Generator) -> Array:
    """Numbers of a range: five eighths uniform, a quarter by their logarithm, an eighth at special values."""
    low, high = ends.low, ends.high
    bits = rng.integers(0, 1 << 32, size, np.uint32)
    share = (bits >> np.uint32(8)).astype(np.float32) * np.float32(2.0**-24)
    kind = bits & np.uint32(7)
    first, last = (max(low, -ORDINARY), min(high, ORDINARY)) if high - low > 1e3 else (low, high)
    samples: Array = np.float32(first) + share * np.float32(last - first)
    small = kind >= 5
    negative = low < 0.0 and (high <= 0.0 or (bits[small] & np.uint32(8)) != 0)
    smallest, largest = np.log2(max(low, TINY)), np.log2(max(abs(low), abs(high), TINY))
    sizes = np.exp2(smallest + share[small].astype(np.float64) * (largest - smallest))
    samples[small] = np.where(negative, -sizes, sizes)
    special = kind == 7
    values = _special(low, high)
    samples[special] = values[(bits[special] >> np.uint32(8)) % np.uint32(len(values))]
    return np.clip(samples, np.float32(low), np.float32(high), out=samples)


def _special(low: float, high: float) -> Array:
    """0, -0, the smallest numbers, 1, the ends and their neighbours, as far as they are in the range."""
    inner = [0.0, -0.0, 1e-45, 1.2e-38, 1e-20, 1e-6, 0.5, 1.0 - 2.0**-24, 1.0, -1.0, -1e-45, -1e-6]
    ends = np.array([low, high], np.float32)
    return np.array(
        [*ends, *np.nextafter(ends, ends[::-1]), *(value for value in inner if low <= value <= high)], np.float32
    )


def directions(size: tuple[int, ...], line: Array, rng: np.random.Generator) -> Array:
    """Unit vectors, and shorter ones down to 0, as interpolation and missing attributes produce them.

    Many lie exactly or nearly along `line`, so that several directions of a lane are often parallel.
    """
    kind = rng.integers(0, 256, size[-1], np.uint8)
    anywhere = _unit(rng.standard_normal(size, np.float32))
    line = line[: size[0]] if size[0] <= len(line) else anywhere
    sign = np.where(rng.integers(0, 2, size[-1]) == 0, np.float32(-1.0), np.float32(1.0))
    share = rng.random(size[-1], np.float32)
    near = _unit(sign * line + np.exp2(-24.0 * share).astype(np.float32) * anywhere)
    axis = np.zeros(size, np.float32)
    axis[kind % size[0], np.arange(size[-1])] = sign
    length = np.where(kind < 236, 1.0, share)
    length = np.where((kind >= 222) & (kind < 236), np.exp2(-150.0 * share), length)
    length = np.where(kind >= 248, 1.0 + (LENGTH - 1.000001) * share, length)
    length = np.where((kind >= 212) & (kind < 222), 0.0, length).astype(np.float32)
    along = [kind < 110, kind < 150, kind < 180, kind < 212]
    vectors: Array = np.select(along, [anywhere, near, sign * line, axis], anywhere) * length
    return vectors


def _unit(vectors: Array) -> Array:
    lengths = np.sqrt(np.einsum("ij,ij->j", vectors, vectors))
    unit: Array = vectors / np.where(lengths > 0.0, lengths, np.float32(1.0))
    return unit


def _whole(param: Param, uniform: Uniform | None, rng: np.random.Generator) -> Array:
    low, high = whole_range(param, uniform)
    if uniform is not None and high - low > 2:
        # steps and taps cost time, so most draws have few
        high = min(high, max(low, int(2 * max(uniform.default))) if rng.random() < 0.9 else high)
    return rng.integers(low, high + 1, (*shape_of(param.type), 1)).astype(DTYPES[kind_of(param.type)])


def texture(uniform: Uniform | None, dim: str, rng: np.random.Generator) -> Texture:
    """A texture of the contract: the default, uniform random texels, only 0 and 1, or any 16 bits if it holds data."""
    assert uniform is not None
    kind = int(rng.integers(0, 4))
    if kind == 0:
        return default_of(uniform)
    size = {"2D": (TEXELS, TEXELS), "3D": (TEXELS,) * 3, "Cube": (6, TEXELS, TEXELS)}[dim]
    if kind == 1 and not contracts.of_uniform(uniform).finite:
        return Texture(rng.integers(0, 1 << 16, (*size, 4), np.uint16).view(np.float16), dim=dim)
    texels = rng.random((*size, 4)) if kind == 2 else rng.integers(0, 2, (*size, 4)).astype(np.float64)
    return Texture(texels.astype(np.float16), dim=dim, wrap="clamp" if dim == "3D" else "repeat")
