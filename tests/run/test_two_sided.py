"""Two-sided materials: a sheet from behind has the reversed normal, on every back end."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sssgen.material.material_loading import parse_material
from sssgen.run import backends
from sssgen.run.backends import Backend
from sssgen.run.render.scene_render import render
from sssgen.scene.pictures import images
from sssgen.scene.scene_loading import load
from sssgen.support.diagnostics import SssgenError

DRAWING = ["gl", "gl-es", "webgpu", "browser", "hlsl", "hlsl-glslang", "unity", "unity-urp", "metal"]
SIZE = (24, 16)

# two triangles that face +z, and bend at their common edge
SHEET = """
v -1 -0.8 0
v 1 -0.8 0
v 1 0.8 0
v -1 0.8 0.2
vt 0 0
vt 1 0
vt 1 1
vt 0 1
f 1/1 2/2 3/3
f 1/1 3/3 4/4
"""
LEAF = """
[material]
name = "leaf"
two_sided = {sides}

[[thickness]]
technique = "constant_thickness"
thickness_factor = 0.3

[[thickness]]
technique = "thinness_from_thickness"

[[thickness]]
technique = "transmittance_from_thinness"

[[surface]]
technique = "base_color"

[[surface]]
technique = "normal_map"

[[surface]]
technique = "pbr_constants"

[translucency]
technique = "lobe_normalized"
distortion = 0.2
"""
SCENE = """
material = "leaf.toml"
size = [{size[0]}, {size[1]}]
exposure = 0.5

[geometry]
kind = "mesh"
file = "{mesh}"

[camera]
position = [{eye}]
target = [0.0, 0.0, 0.0]
field_of_view = 50.0

[[light]]
direction = [{behind}]
color = [1.0, 0.9, 0.6]

[[light]]
direction = [{before}]
color = [0.5, 0.4, 0.4]

[textures]
normal_texture = "tilted.png"
"""


@pytest.fixture
def seen(tmp_path: Path) -> Callable[..., np.ndarray]:
    """Draws the sheet from `side` (1: in front, -1: the point reflection of that camera and its lights)."""

    def picture(backend: Backend, side: float, sides: str = "true") -> np.ndarray:
        # a bump of the front is a dent from behind, so that the reflected relief has the opposite slopes
        slopes = 0.5 + side * np.array([0.15, 0.06])
        images.write_png(tmp_path / "tilted.png", np.full((2, 2, 3), [*slopes, 0.9]))

        def place(*vector: float) -> str:
            return ", ".join(str(side * part) for part in vector)

        (tmp_path / "leaf.toml").write_text(LEAF.format(sides=sides), encoding="utf-8")
        numbers = [[side * float(part) if k else part for k, part in enumerate(line.split())]
                   for line in SHEET.splitlines() if line.startswith("v ")]  # fmt: skip
        moved = "\n".join(" ".join(map(str, line)) for line in numbers)
        faces = "\n".join(line for line in SHEET.splitlines() if not line.startswith("v "))
        # a point reflection keeps the normals of triangles, so that the back of the sheet faces the reflected camera
        (tmp_path / "sheet.obj").write_text(f"{moved}\n{faces}\n", encoding="utf-8")
        scene = SCENE.format(
            size=SIZE, mesh="sheet.obj", eye=place(0.4, 0.3, 2.4), behind=place(0.3, 0.4, -1.0),
            before=place(-0.4, 0.3, 0.9),
        )  # fmt: skip
        (tmp_path / "scene.toml").write_text(scene, encoding="utf-8")
        return render(load(str(tmp_path / "scene.toml")), backend)[0]

    return picture


def test_the_point_reflection_of_a_scene_has_the_same_picture_upside_down(seen: Callable[..., np.ndarray]) -> None:
    numpy = backends.require("numpy")
    front = seen(numpy, 1.0)
    behind = seen(numpy, -1.0)
    assert front.max() - front.min() > 0.2
    assert np.abs(behind[::-1] - front).max() < 1e-3  # textures are rounded
    one_sided = seen(numpy, -1.0, "false")
    assert np.abs(one_sided[::-1] - front).max() > 0.1


@pytest.mark.parametrize("name", DRAWING)
def test_every_back_end_draws_back_faces(
    name: str, backend: Callable[[str], Backend], seen: Callable[..., np.ndarray]
) -> None:
    for side in (1.0, -1.0):
        drawn, expected = seen(backend(name), side), seen(backends.require("numpy"), side)
        assert np.abs(drawn - expected).max() < 1.0 / 255.0, side


@pytest.mark.parametrize(
    ("text", "message", "hint"),
    [
        ('two_sided = "yes"', "'two_sided' takes true or false", "write two_sided = true"),
        ("two_side = true", "unknown key 'two_side' in [material]", "did you mean 'two_sided'?"),
        (
            'two_sided = true\nshading = "unlit"\n[geometry]\ntechnique = "camera_orbit"',
            "a raymarched material has no back faces",
            "omit two_sided, or omit [geometry]",
        ),
    ],
)
def test_wrong_values(text: str, message: str, hint: str) -> None:
    with pytest.raises(SssgenError) as caught:
        parse_material(f'[material]\nname = "leaf"\n{text}\n', "leaf.toml")
    assert (message, hint) in [(entry.message, entry.hint) for entry in caught.value.diagnostics]
