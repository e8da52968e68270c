"""Textures of a glTF file as images of the neutral record."""

from __future__ import annotations

import math
import os

from sssgen.interchange.gltf_buffers import Buffers
from sssgen.interchange.gltf_json import JsonElement
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.surface_model import Image, Picture, UvTransform, Wrap

_CLAMP, _MIRROR, _REPEAT = 33071, 33648, 10497
_SOURCES = ("EXT_texture_webp", "EXT_texture_avif", "KHR_texture_basisu", "MSFT_texture_dds")
"""Extensions that name another picture for a texture."""
_TRANSFORM = "KHR_texture_transform"


class Textures:
    """The textures of a file; pictures are read when a material needs them."""

    def __init__(self, buffers: Buffers, report: Report) -> None:
        self.buffers, self.report = buffers, report
        root = buffers.root
        self.textures, self.images = root.objects("textures"), root.objects("images")
        self.samplers = root.objects("samplers")
        self._pictures: dict[str, Picture] = {}

    def image(self, info: JsonElement, channels: str, srgb: bool = False) -> Image | None:
        """The image of a textureInfo; None where its format cannot be read. Raises SssgenError for a faulty one."""
        texture = info.reference("index", self.textures, "texture")
        source = self._source(texture)
        if source is None:
            self.report.add_omission(info.path, texture.path, "its only picture has a format that is not read")
            return None
        uv_set = info.whole("texCoord", 0, 0, 31)
        transform = UvTransform()
        if (extension := info.extension(_TRANSFORM)) is not None:
            uv_set = extension.whole("texCoord", uv_set, 0, 31)
            transform = _transform(extension)
            self.report.add_mapping(extension.path, extension.value, "uv_transform")
        if uv_set > 1:
            self.report.add_approximation(f"{info.path}/texCoord", uv_set, "the second set: sssgen reads two")
            uv_set = 1
        return Image(self._picture(source), channels, srgb, uv_set, transform, self._wrap(texture))

    def name(self, info: JsonElement) -> str:
        """The name of the picture of a textureInfo, for the report."""
        texture = info.reference("index", self.textures, "texture")
        source = self._source(texture)
        return texture.path if source is None else _picture_name(source)

    def _source(self, texture: JsonElement) -> JsonElement | None:
        webp = texture.extension(_SOURCES[0])
        if webp is not None:
            return webp.reference("source", self.images, "image")
        if texture.has("source"):
            return texture.reference("source", self.images, "image")
        if any(texture.extension(name) is not None for name in _SOURCES[1:]):
            return None
        raise texture.fault("'source' is missing", "export the file with PNG or JPEG pictures")

    def _picture(self, image: JsonElement) -> Picture:
        if image.path not in self._pictures:
            if image.has("bufferView"):
                content = self.buffers.view(image.reference("bufferView", self.buffers.views, "buffer view"))
            else:
                content = self.buffers.container.resource(image)
            self._pictures[image.path] = Picture(f"{image.file}: {image.path}", content)
        return self._pictures[image.path]

    def _wrap(self, texture: JsonElement) -> Wrap:
        if not texture.has("sampler"):
            return "repeat"
        sampler = texture.reference("sampler", self.samplers, "sampler")
        modes = {key: sampler.whole(key, _REPEAT) for key in ("wrapS", "wrapT")}
        for key, mode in modes.items():
            if mode == _MIRROR:
                self.report.add_approximation(f"{sampler.path}/{key}", "mirrored", "repeated without mirroring")
        if len(set(modes.values())) > 1:
            self.report.add_approximation(sampler.path, "different along u and v", "the same along both")
        return "clamp" if set(modes.values()) == {_CLAMP} else "repeat"


def _picture_name(image: JsonElement) -> str:
    uri = image.text("uri")
    return os.path.basename(uri) if uri and not uri.startswith("data:") else image.text("name") or image.path


def _transform(extension: JsonElement) -> UvTransform:
    """KHR_texture_transform with v up: v' = 1 - v turns its offset and leaves the angle."""
    u, v = extension.vector("offset", (0.0, 0.0))
    rotation = extension.number("rotation", 0.0)
    s, t = extension.vector("scale", (1.0, 1.0))
    sine, cosine = math.sin(rotation), math.cos(rotation)
    return UvTransform((s, t), (u + t * sine, 1.0 - v - t * cosine), math.degrees(rotation))
