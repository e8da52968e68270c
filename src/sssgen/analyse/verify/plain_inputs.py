"""Inputs for functions of which only the text is known.

The numbers of a lane follow one of these patterns, so that large numbers do not make every lane overflow:

- ordinary: floats in [-2, 2], some exactly 0, 1 or -1, integers from -8 to 8;
- special: one parameter is a constant of the program, its neighbour, or an extreme of the type, the others are
  ordinary;
- constants: every number is a constant of the program or near one;
- scaled: all numbers have about the same magnitude, from 2^-12 to 2^12;
- wild: every magnitude of a float, every length of an integer, both signs, random bits.

Parameters that bound loops stay small. Well-known names have ranges of their own, with sensible extremes: times, sizes
of the picture.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple
from zlib import crc32

import numpy as np

from sssgen.ir.intrinsics.table import LARGEST
from sssgen.ir.nodes import Literal, Module
from sssgen.ir.types import Sampler, Type, kind_of
from sssgen.ir.walk import all_expressions, subexpressions
from sssgen.run.backends import Array
from sssgen.run.evaluate.evaluation import shape_of
from sssgen.run.evaluate.random_inputs import texture
from sssgen.targets.runtime.numpy_textures import Texture

SPECIAL, WITHIN = 0.12, 0.5
"""The shares of ordinary numbers that are 0, 1 or -1, and of those in [0, 1]."""
SHARES = (0.35, 0.25, 0.12, 0.13, 0.15)
"""The shares of the patterns, in the order above."""
LAYERS = 3
"""How many layers textures have, where they have layers."""
LOOPS = 12
"""The largest number of most that bound loops."""

RANGES = {
    "iResolution": (32.0, 64.0), "iTime": (0.0, 20.0), "iGlobalTime": (0.0, 20.0), "iTimeDelta": (0.01, 0.02),
    "iMouse": (0.0, 64.0), "iFrameRate": (30.0, 60.0), "fragCoord": (0.0, 64.0), "sssgen_coordinates": (0.0, 64.0),
    "u_resolution": (32.0, 64.0), "u_time": (0.0, 20.0), "u_mouse": (0.0, 64.0),
}  # fmt: skip
"""The ranges of Shadertoy's inputs and similar ones: pixels and seconds."""
EXTREMES = {
    "iResolution": (1.0, 4096.0), "u_resolution": (1.0, 4096.0), "iTime": (0.0, 3600.0), "iGlobalTime": (0.0, 3600.0),
    "u_time": (0.0, 3600.0), "iTimeDelta": (0.001, 0.5), "iFrameRate": (1.0, 240.0),
}  # fmt: skip
"""Their extremes; of the others, the ends of their ranges."""

KINDS = {"float": np.float64, "int": np.int32, "uint": np.uint32, "bool": np.bool_}
"""The numbers of an input, by the kind of its type."""


class Source(NamedTuple):
    """A number, vector or matrix among a function's inputs."""

    name: str
    author_name: str
    """The author's name of it, which `RANGES` may know."""
    type: Type
    bounds_loops: bool = False
    """Whether a large number may take many rounds of a loop."""
    uniform: bool = False


class Numbers(NamedTuple):
    """The numbers that a program's constants suggest."""

    floats: Array
    integers: Array
    """int64, of which the low 32 bits are used."""


def suggest_numbers(module: Module) -> Numbers:
    """The numbers that the literals of a module suggest: themselves, their neighbours, and numbers between them."""
    literals = [part for function in module.functions for part in all_expressions(function.body or ())]
    literals += [part for constant in module.constants for part in subexpressions(constant.value)]
    values = {
        kind: sorted({part.value for part in literals if isinstance(part, Literal) and kind_of(part.type) in kinds})
        for kind, kinds in (("float", ("float",)), ("integer", ("int", "uint")))
    }
    whole = np.array([int(value) for value in values["integer"]] or [0], np.int64)
    floats = np.array([*values["float"], *(float(value) for value in values["integer"])] or [0.0], np.float64)
    return Numbers(_near_floats(floats), _near_integers(whole))


def _near_floats(constants: Array) -> Array:
    with np.errstate(all="ignore"):
        single = np.unique(constants.astype(np.float32))
        single = np.unique(np.concatenate([single, -single]))
        beside = [np.nextafter(single, np.float32(end)) for end in (-np.inf, np.inf)]
        between = (single[1:] + single[:-1]) / 2
        numbers = [single, single, *beside, between, single + 1, single - 1, single * 2, single / 2, 1 / single]
        result: Array = np.concatenate(numbers).astype(np.float64)
    kept: Array = result[np.isfinite(result) & ((np.abs(result) >= 2.0**-126) | (result == 0.0))]
    return kept


def _near_integers(constants: Array) -> Array:
    shifts = constants[(constants > 0) & (constants < 32)]
    powers = np.left_shift(np.int64(1), shifts)
    numbers = [constants, constants, constants - 1, constants + 1, -constants, ~constants, 2 * constants]
    numbers += [powers, powers - 1, -powers, np.left_shift(np.int64(1), 32 - shifts), constants * 3]
    return np.concatenate(numbers)


FLOAT_EXTREMES = np.array(
    [0.0, -0.0, 1.0, -1.0, 0.5, 2.0**-126, -(2.0**-126), 1e-20, 1e-6, 1e6, -1e6, 1e20, LARGEST, -LARGEST]
)
INTEGER_EXTREMES = np.array(
    [0, 1, -1, 2, -2, 31, 32, 2**31 - 1, -(2**31), 2**30, 0x55555555, 0xAAAAAAAA, 0xFFFF, 0xFFFF0000, 0xFF, 2**24 + 1]
)


def draw_inputs(sources: Sequence[Source], lanes: int, numbers: Numbers, seed: int) -> dict[str, Array]:
    """`lanes` values of each source, lanes last; floats are exact in float32."""
    names = " ".join([f"{source.author_name} {source.type}" for source in sources])
    rng = np.random.default_rng([seed, crc32(names.encode())])
    pattern = rng.choice(len(SHARES), lanes, p=SHARES)
    chosen = rng.integers(0, max(len(sources), 1), lanes)
    exponent = rng.uniform(-12.0, 12.0, lanes)
    values: dict[str, Array] = {}
    for position, source in enumerate(sources):
        shape = (*shape_of(source.type), lanes)
        values[source.name] = _draw_source(source, shape, rng, numbers, (pattern, chosen == position, exponent))
    return values


def _draw_source(
    source: Source, shape: tuple[int, ...], rng: np.random.Generator, numbers: Numbers,
    lanes: tuple[Array, Array, Array],
) -> Array:  # fmt: skip
    pattern, chosen, exponent = lanes
    kind = kind_of(source.type)
    if kind == "bool":
        return rng.random(shape) < 0.5
    if kind == "float" and (ends := RANGES.get(source.author_name)):
        return round_single(np.where(rng.random(shape) < 0.9, rng.uniform(*ends, shape), _extreme(source, shape, rng)))
    if source.bounds_loops:
        small_numbers = rng.integers(-1, LOOPS, shape)
        if kind == "float":
            return round_single(np.where(rng.random(shape) < 0.5, small_numbers, rng.uniform(-2.0, LOOPS, shape)))
        return small_numbers.clip(0).astype(np.uint32) if kind == "uint" else small_numbers.astype(np.int32)
    if kind == "float":
        ordinary, scaled, wild = _floats(shape, rng, exponent)
        near, extremes = numbers.floats, FLOAT_EXTREMES
    else:
        ordinary, scaled, wild = _integers(shape, rng, exponent)
        near, extremes = numbers.integers, INTEGER_EXTREMES
    constant = rng.choice(near, shape)
    chance = rng.random(shape)
    special = np.select(
        [chance < 0.5, chance < 0.65, chance < 0.8], [constant, rng.choice(extremes, shape), wild], scaled
    )
    special = np.where(chosen & (rng.random(shape) < 0.7), special, ordinary)
    value = np.choose(pattern, [ordinary, special, constant, scaled, wild])
    return round_single(value) if kind == "float" else as_integers(value, kind)


def _floats(shape: tuple[int, ...], rng: np.random.Generator, exponent: Array) -> tuple[Array, Array, Array]:
    chance = rng.random(shape)
    ordinary = np.where(chance < WITHIN, rng.uniform(0.0, 1.0, shape), rng.uniform(-2.0, 2.0, shape))
    ordinary = np.where(chance > 1.0 - SPECIAL, rng.choice([0.0, 1.0, -1.0], shape), ordinary)
    sign = rng.choice([-1.0, 1.0], shape)
    scaled = sign * np.exp2(exponent + rng.uniform(-2.0, 2.0, shape))
    wide = rng.random(shape) < 0.25
    wild = sign * np.exp2(np.where(wide, rng.uniform(-126.0, 127.9, shape), rng.uniform(-24.0, 24.0, shape)))
    return ordinary, np.where(rng.random(shape) < 0.3, np.rint(scaled), scaled), wild


def _integers(shape: tuple[int, ...], rng: np.random.Generator, exponent: Array) -> tuple[Array, Array, Array]:
    ordinary = rng.integers(-8, 9, shape)
    ordinary = np.where(rng.random(shape) < 0.6, np.abs(ordinary), ordinary)
    bits = rng.integers(0, 2**32, shape)
    scaled = np.exp2(np.abs(exponent) + rng.uniform(0.0, 3.0, shape)).astype(np.int64)
    scaled = np.where(rng.random(shape) < 0.5, -scaled, scaled)
    length = rng.integers(0, 33, shape)
    wild = np.where(rng.random(shape) < 0.4, bits, bits >> length)
    return ordinary, scaled, np.where(rng.random(shape) < 0.3, -wild, wild)


def _extreme(source: Source, shape: tuple[int, ...], rng: np.random.Generator) -> Array:
    return rng.choice(EXTREMES.get(source.author_name, RANGES[source.author_name]), shape)


def round_single(value: Array) -> Array:
    """Numbers rounded to float32, in float64; subnormal ones, which drivers may flush, become 0."""
    with np.errstate(all="ignore"):
        rounded = np.clip(value, -LARGEST, LARGEST).astype(np.float32).astype(np.float64)
    return np.where(np.abs(rounded) < 2.0**-126, rounded * 0.0, rounded)


def as_integers(value: Array, kind: str) -> Array:
    """The low 32 bits of whole numbers, as int or uint; an int is not made from a negative one of uint's range."""
    low = (np.asarray(value).astype(np.int64) & 0xFFFFFFFF).astype(np.uint32)
    return low if kind == "uint" else low.view(np.int32)


def join(parts: Iterable[dict[str, Array]]) -> dict[str, Array]:
    """Lanes behind one another."""
    parts = list(parts)
    return {name: np.concatenate([part[name] for part in parts], axis=-1) for name in parts[0]}


def select_lanes(values: dict[str, Array], lanes: Array) -> dict[str, Array]:
    """Some of the lanes."""
    return {name: value[..., lanes] for name, value in values.items()}


def picture(name: str, type_: Sampler, seed: int) -> Texture:
    """A small texture: one half is smooth, the other has hard edges; in 3-D a distance field."""
    count = LAYERS if type_.array else 1
    layers = [texture(type_.dim, np.random.default_rng([seed, crc32(name.encode()), layer])) for layer in range(count)]
    if type_.kind != "float":
        rng = np.random.default_rng([seed, crc32(name.encode())])
        shape = (*((count,) if type_.array else ()), *layers[0].levels[0].shape)
        bits = rng.integers(0, 2**32, shape)
        texels = as_integers(np.where(rng.random(shape) < WITHIN, bits & 7, bits), type_.kind)  # half of them: indices
        return Texture(texels, dim=type_.dim, layers=type_.array, kind=type_.kind, filter="nearest")
    if type_.array:
        return Texture(np.stack([layer.levels[0] for layer in layers]), dim=type_.dim, layers=True)
    if type_.shadow:
        return Texture(layers[0].levels[0][..., :1], dim=type_.dim, compare=True)
    return layers[0]
