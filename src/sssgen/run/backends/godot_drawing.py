"""Draws an emitted shader in Godot: one mesh, lights, a camera, and a picture of 16-bit floats in linear light.

This is no back end of the registry: Godot's pictures have too few bits to compare functions.
"""

from __future__ import annotations

import json
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from sssgen.run.backends.backend_interface import Array, backend_failure
from sssgen.run.compilers.godot_process import Godot as Program
from sssgen.run.compilers.godot_process import find
from sssgen.targets import registry

RENDERERS = {"gl_compatibility": "opengl3", "mobile": "vulkan", "forward_plus": "vulkan"}
"""Rendering method → its driver."""
SECONDS = 240.0
PICTURE = "picture.bin"
"""The file of a project that has its picture."""


class View(NamedTuple):
    """What a draw shows. Matrices are 4 × 4 for column vectors."""

    size: tuple[int, int]
    camera: Array
    """Camera to world space; it looks along its -z."""
    field_of_view: float
    """Vertical, in degrees."""
    lights: list[dict[str, Any]]
    """`towards` or `place`, and the linear `color` and its factor `energy`."""
    model: Array
    vertices: Array | None
    """(count, `VERTEX_SIZE`) float32, as in `Drawing`; None: Godot's own quad, which fills the view."""
    triangles: Array | None


class Godot:
    """One of Godot's renderers."""

    def __init__(self, renderer: str) -> None:
        self.name = f"godot ({renderer})"
        self.renderer = renderer
        self.target = registry.load("godot")
        self.program: Program = find()

    @property
    def options(self) -> list[str]:
        """Of the command line."""
        return ["--rendering-method", self.renderer, "--rendering-driver", RENDERERS[self.renderer]]

    @property
    def encodes(self) -> bool:
        """Whether the renderer passes colours as they are stored, in sRGB."""
        return self.renderer == "gl_compatibility"

    def draw(
        self,
        shader: str,
        view: View,
        values: Mapping[str, Any],
        textures: Mapping[str, Array],
        scripts: Mapping[str, str | bytes] | None = None,
    ) -> Array:
        """The picture, (height, width, 4) float64, row 0 at the top, in linear light; alpha is 0 behind the body.

        `values` are parameters as JSON values with their kind, `textures` (height, width, 4) or (depth, height, width,
        4) of float32, row 0 at v = 0. The first of the `scripts` is that of a node below the body; files that it reads
        may follow. An empty `shader` means Godot's standard material with `values`. Raises SssgenError where Godot
        refuses the shader or draws nothing.
        """
        files = files_of(shader, view, values, textures, scripts or {})
        with self.program.display() as display, self.program.project(files) as project:
            try:
                said = self.program.run(project, "draw.gd", self.options, SECONDS, display)
            except subprocess.TimeoutExpired:
                raise backend_failure(self.name, f"no picture after {SECONDS:.0f} s") from None
            if "SHADER ERROR" in said or "SCRIPT ERROR" in said or not (project / PICTURE).is_file():
                raise backend_failure(self.name, f"no picture: {said.strip()[-600:]}")
            return self.read(project, view.size)

    def read(self, project: Path, size: tuple[int, int]) -> Array:
        """The picture that a project's script has written."""
        pixels = np.fromfile(project / PICTURE, np.float32).reshape(size[1], size[0], 4).astype(np.float64)
        if self.encodes:
            pixels[..., :3] = _decode(pixels[..., :3])
        return pixels


def _decode(stored: Array) -> Array:
    """The inverse of the curve by which the Compatibility renderer encodes: sRGB's without its linear part."""
    light: Array = np.where(stored > 0.0, ((np.maximum(stored, 0.0) + 0.055) / 1.055) ** 2.4, 0.0)
    return light


def files_of(
    shader: str,
    view: View,
    values: Mapping[str, Any],
    textures: Mapping[str, Array],
    scripts: Mapping[str, str | bytes],
) -> dict[str, str | bytes]:
    """The files of a project whose `draw.gd` draws one picture."""
    files: dict[str, str | bytes] = {**scripts, "draw.gd": _SCRIPT, "shader.gdshader": shader}
    plan: dict[str, Any] = {
        "size": view.size, "camera": _transform(view.camera), "field_of_view": view.field_of_view,
        "model": _transform(view.model), "lights": view.lights, "values": dict(values),
        "mesh": view.vertices is not None, "script": next(iter(scripts), ""),
        "textures": {name: list(texels.shape) for name, texels in textures.items()},
    }  # fmt: skip
    if view.vertices is not None and view.triangles is not None:
        v = view.vertices.astype(np.float32)
        normals = v[:, 3:6] / np.maximum(np.linalg.norm(v[:, 3:6], axis=1, keepdims=True), 1e-20)
        tangents = v[:, 6:9] / np.maximum(np.linalg.norm(v[:, 6:9], axis=1, keepdims=True), 1e-20)
        parts = {
            "vertex": v[:, :3],
            "normal": normals,
            "tangent": np.column_stack([tangents, v[:, 9]]),
            "uv": v[:, 10:12],
            "uv2": v[:, 12:14],
            "color": v[:, 14:18],
        }
        files |= {f"{name}.bin": np.ascontiguousarray(part, np.float32).tobytes() for name, part in parts.items()}
        # Godot's front faces turn clockwise
        files["index.bin"] = np.ascontiguousarray(view.triangles[:, [0, 2, 1]], np.int32).tobytes()
    for name, texels in textures.items():
        files[f"texture_{name}.bin"] = np.ascontiguousarray(texels, np.float32).tobytes()
    return {**files, "plan.json": json.dumps(plan)}


def _transform(matrix: Array) -> list[float]:
    """The columns of an affine matrix, as Godot's Transform3D takes them."""
    return [float(x) for column in range(4) for x in matrix[:3, column]]


_SCRIPT = """extends SceneTree

func _initialize():
    Engine.time_scale = 0.0
    draw()

func vector(x, at):
    return Vector3(x[at], x[at + 1], x[at + 2])

func transform(x):
    return Transform3D(vector(x, 0), vector(x, 3), vector(x, 6), vector(x, 9))

func bytes(name):
    return FileAccess.get_file_as_bytes("res://" + name + ".bin")

func value(entry):
    var x = entry["value"]
    match entry["kind"]:
        "float": return float(x[0])
        "int": return int(x[0])
        "bool": return x[0] != 0.0
        "color": return Color(x[0], x[1], x[2], x[3] if x.size() > 3 else 1.0)
        "vec2": return Vector2(x[0], x[1])
        "vec3": return vector(x, 0)
        "vec4": return Vector4(x[0], x[1], x[2], x[3])
        "mat3": return Basis(vector(x, 0), vector(x, 3), vector(x, 6))
        "mat4":
            var columns = []
            for i in range(4):
                columns.append(Vector4(x[4 * i], x[4 * i + 1], x[4 * i + 2], x[4 * i + 3]))
            return Projection(columns[0], columns[1], columns[2], columns[3])
    return PackedFloat32Array(x)

func texture(name, shape):
    var data = bytes("texture_" + name)
    if shape.size() == 3:
        var image = Image.create_from_data(shape[1], shape[0], false, Image.FORMAT_RGBAF, data)
        return ImageTexture.create_from_image(image)
    var slices: Array[Image] = []
    var length = int(shape[1] * shape[2]) * 16
    for i in range(int(shape[0])):
        var part = data.slice(i * length, (i + 1) * length)
        slices.append(Image.create_from_data(shape[2], shape[1], false, Image.FORMAT_RGBAF, part))
    var volume = ImageTexture3D.new()
    volume.create(Image.FORMAT_RGBAF, shape[2], shape[1], shape[0], false, slices)
    return volume

func mesh():
    var arrays = []
    arrays.resize(Mesh.ARRAY_MAX)
    arrays[Mesh.ARRAY_VERTEX] = bytes("vertex").to_vector3_array()
    arrays[Mesh.ARRAY_NORMAL] = bytes("normal").to_vector3_array()
    arrays[Mesh.ARRAY_TANGENT] = bytes("tangent").to_float32_array()
    arrays[Mesh.ARRAY_TEX_UV] = bytes("uv").to_vector2_array()
    arrays[Mesh.ARRAY_TEX_UV2] = bytes("uv2").to_vector2_array()
    arrays[Mesh.ARRAY_COLOR] = bytes("color").to_color_array()
    arrays[Mesh.ARRAY_INDEX] = bytes("index").to_int32_array()
    var made = ArrayMesh.new()
    made.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
    return made

func material(plan):
    var code = FileAccess.get_file_as_string("res://shader.gdshader")
    if code == "":
        var standard = StandardMaterial3D.new()
        for name in plan["values"]:
            standard.set(name, value(plan["values"][name]))
        return standard
    var made = ShaderMaterial.new()
    made.shader = Shader.new()
    made.shader.code = code
    for name in plan["values"]:
        made.set_shader_parameter(name, value(plan["values"][name]))
    for name in plan["textures"]:
        made.set_shader_parameter(name, texture(name, plan["textures"][name]))
    return made

func light(entry):
    var made
    if entry.has("towards"):
        made = DirectionalLight3D.new()
        var towards = vector(entry["towards"], 0)
        made.transform = Transform3D(Basis.looking_at(-towards, Vector3.UP if absf(towards.y) < 0.9 else Vector3.RIGHT))
    else:
        made = OmniLight3D.new()
        made.position = vector(entry["place"], 0)
        made.omni_range = 4096.0
        made.omni_attenuation = 2.0
        made.light_specular = 0.5
    var c = entry["color"]
    made.light_color = Color(c[0], c[1], c[2]).linear_to_srgb()
    made.light_energy = entry["energy"]
    return made

func draw():
    await write_picture()
    OS.kill(OS.get_process_id()) # quit() may wait for ever while shaders are compiled

func write_picture():
    var plan = JSON.parse_string(FileAccess.get_file_as_string("res://plan.json"))
    var view = SubViewport.new()
    view.size = Vector2i(plan["size"][0], plan["size"][1])
    view.use_hdr_2d = true
    view.transparent_bg = true
    view.own_world_3d = true
    view.render_target_update_mode = SubViewport.UPDATE_ALWAYS
    root.add_child(view)
    var environment = Environment.new()
    environment.background_mode = Environment.BG_CLEAR_COLOR
    environment.ambient_light_source = Environment.AMBIENT_SOURCE_DISABLED
    environment.reflected_light_source = Environment.REFLECTION_SOURCE_DISABLED
    var camera = Camera3D.new()
    camera.environment = environment
    camera.transform = transform(plan["camera"])
    camera.fov = plan["field_of_view"]
    camera.near = 0.01
    camera.far = 1000.0
    view.add_child(camera)
    camera.current = true
    var body = MeshInstance3D.new()
    if plan["mesh"]:
        body.mesh = mesh()
        body.transform = transform(plan["model"])
    else:
        var height = 2.0 * tan(deg_to_rad(camera.fov) / 2.0)
        body.mesh = QuadMesh.new()
        body.mesh.size = Vector2(height * view.size.x / view.size.y, height)
        body.transform = camera.transform.translated_local(Vector3(0.0, 0.0, -1.0))
    body.material_override = material(plan)
    if plan["script"] != "":
        var node = Node.new()
        node.set_script(load("res://" + plan["script"]))
        body.add_child(node)
    view.add_child(body)
    for entry in plan["lights"]:
        view.add_child(light(entry))
    for i in range(3):
        await process_frame
    await RenderingServer.frame_post_draw
    var picture = view.get_texture().get_image()
    picture.convert(Image.FORMAT_RGBAF)
    var file = FileAccess.open("res://picture.bin", FileAccess.WRITE)
    file.store_buffer(picture.get_data())
    file.close()
    view.free()
"""
