"""Unity's materials and diffusion profiles as records."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from sssgen.interchange.diffusion_profile import read_profile, shape
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.surface_model import Image, Quantity, SurfaceModel
from sssgen.interchange.texels import texel_values
from sssgen.scene.pictures.images import write_png

pytest.importorskip("yaml")

from sssgen.interchange import unity_reader

HEAD = "%YAML 1.1\n%TAG !u! tag:unity3d.com,2011:\n"
URP_LIT = "{fileID: 4800000, guid: 933532a4fcc9baf4fa0491de14d08ed7, type: 3}"
HDRP_LIT = "{fileID: 4800000, guid: 6e4ae4064600d784cac1e41a9e6f2e59, type: 3}"
STANDARD = "{fileID: 46, guid: 0000000000000000f000000000000000, type: 0}"
MAP, MASK, PROFILE, PARENT = ("1" * 32, "2" * 32, "a1b2c3d4" + "0" * 24, "4" * 32)
TEXELS = np.array([[[0.0, 0.25, 0.5, 1.0], [1.0, 0.75, 0.25, 0.0]], [[0.5, 0.5, 0.5, 0.5], [0.2, 0.4, 0.6, 0.8]]])


def material(
    shader: str = URP_LIT, floats: str = "", colors: str = "", textures: str = "", keywords: str = "", more: str = ""
) -> str:
    """The text of a .mat file; floats and colours are written as `name value; name value`."""

    def listed(text: str) -> str:
        return "".join(f"    - {entry.strip().replace(' ', ': ', 1)}\n" for entry in text.split(";") if entry.strip())

    maps = "".join(
        f"    - {name}:\n        m_Texture: {{fileID: 2800000, guid: {guid}, type: 3}}\n"
        "        m_Scale: {x: 2, y: 3}\n        m_Offset: {x: 0.25, y: 0.5}\n"
        for name, guid in (entry.split() for entry in textures.split(";") if entry.strip())
    )
    return (
        f"{HEAD}--- !u!21 &2100000\nMaterial:\n  m_Name: sample\n  m_Shader: {shader}\n  m_ShaderKeywords: {keywords}\n"
        f"{more}  m_SavedProperties:\n    m_TexEnvs:\n{maps}"
        f"    m_Floats:\n{listed(floats)}    m_Colors:\n{listed(colors)}"
    )


def profile(values: str = "") -> str:
    """The text of a diffusion profile."""
    lines = "".join(f"    {line.strip()}\n" for line in values.split(";") if line.strip())
    return (
        f"{HEAD}--- !u!114 &11400000\nMonoBehaviour:\n  m_Name: Wax\n  profile:\n"
        "    scatteringDistance: {r: 2, g: 1, b: 0.5, a: 1}\n    transmissionTint: {r: 1, g: 0.5, b: 0.25, a: 1}\n"
        f"    thicknessRemap: {{x: 1, y: 5}}\n    transmissionMode: 0\n    ior: 1.45\n    hash: 1234567890\n{lines}"
    )


def write(path: Path, text: str, guid: str = "") -> Path:
    """Writes a file, and a .meta file with its GUID."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    if guid:
        meta(path, guid)
    return path


def meta(path: Path, guid: str, more: str = "") -> None:
    """Writes the .meta file of a file."""
    path.with_name(f"{path.name}.meta").write_text(f"fileFormatVersion: 2\nguid: {guid}\n{more}", encoding="utf-8")


def project(folder: Path) -> Path:
    """A project with a picture, a mask and a profile; the folder of its materials."""
    for name, guid in (("base", MAP), ("mask", MASK)):
        picture = folder / "Assets" / "Textures" / f"{name}.png"
        picture.parent.mkdir(parents=True, exist_ok=True)
        write_png(picture, TEXELS)
        meta(picture, guid)
    write(folder / "Assets" / "Settings" / "wax.asset", profile(), PROFILE)
    (folder / "Assets" / "Materials").mkdir()
    return folder / "Assets" / "Materials"


def model(folder: Path, text: str) -> SurfaceModel:
    """The record of a material in a project."""
    path = write(project(folder) / "sample.mat", text)
    return unity_reader.read(str(path), Report("sample.mat"))[0].model


def image_of(quantity: Quantity) -> Image:
    """The image of a quantity that has one."""
    assert quantity.image is not None
    return quantity.image


def asset_vector(guid: str) -> str:
    """A GUID as HDRP stores it in a vector."""
    numbers = struct.unpack("<4f", bytes.fromhex(guid))
    return "{" + ", ".join(f"{key}: {number!r}" for key, number in zip("rgba", numbers, strict=True)) + "}"


class TestUniversal:
    def test_constants(self, tmp_path: Path) -> None:
        """Colours are stored encoded; roughness is one minus the smoothness."""
        floats = "_Metallic 0.25; _Smoothness 0.7; _Cull 0; _WorkflowMode 1"
        result = model(tmp_path, material(floats=floats, colors="_BaseColor {r: 0.5, g: 1, b: 0, a: 0.5}"))
        assert result.base_color.factor == pytest.approx((0.2140, 1.0, 0.0), abs=1e-4)
        assert (result.metalness.factor, result.roughness.factor) == ((0.25,), pytest.approx((0.3,)))
        assert result.two_sided and result.alpha_mode == "opaque"

    def test_maps(self, tmp_path: Path) -> None:
        """Metalness is red, smoothness alpha, occlusion green; all have the tiling of the base map."""
        textures = f"_BaseMap {MAP}; _MetallicGlossMap {MASK}; _BumpMap {MASK}; _OcclusionMap {MASK}"
        floats = "_Smoothness 0.5; _Metallic 0.1; _BumpScale 0.8; _OcclusionStrength 0.6"
        result = model(tmp_path, material(floats=floats, textures=textures))
        assert image_of(result.base_color).srgb and not image_of(result.metalness).srgb
        assert image_of(result.base_color).transform.tiling == (2.0, 3.0)
        assert image_of(result.base_color).transform.offset == (0.25, 0.5)
        assert (image_of(result.metalness).channels, result.metalness.factor) == ("r", (1.0,))
        assert texel_values(image_of(result.roughness))[..., 0] == pytest.approx(1 - 0.5 * TEXELS[..., 3], abs=3e-3)
        assert (image_of(result.occlusion).channels, result.occlusion.factor) == ("g", (0.6,))
        assert (result.normal.factor, result.normal_down) == ((0.8,), False)

    def test_smoothness_in_the_base_map(self, tmp_path: Path) -> None:
        floats = "_Smoothness 1; _SmoothnessTextureChannel 1"
        result = model(tmp_path, material(floats=floats, textures=f"_BaseMap {MAP}"))
        assert image_of(result.roughness).picture.name == "base.png" and image_of(result.roughness).channels == "a"

    def test_import_settings(self, tmp_path: Path) -> None:
        """The .meta file says whether colours are decoded, whether they repeat, and whether green is flipped."""
        folder = project(tmp_path)
        settings = "TextureImporter:\n  mipmaps:\n    sRGBTexture: 0\n  flipGreenChannel: 1\n"
        settings += "  textureSettings:\n    wrapU: 1\n"
        meta(tmp_path / "Assets" / "Textures" / "base.png", MAP, settings)
        path = write(folder / "a.mat", material(textures=f"_BaseMap {MAP}; _BumpMap {MAP}"))
        result = unity_reader.read(str(path), Report("a"))[0].model
        assert (image_of(result.base_color).srgb, image_of(result.base_color).wrap) == (False, "clamp")
        assert result.normal_down

    def test_alpha(self, tmp_path: Path) -> None:
        clipped = model(tmp_path / "a", material(floats="_AlphaClip 1; _Cutoff 0.3"))
        assert (clipped.alpha_mode, clipped.alpha_cutoff) == ("mask", 0.3)
        blended = model(tmp_path / "b", material(floats="_Surface 1", colors="_BaseColor {r: 1, g: 1, b: 1, a: 0.5}"))
        assert (blended.alpha_mode, blended.opacity.factor) == ("blend", (0.5,))

    def test_emission_only_with_its_keyword(self, tmp_path: Path) -> None:
        colors = "_EmissionColor {r: 2, g: 0.5, b: 0, a: 1}"
        assert model(tmp_path / "a", material(colors=colors)).emission.is_zero
        glowing = model(tmp_path / "b", material(colors=colors, keywords="_EMISSION"))
        assert glowing.emission.factor == (2.0, 0.5, 0.0), "colours of high dynamic range are linear"

    def test_the_specular_workflow(self, tmp_path: Path) -> None:
        dielectric = material(floats="_WorkflowMode 0", colors="_SpecColor {r: 0.22, g: 0.22, b: 0.22, a: 1}")
        result = model(tmp_path / "a", dielectric)
        assert result.reflectance == pytest.approx(((0.22 + 0.055) / 1.055) ** 2.4, rel=1e-3)
        gold = material(floats="_WorkflowMode 0", colors="_SpecColor {r: 1, g: 0.86, b: 0.57, a: 1}")
        assert model(tmp_path / "b", gold).metalness.factor == (1.0,)

    def test_the_built_in_pipeline(self, tmp_path: Path) -> None:
        text = material(STANDARD, "_Glossiness 0.25; _Metallic 1", "_Color {r: 1, g: 0, b: 0, a: 1}", f"_MainTex {MAP}")
        result = model(tmp_path, text)
        assert (result.roughness.factor, result.metalness.factor) == ((0.75,), (1.0,))
        assert image_of(result.base_color).picture.name == "base.png"

    def test_a_variant_inherits(self, tmp_path: Path) -> None:
        """A material variant has the properties of its parent, but for its own."""
        folder = project(tmp_path)
        write(folder / "parent.mat", material(floats="_Smoothness 0.9; _Metallic 0.5"), PARENT)
        parent = f"  m_Parent: {{fileID: 2100000, guid: {PARENT}, type: 2}}\n"
        path = write(folder / "child.mat", material(floats="_Smoothness 0.2", more=parent))
        result = unity_reader.read(str(path), Report("a"))[0].model
        assert (result.metalness.factor, result.roughness.factor) == ((0.5,), (0.8,))

    def test_a_missing_texture_is_reported(self, tmp_path: Path) -> None:
        path = write(project(tmp_path) / "a.mat", material(textures=f"_BaseMap {'9' * 32}"))
        report = Report("a")
        unity_reader.read(str(path), report)
        (row,) = [row for row in report.rows if row.outcome == "left out"]
        assert row.value == "9" * 32 and row.element == "sample/m_TexEnvs/_BaseMap/m_Texture"


class TestHighDefinition:
    def test_the_mask_map(self, tmp_path: Path) -> None:
        """Metalness, occlusion and smoothness in red, green and alpha, each in its range."""
        floats = "_MetallicRemapMin 0.2; _MetallicRemapMax 0.6; _AORemapMin 0.5; _AORemapMax 1"
        floats += "; _SmoothnessRemapMin 0.1; _SmoothnessRemapMax 0.9"
        result = model(tmp_path, material(HDRP_LIT, floats, textures=f"_MaskMap {MASK}"))
        assert texel_values(image_of(result.metalness))[..., 0] == pytest.approx(0.2 + 0.4 * TEXELS[..., 0], abs=3e-3)
        assert texel_values(image_of(result.occlusion))[..., 0] == pytest.approx(0.5 + 0.5 * TEXELS[..., 1], abs=3e-3)
        assert texel_values(image_of(result.roughness))[..., 0] == pytest.approx(0.9 - 0.8 * TEXELS[..., 3], abs=3e-3)

    @pytest.mark.parametrize("by_hash", [False, True])
    def test_scattering(self, tmp_path: Path, by_hash: bool) -> None:
        """The profile's distance is millimetres: the mean free path over Burley's s of the base colour."""
        stored = struct.unpack("<f", struct.pack("<I", 1234567890))[0]
        floats = "_MaterialID 0; _SubsurfaceMask 0.5; _Thickness 0.25; _TransmissionEnable 1"
        floats += f"; _DiffusionProfileHash {stored if by_hash else 0!r}"
        colors = "_BaseColor {r: 1, g: 1, b: 1, a: 1}"
        if not by_hash:
            colors += f"; _DiffusionProfileAsset {asset_vector(PROFILE)}"
        result = model(tmp_path, material(HDRP_LIT, floats, colors))
        assert result.interior is not None and result.ior == 1.45
        expected = [1.0 / (distance * 1e-3 * shape(1.0)) for distance in (2.0, 1.0, 0.5)]
        assert result.interior.extinction == pytest.approx(expected)
        assert result.subsurface.factor == (0.5,)
        assert result.thickness.factor == pytest.approx((0.002,)), "1 mm and a quarter of the 4 mm to 5 mm"

    def test_a_thin_object(self, tmp_path: Path) -> None:
        """It transmits the base colour times the profile's transmittance, and reflects the base colour."""
        folder = project(tmp_path)
        write(
            tmp_path / "Assets" / "Settings" / "wax.asset",
            profile().replace("transmissionMode: 0", "transmissionMode: 1"),
        )
        colors = f"_BaseColor {{r: 0.5, g: 0.5, b: 0.5, a: 1}}; _DiffusionProfileAsset {asset_vector(PROFILE)}"
        path = write(folder / "a.mat", material(HDRP_LIT, "_MaterialID 5; _Thickness 0", colors))
        result = unity_reader.read(str(path), Report("a"))[0].model
        base, share = 0.2140, result.diffuse_transmission.factor[0]
        distances, tint = np.array([2.0, 1.0, 0.5]), np.array([1.0, 0.5, 0.25])
        transmittance = tint / 4.0 * (np.exp(-1.0 / distances) + 3.0 * np.exp(-1.0 / distances / 3.0))
        assert share * np.array(result.diffuse_transmission_color.factor) == pytest.approx(
            base * transmittance, abs=1e-4
        )
        assert (1.0 - share) * np.array(result.base_color.factor) == pytest.approx((base,) * 3, abs=1e-4)
        assert result.thin_walled and result.interior is None

    def test_refraction(self, tmp_path: Path) -> None:
        """Light fades to the transmittance colour over the absorption distance; the alpha is what does not enter."""
        floats = "_SurfaceType 1; _RefractionModel 2; _Ior 1.3; _ATDistance 0.5; _Thickness 0.2"
        colors = "_BaseColor {r: 1, g: 1, b: 1, a: 0.25}; _TransmittanceColor {r: 1, g: 0.7353569, b: 1, a: 1}"
        result = model(tmp_path, material(HDRP_LIT, floats, colors))
        assert result.interior is not None
        assert result.interior.absorption == pytest.approx((0.0, np.log(2.0) / 0.5, 0.0), abs=1e-3)
        assert (result.transmission.factor, result.ior, result.thickness.factor) == ((0.75,), 1.3, (0.2,))

    def test_a_profile_alone(self, tmp_path: Path) -> None:
        project(tmp_path)
        report = Report("wax")
        (imported,) = unity_reader.read(str(tmp_path / "Assets" / "Settings" / "wax.asset"), report)
        assert imported.model.name == "Wax" and imported.model.interior is not None
        assert report.counts()["approximated"] == 1

    def test_the_multiplier_of_newer_profiles(self, tmp_path: Path) -> None:
        path = write(tmp_path / "a.asset", profile("scatteringDistanceMultiplier: 0.5"))
        assert read_profile(str(path)).distance == pytest.approx((1e-3, 0.5e-3, 0.25e-3))
