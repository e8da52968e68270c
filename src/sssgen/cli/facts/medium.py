"""`sssgen show MEDIUM`: the measured coefficients of a medium."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sssgen.cli.layout import wrap
from sssgen.scene.measured import media
from sssgen.support.diagnostics import did_you_mean, failure

names = media.media
"""The media that are published."""


def describe(name: str) -> dict[str, Any]:
    """Everything about a medium. Raises SssgenError."""
    known = media.media()
    if name not in known:
        raise failure(f"unknown medium '{name}'", did_you_mean(name, known) or f"media: {', '.join(known)}")
    medium = known[name]
    return {
        "name": name,
        "reduced_scattering": list(medium.reduced_scattering),
        "absorption": list(medium.absorption),
        "ior": medium.ior,
        "measured": medium.measured,
        "source": medium.source,
    }


def lines(facts: Mapping[str, Any], width: int) -> list[str]:
    """The facts as text."""
    text = [f"{facts['name']} (medium)" + ("" if facts["measured"] else ", partly estimated"), ""]
    for title, key in (("reduced scattering", "reduced_scattering"), ("absorption", "absorption")):
        text.append(f"{title}: {', '.join(f'{value:g}' for value in facts[key])} per mm, red, green, blue")
    text.append(f"refractive index: {facts['ior']:g}")
    return [*text, *wrap(f"source: {facts['source']}", width, "", "  ")]
