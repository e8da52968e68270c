"""What a scene's references have, as text: the boundary of the medium, and the lights."""

from __future__ import annotations

from sssgen.lab.chart.record import MediumEntry, SceneEntry


def boundary(medium: MediumEntry) -> str:
    """The surface of a medium of a record."""
    index, roughness = medium.get("ior", 1.0), medium.get("roughness", 0.0)
    if index == 1.0:
        return "matched"
    return f"index {index:g}, {f'roughness {roughness:g}' if roughness else 'smooth'}"


def lights(scene: SceneEntry) -> str:
    """The kinds of lights of a record's scene."""
    return ", ".join(scene.get("lights", ()))


def conditions(scene: SceneEntry) -> str:
    """Both in a line; '' for a scene without a medium."""
    if (medium := scene.get("medium")) is None:
        return ""
    return "; ".join(filter(None, (f"boundary {boundary(medium)}", lights(scene) and f"light {lights(scene)}")))
