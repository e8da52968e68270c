"""Bevy's WESL: linked by npm wesl, then run as other WGSL in wgpu."""

from __future__ import annotations

from sssgen.run import compilers
from sssgen.run.backends.backend_interface import Array, Drawing, Stage, refusal
from sssgen.run.backends.webgpu import WebGPU
from sssgen.run.compilers import Message
from sssgen.run.compilers.bevy_compiler import Bevy


class BevyWGSL(WebGPU):
    """The functions of the target `bevy`, as the linker writes them."""

    def __init__(self, name: str, target: str) -> None:
        super().__init__(name, target)
        linker = compilers.get("bevy")
        assert isinstance(linker, Bevy)
        self.linker = linker

    def device(self) -> str:
        return f"{self.linker.linker()}, {super().device()}"

    def draw(self, drawing: Drawing) -> Array:
        vertex = self.link(drawing.vertex) if drawing.vertex is not None else None
        return super().draw(drawing._replace(fragment=self.link(drawing.fragment), vertex=vertex))

    def link(self, stage: Stage) -> Stage:
        """A stage with the linker's text."""
        try:
            text = self.linker.link(stage.text.text, ())
        except ValueError as error:
            raise refusal(self.name, stage.text, [Message("error", 0, 0, str(error))]) from None
        return stage._replace(text=stage.text._replace(text=text))
