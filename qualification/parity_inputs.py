"""What the builtins are measured on: every overload of the intrinsic table, with edge and random arguments.

Arguments are numbers of float32 (or int32, uint32, bool), component first and lane last, inside the table's domain. The
same seed and number of lanes give the same arguments everywhere.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from sssgen.ir import signatures
from sssgen.ir.intrinsics import BUILTINS, Builtin
from sssgen.ir.types import BY_NAME, INT, Matrix, Sampler, Scalar, Type, Vector, components, kind_of, spell
from sssgen.run.backends import Array
from sssgen.run.backends.call_program import grid
from sssgen.run.evaluate.evaluation import shape_of
from sssgen.targets import numpy_runtime as runtime
from sssgen.targets.runtime.numpy_textures import Texture

TEXTURE_LANES = 12
"""Lanes of the texture reads and derivatives."""

MIN, MAX = 2.0**-126, float(np.finfo(np.float32).max)
"""The smallest and the largest normal float32."""

DTYPES: dict[str, Any] = {"float": np.float32, "int": np.int32, "uint": np.uint32, "bool": np.bool_}
TEXTURES = {
    "sampler2D": "map", "sampler3D": "volume", "samplerCube": "cube", "sampler2DArray": "layers",
    "samplerCubeArray": "cubes", "sampler2DShadow": "shade", "samplerCubeShadow": "shades_around",
    "sampler2DArrayShadow": "shades", "isampler2D": "ints", "isampler3D": "int_volume", "isamplerCube": "int_cube",
    "isampler2DArray": "int_layers", "usampler2D": "uints", "usampler3D": "uint_volume", "usamplerCube": "uint_cube",
    "usampler2DArray": "uint_layers",
}  # fmt: skip
"""Sampler type → the name of its texture."""

_PI = float(np.float32(np.pi))
_SIZES = [
    0.0,
    0.5,
    1.0,
    2.0,
    0.25,
    1.5,
    2.5,
    3.0,
    7.0,
    10.0,
    0.1,
    1.0 / 3.0,
    1.0 + 2.0**-23,
    1.0 - 2.0**-24,
    0.75,
    88.0,
]
_SIZES += [
    2.0**-10,
    2.0**10,
    2.0**23,
    2.0**24,
    2.0**22 + 0.5,
    1e4,
    1e10,
    1e-4,
    1e-10,
    1e-30,
    1e30,
    MIN,
    MAX,
    126.0,
    44.0,
]
_SIZES += [_PI / 4.0, _PI / 2.0, _PI, 2.0 * _PI, 1e-40, 2.0**-149, 1.0 - 2.0**-12, 1.0 + 2.0**-12, 0.499999970197678]
EDGES: Array = np.array([sign * size for size in _SIZES for sign in (1.0, -1.0)], np.float32)
"""Zeros, powers of two and their neighbours, integers, halves, parts of pi, denormals, and the ends of the domains."""
INTEGERS = [0, 1, 2, 3, 7, 255, 32767, 32768, 65535, 65536, 2**24, 2**24 + 1, 2**31 - 1, 2**31, 2**32 - 1]


class Case(NamedTuple):
    """One overload of a builtin, and its arguments: arrays over all lanes, and textures by name."""

    name: str
    params: tuple[Type, ...]
    result: Type
    args: tuple[Any, ...]

    @property
    def title(self) -> str:
        return f"{self.name}({', '.join(map(spell, self.params))})"

    @property
    def row(self) -> Builtin:
        return BUILTINS[self.name]

    @property
    def lanes(self) -> int:
        return max((int(arg.shape[-1]) for arg in self.args if not isinstance(arg, str)), default=TEXTURE_LANES)

    @property
    def constant(self) -> tuple[int, ...]:
        """The positions of arguments that are constants of the program; the same in all lanes."""
        return tuple(self.row.constants(self.params))


@cache
def cases(lanes: int) -> tuple[Case, ...]:
    """Every overload, over that many lanes; texture reads and derivatives over `TEXTURE_LANES`.

    The table's test vectors stand in the first lanes.
    """
    all_cases = []
    for row in BUILTINS.values():
        for params, (result, _) in signatures.overloads(row.name).items():
            if params and isinstance(params[0], Sampler) and params[0].dim == "2DMS":
                continue  # no back end is given a texture with samples
            if row.kind == "derivative":
                args = over_the_image(row, params)
            elif row.kind == "fetch":
                args = reads(row, params)
            else:
                args = _arguments(row, params, lanes)
            all_cases.append(Case(row.name, params, result, args))
    return tuple(all_cases)


@cache
def textures() -> dict[str, Texture]:
    """A texture of each kind: of numbers that float16 holds, of depths, or of integers."""
    rng = np.random.default_rng(11)
    sizes = {"2D": (8, 16), "3D": (4, 4, 8), "Cube": (6, 4, 4)}
    by_name = {}
    for spelt, name in TEXTURES.items():
        type_ = BY_NAME[spelt]
        assert isinstance(type_, Sampler)
        size = (*((3,) if type_.array else ()), *sizes[type_.dim], 4)
        plain = type_.kind == "float" and not type_.shadow
        data: Array = rng.integers(0, 256, size).astype(np.float16) / np.float16(256.0)
        if type_.kind != "float":
            low = -(2**31) if type_.kind == "int" else 0
            data = rng.integers(low, low + 2**32, size)
        by_name[name] = Texture(
            data, "linear" if type_.kind == "float" else "nearest", dim=type_.dim, mipmaps=plain,
            layers=type_.array, kind=type_.kind, compare=type_.shadow,
        )  # fmt: skip
    return by_name


def evaluated(function: Callable[..., Any], args: tuple[Any, ...]) -> Array:
    """A row's `inside` or `size` for float64 arguments, lane by lane: the largest, or all, of a value's components."""
    with runtime.precision("float64"), np.errstate(all="ignore"):
        value = np.asarray(function(runtime, *args))
    axes = tuple(range(value.ndim - 1))
    lanes = max(arg.shape[-1] for arg in args)
    return np.broadcast_to(value.all(axes) if value.dtype.kind == "b" else np.abs(value).max(axes), (lanes,))


def widened(args: tuple[Any, ...]) -> tuple[Any, ...]:
    """Arguments with their floats in float64."""
    return tuple(arg.astype(np.float64) if not isinstance(arg, str) and arg.dtype.kind == "f" else arg for arg in args)


# Drawing


def _arguments(row: Builtin, params: tuple[Type, ...], lanes: int) -> tuple[Array, ...]:
    """Test vectors, and numbers from the domain: those that fall out of it are replaced."""
    rng = np.random.default_rng([7, zlib.crc32(f"{row.name}({', '.join(map(spell, params))})".encode())])
    vectors = _vectors(row, params)
    parts = [tuple(arg[..., inside(row, vectors)] for arg in vectors)]
    expected = lanes - parts[0][0].shape[-1]
    for _ in range(32):
        pool = [_column(row, index, type_, max(4 * lanes, 256), rng) for index, type_ in enumerate(params)]
        pool = [arg if index == 0 else _mixed(arg, rng) for index, arg in enumerate(pool)]
        _repeat(pool, params, rng)
        chosen = rng.permutation(np.flatnonzero(inside(row, tuple(pool))))[: max(expected, 0)]
        parts.append(tuple(arg[..., chosen] for arg in pool))
        expected -= len(chosen)
        if expected <= 0:
            return tuple(np.concatenate(column, axis=-1)[..., :lanes] for column in zip(*parts, strict=True))
    raise ValueError(f"{row.name}: too few arguments fall into its domain")


def inside(row: Builtin, args: tuple[Array, ...]) -> Array:
    """The lanes in which the parity of a row is measured."""
    domain = row.inside or (row.defined if row.kind != "fetch" else None)
    return evaluated(domain, widened(args)) if domain else np.ones(args[0].shape[-1], bool)


def _column(row: Builtin, index: int, type_: Type, count: int, rng: np.random.Generator) -> Array:
    """One argument: a third each of edges, even numbers and even magnitudes."""
    kind, size, samples = kind_of(type_), (*shape_of(type_), count), row.samples
    if kind == "bool":
        return rng.random(size) < 0.5
    if isinstance(type_, Matrix) and samples.invertible:
        regular = 2.0 * np.eye(type_.columns)[..., None] + rng.uniform(-0.5, 0.5, size)
        return (regular * 2.0 ** rng.integers(-4, 5, count)).astype(np.float32)
    third = (*size[:-1], count // 3)
    rest = (*size[:-1], count - 2 * (count // 3))
    if kind in ("int", "uint"):
        if index in samples.integers:
            low, high = samples.integers[index]
            return rng.integers(low, high + 1, size).astype(DTYPES[kind])
        info = np.iinfo(DTYPES[kind])
        edges = np.array([sign * number for number in INTEGERS for sign in (1, -1)], np.int64)
        edges = edges[(edges >= info.min) & (edges <= info.max)]
        low = -9 if kind == "int" else 0
        parts = [_choices(edges, third, rng), rng.integers(low, 10, third), rng.integers(info.min, info.max, rest)]
        integers: Array = np.concatenate(parts, axis=-1).astype(DTYPES[kind])
        return integers
    low_end, high_end = samples.interval(index) or (-MAX, MAX)
    edges = np.append(EDGES, [low_end, high_end]).astype(np.float32)
    if samples.special:
        edges = np.append(edges, np.array([np.nan, np.inf, -np.inf], np.float32))
    edges = edges[~((edges < low_end) | (edges > high_end))]
    even = rng.uniform(max(low_end, -8.0), min(high_end, 8.0), third)
    sizes = 2.0 ** rng.uniform(-40.0, min(40.0, np.log2(max(abs(low_end), abs(high_end)))), rest)
    signs = np.where(rng.random(rest) < 0.5, 1.0 if high_end > 0.0 else -1.0, -1.0 if low_end < 0.0 else 1.0)
    value = np.concatenate([_choices(edges, third, rng), even, np.maximum(signs * sizes, low_end)], axis=-1)
    value = value.astype(np.float32)
    if index in samples.unit:
        with np.errstate(invalid="ignore"):
            value = value / np.linalg.norm(value.astype(np.float64), axis=0) if value.ndim > 1 else np.sign(value)
    if samples.halves:
        value = np.clip(value, -65504.0, 65504.0).astype(np.float16)
    return value.astype(np.float32)


def _choices(edges: Array, size: tuple[int, ...], rng: np.random.Generator) -> Array:
    """All edges equally often."""
    return rng.permutation(np.resize(edges, int(np.prod(size)))).reshape(size)


def _mixed(arg: Array, rng: np.random.Generator) -> Array:
    """An argument so that one half of the edges meets edges, and the other meets anything."""
    half = rng.random(arg.shape[-1]) < 0.5
    arg[..., half] = arg[..., rng.permutation(np.flatnonzero(half))]
    return arg


def _repeat(pool: list[Array], params: tuple[Type, ...], rng: np.random.Generator) -> None:
    """In some lanes arguments are equal, in some a vector's components."""
    equal, alike = rng.random((2, pool[0].shape[-1])) < 0.05
    for arg, type_ in zip(pool, params, strict=True):
        if type_ == params[0]:
            arg[..., equal] = pool[0][..., equal]
        if isinstance(type_, Vector):
            arg[:, alike] = arg[:1, alike]


def _vectors(row: Builtin, params: tuple[Type, ...]) -> tuple[Array, ...]:
    """The arguments of the test vectors that are of this overload."""
    matching = [args for args, _ in row.vectors if len(args) == len(params) and all(map(_fits, args, params))]
    columns = []
    for index, type_ in enumerate(params):
        value = np.array([args[index] for args in matching], DTYPES[kind_of(type_)]).reshape(-1, *shape_of(type_))
        columns.append(np.moveaxis(value, 0, -1))
    return tuple(columns)


def _fits(value: object, type_: Type) -> bool:
    """Whether a test vector's value has a type; an integer is an int or a uint."""
    if isinstance(type_, Vector | Matrix):
        inner = Vector("float", type_.rows) if isinstance(type_, Matrix) else Scalar(type_.kind)
        count = type_.columns if isinstance(type_, Matrix) else type_.size
        return isinstance(value, tuple) and len(value) == count and all(_fits(part, inner) for part in value)
    kind = kind_of(type_)
    if kind == "bool":
        return isinstance(value, bool)
    if kind == "float":
        return isinstance(value, float)
    low, high = (0, 2**32) if kind == "uint" else (-(2**31), 2**31)
    return isinstance(value, int) and not isinstance(value, bool) and low <= value < high


# Textures and derivatives


CONSTANTS = {"ivec2": np.array([1, -2]), "ivec3": np.array([1, -2, 1]), "int": np.array(2)}
"""Constant arguments: offsets in texels, a channel."""


def reads(row: Builtin, params: tuple[Type, ...]) -> tuple[Any, ...]:
    """Arguments of a texture read or of a question about a texture.

    A level that is an integer is the same for all lanes, as are constants. Reads that look at neighbouring pixels, or
    get derivatives, have coordinates that are linear over the image, two texels a pixel, so level 1 everywhere:
    levels between are an implementation's own. The others have random ones.
    """
    rng = np.random.default_rng(7)
    sampler = params[0]
    assert isinstance(sampler, Sampler)
    name = TEXTURES[spell(sampler)]
    texture = textures()[name]
    layer = rng.integers(0, 3, TEXTURE_LANES)
    reference = (rng.integers(40, 216, TEXTURE_LANES) + 0.5) / 256.0  # between the texels, which are multiples of 1/256
    linear, slopes = _over_the_image(texture)
    gradients = sum(isinstance(type_, Vector) and type_.kind == "float" for type_ in params) == 3
    constants = row.constants(params)
    offsets = [params[index] for index in constants if isinstance(params[index], Vector)]
    if not row.uniform_flow and not gradients:
        linear = rng.uniform(-1.0, 2.0, linear.shape)
        if texture.dim == "Cube":
            linear[1] = 3.0  # to the middle of a cube's face
    args: list[Any] = [name]
    for index, type_ in enumerate(params[1:], 1):
        last_int = type_ == INT and INT not in params[index + 1 :]
        value: Array
        if index in constants:
            value = CONSTANTS[spell(type_)][..., None] * np.ones(TEXTURE_LANES, np.int32)
        elif isinstance(type_, Vector) and type_.kind == "int":
            value = np.concatenate([rng.integers(0, 2, (texture.axes, TEXTURE_LANES)), [layer]])[: type_.size]
            for offset in offsets:  # the texel that is read lies inside
                value[: components(offset)] -= CONSTANTS[spell(offset)][..., None]
        elif index == 1 and isinstance(type_, Vector):
            further = [layer + 0.25] * texture.layers + [reference] * texture.compare
            value = np.concatenate([linear, *(part[None] for part in further)])[: type_.size]
        elif isinstance(type_, Vector):
            value = slopes[index - params.index(type_, 2)]
        elif last_int and kind_of(params[1]) == "int":
            value = np.full(TEXTURE_LANES, min(1, len(texture.levels) - 1))
        elif type_ == INT:
            value = layer
        elif sampler.shadow and components(params[1]) < texture.axes + texture.layers + texture.compare:
            value = reference
        elif row.uniform_flow:
            value = np.full(TEXTURE_LANES, 1.0 if offsets else 0.5)  # a bias
        else:
            value = rng.uniform(0.0, 3.0, TEXTURE_LANES)  # a level
            value = np.floor(value) if offsets else value  # SwiftShader mistakes those between
        args.append(value.astype(DTYPES[kind_of(type_)]))
    return tuple(args)


def _over_the_image(texture: Texture) -> tuple[Array, Array]:
    """A coordinate that moves by two texels a pixel, (axes, lanes), and its two slopes, (2, axes, lanes)."""
    width = grid(TEXTURE_LANES).width
    x, y = np.arange(TEXTURE_LANES) % width - 2.0, np.arange(TEXTURE_LANES) // width - 0.5
    sizes = np.array(texture.size()).reshape(-1, 1)
    steps = np.zeros((2, texture.axes, TEXTURE_LANES))
    steps[0, 0], steps[1, 1] = 2.0 / sizes[0], 2.0 / sizes[1]
    coord = steps[0] * x + steps[1] * y + 0.3
    if texture.dim == "Cube":
        coord, steps = np.array([coord[0], np.full(TEXTURE_LANES, 2.0), coord[1]]), 4.0 * steps[:, [0, 2, 1]]
    return coord, steps


def over_the_image(row: Builtin, params: tuple[Type, ...]) -> tuple[Any, ...]:
    """Arguments of derivatives: linear over the image.

    The coarse and the fine derivatives of anything else are an implementation's own.
    """
    width = grid(TEXTURE_LANES).width
    x, y = np.arange(TEXTURE_LANES) % width - 2.0, np.arange(TEXTURE_LANES) // width - 0.5
    slope = 0.5 * x - 0.25 * y
    args = [slope * np.arange(1, components(type_) + 1)[:, None] for type_ in params]
    return tuple(arg.reshape(*shape_of(params[0]), TEXTURE_LANES).astype(np.float32) for arg in args)
