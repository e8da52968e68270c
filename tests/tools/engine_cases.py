"""What tests of engines in a page draw: the examples with a mesh, and techniques that show each value of the chain."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

import sssgen
from folders import ROOT
from sssgen.material.material_loading import load_material
from sssgen.pipeline.compiler import Compiled
from sssgen.run.backends import Array
from sssgen.run.backends.backend_interface import VERTEX_SIZE
from sssgen.run.backends.engine_page import EngineDrawing, EnginePage
from sssgen.run.backends.web_engines import BABYLON, PLAYCANVAS, THREE
from sssgen.run.check.compiler_inputs import sources
from sssgen.run.compilers import Compiler, errors
from sssgen.run.render import page_values, shade_numpy
from sssgen.run.render.scene_render import PlacedMesh, place_mesh
from sssgen.run.render.scene_values import shell_of
from sssgen.run.render.shell_values import Shell
from sssgen.scene import scene_loading
from sssgen.support.diagnostics import SssgenError
from sssgen.targets import registry
from sssgen.targets.runtime.numpy_textures import Texture

INPUTS = "world_position P, world_direction N, world_direction V, world_direction T, world_direction B"
INPUTS += ", object_position P_object, object_direction N_object, object_direction V_object, vec2 screen_uv"
INPUTS += ", float eye_distance, uv_position uv, float time, uv_position uv2, vec4 vertex_color"
VALUES = "vec3(P) + vec3(N) + vec3(V) + vec3(T) + vec3(B) + 2.0 * vec3(P_object) + vec3(N_object) + vec3(V_object)"
VALUES += " + vec3(screen_uv.x, abs(screen_uv.y - 0.5), eye_distance) + vec3(uv, time)"  # v is down in WebGPU
VALUES += " + vertex_color.a * vertex_color.rgb + vec3(uv2, 0.0)"
HEAD = "/**\n * X.\n * role: {}\n * formula: none\n * source: none\n * units: none\n * limits: none\n */\n"
PROBES = {
    "shown": HEAD.format("surface") + f"void shown({INPUTS}, inout tangent_direction normal, out vec3 emission) {{ "
    f"normal = tangent_direction(normalize(vec3(0.1, 0.2, 1.0))); emission = abs({VALUES}); }}\n",
    "through": HEAD.format("translucency") + f"vec3 through({INPUTS}, world_direction L, object_direction L_object, "
    f"float light_nearness) {{ return abs({VALUES} + vec3(L) - vec3(L_object) + light_nearness); }}\n",
    "unlit": HEAD.format("lighting") + f"vec3 unlit({INPUTS}, world_direction L, object_direction L_object, "
    f"float light_nearness, vec3 light_color) {{ return abs({VALUES} + vec3(L) - vec3(L_object) + light_nearness) "
    "+ light_color; }\n",
    "rays": HEAD.format("lighting") + "vec3 rays(world_direction ray_direction, world_position ray_origin) "
    "{ return abs(vec3(ray_direction) + vec3(ray_origin)); }\n",
}
"""Techniques that show each value of the chain."""
MATERIALS = {
    "lit": '[[surface]]\ntechnique = "./shown.sss"\n[translucency]\ntechnique = "./through.sss"\n',
    "unlit": 'shading = "unlit"\n[lighting]\ntechnique = "./unlit.sss"\n',
    "rays": 'shading = "unlit"\n[lighting]\ntechnique = "./rays.sss"\n',
}
MESHES = ("ice", "ice_inlay", "jade_ring", "marble_idol", "paper_lantern", "resin_inlay", "wax_mouse")
ENGINES = {engine.target: engine for engine in (THREE, BABYLON, PLAYCANVAS)}
RENDERERS = [(target, name) for target, engine in ENGINES.items() for name in engine.renderers]


def pages(*quick: tuple[str, str]) -> list[Any]:
    """Parameters of a fixture that opens a page: those that are not quick run in `make test-long`."""
    assert set(quick) <= set(RENDERERS)
    marks = {pair: [] if pair in quick else [pytest.mark.slow] for pair in RENDERERS}
    return [pytest.param(pair, id="-".join(pair), marks=marks[pair]) for pair in RENDERERS]


PAGES = pages(("threejs", "webgpu"), ("babylonjs", "webgl"), ("playcanvas", "webgpu"))
"""Each engine, and both languages: a page takes seconds on the processor."""
SIZE = (96, 72)
BLACK: dict[str, dict[str, Any]] = {
    "threejs": {"color": 0.0, "specularIntensity": 0.0},
    "babylonjs": {"albedoColor": 0.0, "metallicF0Factor": 0.0},
    "playcanvas": {"diffuse": 0.0, "useMetalness": False, "specular": 0.0, "enableGGXSpecular": False},
}
"""Without the engine's own reflection."""
_NO_LIGHTING = "def evaluate_lighting(*_):\n    return np.zeros((3, 1))\n"


@cache
def mesh_of(name: str) -> PlacedMesh:
    """The points of an example's scene, or of a scene's file, with values for its program."""
    scene = scene_loading.load(name if name.endswith(".toml") else str(ROOT / "examples" / name / "scene.toml"))
    scene = dataclasses.replace(scene, size=SIZE, samples=1)
    compiled = sssgen.compile(scene.material, "numpy")
    shell = shell_of(scene, load_material(scene.material), compiled.reflection)
    return place_mesh(scene, compiled, shell, registry.load("numpy"), SIZE)


def through(name: str, mesh: PlacedMesh) -> Array:
    """Emission and the light that comes through, in NumPy's float64."""
    dark = dataclasses.replace(mesh.shell, ambient=(0.0, 0.0, 0.0))
    return shade_numpy.shade(without_reflection(sssgen.compile(name, "numpy")), dark, mesh.size, mesh.points, "float64")


def half_as_large(name: str) -> tuple[PlacedMesh, PlacedMesh]:
    """An example, and its body and camera half as large and in another place, where it covers the same pixels."""
    mesh = mesh_of(name)
    own = dataclasses.replace(mesh.shell, ambient=(0.0, 0.0, 0.0))
    moved = np.diag([0.5, 0.5, 0.5, 1.0])
    moved[:3, 3] = [0.3, -0.2, 0.1]
    shell = dataclasses.replace(
        own,
        model=moved @ own.model,
        camera_position=tuple(moved[:3, :3] @ own.camera_position + moved[:3, 3]),
        view_projection=own.view_projection @ np.linalg.inv(moved),
        parameters={**own.parameters, "object_scale": (0.5 * own.parameters["object_scale"][0],)},
    )
    return mesh._replace(shell=own), mesh._replace(shell=shell)


def without_reflection(compiled: Compiled) -> Compiled:
    """A material in NumPy, without reflected light."""
    file = next(file for file in compiled.files if file.endswith(".py"))
    return compiled._replace(files={**compiled.files, file: f"{compiled.files[file]}\n{_NO_LIGHTING}"})


class ChainCase(NamedTuple):
    """A material that shows the values of its chain, on a turned, stretched and mirrored body under one light."""

    material: str
    mesh: PlacedMesh
    shell: Shell
    points: Array
    expected: Array
    """Emission and the light that comes through, in NumPy's float64."""


def chain_case(name: str, front: bool, light: str, folder: Path) -> ChainCase:
    """`name` is of MATERIALS, `light` point or direction; the camera sees the front or the back."""
    for probe, text in PROBES.items():
        (folder / f"{probe}.sss").write_text(text, encoding="utf-8")
    path = folder / "made.toml"
    path.write_text(f'[material]\nname = "made"\ntwo_sided = true\n{MATERIALS[name]}', encoding="utf-8")
    turned = np.array([[0.0, -1.5, 0.0, 0.3], [-2.0, 0.0, 0.0, 0.1], [0.0, 0.0, 0.5, 0.2], [0.0, 0.0, 0.0, 1.0]])
    mesh = mesh_of("wax_mouse")
    moved = np.linalg.inv(turned) @ mesh.shell.model  # the same points in the world
    points = mesh.points.copy()
    points[:, :3] = points[:, :3] @ moved[:3, :3].T + moved[:3, 3]
    points[:, 3:6] = points[:, 3:6] @ np.linalg.inv(moved[:3, :3])
    points[:, 6:9] = points[:, 6:9] @ moved[:3, :3].T
    points[:, 12:18] = 0.5 + 0.4 * np.sin(points[:, :1] * np.arange(1.0, 7.0))  # a second set, and colours
    position = [0.5, 2.0, 3.0, 1.0] if light == "point" else [0.3, 0.5, 0.8, 0.0]
    shell = dataclasses.replace(
        mesh.shell, model=turned, parameters={}, textures={}, ambient=(0.0, 0.0, 0.0), time=0.75, front=front,
        light_positions=np.array([position]), light_colors=np.array([[0.5, 0.7, 0.9]]),
    )  # fmt: skip
    program = without_reflection(sssgen.compile(str(path), "numpy"))
    expected = shade_numpy.shade(program, shell, mesh.size, None if name == "rays" else points, "float64")
    if name == "rays":  # of the mesh's points here, of the screen there
        world = points[:, :3] @ turned[:3, :3].T + turned[:3, 3] - shell.camera_position
        ray = world / np.linalg.norm(world, axis=1, keepdims=True)
        expected = np.abs(ray + shell.camera_position).reshape(*expected.shape[:2], 3)
    return ChainCase(str(path), mesh, shell, points, expected)


def check_refusals(page: EnginePage, target: str, engine_class: str, colors: str, texture: str) -> None:
    """A value that a property does not take, or a name that there is not, is one error that says what there is."""
    modules = page_values.modules_of(sssgen.compile("ice", target))
    drawing = EngineDrawing(
        modules, (4, 3), np.zeros((3, VERTEX_SIZE)), [[0, 1, 2]], np.eye(4), (0.0, 0.0, 3.0), np.eye(4)
    )
    refused: dict[str, tuple[Any, str]] = {
        "cellCount": ("six", "a number, not 'six'"),
        "veinColor": ([0.2, 0.4], f"3 numbers, {colors}, not [0.2, 0.4]"),
        "coverTexture": (6, f"{texture}, or null, not 6"),
    }
    for name, (value, taken) in refused.items():
        text = f"'{name}' takes {taken}"
        said = f"TypeError: ice: {re.escape(text)}$"
        with pytest.raises(SssgenError, match=said):
            page.draw(drawing._replace(values={name: value}))
        if name != "veinColor":  # of which the page would make a colour
            with pytest.raises(SssgenError, match=said):
                page.draw(drawing._replace(properties={name: value}))  # set later
    volume = Texture(np.zeros((2, 2, 2, 4), np.float32))
    kinds = "TypeError: ice: 'coverTexture' takes a 2D texture, not a 3D texture$"
    with pytest.raises(SssgenError, match=kinds):
        page.draw(drawing._replace(textures={"coverTexture": volume}))
    names = rf"ice has no property 'cell_count'\. Its own: variation, .*; the others are those of {engine_class}$"
    with pytest.raises(SssgenError, match=names):
        page.draw(drawing._replace(values={"cell_count": 6.0}))
    color = drawing._replace(values={"veinColor": "#3070ff"})
    assert np.isfinite(page.draw(color)).all()


def check_reported_errors(page: EnginePage, target: str, named: str) -> None:
    """An error of the engine's compiler reaches the caller: a function of the shader has another name."""
    mesh, compiled = mesh_of("resin_inlay"), sssgen.compile("resin_inlay", target)
    declared = r"(Surface|fn) sss_evaluate_surface\("
    files = {name: re.sub(declared, r"\1 sss_misnamed(", text) for name, text in compiled.files.items()}
    with pytest.raises(SssgenError, match=named):
        page_values.shade(compiled._replace(files=files), mesh.shell, page, mesh.size, mesh.points)


def check_texts(target: str, form: str, compiler: Callable[[str], Compiler]) -> None:
    """Both languages are found in the module, and an error has the line that it has there."""
    (name, text), *_ = sssgen.compile("wax_mouse", target, form).files.items()
    read = sources({name: text})
    assert [source.language for source in read] == ["glsl-es-300", "wgsl"]
    for source, tool in zip(read, ("glslang", "tint"), strict=True):
        assert errors(compiler(tool).check(source)) == []
        wrong = dataclasses.replace(source, text=source.text.replace("max(", "maximum(", 1))
        (line,) = {said.line for said in errors(compiler(tool).check(wrong))[:1]}
        assert "max(" in text.splitlines()[line - 1]
