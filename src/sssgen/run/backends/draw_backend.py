"""A back end that computes by drawing: what OpenGL, WebGPU and HLSL share."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence

from sssgen.run.backends import call_program as programs
from sssgen.run.backends.backend_interface import Array, Backend, Call, Drawing, Text, backend_failure
from sssgen.targets import registry
from sssgen.targets.runtime.numpy_textures import Texture


class DrawingBackend(Backend):
    """Draws programs. `top_first`: whether the first row of a picture is at the top."""

    top_first = False
    draw_seconds = 0.0
    """The duration of the last draw in seconds; in WebGPU with the read of the picture."""

    largest: Mapping[str, int] = {}
    """The most texels along a side of a 2D, 3D or Cube texture; other kinds have no limit."""

    def __init__(self, name: str, target: str) -> None:
        self.name = name
        self.target = registry.load(target)

    def check(self, drawing: Drawing) -> None:
        """Raises SssgenError for a texture or a picture that is too large for the driver: not all drivers report it."""
        for name, bound in drawing.textures.items():
            if isinstance(bound.data, Texture):
                side, most = max(bound.data.size()), self.largest.get(bound.data.dim, 1 << 30)
                if side > most:
                    raise backend_failure(
                        self.name, f"texture '{name}' is {side} texels wide", f"this driver takes {most}"
                    )
        most = self.largest.get("2D", 1 << 30)
        if max(drawing.size) > most:
            raise backend_failure(
                self.name, f"{drawing.size[0]} × {drawing.size[1]} is too large", f"at most {most} on a side"
            )

    @abstractmethod
    def draw(self, drawing: Drawing) -> Array:
        """The picture, (height, width, 4) of uint32 or float32, its rows as the driver counts them.

        Raises SssgenError where the driver refuses the program or gives up.
        """

    def run(self, text: Text, calls: Sequence[Call], textures: Mapping[str, Texture] | None = None) -> list[Array]:
        drawing, layout = programs.drawing(self.target, text, calls, textures or {})
        return programs.results(calls, layout, self.draw(drawing))
