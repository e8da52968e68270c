"""Colours of vertices and the second set of texture coordinates: from a file to the picture, on every back end."""

from __future__ import annotations

import base64
import json
import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sssgen.material.material_loading import load_material, parse_material
from sssgen.pipeline.compiler import all_targets, compile
from sssgen.run import backends
from sssgen.run.backends import Backend
from sssgen.run.render.scene_render import render
from sssgen.scene.mesh import Mesh
from sssgen.scene.pictures import images
from sssgen.scene.pictures.images import decode_srgb
from sssgen.scene.scene_loading import load
from sssgen.support.diagnostics import SssgenError

DRAWING = ["gl", "gl-es", "webgpu", "browser", "hlsl", "hlsl-glslang", "unity", "unity-urp", "metal"]
SIZE = (24, 16)
CORNERS = np.array([[-1.0, -0.7, 0.0], [1.0, -0.7, 0.0], [1.0, 0.7, 0.0], [-1.0, 0.7, 0.0]])
FACES = [0, 1, 2, 0, 2, 3]
UV = np.array([[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]])
"""As in glTF, v down."""
UV2 = 0.25 + 0.5 * UV[:, ::-1]
COLORS = np.array([[1.0, 0.2, 0.1, 1.0], [0.1, 0.9, 0.3, 0.8], [0.2, 0.3, 1.0, 0.3], [0.7, 0.7, 0.7, 0.6]])

SCENE = """
material = "sheet.toml"
size = [{size[0]}, {size[1]}]
samples = 1
[geometry]
kind = "mesh"
file = "{mesh}"
[camera]
position = [0.4, 0.3, 2.4]
target = [0.0, 0.0, 0.0]
field_of_view = 50.0
[[light]]
direction = [-0.4, 0.3, 0.9]
color = [0.9, 0.8, 0.7]
[[light]]
direction = [0.3, 0.2, -0.9]
color = [1.0, 0.9, 0.6]
"""
TEXTURES = """[textures]
base_color_texture = "checker.png"
occlusion_texture = "ramp.png"
thickness_texture = "ramp.png"
"""
PAINTED = """
[material]
name = "sheet"
alpha_mode = "mask"
[[thickness]]
technique = "thickness_map"
uv = "uv2"
[[thickness]]
technique = "beer_lambert"
[[surface]]
technique = "base_color"
[[surface]]
technique = "vertex_tint"
[[surface]]
technique = "occlusion_map"
uv = "uv2"
[[translucency]]
technique = "lobe_normalized"
[[translucency]]
technique = "through.sss"
"""
THROUGH = """
/** Light that the colours of the vertices let through.
role: translucency
*/
vec3 through(vec4 vertex_color, uv_position uv2, world_direction N, world_direction L)
{
    return 0.2 * vertex_color.rgb * vertex_color.a * (0.5 + vec2(uv2).x) * max(-dot(N, L), 0.0);
}
"""
SHOWN = '[material]\nname = "sheet"\nshading = "unlit"\n[lighting]\ntechnique = "shown.sss"\n'
SHOWN_TEXT = """
/** Shows a value of the mesh.
role: lighting
*/
vec3 shown(vec4 vertex_color, uv_position uv2)
{
    return VALUE;
}
"""


def accessor(numbers: np.ndarray, normalized: bool) -> tuple[bytes, dict[str, object]]:
    """The bytes of an accessor, and its description without the view."""
    kinds = {"float32": 5126, "uint8": 5121, "uint16": 5123, "uint32": 5125}
    shape = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}[numbers.shape[1]]
    return numbers.tobytes(), {
        "componentType": kinds[str(numbers.dtype)], "count": len(numbers), "type": shape, "normalized": normalized,
    }  # fmt: skip


def gltf(path: Path, **more: np.ndarray) -> Path:
    """Writes a sheet with further attributes; integers are shares of the largest."""
    arrays = {"POSITION": CORNERS.astype(np.float32), "TEXCOORD_0": UV.astype(np.float32), **more}
    described, views, data = [], [], b""
    for values in [np.array(FACES, np.uint32)[:, None], *arrays.values()]:
        piece, description = accessor(values, values.dtype.kind == "u" and values.shape[1] > 1)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(piece)})
        described.append({**description, "bufferView": len(views) - 1})
        data += piece + b"\0" * (-len(piece) % 4)
    attributes = {name: number for number, name in enumerate(arrays, 1)}
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": 0, "material": 0}]}],
        "materials": [{}], "accessors": described, "bufferViews": views, "buffers": [{"byteLength": len(data)}],
    }  # fmt: skip
    if path.suffix == ".gltf":
        document["buffers"] = [{"byteLength": len(data), "uri": "data:;base64," + base64.b64encode(data).decode()}]
        path.write_text(json.dumps(document), encoding="utf-8")
        return path
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    parts = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(parts)) + parts)
    return path


def at(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """The values of corners at points of the sheet, by the triangles of `FACES`."""
    x, y = (points[:, 0] + 1.0) / 2.0, (points[:, 1] + 0.7) / 1.4
    lower = np.stack([1.0 - x, x - y, y], axis=1) @ corners[[0, 1, 2]]
    upper = np.stack([1.0 - y, x, y - x], axis=1) @ corners[[0, 2, 3]]
    return np.where((x >= y)[:, None], lower, upper)


RAYS = np.array([[0.31, 0.13, -1.0], [-0.27, 0.2, -1.0], [0.02, -0.25, -1.0], [0.4, -0.2, -1.0]])


@pytest.mark.parametrize("suffix", [".glb", ".gltf"])
def test_values_of_a_file_at_hits(suffix: str, tmp_path: Path) -> None:
    path = gltf(
        tmp_path / f"sheet{suffix}", TEXCOORD_1=UV2.astype(np.float32),
        COLOR_0=np.round(255.0 * COLORS).astype(np.uint8),
    )  # fmt: skip
    directions = RAYS / np.linalg.norm(RAYS, axis=1, keepdims=True)
    hits = Mesh(path=str(path)).hits((0.0, 0.0, 2.0), directions)
    assert hits.hit.all()
    np.testing.assert_allclose(hits.color, at(hits.position, np.round(255.0 * COLORS) / 255.0), atol=1e-6)
    np.testing.assert_allclose(hits.uv2, at(hits.position, UV2 * [1.0, -1.0] + [0.0, 1.0]), atol=1e-6)
    np.testing.assert_allclose(hits.uv, at(hits.position, UV * [1.0, -1.0] + [0.0, 1.0]), atol=1e-6)


def test_integers_and_colours_without_opacity(tmp_path: Path) -> None:
    path = gltf(
        tmp_path / "sheet.glb", TEXCOORD_1=np.round(65535.0 * UV2).astype(np.uint16),
        COLOR_0=COLORS[:, :3].astype(np.float32),
    )  # fmt: skip
    hits = Mesh(path=str(path)).hits((0.0, 0.0, 2.0), np.array([[0.0, 0.0, -1.0]]))
    np.testing.assert_allclose(hits.color[0], [*(0.5 * (COLORS[0] + COLORS[2]))[:3], 1.0], atol=1e-6)
    np.testing.assert_allclose(hits.uv2[0], [0.5, 0.5], atol=1e-4)


def test_a_mesh_without_them_is_white_and_has_0(tmp_path: Path) -> None:
    hits = Mesh(path=str(gltf(tmp_path / "sheet.glb"))).hits((0.0, 0.0, 2.0), RAYS[:1] / np.linalg.norm(RAYS[0]))
    assert (hits.color == 1.0).all()
    assert (hits.uv2 == 0.0).all()


def test_colours_of_other_files_are_srgb(tmp_path: Path) -> None:
    rows = "\n".join(f"{x} {y} {z} 128 64 255 51" for x, y, z in CORNERS)
    names = "".join(f"property float {name}\n" for name in "xyz")
    names += "".join(f"property uchar {name}\n" for name in ("red", "green", "blue", "alpha"))
    head = f"ply\nformat ascii 1.0\nelement vertex 4\n{names}element face 2\nproperty list uchar int vertex_indices\n"
    (tmp_path / "sheet.ply").write_text(f"{head}end_header\n{rows}\n3 0 1 2\n3 0 2 3\n", encoding="utf-8")
    hits = Mesh(path=str(tmp_path / "sheet.ply")).hits((0.0, 0.0, 2.0), np.array([[0.0, 0.0, -1.0]]))
    expected = [*decode_srgb(np.array([128.0, 64.0, 255.0]) / 255.0), 0.2]
    np.testing.assert_allclose(hits.color[0], expected, atol=1e-9)


@pytest.fixture
def drawn(tmp_path: Path) -> Callable[..., np.ndarray]:
    """Draws the sheet with a material."""
    gltf(tmp_path / "sheet.glb", TEXCOORD_1=UV2.astype(np.float32), COLOR_0=COLORS.astype(np.float32))
    ramp = np.linspace(0.1, 0.9, 16).reshape(4, 4)
    images.write_png(tmp_path / "ramp.png", np.repeat(ramp[..., None], 3, axis=2))
    images.write_png(tmp_path / "checker.png", np.random.default_rng(1).uniform(0.3, 1.0, (4, 4, 3)))

    def picture(backend: Backend, material: str = PAINTED, value: str = "vec3(0.0)") -> np.ndarray:
        scene = SCENE.format(size=SIZE, mesh="sheet.glb") + (TEXTURES if material == PAINTED else "")
        (tmp_path / "scene.toml").write_text(scene, encoding="utf-8")
        (tmp_path / "through.sss").write_text(THROUGH, encoding="utf-8")
        (tmp_path / "shown.sss").write_text(SHOWN_TEXT.replace("VALUE", value), encoding="utf-8")
        (tmp_path / "sheet.toml").write_text(material, encoding="utf-8")
        return render(load(str(tmp_path / "scene.toml")), backend)[0]

    return picture


@pytest.mark.parametrize("name", DRAWING)
def test_every_back_end_draws_them(
    name: str, backend: Callable[[str], Backend], drawn: Callable[..., np.ndarray]
) -> None:
    for material, value in ((PAINTED, ""), (SHOWN, "vertex_color.rgb * vertex_color.a + vec3(uv2, 0.0)")):
        expected = drawn(backends.require("numpy"), material, value)
        assert expected.std() > 0.1
        assert np.abs(drawn(backend(name), material, value) - expected).max() < 1.0 / 255.0


def test_each_value_has_its_place_in_the_picture(drawn: Callable[..., np.ndarray], tmp_path: Path) -> None:
    """The oracle, against the points where the camera's rays meet the plane z = 0."""
    for value, corners in (
        ("vertex_color.rgb", COLORS[:, :3]),
        ("vec3(uv2, vertex_color.a)", np.c_[UV2 * [1.0, -1.0] + [0.0, 1.0], COLORS[:, 3]]),
    ):
        picture = drawn(backends.require("numpy"), SHOWN, value)[::-1].reshape(-1, 3)
        origin, directions = load(str(tmp_path / "scene.toml")).camera.rays(*SIZE)
        points = origin + directions * (-origin[2] / directions[:, 2:])
        on_sheet = (np.abs(points[:, 0]) < 0.95) & (np.abs(points[:, 1]) < 0.65)
        assert on_sheet.sum() > 50
        np.testing.assert_allclose(picture[on_sheet], at(points, corners)[on_sheet], atol=1e-5)


TWICE = """
[material]
name = "twice"
[[coordinates]]
technique = "uv_transform"
uv = "uv2"
uv_tiling = { value = [2.0, 4.0], fixed = true }
[[surface]]
technique = "base_color"
[[surface]]
technique = "occlusion_map"
uv = "uv2"
"""


def test_a_coordinates_stage_transforms_the_set_that_it_reads() -> None:
    (text,) = [
        text for name, text in compile(parse_material(TWICE, "twice.toml"), "glsl-330").files.items() if "frag" in name
    ]
    body = text.partition("evaluate_surface(")[2].partition("\n}\n")[0]
    assert "uv2 = uv_transform(uv2)" in body
    assert "base_color(uv, " in body
    assert "occlusion_map(uv2, " in body


@pytest.mark.parametrize(
    ("stage", "message", "hint", "column"),
    [
        (
            'technique = "base_color"\nuv = "uv3"',
            "'uv' takes the name of a set of texture coordinates: uv or uv2", 'write uv = "uv2"', 6,
        ),
        ('technique = "pbr_constants"\nuv = "uv2"', "'pbr_constants' reads no texture coordinates", "omit uv", 1),
    ],
)  # fmt: skip
def test_wrong_sets(stage: str, message: str, hint: str, column: int) -> None:
    with pytest.raises(SssgenError) as caught:
        parse_material(f'[material]\nname = "a"\n[surface]\n{stage}\n', "a.toml")
    (error,) = caught.value.diagnostics
    assert (error.message, error.hint, error.span.line, error.span.column) == (message, hint, 5, column)


def test_a_raymarched_material_has_no_vertices(tmp_path: Path) -> None:
    text = "/** X.\nrole: lighting\n*/\nvec3 marched(vec4 vertex_color, world_direction ray_direction) "
    (tmp_path / "marched.sss").write_text(text + "{ return vertex_color.rgb + ray_direction; }\n", encoding="utf-8")
    (tmp_path / "m.toml").write_text(
        '[material]\nname = "m"\nshading = "unlit"\n[lighting]\ntechnique = "marched.sss"\n', encoding="utf-8"
    )
    for target in all_targets():
        with pytest.raises(SssgenError, match="marched reads vertex_color, but a raymarched material has no mesh"):
            compile(load_material(str(tmp_path / "m.toml")), target)
