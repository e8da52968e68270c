"""Runs functions on a back end and in NumPy on the same random arguments, and reports where the two differ."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from types import MappingProxyType
from typing import Any, TypeAlias

import numpy as np

from sssgen.ir.nodes import Function, Module, Param
from sssgen.ir.types import Sampler, kind_of
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Backend, Call, Text
from sssgen.run.evaluate.evaluation import shape_of
from sssgen.targets import numpy_runtime as rt
from sssgen.targets.runtime.numpy_textures import Texture
from validate import code

HEIGHT = 2
"""The number of rows of a test's picture."""

Array: TypeAlias = np.ndarray[Any, Any]
Draw: TypeAlias = Callable[[Param, np.random.Generator, int], Array]
"""Returns the argument for a parameter, with this many lanes."""

DTYPES = {"float": np.float32, "int": np.int32, "uint": np.uint32, "bool": np.bool_}
TEXTURES = {"2D": "map", "3D": "volume", "Cube": "cube"}


def pixels(lanes: int) -> tuple[Array, Array]:
    """The column and the row of each lane's pixel."""
    return np.arange(lanes) % (lanes // HEIGHT), np.arange(lanes) // (lanes // HEIGHT)


@cache
def textures(mipmaps: bool = True) -> dict[str, Texture]:
    """A texture of each kind, with numbers that are exact in float16."""
    rng = np.random.default_rng(11)

    def noise(*size: int) -> Array:
        return rng.integers(0, 256, (*size, 4)).astype(np.float16) / np.float16(256.0)

    return {
        "map": Texture(noise(8, 16), mipmaps=mipmaps),
        "volume": Texture(noise(4, 4, 8), mipmaps=mipmaps),
        "cube": Texture(noise(6, 4, 4), dim="Cube", mipmaps=mipmaps),
    }


def random_argument(param: Param, rng: np.random.Generator, lanes: int) -> Array:
    """A random argument. Coordinates called `uv` are linear over the picture, with two texels of `map` per pixel."""
    kind, size = kind_of(param.type), (*shape_of(param.type), lanes)
    if kind == "bool":
        return rng.random(size) < 0.5
    if kind in ("int", "uint"):
        return rng.integers(-9 if kind == "int" else 0, 10 if kind == "int" else 2**16, size).astype(DTYPES[kind])
    if param.name == "uv":
        x, y = pixels(lanes)
        return np.array([x / 8.0 + 0.3, y / 4.0 + 0.4], np.float32)
    return rng.uniform(-2.0, 2.0, size).astype(np.float32)


def random_per_quad(param: Param, rng: np.random.Generator, lanes: int) -> Array:
    """A random argument that is constant in each quad, so that the derivatives of a coordinate are those of `uv`."""
    value = random_argument(param, rng, lanes)
    return value if param.name == "uv" else value[..., pixels(lanes)[0] // 2]


def arguments(function: Function, draw: Draw, lanes: int) -> tuple[Any, ...]:
    """An argument for each parameter; each call gives the same."""
    rng = np.random.default_rng(3)
    return tuple(
        TEXTURES[param.type.dim] if isinstance(param.type, Sampler) else draw(param, rng, lanes)
        for param in function.params
    )


@cache
def transpiled(module: Module, target: str) -> str:
    """The functions form of a module."""
    return next(text for name, text in transpile(module, target, "cases").files.items() if not name.endswith(".json"))


def with_numpy(text: str, call: Call, bound: Mapping[str, Texture], lanes: int, floating: str = "float64") -> Array:
    """The result of a call by the text of the numpy target; 0 in discarded lanes."""
    names: dict[str, Any] = {}
    exec(compile(text, "numpy", "exec"), names)
    args = [
        bound[arg] if isinstance(arg, str) else arg.astype(floating) if arg.dtype.kind == "f" else arg
        for arg in call.args
    ]
    with rt.precision(floating), rt.grid(HEIGHT, lanes // HEIGHT):
        result = names[call.function](*args)
    value, discarded = result if isinstance(result, tuple) else (result, False)
    return np.where(discarded, 0, value)


def differences(
    gpu: Backend,
    module: Module,
    calls: Sequence[tuple[str, Call]],
    bound: Mapping[str, Texture],
    floating: str = "float64",
    tolerance: float = 2e-5,
    loose: Mapping[str, float] = MappingProxyType({}),
) -> list[str]:
    """The differences between a back end's results for the calls and those of the numpy target.

    Each call has a title; `loose` maps titles to another tolerance, relative and absolute.
    """
    lanes = next(arg.shape[-1] for _, call in calls for arg in call.args if not isinstance(arg, str))
    oracle, wrong = transpiled(module, "numpy"), []
    results = gpu.run(Text(code(module, gpu.target.name)), [call for _, call in calls], bound)
    for (title, call), actual in zip(calls, results, strict=True):
        expected = np.broadcast_to(with_numpy(oracle, call, bound, lanes, floating), actual.shape)
        if expected.dtype.kind != "f":
            good = actual == expected
        else:
            limit = 2.0**-6 if any(isinstance(arg, str) for arg in call.args) else loose.get(title, tolerance)
            good = np.isclose(actual, expected, limit, limit, equal_nan=True)
        bad = np.flatnonzero(~good.reshape(-1, lanes).all(axis=0))
        for lane in bad[:1]:
            at = [arg if isinstance(arg, str) else arg[..., lane].tolist() for arg in call.args]
            wrong.append(f"{title}\n{len(bad)} of {lanes}: {at}: {actual[..., lane]} is not {expected[..., lane]}")
    return wrong
