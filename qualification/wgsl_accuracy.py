"""The accuracy that WGSL's specification promises (the section "Floating-point accuracy"), as functions of arguments.

    shares(backends.get("webgpu"), cases(2000))["exp"]   # the largest error, as a share of what is allowed there

The WebGPU conformance tests hold a device to the same limits. Where a builtin inherits the accuracy of an expression,
the limit is that of the expression's operations, each with its own. A builtin that WGSL has not, such as `mod`, has
none.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from qualification.parity import lanes_of, oracle, run, supported
from qualification.parity_inputs import Case, widened
from sssgen.run.backends import Array, Backend

WGSL_BACKENDS = ("webgpu", "browser", "firefox")
"""The back ends that run WGSL."""

Limit = Callable[..., Array]
"""From arguments to the largest absolute error; infinity where the specification has no limit."""


def _ulp(value: Array) -> Array:
    """A unit in the last place of float32, at the size of a number."""
    return np.spacing(np.abs(value).astype(np.float32)).astype(np.float64)


def _correct(function: Callable[..., Array]) -> Limit:
    """Correctly rounded: the result is one of both neighbours."""
    return lambda *args: _ulp(function(*args))


def _near_zero(x: Array, limit: Array | float) -> Array:
    """A limit between -pi and pi."""
    return np.asarray(np.where(np.abs(x) <= np.float32(np.pi), limit, np.inf))


def _log(x: Array) -> Array:
    return np.where((x >= 0.5) & (x <= 2.0), 2.0**-21, 3.0 * _ulp(np.log(x)))


def _log2(x: Array) -> Array:
    return np.where((x >= 0.5) & (x <= 2.0), 2.0**-21, 3.0 * _ulp(np.log2(x)))


def _exp(x: Array) -> Array:
    return (3.0 + 2.0 * np.abs(x)) * _ulp(np.exp(x))


def _exp2(x: Array) -> Array:
    return (3.0 + 2.0 * np.abs(x)) * _ulp(np.exp2(x))


def _pow(x: Array, y: Array) -> Array:
    """That of exp2(y * log2(x))."""
    exponent = y * np.log2(x)
    apart = np.abs(y) * _log2(x) + _ulp(exponent)
    return np.asarray(np.exp2(exponent) * np.expm1(np.log(2.0) * apart) + _exp2(exponent))


def _sinh(x: Array) -> Array:
    """That of (exp(x) - exp(-x)) * 0.5; cosh has the same."""
    return 0.5 * (_exp(x) + _exp(-x)) + _ulp(np.cosh(x))


def _tanh(x: Array) -> Array:
    share = (_sinh(x) / np.abs(np.sinh(x)) + _sinh(x) / np.cosh(x)) * np.abs(np.tanh(x))
    return np.asarray(np.maximum(1e-5, share + 2.5 * _ulp(np.tanh(x))))


def _tan(x: Array) -> Array:
    """That of sin(x) / cos(x)."""
    apart, cosine = 2.0**-11, np.abs(np.cos(x))
    bound = apart * (1.0 + np.abs(np.tan(x))) / np.maximum(cosine - apart, 1e-30) + 2.5 * _ulp(np.tan(x))
    return _near_zero(x, np.where(cosine > apart, bound, np.inf))


def _sqrt(x: Array) -> Array:
    """That of 1 / inverseSqrt(x)."""
    return np.asarray(2.0 * 2.0**-23 * np.sqrt(x) + 2.5 * _ulp(np.sqrt(x)))


def _log_of(argument: Array, apart: Array) -> Array:
    """That of the logarithm of an argument that has an error itself."""
    own = np.maximum(_log(argument), _log(argument + apart))
    return np.asarray(own + apart / np.maximum(argument - apart, 1e-30))


def _asinh(x: Array) -> Array:
    """That of log(x + sqrt(x * x + 1)); below 0, where this cancels, that of -x."""
    x = np.abs(x)
    root = np.sqrt(x * x + 1.0)
    apart = (_ulp(x * x) + _ulp(root * root)) / (2.0 * root) + _sqrt(root * root) + _ulp(x + root)
    return _log_of(x + root, apart)


def _acosh(x: Array) -> Array:
    """That of log(x + sqrt(x * x - 1))."""
    square = x * x - 1.0
    below = np.maximum(square - _ulp(x * x) - _ulp(square), 0.0)
    apart = np.sqrt(square) - np.sqrt(below) + _sqrt(np.maximum(square, 1e-30)) + _ulp(x + np.sqrt(square))
    return _log_of(x + np.sqrt(square), apart)


def _atanh(x: Array) -> Array:
    """That of log((1 + x) / (1 - x)) * 0.5."""
    quotient = (1.0 + x) / (1.0 - x)
    apart = quotient * (_ulp(1.0 + x) / (1.0 + x) + _ulp(1.0 - x) / (1.0 - x)) + 2.5 * _ulp(quotient)
    return 0.5 * _log_of(quotient, apart) + _ulp(np.arctanh(x))


def _mix(x: Array, y: Array, a: Array) -> Array:
    """That of x * (1 - a) + y * a, or of x + (y - x) * a."""
    first, second, way = x * (1.0 - a), y * a, (y - x) * a
    precise = np.abs(x) * _ulp(1.0 - a) + _ulp(first) + _ulp(second) + _ulp(np.abs(first) + np.abs(second))
    return np.asarray(np.maximum(precise, np.abs(a) * _ulp(y - x) + _ulp(way) + _ulp(np.abs(x) + np.abs(way))))


def _smoothstep(low: Array, high: Array, x: Array) -> Array:
    """That of t * t * (3 - 2 * t) for t = clamp((x - low) / (high - low), 0, 1)."""
    t = np.clip((x - low) / (high - low), 0.0, 1.0)
    apart = t * (_ulp(x - low) / np.maximum(np.abs(x - low), 1e-30) + _ulp(high - low) / np.abs(high - low))
    steep = 6.0 * t * (1.0 - t) * (apart + 2.5 * _ulp(t)) + 6.0 * apart * apart
    return np.asarray(steep + 12.0 * 2.0**-23 * t * t)


LIMITS: dict[str, Limit] = {
    "radians": lambda x: 1.5 * _ulp(np.radians(x)),
    "degrees": lambda x: 1.5 * _ulp(np.degrees(x)),
    "sin": lambda x: _near_zero(x, 2.0**-11),
    "cos": lambda x: _near_zero(x, 2.0**-11),
    "tan": _tan,
    "asin": lambda x: np.maximum(6.81e-5, 4096.0 * _ulp(np.arcsin(x))),
    "acos": lambda x: np.maximum(6.77e-5, 4096.0 * _ulp(np.arccos(x))),
    "atan": lambda y, x=None: 4096.0 * _ulp(np.arctan(y) if x is None else np.arctan2(y, x)),
    "sinh": _sinh,
    "cosh": _sinh,
    "tanh": _tanh,
    "asinh": _asinh,
    "acosh": _acosh,
    "atanh": _atanh,
    "pow": _pow,
    "exp": _exp,
    "exp2": _exp2,
    "log": _log,
    "log2": _log2,
    "sqrt": _sqrt,
    "inversesqrt": lambda x: 2.0 * _ulp(1.0 / np.sqrt(x)),
    "abs": _correct(np.abs),
    "sign": _correct(np.sign),
    "floor": _correct(np.floor),
    "ceil": _correct(np.ceil),
    "trunc": _correct(np.trunc),
    "fract": lambda x: _ulp(x - np.floor(x)),
    "min": _correct(np.minimum),
    "max": _correct(np.maximum),
    "mix": _mix,
    "fma": lambda a, b, c: _ulp(a * b) + _ulp(np.abs(a * b) + np.abs(c)),
    "smoothstep": _smoothstep,
}
"""Name → limit, of the builtins that work by components."""


def shares(backend: Backend, chosen: Sequence[Case]) -> dict[str, float]:
    """Builtin → the largest error of a back end, as a share of the limit: at most 1 where the promise is kept."""
    held = [
        case
        for case in chosen
        if case.name in LIMITS and supported(case, backend) and all(isinstance(arg, np.ndarray) for arg in case.args)
    ]
    largest: dict[str, float] = {}
    for case, actual in zip(held, run(backend, held), strict=True):
        if actual.dtype.kind == "f":
            largest[case.name] = max(largest.get(case.name, 0.0), share(case, actual))
    return largest


def share(case: Case, actual: Array) -> float:
    """The largest error of a result, as a share of the limit, over the lanes that every language defines."""
    with np.errstate(all="ignore"):
        limit = LIMITS[case.name](*[np.asarray(arg, np.float64) for arg in widened(case.args)])
        error = np.nan_to_num(np.abs(actual.astype(np.float64) - oracle(case)), nan=np.inf)
        of_limit = np.where(np.isfinite(limit) & (error > 0.0), error / limit, 0.0)
    measured = lanes_of(case, actual).measured
    lanes = np.broadcast_to(of_limit, actual.shape)[..., measured]
    return float(lanes.max(initial=0.0))
