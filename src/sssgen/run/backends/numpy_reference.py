"""The numpy target: the oracle in float64, and the same formulas in float32 and float16."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from sssgen.run.backends import call_program as programs
from sssgen.run.backends.backend_interface import Array, Backend, Call, Text, backend_failure
from sssgen.targets import registry
from sssgen.targets.runtime.numpy_textures import Texture
from sssgen.targets.runtime.numpy_values import grid, precision


class Reference(Backend):
    """Runs emitted Python; `dtype` is float64, float32 or float16."""

    def __init__(self, name: str, target: str, dtype: str) -> None:
        self.name, self.dtype = name, dtype
        self.target = registry.load(target)

    def device(self) -> str:
        return f"NumPy {np.__version__}, {self.dtype}"

    def run(self, text: Text, calls: Sequence[Call], textures: Mapping[str, Texture] | None = None) -> list[Array]:
        functions = namespace(text.text)
        return [self.call(functions, call, textures or {}) for call in calls]

    def call(self, functions: Mapping[str, Any], call: Call, textures: Mapping[str, Texture]) -> Array:
        """One call, on the same grid of pixels as in the other back ends, so that derivatives have neighbours."""
        lanes = max((np.shape(arg)[-1] for arg in call.args if not isinstance(arg, str)), default=1)
        shape = programs.grid(lanes)
        padded = shape.width * shape.rows
        args = [textures[arg] if isinstance(arg, str) else self._lanes(np.asarray(arg), padded) for arg in call.args]
        try:
            with precision(self.dtype), grid(shape.rows, shape.width):
                results = functions[call.function](*args)
                value, discarded = results if isinstance(results, tuple) else (results, None)
                value = value if discarded is None else np.where(discarded, np.zeros_like(value), value)
        except MemoryError:
            raise backend_failure(self.name, f"no memory for {lanes} evaluations of {call.function}") from None
        value = np.asarray(value)
        inner = value.shape[:-1] if value.ndim else ()
        return np.broadcast_to(value, (*inner, padded))[..., :lanes]

    def _lanes(self, value: Array, lanes: int) -> Array:
        """An argument in the working precision; unused lanes at the end of the grid are 0, as in a picture."""
        with np.errstate(over="ignore"):
            value = value.astype(self.dtype) if value.dtype.kind == "f" else value
        if value.shape[-1] == 1:
            return value
        return np.pad(value, [(0, 0)] * (value.ndim - 1) + [(0, lanes - value.shape[-1])])


@lru_cache(64)
def namespace(text: str) -> Mapping[str, Any]:
    """The names that emitted Python defines."""
    names: dict[str, Any] = {}
    exec(compile(text, "<emitted>", "exec"), names)
    return names
