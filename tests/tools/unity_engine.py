"""Draws with the stand-in headers of Unity as those of any version, with values and keywords of the engine."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from lamp_scene import SIZE
from sssgen.run.backends import Array, Backend
from sssgen.run.backends.unity_backend import UnityHLSL
from sssgen.run.render import unity_values
from sssgen.run.render.scene_render import render
from sssgen.scene.scene import Scene


def drawing(machine: Backend, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Array]:
    """`draw(scene, version, keywords, **values)`: the linear picture. Keywords replace `_ADDITIONAL_LIGHTS`."""
    assert isinstance(machine, UnityHLSL)
    if machine.unity.real:
        pytest.skip("SSSGEN_UNITY_INCLUDES is set: only the stand-in headers let a test choose the engine's values")
    forward, engine = machine.forward, unity_values._engine

    def draw(described: Scene, version: int, keywords: tuple[str, ...] = (), **values: Any) -> Array:
        def with_keywords(shader: Any, stage: Any, given: Any) -> Any:
            kept = [word for word in given if not keywords or word != "_ADDITIONAL_LIGHTS=1"]
            return forward(shader, stage, [*kept, *keywords])

        own = {name: np.array(value) for name, value in values.items()}
        monkeypatch.setattr(machine.unity, "unity_version", version)
        monkeypatch.setattr(machine, "forward", with_keywords)
        monkeypatch.setattr(unity_values, "_engine", lambda *arguments: engine(*arguments) | own)
        return render(described, machine, SIZE).linear

    return draw
