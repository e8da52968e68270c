"""The scenes of `shadow_cases` in Godot: bodies with a node for their passes, walls, and one light of any kind."""

from __future__ import annotations

import contextlib
import json
import math
import subprocess
import time
from pathlib import Path

import numpy as np

import sssgen
from godot_scenes import THROUGH, text_of
from shadow_cases import HALF
from sssgen.pipeline.compiler import Compiled
from sssgen.run.backends import Array
from sssgen.run.backends.engine_page import EngineDrawing
from sssgen.run.backends.godot_drawing import SECONDS, Godot, View, files_of
from sssgen.run.compilers.godot_process import said_in

_NODE = """extends Node

var stage: Dictionary = JSON.parse_string(FileAccess.get_file_as_string("res://stage.json"))
var body: MeshInstance3D
var walls := []
var frame := 0

func _process(_delta):
    frame += 1
    if frame == 1:
        build()
    for i in walls.size():  # they are in their places in the frame that is shown
        walls[i].transform = transform_of(stage["walls"][i]).translated(Vector3(0.0, 0.0 if frame == 3 else 9.0, 0.0))

func build():
    body = get_parent()
    if stage.has("sky"):
        shine(get_viewport().get_camera_3d().environment)
    if stage.has("bare"):
        get_viewport().get_camera_3d().environment = null
    if stage.has("instances"):
        body.visible = false
        var many = MultiMeshInstance3D.new()
        many.multimesh = MultiMesh.new()
        many.multimesh.transform_format = MultiMesh.TRANSFORM_3D
        many.multimesh.mesh = body.mesh
        many.multimesh.instance_count = stage["instances"].size()
        for i in stage["instances"].size():
            many.multimesh.set_instance_transform(i, transform_of(stage["instances"][i]))
        add_body(many)
    else:
        draw_passes(body)
    for copy in stage.get("copies", []):
        var one = MeshInstance3D.new()
        one.mesh = body.mesh
        one.transform = transform_of(copy["model"]) * Transform3D(Basis().scaled(Vector3.ONE * copy["size"]))
        add_body(one)
    for i in stage.get("walls", []).size():
        var wall = MeshInstance3D.new()
        wall.mesh = BoxMesh.new()
        walls.append(wall)
        for property in stage.get("wall", {}):
            wall.set(property, stage["wall"][property])
        if stage.has("surface"):
            wall.material_override = StandardMaterial3D.new()
            for property in stage["surface"]:
                wall.material_override.set(property, stage["surface"][property])
        body.get_parent().add_child(wall)
    for place in [stage["place"]] + stage.get("lamps", []):
        add_lamp(place)

# The side of a direction is white, or the surroundings have one colour.
func shine(environment):
    if stage["sky"] is String:
        environment.ambient_light_source = Environment.AMBIENT_SOURCE_COLOR
        environment.ambient_light_color = Color(stage["sky"])
        return
    var way = Vector3(stage["sky"][0], stage["sky"][1], stage["sky"][2])
    var image = Image.create(128, 64, false, Image.FORMAT_RGBH)
    for y in 64:
        for x in 128:
            var around = TAU * (x + 0.5) / 128
            var polar = PI * (y + 0.5) / 64
            var at = Vector3(-sin(around) * sin(polar), cos(polar), cos(around) * sin(polar))
            image.set_pixel(x, y, Color.WHITE if at.dot(way) > 0.0 else Color.BLACK)
    environment.ambient_light_source = Environment.AMBIENT_SOURCE_SKY
    environment.sky = Sky.new()
    environment.sky.sky_material = PanoramaSkyMaterial.new()
    environment.sky.sky_material.panorama = ImageTexture.create_from_image(image)

func transform_of(x):
    var columns = []
    for i in 4:
        columns.append(Vector3(x[4 * i], x[4 * i + 1], x[4 * i + 2]))
    return Transform3D(columns[0], columns[1], columns[2], columns[3])

func add_body(one):
    one.material_override = body.material_override.duplicate()
    body.get_parent().add_child(one)
    draw_passes(one)

func draw_passes(one):
    if stage["passes"]:
        one.add_child(load("res://m_passes.gd").new())

func add_lamp(xyzw):
    var place = Vector3(xyzw[0], xyzw[1], xyzw[2])
    var lamp
    if xyzw[3] == 0.0:
        lamp = DirectionalLight3D.new()
    elif stage.has("spot"):
        lamp = SpotLight3D.new()
        lamp.spot_angle = rad_to_deg(stage["spot"] / 2.0)
    else:
        lamp = OmniLight3D.new()
    lamp.transform = Transform3D(Basis.looking_at(-place), place)
    for property in stage["properties"]:
        lamp.set(property, stage["properties"][property])
    lamp.shadow_enabled = stage.get("shadows", false)
    body.get_parent().add_child(lamp)
"""
_SERVER = """extends "draw.gd"

var shaders = {}

func draw():
    while true:
        while not FileAccess.file_exists("res://asked"):
            OS.delay_msec(20)
        DirAccess.remove_absolute("res://asked")
        await write_picture()
        FileAccess.open("res://answered", FileAccess.WRITE).close()

# One shader is compiled once.
func material(plan):
    var made = super(plan)
    made.shader = shaders.get_or_add(made.shader.code, made.shader)
    return made
"""
FALLOFF = {
    "omni_range": 9.0, "omni_attenuation": 1.3, "spot_range": 9.0, "spot_attenuation": 1.3,
    "spot_angle_attenuation": 2.5, "light_energy": 3.0,
}  # fmt: skip
"""Properties of lamps: those of a kind do not change the other kinds."""
_MATERIAL = '[material]\nname = "m"\n[translucency]\ntechnique = "./made.sss"\n'


class Stage:
    """One of Godot's renderers, which runs as long as the context, as a page that `shadow_cases` draws in."""

    def __init__(self, renderer: str, folder: Path, technique: str = HALF, surface: str = "") -> None:
        (folder / "made.sss").write_text(technique, "utf-8")
        (folder / "m.toml").write_text(_MATERIAL + surface, "utf-8")
        compiled = sssgen.compile(str(folder / "m.toml"), "godot")
        self.show(compiled, text_of(compiled, THROUGH))
        self.godot = Godot(renderer)
        self.open = contextlib.ExitStack()
        self.process: subprocess.Popen[bytes] | None = None

    def __enter__(self) -> Stage:
        self.display = self.open.enter_context(self.godot.program.display())
        self.project = self.open.enter_context(self.godot.program.project({"server.gd": _SERVER}))
        return self

    def __exit__(self, *_: object) -> None:
        self.open.close()

    def show(self, compiled: Compiled, shader: str) -> None:
        """Draws a shader of a material named m from now on, with its node."""
        self.shader = shader
        self.scripts = {name: text for name, text in compiled.files.items() if name.endswith(".gd")}

    def draw(self, drawing: EngineDrawing) -> Array:
        """What this shader shows, (height, width, 4); at first the light that comes through."""
        camera = np.eye(4)
        camera[:3, 3] = drawing.eye
        field_of_view = 2.0 * math.degrees(math.atan(1.0 / drawing.view_projection[1, 1]))
        body = (drawing.model, drawing.vertices, np.asarray(drawing.triangles))
        stage = {"passes": True, **drawing.properties["stage"], "place": [*drawing.light_positions[0]]}
        stage["properties"] = {**FALLOFF, **stage.get("properties", {})}
        scripts = {"stage.gd": _NODE, "stage.json": json.dumps(stage), **self.scripts}
        view = View(drawing.size, camera, field_of_view, [], *body)
        for name, content in files_of(self.shader, view, {}, {}, scripts).items():
            (self.project / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        self._ask()
        return self.godot.read(self.project, drawing.size)

    def _ask(self) -> None:
        """Lets Godot draw what is in the project."""
        if self.process is None:
            program, options = self.godot.program, self.godot.options
            self.process = program.start(self.project, "server.gd", options, self.display)
            self.open.callback(self.process.wait)
            self.open.callback(self.process.kill)
        answered = self.project / "answered"
        answered.unlink(missing_ok=True)
        (self.project / "asked").touch()
        end = time.monotonic() + SECONDS
        while not answered.exists() and self.process.poll() is None and time.monotonic() < end:
            time.sleep(0.02)
        said = said_in(self.project)
        assert answered.exists() and "SCRIPT ERROR" not in said and "SHADER ERROR" not in said, said[-2000:]
