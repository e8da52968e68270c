"""The light inside a body that Godot's node computes from a bake: its picture is that of NumPy. With a Godot: slow."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sssgen
from relit_cases import EXAMPLES, drawn_by_numpy, linear_sky, turned, write_body, write_example
from sssgen.run.backends import Array
from sssgen.run.backends.backend_interface import VERTEX_SIZE
from sssgen.run.backends.godot_drawing import RENDERERS, Godot
from sssgen.run.compilers import Compiler
from sssgen.run.render import godot_values, inner_light
from sssgen.scene import scene_loading
from sssgen.scene.geometry import Mesh

pytestmark = pytest.mark.slow
SKY = (0.22, 0.25, 0.3), (0.18, 0.16, 0.18)
"""They differ little: Godot's filter flattens what differs."""
SCENE = """extends Node

const CASE := "%s"
const MOVES := CASE == "moved" or CASE == "in a thread"
const AWAY := Vector3(0.3, 0.2, -0.4)
var moved: Array[Node] = []
var frame := 0
var passes

func _ready():
    var environment = get_viewport().get_camera_3d().environment
    environment.ambient_light_source = Environment.AMBIENT_SOURCE_COLOR
    environment.ambient_light_color = Color%s.linear_to_srgb()
    if FileAccess.file_exists("res://sky.bin"):
        shine(environment)
    passes = load("res://relit_passes.gd").new()
    passes.inner_light_waits = CASE != "in a thread"
    get_parent().add_child.call_deferred(passes)
    prepare.call_deferred()

# Godot's panoramas begin at +z, and x runs to the left in them.
func shine(environment):
    var pixels := FileAccess.get_file_as_bytes("res://sky.bin")
    environment.ambient_light_source = Environment.AMBIENT_SOURCE_SKY
    environment.sky = Sky.new()
    environment.sky.sky_material = PanoramaSkyMaterial.new()
    environment.sky.sky_material.panorama = ImageTexture.create_from_image(
        Image.create_from_data(128, 64, false, Image.FORMAT_RGBF, pixels))

func prepare():
    for light in get_tree().root.find_children("*", "Light3D", true, false):
        if MOVES:
            moved.append(light)
        elif CASE == "spot" and light is OmniLight3D:
            light.replace_by(spot_of(light))
    if MOVES:
        moved.append(get_parent())
        move(AWAY, 0.5)

func _process(_delta):
    frame += 1
    if frame == 3 and CASE == "moved" or frame == 2 and CASE == "in a thread":
        move(-AWAY, -0.5)
    elif frame == 3 and CASE == "in a thread":
        var inner = passes._pictures.filter(func(one): return "response" in one)[0]
        while not WorkerThreadPool.is_task_completed(inner._task):
            OS.delay_msec(1)

func move(way, angle):
    for node in moved:
        node.rotate_object_local(Vector3.UP, angle)
        node.position += way

# A cone around the body that has an edge without a slope.
func spot_of(omni):
    var spot = SpotLight3D.new()
    spot.transform = omni.transform.looking_at(get_parent().global_position)
    spot.spot_range = omni.omni_range
    spot.spot_attenuation = omni.omni_attenuation
    spot.spot_angle = 75.0
    spot.spot_angle_attenuation = 0.005
    spot.light_color = omni.light_color
    spot.light_energy = omni.light_energy
    return spot
"""
"""The scene's ambient light or sky, the node of the material, and lamps and a body that reach their places in the last
frame, which waits for their light, or in the last but one, or a spot as bright in its cone as the scene's lamp."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("relit")
    write_body(folder)
    return folder


def draw(
    renderer: str, case: str, folder: Path, file: str = "scene.toml", sky: bytes = b"", **changes: Any
) -> tuple[Array, Array]:
    """The body's pixels in Godot and in NumPy, for a scene with some `changes`; `sky` is a panorama around it."""
    scene, placed, expected = drawn_by_numpy(folder, file, **changes)
    body = scene.geometry
    assert isinstance(body, Mesh)
    compiled = sssgen.compile(scene.material, "godot")
    vertices = np.zeros((len(body.triangles.places), VERTEX_SIZE), np.float32)
    vertices[:, :3], vertices[:, 3:6] = body.triangles.places, body.triangles.normals
    view = godot_values.view_of(placed.shell, placed.size, vertices, np.asarray(body.triangles.corners))
    files: dict[str, str | bytes] = {"scene.gd": SCENE % (case, scene.ambient)} | ({"sky.bin": sky} if sky else {})
    files |= {name: text for name, text in compiled.files.items() if name.endswith(".gd")}
    files |= {name: (folder / name).read_bytes() for name in ("body.bin", "body.bin.json")}
    values = godot_values.values_of(compiled.reflection, dataclasses.replace(placed.shell, parameters={}))
    drawn = Godot(renderer).draw(compiled.files["relit.gdshader"], view, values, {}, files)[::-1]
    return drawn[placed.hit][:, :3], expected[placed.hit][:, :3]


@pytest.mark.parametrize("case", ["still", "moved", "in a thread", "spot"])
@pytest.mark.parametrize("renderer", RENDERERS)
def test_two_lamps_and_ambient_light(
    renderer: str, case: str, folder: Path, compiler: Callable[[str], Compiler]
) -> None:
    """Within 1/255 on 95 % of the body's pixels: the picture of the eye's layers is coarse at the silhouette."""
    compiler("godot")
    drawn, expected = draw(renderer, case, folder)
    reached = 255.0 * float(np.quantile(np.abs(drawn - expected).max(axis=-1), 0.95))
    print(f"{case}, {renderer}: {reached:.2f}/255 on 95 % of the pixels, of light up to {expected.max():.2f}")
    assert np.median(expected) > 0.1
    assert reached <= 1.0


@pytest.mark.parametrize("renderer", RENDERERS)
def test_a_refracting_surface(
    renderer: str, tmp_path_factory: pytest.TempPathFactory, compiler: Callable[[str], Compiler]
) -> None:
    """The index and the distance from the surface come from the file."""
    compiler("godot")
    folder = tmp_path_factory.mktemp("refracting")
    write_body(folder, 1.4)
    drawn, expected = draw(renderer, "still", folder)
    reached = 255.0 * float(np.quantile(np.abs(drawn - expected).max(axis=-1), 0.95))
    print(f"refracting, {renderer}: {reached:.2f}/255 on 95 % of the pixels, of light up to {expected.max():.2f}")
    assert reached <= 2.0


@pytest.mark.parametrize("renderer", [name for name in RENDERERS if name != "gl_compatibility"])
def test_a_sky(renderer: str, folder: Path, compiler: Callable[[str], Compiler]) -> None:
    """Most of it differs in order 2. Godot changes the mean; Compatibility takes the colours for encoded ones."""
    compiler("godot")
    rows, columns = np.indices((64, 128)) + 0.5

    def light(around: Array) -> Array:
        x, y, z = np.sin(around) * np.sin(polar), np.cos(polar), np.cos(around) * np.sin(polar)
        bright = 0.5 + 0.1 * y + 0.35 * (x * x - z * z)
        return (bright[..., None] * [1.0, 0.7, 0.4]).astype(np.float32)

    polar = np.pi * rows / 64
    np.save(folder / "sky.npy", np.flipud(light(0.5 * np.pi - 2.0 * np.pi * (columns / 128 - 0.5))))
    text = (folder / "scene.toml").read_text("utf-8").replace("ambient = [0.2, 0.1, 0.3]\n", "")
    (folder / "sky.toml").write_text(f'{text[: text.index("[[light]]")]}[environment]\nfile = "sky.npy"\n'
                                     + text[text.index("[medium]") :], "utf-8")  # fmt: skip
    drawn, expected = draw(renderer, "still", folder, "sky.toml", light(-2.0 * np.pi * columns / 128).tobytes())
    level = float(np.median(expected[:, 0]) / np.median(drawn[:, 0]))
    reached = float(np.quantile(np.abs(level * drawn - expected).max(axis=-1), 0.9))
    print(f"sky, {renderer}: {reached:.4f} of light up to {expected[:, 0].max():.3f}; Godot's mean is 1 / {level:.3f}")
    assert abs(level - 1.0) < 0.04
    assert reached < 0.004


@pytest.fixture(scope="module", params=EXAMPLES)
def example(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    folder = tmp_path_factory.mktemp(request.param)
    write_example(request.param, folder)
    return request.param, folder


@pytest.mark.parametrize("case", ["still", "in a thread"])
@pytest.mark.parametrize("renderer", RENDERERS)
def test_an_example_under_lamps_that_move(
    renderer: str, case: str, example: tuple[str, Path], compiler: Callable[[str], Compiler],
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    """The lamps in their places, or in others that they reach in the last frame but one; and a sky, in Compatibility
    an ambient colour, as it has skies in a few bits."""
    compiler("godot")
    name, folder = example
    changes: dict[str, Any] = {"size": EXAMPLES[name], "ambient": (0.0, 0.0, 0.0)}
    if case != "still":
        changes["lights"] = turned(scene_loading.load(str(folder / "scene.toml")).lights, 2.0)
    panorama = b""
    if renderer == "gl_compatibility":
        changes["ambient"] = (0.2, 0.205, 0.24)
    else:
        monkeypatch.setattr(inner_light, "surroundings", linear_sky(SKY))
        above, below = np.array(SKY)
        height = np.cos(np.pi * (np.arange(64) + 0.5) / 64)[:, None]
        rows = 0.5 * (above + below) + 0.75 * height * (above - below)
        panorama = np.repeat(rows[:, None], 128, axis=1).astype(np.float32).tobytes()
    drawn, expected = draw(renderer, case, folder, "scene.toml", panorama, **changes)
    reached = 255.0 * float(np.quantile(np.abs(drawn - expected).max(axis=-1), 0.95))
    print(f"{name}, {case}, {renderer}: {reached:.2f}/255 on 95 % of the pixels, of light up to {expected.max():.2f}")
    assert np.median(expected.max(axis=-1)) > 0.1
    assert reached <= 1.0
