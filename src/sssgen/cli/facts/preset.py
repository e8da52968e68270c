"""`sssgen show PRESET`: a ready material, its numbers and where they come from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sssgen.cli.layout import wrap
from sssgen.presets import preset as table

names = table.presets
"""The presets."""
_KINDS = {"body": "light is scattered inside", "clear": "light is absorbed inside", "sheet": "a sheet, without inside"}


def describe(name: str) -> dict[str, Any]:
    """Everything about a preset. Raises SssgenError."""
    preset = table.preset(name)
    inside = preset.interior(1.0)
    return {
        "name": name,
        "title": preset.title,
        "summary": preset.doc,
        "inside": "body" if preset.scatters else "sheet" if any(preset.sheet) else "clear",
        "size_mm": preset.size_mm,
        "absorption": list(inside.absorption),
        "reduced_scattering": list(inside.scattering),
        "roughness": preset.roughness,
        "ior": preset.ior,
        "source": preset.source,
    }


def lines(facts: Mapping[str, Any], width: int) -> list[str]:
    """The facts as text."""
    text = [f"{facts['name']} (preset)", "", *wrap(facts["summary"], width, "", "  "), ""]
    text.append(f"inside: {_KINDS[facts['inside']]}")
    if facts["inside"] != "sheet":
        for title, key in (("reduced scattering", "reduced_scattering"), ("absorption", "absorption")):
            text.append(f"{title}: {', '.join(f'{value:.4g}' for value in facts[key])} per mm, red, green, blue")
    text.append(f"refractive index {facts['ior']:g}, roughness {facts['roughness']:g}")
    text.append(f"size: the mesh's longest side is {facts['size_mm']:g} mm, or --size MM")
    return [*text, *wrap(f"source: {facts['source']}", width, "", "  "), f"use: sssgen use {facts['name']} MESH -o DIR"]
