"""The formats of images (GLSL 4.60, section 4.4.7)."""

from __future__ import annotations

from typing import NamedTuple


class ImageFormat(NamedTuple):
    """A format of GLSL."""

    kind: str
    """Of the numbers that are loaded: float, int or uint."""
    numbers: int
    """How many a texel has."""
    norm: str = ""
    """unorm or snorm, of integers that stand for 0 to 1 or -1 to 1."""
    webgpu: str = ""
    """Its name in WebGPU; '' where it has none."""


FORMATS: dict[str, ImageFormat] = {
    "rgba32f": ImageFormat("float", 4, "", "rgba32float"),
    "rgba16f": ImageFormat("float", 4, "", "rgba16float"),
    "rg32f": ImageFormat("float", 2, "", "rg32float"),
    "rg16f": ImageFormat("float", 2),
    "r11f_g11f_b10f": ImageFormat("float", 3),
    "r32f": ImageFormat("float", 1, "", "r32float"),
    "r16f": ImageFormat("float", 1),
    "rgba16": ImageFormat("float", 4, "unorm"),
    "rgb10_a2": ImageFormat("float", 4, "unorm"),
    "rgba8": ImageFormat("float", 4, "unorm", "rgba8unorm"),
    "rg16": ImageFormat("float", 2, "unorm"),
    "rg8": ImageFormat("float", 2, "unorm"),
    "r16": ImageFormat("float", 1, "unorm"),
    "r8": ImageFormat("float", 1, "unorm"),
    "rgba16_snorm": ImageFormat("float", 4, "snorm"),
    "rgba8_snorm": ImageFormat("float", 4, "snorm", "rgba8snorm"),
    "rg16_snorm": ImageFormat("float", 2, "snorm"),
    "rg8_snorm": ImageFormat("float", 2, "snorm"),
    "r16_snorm": ImageFormat("float", 1, "snorm"),
    "r8_snorm": ImageFormat("float", 1, "snorm"),
    "rgb10_a2ui": ImageFormat("uint", 4),
}
for _kind, _end, _name in (("int", "i", "sint"), ("uint", "ui", "uint")):
    for _channels in ("rgba", "rg", "r"):
        for _bits in (32, 16, 8):
            _webgpu = _bits == 32 or _channels == "rgba"
            FORMATS[f"{_channels}{_bits}{_end}"] = ImageFormat(
                _kind, len(_channels), "", f"{_channels}{_bits}{_name}" if _webgpu else ""
            )
