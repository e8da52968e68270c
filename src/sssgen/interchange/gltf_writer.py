"""Writes a material as glTF: its parameters as core PBR and Khronos' extensions, with its textures and mesh."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from sssgen.interchange.gltf_parameters import Parameters, Texture
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.mesh_glb import Buffer, document, glb, primitive
from sssgen.interchange.surface_model import Picture
from sssgen.interchange.texels import read_texels
from sssgen.material.model import Material
from sssgen.material.scatter_color import multiscatter_of_albedo
from sssgen.scene.mesh_files import FileContent
from sssgen.scene.pictures import images

_USUAL_REFLECTED, _MOST_REFLECTED = 0.04, 0.08
_LINEAR = 9729, 9987
"""Filters: linear, and linear with linear mipmaps."""


class GltfWriter:
    """The glTF material of a material; `report` gets a row for each element and each stage that is left out."""

    def __init__(self, material: Material, report: Report) -> None:
        self.material, self.report = material.at_level(0), report
        self.parameters = Parameters(self.material)
        self.levels = material.levels
        self.json: dict[str, Any] = {"name": material.title or material.name, "pbrMetallicRoughness": {}}
        self.pictures: dict[str, bytes] = {}
        """Name → PNG file"""
        self.textures: list[dict[str, Any]] = []
        self.used: set[str] = set()
        """Extensions"""

    def write(self) -> dict[str, Any]:
        """The glTF material."""
        if self.levels > 1:
            self.report.add_omission("detail_level", f"{self.levels} levels", "glTF has the level 0 alone")
        self.base()
        self.surface()
        self.reflection()
        if self.material.shading == "unlit":
            self.extension("unlit")
        else:
            self.emission()
            self.volume()
            self.scattering()
        for number, stage in enumerate(self.material.stages):
            inputs = {param.name for param in stage.technique.function.params}
            if "vertex_color" in inputs:
                self.report.add_mapping(stage.technique.name, "a stage", "COLOR_0, where the mesh has colours")
            elif number not in self.parameters.used_stages and inputs:
                self.report.add_omission(stage.technique.name, "a stage", "glTF has nothing for it")
        return self.json

    def set(self, target: dict[str, Any], key: str, value: Any, default: Any, source: str, error: str = "") -> None:
        """Sets a value that is not its default, and reports it."""
        plain = [round(part, 6) for part in value] if isinstance(value, tuple | list) else round(value, 6)
        if plain != default:
            target[key] = plain
        if error:
            self.report.add_approximation(source, value, key, error)
        else:
            self.report.add_mapping(source, value, key)

    def extension(self, name: str) -> dict[str, Any]:
        """An extension of the material, which is added."""
        full = f"KHR_materials_{name}"
        self.used.add(full)
        extensions: dict[str, Any] = self.json.setdefault("extensions", {})
        result: dict[str, Any] = extensions.setdefault(full, {})
        return result

    def base(self) -> None:
        pbr = self.json["pbrMetallicRoughness"]
        tint = self.parameters.value("baseColorFactor", 4) or (1.0, 1.0, 1.0, 1.0)
        texture = self.parameters.texture("baseColorTexture")
        entering = self.parameters.value("transmissionFactor", 3)
        leaving = self.parameters.value("diffuseTransmissionColorFactor", 3) if entering is None else None
        if entering is not None:
            tint, texture = self.transmission(tint, entering, texture)
        elif leaving is not None and self.parameters.value("diffuseTransmissionFactor") is None:
            kept = max(1.0 - max(leaving), 1e-3)
            tint = (*(min(part / kept, 1.0) for part in tint[:3]), tint[3])
        self.set(pbr, "baseColorFactor", tint, [1.0, 1.0, 1.0, 1.0], "base color")
        self.texture(pbr, "baseColorTexture", texture)

    def transmission(
        self, tint: tuple[float, ...], entering: tuple[float, ...], texture: Texture | None
    ) -> tuple[tuple[float, ...], Texture | None]:
        """The base colour is what is reflected and what enters; the share that enters is the transmission."""
        extension = self.extension("transmission")
        second = self.parameters.texture("entering_texture")
        total = [a + b for a, b in zip(tint, entering, strict=False)]
        share = min(max(entering) / max(*total, 1e-9), 1.0)
        if second is not None and texture is not None:
            texture, share = self.unmix(tint, entering, texture, second), 1.0
            total = [1.0, 1.0, 1.0]
            extension["transmissionTexture"] = {"index": len(self.textures) - 1}
        elif second is not None:
            texture = second
        self.set(extension, "transmissionFactor", share, 0.0, "entering color")
        return (*(min(part, 1.0) for part in total), tint[3]), texture

    def unmix(
        self, tint: tuple[float, ...], entering: tuple[float, ...], reflected: Texture, entered: Texture
    ) -> Texture:
        """The texture of the base colour from those of both shares; also adds the texture of the transmission."""
        texels = [read_texels(Picture(texture.file, _png(texture.file))) for texture in (reflected, entered)]
        first = images.decode_srgb(texels[0][..., :3]) * tint[:3]
        second = images.decode_srgb(texels[1][..., :3]) * entering
        if first.shape != second.shape:
            second = np.broadcast_to(second.mean(axis=(0, 1)), first.shape)
        total = np.clip(first + second, 0.0, 1.0)
        share = second.max(axis=-1) / np.maximum(total.max(axis=-1), 1e-6)
        base = np.concatenate([images.encode_srgb(total), texels[0][..., 3:]], axis=-1)
        self.pictures["unmixed_color"] = images.png_bytes(base)
        self.add("transmission", images.png_bytes(share), reflected)
        return reflected._replace(file="unmixed_color")

    def surface(self) -> None:
        parameters, material = self.parameters, self.json
        pbr = material["pbrMetallicRoughness"]
        for key, default in (("metallicFactor", 1.0), ("roughnessFactor", 1.0)):
            if (value := parameters.value(key)) is not None:
                self.set(pbr, key, value[0], default, key)
            else:
                pbr[key] = 0.0 if key == "metallicFactor" else 0.5
        self.texture(
            pbr, "metallicRoughnessTexture", parameters.texture("metallicRoughnessTexture", "packed_surface_texture")
        )
        for key, strength, name in (
            ("normalTexture", "normalScale", "scale"),
            ("occlusionTexture", "occlusionStrength", "strength"),
        ):
            texture = parameters.texture(key) or (
                parameters.texture("packed_surface_texture") if key == "occlusionTexture" else None
            )
            self.texture(material, key, texture)
            if texture is not None and (value := parameters.value(strength)) is not None:
                self.set(material[key], name, value[0], 1.0, strength)
        if self.material.two_sided:
            material["doubleSided"] = True
        if self.material.alpha_mode != "opaque":
            material["alphaMode"] = self.material.alpha_mode.upper()

    def emission(self) -> None:
        color = self.parameters.value("emissiveFactor", 3)
        if color is None:
            return
        (strength,) = self.parameters.value("emissiveStrength") or (1.0,)
        self.set(self.json, "emissiveFactor", color, [0.0, 0.0, 0.0], "emission color")
        if strength != 1.0:
            self.set(self.extension("emissive_strength"), "emissiveStrength", strength, 1.0, "emission strength")
        self.texture(self.json, "emissiveTexture", self.parameters.texture("emissiveTexture"))

    def reflection(self) -> None:
        parameters = self.parameters
        level = parameters.value("dielectric_specular") or parameters.value("specular_strength")
        reflected = _USUAL_REFLECTED if level is None else _MOST_REFLECTED * level[0]
        index = parameters.value("ior")
        if index is None or index[0] <= 1.0:
            root = math.sqrt(reflected)
            index = (1.5,) if reflected <= _USUAL_REFLECTED else ((1.0 + root) / (1.0 - root),)
        if abs(index[0] - 1.5) > 1e-4:
            self.set(self.extension("ior"), "ior", index[0], 1.5, "ior")
        usual = ((index[0] - 1.0) / (index[0] + 1.0)) ** 2
        texture = parameters.texture("specularTexture")
        if abs(reflected - usual) > 1e-4 * usual or texture is not None:
            specular = self.extension("specular")
            share = reflected / usual
            error = f"{usual:.3g} are reflected, not {reflected:.3g}" if share > 1.0 + 1e-6 else ""
            self.set(specular, "specularFactor", min(share, 1.0), 1.0, "specular level", error)
            self.texture(specular, "specularTexture", texture)
        if (weight := parameters.value("clearcoatFactor")) is not None:
            coat = self.extension("clearcoat")
            (roughness,) = parameters.value("clearcoatRoughnessFactor") or (0.0,)
            self.set(coat, "clearcoatFactor", weight[0], 0.0, "coat weight")
            self.set(coat, "clearcoatRoughnessFactor", roughness, 0.0, "coat roughness")
            texture = parameters.texture("clearcoatTexture")
            for key in ("clearcoatTexture", "clearcoatRoughnessTexture"):
                self.texture(coat, key, texture)

    def volume(self) -> None:
        """Absorption: a colour and a distance, or an extinction, and the thickness."""
        parameters = self.parameters
        if (entering := parameters.value("transmissionFactor")) is not None:
            self.set(self.extension("transmission"), "transmissionFactor", entering[0], 0.0, "transmission factor")
        self.diffuse_transmission()
        extinction = parameters.value("extinction", 3)
        color = parameters.value("attenuationColor", 3)
        distance = parameters.value("attenuationDistance")
        thickness = parameters.value("thicknessFactor")
        if distance is not None and color is None:
            color = (math.exp(-1.0),) * 3
        if extinction is not None and any(extinction):
            distance, color = _color_of_extinction(extinction)
        texture = parameters.texture("thicknessTexture")
        if (distance is None or color is None) and (thickness is None or not thickness[0]):
            return
        if "transmission" not in "".join(self.used):  # the volume has an effect only on light that enters
            weight = parameters.value("subsurface_weight") or (1.0,)
            self.set(self.extension("transmission"), "transmissionFactor", weight[0], 0.0, "the light that enters")
        volume = self.extension("volume")
        unknown = thickness is None and texture is None
        if unknown:
            roles = [stage.technique.role for stage in self.material.stages]
            self.parameters.used_stages |= {number for number, role in enumerate(roles) if role == "thickness"}
        depth = 1.0 if thickness is None else thickness[0]
        note = "the program measures it: 1 m stands for it" if unknown else ""
        self.set(volume, "thicknessFactor", depth, 0.0, "thickness", note)
        self.texture(volume, "thicknessTexture", texture, _green_picture)
        if distance is not None and color is not None and any(part < 1.0 for part in color):
            self.set(volume, "attenuationDistance", distance[0], None, "extinction")
            self.set(volume, "attenuationColor", color, [1.0, 1.0, 1.0], "extinction")

    def diffuse_transmission(self) -> None:
        parameters = self.parameters
        color = parameters.value("diffuseTransmissionColorFactor", 3)
        if color is None:
            return
        factor = parameters.value("diffuseTransmissionFactor")
        if factor is None:  # the colour contains it
            largest = max(color)
            factor, color = (largest,), tuple(part / largest if largest else 1.0 for part in color)
        extension = self.extension("diffuse_transmission")
        self.set(extension, "diffuseTransmissionFactor", factor[0], 0.0, "diffuse transmission")
        self.set(extension, "diffuseTransmissionColorFactor", color, [1.0, 1.0, 1.0], "diffuse transmission colour")
        self.texture(
            extension, "diffuseTransmissionColorTexture", parameters.texture("diffuseTransmissionColorTexture")
        )

    def scattering(self) -> None:
        albedo = self.parameters.value("scattering_albedo", 3)
        if albedo is not None and "KHR_materials_volume" in self.used:
            scatter = self.extension("volume_scatter")
            note = "of isotropic scattering; other parameters of the technique have no equal"
            self.set(
                scatter, "multiscatterColor", multiscatter_of_albedo(albedo), [0.0, 0.0, 0.0], "scattering albedo", note
            )

    def texture(
        self, target: dict[str, Any], key: str, texture: Texture | None, change: Callable[[bytes], bytes] | None = None
    ) -> None:
        """Sets a textureInfo, if there is a texture."""
        if texture is None:
            return
        name = os.path.splitext(os.path.basename(texture.file))[0]
        if name not in self.pictures:
            picture = _png(texture.file)
            self.pictures[name] = picture if change is None else change(picture)
        self.add(name, self.pictures[name], texture)
        info: dict[str, Any] = {"index": len(self.textures) - 1}
        if texture.uv == "uv2":
            info["texCoord"] = 1
        if (transform := self.parameters.transforms.get(texture.uv)) is not None:
            self.used.add("KHR_texture_transform")
            info["extensions"] = {"KHR_texture_transform": _flip_transform(transform)}
        target[key] = info
        self.report.add_mapping(key, name, key)

    def add(self, name: str, picture: bytes, texture: Texture) -> None:
        """Appends a texture with a picture."""
        self.pictures[name] = picture
        self.textures.append({"source": [*self.pictures].index(name), "sampler": 0})


def export(material: Material, mesh: FileContent | None, path: str, report: Report) -> dict[str, bytes | str]:
    """The files of a glTF file at `path`, by their names in its folder. Raises SssgenError for a faulty picture."""
    writer = GltfWriter(material, report)
    described = writer.write()
    buffer = Buffer()
    primitives = [] if mesh is None else [{**primitive(mesh, buffer), "material": 0}]
    base, suffix = os.path.splitext(os.path.basename(path))
    inside = suffix.lower() == ".glb"
    files: dict[str, bytes | str] = {}
    listed = []
    for name, picture in writer.pictures.items():
        if inside:
            listed.append({"name": name, "mimeType": "image/png", "bufferView": buffer.view(picture)})
        else:
            files[f"{base}_{name}.png"] = picture
            listed.append({"name": name, "uri": f"{base}_{name}.png"})
    more: dict[str, Any] = {"materials": [described]}
    if listed:
        filters = {"magFilter": _LINEAR[0], "minFilter": _LINEAR[1]}
        more |= {"textures": writer.textures, "images": listed, "samplers": [filters]}
    if writer.used:
        more["extensionsUsed"] = sorted(writer.used)
    content = document(buffer, primitives, **more)
    if inside:
        files[f"{base}{suffix}"] = glb(content, bytes(buffer.data))
        return files
    if buffer.data:
        content["buffers"][0]["uri"] = f"{base}.bin"
        files[f"{base}.bin"] = bytes(buffer.data)
    files[f"{base}{suffix}"] = json.dumps(content, indent=2, allow_nan=False) + "\n"
    return files


def _color_of_extinction(extinction: Sequence[float]) -> tuple[tuple[float], tuple[float, ...]]:
    """A distance, and the colour of white light after it: the mean free path of the channels' mean."""
    distance = 3.0 / sum(extinction)
    return (distance,), tuple(math.exp(-part * distance) for part in extinction)


def _flip_transform(transform: dict[str, tuple[float, ...]]) -> dict[str, Any]:
    """KHR_texture_transform of a transform with v up."""
    (s, t), (u, v) = transform["uv_tiling"], transform["uv_offset"]
    rotation = math.radians(transform["uv_rotation"][0])
    offset = [u - t * math.sin(rotation), 1.0 - v - t * math.cos(rotation)]
    return {"offset": [round(part, 6) for part in offset], "rotation": round(rotation, 6), "scale": [s, t]}


def _png(path: str) -> bytes:
    """A picture file as PNG. Raises SssgenError."""
    if path.lower().endswith(".png"):
        images.read(path)  # reports a missing or faulty file
        with open(path, "rb") as file:
            return file.read()
    return images.png_bytes(images.encode_srgb(images.upright(path)))


def _green_picture(picture: bytes) -> bytes:
    """The red channel in all channels: glTF reads the green one."""
    return images.png_bytes(read_texels(Picture("thickness", picture))[..., :1].repeat(3, axis=-1))
