"""A glTF material as a neutral record: core PBR and the extensions of translucent matter."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal

from sssgen.interchange.gltf_json import JsonElement
from sssgen.interchange.gltf_textures import Textures
from sssgen.interchange.imported_material import Element, ImportedMaterial
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.surface_model import ONE, Quantity, SurfaceModel, extinction_of_color, medium
from sssgen.material.scatter_color import albedo_of_multiscatter

Channels = Literal["rgb", "r", "g", "b", "a"]

EXTENSIONS = (
    "KHR_materials_unlit",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_emissive_strength",
    "KHR_materials_clearcoat",
    "KHR_materials_sheen",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_volume_scatter",
    "KHR_materials_scatter",
)
"""The extensions of materials that are read."""
_OMISSIONS = {
    "KHR_materials_iridescence": "no technique has thin-film interference",
    "KHR_materials_anisotropy": "highlights are isotropic",
    "KHR_materials_dispersion": "all colours are refracted alike",
    "KHR_materials_pbrSpecularGlossiness": "archived by Khronos: convert the file to metalness and roughness",
    "KHR_materials_variants": "the first material of each primitive is taken",
}
_INFINITE = float("inf")
_LARGEST = 1e6
_MOST_ANISOTROPY = 0.9999


@dataclass
class MaterialReader:
    """Reads one material; `elements` collects where each field of the record comes from."""

    material: JsonElement
    textures: Textures
    report: Report
    scale: float
    """Lengths of mesh space times this are lengths in world space"""
    fields: dict[str, Any] = field(default_factory=dict)
    elements: dict[str, list[Element]] = field(default_factory=dict)

    def extension(self, name: str) -> JsonElement | None:
        """An extension of the material."""
        return self.material.extension(f"KHR_materials_{name}")

    def source(self, name: str, parent: JsonElement, key: str, value: object) -> None:
        """Records that a field comes from an element."""
        self.elements.setdefault(name, []).append(Element(f"{parent.path}/{key}", value))

    def quantity(
        self, name: str, parent: JsonElement, factor_key: str, default: tuple[float, ...], texture_key: str = "",
        channels: Channels = "rgb", srgb: bool = False, high: float = 1.0,
    ) -> Quantity:  # fmt: skip
        """A factor with a texture; it becomes the field `name`."""
        factor: tuple[float, ...]
        if len(default) == 1:
            factor = (parent.number(factor_key, default[0], 0.0, high),) if factor_key else default
        else:
            factor = parent.vector(factor_key, default, 0.0, high)
        if parent.has(factor_key):
            self.source(name, parent, factor_key, factor[0] if len(factor) == 1 else factor)
        image = None
        if texture_key and (info := parent.child(texture_key)) is not None:
            image = self.textures.image(info, channels, srgb)
            if image is not None:
                self.source(name, parent, texture_key, self.textures.name(info))
        self.fields[name] = Quantity(factor, image)
        return Quantity(factor, image)

    def read(self) -> ImportedMaterial:
        """The record of the material. Raises SssgenError."""
        self.surface()
        self.core()
        if self.extension("unlit") is not None:
            self.fields["unlit"] = True
            self.source("unlit", self.material, "extensions/KHR_materials_unlit", "unlit")
        self.reflection()
        self.transmission()
        self.other_extensions()
        return ImportedMaterial(SurfaceModel(**self.fields), self.elements)

    def surface(self) -> None:
        material = self.material
        self.fields["name"] = material.text("name") or f"material {material.path.rpartition('/')[2]}"
        self.fields["two_sided"] = material.flag("doubleSided")
        mode = material.text("alphaMode", "OPAQUE")
        if mode not in ("OPAQUE", "MASK", "BLEND"):
            raise material.require("alphaMode").fault(f"unknown mode '{mode[:20]}'", "OPAQUE, MASK or BLEND")
        self.fields["alpha_mode"] = mode.lower()
        self.fields["alpha_cutoff"] = material.number("alphaCutoff", 0.5, 0.0)
        for key, name in (("doubleSided", "two_sided"), ("alphaMode", "alpha_mode"), ("alphaCutoff", "alpha_cutoff")):
            if material.has(key):
                self.source(name, material, key, material.value[key])

    def core(self) -> None:
        material = self.material
        pbr = material.child("pbrMetallicRoughness") or JsonElement(
            {}, f"{material.path}/pbrMetallicRoughness", material.file
        )
        color = pbr.vector("baseColorFactor", (1.0, 1.0, 1.0, 1.0), 0.0, 1.0)
        base = self.quantity("base_color", pbr, "", (1.0, 1.0, 1.0), "baseColorTexture", "rgb", srgb=True)
        if pbr.has("baseColorFactor"):
            self.source("base_color", pbr, "baseColorFactor", color)
        self.fields["base_color"] = Quantity(color[:3], base.image)
        alpha = None if base.image is None else base.image._replace(channels="a", srgb=False)
        self.fields["opacity"] = Quantity(color[3:], alpha if self.fields["alpha_mode"] != "opaque" else None)
        self.quantity("metalness", pbr, "metallicFactor", (1.0,), "metallicRoughnessTexture", "b")
        self.quantity("roughness", pbr, "roughnessFactor", (1.0,), "metallicRoughnessTexture", "g")
        for name, key, channels, factor in (
            ("normal", "normalTexture", "rgb", "scale"),
            ("occlusion", "occlusionTexture", "r", "strength"),
        ):
            if (info := material.child(key)) is not None and (image := self.textures.image(info, channels)) is not None:
                self.fields[name] = Quantity((info.number(factor, 1.0),), image)
                self.source(name, material, key, self.textures.name(info))
        emission = self.quantity("emission", material, "emissiveFactor", (0.0, 0.0, 0.0), "emissiveTexture", srgb=True)
        if (strength_of := self.extension("emissive_strength")) is not None:
            strength = strength_of.number("emissiveStrength", 1.0, 0.0, 1e5)
            self.fields["emission"] = Quantity(tuple(part * strength for part in emission.factor), emission.image)
            self.source("emission", strength_of, "emissiveStrength", strength)

    def reflection(self) -> None:
        if (ior := self.extension("ior")) is not None:
            index = ior.number("ior", 1.5, 0.0)
            if 0.0 < index < 1.0:
                raise ior.require("ior").fault(f"{index:g} is out of range", "at least 1, or 0")
            self.fields["ior"] = index
            self.source("ior", ior, "ior", index)
        if (specular := self.extension("specular")) is not None:
            self.quantity("specular", specular, "specularFactor", (1.0,), "specularTexture", "a")
            self.quantity(
                "specular_color", specular, "specularColorFactor", (1.0, 1.0, 1.0), "specularColorTexture", srgb=True,
                high=_LARGEST,
            )  # fmt: skip
        if (coat := self.extension("clearcoat")) is not None:
            self.quantity("coat", coat, "clearcoatFactor", (0.0,), "clearcoatTexture", "r")
            self.quantity("coat_roughness", coat, "clearcoatRoughnessFactor", (0.0,), "clearcoatRoughnessTexture", "g")
            if coat.has("clearcoatNormalTexture"):
                path = f"{coat.path}/clearcoatNormalTexture"
                self.report.add_omission(path, "a texture", "the coat has the normal of the surface")

        if (sheen := self.extension("sheen")) is not None:
            self.quantity("sheen_color", sheen, "sheenColorFactor", (0.0, 0.0, 0.0), "sheenColorTexture", srgb=True)
            self.quantity("sheen_roughness", sheen, "sheenRoughnessFactor", (0.0,), "sheenRoughnessTexture", "a")

    def transmission(self) -> None:
        if (transmission := self.extension("transmission")) is not None:
            self.quantity("transmission", transmission, "transmissionFactor", (0.0,), "transmissionTexture", "r")
        if (diffuse := self.extension("diffuse_transmission")) is not None:
            self.quantity(
                "diffuse_transmission", diffuse, "diffuseTransmissionFactor", (0.0,), "diffuseTransmissionTexture", "a"
            )
            self.quantity(
                "diffuse_transmission_color", diffuse, "diffuseTransmissionColorFactor", (1.0, 1.0, 1.0),
                "diffuseTransmissionColorTexture", srgb=True,
            )  # fmt: skip
        volume = self.extension("volume")
        self.fields["thin_walled"] = volume is None or volume.number("thicknessFactor", 0.0, 0.0) == 0.0
        if volume is not None:
            self.volume(volume)
        if (scatter := self.extension("scatter")) is not None and self.fields["thin_walled"]:
            self.thin_scatter(scatter)

    def volume(self, volume: JsonElement) -> None:
        thickness = self.quantity(
            "thickness", volume, "thicknessFactor", (0.0,), "thicknessTexture", "g", high=_LARGEST
        )
        self.fields["thickness"] = Quantity((thickness.factor[0] * self.scale,), thickness.image)
        distance = volume.number("attenuationDistance", _INFINITE, 0.0)
        color = volume.vector("attenuationColor", (1.0, 1.0, 1.0), 0.0, 1.0)
        if volume.has("attenuationDistance") and distance == 0.0:
            raise volume.require("attenuationDistance").fault("0 is out of range", "it is above 0")
        for key, value in (("attenuationDistance", distance), ("attenuationColor", color)):
            if volume.has(key):
                self.source("interior", volume, key, value)
        albedo, anisotropy = self.scattering()
        self.fields["interior"] = medium(extinction_of_color(color, distance), albedo, anisotropy)
        if not any(
            self.fields.get(name, Quantity((0.0,))).factor[0] for name in ("transmission", "diffuse_transmission")
        ):
            for name in ("thickness", "interior"):
                for element in self.elements.pop(name, []):
                    self.report.add_omission(element.path, element.value, "no light enters the body")

    def scattering(self) -> tuple[tuple[float, ...], float]:
        """The single-scattering albedo and the anisotropy of both drafts."""
        draft = self.extension("volume_scatter")
        if draft is not None:
            key = "multiscatterColor" if draft.has("multiscatterColor") else "multiscatterColorFactor"
            color = draft.vector(key, (0.0, 0.0, 0.0), 0.0, 1.0)
            anisotropy = self.anisotropy(draft)
            self.source("interior", draft, key, color)
            return albedo_of_multiscatter(color), anisotropy
        scatter = self.extension("scatter")
        if scatter is None or self.fields["thin_walled"]:
            return (0.0, 0.0, 0.0), 0.0
        strength = scatter.number("scatterStrengthFactor", 0.0, 0.0, 1.0)
        color = scatter.vector("multiscatterColorFactor", (1.0, 1.0, 1.0), 0.0, 1.0)
        anisotropy = self.anisotropy(scatter)
        self.source("interior", scatter, "multiscatterColorFactor", color)
        self.source("interior", scatter, "scatterStrengthFactor", strength)
        for key in ("scatterStrengthTexture", "multiscatterColorTexture"):
            if scatter.has(key):
                self.report.add_omission(f"{scatter.path}/{key}", "a texture", "the medium is the same everywhere")
        return albedo_of_multiscatter(tuple(strength * part for part in color), anisotropy), anisotropy

    def anisotropy(self, draft: JsonElement) -> float:
        value = draft.number("scatterAnisotropy", 0.0, -1.0, 1.0)
        self.source("interior", draft, "scatterAnisotropy", value)
        return min(max(value, -_MOST_ANISOTROPY), _MOST_ANISOTROPY)

    def thin_scatter(self, scatter: JsonElement) -> None:
        """KHR_materials_scatter of a sheet: Lambert lobes on both sides, shared out by the anisotropy."""
        strength = scatter.number("scatterStrengthFactor", 0.0, 0.0, 1.0)
        anisotropy = scatter.number("scatterAnisotropy", 0.0, -1.0, 1.0)
        transmission = self.fields.get("transmission", Quantity((0.0,)))
        scattered = strength * transmission.factor[0]
        self.fields["transmission"] = transmission._replace(factor=((1.0 - strength) * transmission.factor[0],))
        self.quantity(
            "diffuse_transmission_color", scatter, "multiscatterColorFactor", (1.0, 1.0, 1.0),
            "multiscatterColorTexture", srgb=True,
        )  # fmt: skip
        image = transmission.image
        self.fields["diffuse_transmission"] = Quantity((0.5 * (1.0 + anisotropy) * scattered,), image)
        self.source("diffuse_transmission", scatter, "scatterStrengthFactor", strength)
        self.source("diffuse_transmission", scatter, "scatterAnisotropy", anisotropy)
        self.reflected_half(0.5 * (1.0 - anisotropy) * scattered, scattered, scatter)

    def reflected_half(self, reflected: float, scattered: float, scatter: JsonElement) -> None:
        """Adds the light that a sheet scatters back to the base colour."""
        base, color = self.fields["base_color"], self.fields["diffuse_transmission_color"]
        first, second = (self.fields[name].factor[0] for name in ("transmission", "diffuse_transmission"))
        kept = (1.0 - first) * (1.0 - second)
        left = 1.0 - first - scattered
        if base.image is not None or color.image is not None or kept <= 0.0:
            path = f"{scatter.path}/multiscatterColorFactor"
            self.report.add_approximation(path, color.factor, "the half that is scattered back has the base colour")
            return
        mixed = [(left * b + reflected * c) / kept for b, c in zip(base.factor, color.factor, strict=True)]
        self.fields["base_color"] = base._replace(factor=tuple(min(part, 1.0) for part in mixed))

    def other_extensions(self) -> None:
        for extension in self.material.members("extensions"):
            name = extension.path.rpartition("/")[2]
            if name not in EXTENSIONS:
                self.report.add_omission(extension.path, name, _OMISSIONS.get(name, "this extension is not read"))


def default_material(file: str) -> ImportedMaterial:
    """The material of primitives without one (glTF 2.0, section 3.7.2.1)."""
    model = SurfaceModel("default", "The default material of glTF.", metalness=ONE, roughness=ONE)
    return ImportedMaterial(model, {})
