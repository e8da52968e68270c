"""How an engine is to import a texture: what the reflection says of a material's, and a bake of its own."""

from __future__ import annotations

from typing import Any


def import_settings(
    dimension: str = "2D", wrap: str = "repeat", srgb: bool = False, mipmaps: bool = True, normal_map: bool = False
) -> dict[str, Any]:
    """As JSON has them: `dimension` is 2D, 3D or Cube, `wrap` repeat or clamp. All of ours are filtered linearly."""
    return {
        "dimension": dimension, "srgb": srgb, "filter": "linear", "wrap": wrap, "mipmaps": mipmaps,
        "normal_map": normal_map,
    }  # fmt: skip
