"""Draws the loop of the gallery: a scene from the same eye while its first light goes around it once."""

from __future__ import annotations

import dataclasses
import io
import math

import numpy as np
from PIL import Image

from sssgen.run import backends
from sssgen.run.render.scene_render import render
from sssgen.scene import scene_loading
from sssgen.scene.scene import Light

LOOP = "light_around.webp"
SCENE = "jelly"
FRAMES, SIZE, SECONDS = 20, (640, 480), 2.4


def drawn() -> bytes:
    """An animated WebP; the light is from afar and goes around the vertical axis."""
    scene = dataclasses.replace(scene_loading.load(SCENE), size=SIZE, samples=2)
    gl, frames = backends.get("gl"), []
    for number in range(FRAMES):
        lights = (turned(scene.lights[0], 2.0 * math.pi * number / FRAMES), *scene.lights[1:])
        encoded = render(dataclasses.replace(scene, lights=lights), gl).encoded
        frames.append(Image.fromarray(np.rint(255.0 * encoded).astype(np.uint8)))
    file = io.BytesIO()
    duration = round(1000.0 * SECONDS / FRAMES)
    frames[0].save(
        file, "WEBP", save_all=True, append_images=frames[1:], duration=duration, loop=0, quality=82, method=6
    )
    return file.getvalue()


def turned(light: Light, angle: float) -> Light:
    """A light from afar, turned about the vertical axis."""
    assert light.direction is not None
    x, y, z = light.direction
    cosine, sine = math.cos(angle), math.sin(angle)
    return dataclasses.replace(light, direction=(x * cosine + z * sine, y, z * cosine - x * sine))
