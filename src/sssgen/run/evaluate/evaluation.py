"""Evaluates a technique on arrays of inputs, on one back end or on several.

    outputs = evaluate(subject("lobe_gdc2011"), {"V": v, "N": n, "L": l, "through": 0.5}, backends.get("gl"))
    outputs["result"]                                                      # (lanes, 3)

Arrays of users have lanes first: (lanes,) for a float, (lanes, 3) for a vec3, (lanes, column, row) for a matrix. Arrays
of back ends have lanes last.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from sssgen.ir.nodes import Param, Uniform
from sssgen.ir.types import Array as ArrayType
from sssgen.ir.types import Matrix, Sampler, Type, Vector, components, kind_of, spell, with_article
from sssgen.passes.ranges.sites import Site
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Array, Backend, Call, Text, file_text
from sssgen.run.evaluate.probes import Subject
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.targets.runtime.numpy_textures import Texture
from sssgen.targets.texture_import import default_color

DTYPES: dict[str, Any] = {"float": np.float64, "int": np.int32, "uint": np.uint32, "bool": np.bool_}


class Inputs(NamedTuple):
    """Inputs that fit a subject."""

    values: dict[str, Array]
    """Lanes last; one lane where the input is the same for all."""
    textures: dict[str, Texture]
    lanes: int


def evaluate(subject: Subject, values: Mapping[str, Any], backend: Backend, guards: str = "auto") -> dict[str, Array]:
    """The outputs by name (`result` is the return value), lanes first.

    `values` has numbers, arrays and `Texture`s by the name of the technique's parameter or uniform; other uniforms have
    their defaults; `guards` as in `compile`. Raises SssgenError for inputs that do not fit, and if the back end rejects
    the program.
    """
    return run(subject, fit_inputs(subject, values), backend, guards)


def run(
    subject: Subject,
    inputs: Inputs,
    backend: Backend,
    guards: str = "auto",
    guard_change: Callable[[Site], str] | None = None,
) -> dict[str, Array]:
    """The outputs, lanes first; `guard_change` is the `at` of `passes.guards.guard`."""
    text, names = _emit(subject, backend.target.name, guards, guard_change)
    calls = [
        Call(
            names.get(probe.function, probe.function),
            tuple(param.type for param in probe.params),
            probe.result,
            tuple(_argument(param, inputs) for param in probe.params),
        )
        for probe in subject.probes
    ]
    results = backend.run(text, calls, inputs.textures)
    return {
        probe.output: np.moveaxis(value, -1, 0) if value.ndim else value
        for probe, value in zip(subject.probes, results, strict=True)
    }


def _argument(param: Param, inputs: Inputs) -> Any:
    if isinstance(param.type, Sampler):
        return param.name
    value = inputs.values[param.name]
    return np.broadcast_to(value, (*value.shape[:-1], inputs.lanes))


_texts: dict[tuple[object, ...], tuple[Subject, Text, dict[str, str]]] = {}


def _emit(
    subject: Subject, target: str, guards: str, guard_change: Callable[[Site], str] | None
) -> tuple[Text, dict[str, str]]:
    """The functions form of a subject for a target, and its renamed functions."""
    key = (id(subject.module), target, guards, guard_change)
    cached = _texts.get(key)
    if cached is None or cached[0].module is not subject.module:
        compiled = transpile(subject.module, target, "evaluated", guards, subject.called, guard_change, subject.chained)
        file, reflection = next(name for name in compiled.files if not name.endswith(".json")), compiled.reflection
        if len(_texts) >= 256:
            _texts.clear()
        cached = _texts[key] = subject, file_text(compiled, reflection, file), reflection["renames"]
    return cached[1], cached[2]


def fit_inputs(subject: Subject, raw: Mapping[str, Any]) -> Inputs:
    """Inputs in the form of the subject's parameters, rounded to float32, which all back ends share.

    Raises SssgenError for an unknown or a missing name, a wrong shape, NaN and infinity.
    """
    params = subject.params
    for name in raw:
        if name not in params:
            hint = did_you_mean(name, params) or f"it takes: {', '.join(params)}"
            raise failure(f"{subject.name} has no input '{name}'", hint)
    values: dict[str, Array] = {}
    textures: dict[str, Texture] = {}
    for name, param in params.items():
        if isinstance(param.type, Sampler):
            textures[name] = _texture(subject, name, param.type, raw.get(name))
        elif name in raw:
            values[name] = _value(name, param.type, raw[name])
        elif name in subject.uniforms and subject.uniforms[name].default:
            default = np.array(subject.uniforms[name].default, np.float64)
            values[name] = _value(name, param.type, default.reshape(shape_of(param.type)))
        else:
            missing = [
                f"{name} ({spell(param.type)})"
                for name, param in params.items()
                if name not in raw and not isinstance(param.type, Sampler) and name not in subject.uniforms
            ]
            raise failure(f"{subject.name} needs more inputs: {', '.join(missing or [name])}")
    counts = {name: value.shape[-1] for name, value in values.items() if value.shape[-1] != 1}
    if len(set(counts.values())) > 1:
        lengths = ", ".join(f"{name} has {count}" for name, count in counts.items())
        raise failure(f"the inputs have different numbers of values: {lengths}", "a single value applies to all")
    return Inputs(values, textures, next(iter(counts.values()), 1))


def shape_of(type_: Type) -> tuple[int, ...]:
    """A value's axes without its lanes."""
    if isinstance(type_, Matrix):
        return type_.columns, type_.rows
    return (type_.size,) if isinstance(type_, Vector) else ()


def _value(name: str, type_: Type, raw: Any) -> Array:
    """An input, lanes last."""
    if isinstance(type_, ArrayType):
        raise failure(
            f"input '{name}' is an array of {spell(type_.element)}: techniques with arrays cannot be evaluated"
        )
    shape, expected = shape_of(type_), spell(type_)
    try:
        array = np.asarray(raw)
    except ValueError:
        raise failure(f"input '{name}': its rows have different lengths", f"a list of {expected}") from None
    if array.dtype.kind not in "fiub" or (kind_of(type_) == "bool") != (array.dtype.kind == "b"):
        raise failure(
            f"input '{name}' is not of type {expected}", "true or false" if kind_of(type_) == "bool" else "numbers"
        )
    if array.shape[array.ndim - len(shape) :] != shape or array.ndim > len(shape) + 1 or array.ndim < len(shape):
        each = ("a number", f"{components(type_)} numbers", f"{components(type_)} numbers in columns")[len(shape)]
        actual = "×".join(map(str, array.shape)) or "of one number"
        message = f"input '{name}' has the shape {actual}, not that of {expected}"
        raise failure(message, f"{each}, or a list of them")
    if array.ndim > len(shape) and not len(array):
        raise failure(f"input '{name}' is an empty list")
    if array.dtype.kind == "f" and not np.isfinite(array).all():
        bad = int(np.flatnonzero(~np.isfinite(array.reshape(-1, *shape)).all(axis=tuple(range(1, len(shape) + 1))))[0])
        raise failure(f"input '{name}' is NaN or infinite at number {bad}", "a shader's inputs are finite")
    kind = kind_of(type_)
    if kind in ("int", "uint"):
        info = np.iinfo(DTYPES[kind])
        if (array != np.floor(array)).any() or (array < info.min).any() or (array > info.max).any():
            raise failure(f"input '{name}' is not of type {expected}", f"whole numbers from {info.min} to {info.max}")
    elif kind == "float":
        with np.errstate(over="ignore"):
            array = array.astype(np.float32)
        if not np.isfinite(array).all():
            raise failure(f"input '{name}' is too large for a 32-bit float")
    array = array.astype(DTYPES[kind]).reshape(-1, *shape)
    return np.moveaxis(array, 0, -1)


_DEFAULTS = {"white": (1.0, 1.0, 1.0), "black": (0.0, 0.0, 0.0), "gray": (0.5, 0.5, 0.5), "bump": (0.5, 0.5, 1.0)}


def default_texture(type_: str, color: str) -> Texture:
    """One texel of `white`, `black`, `gray` or `bump`; `type_` as the language spells it: `sampler2D`, …"""
    dim = type_.removeprefix("sampler")
    data = np.ones((*{"2D": (1, 1), "3D": (1, 1, 1), "Cube": (6, 1, 1)}[dim], 4))
    data[..., :3] = _DEFAULTS[color]
    return Texture(data, dim=dim)


def default_of(uniform: Uniform) -> Texture:
    """One texel of the colour that a texture's declaration states."""
    return default_texture(spell(uniform.type), default_color(uniform))


def _texture(subject: Subject, name: str, type_: Sampler, raw: Any) -> Texture:
    """A texture rounded to float16, which all back ends share; one texel of the default if `raw` is None."""
    if raw is None:
        raw = default_of(subject.uniforms[name])
    if not isinstance(raw, Texture):
        try:
            raw = Texture(np.asarray(raw), dim=type_.dim)
        except ValueError as error:
            raise failure(f"texture '{name}': {error}", "(height, width, channels), in 3-D (depth, …)") from None
    if raw.dim != type_.dim:
        raise failure(f"texture '{name}' is {raw.dim}, and {subject.name} takes {with_article(spell(type_))}")
    if not all(np.isfinite(level).all() for level in raw.levels):
        raise failure(f"texture '{name}' contains NaN or infinity")
    return half(raw)


@lru_cache(64)
def half(texture: Texture, file: str = "") -> Texture:
    """The texture rounded to float16. Raises SssgenError for texels beyond the range of float16, of a `file`."""
    with np.errstate(over="ignore"):
        levels = [level.astype(np.float16) for level in texture.levels]
    if not all(np.isfinite(level).all() for level in levels):
        raise failure("a texture contains NaN, infinity or numbers beyond 65504", "texels are 16-bit floats", file)
    rounded = Texture(levels[0], texture.filter, texture.wrap, texture.dim)
    rounded.levels = levels
    return rounded
