"""Plain inputs for a technique; a row of the table of dangerous inputs changes those that it tests."""

from __future__ import annotations

from typing import Any

import numpy as np

from sssgen.analyse.stress.contract_inputs import DTYPES, contract, fixed_value, is_direction
from sssgen.analyse.stress.subject import Specimen
from sssgen.ir.formats import FLOAT16, FLOAT32, Format
from sssgen.ir.nodes import Intrinsic
from sssgen.ir.types import Matrix, Sampler, kind_of
from sssgen.ir.walk import all_expressions
from sssgen.run.backends import Array
from sssgen.run.evaluate.evaluation import Inputs, default_of, shape_of
from sssgen.targets.runtime.numpy_textures import Texture

_PLAIN: dict[str, Any] = {
    "N": (0, 0, 1), "V": (0, 0, 1), "L": (0, 0, -1), "T": (1, 0, 0), "B": (0, 1, 0), "normal": (0, 0, 1),
    "ray_origin": (0, 0, 3), "ray_direction": (0, 0, -1), "uv": (0.3, 0.6), "P": (0.1, 0.2, 0.5),
    "P_object": (0.1, 0.2, 0.5), "V_object": (0, 0, 1), "L_object": (0, 0, -1), "alpha": 1, "time": 1,
    "screen_uv": (0.3, 0.6), "eye_distance": 3, "light_nearness": 0.25, "uv2": (0.7, 0.4),
    "vertex_color": (0.8, 0.6, 0.4, 0.9), "specular": 0.04,
    "irradiance": (0.6, 0.7, 0.8), "irradiance_behind": (0.3, 0.2, 0.1),
}  # fmt: skip
_OF_QUANTITY = {"thickness": 0.1, "view_thickness": 0.1, "thinness": 0.5, "transmittance": 0.5}


def plain(specimen: Specimen, lanes: int, overrides: dict[str, Any] | None = None) -> Inputs:
    """Defaults for uniforms, a lit surface for parameters; `overrides`, lanes last, replaces the values of such inputs.

    A texture in `overrides` has its uniform's name as the key.
    """
    values: dict[str, Array] = {}
    textures: dict[str, Texture] = {}
    changes = overrides or {}
    for name, param in specimen.subject.params.items():
        if isinstance(param.type, Sampler):
            textures[name] = changes.get(name) or default_of(specimen.subject.uniforms[name])
        elif name in changes and name not in specimen.settings:
            values[name] = _with_shape(changes[name], shape_of(param.type))
        elif name in specimen.subject.uniforms:
            values[name] = fixed_value(specimen, name)
        else:
            value = np.asarray(_PLAIN.get(name, 0.5))
            if value.shape != shape_of(param.type) or name not in _PLAIN:
                value = np.asarray(_OF_QUANTITY.get(param.quantity, 0.5))
            if isinstance(param.type, Matrix):
                value = np.eye(param.type.columns, param.type.rows)
            lane = np.broadcast_to(value[..., None], (*shape_of(param.type), 1))
            values[name] = lane.astype(DTYPES[kind_of(param.type)])
    return Inputs(values, textures, lanes)


def _with_shape(value: Any, shape: tuple[int, ...]) -> Array:
    """Numbers or vectors, lanes last; a number for a vector goes into all its components."""
    array = np.asarray(value)
    array = array.astype(np.float32) if array.dtype.kind == "f" else array
    array = np.broadcast_to(array, shape) if not array.ndim else array
    array = array[..., None] if array.ndim == len(shape) else array
    return np.ascontiguousarray(np.broadcast_to(array, (*shape, array.shape[-1])))


def mix(specimen: Specimen, choices: dict[str, list[Any]], lanes: int = 4096) -> Inputs:
    """Each lane has one of the choices of each input; the other inputs are plain."""
    rng = np.random.default_rng(7)
    changes = {}
    for name, listed in choices.items():
        if name in specimen.subject.params:
            shape = shape_of(specimen.subject.params[name].type)
            each = np.stack([np.broadcast_to(np.asarray(choice, np.float32), shape) for choice in listed], axis=-1)
            changes[name] = each[..., rng.integers(0, len(listed), lanes)]
    return plain(specimen, lanes, changes)


def directions(specimen: Specimen) -> list[str]:
    """The inputs that are directions of three components."""
    return [
        name
        for name, param in specimen.subject.params.items()
        if shape_of(param.type) == (3,) and is_direction(name, contract(specimen, name))
    ]


def scalars(specimen: Specimen, format: Format = FLOAT32) -> dict[str, list[float]]:
    """For each scalar input: the ends of its range, and 0, 1 and nearly 0, if these are in the range."""
    least = 1e-3 if format is FLOAT16 else 1e-30
    choices = {}
    for name, param in specimen.subject.params.items():
        if kind_of(param.type) == "float" and not isinstance(param.type, Matrix) and name not in directions(specimen):
            ends = contract(specimen, name, format)
            inner = [value for value in (0.0, least, 1.0) if ends.low <= value <= ends.high]
            choices[name] = [ends.low, ends.high, *inner]
    return choices


def calls(specimen: Specimen, *names: str) -> bool:
    """Whether a technique calls one of these builtins."""
    bodies = [function.body or () for function in specimen.subject.module.functions]
    return any(isinstance(expr, Intrinsic) and expr.name in names for body in bodies for expr in all_expressions(body))


def samplers(specimen: Specimen, data: bool = False) -> list[str]:
    """The textures; with `data` only those that hold a quantity or distances."""
    names = []
    for name, uniform in specimen.subject.uniforms.items():
        if isinstance(uniform.type, Sampler) and (not data or uniform.quantity or "distance" in name):
            names.append(name)
    return names


def angles(start: float, end: float, count: int = 2001) -> tuple[Array, Array]:
    """Sines and cosines of evenly spaced angles, in degrees."""
    angle = np.radians(np.linspace(start, end, count))
    return np.sin(angle), np.cos(angle)
