"""What a file says about the picture of its scene: the camera and the lights."""

from __future__ import annotations

from typing import NamedTuple

from sssgen.scene.camera import Camera
from sssgen.scene.scene import Light


class ImportedView(NamedTuple):
    """The camera and the lights of a file, in metres."""

    camera: Camera | None = None
    """None where the file has none"""
    aspect: float = 4.0 / 3.0
    """The picture's width over its height"""
    lights: tuple[Light, ...] = ()
    """None where the file has none"""
