"""Materials as glTF: Khronos' validator takes them, and an import of an export keeps what was mapped."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gltf_files import box, box_arrays, data_uri, png, write_gltf
from gltf_validation import validate
from sssgen.cli.main import main
from sssgen.interchange.dense_bodies import scatters_inside
from sssgen.interchange.gltf_reader import read
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.material_writer import write_import
from sssgen.interchange.surface_model import SurfaceModel
from sssgen.interchange.texels import mean_of


def extended(name: str = "part", **extensions: dict[str, Any]) -> dict[str, Any]:
    pbr = {"baseColorFactor": [0.8, 0.6, 0.4, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.3}
    listed = {f"KHR_materials_{key}": value for key, value in extensions.items()}
    return {"name": name, "pbrMetallicRoughness": pbr, **({"extensions": listed} if listed else {})}


VOLUME = {"thicknessFactor": 0.5, "attenuationColor": [0.9, 0.5, 0.2], "attenuationDistance": 0.4}
MATERIALS = {
    "plain": extended(),
    "glass": extended(transmission={"transmissionFactor": 0.75}, volume=VOLUME, ior={"ior": 1.3}),
    "pane": extended(transmission={"transmissionFactor": 1.0}),
    "leaf": extended(
        diffuse_transmission={"diffuseTransmissionFactor": 0.6, "diffuseTransmissionColorFactor": [1.0, 0.8, 0.2]}
    ),
    "coat": extended(clearcoat={"clearcoatFactor": 0.7, "clearcoatRoughnessFactor": 0.2}),
    "specular": extended(specular={"specularFactor": 0.4}),
    "dense": extended(ior={"ior": 1.7}),
    "lamp": {**extended(emissive_strength={"emissiveStrength": 4.0}), "emissiveFactor": [1.0, 0.5, 0.25]},
    "unlit": extended(unlit={}),
    "wax": extended(
        transmission={"transmissionFactor": 1.0}, volume=VOLUME, volume_scatter={"multiscatterColor": [0.8, 0.6, 0.3]}
    ),
}
FIELDS = (
    "base_color", "metalness", "roughness", "transmission", "diffuse_transmission", "diffuse_transmission_color",
    "coat", "coat_roughness", "emission", "thickness", "opacity", "occlusion", "normal",
)  # fmt: skip


def imported(path: Path) -> SurfaceModel:
    (material,) = read(str(path), Report(path.name))
    return material.model


def reimported(path: Path, folder: Path, suffix: str) -> tuple[SurfaceModel, Path]:
    """The model of a file that was imported, exported and imported again; and the exported file."""
    report = Report(path.name)
    (written,) = write_import(str(folder / "out"), read(str(path), report), report)
    exported = folder / f"exported{suffix}"
    assert main(["export-gltf", str(folder / "out" / written.material), "-o", str(exported)]) == 0
    return imported(exported), exported


def measured(model: SurfaceModel) -> bool:
    """Whether the length inside the body is measured for each picture, and not a number of the material."""
    enters = not model.transmission.is_zero
    return enters and model.interior is not None and not model.thin_walled and model.thickness.image is None


def assert_equal(first: SurfaceModel, second: SurfaceModel, tolerance: float = 2e-3) -> None:
    inside = scatters_inside(first)
    if inside:  # the matte share stays in the base colour
        assert np.all(np.subtract(mean_of(second.base_color), mean_of(first.base_color)) >= 0.0)
    for field in ("base_color", "opacity") if first.unlit else FIELDS:
        if inside and field in ("base_color", "transmission"):
            continue
        if field == "thickness" and measured(first):
            assert second.thickness.factor[0] > 0.0
            continue
        np.testing.assert_allclose(
            mean_of(getattr(first, field)), mean_of(getattr(second, field)), atol=tolerance, err_msg=field
        )
    assert (first.unlit, first.two_sided, first.alpha_mode) == (second.unlit, second.two_sided, second.alpha_mode)
    assert first.thin_walled == second.thin_walled
    reflected = [model.reflectance * model.specular.factor[0] for model in (first, second)]
    assert reflected[0] == pytest.approx(reflected[1], rel=2e-3)
    if first.interior is not None and not first.thin_walled:
        assert second.interior is not None
        np.testing.assert_allclose(first.interior.extinction, second.interior.extinction, rtol=2e-3)
        np.testing.assert_allclose(first.interior.albedo, second.interior.albedo, atol=2e-3)


@pytest.mark.parametrize("name", MATERIALS)
def test_an_import_of_an_export(name: str, tmp_path: Path) -> None:
    content, data = box(MATERIALS[name])
    path = write_gltf(tmp_path / "box.glb", content, data)
    model, exported = reimported(path, tmp_path, ".glb")
    assert_equal(imported(path), model)
    validate(exported)


def textured() -> tuple[dict[str, Any], bytes]:
    """A box whose material has every texture, with a transform."""
    transform = {"KHR_texture_transform": {"offset": [0.25, 0.5], "rotation": 0.5, "scale": [2.0, 3.0]}}
    info = {index: {"index": index, "extensions": transform} for index in range(6)}
    material = extended(
        "textured",
        transmission={"transmissionFactor": 0.5},
        volume={**VOLUME, "thicknessTexture": info[3]},
        clearcoat={"clearcoatFactor": 1.0, "clearcoatTexture": info[4], "clearcoatRoughnessTexture": info[4]},
    )
    material["pbrMetallicRoughness"] |= {"baseColorTexture": info[0], "metallicRoughnessTexture": info[1]}
    material |= {"normalTexture": {**info[2], "scale": 0.5}, "occlusionTexture": {**info[1], "strength": 0.5}}
    material |= {"emissiveFactor": [1.0, 1.0, 1.0], "emissiveTexture": info[5]}
    colors = [(200, 100, 50), (128, 64, 0), (128, 128, 255), (10, 200, 10), (90, 30, 0), (20, 40, 60)]
    return box(
        material,
        textures=[{"source": index} for index in range(6)],
        images=[{"uri": data_uri(png(color))} for color in colors],
    )


@pytest.mark.parametrize("suffix", [".glb", ".gltf"])
def test_textures_and_their_transform(suffix: str, tmp_path: Path) -> None:
    content, data = textured()
    path = write_gltf(tmp_path / "box.gltf", content, data)
    model, exported = reimported(path, tmp_path, suffix)
    first = imported(path)
    assert_equal(first, model, 0.01)
    assert first.base_color.image is not None and model.base_color.image is not None
    for old, new in zip(first.base_color.image.transform, model.base_color.image.transform, strict=True):
        np.testing.assert_allclose(old, new, atol=1e-4)
    validate(exported)


def test_the_mesh_keeps_its_triangles(tmp_path: Path) -> None:
    content, data = box()
    content["nodes"] = [{"mesh": 0, "scale": [2.0, 2.0, 2.0], "translation": [1.0, 0.0, 0.0]}]
    path = write_gltf(tmp_path / "box.glb", content, data)
    _, exported = reimported(path, tmp_path, ".glb")
    (material,) = read(str(exported), Report("exported"))
    assert material.mesh is not None and material.mesh.uv is not None
    corners, uv, faces = box_arrays()
    assert sorted(map(tuple, (2.0 * corners[faces.reshape(-1)] + (1.0, 0.0, 0.0)).round(5).tolist())) == sorted(
        map(tuple, material.mesh.vertices[material.mesh.faces.reshape(-1)].round(5).tolist())
    )
    assert set(map(tuple, material.mesh.uv.round(5).tolist())) == {(u, 1.0 - v) for u, v in uv.tolist()}


@pytest.mark.parametrize("example", ["paper_lantern", "jade_ring", "soap", "resin_inlay"])
def test_an_example(example: str, tmp_path: Path) -> None:
    exported = tmp_path / f"{example}.gltf"
    assert main(["export-gltf", example, "-o", str(exported)]) == 0
    validate(exported)


def test_another_suffix_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export-gltf", "soap", "-o", str(tmp_path / "soap.obj")]) == 2
    assert "end the name in .glb or .gltf" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
