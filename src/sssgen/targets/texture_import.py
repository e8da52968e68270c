"""Import settings for engines: of a material's textures in the reflection, and of baked textures."""

from __future__ import annotations

from typing import Any


def import_settings(
    dimension: str = "2D", wrap: str = "repeat", srgb: bool = False, mipmaps: bool = True, normal_map: bool = False
) -> dict[str, Any]:
    """The settings as JSON: `dimension` is 2D, 3D or Cube, `wrap` repeat or clamp. The filter is always linear."""
    return {
        "dimension": dimension, "srgb": srgb, "filter": "linear", "wrap": wrap, "mipmaps": mipmaps,
        "normal_map": normal_map,
    }  # fmt: skip
