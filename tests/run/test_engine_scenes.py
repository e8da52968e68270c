"""Whole scenes in engines: examples under two lamps with shadows and a sky, with the passes that the engine draws.

Of each picture the light that comes through is compared with NumPy's, on all pixels of the body. `-s` prints the
differences, of which docs/engines.md has a table.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sssgen
from engine_cases import BLACK, ENGINES, RENDERERS
from scene_cases import ABOVE, BELOW, EXAMPLES, MIDDLE, SceneCase, check_light, scene_case
from skips import or_skip
from sssgen.run.backends import Array, Backend
from sssgen.run.backends.engine_page import EngineDrawing, EnginePage
from sssgen.run.backends.godot_drawing import RENDERERS as GODOTS
from sssgen.run.backends.godot_drawing import Godot
from sssgen.run.backends.godot_drawing import _decode as decoded
from sssgen.run.backends.unity_backend import UnityHLSL
from sssgen.run.compilers import Compiler
from sssgen.run.render import godot_values, page_values, unity_values
from sssgen.run.render.shell_values import Shell, bound_texture
from sssgen.targets.runtime.numpy_textures import Texture
from unity_frames import Lamp, Replay, compile_feature, full_floats, mirrored, run_feature, texture_numbers

SLOW = partial(pytest.param, marks=pytest.mark.slow)
QUICK = {("threejs", "webgl2", "jade_ring")}
CELLS = [
    (pytest.param if (*renderer, name) in QUICK else SLOW)(renderer, name, id="-".join((*renderer, name)))
    for renderer in RENDERERS
    for name in EXAMPLES
]


@pytest.fixture(scope="module")
def case_of(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., SceneCase]:
    return cache(lambda name, **others: scene_case(name, tmp_path_factory.mktemp("scenes"), **others))


@pytest.fixture(scope="module")
def page(request: pytest.FixtureRequest) -> Iterator[EnginePage]:
    target, name = request.param
    renderer: EnginePage = or_skip(partial(EnginePage, ENGINES[target], seconds=400.0), name)
    yield renderer
    renderer.page.close()


@pytest.mark.parametrize(("page", "name"), CELLS, indirect=["page"])
def test_a_scene_in_a_page(page: EnginePage, name: str, case_of: Callable[..., SceneCase]) -> None:
    case, target = case_of(name), page.engine.target
    compiled = sssgen.compile(case.material, target)
    shell = case.mesh.shell
    textures = {
        texture["property"]: bound_texture(texture, shell) for texture in compiled.reflection["textures"]
        if not texture["drawn"]
    }  # fmt: skip
    stage: dict[str, Any] = {"shadows": True, "around": "hemisphere", "above": ABOVE, "below": BELOW}
    drawing = EngineDrawing(
        page_values.modules_of(compiled), case.mesh.size, case.vertices, case.triangles, shell.view_projection,
        shell.camera_position, shell.model, shell.light_positions, shell.light_colors, textures=textures,
        properties=BLACK[target] | {"stage": stage},
    )  # fmt: skip
    check_light(page.draw(drawing), case, f"{name}, {target}, {page.name}")


@pytest.mark.parametrize("name", ["skin_ear", *(SLOW(name) for name in EXAMPLES if name != "skin_ear")])
def test_a_scene_in_urp(
    name: str, case_of: Callable[..., SceneCase], backend: Callable[[str], Backend], tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    """The renderer feature and the shader, on the stand-ins of Unity. The shadow maps have the lower half of the body's
    box; reflected light is that of a body without translucency.
    """
    case, machine = case_of(name), backend("unity-urp")
    assert isinstance(machine, UnityHLSL)
    shell = _passes_of_urp(case, machine, tmp_path)
    low, high = ([*corner, 0.0] for corner in case.box)
    middle = [high[0], 0.5 * (low[1] + high[1]), high[2], 0.0]
    strength = [1.0, 0.0, 0.0, 0.0]
    own: dict[str, Any] = {
        "unity_RendererBounds_Min": low, "unity_RendererBounds_Max": high, "standin_box_min": [low] * 2,
        "standin_box_max": [middle] * 2, "_MainLightShadowParams": strength, "_AdditionalShadowParams": [strength],
    }  # fmt: skip
    for channel, above, below in zip("rgb", ABOVE, BELOW, strict=True):
        own[f"unity_SHA{channel}"] = [0.0, 0.5 * (above - below), 0.0, 0.5 * (above + below)]
    engine = unity_values._engine
    monkeypatch.setattr(unity_values, "_engine", lambda *of: engine(*of) | {key: np.array(own[key]) for key in own})
    monkeypatch.setattr(machine.unity, "unity_version", 60000100)
    monkeypatch.setattr(machine.whole, "texels", partial(full_floats, machine.whole))
    whole, reflected = (
        unity_values.shade(sssgen.compile(material, "unity-urp"), shell, machine, case.mesh.size, case.mesh.points)
        for material in (case.material, case.opaque)
    )
    check_light(whole - reflected + case.emission, case, f"{name}, unity-urp")


def _passes_of_urp(case: SceneCase, machine: UnityHLSL, folder: Path) -> Shell:
    """The shell with the pictures that the renderer feature draws."""
    compiled, shell = sssgen.compile(case.material, "unity-urp"), case.mesh.shell
    if not compiled.reflection["passes"]:
        return shell
    (shader,) = (text for name, text in compiled.files.items() if name.endswith(".shader"))
    (sun, lamp), colors = shell.light_positions, shell.light_colors
    lamps = (
        Lamp("Directional", towards=sun[:3], color=colors[0]),
        Lamp("Point", place=lamp[:3], color=colors[1]),
    )
    eye = np.array(shell.camera_position), shell.view_projection
    frame = run_feature(compile_feature("URP 17", folder), shader, [case.box], lamps, eye, case.mesh.size)
    world = case.vertices.copy()
    world[:, :3] = world[:, :3] @ shell.model[:3, :3].T + shell.model[:3, 3]
    pictures = Replay(machine, shader).pictures_of(frame, mirrored((world, case.triangles)))
    drawn = {name: pictures[number] for name, number in texture_numbers(frame.values[0]).items()}
    assert "Bilinear" in frame.values[0]["_LightDepthMap"] and "Point" in frame.values[0]["_BackFaceMap"]
    return dataclasses.replace(
        shell,
        parameters={**shell.parameters, "light_matrix": frame.matrix("_LightMatrix").T.ravel()},
        textures={**shell.textures, "light_depth_map": Texture(drawn["_LightDepthMap"], wrap="clamp")},
        screens={"back_face_map": Texture(drawn["_BackFaceMap"], "nearest")},
    )


BOUNDS = {"gl_compatibility": 2.0, "mobile": 1.0, "forward_plus": 1.0}
"""Of Godot's renderers, in 255ths. Compatibility adds the light of lamps with a shadow in encoded colours, where dark
light has large steps."""
_GODOT = """extends "NAME_passes.gd"
func _process(_delta):
    var view := body.get_viewport()
    for light in view.find_children("*", "Light3D", true, false):
        light.shadow_enabled = true
    var environment := view.get_camera_3d().environment
    if environment.ambient_light_source == Environment.AMBIENT_SOURCE_DISABLED:
        shine(environment)

func shine(environment):
    var part := 0.0
SKY"""
_COLOR = """
    environment.ambient_light_source = Environment.AMBIENT_SOURCE_COLOR
    environment.ambient_light_color = Color(RED, GREEN, BLUE).linear_to_srgb()
"""
_PANORAMA = """
    var image := Image.create(32, 256, false, Image.FORMAT_RGBF)
    for y in 256:
        part = 1.5 * cos(PI * (y + 0.5) / 256)
        image.fill_rect(Rect2i(0, y, 32, 1), Color(RED, GREEN, BLUE))
    environment.ambient_light_source = Environment.AMBIENT_SOURCE_SKY
    environment.sky = Sky.new()
    environment.sky.sky_material = PanoramaSkyMaterial.new()
    environment.sky.sky_material.panorama = ImageTexture.create_from_image(image)
"""


@pytest.mark.slow
@pytest.mark.parametrize("name", EXAMPLES)
@pytest.mark.parametrize("renderer", GODOTS)
def test_a_scene_in_godot(
    renderer: str, name: str, case_of: Callable[..., SceneCase], compiler: Callable[[str], Compiler]
) -> None:
    """The node, which draws the passes and measures the sky, and the shader."""
    compiler("godot")
    godot = Godot(renderer)
    sky = (MIDDLE, MIDDLE) if godot.encodes else (ABOVE, BELOW)  # Compatibility has a sky in a few bits
    # Forward+ filters each picture once more: with other sizes Mesa's software driver mixes neighbours into a texel
    case = case_of(name, sky=sky, halves=True, powers=renderer == "forward_plus")
    compiled, shell = sssgen.compile(case.material, "godot"), case.mesh.shell
    view = godot_values.view_of(shell, case.mesh.size, case.vertices, case.triangles)
    drawn = {texture["source_name"] for texture in compiled.reflection["textures"] if texture["drawn"]}
    given = {key: texture for key, texture in shell.textures.items() if key not in drawn}
    textures = godot_values.textures_of(
        compiled.reflection, dataclasses.replace(shell, textures=given, screens={}), godot.encodes
    )
    material = compiled.reflection["material"]
    scene = _GODOT.replace("NAME", material).replace("SKY", _COLOR if godot.encodes else _PANORAMA)
    for color, above, below in zip(("RED", "GREEN", "BLUE"), *sky, strict=True):
        scene = scene.replace(color, f"{0.5 * (above + below)} + {0.5 * (above - below)} * part")
    scripts = {"scene.gd": scene} | {key: text for key, text in compiled.files.items() if key.endswith(".gd")}
    picture = godot.draw(compiled.files[f"{material}.gdshader"], view, {}, textures, scripts)[::-1]
    expected = case.expected
    if godot.encodes:  # it adds the light of each lamp with a shadow in encoded colours (docs/engines/godot.md)
        sky, *lamps = case.lights
        expected = decoded(encoded(case.emission + sky) + sum(map(encoded, lamps)))
    check_light(picture, case, f"{name}, godot, {renderer}", expected, BOUNDS[renderer])


def encoded(light: Array) -> Array:
    """As the Compatibility renderer stores it: sRGB without its linear part."""
    return np.maximum(1.055 * np.maximum(light, 0.0) ** (1.0 / 2.4) - 0.055, 0.0)
