"""The results of a plain GLSL function `f` in every target, run by its back end."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from sssgen.ir.types import Sampler
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Backend, Call, Text
from sssgen.targets.runtime.numpy_textures import Texture

BACKENDS = ("numpy", "gl", "gl-es", "webgpu", "hlsl", "hlsl-glslang", "unity", "metal")
LANES = 4


def results_of(
    text: str,
    backend: Backend,
    args: Sequence[float] = (),
    textures: Mapping[str, Texture] | None = None,
    guards: str = "none",
) -> Any:
    """The result of `f` for these numbers and, as its last arguments, the uniforms that it reads.

    A texture of `f`, a parameter or a uniform, has the name of its texture in `textures`.
    """
    module = load_glsl_text(text, "case.glsl").module
    files = transpile(module, backend.target.name, "case", guards, keep=True).files
    emitted = next(content for name, content in files.items() if not name.endswith(".json"))
    function = next(function for function in module.functions if function.name == "f")
    params = [(param.name, param.type) for param in function.params]
    params += [(uniform.name, uniform.type) for uniform in module.uniforms]
    numbers = iter(args)
    values = tuple(
        name if isinstance(type_, Sampler) else np.full(LANES, next(numbers), np.float32) for name, type_ in params
    )
    call = Call("f", tuple(type_ for _, type_ in params), function.result, values)
    (result,) = backend.run(Text(emitted), [call], textures or {})
    return np.broadcast_to(np.asarray(result), (*np.shape(result)[:-1], LANES))[..., 0]


def check_results(
    text: str,
    expected: Any,
    get: Callable[[str], Backend],
    args: Sequence[float] = (),
    textures: Mapping[str, Texture] | None = None,
    backends: Sequence[str] = BACKENDS,
) -> None:
    """Fails where a back end computes another result."""
    for name in backends:
        result = results_of(text, get(name), args, textures)
        np.testing.assert_allclose(result, expected, 1e-4, 1e-4, err_msg=f"{name}: {text}")
