"""Contracts: which values a shader's inputs may have. The range pass assumes them; `sssgen stress` draws from them.

A parameter's range follows from its quantity or from its name in the chain, a uniform's from its hints; any other
number has an ordinary size. A technique's result is within the range of its quantity, so that the next technique can
rely on it; if the range pass cannot prove that, the guard pass clamps it. Arguments of functions that are called from
outside are not clamped: a thickness may be any number.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import prod
from typing import NamedTuple

from sssgen.ir.formats import FLOAT32, Format
from sssgen.ir.intervals import INF, Range
from sssgen.ir.nodes import Param, Uniform, Variable
from sssgen.ir.surface_fields import COLORS, FRACTIONS
from sssgen.ir.types import FLOAT, VEC3, VEC4, Array, Matrix, Sampler, Type, kind_of
from sssgen.ir.vector_ranges import LENGTH, Contract

LONG = 300.0
"""The greatest length of a direction from outside in half precision. In float32 no length overflows."""
ONE = 1.0 + 2.0**-10
"""The largest thinness and transmittance: 1, and the error of imprecise functions."""
POSITION = {FLOAT32.name: 1e6, "half": 100.0}
"""The largest coordinate, length, time and number without a hint."""
THICKNESS = {FLOAT32.name: 1e12, "half": 1e4}
"""The longest path through matter: longer ones are as opaque."""
MATRIX = {FLOAT32.name: 1e3, "half": 10.0}
UV = {FLOAT32.name: 1e4, "half": 100.0}
COLOR = {FLOAT32.name: 65504.0, "half": 1000.0}
LIGHT = {FLOAT32.name: 1e9, "half": 1000.0}
"""The brightest light: a lamp's colour over its least squared distance, 1e-4 in the shells."""
NEAREST = 100.0
"""The largest light_nearness: 1 over the least distance in the shells."""
INTEGERS = {"int": (-(2.0**31), 2.0**31 - 1.0), "uint": (0.0, 2.0**32 - 1.0), "bool": (0.0, 1.0)}

_UNIT = {"thinness", "transmittance"}
_LENGTHS = {"thickness", "view_thickness"}
_COLORS = COLORS | {"light_color", "color", "translucency", "irradiance", "irradiance_behind"}
_FRAME = {"N", "V", "L", "T", "B", "normal"}


class Assumption(NamedTuple):
    """What is assumed of an input in place of its contract."""

    low: float = -INF
    high: float = INF
    """The range of each component."""
    shortest: float = 0.0
    longest: float = INF
    """The range of a vector's length, a number's size, or a matrix's stretch: how much longer it makes vectors."""
    finite: bool = False
    """No texel of a texture is infinite or NaN."""

    def applied(self, contract: Contract) -> Contract:
        """The contract with what is assumed."""
        return Contract(
            self.low if self.low > -INF else contract.low, self.high if self.high < INF else contract.high,
            min(self.longest, contract.length), self.finite or contract.finite, self.shortest,
        )  # fmt: skip


Assumed = Callable[[str, str, Type], Assumption | None]
"""What is assumed of an input, by its storage (uniform, varying, attribute or parameter), its name and its type."""


def of_param(param: Param, format: Format = FLOAT32, chained: bool = True) -> Contract:
    """The contract of a parameter of a technique, or, if not `chained`, of a function whose names have no meaning."""
    kind = kind_of(param.type)
    if kind != "float":
        return Contract(*INTEGERS.get(kind, (0.0, 0.0)))
    contract = of_quantity(param.quantity, format)
    if contract is None and chained:
        contract = of_name(param, format)
    if contract is not None:
        return contract
    return _around((MATRIX if isinstance(param.type, Matrix) else POSITION)[format.name])


def of_name(param: Param, format: Format = FLOAT32) -> Contract | None:
    """The contract of a value of the chain by its name; None for any other name."""
    if param.name in _FRAME and param.type == VEC3:
        return Contract(-LENGTH, LENGTH, LENGTH)
    if param.name in FRACTIONS and param.type == FLOAT:
        return Contract(0.0, 1.0)
    if param.name == "eye_distance" and param.type == FLOAT:
        return Contract(0.0, THICKNESS[format.name])
    if param.name == "light_nearness" and param.type == FLOAT:
        return Contract(0.0, NEAREST)
    if param.name == "vertex_color" and param.type == VEC4:
        return Contract(0.0, 1.0)
    if param.name in _COLORS and param.type == VEC3:
        return Contract(0.0, LIGHT[format.name] if param.name == "light_color" else COLOR[format.name])
    return None


def of_result(quantity: str, param: Param | None, format: Format = FLOAT32) -> Contract | None:
    """The contract that a result or an out parameter is clamped to, as others rely on it, or None."""
    contract = of_quantity(quantity, format)
    if contract is None and param is not None:
        contract = of_name(param, format)
    if contract is None or contract.length < float("inf") or quantity.endswith("_position"):
        return None
    return contract


def from_outside(param: Param, format: Format = FLOAT32, chained: bool = True) -> Contract:
    """The contract of an argument from outside: a quantity may be any number, as nothing has clamped it."""
    if param.quantity in _LENGTHS:
        return _around(format.largest)
    if param.quantity in _UNIT:
        return _around(POSITION[format.name])
    contract = of_param(param, format, chained)
    if contract.length < float("inf") and format.largest < LONG**4:
        return Contract(-LONG, LONG, LONG)  # its square would overflow
    return contract


def of_quantity(quantity: str, format: Format = FLOAT32) -> Contract | None:
    """The contract of a quantity; None for a plain number."""
    if quantity.endswith("_direction"):
        return Contract(-LENGTH, LENGTH, LENGTH)
    if quantity in _UNIT:
        return Contract(0.0, ONE)
    if quantity in _LENGTHS:
        return Contract(0.0, THICKNESS[format.name])
    if quantity.endswith("_position"):
        return _around((UV if quantity == "uv_position" else POSITION)[format.name])
    return None


def of_uniform(uniform: Uniform, format: Format = FLOAT32) -> Contract:
    """The contract of a uniform's components, or of a texture's texels."""
    type_ = uniform.type.element if isinstance(uniform.type, Array) else uniform.type
    hints: Mapping[str, tuple[float | str, ...]] = dict(uniform.hints)
    if isinstance(type_, Sampler):
        if "drawn" in hints:
            return Contract(0.0, THICKNESS[format.name])
        return Contract(0.0, 1.0, finite="holds" not in hints)
    kind = kind_of(type_)
    if "hint_range" in hints:
        low, high = [format.rounded(float(end)) if kind == "float" else float(end) for end in hints["hint_range"][:2]]
        return Contract(low if kind == "float" else min(low, 0.0), high)  # a count that is not set is 0
    if kind != "float":
        return Contract(*INTEGERS.get(kind, (0.0, 0.0)))
    if "source_color" in hints:
        return Contract(0.0, COLOR[format.name])  # it may be brighter than white
    contract = _around((MATRIX if isinstance(type_, Matrix) else POSITION)[format.name])
    return Contract(min([contract.low, *uniform.default]), max([contract.high, *uniform.default]))


def of_stage_input(variable: Variable, format: Format = FLOAT32) -> Contract:
    """The contract of an input of a stage: an attribute, a varying, a variable of GLSL such as gl_FragCoord."""
    kind = kind_of(variable.type)
    if kind != "float":
        return Contract(*INTEGERS.get(kind, (0.0, 0.0)))
    if variable.builtin == "gl_FragCoord":
        return Contract(0.0, POSITION[format.name])
    if variable.builtin == "gl_PointCoord":
        return Contract(0.0, 1.0)
    return _around((MATRIX if isinstance(variable.type, Matrix) else POSITION)[format.name])


GROUPS = 65535
"""The most workgroups along an axis (OpenGL's and WebGPU's least limit, D3D's limit)."""


def of_invocation(variable: Variable, workgroup: Sequence[int]) -> tuple[Range, ...]:
    """The components of a variable that places an invocation of a compute shader; () for any other variable."""
    if not workgroup:
        return ()
    if variable.builtin == "gl_LocalInvocationIndex":
        return (Range(0.0, prod(workgroup) - 1.0),)
    highs = {
        "gl_LocalInvocationID": [size - 1.0 for size in workgroup],
        "gl_GlobalInvocationID": [GROUPS * size - 1.0 for size in workgroup],
        "gl_WorkGroupID": [GROUPS - 1.0] * 3,
        "gl_NumWorkGroups": [float(GROUPS)] * 3,
    }.get(variable.builtin)  # fmt: skip
    if highs is None:
        return ()
    least = 1.0 if variable.builtin == "gl_NumWorkGroups" else 0.0
    return tuple([Range(least, high) for high in highs])


def alpha_at(uniform: Uniform) -> int | None:
    """Which component of a uniform is an opacity, 0 to 1."""
    return 3 if uniform.type == VEC4 and any(name == "source_color" for name, _ in uniform.hints) else None


def _around(size: float) -> Contract:
    return Contract(-size, size)
