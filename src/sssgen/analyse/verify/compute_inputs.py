"""What a compute shader reads under `--verify`: buffers, uniforms and textures, and how many workgroups run.

A buffer is an array of 32-bit words; `Word` has the type and the place of each in the layout of its block.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple
from zlib import crc32

import numpy as np

from sssgen.analyse.verify.plain_inputs import picture
from sssgen.ir.nodes import Global, Module, Swizzle, Uniform, Variable
from sssgen.ir.types import Array as ArrayType
from sssgen.ir.types import Matrix, Sampler, Struct, Type, Vector, components, kind_of
from sssgen.ir.walk import all_expressions
from sssgen.passes.stage.storage_layout import extent, offsets
from sssgen.run.backends import Array
from sssgen.targets.runtime.numpy_textures import Texture

GROUPS = (3, 2, 2)
"""Workgroups along each axis that the shader uses."""
SMALL = 16
"""Integers in buffers are below it, as many are indices; one in eight may be any integer."""
_IDS = ("gl_GlobalInvocationID", "gl_WorkGroupID")


class Word(NamedTuple):
    """One number of a buffer."""

    at: int
    """In words of 32 bits."""
    kind: str
    """float, int or uint"""
    place: str
    """As `particles[2].mass`."""


class RoundValues(NamedTuple):
    """The values of one run."""

    buffers: dict[str, Array]
    """By the name of the variable: words as uint32."""
    uniforms: dict[str, Array]
    textures: dict[str, Texture]


def group_counts(module: Module) -> tuple[int, int, int]:
    """Workgroups along each axis: several along x, where a workgroup is longer than 1, and where the text names it."""
    names = {variable.name for variable in module.variables if variable.builtin in _IDS}
    used = {"x"}
    for function in module.functions:
        for expr in all_expressions(function.body or ()):
            if isinstance(expr, Swizzle) and isinstance(expr.value, Global) and expr.value.name in names:
                used |= set(expr.components)
    several = [axis in used or size > 1 for axis, size in zip("xyz", module.workgroup, strict=True)]
    x, y, z = (count if wanted else 1 for count, wanted in zip(GROUPS, several, strict=True))
    return x, y, z


def words(type_: Type, rule: str, length: int, start: int = 0, place: str = "") -> Iterator[Word]:
    """The numbers of a block in the layout `rule`; an array without a length has `length` elements."""
    if isinstance(type_, Struct):
        for field, offset in zip(type_.fields, offsets(type_, rule), strict=True):
            inner = f"{place}.{field.name}" if place else field.name
            yield from words(field.type, rule, length, start + offset // 4, inner)
    elif isinstance(type_, ArrayType):
        stride = extent(type_, rule).stride // 4
        for index in range(type_.length or length):
            yield from words(type_.element, rule, length, start + index * stride, f"{place}[{index}]")
    elif isinstance(type_, Matrix):
        stride = extent(type_, rule).stride // 4
        for column in range(type_.columns):
            yield from words(Vector("float", type_.rows), rule, length, start + column * stride, f"{place}[{column}]")
    else:
        count = components(type_)
        for index in range(count):
            yield Word(start + index, kind_of(type_), f"{place}.{'xyzw'[index]}" if count > 1 else place)


def word_count(buffer: Variable, length: int) -> int:
    """The size of a buffer in words, where an array without a length has `length` elements."""
    struct = buffer.type
    assert isinstance(struct, Struct)
    size = extent(struct, buffer.layout).size
    last = struct.fields[-1].type
    if isinstance(last, ArrayType) and not last.length:
        end = offsets(struct, buffer.layout)[-1] + length * extent(last, buffer.layout).stride
        size = max(size, end)
    return -(-size // 16) * 4


def round_values(
    module: Module, layouts: Mapping[str, Sequence[Word]], length: int, number: int, seed: int
) -> RoundValues:
    """The values of round `number`. Integers among the uniforms are sizes of the grid, its volume, or random."""
    buffers = {}
    for variable in module.variables:
        if variable.storage == "buffer":
            rng = np.random.default_rng([seed, number, crc32(variable.name.encode())])
            buffer = np.zeros(word_count(variable, length), np.uint32)
            for word in layouts[variable.name]:
                buffer[word.at] = _number(word.kind, rng)
            buffers[variable.name] = buffer
    grid = [count * size for count, size in zip(group_counts(module), module.workgroup, strict=True)]
    uniforms = {
        uniform.name: _uniform(
            uniform, grid, number, np.random.default_rng([seed, number, crc32(uniform.name.encode())])
        )
        for uniform in module.uniforms
        if not isinstance(uniform.type, Sampler)
    }
    textures = {
        uniform.name: picture(uniform.name, uniform.type, seed)
        for uniform in module.uniforms
        if isinstance(uniform.type, Sampler)
    }
    return RoundValues(buffers, uniforms, textures)


def _number(kind: str, rng: np.random.Generator) -> np.uint32:
    if kind == "float":
        value = rng.choice([0.0, 1.0, -1.0]) if rng.random() < 0.125 else rng.uniform(-2.0, 2.0)
        return np.float32(value).view(np.uint32)
    bits = rng.integers(0, 2**32) if rng.random() < 0.125 else rng.integers(0, SMALL)
    return np.uint32(bits)


def _uniform(uniform: Uniform, grid: Sequence[int], number: int, rng: np.random.Generator) -> Array:
    type_ = uniform.type
    shape: tuple[int, ...] = ()
    while isinstance(type_, ArrayType):
        shape, type_ = (*shape, type_.length), type_.element
    count, kind = components(type_), kind_of(type_)
    volume = int(np.prod(grid))
    if kind == "float":
        return rng.uniform(-2.0 if number % 2 else 0.25, 2.0, (*shape, count)).astype(np.float32)
    if kind == "bool":
        return rng.integers(0, 2, (*shape, count)).astype(np.uint32)
    choices = {0: grid[:count] if count > 1 else [grid[0]], 1: [volume] * count, 2: [max(1, grid[0] - 3)] * count}
    values = choices.get(number, rng.integers(1, [volume + 1, SMALL][number % 2], count))
    numbers = np.broadcast_to(np.resize(np.asarray(values), count), (*shape, count))
    return numbers.astype(np.int32 if kind == "int" else np.uint32)
