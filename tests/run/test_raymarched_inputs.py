"""What a raymarched material reads of the screen and of the ray's hit, on every target."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sssgen.material.material_loading import load_material
from sssgen.pipeline.compiler import compile
from sssgen.run import backends
from sssgen.run.backends import Backend
from sssgen.run.check import compile_check
from sssgen.run.check.shader_files import of_material
from sssgen.run.render.scene_render import render
from sssgen.scene.scene_loading import parse_scene
from sssgen.support.diagnostics import SssgenError

SHOWN = """
/** Shows how far the hit is from the eye, and the place on the screen.
role: surface
*/
void shown(float eye_distance, vec2 screen_uv, out vec3 albedo)
{
    albedo = vec3(0.1 * eye_distance, screen_uv);
}
"""
LIT = """
/** Shows the albedo; the light's direction is read, so that shells compute it.
role: lighting
*/
vec3 lit(vec3 albedo, world_direction L)
{
    return albedo + 1e-9 * L;
}
"""
HEAD = '[material]\nname = "far"\nshading = "unlit"\n'
MARCH = '[[geometry]]\ntechnique = "raymarch"\nbind = { scene_distance = "sphere" }\nradius = 0.8\n'
SHADE = '[[surface]]\ntechnique = "shown.sss"\n[[lighting]]\ntechnique = "lit.sss"\n'
EYE, SIZE = (0.3, 0.5, 3.0), (40, 30)
SCENE = (
    f'material = "far.toml"\nsamples = 1\n[camera]\nposition = {list(EYE)}\n[[light]]\ndirection = [0.0, 1.0, 0.0]\n'
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "shown.sss").write_text(SHOWN, encoding="utf-8")
    (tmp_path / "lit.sss").write_text(LIT, encoding="utf-8")
    (tmp_path / "far.toml").write_text(HEAD + MARCH + SHADE, encoding="utf-8")
    return tmp_path


def test_the_distance_of_the_hit_in_closed_form(folder: Path) -> None:
    scene = parse_scene(SCENE, folder / "scene.toml")
    picture = render(scene, backends.get("numpy"), SIZE).linear[::-1].reshape(-1, 3)
    origin, rays = scene.camera.rays(*SIZE)
    along = -rays @ origin
    square = along**2 - origin @ origin + 0.8**2
    hit = square > 0.05  # grazing rays end within the march's tolerance
    np.testing.assert_allclose(picture[hit, 0], 0.1 * (along - np.sqrt(np.maximum(square, 0.0)))[hit], atol=1e-3)
    x, y = np.meshgrid((np.arange(SIZE[0]) + 0.5) / SIZE[0], (np.arange(SIZE[1]) + 0.5) / SIZE[1])
    np.testing.assert_allclose(picture[hit, 1:], np.stack([x.ravel(), y.ravel()], axis=1)[hit], atol=1e-6)
    assert hit.sum() > 50


@pytest.mark.parametrize("name", ["gl", "gl-es", "webgpu", "browser", "hlsl", "unity", "unity-urp", "metal"])
def test_every_back_end_shows_the_same(name: str, backend: Callable[[str], Backend], folder: Path) -> None:
    scene = parse_scene(SCENE, folder / "scene.toml")
    oracle = render(scene, backends.get("numpy"), SIZE).linear
    shown = render(scene, backend(name), SIZE).linear
    np.testing.assert_allclose(shown[..., :2], oracle[..., :2], atol=4e-3)
    if name in ("webgpu", "browser", "hlsl", "metal"):  # their framebuffers count rows from the top
        shown[..., 2] = np.where(oracle[..., 0] > 0.0, 1.0 - shown[..., 2], shown[..., 2])
    np.testing.assert_allclose(shown[..., 2], oracle[..., 2], atol=4e-3)
    assert np.ptp(oracle[oracle[..., 0] > 0.0], axis=0).min() > 0.05


@pytest.mark.slow
def test_every_shell_compiles(folder: Path) -> None:
    """Those of Shader Graph too, which no back end draws."""
    report = compile_check.run(of_material(str(folder / "far.toml"), ()))
    assert report.results and not [result for result in report.results if not result.ok]


@pytest.mark.parametrize("name", ["P_object", "V_object", "N_object", "T", "B"])
def test_a_raymarched_material_has_no_mesh(name: str, folder: Path) -> None:
    """The error names the technique and the input; the targets' shells could not supply it."""
    meshed = f"/** Reads the mesh.\nrole: surface\n*/\nvoid meshed(vec3 {name}, out float roughness)\n"
    (folder / "meshed.sss").write_text(meshed + f"{{\n    roughness = length({name});\n}}\n", encoding="utf-8")
    stage = '[[surface]]\ntechnique = "meshed.sss"\n'
    (folder / "far.toml").write_text(HEAD + stage + MARCH + SHADE, encoding="utf-8")
    with pytest.raises(SssgenError, match=rf"meshed reads {name}, but a raymarched material has no mesh"):
        compile(load_material(str(folder / "far.toml")), "glsl-330")
