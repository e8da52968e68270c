"""Pictures of scenes as work items of the gallery: PNG files, and the differences between back ends.

An item names an example of the installation, which every worker has. Workers of a cluster need this folder in their
PYTHONPATH.
"""

from __future__ import annotations

import dataclasses
import functools
import io
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from sssgen.run import backends
from sssgen.run.backends import Backend
from sssgen.run.render.scene_render import render
from sssgen.scene.scene import Scene
from sssgen.scene.scene_loading import load
from sssgen.support.extras import need
from sssgen.support.paths import place

PICTURED = {"ice": "scene_cave.toml", "jade_ring": "scene_bangles.toml"}
"""The scenes of pictures that do not show an example's own scene, which is a plain body for the tests of engines."""

DETAILED = ("ice", "leaves")
"""Pictures so full of detail that 7 bits of a channel are enough, which makes them a sixth smaller."""

_drawing = threading.Lock()
"""The back ends of a worker draw one picture at a time."""


class PictureDifference(NamedTuple):
    """The difference of a back end's picture from the picture by NumPy in float64."""

    worst: float
    """The largest difference of a channel, in 1/255 of the encoded sRGB value."""
    differing: int
    """The number of pixels with a channel that differs by more than 1/255."""


def picture(example: str) -> bytes:
    """The picture of an example as PNG, drawn by OpenGL."""
    with _drawing:
        color = render(pictured(example), _backend("gl")).encoded
    buffer = io.BytesIO()
    steps = 127.0 if example in DETAILED else 255.0
    texels = np.rint(np.rint(steps * color) * 255.0 / steps).astype(np.uint8)
    need("PIL.Image", "pillow").fromarray(texels).save(buffer, "PNG", optimize=True)
    return buffer.getvalue()


def compare_backends(
    example: str, names: Sequence[str], size: tuple[int, int] | None, samples: int | None
) -> list[PictureDifference]:
    """Compares an example's scene on the named back ends with NumPy.

    `size`, in pixels, and `samples`, per pixel, default to the scene's.
    """
    scene = _scene(example)
    scene = dataclasses.replace(scene, size=size or scene.size, samples=samples or scene.samples)
    with _drawing:
        reference = render(scene, _backend("numpy")).encoded
        differences = [255.0 * np.abs(render(scene, _backend(name)).encoded - reference).max(axis=2) for name in names]
    return [PictureDifference(float(image.max()), int((image > 1.0).sum())) for image in differences]


def pictured(example: str) -> Scene:
    """The scene of an example's picture."""
    return _scene(example, PICTURED.get(example, "scene.toml"))


def _scene(example: str, file: str = "scene.toml") -> Scene:
    return load(Path(place("examples"), example, file))


@functools.cache
def _backend(name: str) -> Backend:
    return backends.get(name)
