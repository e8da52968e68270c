"""`sssgen bake fluence --relit`: its file, its errors, and renders that compute the light inside a body from it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from bake_meshes import facts
from sssgen.cli.main import main
from sssgen.lab.fluence import response
from sssgen.lab.fluence.fluence_field import Settings
from sssgen.run import backends
from sssgen.run.render.scene_render import render
from sssgen.scene.light_response import from_bytes
from sssgen.scene.measured import measured_scene
from sssgen.scene.scene_loading import load
from sssgen.support.diagnostics import SssgenError

for package in ("trimesh", "igl", "embreex", "scipy", "psutil"):
    pytest.importorskip(package, reason=f"{package} is missing: pip install -e '.[bake]'")

pytestmark = pytest.mark.usefixtures("folder")

FEW = ["--voxels", "8", "--photons", "1000", "--processes", "1"]
MATERIAL = """
[material]
name = "relit"
[translucency]
technique = "fluence_relit"
inner_light = "ball.bin"
[[surface]]
technique = "base_color"
tint = [0.0, 0.0, 0.0, 1.0]
"""
SCENE = """
material = "relit.toml"
size = [24, 24]
[camera]
position = [0.0, 0.0, 4.0]
[geometry]
kind = "ball"
radius = 0.6
[medium]
absorption = [0.5, 1.0, 1.5]
scattering = [4.0, 4.0, 4.0]
"""
FIRST = "[[light]]\ndirection = [-0.8, 0.0, -0.6]\ncolor = [1.0, 1.0, 1.0]\n"
SECOND = "[[light]]\nposition = [1.5, 0.5, 0.5]\ncolor = [0.3, 0.6, 0.9]\n"


def write(lights: str) -> None:
    Path("relit.toml").write_text(MATERIAL, "utf-8")
    Path("scene.toml").write_text(SCENE + lights, "utf-8")


def bake(*options: str) -> int:
    return main(["bake", "fluence", "scene.toml", "--relit", "8", "-o", "ball.bin", *FEW, *options])


def picture(lights: str) -> np.ndarray:
    write(lights)
    drawn: np.ndarray = render(load("scene.toml"), backends.get("numpy")).linear
    return drawn


@pytest.mark.slow
def test_one_seed_gives_one_file_and_its_json_explains_it() -> None:
    write(FIRST)
    assert bake() == 0
    first = Path("ball.bin").read_bytes()
    about = facts("ball.bin")
    assert about["technique"] == "fluence_relit" and about["rank"] == 8 and about["error"]["standard_error"] > 0.0
    stored = from_bytes(first, about)
    assert stored.latents.shape == (8, len(stored.cells)) and stored.arriving.shape == (len(stored.cells), 1024)
    assert bake() == 0
    assert Path("ball.bin").read_bytes() == first


def test_the_stored_numbers_are_those_of_the_field() -> None:
    """With many numbers in a voxel, for the directions of the table."""
    write(FIRST)
    scene = measured_scene.load("scene.toml").body_alone()
    packed, traced = response.response(scene, 24, Settings(8, photons=1000), processes=0)
    for direction in (7, 100, 200):
        rows = packed.table[direction].astype(float)
        scattered = rows[0][:, None] + rows[1:].T @ (packed.latents / 255.0)
        light = traced.whole[:, direction]
        assert np.sqrt(((scattered - traced.values[:, direction]) ** 2).mean()) < 0.03 * light.max()
    root = packed.arriving.T * (packed.highest / 255.0)
    step = packed.highest / response.LEVELS
    # of one channel, and by powers of it of the others
    expected = np.maximum(traced.shares, 0.0) ** (0.5 / packed.powers[:, None, None])
    assert (np.abs(root - expected) < 0.51 * step).any(axis=0).all()
    assert (np.abs(root - expected).mean((1, 2)) < 0.5 * step).all()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["-o", "ball.dds"], "end it in .bin"),
        (["--relit", "2"], "between 4 and 32"),
        (["--light", "0,1,0"], "--relit and --light exclude each other"),
        (["--format", "dds"], "--relit and --format exclude each other"),
        (["--rank", "0"], "--relit and --rank exclude each other"),
    ],
)
def test_wrong_options_are_errors(options: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    write(FIRST)
    assert bake(*options) == 2
    assert said in capsys.readouterr().err
    assert not Path("ball.bin").exists()


@pytest.mark.slow
def test_media_that_it_traces_otherwise() -> None:
    """A refracting surface has a technique of its own; an anisotropic medium has light that is not scattered, too."""
    write("ior = 1.4\n" + FIRST)
    assert bake() == 0
    assert facts("ball.bin")["technique"] == "fluence_relit_refracted"
    assert facts("ball.bin")["parameters"]["ior"] == 1.4
    write("anisotropy = 0.5\n" + FIRST)
    assert bake("--photons", "50") == 0
    stored = from_bytes(Path("ball.bin").read_bytes(), facts("ball.bin"))
    assert stored.arriving.shape == (len(stored.cells), 1024) and stored.arriving.max() > 200


def test_a_render_sums_the_lights() -> None:
    write(FIRST)
    assert bake() == 0
    first, second, both = picture(FIRST), picture(SECOND), picture(FIRST + SECOND)
    np.testing.assert_allclose(both, first + second, atol=2e-3)
    # the first light is at the left, behind the ball; the second at the right, in front of it
    left, right = slice(7, 11), slice(13, 17)
    assert first[12, left].mean() > 1.2 * first[12, right].mean()
    assert second[12, right].mean() > 1.2 * second[12, left].mean()


def test_a_render_without_a_right_file_says_what_to_do() -> None:
    write(FIRST)
    with pytest.raises(SssgenError, match=r"sssgen bake fluence scene\.toml --relit 32"):
        render(load("scene.toml"), backends.get("numpy"))
    assert bake() == 0
    Path("ball.bin").write_bytes(Path("ball.bin").read_bytes()[:64])
    with pytest.raises(SssgenError, match="the JSON is that of another file"):
        render(load("scene.toml"), backends.get("numpy"))


@pytest.mark.parametrize(("photons", "noisy"), [("2", True), ("1000", False)])
def test_a_noisy_bake_is_warned_of(capsys: pytest.CaptureFixture[str], photons: str, noisy: bool) -> None:
    """Photons serve an anisotropic medium; two of them reach few voxels."""
    write(f"anisotropy = 0.8\n{FIRST}")
    few = ["--voxels", "16", "--photons", photons, "--processes", "1", "--light", "0,0,1", "-o", "ball.npy"]
    assert main(["bake", "fluence", "scene.toml", *few]) == 0
    assert ("warning: the noise is as large as the light: use more --photons" in capsys.readouterr().out) is noisy
    assert (facts("ball.npy")["error"]["standard_error"] > 1.0) is noisy
