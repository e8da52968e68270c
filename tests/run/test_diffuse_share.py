"""A small share of diffuse reflection, for materials whose scattered light contains the light that enters in front.

The share is the albedo, so that the engine's highlight and the translucent term stay as they are.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from slow_cases import back_end_cases
from sssgen.run.backends import Array, Backend
from sssgen.run.render.scene_render import render
from sssgen.scene.scene_loading import parse_scene

DRAWING = ["numpy", "gl", "gl-es", "webgpu", "hlsl", "unity", "unity-urp"]
SIZE = (40, 30)
MATERIAL = """
[material]
name = "share"
shading = "lit"
[[surface]]
technique = "base_color"
[[surface]]
technique = "pbr_constants"
surface_roughness = 0.3
metalness = 0.0
[thickness]
technique = "back_face_thickness"
[translucency]
technique = "interior_octaves"
bind = { light_path = "depth_map_path" }
"""
SCENE = """
material = "share.toml"
samples = 1
[geometry]
kind = "ball"
[[light]]
direction = [0.3, 0.5, 1.0]
color = [1.5, 1.4, 1.3]
[parameters]
tint = [SHARE, SHARE, SHARE, 1.0]
scattering_albedo = [SCATTERED, SCATTERED, SCATTERED]
"""


@pytest.mark.parametrize("name", back_end_cases(DRAWING, "unity-urp"))
def test_the_share_scales_the_diffuse_reflection_alone(
    name: str, backend: Callable[[str], Backend], tmp_path: Path
) -> None:
    machine = backend(name)
    (tmp_path / "share.toml").write_text(MATERIAL, encoding="utf-8")

    def picture(share: float, scattered: float) -> Array:
        text = SCENE.replace("SHARE", str(share)).replace("SCATTERED", str(scattered))
        return render(parse_scene(text, tmp_path / "scene.toml"), machine, SIZE).linear

    whole, part, none = picture(0.8, 0.0), picture(0.2, 0.0), picture(0.0, 0.0)
    # the highlight needs no albedo
    assert none.max() > 1.0
    diffuse = whole - none
    assert diffuse.max() > 0.5
    np.testing.assert_allclose(part - none, 0.25 * diffuse, atol=2e-4)
    # the scattered light does not depend on the share
    scattered = picture(0.0, 0.9) - none
    assert scattered.max() > 0.05
    np.testing.assert_allclose(picture(0.8, 0.9) - whole, scattered, atol=2e-4)
