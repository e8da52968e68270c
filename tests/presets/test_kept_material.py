"""What `sssgen use` keeps of the material of a glTF file, and what it says about the rest."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gltf_files import write_gltf
from sssgen.cli.main import main
from sssgen.interchange.surface_model import Picture
from sssgen.interchange.texels import read_texels
from sssgen.material.material_loading import load_material
from sssgen.material.model import TechniqueUse
from sssgen.scene.mesh_files import read
from textured_head import textured

pytest.importorskip("trimesh", reason="trimesh is missing: pip install -e '.[import]'")

TILING = {"KHR_texture_transform": {"scale": [2.0, 3.0]}}


@pytest.fixture
def head(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.chdir(tmp_path)
    return write_gltf(Path("head.glb"), *textured()).name


def stages(folder: str, name: str) -> dict[str, TechniqueUse]:
    """Technique → its stage."""
    material = load_material(str(Path(folder, f"{name}.toml")))
    return {stage.technique.name: stage for stage in material.stages}


def used(*arguments: str, capsys: pytest.CaptureFixture[str]) -> dict[str, Any]:
    """Runs the command; gives its report."""
    assert main(["use", *arguments, "-o", "out", "--force", "--json"]) == 0
    report: dict[str, Any] = json.loads(capsys.readouterr().out)
    return report


def outcomes(report: dict[str, Any]) -> dict[str, str]:
    """The last part of an element's path → what became of it."""
    return {row["element"].rpartition("/")[2]: row["outcome"] for row in report["report"]["rows"]}


@pytest.mark.parametrize(("preset", "color"), [("skin_fair", "approximated"), ("jade", "left out")])
def test_pictures_are_kept(preset: str, color: str, head: str, capsys: pytest.CaptureFixture[str]) -> None:
    """The colour of skin keeps its detail; jade is jade."""
    report = used(preset, head, capsys=capsys)
    assert outcomes(report) == {
        "baseColorTexture": color, "metallicRoughnessTexture": "approximated", "normalTexture": "mapped",
        "occlusionTexture": "mapped", "emissiveFactor": "left out", "metallicFactor": "left out",
    }  # fmt: skip
    chain = stages("out", preset)
    assert chain["normal_map"].textures == {"normal_texture": "textures/normal.png"}
    assert chain["occlusion_map"].textures == {"occlusion_texture": "textures/occlusion.png"}
    assert bool(chain["base_color"].textures) == (color != "left out")
    assert {"out/textures/normal.png", "out/textures/occlusion.png"} <= set(report["files"])
    page = Path("out", "main.js").read_text(encoding="utf-8")
    assert "normalTexture: await picture('textures/normal.png', THREE.RepeatWrapping)" in page


def test_the_roughness_varies_about_that_of_the_preset(head: str, capsys: pytest.CaptureFixture[str]) -> None:
    used("wax", head, capsys=capsys)
    picture = read_texels(Picture("", Path("out/textures/metallic_roughness.png").read_bytes()))
    assert picture[..., 1] == pytest.approx(0.38, abs=0.005)


@pytest.mark.parametrize("quality", ["fast", "good"])
def test_the_mean_color_is_that_of_the_preset(quality: str, head: str, capsys: pytest.CaptureFixture[str]) -> None:
    """The picture of one colour changes nothing but the share of the light that it gets."""
    used("skin_fair", head, "--quality", quality, "--no-keep-color", capsys=capsys)
    plain = stages("out", "skin_fair")
    used("skin_fair", head, "--quality", quality, capsys=capsys)
    detailed = stages("out", "skin_fair")
    from sssgen.scene.pictures.images import decode_srgb

    texel = decode_srgb(np.array([200.0, 100.0, 50.0]) / 255.0)
    shown = np.array(detailed["base_color"].values["tint"][:3]) * texel
    if quality == "fast":
        assert shown == pytest.approx(plain["base_color"].values["tint"][:3], rel=1e-3)
    else:
        assert shown[0] > shown[1] > shown[2] > 0.0
        halved = 0.5 * np.array(plain["interior_octaves_refracted"].values["octaves"])
        assert detailed["interior_octaves_refracted"].values["octaves"] == pytest.approx(halved)


def test_clear_and_thin_bodies_take_the_color_on_request(head: str, capsys: pytest.CaptureFixture[str]) -> None:
    used("honey", head, "--keep-color", capsys=capsys)
    assert stages("out", "honey")["seen_through_body"].textures == {"entering_texture": "textures/entering.png"}
    used("leaf", head, capsys=capsys)
    leaf = stages("out", "leaf")
    assert leaf["diffuse_transmission_map"].textures and leaf["base_color"].textures


def test_baked_light_has_no_picture(head: str, capsys: pytest.CaptureFixture[str], monkeypatch: Any) -> None:
    monkeypatch.setattr("sssgen.presets.project_files._baked_light", lambda *_: {})
    report = used("skin_fair", head, "--quality", "best", capsys=capsys)
    assert outcomes(report)["baseColorTexture"] == "left out"
    assert outcomes(report)["normalTexture"] == "mapped"


def test_nodes_and_metres_are_respected(head: str, capsys: pytest.CaptureFixture[str]) -> None:
    used("wax", head, "--size", "file", capsys=capsys)
    content = read("out/body.glb")
    assert content.vertices.min(axis=0) == pytest.approx([0.0, -1.0, -1.0])
    assert content.vertices.max(axis=0) == pytest.approx([2.0, 1.0, 1.0])
    assert "A world unit is 1000 mm" in Path("out", "wax.toml").read_text(encoding="utf-8")


def test_texture_coordinates_are_moved_as_the_pictures(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Those of most pictures; the others are left out."""
    monkeypatch.chdir(tmp_path)
    content, data = textured()
    for key in ("normalTexture", "occlusionTexture"):
        content["materials"][0][key]["extensions"] = TILING
    write_gltf(Path("head.glb"), content, data)
    report = used("jade", "head.glb", "--keep-color", capsys=capsys)
    assert outcomes(report)["metallicRoughnessTexture"] == outcomes(report)["baseColorTexture"] == "left out"
    uv = read("out/body.glb").uv
    assert uv is not None and np.ptp(uv, axis=0) == pytest.approx([2.0, 3.0])
    assert "uv_transform" not in stages("out", "jade")


def test_a_relief_has_tangents(head: str, capsys: pytest.CaptureFixture[str]) -> None:
    used("wax", head, capsys=capsys)
    data = Path("out/body.glb").read_bytes()
    header = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
    attributes = header["meshes"][0]["primitives"][0]["attributes"]
    view = header["bufferViews"][header["accessors"][attributes["TANGENT"]]["bufferView"]]
    start = 28 + int.from_bytes(data[12:16], "little") + view["byteOffset"]
    tangents = np.frombuffer(data, "<f4", view["byteLength"] // 4, start).reshape(-1, 4)
    assert np.linalg.norm(tangents[:, :3], axis=1) == pytest.approx(1.0, abs=1e-5)
    assert set(tangents[:, 3]) <= {-1.0, 1.0}


def two_parts() -> tuple[dict[str, Any], bytes]:
    content, data = textured()
    content["materials"].append({"name": "Eyes"})
    eyes = {**content["meshes"][0]["primitives"][0], "material": 1}
    content["meshes"].append({"primitives": [eyes]})
    content["nodes"].append({"mesh": 1, "translation": [9.0, 0.0, 0.0]})
    content["scenes"] = [{"nodes": [0, 1]}]
    return content, data


def test_several_materials(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    write_gltf(Path("two.gltf"), *two_parts())
    report = used("skin_fair", "two.gltf", capsys=capsys)
    assert "choose one with --material (Skin, Eyes)" in " ".join(report["warnings"])
    assert read("out/body.glb").vertices[:, 0].max() == pytest.approx(9.5)
    assert not Path("out/textures").exists()
    report = used("skin_fair", "two.gltf", "--material", "Skin", capsys=capsys)
    assert not report["warnings"] and "rest.glb" in Path("out/main.js").read_text(encoding="utf-8")
    rest = read("out/rest.glb")
    assert rest.vertices[:, 0].min() > 2.0 and rest.vertices[:, 0].max() == pytest.approx(9.5)
    used("skin_fair", "two.gltf", "--material", "Skin", "--turn", "180", "--up", "z", capsys=capsys)
    moved = rest.vertices[:, [0, 2, 1]] * [-1.0, 1.0, 1.0]  # (x, y, z) → (x, z, -y), then (-x, y, -z)
    assert np.sort(read("out/rest.glb").vertices, axis=0) == pytest.approx(np.sort(moved, axis=0), abs=1e-6)
    report = used("skin_fair", "two.gltf", "--material", "Skin", "--target", "gltf", capsys=capsys)
    assert "left out are the parts with other materials: Eyes" in report["warnings"]
    assert read("out/body.glb").vertices[:, 0].max() == pytest.approx(2.0)
    assert Path("out/textures/normal.png").is_file()
    assert main(["use", "wax", "two.gltf", "--material", "Skn", "-o", "other"]) == 2
    assert "did you mean 'Skin'" in capsys.readouterr().err


def test_two_materials_of_one_name_are_chosen_by_number(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    content, data = two_parts()
    content["materials"][1]["name"] = "Skin"
    write_gltf(Path("two.gltf"), content, data)
    assert main(["use", "wax", "two.gltf", "--material", "Skin", "-o", "out"]) == 2 and not Path("out").exists()
    error = capsys.readouterr().err
    assert "2 materials are called 'Skin'" in error and "--material 0 or 1" in error
    used("wax", "two.gltf", "--material", "1", capsys=capsys)
    assert read("out/body.glb").vertices[:, 0].min() > 2.0 > read("out/rest.glb").vertices[:, 0].max() - 0.1


def test_pictures_of_a_mesh_without_texture_coordinates_are_left_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    content, data = textured()
    del content["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"]
    write_gltf(Path("head.glb"), content, data)
    report = used("skin_fair", "head.glb", capsys=capsys)
    rows = [row for row in report["report"]["rows"] if row["element"].endswith("Texture")]
    assert {row["became"] for row in rows} == {"the mesh has no texture coordinates"}
    assert not any(use.textures for use in stages("out", "skin_fair").values())


def test_an_export_says_that_a_mesh_has_no_texture_coordinates(head: str, capsys: pytest.CaptureFixture[str]) -> None:
    used("skin_fair", head, capsys=capsys)
    content, data = textured()
    del content["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"]
    write_gltf(Path("bare.glb"), content, data)
    for mesh, is_bare in ((head, False), ("bare.glb", True)):
        assert main(["export-gltf", "out/skin_fair.toml", "--mesh", mesh, "-o", "skin.glb"]) == 0
        assert ("left out: texture coordinates: the mesh has none" in capsys.readouterr().out) == is_bare


@pytest.mark.parametrize(
    ("extension", "hint"),
    [
        ("KHR_draco_mesh_compression", "@gltf-transform/cli copy"),
        ("EXT_meshopt_compression", "@gltf-transform/cli copy"),
        ("KHR_texture_basisu", "@gltf-transform/cli ktxdecompress"),
    ],
)
def test_compressed_files_are_errors_with_a_way_out(
    extension: str, hint: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    write_gltf(Path("head.glb"), *textured(extensionsRequired=[extension]))
    assert main(["use", "wax", "head.glb", "-o", "out"]) == 2 and not Path("out").exists()
    error = capsys.readouterr().err
    assert extension in error and hint in error
