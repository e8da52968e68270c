"""The presets and the media as lists for menus: names, titles, colours and small pictures, as JSON for a page."""

from __future__ import annotations

import base64
import os
from functools import cache
from typing import Any

from sssgen.material.scatter_color import multiscatter_of_albedo
from sssgen.presets.preset import Color, Preset, presets
from sssgen.presets.qualities import QUALITIES
from sssgen.scene.measured import media

SHEET = os.path.join(os.path.dirname(__file__), "thumbnails.jpg")
"""The small pictures of all presets in one row of squares; docs/preset_pictures.py draws them."""
MENU_QUALITIES = {name: needs for name, needs in QUALITIES.items() if name != "best"}
"""The qualities that need no bake."""


@cache
def preset_list() -> dict[str, Any]:
    """The presets in their order: `sheet`, a picture as a data URL in which the preset with the index i has the ith
    square, and for each of `presets` its name, title, doc, size in millimetres, and linear colour.
    """
    with open(SHEET, "rb") as file:
        sheet = base64.b64encode(file.read()).decode("ascii")
    rows = [
        {"name": one.name, "title": one.title, "doc": one.doc, "size_mm": one.size_mm, "color": [*color_of(one)]}
        for one in presets().values()
    ]
    return {"sheet": f"data:image/jpeg;base64,{sheet}", "presets": rows}


def color_of(preset: Preset) -> Color:
    """The colour of a preset: what a thick body or a sheet of it reflects, or what its clear body lets through."""
    if not preset.scatters:
        return preset.sheet if any(preset.sheet) else preset.clear_color
    red, green, blue = multiscatter_of_albedo(preset.interior(1.0).albedo)
    return red, green, blue


@cache
def media_list() -> list[dict[str, Any]]:
    """The media of the library: name, source, linear colour of a thick body, and mean free path in millimetres."""
    rows = []
    for name, entry in media.media().items():
        medium = media.preset(name)
        color, depth = multiscatter_of_albedo(medium.albedo), medium.mean_free_path
        rows.append({"name": name, "doc": f"{entry.source}.", "color": [*color], "depth_mm": depth})
    return rows
