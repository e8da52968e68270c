"""Runs one technique on arrays: its compiled NumPy text, in float64.

    lobe = technique("lobe_gdc2011")
    lobe(V=v, N=n, L=l, through=0.5, power=4.0)          # v, n, l: (count, 3) or (3,)
    technique("march_light", body_distance="sphere")     # a slot: a library function, FILE:FUNCTION, or source text
    technique("common/hash.sss:hash_unit")(x=7)          # any function of a library file

Values are passed by the name of the parameter or uniform. Scalars are () or (count,), vectors and matrices have
their components last: (count, 3), (count, row, column). A texture is an array as `Texture` takes it, or a `Texture`.
Omitted uniforms have their defaults. The result has the same layout; with out parameters it is a tuple.
"""

from __future__ import annotations

import re
from functools import cache
from inspect import signature
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from sssgen.ir.nodes import Function, Module
from sssgen.ir.types import VOID, Matrix, Sampler, Type, Vector, components, kind_of
from sssgen.lang.check.module_checker import check
from sssgen.lang.loader import load_file
from sssgen.lang.syntax.parser import parse
from sssgen.material import library
from sssgen.material.library import TECHNIQUES
from sssgen.material.slots import find
from sssgen.passes.link import LinkInput, link
from sssgen.pipeline.compiler import transpile
from sssgen.targets.runtime.numpy_textures import Texture
from sssgen.targets.runtime.numpy_values import precision

DTYPES: dict[str, Any] = {"float": np.float64, "int": np.int32, "uint": np.uint32, "bool": np.bool_}


Array: TypeAlias = np.ndarray[Any, Any]
close = np.testing.assert_allclose
UP = np.array([0.0, 1.0, 0.0])


def rng(seed: int = 7) -> np.random.Generator:
    return np.random.default_rng(seed)


def unit(v: Any) -> Array:
    """Normalized vectors."""
    result: Array = np.asarray(v, np.float64) / np.linalg.norm(v, axis=-1, keepdims=True)
    return result


def units(count: int, seed: int = 7) -> Array:
    """Random unit vectors."""
    return unit(rng(seed).normal(size=(count, 3)))


def lowbias32(x: int) -> int:
    """The hash of common/hash.sss, in Python's integers."""
    x = (x ^ x >> 16) * 0x7FEB352D & 0xFFFFFFFF
    x = (x ^ x >> 15) * 0x846CA68B & 0xFFFFFFFF
    return x ^ x >> 16


class Technique(NamedTuple):
    """A technique that can be called."""

    function: Any
    types: dict[str, Type]
    """Parameter of the Python function → its type, in order."""
    defaults: dict[str, Any]
    results: tuple[Type, ...]

    def __call__(self, **values: Any) -> Any:
        unknown = values.keys() - self.types.keys()
        missing = self.types.keys() - self.defaults.keys() - values.keys()
        if unknown or missing:
            raise TypeError(f"unknown {sorted(unknown)}, missing {sorted(missing)}; it takes {list(self.types)}")
        inputs = {**self.defaults, **values}
        counts = {
            np.shape(value)[0]
            for name, value in values.items()
            if not isinstance(self.types[name], Sampler) and np.ndim(value) > _rank(self.types[name])
        }
        assert len(counts) < 2, f"lanes: {counts}"
        with precision(np.float64):
            result = self.function(*[_inwards(type_, inputs[name]) for name, type_ in self.types.items()])
        parts = result if isinstance(result, tuple) else (result,)
        results = [_outwards(type_, part, counts) for type_, part in zip(self.results, parts, strict=True)]
        return tuple(results) if len(results) > 1 else results[0]


def technique(name: str, **slots: str) -> Technique:
    """A technique of the library, or FILE:FUNCTION, with its slots bound."""
    return _technique(name, tuple(slots.items()))


@cache
def _technique(name: str, slots: tuple[tuple[str, str], ...]) -> Technique:
    module, function = _function(name)
    declared = {declaration.name: declaration for declaration in module.functions if declaration.body is None}
    bound: dict[str, tuple[Module, Function]] = {}
    for slot, text in slots:  # the slots of a bound function come after it
        bound[slot] = _bound(text, declared[slot])
        declared |= {other.name: other for other in bound[slot][0].functions if other.body is None}
    linked = link([LinkInput(function.name, "", module, function, bound, {}, frozenset())])
    compiled = transpile(linked.module, "numpy", function.name)
    namespace: dict[str, Any] = {}
    exec(compiled.files[f"{function.name}_functions.py"], namespace)
    result = namespace[compiled.reflection["renames"].get(function.name, function.name)]
    own = {param.name: param.type for param in function.params if param.direction != "out"}
    declared_uniforms = {uniform.name: uniform for uniform in linked.module.uniforms}
    renamed = list(signature(result).parameters)[len(own) :]
    # a name that a language reserves (`center` in HLSL) has a suffix
    uniform_names = [name if name in declared_uniforms else re.sub(r"_\d*$", "", name) for name in renamed]
    uniforms = {name: declared_uniforms[name] for name in uniform_names}
    results = [function.result] if function.result != VOID else []
    results += [param.type for param in function.params if param.direction != "in"]
    return Technique(
        result,
        own | {name: uniform.type for name, uniform in uniforms.items()},
        {name: _default(uniform.type, uniform.default) for name, uniform in uniforms.items() if uniform.default},
        tuple(results),
    )


def _function(name: str) -> tuple[Module, Function]:
    file, colon, inner = name.partition(":")
    if not colon:
        loaded = library.load(name)
        return loaded.module, loaded.function
    module = load_file(Path(TECHNIQUES) / file, (TECHNIQUES,))
    return module, next(function for function in module.functions if function.name == inner)


def _bound(text: str, slot: Function) -> tuple[Module, Function]:
    if "(" not in text:
        return find(text, slot, str(TECHNIQUES))
    module = check(parse(text, "slot.sss"), text)
    return module, module.functions[-1]


def _rank(type_: Type) -> int:
    return 2 if isinstance(type_, Matrix) else 1 if isinstance(type_, Vector) else 0


def _default(type_: Type, value: tuple[float, ...]) -> Any:
    """A uniform's default, which lists the components (a matrix column by column), in the layout of the tests."""
    if isinstance(type_, Matrix):
        return np.reshape(value, (type_.columns, type_.rows)).T
    return value if components(type_) > 1 else value[0]


def _inwards(type_: Type, value: Any) -> Any:
    """Converts the layout of the tests to that of the runtime, which has components first."""
    if isinstance(type_, Sampler):
        return value if isinstance(value, Texture) else Texture(value)
    array = np.asarray(value, DTYPES[kind_of(type_)])
    if isinstance(type_, Matrix):
        return np.atleast_3d(array.T)
    return np.moveaxis(np.atleast_2d(array), -1, 0) if isinstance(type_, Vector) else array


def _outwards(type_: Type, value: Any, counts: set[int]) -> Any:
    """The inverse conversion; the result has no lanes if no argument has lanes."""
    rank = _rank(type_)
    array = np.asarray(value)
    array = np.moveaxis(array, -1, 0) if array.ndim > rank else array
    if not counts:
        return array[0] if array.ndim > rank else array
    return np.broadcast_to(array, (*counts, *array.shape[-rank:])) if rank else np.broadcast_to(array, tuple(counts))
