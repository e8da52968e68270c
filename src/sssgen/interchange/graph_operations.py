"""What MaterialX's nodes compute from numbers: one row per node, as a function of arrays.

The last axis of an array has the components. Nodes that MaterialX defines by a graph of other nodes are not here.
Source: MaterialX Specification 1.39, Standard Nodes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[Any]


class Operation(NamedTuple):
    """A node's inputs in the order of the function's arguments."""

    inputs: tuple[str, ...]
    function: Callable[..., Array]


def _rows(inputs: tuple[str, ...], **functions: Callable[..., Array]) -> dict[str, Operation]:
    """The operations of nodes that have the same inputs."""
    return {name: Operation(inputs, function) for name, function in functions.items()}


def _length(a: Array) -> Array:
    return np.asarray(np.linalg.norm(a, axis=-1, keepdims=True))


def _dot(a: Array, b: Array) -> Array:
    return np.asarray((a * b).sum(axis=-1, keepdims=True))


def _smoothstep(a: Array, low: Array, high: Array) -> Array:
    t = np.clip((a - low) / (high - low), 0.0, 1.0)
    return np.asarray(t * t * (3.0 - 2.0 * t))


def _luminance(a: Array, weights: Array) -> Array:
    luminance = np.broadcast_to((a[..., :3] * weights[..., :3]).sum(axis=-1, keepdims=True), a[..., :3].shape)
    return np.concatenate([luminance, a[..., 3:]], axis=-1)


def _hsv_of_rgb(a: Array) -> Array:
    red, green, blue = (a[..., index] for index in range(3))
    value = a[..., :3].max(axis=-1)
    span = value - a[..., :3].min(axis=-1)
    safe = np.where(span > 0.0, span, 1.0)
    sector = np.where(
        value == red, (green - blue) / safe, np.where(value == green, 2 + (blue - red) / safe, 4 + (red - green) / safe)
    )
    hue = np.where(span > 0.0, np.mod(sector / 6.0, 1.0), 0.0)
    saturation = np.where(value > 0.0, span / np.where(value > 0.0, value, 1.0), 0.0)
    return np.concatenate([np.stack([hue, saturation, value], axis=-1), a[..., 3:]], axis=-1)


def _rgb_of_hsv(a: Array) -> Array:
    hue, saturation, value = (a[..., index : index + 1] for index in range(3))
    wheel = np.clip(np.abs(np.mod(hue * 6.0 + np.array([0.0, 4.0, 2.0]), 6.0) - 3.0) - 1.0, 0.0, 1.0)
    return np.concatenate([value * (1.0 + saturation * (wheel - 1.0)), a[..., 3:]], axis=-1)


def _blend(blend: Callable[[Array, Array], Array]) -> Callable[..., Array]:
    """A blend of foreground and background, with the share `mix` of it."""
    return lambda fg, bg, mix: mix * blend(fg, bg) + (1.0 - mix) * bg


_EPSILON = 1e-8

OPERATIONS: Mapping[str, Operation] = {
    **_rows(
        ("in1", "in2"),
        add=np.add, subtract=np.subtract, multiply=np.multiply, divide=np.divide, modulo=np.mod,
        power=lambda a, b: np.sign(a) * np.power(np.abs(a), b),
        min=np.minimum, max=np.maximum, dotproduct=_dot,
    ),
    **_rows(
        ("in",),
        absval=np.abs, floor=np.floor, ceil=np.ceil, round=np.round, sign=np.sign, exp=np.exp,
        sqrt=lambda a: np.sqrt(np.maximum(a, 0.0)),
        ln=lambda a: np.log(np.maximum(a, 1e-30)),
        sin=np.sin, cos=np.cos, tan=np.tan, asin=np.arcsin, acos=np.arccos,
        fract=lambda a: a - np.floor(a),
        normalize=lambda a: a / np.maximum(_length(a), _EPSILON),
        magnitude=_length, rgbtohsv=_hsv_of_rgb, hsvtorgb=_rgb_of_hsv,
    ),
    **_rows(
        ("fg", "bg", "mix"),
        plus=_blend(np.add),
        minus=_blend(lambda fg, bg: bg - fg),
        difference=_blend(lambda fg, bg: np.abs(bg - fg)),
        screen=_blend(lambda fg, bg: 1.0 - (1.0 - fg) * (1.0 - bg)),
        burn=_blend(lambda fg, bg: 1.0 - (1.0 - bg) / np.maximum(fg, _EPSILON)),
        dodge=_blend(lambda fg, bg: bg / np.maximum(1.0 - fg, _EPSILON)),
    ),
    "atan2": Operation(("iny", "inx"), np.arctan2),
    "invert": Operation(("amount", "in"), np.subtract),
    "clamp": Operation(("in", "low", "high"), np.clip),
    "mix": Operation(("bg", "fg", "mix"), lambda bg, fg, share: bg + (fg - bg) * share),
    "remap": Operation(
        ("in", "inlow", "inhigh", "outlow", "outhigh"),
        lambda a, low, high, out_low, out_high: out_low + (a - low) * (out_high - out_low) / (high - low),
    ),
    "smoothstep": Operation(("in", "low", "high"), _smoothstep),
    "luminance": Operation(("in", "lumacoeffs"), _luminance),
    "transformmatrix": Operation(("in", "mat"), lambda a, matrix: a @ matrix.reshape(a.shape[-1], a.shape[-1])),
    "inside": Operation(("in", "mask"), np.multiply),
    "outside": Operation(("in", "mask"), lambda a, mask: a * (1.0 - mask)),
}  # fmt: skip

COMPARISONS: Mapping[str, Callable[[Array, Array], Array]] = {
    "ifgreater": np.greater,
    "ifgreatereq": np.greater_equal,
    "ifequal": np.equal,
}
"""Nodes that take `in1` where the comparison of `value1` with `value2` holds, else `in2`."""

MEANS: Mapping[str, float] = {
    "cellnoise2d": 0.5,
    "cellnoise3d": 0.5,
    "worleynoise2d": 0.5,
    "worleynoise3d": 0.5,
    "unifiednoise2d": 0.5,
    "unifiednoise3d": 0.5,
}
"""The mean of a procedural node; 0 for those that are not listed. Noise of Perlin has its `pivot`."""
