"""Levels of detail: each level of a material has the values of the material with only that level's stages."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from slow_cases import back_end_cases
from sssgen.run.backends import Backend
from sssgen.run.render.scene_render import render
from sssgen.scene.scene_loading import load

DRAWING = ["numpy", "gl", "gl-es", "webgpu", "hlsl", "metal", "unity-urp"]
ENGINES = ["threejs", "babylonjs", "playcanvas", "godot"]
LEVELS = 3
# A level whose light has a thickness of its own, one whose thickness all lights share, and one without thickness. The
# third level has no stage of its own in [translucency] but the one that it shares with the first.
STAGES: list[tuple[str, tuple[int, ...]]] = [
    ('[[thickness]]\ntechnique = "march_light"\nbind = { body_distance = "sphere" }\nradius = 0.5', (0,)),
    ('[[thickness]]\ntechnique = "beer_lambert"\nattenuation_distance = 0.3', (0,)),
    ('[[thickness]]\ntechnique = "constant_thickness"\nthickness_factor = 0.4', (1,)),
    ('[[thickness]]\ntechnique = "beer_lambert"\nattenuation_distance = 0.2', (1,)),
    ('[[surface]]\ntechnique = "base_color"\ntint = [0.5, 0.4, 0.3, 1.0]', (0, 2)),
    ('[[surface]]\ntechnique = "base_color"\ntint = [0.2, 0.4, 0.8, 1.0]', (1,)),
    ('[[surface]]\ntechnique = "pbr_constants"\nsurface_roughness = 0.6', ()),
    ('[[translucency]]\ntechnique = "lobe_normalized"\npower = 2.0', (0, 1)),
    ('[[translucency]]\ntechnique = "wrap_lighting"\nwrap = 0.4', (0, 2)),
]
SCENE = """
material = "ball.toml"
size = [20, 16]
samples = 1
ambient = [0.1, 0.2, 0.15]
[geometry]
kind = "distance"
technique = "sphere"
parameters = { radius = 0.5 }
reach = 1.0
[camera]
position = [0.3, 0.4, 1.6]
target = [0.0, 0.0, 0.0]
[[light]]
direction = [-0.4, 0.3, 0.9]
color = [0.9, 0.8, 0.7]
[[light]]
direction = [0.3, 0.2, -0.9]
color = [1.0, 0.9, 0.6]
"""


def material_text(level: int | None) -> str:
    """The material with all levels, or with the stages of one."""
    head = '[material]\nname = "ball"\n' + (f"levels = {LEVELS}\n" if level is None else "")
    parts = [head]
    for stage, levels in STAGES:
        if level is None:
            parts.append(f"{stage}\nlevel = {list(levels)}\n" if levels else f"{stage}\n")
        elif not levels or level in levels:
            parts.append(f"{stage}\n")
    return "\n".join(parts)


def picture(folder: Path, material: str, parameters: str, backend: Backend) -> np.ndarray:
    (folder / "ball.toml").write_text(material)
    (folder / "scene.toml").write_text(SCENE + parameters)
    return render(load(folder / "scene.toml"), backend).linear


@pytest.mark.parametrize("name", back_end_cases([*DRAWING, *ENGINES]))
def test_a_level_has_the_values_of_its_own_stages(name: str, backend: Callable[[str], Backend], tmp_path: Path) -> None:
    driver = backend(name)
    alone = [picture(tmp_path, material_text(level), "", driver) for level in range(LEVELS)]
    for number in range(LEVELS):
        switched = picture(tmp_path, material_text(None), f"[parameters]\ndetail_level = {number}\n", driver)
        np.testing.assert_allclose(switched, alone[number], atol=1e-5)
    assert all(np.abs(alone[one] - alone[other]).max() > 0.05 for one, other in [(0, 1), (1, 2), (0, 2)])
