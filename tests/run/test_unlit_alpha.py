"""The alpha of an unlit material: cut off or blended, on every back end."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sssgen.material.material_loading import load_material
from sssgen.pipeline.compiler import all_targets, compile
from sssgen.run.backends import Backend
from sssgen.run.check.compiler_inputs import sources
from sssgen.run.compilers import Source
from sssgen.run.render.scene_render import render
from sssgen.scene.scene_loading import load

DRAWING = ["gl", "gl-es", "webgpu", "hlsl", "unity", "unity-urp", "metal"]
BACKGROUND = np.array([0.2, 0.3, 0.4])
SCENE = """
material = "veil.toml"
size = [24, 18]
samples = 1
background = [0.2, 0.3, 0.4]
[geometry]
kind = "ball"
radius = 2.0
[camera]
position = [0.0, 0.0, 5.0]
target = [0.0, 0.0, 0.0]
field_of_view = 30.0
"""
VEIL = """
[material]
name = "veil"
shading = "unlit"
alpha_mode = "{mode}"
[[surface]]
technique = "veiled.sss"
[lighting]
technique = "glowing.sss"
"""
VEILED = """
/** Half of a ball is a veil.
role: surface
*/
void veiled(object_position P_object, out float alpha) { alpha = P_object.x > 0.0 ? 0.75 : 0.25; }
"""
GLOWING = """
/** One colour.
role: lighting
*/
vec3 glowing(object_position P_object) { return vec3(0.9, 0.5, 0.1) + 0.0 * P_object; }
"""
COLOR = np.array([0.9, 0.5, 0.1])


@pytest.fixture
def veil(tmp_path: Path) -> Callable[[str], Path]:
    """Writes the material and its scene."""

    def written(mode: str) -> Path:
        for name, text in (("veiled.sss", VEILED), ("glowing.sss", GLOWING), ("veil.toml", VEIL.format(mode=mode))):
            (tmp_path / name).write_text(text, encoding="utf-8")
        (tmp_path / "scene.toml").write_text(SCENE, encoding="utf-8")
        return tmp_path

    return written


@pytest.mark.parametrize("name", ["numpy", *DRAWING])
def test_alpha_of_an_unlit_material(name: str, backend: Callable[[str], Backend], veil: Callable[[str], Path]) -> None:
    for mode, left, right in (("mask", 0.0, 1.0), ("blend", 0.25, 0.75), ("opaque", 1.0, 1.0)):
        picture = render(load(str(veil(mode) / "scene.toml")), backend(name)).linear
        for share, column in ((left, 4), (right, 19)):
            expected = share * COLOR + (1.0 - share) * BACKGROUND
            assert np.abs(picture[4:14, column] - expected).max() < 1.0 / 255.0, mode


@pytest.mark.parametrize("mode", ["mask", "blend"])
def test_every_target_compiles(
    mode: str, veil: Callable[[str], Path], assert_compiles: Callable[[Source], None]
) -> None:
    material = load_material(str(veil(mode) / "veil.toml"))
    for target in all_targets():
        files = compile(material, target).files
        for source in sources(files):
            assert_compiles(source)
        if target.startswith("unity-") and target != "unity-shadergraph":
            (shader,) = (text for name, text in files.items() if name.endswith(".shader"))
            assert {"mask": '"Queue" = "AlphaTest"', "blend": '"Queue" = "Transparent"'}[mode] in shader
            assert ("Blend SrcAlpha" in shader) == (mode == "blend")
