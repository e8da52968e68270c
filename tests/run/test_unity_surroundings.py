"""The light of ambient colours and probes that comes through a body in Unity's shaders, on the stand-ins."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lamp_scene import SIZE
from sssgen.run.backends import Backend
from sssgen.scene.scene_loading import parse_scene
from surroundings_cases import BOTH_SIDES
from unity_engine import drawing

MATERIAL = """[material]
name = "m"
[[surface]]
technique = "base_color"
tint = [0.0, 0.0, 0.0, 1.0]
[translucency]
technique = "./made.sss"
"""
SLOPE, MEAN = (0.1, 0.3, -0.2), 0.5
"""Of the light on a white matte surface, over its normal."""


@pytest.mark.parametrize("target", ["unity", "unity-urp"])
def test_light_of_the_surroundings_comes_through(
    target: str, backend: Callable[[str], Backend], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Red has the light in front of the surface, green the one behind it."""
    draw = drawing(backend(target), monkeypatch)
    (tmp_path / "made.sss").write_text(BOTH_SIDES, "utf-8")
    (tmp_path / "m.toml").write_text(MATERIAL, "utf-8")
    scene = parse_scene('material = "m.toml"\nsamples = 1\n[geometry]\nkind = "ball"\n', tmp_path / "scene.toml")
    picture = draw(scene, 60000100, **{f"unity_SHA{channel}": [*SLOPE, MEAN] for channel in "rgb"})[::-1]
    assert scene.geometry is not None
    hits = scene.geometry.hits(*scene.camera.rays(*SIZE))
    seen = hits.hit.reshape(SIZE[1], SIZE[0])
    facing = hits.normal[hits.hit] @ SLOPE
    front, behind, _ = picture[seen].T
    assert seen.sum() > 200 and np.ptp(facing) > 0.4
    assert np.abs(front - (MEAN + facing)).max() < 1e-4
    assert np.abs(behind - (MEAN - facing)).max() < 1e-4
