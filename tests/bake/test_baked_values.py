"""What materials, scenes and GPUs take from baked files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bake_meshes as meshes
from bake_meshes import bake, facts, write
from sssgen.cli.main import main

pytest.importorskip("trimesh", reason="trimesh is missing: pip install -e '.[bake]'")
pytest.importorskip("igl", reason="libigl is missing: pip install -e '.[bake]'")
pytest.importorskip("embreex", reason="embreex is missing: pip install -e '.[bake]'")
pytest.importorskip("scipy", reason="SciPy is missing: pip install -e '.[bake]'")
pytest.importorskip("xatlas", reason="xatlas is missing: pip install -e '.[bake]'")
pytest.importorskip("psutil", reason="psutil is missing: pip install -e '.[bake]'")
pytest.importorskip("OpenEXR", reason="OpenEXR is missing: pip install -e '.[bake]'")

from sssgen.material.material_loading import load_material
from sssgen.pipeline.compiler import compile
from sssgen.run.backends import Backend
from sssgen.run.render.scene_values import shell_of
from sssgen.run.render.shell_values import Shell
from sssgen.scene.pictures import images
from sssgen.scene.scene_loading import load
from sssgen.support.diagnostics import SssgenError

pytestmark = pytest.mark.usefixtures("folder")


# What materials and scenes take


def material(path: str, section: str) -> str:
    Path(path).write_text(
        f"""
[material]
name = "made"
shading = "lit"
{section}
[translucency]
technique = "absorption_tint"
[[surface]]
technique = "base_color"
[[surface]]
technique = "pbr_constants"
""",
        encoding="utf-8",
    )
    return path


def mapped(quantity: str, file: str, more: str = "") -> str:
    conversion = '[[thickness]]\ntechnique = "thickness_from_transmittance"\n' if quantity == "transmittance" else ""
    return f'[[thickness]]\ntechnique = "{quantity}_map"\n{quantity}_texture = "{file}"\n{more}\n{conversion}'


MODES = {"thickness": [], "transmittance": ["--mode", "transmittance", "--attenuation", "0.4"]}


@pytest.fixture(scope="module")
def baked_maps(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """thickness.png and transmittance.png, each with its JSON."""
    folder = tmp_path_factory.mktemp("maps")
    box = write(folder / "box.obj", meshes.box((1.0, 0.6, 0.4)))
    for quantity, mode in MODES.items():
        path = str(folder / f"{quantity}.png")
        bake("thickness", box, "-o", path, "--size", "24", "--rays", "8", "--processes", "1", *mode)
    return folder


@pytest.fixture
def maps(baked_maps: Path, folder: Path) -> None:
    """The same, here."""
    for quantity in MODES:
        for name in (f"{quantity}.png", f"{quantity}.png.json"):
            (folder / name).write_bytes((baked_maps / name).read_bytes())


@pytest.mark.parametrize("quantity", MODES)
def test_a_map_of_another_quantity_is_refused(maps: None, quantity: str) -> None:
    (other,) = MODES.keys() - {quantity}
    with pytest.raises(SssgenError) as caught:
        load_material(material("made.toml", mapped(quantity, f"{other}.png")))
    message = str(caught.value)
    assert f"'{other}.png' holds {other}, and '{quantity}_texture' takes {quantity}" in message
    assert f"{other}_map" in message and "made.toml:7" in message


@pytest.mark.parametrize("quantity", MODES)
def test_a_map_of_the_right_one_compiles_for_all_targets(maps: None, quantity: str) -> None:
    path = material("made.toml", mapped(quantity, f"{quantity}.png"))
    assert main(["emit", path, "--target", "all", "-o", "out"]) == 0
    assert len(list(Path("out").iterdir())) > 8


def test_the_factor_defaults_to_that_of_the_map(maps: None) -> None:
    loaded = load_material(material("made.toml", mapped("thickness", "thickness.png")))
    top = facts("thickness.png")["range"][1]
    assert loaded.stages[0].values["thickness_factor"] == (pytest.approx(top),) and 0.4 < top < 1.3
    message = load_material(material("said.toml", mapped("thickness", "thickness.png", "thickness_factor = 2.5")))
    assert message.stages[0].values["thickness_factor"] == (2.5,)
    alias = load_material(material("alias.toml", mapped("thickness", "thickness.png", "thicknessFactor = 2.5")))
    assert alias.stages[0].values["thickness_factor"] == (2.5,)


def test_a_map_without_json_is_accepted(maps: None) -> None:
    Path("thickness.png.json").unlink()
    loaded = load_material(material("made.toml", mapped("transmittance", "thickness.png")))
    assert loaded.stages[0].textures == {"transmittance_texture": "thickness.png"}


def test_a_faulty_json_is_an_error(maps: None) -> None:
    for text in ("{", '{"kind": "thickness", "format": 99}', '{"kind": "thickness", "format": 1, "parameters": 3}'):
        Path("thickness.png.json").write_text(text, encoding="utf-8")
        with pytest.raises(SssgenError):
            load_material(material("made.toml", mapped("thickness", "thickness.png")))


MARCH = """
[thickness]
technique = "march_light"
bind = { body_distance = "distance_texture_world" }
"""


def test_a_distance_texture_brings_its_box() -> None:
    bake("sdf", "box.obj", "-o", "o.dds", "--resolution", "16")
    loaded = load_material(material("made.toml", MARCH + 'distance_map = "o.dds"'))
    for name, value in facts("o.dds")["parameters"].items():
        assert loaded.stages[0].values[name] == pytest.approx(np.atleast_1d(value))
    inputs = load_material(material("given.toml", MARCH + 'distance_map = "o.dds"\ndistance_range = 3.0'))
    assert inputs.stages[0].values["distance_range"] == (3.0,)
    assert inputs.stages[0].values["box_min"] == loaded.stages[0].values["box_min"]


def test_a_picture_is_no_volume(maps: None) -> None:
    with pytest.raises(SssgenError, match=r"'thickness.png' is a 2D texture, and 'distance_map' is 3D"):
        load_material(material("made.toml", MARCH + 'distance_map = "thickness.png"'))


def shell(textures: str, section: str, place: str = "", parameters: str = "") -> Shell:
    """The values of a scene for a material with these textures in its folder."""
    path = material("made.toml", section)
    Path("scene.toml").write_text(
        f'material = "{path}"\n[geometry]\nkind = "mesh"\nfile = "box.obj"\n{place}\n'
        f"[[light]]\ndirection = [0, 0, 1]\n[parameters]\n{parameters}\n[textures]\n{textures}\n",
        encoding="utf-8",
    )
    scene = load(Path("scene.toml"))
    loaded = load_material(path)
    return shell_of(scene, loaded, compile(loaded, "numpy").reflection)


@pytest.mark.parametrize("format", ["npy", "dds", "ktx2"])
def test_scenes_read_distance_textures(format: str) -> None:
    bake("sdf", "box.obj", "-o", f"o.{format}", "--resolution", "16")
    description = facts(f"o.{format}")["parameters"]
    scene_read = shell(f'distance_map = "o.{format}"', MARCH, "scale = 2.0\nposition = [1.0, 2.0, 3.0]")
    texture = scene_read.textures["distance_map"]
    assert texture.dim == "3D" and texture.wrap == "clamp"
    expected = images.read(f"o.{format}")[..., 0]
    assert texture.levels[0][..., 0] == pytest.approx(expected, abs=2.0**-11)
    for name, value in description.items():
        assert scene_read.parameters[name] == pytest.approx(np.atleast_1d(value))
    assert scene_read.parameters["object_scale"] == (2.0,)
    to_object = np.reshape(scene_read.parameters["world_to_object"], (4, 4)).T
    assert to_object @ [3.0, 2.0, 3.0, 1.0] == pytest.approx([1.0, 0.0, 0.0, 1.0])
    inputs = shell(f'distance_map = "o.{format}"', MARCH, parameters="distance_range = 3.0")
    assert inputs.parameters["distance_range"] == (3.0,)


def test_scenes_read_maps(maps: None) -> None:
    scene_read = shell('thickness_texture = "thickness.png"', '[thickness]\ntechnique = "thickness_map"', "scale = 3.0")
    top = facts("thickness.png")["range"][1]
    assert scene_read.parameters["thickness_factor"] == pytest.approx((3.0 * top,))  # units of the world
    stored = images.read("thickness.png")
    assert scene_read.textures["thickness_texture"].levels[0][..., 0] == pytest.approx(
        np.flipud(stored)[..., 0], abs=2.0**-11
    )
    with pytest.raises(SssgenError, match="holds transmittance, and 'thickness_texture' takes thickness"):
        shell('thickness_texture = "transmittance.png"', '[thickness]\ntechnique = "thickness_map"')
    with pytest.raises(SssgenError, match="holds thickness, and 'transmittance_texture' takes transmittance"):
        shell('transmittance_texture = "thickness.png"', mapped("transmittance", "transmittance.png"))


# GPUs take the bytes as they are


def raw(encoding: str) -> tuple[tuple[int, int, int], bytes]:
    """A baked .raw file, whose rows are no multiple of four bytes long."""
    bake("sdf", "box.obj", "-o", "o.raw", "--resolution", "7,5,6", "--encode", encoding, "--format", "raw+json")
    size = facts("o.raw")["file"]["size"]
    return (size["x"], size["y"], size["z"]), Path("o.raw").read_bytes()


@pytest.mark.parametrize(("encoding", "dtype"), [("r8", "f1"), ("r16", "nu2"), ("r16f", "f2"), ("r32f", "f4")])
def test_opengl_accepts_the_bytes(backend: Callable[[str], Backend], encoding: str, dtype: str) -> None:
    context: Any = getattr(backend("gl"), "context")  # noqa: B009 - of that back end only
    size, data = raw(encoding)
    with context:
        texture = context.texture3d(size, 1, data, alignment=1, dtype=dtype)
        try:
            assert texture.read(alignment=1) == data
        finally:
            texture.release()


@pytest.mark.parametrize(("encoding", "format"), [("r8", "r8unorm"), ("r16f", "r16float"), ("r32f", "r32float")])
def test_webgpu_accepts_the_bytes(backend: Callable[[str], Backend], encoding: str, format: str) -> None:
    device: Any = getattr(backend("webgpu"), "gpu")  # noqa: B009 - of that back end only
    import wgpu

    (width, height, depth), data = raw(encoding)
    size = (width, height, depth)
    usage = wgpu.TextureUsage.COPY_DST | wgpu.TextureUsage.COPY_SRC
    texture = device.create_texture(size=size, dimension="3d", format=format, usage=usage)
    layout = {"offset": 0, "bytes_per_row": len(data) // (height * depth), "rows_per_image": height}
    device.queue.write_texture({"texture": texture}, data, layout, size)
    assert bytes(device.queue.read_texture({"texture": texture}, layout, size)) == data
