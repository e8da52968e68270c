"""The properties of a Unity material, with those that it inherits, and the report of what became of each."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import NamedTuple

from sssgen.interchange.imported_material import Element
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.surface_model import Image, Picture, Quantity, UvTransform, Wrap
from sssgen.interchange.texture_files import read_picture
from sssgen.interchange.unity_project import UnityProject
from sssgen.interchange.unity_yaml import Value, objects, read_plain
from sssgen.scene.pictures.images import decode_srgb
from sssgen.support.diagnostics import failure

_MAX_PARENTS = 16
_NO_GUID = "0" * 32
_LISTS = ("m_TexEnvs", "m_Floats", "m_Ints", "m_Colors")
_NORMAL_MAP = 1
"""The `textureType` of a normal map."""


class ImportSettings(NamedTuple):
    """What a texture's .meta file says of it."""

    srgb: bool
    """Whether Unity decodes the colours"""
    wrap: Wrap
    from_height: bool
    """Whether Unity makes a normal map of a height map"""
    flips_green: bool


class UnityMaterial:
    """A material. A property that is used for a field of the record is listed in `elements`."""

    def __init__(self, path: str, body: Value, project: UnityProject, report: Report) -> None:
        """Reads the body of a `Material` and its parents. Raises SssgenError where one is missing or wrong."""
        self.path, self.body, self.project, self.report = path, body, project, report
        self.elements: dict[str, list[Element]] = {}
        self.properties: dict[str, dict[str, Value]] = {name: {} for name in _LISTS}
        self.keywords: set[str] = set()
        self.shader = ("", 0)
        self.name = body.mapping["m_Name"].text if "m_Name" in body.mapping else ""
        self.name = self.name or os.path.splitext(os.path.basename(path))[0]
        for ancestor in reversed(self._ancestry()):
            self._add(ancestor)
        self._pictures: dict[str, Picture] = {}
        self.used: set[str] = set()

    def _ancestry(self) -> list[Value]:
        """The material, its parent, and so on."""
        chain, paths = [self.body], [os.path.realpath(self.path)]
        while (parent := _reference(chain[-1], "m_Parent")) is not None:
            guid = parent.require("guid").text.lower()
            path = self.project.file(guid)
            if not path:
                raise parent.error(f"the parent material with the GUID {guid} is not in the project")
            if os.path.realpath(path) in paths:
                raise parent.error("the material is its own ancestor", "choose another parent in Unity")
            if len(paths) > _MAX_PARENTS:
                raise parent.error(f"the material has more than {_MAX_PARENTS} ancestors")
            bodies = objects(path, "Material")
            if not bodies:
                raise parent.error("the parent is not a material")
            chain.append(bodies[0])
            paths.append(os.path.realpath(path))
        return chain

    def _add(self, body: Value) -> None:
        """Takes over what a material of the ancestry sets."""
        if (shader := _reference(body, "m_Shader", with_file=True)) is not None:
            guid = shader.mapping["guid"].text.lower() if "guid" in shader.mapping else ""
            self.shader = (guid, int(shader.require("fileID").number))
        if "m_ShaderKeywords" in body.mapping:
            self.keywords |= set(body.mapping["m_ShaderKeywords"].text.split())
        if "m_ValidKeywords" in body.mapping:
            self.keywords |= {item.text for item in body.mapping["m_ValidKeywords"].items}
        saved = body.mapping.get("m_SavedProperties")
        for name in _LISTS if saved is not None else ():
            if saved is not None and name in saved.mapping:
                self.properties[name] |= dict(saved.mapping[name].pairs())

    def check_complete(self) -> None:
        """Raises SssgenError for a file that ends early: Unity writes all lists, also those that are empty."""
        saved = self.body.mapping.get("m_SavedProperties", self.body)
        for name in ("m_TexEnvs", "m_Floats", "m_Colors"):
            if saved is self.body or name not in saved.mapping:
                missing = "m_SavedProperties" if saved is self.body else name
                raise saved.error(f"the key '{missing}' is missing: the file is truncated", "copy it again")

    def has(self, name: str) -> bool:
        """Whether the material has a property."""
        return any(name in properties for properties in self.properties.values())

    def number(self, name: str, default: float, field: str = "") -> float:
        """A float or an integer; `field` is that of the record which gets it."""
        value = self._number(name)
        if value is None:
            return default
        self._record(field, value, value.text)
        return value.number

    def vector(self, name: str, default: tuple[float, ...], field: str = "") -> tuple[float, ...]:
        """The four numbers of a colour or a vector, as they are stored."""
        value = self.properties["m_Colors"].get(name)
        if value is None:
            return default
        numbers = value.numbers("rgba")
        self._record(field, value, numbers)
        return numbers

    def color(self, name: str, default: tuple[float, ...], field: str = "", *, hdr: bool = False) -> tuple[float, ...]:
        """A colour as linear sRGB, and its alpha. Unity stores colours encoded, those of high dynamic range linear."""
        red, green, blue, alpha = self.vector(name, default, field)
        if hdr:
            return red, green, blue, alpha
        decoded = decode_srgb([red, green, blue]).tolist()
        return decoded[0], decoded[1], decoded[2], alpha

    def transform(self, name: str) -> UvTransform:
        """The tiling and the offset of a texture's coordinates."""
        value = self.properties["m_TexEnvs"].get(name)
        if value is None:
            return UvTransform()
        scale, offset = (value.require(key).numbers("xy") for key in ("m_Scale", "m_Offset"))
        return UvTransform((scale[0], scale[1]), (offset[0], offset[1]))

    def has_texture(self, name: str) -> bool:
        """Whether a texture is set."""
        return self._texture(name) is not None

    def image(
        self, name: str, channels: str, field: str, transform: UvTransform, *, color: bool = False
    ) -> Image | None:
        """A texture; None, with a row in the report, where its file is not in the project."""
        texture = self._texture(name)
        if texture is None:
            return None
        guid = texture.require("guid").text.lower()
        path = self.project.file(guid)
        if not path:
            if name not in self.used:
                self.report.add_omission(self._report_path(texture), guid, "no file of the project has this GUID")
            self.used.add(name)
            return None
        if path not in self._pictures:
            self._pictures[path] = read_picture(path, texture.span)
        settings = import_settings(f"{path}.meta", color)
        if settings.from_height:
            self.report.add_omission(
                self._report_path(texture), os.path.basename(path), "a height map; bake a normal map of it"
            )
            return None
        self._record(field, texture, os.path.basename(path))
        return Image(self._pictures[path], channels, settings.srgb, 0, transform, settings.wrap)

    def flips_green(self, name: str) -> bool:
        """Whether Unity flips the green channel of a normal map."""
        texture = self._texture(name)
        path = self.project.file(texture.require("guid").text) if texture is not None else ""
        return bool(path) and import_settings(f"{path}.meta", False).flips_green

    def report_omissions(self, reasons: Mapping[str, str]) -> None:
        """Reports textures that are set and numbers that are not 0, and that no field has: name → reason."""
        for name, reason in reasons.items():
            texture, value = self._texture(name), self._number(name)
            if texture is not None:
                path = self.project.file(texture.require("guid").text)
                self.report.add_omission(self._report_path(texture), os.path.basename(path) or "a texture", reason)
            elif value is not None and value.number:
                self.report.add_omission(self._report_path(value), value.number, reason)

    def report_approximation(self, name: str, value: object, became: str, error: str = "") -> None:
        """Reports a property that the record keeps only in part."""
        written = next((group[name] for group in self.properties.values() if name in group), None)
        if written is not None:
            path = self._report_path(written)
            for elements in self.elements.values():
                elements[:] = [element for element in elements if element.path != path]
            self.report.add_approximation(path, value, became, error)

    def _number(self, name: str) -> Value | None:
        return self.properties["m_Floats"].get(name) or self.properties["m_Ints"].get(name)

    def _texture(self, name: str) -> Value | None:
        value = self.properties["m_TexEnvs"].get(name)
        return None if value is None else _reference(value, "m_Texture")

    def _record(self, field: str, value: Value, text: object) -> None:
        if field:
            elements = self.elements.setdefault(field, [])
            path = self._report_path(value)
            if path not in [element.path for element in elements]:
                elements.append(Element(path, text))

    def _report_path(self, value: Value) -> str:
        """The path of a property for the report, without the numbers of list items."""
        parts = [part for part in value.path.split("/") if part and not part.isdigit()]
        return f"{self.name}/{'/'.join(part for part in parts if part not in ('Material', 'm_SavedProperties'))}"


def constant(*numbers: float) -> Quantity:
    """A quantity without a picture."""
    return Quantity(tuple(numbers))


def import_settings(meta: str, color: bool) -> ImportSettings:
    """What a .meta file says of a texture; `color` says whether it is decoded where the file does not say it."""
    importer = read_plain(meta).mapping.get("TextureImporter") if os.path.isfile(meta) else None
    if importer is None:
        return ImportSettings(color, "repeat", False, False)

    def setting(name: str, default: float, group: str = "") -> float:
        part = importer.mapping.get(group) if group else importer
        written = part.mapping.get(name) if part is not None else None
        return default if written is None else written.number

    srgb = bool(setting("sRGBTexture", float(color), "mipmaps")) and setting("textureType", 0.0) != _NORMAL_MAP
    clamped = setting("wrapU", 0.0, "textureSettings") == 1.0
    return ImportSettings(
        srgb,
        "clamp" if clamped else "repeat",
        bool(setting("convertToNormalMap", 0.0, "bumpmap")),
        bool(setting("flipGreenChannel", 0.0)),
    )


def _reference(body: Value, key: str, *, with_file: bool = False) -> Value | None:
    """A reference {fileID: …, guid: …} to another file; None where it is empty."""
    reference = body.mapping.get(key)
    if reference is None or "fileID" not in reference.mapping or not reference.mapping["fileID"].number:
        return None
    guid = reference.mapping.get("guid")
    if guid is None or guid.text in ("", _NO_GUID):
        return reference if with_file else None
    return reference


def material_of(path: str, project: UnityProject, report: Report) -> UnityMaterial:
    """The material of a .mat file. Raises SssgenError where it has none."""
    bodies = objects(path, "Material")
    if not bodies:
        raise failure("the file has no material", "name a .mat file or a diffusion profile (.asset)", path)
    return UnityMaterial(path, bodies[0], project, report)
