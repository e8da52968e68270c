"""Scene files: their contents, and every error with its place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from sssgen.scene.camera import Camera
from sssgen.scene.geometry import Ball, Box, Distance, Mesh, Slab, Torus
from sssgen.scene.scene import DistanceTexture, Light, Picture, Scene
from sssgen.scene.scene_loading import load, parse_scene
from sssgen.support.diagnostics import SssgenError
from sssgen.targets.runtime.numpy_textures import Texture

HEAD = 'material = "paper_lantern"\n'


@pytest.fixture(autouse=True)
def with_map(in_folder: Path) -> None:
    np.save("map.npy", np.zeros((2, 2)))


def read(text: str) -> Scene:
    return parse_scene(text, "scene.toml")


def error_of(text: str) -> SssgenError:
    with pytest.raises(SssgenError) as caught:
        read(text)
    return caught.value


def test_a_scene_with_every_key() -> None:
    Path("scenes").mkdir()
    Path("scenes/wax.toml").write_text("", encoding="utf-8")
    np.save("scenes/ribs.npy", np.full((2, 2), 0.25))
    Path("scenes/one.toml").write_text(
        """
material = "wax.toml"
size = [320, 200]
samples = 3
time = 1.5
background = [[0.0, 0.1, 0.2], [0.3, 0.4, 0.5]]
ambient = [0.05, 0.05, 0.06]
exposure = 2.0
[geometry]
kind = "torus"
major = 2
minor = 0.5
rotation = [0.0, 90.0, 0.0]
[camera]
position = [0.0, 0.6, 3.4]
field_of_view = 30.0
[[light]]
position = [0.0, 0.6, -1.6]
color = [2.4, 2.2, 1.9]
[[light]]
direction = [0, 0, 4]
[parameters]
power = 6.0
tint = "#ff8000"
[textures]
thickness_texture = "ribs.npy"
other = { file = "ribs.npy", wrap = "clamp" }
""",
        encoding="utf-8",
    )
    scene = load(Path("scenes/one.toml"))
    assert scene.material == "scenes/wax.toml"
    assert (scene.size, scene.samples, scene.time, scene.exposure) == ((320, 200), 3, 1.5, 2.0)
    assert scene.background == ((0.0, 0.1, 0.2), (0.3, 0.4, 0.5))
    assert scene.ambient == (0.05, 0.05, 0.06)
    assert scene.geometry == Torus(2.0, 0.5, rotation=(0.0, 90.0, 0.0))
    assert scene.camera == Camera((0.0, 0.6, 3.4), (0.0, 0.0, 0.0), 30.0)
    assert scene.lights[0] == Light((0.0, 0.6, -1.6), None, (2.4, 2.2, 1.9))
    assert scene.lights[1] == Light(None, (0.0, 0.0, 1.0), (1.0, 1.0, 1.0))
    assert scene.parameters == {"power": 6.0, "tint": "#ff8000"}
    assert scene.textures["other"] == Picture("scenes/ribs.npy", "clamp")
    first = scene.textures["thickness_texture"]
    assert isinstance(first, Picture)
    assert first.values().tolist() == [[[0.25], [0.25]], [[0.25], [0.25]]]
    assert [scene.places[key].line for key in ("material", "parameters.power", "textures.other")] == [2, 23, 27]


def test_omitted_keys_have_defaults() -> None:
    scene = read(HEAD)
    assert (scene.material, scene.size, scene.samples, scene.time) == ("paper_lantern", (640, 480), 2, 0.0)
    assert scene.geometry is None
    assert scene.lights == ()
    assert scene.camera == Camera()


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        ('kind = "ball"\nradius = 2', Ball(2.0)),
        ('kind = "box"\nsize = [1, 2, 3]\nscale = 2', Box(size=(1.0, 2.0, 3.0), scale=2.0)),
        ('kind = "slab"\nthickness = 0.3', Slab(2.0, 2.0, 0.3)),
        ('kind = "mesh"\nfile = "m.obj"', Mesh(path="m.obj")),
        (
            'kind = "distance"\ntechnique = "sphere"\nparameters = { radius = 0.5 }',
            Distance(parameters={"radius": 0.5}),
        ),
    ],
)
def test_the_kinds_of_geometry(lines: str, expected: object) -> None:
    Path("m.obj").write_text("", encoding="utf-8")
    assert read(HEAD + "[geometry]\n" + lines).geometry == expected


def test_a_distance_texture_has_the_technique_s_convention() -> None:
    text = '[geometry]\nkind = "ball"\nposition = [9, 9, 9]\n[textures]\n'
    result = read(HEAD + text + "d = { distance_of_geometry = [8, 6, 4], box_max = [1, 1, 2], range = 0.7 }\n")
    texture = result.textures["d"]
    assert isinstance(texture, DistanceTexture)
    assert result.geometry is not None
    values = texture.values(result.geometry)
    assert values.shape == (4, 6, 8, 1)
    z, y, x = np.array([1.5, 2.5, 3.5]) / [4, 6, 8] * [3.0, 2.0, 2.0] - 1.0
    expected = np.clip(0.5 + (np.sqrt(x * x + y * y + z * z) - 1.0) / 1.4, 0.0, 1.0)
    assert values[1, 2, 3, 0] == pytest.approx(expected)
    read_back = Texture(values, wrap="clamp").sample(np.array([[3.5 / 8], [2.5 / 6], [1.5 / 4]]))[0]
    assert read_back == pytest.approx(expected)


@pytest.mark.parametrize(
    ("text", "message", "line"),
    [
        ("", "the scene has no material", 1),
        ('material = "paper_lanter"\n', "did you mean 'paper_lantern'", 1),
        ('material = "none.toml"\n', "cannot find the file 'none.toml'", 1),
        ("material = 3\n", "takes one line of text", 1),
        ('[material]\nname = "wax"\n[[surface]]\ntechnique = "base_color"\n', "this is a material, and no scene", 1),
        (HEAD + "sise = [1, 1]\n", "did you mean 'size'", 2),
        (HEAD + "size = [0, 480]\n", "'size' cannot be 0", 2),
        (HEAD + "size = [640.0, 480]\n", "takes whole numbers", 2),
        (HEAD + "size = [640]\n", "takes 2 whole numbers", 2),
        (HEAD + "size = [9000, 480]\n", "'size' cannot be 9000", 2),
        (HEAD + "size = [8192, 8192]\n", "are too many", 2),
        (HEAD + "samples = 9\n", "'samples' cannot be 9", 2),
        (HEAD + "samples = true\n", "takes a whole number", 2),
        (HEAD + "time = nan\n", "'time' cannot be nan", 2),
        (HEAD + "exposure = inf\n", "'exposure' cannot be inf", 2),
        (HEAD + "exposure = 0\n", "'exposure' cannot be 0", 2),
        (HEAD + "ambient = [0, 0, -1]\n", "'ambient' cannot be -1", 2),
        (HEAD + 'background = "red"\n', "takes 3 numbers", 2),
        (HEAD + "background = [[0, 0, 0]]\n", "one colour, or two", 2),
        (HEAD + "background = [[0, 0, 0], [0, nan, 0]]\n", "'background' cannot be nan", 2),
        (HEAD + "geometry = 3\n", "'geometry' is a table", 2),
        (HEAD + "[geometry]\nradius = 1\n", "the geometry has no kind", 2),
        (HEAD + '[geometry]\nkind = "bal"\n', "did you mean 'ball'", 3),
        (HEAD + '[geometry]\nkind = "ball"\nmajor = 1\n', "unknown key 'major'", 4),
        (HEAD + '[geometry]\nkind = "ball"\nradius = 0\n', "'radius' cannot be 0", 4),
        (HEAD + '[geometry]\nkind = "ball"\nscale = -1\n', "'scale' cannot be -1", 4),
        (HEAD + '[geometry]\nkind = "torus"\nminor = 1\n', "must be less than 'major'", 4),
        (HEAD + '[geometry]\nkind = "mesh"\n', "the mesh has no file", 2),
        (HEAD + '[geometry]\nkind = "mesh"\nfile = "none.obj"\n', "cannot find the file 'none.obj'", 4),
        (HEAD + '[geometry]\nkind = "mesh"\nfile = "m.fbx"\n', "not a mesh file's suffix", 4),
        (HEAD + '[geometry]\nkind = "distance"\ntechnique = "spere"\n', "did you mean 'sphere'", 4),
        (HEAD + '[geometry]\nkind = "distance"\ntechnique = "sphere"\nparameters = {radiu = 1}\n', "'radius'", 5),
        (HEAD + "[camera]\nposition = [0, 0, 0]\n", "stands at its target", 2),
        (HEAD + "[camera]\nfield_of_view = 180\n", "'field_of_view' cannot be 180", 3),
        (HEAD + "light = 3\n", "lights are a list", 2),
        (HEAD + "[[light]]\nposition = [1, 1, 1]\n" * 5, "the scene has 5 lights", 10),
        (HEAD + "[[light]]\ncolor = [1, 1, 1]\n", "a position or a direction", 2),
        (HEAD + "[[light]]\ndirection = [0, 0, 0]\n", "has length 0", 3),
        (HEAD + "[parameters]\npower = inf\n", "not a parameter's value", 3),
        (HEAD + "[parameters]\npower = 2020-01-01\n", "not a parameter's value", 3),
        (HEAD + "[textures]\na = 3\n", "takes a picture file", 3),
        (HEAD + '[textures]\na = "none.png"\n', "cannot find the file 'none.png'", 3),
        (HEAD + '[textures]\na = "map.jpg"\n', "not a picture file's suffix", 3),
        (HEAD + '[textures]\na = { file = "map.npy", wrap = "repaet" }\n', "did you mean 'repeat'", 3),
        (HEAD + "[textures]\na = { distance_of_geometry = [8, 8, 8] }\n", "no geometry to measure", 3),
        (HEAD + "[textures]\na = { distance_of_geometry = [8, 8, 0] }\n", "cannot be 0", 3),
        (HEAD + "[textures]\na = { distance_of_geometry = [8, 8, 8], box_max = [-2, 1, 1] }\n", "the box is empty", 3),
    ],
)
def test_errors_are_reported_at_their_place(text: str, message: str, line: int) -> None:
    error = error_of(text)
    assert message in str(error)
    reported = next(
        diagnostic for diagnostic in error.diagnostics if message in f"{diagnostic.message} {diagnostic.hint}"
    )
    assert (reported.span.file, reported.span.line) == ("scene.toml", line)


def test_all_errors_of_a_file_are_reported() -> None:
    assert len(error_of("size = 3\ntime = true\n[camera]\nnear = nan\n").diagnostics) == 4


def test_a_missing_scene() -> None:
    with pytest.raises(SssgenError, match=r"none\.toml"):
        load("none.toml")
