"""Godot draws the passes of a material with the emitted script. With a Godot, in its three renderers: slow."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import sssgen
from engine_cases import half_as_large, mesh_of, through
from godot_scenes import THROUGH, as_godot_stores, text_of
from sssgen.run.backends.godot_drawing import RENDERERS, Godot
from sssgen.run.compilers import Compiler
from sssgen.run.render import godot_values
from sssgen.scene import scene_loading
from sssgen.scene.solids import Torus
from torus_cases import inner_pixels, lengths_scene, torus_mesh, torus_scene

LIGHTS = """
[[light]]
position = [6.4, -1.6, -5.6]
color = [75.0, 38.0, 18.0]

[[light]]
direction = [0.5, -0.62, 0.66]
color = [0.2, 0.3, 0.6]
"""
"""Lights for jade_ring. The second is not near, as Godot takes each light for one from afar."""
SHAKEN = """extends "jade_ring_passes.gd"
var frame := 0
func _process(_delta):
    frame += 1
    var still := frame == 3
    body.position.x = 0.0 if still else 0.4
    var view := body.get_viewport()
    view.get_camera_3d().fov = FOV if still else 50.0
    view.size = Vector2i(SIZE) if still else Vector2i(80, 80)
"""
"""Body, camera and picture differ in the frames before the one that is read."""
SHADOWED = """extends "jade_ring_passes.gd"
func _process(_delta):
    for light in body.get_parent().find_children("*", "Light3D", false, false):
        light.shadow_enabled = true
"""
"""The lights cast shadows."""


def test_the_script_names_all_passes() -> None:
    compiled = sssgen.compile("jade_ring", "godot")
    script = compiled.files["jade_ring_passes.gd"]
    assert "class_name JadeRingPasses" in script and 'extends "sssgen_passes.gd"' in script
    rows = [json.loads(line.strip().rstrip(",")) for line in script.splitlines() if line.startswith("\t\t{")]
    assert [row["name"] for row in rows] == ["back_faces", "distant_light_depth", "occluders"]
    keys = ("name", "seen_from", "layers", "empty", "texture", "views", "lights", "size")
    assert rows == [{key: row[key] for key in keys} for row in compiled.reflection["passes"]]
    listed = {file["name"] for file in compiled.reflection["files"]}
    assert {"jade_ring_passes.gd", "sssgen_passes.gd"} <= listed


def test_the_script_has_what_bakes_a_texture() -> None:
    """The node warns where the material has none."""
    compiled = sssgen.compile("wax_mouse", "godot")
    (line,) = (line for line in compiled.files["wax_mouse_passes.gd"].splitlines() if line.startswith("func needed()"))
    (needed,) = (texture["needed"] for texture in compiled.reflection["textures"] if texture["needed"])
    assert f'{{"distance_map": {json.dumps(needed)}' in line and "sssgen bake sdf" in needed


def test_only_materials_that_light_comes_through_have_a_script() -> None:
    scripts = {
        name: [file for file in sssgen.compile(name, "godot").files if file.endswith(".gd")]
        for name in ("ice", "resin_inlay", "jelly_cubes")
    }
    assert scripts == {"ice": ["ice_passes.gd", "sssgen_passes.gd"], "resin_inlay": [], "jelly_cubes": []}
    assert not [file for file in sssgen.compile("ice", "godot", "functions").files if file.endswith(".gd")]


@pytest.mark.slow
@pytest.mark.parametrize("renderer", RENDERERS)
@pytest.mark.parametrize("case", ["one light", "several lights", "moved before", "own shadow"])
def test_the_script_draws_the_passes(
    case: str, renderer: str, tmp_path: Path, compiler: Callable[[str], Compiler]
) -> None:
    """The light that comes through is that of the oracle, also where all has moved in the frame before, and where the
    body lies in its own shadow."""
    compiler("godot")
    # Compatibility adds lights with shadows in encoded colours
    several = case == "several lights" or (case == "own shadow" and renderer != "gl_compatibility")
    path = torus_scene(tmp_path, LIGHTS if several else "")
    mesh, scene = mesh_of(path), scene_loading.load(path)
    assert isinstance(scene.geometry, Torus)
    compiled = sssgen.compile(scene.material, "godot")
    view = godot_values.view_of(mesh.shell, mesh.size, *torus_mesh(scene.geometry))
    scripts = {name: text for name, text in compiled.files.items() if name.endswith(".gd")}
    if case == "moved before":
        text = SHAKEN.replace("FOV", str(view.field_of_view)).replace("SIZE", f"{mesh.size[0]}, {mesh.size[1]}")
        scripts = {"shaken.gd": text, **scripts}
    if case == "own shadow":
        scripts = {"shadowed.gd": SHADOWED, **scripts}
    values = godot_values.values_of(compiled.reflection, dataclasses.replace(mesh.shell, parameters={}))
    drawn = Godot(renderer).draw(text_of(compiled, THROUGH), view, values, {}, scripts)[::-1]
    expected = through(scene.material, mesh)
    difference = np.abs(drawn - expected)[..., :3][inner_pixels(mesh.hit)].max(axis=-1)
    print(f"{case}, {renderer}: {255 * np.quantile(difference, 0.98):.2f}")
    assert np.quantile(difference, 0.98) < 1.0 / 255.0 and expected.mean() > 0.01


@pytest.mark.slow
@pytest.mark.parametrize("renderer", RENDERERS)
def test_the_eyes_layers(renderer: str, tmp_path: Path, compiler: Callable[[str], Compiler]) -> None:
    """The length inside the ring's near side, the gap behind it, and the length inside its far side."""
    compiler("godot")
    path = lengths_scene(tmp_path)
    mesh, scene = mesh_of(path), scene_loading.load(path)
    assert isinstance(scene.geometry, Torus)
    compiled = sssgen.compile(scene.material, "godot")
    dark = dataclasses.replace(mesh.shell, parameters={}, light_colors=np.zeros((1, 3)), ambient=(0.0, 0.0, 0.0))
    view = godot_values.view_of(dark, mesh.size, *torus_mesh(scene.geometry))
    scripts = {name: text for name, text in compiled.files.items() if name.endswith(".gd")}
    values = godot_values.values_of(compiled.reflection, dark)
    drawn = Godot(renderer).draw(compiled.files["jade.gdshader"], view, values, {}, scripts)[::-1]
    expected = through(scene.material, mesh)
    difference = np.abs(drawn - expected)[..., :3][inner_pixels(mesh.hit)].max(axis=-1)
    print(f"{renderer}: {255 * np.quantile(difference, 0.95):.2f}")
    assert (expected[..., 2][mesh.hit] > 0.05).sum() > 200, "the far side is behind the near one"
    assert np.quantile(difference, 0.95) < 1.0 / 255.0


@pytest.mark.slow
@pytest.mark.parametrize("renderer", RENDERERS)
def test_values_of_the_body_come_from_its_matrix(renderer: str, compiler: Callable[[str], Compiler]) -> None:
    """wax_mouse half as large and in another place: no parameter of the material differs."""
    compiler("godot")
    compiled = sssgen.compile("wax_mouse", "godot")
    whole, half = (mesh._replace(points=as_godot_stores(mesh.points)) for mesh in half_as_large("wax_mouse"))
    values = [godot_values.values_of(compiled.reflection, mesh.shell) for mesh in (whole, half)]
    assert values[0]["object_scale"]["value"] == pytest.approx(values[1]["object_scale"]["value"])
    drawn = godot_values.shade(
        text_of(compiled, THROUGH), compiled.reflection, half.shell, Godot(renderer), half.size, half.points
    )
    expected = through("wax_mouse", half)
    assert np.abs(drawn - expected)[..., :3][half.hit].max() < 1.0 / 255.0
    assert np.abs(through("wax_mouse", whole) - expected)[..., :3][half.hit].max() > 0.02, "the size matters"
