"""The renderer feature for URP draws what a white matt body reflects, and the material spreads it: on the stand-ins."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sssgen
from diffusion_cases import PLAIN, SCENE, SPREAD
from engine_cases import mesh_of, through
from sssgen.run.backends import Array, Backend
from sssgen.run.backends.unity_backend import UnityHLSL
from sssgen.run.compilers.compiler_interface import Compiler, Source
from sssgen.run.render import unity_values
from sssgen.run.render.scene_render import PlacedMesh
from sssgen.run.render.shell_values import Shell
from sssgen.scene import scene_loading
from sssgen.scene.solids import Torus
from sssgen.targets.runtime.numpy_textures import Texture
from torus_cases import inner_pixels, torus_mesh
from unity_frames import (
    MIRROR,
    VERSIONS,
    Frame,
    Replay,
    compile_feature,
    full_floats,
    mirrored,
    passes_of,
    run_feature,
    texture_numbers,
)

LEVEL = 1.0 / 255.0
SECOND = """
# along the axis of the ring, as the first one
[[light]]
position = [0.0, 2.5357096, 5.4378584]
color = [4.0, 6.0, 8.0]
"""
STAGES: dict[str, dict[str, Any]] = {
    "surroundings": {
        "unity_SHAr": [0.1, 0.2, -0.1, 0.3],
        "unity_SHAg": [0.0, 0.1, 0.2, 0.2],
        "unity_SHAb": [0.0, 0.0, 0.0, 0.2],
    },
    "shadows": {
        "standin_box_min": [[-9.0, 0.1, 1.0, 0.0], [-9.0, -0.5, 0.6, 0.0]],
        "standin_box_max": [[9.0, 9.0, 1.1, 0.0], [-0.2, 0.2, 0.8, 0.0]],
        "_MainLightShadowParams": [0.8, 0.0, 0.0, 0.0],
        "_AdditionalShadowParams": [[1.0, 0.0, 0.0, 0.0]],
    },
}
"""What URP says of surroundings, and of walls between the lamps and parts of the ring, in this project's world."""


@pytest.fixture
def machine(backend: Callable[[str], Backend], monkeypatch: pytest.MonkeyPatch) -> UnityHLSL:
    result = backend("unity-urp")
    assert isinstance(result, UnityHLSL)
    if not result.unity.real:
        monkeypatch.setattr(result.unity, "unity_version", 60000100)
    monkeypatch.setattr(result.whole, "texels", partial(full_floats, result.whole))
    return result


@pytest.fixture(scope="module")
def feature(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return compile_feature("URP 17", tmp_path_factory.mktemp("feature"))


class Stage:
    """A ring of skin as the feature and the shader draw it, with values of the engine."""

    def __init__(self, machine: UnityHLSL, feature: Path, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.machine, self.feature, self.folder = machine, feature, folder
        (folder / "scene.toml").write_text(SCENE + SECOND, encoding="utf-8")
        self.write(PLAIN)
        self.scene = scene_loading.load(str(folder / "scene.toml"))
        self.own: dict[str, Array] = {}
        engine = unity_values._engine
        monkeypatch.setattr(unity_values, "_engine", lambda *of: engine(*of) | self.own)

    def write(self, text: str) -> str:
        path = self.folder / "skin.toml"
        path.write_text(text, encoding="utf-8")
        return str(path)

    def mesh(self) -> PlacedMesh:
        mesh_of.cache_clear()  # the material in the file is another one each time
        return mesh_of(str(self.folder / "scene.toml"))

    def draw(self, text: str, own: dict[str, Any]) -> Array:
        """The picture of a material, with the picture that the feature draws for it."""
        compiled = sssgen.compile(self.write(text), "unity-urp")
        mesh = self.mesh()
        shell = dataclasses.replace(mesh.shell, parameters=dict(mesh.shell.parameters), textures={})
        self.own = {name: np.array(value) for name, value in own.items()}
        if compiled.reflection["passes"]:
            shell = self.with_picture(shell, compiled.files["skin.unity-urp.shader"], mesh.size)
        return unity_values.shade(compiled, shell, self.machine, mesh.size, mesh.points)[..., :3]

    def frame(self, shader: str, shell: Shell, size: tuple[int, int], bodies: int = 1) -> Frame:
        box = np.array([-1.2] * 3), np.array([1.2] * 3)
        eye = np.array(shell.camera_position), shell.view_projection
        return run_feature(self.feature, shader, [box] * bodies, [], eye, size)

    def with_picture(self, shell: Shell, shader: str, size: tuple[int, int]) -> Shell:
        frame = self.frame(shader, shell, size)
        assert isinstance(self.scene.geometry, Torus)
        vertices, triangles = torus_mesh(self.scene.geometry)
        vertices[:, :3] = vertices[:, :3] @ shell.model[:3, :3].T + shell.model[:3, 3]
        vertices[:, 3:6] = vertices[:, 3:6] @ shell.model[:3, :3].T
        positions = shell.light_positions * [1.0, 1.0, -1.0, 1.0]
        (main, *others) = zip(positions, shell.light_colors, strict=True)
        lights = unity_values._urp_lights(main, others) | {name: _mirrored(value) for name, value in self.own.items()}
        world = mirrored((vertices, triangles))
        pictures = Replay(self.machine, shader).pictures_of(frame, world, lights)
        (number,) = texture_numbers(frame.values[0]).values()
        return dataclasses.replace(
            shell,
            parameters={**shell.parameters, "eye_matrix": frame.matrix("_EyeMatrix").T.ravel()},
            textures={"matt_light_map": Texture(pictures[number], wrap="clamp")},
        )


def _mirrored(value: Array) -> Array:
    """A value of the engine in Unity's world. A box that is mirrored has other ends in z, which are its own here."""
    return value @ MIRROR


@pytest.fixture
def stage(machine: UnityHLSL, feature: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Stage:
    return Stage(machine, feature, tmp_path, monkeypatch)


def test_the_light_spreads_as_in_numpy(stage: Stage) -> None:
    text = PLAIN + SPREAD.format("0.06, 0.03, 0.02")
    picture = stage.draw(text, {})
    mesh = stage.mesh()
    expected = through(str(stage.folder / "skin.toml"), mesh)[..., :3]
    inner = inner_pixels(mesh.hit)
    assert expected[inner].mean() > 0.05
    difference = np.abs(picture - expected)[inner].max(axis=-1)
    print(f"98 % of the pixels differ by at most {np.quantile(difference, 0.98) / LEVEL:.2f} / 255")
    assert np.quantile(difference, 0.98) < 2.0 * LEVEL
    still = stage.draw(PLAIN + SPREAD.format("0.0, 0.0, 0.0"), {})
    assert np.quantile(np.abs(still - expected)[inner].max(axis=-1), 0.5) > 2.0 * LEVEL


@pytest.mark.parametrize("own", STAGES.values(), ids=STAGES)
def test_light_that_does_not_spread_is_urps_own(stage: Stage, own: dict[str, Any]) -> None:
    """A spread of 0 leaves the diffuse reflection of the shader, with its shadows and surroundings."""
    if stage.machine.unity.real and "standin_box_min" in own:
        pytest.skip("only the stand-in headers have shadow maps without texels")
    reflected, unshadowed = stage.draw(PLAIN, own), stage.draw(PLAIN, {})
    picture = stage.draw(PLAIN + SPREAD.format("0.0, 0.0, 0.0"), own)
    inner = inner_pixels(stage.mesh().hit)
    assert reflected[inner].mean() > 0.05
    assert np.abs(reflected - unshadowed)[inner].mean() > 0.02
    difference = np.abs(picture - reflected)[inner].max(axis=-1)
    print(f"98 % of the pixels differ by at most {np.quantile(difference, 0.98) / LEVEL:.2f} / 255")
    assert np.quantile(difference, 0.98) < 2.0 * LEVEL


@pytest.mark.parametrize("version", VERSIONS)
def test_every_version_draws_the_picture_with_its_lights(version: str, stage: Stage, tmp_path: Path) -> None:
    """After what the lights need, and once for all bodies."""
    stage.feature = compile_feature(version, tmp_path)
    path = stage.write(PLAIN + SPREAD.format("0.1, 0.1, 0.1"))
    shader = sssgen.compile(path, "unity-urp").files["skin.unity-urp.shader"]
    shell = stage.mesh().shell
    frame = stage.frame(shader, shell, (64, 48), bodies=2)
    words = [row[0] for row in frame.commands]
    assert words == ["pass", "target", "clear", "set", "set", "set", "bodies"]
    assert frame.commands[0][1] == "BeforeRenderingOpaques" and frame.commands[-1][1] == "SssgenLight"
    assert frame.commands[1][1].endswith("64 48 ARGBFloat Bilinear Clamp")
    assert frame.commands[2][1:] == ["True", "True", "0", "0", "0", "60000"]
    assert frame.values[0] == frame.values[1] and frame.lent == 0
    x, y, _, w = shell.view_projection
    np.testing.assert_allclose(frame.matrix("_EyeMatrix"), [0.5 * (x + w), 0.5 * (y + w), w, w], atol=2e-5)


@pytest.mark.parametrize(
    "line", ['shading = "unlit"', "two_sided = true", 'alpha_mode = "mask"', 'alpha_mode = "blend"']
)
def test_every_kind_of_material_has_the_pass(
    line: str, compiler: Callable[[str], Compiler], assert_compiles: Callable[[Source], None], tmp_path: Path
) -> None:
    compiler("unity")
    lighting = '[lighting]\ntechnique = "standard"\n' if "unlit" in line else ""
    (tmp_path / "skin.toml").write_text(
        f'[material]\nname = "skin"\n{line}\n{SPREAD.format("0.1, 0.1, 0.1")}{lighting}', encoding="utf-8"
    )
    shader = sssgen.compile(str(tmp_path / "skin.toml"), "unity-urp").files["skin.unity-urp.shader"]
    assert sum(tags["LightMode"] == "SssgenLight" for _, tags in passes_of(shader)) == 1
    assert_compiles(Source(shader, "unity-urp", name="skin.shader"))
