"""Pictures that are bound to a texture of another kind have a warning at their line; grey ones have three channels."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from sssgen.material.material_loading import load_material
from sssgen.pipeline.compiler import compile
from sssgen.run.evaluate.input_files import texture
from sssgen.run.render.bake_warnings import bake_warnings
from sssgen.run.render.mesh_needs import mesh_diagnostics
from sssgen.run.render.texture_warnings import texture_warnings
from sssgen.scene.pictures.images import write_png
from sssgen.scene.scene_loading import load

MATERIAL = """[material]
name = "painted"
[thickness]
technique = "thickness_map"
thickness_texture = "{thickness}.png"
[translucency]
technique = "absorption_tint"
[[surface]]
technique = "base_color"
base_color_texture = "{color}.png"
[[surface]]
technique = "normal_map"
normal_texture = "{normal}.png"
"""
SCENE = """material = "painted.toml"
[geometry]
kind = "ball"
radius = 1.0
[camera]
position = [0.0, 0.0, 3.0]
[[light]]
position = [0.0, 2.0, 0.0]
color = [1.0, 1.0, 1.0]
[[light]]
position = [0.0, 0.5, 0.0]
color = [1.0, 1.0, 1.0]
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    random = np.random.default_rng(0)
    grey, colors = random.uniform(0.2, 0.8, (32, 32)), random.uniform(0.0, 1.0, (32, 32, 3))
    slopes = random.uniform(-0.4, 0.4, (32, 32, 2))
    normals = np.dstack([slopes, np.ones((32, 32))])
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    for name, picture in {"grey": grey, "colors": colors, "normals": 0.5 * normals + 0.5}.items():
        write_png(tmp_path / f"{name}.png", picture)
    (tmp_path / "scene.toml").write_text(SCENE, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def warned(**files: str) -> list[tuple[str, int]]:
    """The warnings for a material with these files, and their lines."""
    names = {"thickness": "grey", "color": "colors", "normal": "normals", **files}
    Path("painted.toml").write_text(MATERIAL.format(**names), encoding="utf-8")
    scene, material = load("scene.toml"), load_material("painted.toml")
    reflection = compile(material, "numpy").reflection
    found = [*texture_warnings(scene, material, reflection), *bake_warnings(scene, material, reflection)]
    return [(warning.message, warning.span.line) for warning in found]


@pytest.mark.usefixtures("folder")
def test_each_kind_of_picture_at_its_place_has_no_warning() -> None:
    assert warned() == [] and warned(color="grey") == []


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(
    "files, message, line",
    [
        ({"thickness": "colors"}, "'colors.png' has colours, and 'thickness_texture' takes one number", 5),
        ({"color": "normals"}, "'normals.png' is a normal map, and 'base_color_texture' takes colours", 10),
        ({"normal": "colors"}, "'colors.png' is no normal map, and 'normal_texture' takes one", 13),
        ({"normal": "grey"}, "'grey.png' is no normal map", 13),
    ],
)
def test_a_picture_of_another_kind(files: dict[str, str], message: str, line: int) -> None:
    ((found, place),) = warned(**files)
    assert found.startswith(message) and place == line


def test_a_picture_of_the_scene_has_its_line_there(folder: Path) -> None:
    with (folder / "scene.toml").open("a", encoding="utf-8") as scene:
        scene.write('[textures]\nthickness_texture = "colors.png"\n')
    ((message, line),) = warned()
    assert "takes one number" in message and line == 14


def test_a_lamp_inside_a_body_whose_thickness_is_baked(folder: Path) -> None:
    facts = {"format": 1, "kind": "thickness", "holds": "thickness", "mesh": {"triangles": 4}}
    (folder / "grey.png.json").write_text(json.dumps(facts), encoding="utf-8")
    ((message, line),) = warned()
    assert message.startswith("this light is inside the body, and 'grey.png'") and line == 10


@pytest.mark.parametrize("srgb", [False, True])
def test_grey_pictures_have_three_equal_channels(srgb: bool, folder: Path) -> None:
    grey = texture("grey.png", srgb=srgb).levels[0]
    assert (grey[..., :1] == grey[..., :3]).all() and (grey[..., 3] == 1.0).all()
    write_png(folder / "clear.png", np.dstack([np.full((4, 4), 0.5), np.full((4, 4), 0.25)]))
    clear = texture("clear.png", srgb=srgb).levels[0]
    assert clear.shape == (4, 4, 4) and (clear[..., 0] == clear[..., 2]).all()
    assert clear[..., 3] == pytest.approx(0.25, abs=0.01)


def test_a_mesh_without_coordinates_whose_material_reads_a_picture(folder: Path) -> None:
    mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
    scene = SCENE.replace('kind = "ball"\nradius = 1.0', 'kind = "mesh"\nfile = "body.obj"')
    warned()
    (folder / "scene.toml").write_text(scene, encoding="utf-8")
    with_coordinates = mesh + "vt 0 0\n" + re.sub("([1-4])", r"\1/1", faces)
    for text, count in ((mesh + faces, 1), (with_coordinates, 0)):
        (folder / "body.obj").write_text(text, encoding="utf-8")
        found = mesh_diagnostics(load("scene.toml"), load_material("painted.toml"))
        assert len(found) == count and all("no texture coordinates" in one.message for one in found)
        assert all(one.span.file.endswith("body.obj") for one in found)
