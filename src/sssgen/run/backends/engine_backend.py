"""Engines as back ends: they draw a scene with its emitted material, lit by their own lights."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from sssgen.run.backends.backend_interface import Array, Backend, Call, Text, backend_failure
from sssgen.run.backends.engine_page import EnginePage
from sssgen.run.backends.godot_drawing import Godot
from sssgen.run.backends.web_engines import BABYLON, PLAYCANVAS, THREE
from sssgen.targets import registry
from sssgen.targets.runtime.numpy_textures import Texture

_PAGES = {engine.target: engine for engine in (BABYLON, PLAYCANVAS, THREE)}
"""The engines of the web, by their targets."""


class EngineBackend(Backend):
    """An engine. It evaluates no functions: it only draws scenes."""

    def __init__(self, name: str, target: str) -> None:
        self.name = name
        self.target = registry.load(target)

    def run(self, text: Text, calls: Sequence[Call], textures: Mapping[str, Texture] | None = None) -> list[Array]:
        raise backend_failure(self.name, "an engine draws scenes and evaluates no functions")


class PageBackend(EngineBackend):
    """One renderer of an engine of the web, in a headless Chromium."""

    def __init__(self, name: str, target: str, renderer: str) -> None:
        super().__init__(name, target)
        self.page = EnginePage(_PAGES[target], renderer)

    def device(self) -> str:
        return f"{self.page.engine.title} {self.page.version} in Chromium, {self.page.name}"


class GodotBackend(EngineBackend):
    """One renderer of Godot."""

    def __init__(self, name: str, target: str, renderer: str) -> None:
        super().__init__(name, target)
        self.godot = Godot(renderer)

    def device(self) -> str:
        return f"Godot, {self.godot.renderer}"
