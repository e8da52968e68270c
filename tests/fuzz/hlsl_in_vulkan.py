"""HLSL through DXC, whose SPIR-V Vulkan executes: neither spirv-cross nor OpenGL takes part.

Its pixels are computed one by one, so no control flow diverges. Functions only, without textures of their own.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from sssgen.run.backends import Array, Drawing
from sssgen.run.backends.backend_interface import backend_failure
from sssgen.run.backends.draw_backend import DrawingBackend
from sssgen.run.compilers import CompilerMissing
from sssgen.support.worker_process import LostError, Process

SECONDS = 60.0
_ENTRY = """
RWStructuredBuffer<uint4> sssgen_pixels : register(u0);
[numthreads(1, 1, 1)] void sssgen_compute(uint3 sssgen_pixel : SV_DispatchThreadID) {{
    sssgen_pixels[sssgen_pixel.y * {width}u + sssgen_pixel.x] = {main}(float4(float2(sssgen_pixel.xy) + 0.5, 0.0, 1.0));
}}
"""


class _Question(NamedTuple):
    """A compute shader, the number of its threads, and the texture of its arguments."""

    text: str
    size: tuple[int, int]
    data: Array


class HLSLInVulkan(DrawingBackend):
    """Asks a process of its own. Raises CompilerMissing where DXC or Vulkan is missing."""

    def __init__(self, name: str) -> None:
        super().__init__(name, "hlsl")
        self.process = Process(__name__, "", seconds=SECONDS)
        try:
            self.version = str(self.process.start())
        except LostError as reason:
            raise CompilerMissing(f"Vulkan {reason} as it started") from None

    def device(self) -> str:
        return self.version

    def draw(self, drawing: Drawing) -> Array:
        stage = drawing.fragment
        ((_, data),) = drawing.textures.items()
        text = stage.text.text + _ENTRY.format(width=drawing.size[0], main=stage.entry)
        try:
            picture: Array = self.process.ask(_Question(text, drawing.size, np.asarray(data.data)))
        except (LostError, ValueError) as error:
            raise backend_failure(self.name, str(error)) from None
        return picture

    def close(self) -> None:
        self.process.close()


def serve(_: str) -> tuple[str, Callable[[_Question], Array]]:
    """The device, and the function from questions to pictures. Raises CompilerMissing."""
    try:
        import compushady
        from compushady.formats import R32G32B32A32_UINT
        from compushady.shaders import hlsl

        device = compushady.get_current_device().name
    except Exception as error:
        raise CompilerMissing(f"compushady with a Vulkan device: {error}") from None

    def answer(question: _Question) -> Array:
        try:
            return pixels_of(question)
        except Exception as error:
            raise ValueError(f"{type(error).__name__}: {error}") from None

    def pixels_of(question: _Question) -> Array:
        width, height = question.size
        rows, columns, _ = question.data.shape
        texture = compushady.Texture2D(columns, rows, R32G32B32A32_UINT)
        upload = compushady.Buffer(texture.size, compushady.HEAP_UPLOAD)
        upload.upload2d(np.ascontiguousarray(question.data, np.uint32), texture.row_pitch, columns, rows, 16)
        upload.copy_to(texture)
        pixels = compushady.Buffer(16 * width * height, stride=16)
        shader = hlsl.compile(question.text, "sssgen_compute")
        compushady.Compute(shader, srv=[texture], uav=[pixels]).dispatch(width, height, 1)
        download = compushady.Buffer(pixels.size, compushady.HEAP_READBACK)
        pixels.copy_to(download)
        return np.frombuffer(download.readback(), np.uint32)[: 4 * width * height].reshape(height, width, 4)

    return f"DXC and Vulkan on {device}", answer
