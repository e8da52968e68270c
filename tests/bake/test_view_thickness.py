"""`sssgen bake view_thickness`: a ball in closed form, the files, the same picture on every back end, bad input."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import bake_meshes as meshes
from bake_meshes import Array, bake, facts, write
from oracle import close, technique, unit, units
from sssgen.bake import memory_check
from sssgen.cli.main import main
from sssgen.run import backends
from sssgen.run.backends import Backend
from sssgen.run.render.scene_render import RenderedPicture, render
from sssgen.scene.pictures import images
from sssgen.scene.scene_loading import load
from sssgen.targets.runtime.numpy_textures import Texture

for package in ("trimesh", "igl", "embreex", "xatlas", "scipy", "psutil"):
    pytest.importorskip(package, reason=f"{package} is missing: pip install -e '.[bake]'")

pytestmark = pytest.mark.usefixtures("folder")

MATERIAL = """
[material]
name = "wax"
[thickness]
technique = "view_thickness_map"
view_harmonics_1 = "made_1.png"
view_harmonics_2 = "made_2.png"
view_harmonics_3 = "made_3.png"
[translucency]
technique = "interior_sample"
bind = { light_path = "march_light" }
"""
SCENE = """
material = "wax.toml"
size = [40, 32]
samples = 1
[camera]
position = [0.0, 0.6, 3.4]
target = [0.0, 0.0, 0.0]
[geometry]
kind = "mesh"
file = "globe.obj"
rotation = [0.0, 30.0, 0.0]
scale = 1.25
[[light]]
direction = [0.4, 0.8, 0.1]
color = [3.0, 3.0, 3.0]
"""


@pytest.fixture
def globe(folder: Path) -> str:
    march = '"march_light", body_distance = "sphere" }\nradius = 1.0\nsteps = 8'
    Path("wax.toml").write_text(MATERIAL.replace('"march_light" }', march), encoding="utf-8")
    return write(Path("globe.obj"), meshes.globe(0.8, 64, 32))


def pictures(stem: str = "made") -> dict[str, Texture]:
    return {
        f"view_harmonics_{number}": Texture(np.flipud(images.upright(f"{stem}_{number}.png")), "linear", "repeat")
        for number in (1, 2, 3)
    }


def test_a_balls_map_has_its_lengths(globe: str) -> None:
    """The eye's ray has the length 2 R cos a; with m = R, the nine numbers are exact within 0.03 of the light."""
    bake("view_thickness", globe, "--mean-free-path", "0.8", "-o", "made.png", "--size", "64x32", "--processes", "1")
    content = facts("made_1.png")
    assert content["kind"] == "view_thickness" and content["texture"] == "view_harmonics_1"
    # at most a quarter of the ball's longest side
    assert content["parameters"]["fade_length"] == pytest.approx(0.4)
    normal = units(400, 3)
    normal = normal[np.abs(normal[:, 1]) < 0.9]  # the texture coordinates of a ball are compressed at its poles
    view = unit(normal + 0.9 * units(len(normal), 4))
    u = np.arctan2(-normal[:, 2], normal[:, 0]) / (2.0 * np.pi) % 1.0
    uv = np.stack([u, 0.5 + np.arcsin(normal[:, 1]) / np.pi], axis=1)
    parameters = {
        name: tuple(value) if isinstance(value, list) else value for name, value in content["parameters"].items()
    }
    result = technique("view_thickness_map")(uv=uv, V_object=view, **parameters, **pictures())
    exact = 1.6 * np.einsum("nc,nc->n", normal, view)
    light, expected = (1.0 - np.exp(-length / 0.4) for length in (result, exact))
    difference = np.abs(light - expected)
    assert np.sqrt((difference**2).mean()) < 0.03 and difference.max() < 0.12
    assert content["error"]["mean_of_fit"] == pytest.approx(np.sqrt((difference**2).mean()), abs=0.012)
    assert 0.0 < content["error"]["rounding"] < 0.01 and content["lost_rays"] < 0.01


@pytest.mark.slow
def test_the_same_inputs_give_the_same_bytes(globe: str) -> None:
    base = ["view_thickness", globe, "--mean-free-path", "0.3", "--size", "48x24", "--rays", "32"]
    bake(*base, "-o", "one.png", "--processes", "1")
    bake(*base, "-o", "two.png", "--processes", "2")
    for number in (1, 2, 3):
        assert Path(f"one_{number}.png").read_bytes() == Path(f"two_{number}.png").read_bytes()
        first, second = (facts(f"{stem}_{number}.png") for stem in ("one", "two"))
        assert first.pop("file")["name"] != second.pop("file")["name"] and first == second
        picture = images.upright(f"one_{number}.png")
        assert picture.shape == (24, 48, 3) and picture.min() == 0.0 and picture.max() == 1.0


def test_a_scene_gives_the_medium_and_the_mesh(globe: str) -> None:
    medium = "[medium]\nabsorption = [1.0, 2.0, 3.0]\nscattering = [3.0, 2.0, 1.0]\n"
    Path("scene.toml").write_text(SCENE + medium, encoding="utf-8")
    bake("view_thickness", "scene.toml", "-o", "a.png", "--size", "16", "--processes", "1")
    bake("view_thickness", globe, "--mean-free-path", "0.2", "-o", "b.png", "--size", "16", "--processes", "1")
    # 4 in a unit of the world, 5 in a unit of the mesh, which the scene scales by 1.25
    assert facts("a_1.png")["parameters"] == facts("b_1.png")["parameters"]
    assert facts("a_1.png")["body"] == facts("b_1.png")["body"] and facts("a_1.png")["body"]["name"] == "globe.obj"


@pytest.mark.slow
def test_new_texture_coordinates_come_with_a_mesh(folder: Path) -> None:
    bare = meshes.box((1.0, 0.6, 0.4))._replace(uv=None)
    write(Path("bare.obj"), bare)
    bake("view_thickness", "bare.obj", "--mean-free-path", "0.2", "-o", "new.png", "--size", "48", "--processes", "1")
    assert Path("new.png.obj").is_file() and facts("new_1.png")["mesh"]["new_uv"]
    bake("view_thickness", "new.png.obj", "--mean-free-path", "0.2", "-o", "x.png", "--size", "48", "--processes", "1")
    assert not facts("x_1.png")["mesh"]["new_uv"]
    # the map is for the written mesh
    assert facts("x_1.png")["body"]["key"] == facts("new_1.png")["body"]["key"]


def drawn(backend: str) -> RenderedPicture:
    return render(load("scene.toml"), backends.get(backend))


@pytest.mark.parametrize("other", ["gl", "webgpu"])
def test_every_back_end_draws_the_same(globe: str, other: str, backend: Callable[[str], Backend]) -> None:
    backend(other)
    bake("view_thickness", globe, "--mean-free-path", "0.2", "-o", "made.png", "--size", "64x32", "--processes", "1")
    Path("scene.toml").write_text(SCENE, encoding="utf-8")
    oracle = drawn("numpy")
    assert 255.0 * np.abs(drawn(other).encoded - oracle.encoded).max() < 1.0
    shown = oracle.encoded[oracle.covered > 0.5]
    assert shown.std() > 0.05


def refused(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    """The message of a bake that fails with the exit code of an error."""
    assert main(["bake", *words]) == 2
    message = capsys.readouterr().err
    assert "Traceback" not in message and not list(Path().glob("out*"))
    return message


BAD: dict[str, tuple[list[str], str]] = {
    "no medium": (["globe.obj"], "a mesh has no medium"),
    "two media": (["globe.obj", "--medium", "marble", "--mean-free-path", "1"], "has its own mean free path"),
    "no length": (["globe.obj", "--mean-free-path", "0"], "0 is not a mean free path"),
    "few rays": (["globe.obj", "--mean-free-path", "1", "--rays", "8"], "nine numbers are fitted"),
    "an unknown medium": (["globe.obj", "--medium", "marbel"], "marble"),
    "a medium beside a scene": (["scene.toml", "--medium", "marble"], "leave --medium"),
    "a shape without texture coordinates": (["ball.toml"], "not a mesh but a ball"),
    "a sheet": (["sheet.obj", "--mean-free-path", "1"], "no inside"),
    "no mesh": (["missing.obj", "--mean-free-path", "1"], "missing.obj"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_refused(case: str, globe: str, capsys: pytest.CaptureFixture[str]) -> None:
    medium = '[medium]\npreset = "marble"\n'
    Path("scene.toml").write_text(SCENE + medium, encoding="utf-8")
    ball = SCENE.replace('kind = "mesh"\nfile = "globe.obj"', 'kind = "ball"\nradius = 0.5')
    Path("ball.toml").write_text(ball + medium, encoding="utf-8")
    sheet = meshes.MeshData(
        np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float), np.array([[0, 1, 2], [0, 2, 3]])
    )
    flat: Array = sheet.vertices[:, :2][sheet.faces]
    write(Path("sheet.obj"), sheet._replace(uv=flat))
    words, message = BAD[case]
    assert message in refused(capsys, "view_thickness", *words, "-o", "out.png", "--size", "16", "--processes", "1")


def test_a_map_that_does_not_fit_into_memory(
    globe: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(memory_check, "SPARE", 1e-6)
    message = refused(capsys, "view_thickness", globe, "--mean-free-path", "1", "-o", "out.png")
    assert "of memory" in message and "--size" in message


def test_a_hole_is_reported_and_its_rays_do_not_count(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    whole = meshes.box((1.0, 0.6, 0.4))
    assert whole.uv is not None
    write(Path("open.obj"), whole._replace(faces=whole.faces[:-2], uv=whole.uv[:-2]))
    words = ["--mean-free-path", "0.2", "--size", "30x20", "--processes", "1"]
    assert main(["bake", "view_thickness", "open.obj", "-o", "open.png", *words]) == 0
    assert "left through holes of the mesh" in capsys.readouterr().out
    assert 0.02 < facts("open_1.png")["lost_rays"] < 0.5
    numbers = np.array([facts("open_1.png")["parameters"][f"harmonics_lowest_{number}"] for number in (1, 2, 3)])
    assert np.abs(numbers).max() <= 8.0


def test_an_opaque_and_a_clear_medium_have_finite_maps(globe: str) -> None:
    for number, length in enumerate(("1e-6", "1e8")):
        path = f"m{number}.png"
        bake("view_thickness", globe, "--mean-free-path", length, "-o", path, "--size", "16x8", "--processes", "1")
        values = facts(f"m{number}_1.png")["parameters"]
        assert np.isfinite(np.concatenate([np.atleast_1d(value) for value in values.values()])).all()
    close(facts("m1_1.png")["parameters"]["fade_length"], 0.4)


def test_the_pictures_are_not_interchangeable(globe: str, capsys: pytest.CaptureFixture[str]) -> None:
    bake("view_thickness", globe, "--mean-free-path", "0.2", "-o", "made.png", "--size", "16", "--processes", "1")
    text = MATERIAL.replace("made_2.png", "made_3.png").replace('"march_light"', '"depth_map_path"')
    Path("wax.toml").write_text(text, encoding="utf-8")
    assert main(["emit", "wax.toml", "--target", "wgsl", "-o", "out"]) == 2
    message = capsys.readouterr().err
    assert "'made_3.png' is baked as 'view_harmonics_3', and not as 'view_harmonics_2'" in message
