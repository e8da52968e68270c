"""glTF materials as materials of sssgen: parameters, textures, meshes, thickness, and the report."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gltf_files import box, data_uri, png, write_gltf
from sssgen.interchange.gltf_reader import read
from sssgen.interchange.imported_material import ImportedMaterial
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.material_writer import identifiers, mean_chord, write_import
from sssgen.material.material_loading import load_material
from sssgen.material.scatter_color import albedo_of_multiscatter, multiscatter_of_albedo
from sssgen.scene import mesh_files, scene_loading
from sssgen.scene.pictures import images

GLASS = {"KHR_materials_transmission": {"transmissionFactor": 1.0}}


def imported(tmp_path: Path, material: dict[str, Any], **more: Any) -> tuple[ImportedMaterial, Report]:
    content, data = box(material)
    report = Report("box")
    (result,) = read(str(write_gltf(tmp_path / "box.gltf", {**content, **more}, data)), report)
    return result, report


def written(tmp_path: Path, material: dict[str, Any], **more: Any) -> tuple[Path, Report]:
    result, report = imported(tmp_path, material, **more)
    (place,) = write_import(str(tmp_path / "out"), [result], report)
    return tmp_path / "out" / place.name, report


def volume(**values: Any) -> dict[str, Any]:
    return {"extensions": {**GLASS, "KHR_materials_volume": {"thicknessFactor": 1.0, **values}}}


def test_thickness_is_scaled_by_the_node_and_attenuation_is_not(tmp_path: Path) -> None:
    material = volume(thicknessFactor=0.5, attenuationColor=[0.5, 0.25, 1.0], attenuationDistance=2.0)
    result, _ = imported(tmp_path, material, nodes=[{"mesh": 0, "scale": [3.0, 3.0, 3.0]}])
    assert result.model.thickness.factor == pytest.approx((1.5,))
    assert result.model.interior is not None
    assert result.model.interior.extinction == pytest.approx((math.log(2.0) / 2.0, math.log(4.0) / 2.0, 0.0))


def test_nodes_of_different_scales_are_reported(tmp_path: Path) -> None:
    nodes = [{"children": [1, 2]}, {"mesh": 0}, {"mesh": 0, "scale": [2.0, 2.0, 2.0]}]
    result, report = imported(tmp_path, volume(), nodes=nodes)
    assert result.model.thickness.factor == pytest.approx((1.8,))  # weighted by area: (1 + 2 · 4) / 5
    assert any("different scales" in row.element for row in report.rows)


def test_a_mirrored_node_keeps_its_front(tmp_path: Path) -> None:
    result, _ = imported(tmp_path, {"name": "a"}, nodes=[{"mesh": 0, "scale": [-1.0, 1.0, 1.0]}])
    assert result.mesh is not None and result.mesh.normals is not None
    corners = result.mesh.vertices[result.mesh.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("nc,nc->n", across, corners.mean(axis=1)) > 0.0).all()
    assert (np.einsum("nc,nc->n", across, result.mesh.normals[result.mesh.faces[:, 0]]) > 0.0).all()


def test_a_body_that_transmits_has_less_diffuse_light(tmp_path: Path) -> None:
    material = {
        "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.4, 0.2, 1.0], "metallicFactor": 0.25},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.5}},
    }
    folder, _ = written(tmp_path, material)
    chain = {stage.technique.name: stage.values for stage in load_material(str(next(folder.glob("[!s]*.toml")))).stages}
    entering = np.array([0.8, 0.4, 0.2]) * 0.5 * 0.75
    np.testing.assert_allclose(chain["seen_through"]["entering_color"], entering, rtol=1e-5)
    np.testing.assert_allclose(chain["base_color"]["tint"][:3], np.array([0.8, 0.4, 0.2]) - entering, rtol=1e-5)


def test_textures_have_the_channels_that_techniques_read(tmp_path: Path) -> None:
    material = {
        **volume(thicknessTexture={"index": 0}),
        "pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 0}, "baseColorTexture": {"index": 1}},
        "alphaMode": "MASK",
        "alphaCutoff": 0.25,
    }
    pictures = [{"uri": data_uri(png((10, 100, 200)))}, {"uri": data_uri(png((255, 128, 0, 64)))}]
    textures = [{"source": 0}, {"source": 1}]
    folder, _ = written(tmp_path, material, images=pictures, textures=textures)
    texel = {path.stem: (255.0 * images.read(path)[0, 0]).round().tolist() for path in folder.glob("textures/*.png")}
    assert texel["thickness"] == [100.0]  # glTF's green
    assert texel["metallic_roughness"] == [255.0, 100.0, 200.0]
    assert texel["base_color"][3] == 128.0  # the cutoff is one half


def test_the_texture_coordinates_of_the_mesh_are_kept(tmp_path: Path) -> None:
    folder, _ = written(
        tmp_path,
        {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}},
        images=[{"uri": data_uri(png((1, 2, 3)))}],
        textures=[{"source": 0}],
    )
    content = mesh_files.read(str(folder / "mesh.glb"))
    assert content.uv is not None and content.normals is not None
    assert set(map(tuple, content.uv.tolist())) == {(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)}
    assert scene_loading.load(str(folder / "scene.toml")).material


def test_an_image_with_a_third_transform_is_its_mean(tmp_path: Path) -> None:
    def info(offset: float) -> dict[str, Any]:
        return {"index": 0, "extensions": {"KHR_texture_transform": {"offset": [offset, 0.0]}}}

    material = {
        "pbrMetallicRoughness": {"baseColorTexture": info(0.1)}, "normalTexture": info(0.2),
        "emissiveTexture": info(0.3), "emissiveFactor": [1.0, 1.0, 1.0],
    }  # fmt: skip
    result, report = imported(
        tmp_path, material, images=[{"uri": data_uri(png((255, 0, 255)))}], textures=[{"source": 0}]
    )
    write_import(str(tmp_path / "out"), [result], report)
    rows = [row for row in report.rows if row.outcome == "approximated"]
    assert any("the mean of its picture" in row.became for row in rows)


def test_a_sheen_is_the_same_everywhere(tmp_path: Path) -> None:
    sheen = {"sheenColorFactor": [0.8, 0.4, 0.2], "sheenRoughnessFactor": 0.6, "sheenColorTexture": {"index": 0}}
    material = {"extensions": {"KHR_materials_sheen": sheen}}
    pictures, textures = [{"uri": data_uri(png((255, 0, 255)))}], [{"source": 0}]
    folder, report = written(tmp_path, material, images=pictures, textures=textures)
    chain = {stage.technique.name: stage.values for stage in load_material(str(next(folder.glob("[!s]*.toml")))).stages}
    np.testing.assert_allclose(chain["sheen_constants"]["sheen_tint"], [0.8, 0.0, 0.2], atol=1e-6)
    assert chain["sheen_constants"]["sheen_spread"] == pytest.approx((0.6,))
    rows = {row.element.rpartition("/")[2]: row.outcome for row in report.rows}
    assert (rows["sheenColorFactor"], rows["sheenRoughnessFactor"]) == ("approximated", "mapped")


def test_what_has_no_effect_is_left_out(tmp_path: Path) -> None:
    material = {"extensions": {"KHR_materials_volume": {"thicknessFactor": 1.0}, "KHR_materials_iridescence": {}}}
    _, report = imported(tmp_path, material, animations=[{"channels": [], "samplers": []}])
    left = {row.element: row.became for row in report.rows if row.outcome == "left out"}
    assert left["/materials/0/extensions/KHR_materials_volume/thicknessFactor"] == "no light enters the body"
    assert "/materials/0/extensions/KHR_materials_iridescence" in left and "/animations" in left


def test_a_sheet_that_scatters_keeps_its_light(tmp_path: Path) -> None:
    material = {
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1.0], "metallicFactor": 0.0},
        "extensions": {
            "KHR_materials_transmission": {"transmissionFactor": 0.8},
            "KHR_materials_scatter": {
                "scatterStrengthFactor": 1.0, "multiscatterColorFactor": [0.4, 0.4, 0.4], "scatterAnisotropy": 0.5,
            },
        },
    }  # fmt: skip
    model = imported(tmp_path, material)[0].model
    through = model.diffuse_transmission.factor[0] * model.diffuse_transmission_color.factor[0]
    reflected = model.base_color.factor[0] * (1.0 - model.diffuse_transmission.factor[0])
    assert through == pytest.approx(0.8 * 0.4 * 0.75)
    assert reflected == pytest.approx(0.2 * 0.5 + 0.8 * 0.4 * 0.25)


def test_the_colour_of_a_dense_body() -> None:
    colors = np.linspace(0.0, 1.0, 11)
    albedo = albedo_of_multiscatter(colors, 0.3)
    assert albedo[0] == pytest.approx(0.0, abs=1e-3) and albedo[-1] == pytest.approx(1.0, abs=1e-4)
    np.testing.assert_allclose(multiscatter_of_albedo(albedo, 0.3), colors, atol=1e-4)


def test_names() -> None:
    assert identifiers(["Amber Glass", "amber glass", "2nd", "名前", "CarPaint"]) == [
        "amber_glass", "amber_glass_2", "material_2nd", "material", "car_paint",
    ]  # fmt: skip


def test_the_mean_chord_of_a_cube(tmp_path: Path) -> None:
    mesh = imported(tmp_path, {"name": "a"})[0].mesh
    assert mesh is not None
    assert mean_chord(mesh) == pytest.approx(4.0 / 6.0)


def test_the_mesh_has_its_own_thickness(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for package in ("xatlas", "embreex", "igl"):
        pytest.importorskip(package)
    from sssgen.interchange import thickness_bake

    monkeypatch.setattr(thickness_bake, "SIDE", 32)
    monkeypatch.setattr(thickness_bake, "RAYS", 16)
    result, report = imported(tmp_path, volume(attenuationDistance=0.5, attenuationColor=[0.5, 0.5, 0.5]))
    baked = thickness_bake.bake_thickness(result, report)
    image = baked.model.thickness.image
    assert image is not None and baked.baked_uv is not None and baked.mesh is not None
    assert len(baked.baked_uv) == len(baked.mesh.vertices)
    assert 0.6 < baked.model.thickness.factor[0] < 1.0  # of a cube of 1 m, averaged over directions
    (place,) = write_import(str(tmp_path / "out"), [baked], report)
    assert 'technique = "thickness_map"' in (tmp_path / "out" / place.material).read_text(encoding="utf-8")
    assert any(row.became.startswith("the mesh's own, baked") for row in report.rows)
