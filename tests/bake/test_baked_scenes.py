"""The scenes of examples/bake: baked by the commands that they name, and the same picture on every back end."""

from __future__ import annotations

import dataclasses
import re
import shlex
import shutil
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from folders import ROOT
from slow_cases import diagonal
from sssgen.cli.main import main
from sssgen.pipeline.compiler import compile
from sssgen.run import backends
from sssgen.run.backends import Backend
from sssgen.run.render.scene_render import RenderedPicture, render
from sssgen.scene.scene_loading import load
from sssgen.support.diagnostics import SssgenError

for package in ("trimesh", "igl", "embreex", "xatlas", "scipy", "psutil"):
    pytest.importorskip(package, reason=f"{package} is missing: pip install -e '.[bake]'")

MESHES = ROOT.parent / "shared" / "data" / "meshes"
NAMES = ("spot", "suzanne")
FILE = re.compile(r"\.(obj|npy|png|exr|json)$")
COARSE = {
    "sdf": ["--resolution", "32"],
    "thickness": ["--size", "64", "--rays", "32", "--processes", "1"],
    "depth": ["--size", "64"],
}
"""What makes bakes quick, and pictures still tell one technique from another."""
SCENES = ("spot_distance", "spot_map", "spot_depth", "suzanne_distance", "suzanne_map", "suzanne_depth")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The examples with everything baked."""
    top = tmp_path_factory.mktemp("bake")
    shutil.copytree(ROOT / "examples" / "ice", top / "ice")
    result: Path = shutil.copytree(ROOT / "examples" / "bake", top / "bake")
    for name in NAMES:
        if (MESHES / f"{name}.obj").is_file():
            shutil.copy(MESHES / f"{name}.obj", result)
    for scene in sorted(result.glob("*.toml")):
        text = scene.read_text(encoding="utf-8")
        if (needed := re.search(r'file = "([a-z]+)[_.]', text)) and not (result / f"{needed[1]}.obj").is_file():
            continue
        for command in re.findall(r"^# sssgen (bake [^;\n]*)", text, re.MULTILINE):
            words = [
                str(result / word) if re.search(r"\.(obj|npy|png|exr|json)$", word) else word
                for word in shlex.split(command)
            ]
            assert main([*words, *COARSE.get(words[1], [])]) == 0
    return result


@cache
def drawn(scene: Path, backend: str) -> RenderedPicture:
    loaded = load(scene)
    return render(dataclasses.replace(loaded, size=(48, 40), samples=1), backends.get(backend))


def scene_path(folder: Path, name: str) -> Path:
    mesh = name.partition("_")[0]
    if mesh in NAMES and not (folder / f"{mesh}.obj").is_file():
        pytest.skip(f"{mesh}.obj is missing: it lies in ../shared/data/meshes")
    return folder / f"{name}.toml"


@pytest.mark.parametrize(
    ("name", "other"), diagonal([*SCENES[:3], "ice_baked_scene"], ["gl", "webgpu", "browser", "hlsl"])
)
def test_every_back_end_draws_the_same(name: str, other: str, folder: Path, backend: Callable[[str], Backend]) -> None:
    backend(other)
    scene = scene_path(folder, name)
    oracle = drawn(scene, "numpy")
    assert 255.0 * np.abs(drawn(scene, other).encoded - oracle.encoded).max() < 1.0
    shown = oracle.encoded[oracle.covered > 0.5]
    assert 0.2 < shown.mean() < 0.85 and shown.mean(axis=1).std() > 0.03


@pytest.mark.parametrize("mesh", NAMES)
def test_thin_parts_are_bright_and_the_three_ways_differ(
    mesh: str, folder: Path, backend: Callable[[str], Backend]
) -> None:
    backend("gl")
    pictures = [drawn(scene_path(folder, f"{mesh}_{way}"), "gl") for way in ("distance", "map", "depth")]
    for picture in pictures:
        red, blue = picture.encoded[..., 0], picture.encoded[..., 2]
        shown = picture.covered > 0.9
        assert np.ptp(blue[shown]) > 0.3 and (red[shown] > blue[shown]).mean() > 0.9  # wax
    first, second, third = (picture.encoded for picture in pictures)
    assert min(np.abs(first - second).max(), np.abs(second - third).max(), np.abs(first - third).max()) > 0.1


@pytest.mark.parametrize("material", ["wax_distance", "wax_map", "wax_depth", "ice_baked"])
def test_import_settings_are_reported(material: str, folder: Path) -> None:
    textures = compile(folder / f"{material}.toml", "wgsl").reflection["textures"]
    messages = {texture["technique_name"]: texture["import"] for texture in textures}
    if material == "wax_distance":
        volume = messages["distance_map"]
        assert (volume["dimension"], volume["wrap"], volume["mipmaps"], volume["srgb"]) == ("3D", "clamp", False, False)
    if material == "wax_depth":
        assert messages["light_depth_map"]["wrap"] == "clamp" and not messages["light_depth_map"]["mipmaps"]
    if material == "ice_baked":
        assert messages["normal_texture"]["normal_map"] and not messages["thickness_texture"]["srgb"]
        assert messages["thickness_texture"]["wrap"] == "repeat" and messages["thickness_texture"]["mipmaps"]
    assert messages["base_color_texture"]["srgb"]


PAIRS = {
    "normals as a colour": ("base_color", "base_color_texture", ["normal", "cells.png"], "takes colours"),
    "cells as normals": ("normal_map", "normal_texture", ["voronoi"], "takes normals"),
    "normals with green down": ("normal_map", "normal_texture", ["normal", "cells.png", "--green", "directx"], "green"),
    "a thickness as a view": (
        "depth_map_thickness",
        "light_depth_map",
        ["voronoi"],
        "takes an image of the body from one view",
    ),
    "normals as a height": ("normal_from_height", "height_texture", ["normal", "cells.png"], "takes other numbers"),
}


@pytest.mark.parametrize("pair", PAIRS)
def test_incompatible_textures_are_refused(pair: str, tmp_path: Path) -> None:
    technique, texture, words, message = PAIRS[pair]
    assert main(["bake", "voronoi", "-o", str(tmp_path / "cells.png"), "--size", "16", "--cells", "4"]) == 0
    words = [str(tmp_path / word) if FILE.search(word) else word for word in words]
    file = tmp_path / "made.png"
    assert (
        main(["bake", words[0], *words[1:], "-o", str(file), *(["--size", "16"] if words[0] == "voronoi" else [])]) == 0
    )
    section = "thickness" if technique.endswith("thickness") else "surface"
    text = f'[material]\nname = "m"\n[{section}]\ntechnique = "{technique}"\n{texture} = "made.png"\n'
    text += '[translucency]\ntechnique = "absorption_tint"\n' if section == "thickness" else ""
    (tmp_path / "m.toml").write_text(text, encoding="utf-8")
    with pytest.raises(SssgenError, match=message):
        compile(tmp_path / "m.toml", "wgsl")


def test_a_fixed_parameter_is_the_baked_one(tmp_path: Path) -> None:
    (tmp_path / "t.png.json").write_text(
        '{"format": 1, "kind": "thickness", "holds": "thickness", "parameters": {"thickness_factor": 0.25}}',
        encoding="utf-8",
    )
    head = '[material]\nname = "m"\n[thickness]\ntechnique = "thickness_map"\nthickness_texture = "t.png"\n'
    rest = '[translucency]\ntechnique = "absorption_tint"\n'
    (tmp_path / "m.toml").write_text(f"{head}thickness_factor = {{ fixed = true }}\n{rest}", encoding="utf-8")
    text = compile(tmp_path / "m.toml", "wgsl").files["m.wgsl"]
    assert "return 0.25 * " in text and "material.thickness_factor" not in text
    for wrong in ("1" + 400 * "0", '"a"', "[[1]]", "NaN"):
        message = f'"holds": "thickness", "parameters": {{"thickness_factor": {wrong}}}'
        (tmp_path / "t.png.json").write_text(f'{{"format": 1, "kind": "thickness", {message}}}', encoding="utf-8")
        with pytest.raises(SssgenError, match="must be a number or a list of numbers"):
            compile(tmp_path / "m.toml", "wgsl")
