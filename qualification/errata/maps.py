"""Pictures of what no scene can show, since a scene's picture must be finite: a technique over two inputs.

NaN and infinity are magenta.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from qualification.errata.erratum import subject_of
from sssgen.material import library
from sssgen.run.backends import Array, Backend
from sssgen.run.evaluate.evaluation import evaluate
from sssgen.scene.camera import Camera
from sssgen.scene.geometry import Ball
from sssgen.scene.pictures.images import encode_srgb

NO_NUMBER = (1.0, 0.0, 1.0)
SIZE = (320, 240)
"""Width and height of a picture in pixels."""

_SAMPLES = 3
"""Samples along each side of a pixel."""

_BEHIND = 0.03
_WAX, _DIM = np.array((0.75, 0.4, 0.2)), 0.04
_WOOD, _DARK, _BRASS = (0.19, 0.075, 0.03), (0.11, 0.04, 0.015), (0.8, 0.5, 0.13)


def ball(technique: str, power: float, backend: Backend) -> Array:
    """A ball of wax with the light at its right, a little behind: (240, 320, 3), encoded, row 0 on top."""
    camera = Camera((0.0, 0.0, 4.2), (0.0, 0.0, 0.0), 32.0)
    origin, rays = camera.rays(SIZE[0] * _SAMPLES, SIZE[1] * _SAMPLES)
    hits = Ball().hits(origin, rays)
    light = np.array((0.9, 0.25, -0.35))
    inputs: dict[str, Any] = {"V": -rays[hits.hit], "N": hits.normal[hits.hit], "L": light / np.linalg.norm(light)}
    lobe = _result_of(technique, inputs | _lobe(technique, power) | {"distortion": 0.5}, backend)
    color = np.full((len(rays), 3), _BEHIND)
    color[hits.hit] = _WAX * (lobe + _DIM)
    return _picture(color)


def half_vector(technique: str, distortion: float, backend: Backend) -> Array:
    """A lobe for lights about the one straight behind, which is in the middle: (240, 320, 3), encoded, row 0 on top.

    The picture is .1 wide in the light's direction, 8 pixels a light; the eye is at 45 degrees to the right.
    """
    wide, high = 39, 29
    x, y = np.meshgrid(np.arange(wide) - wide // 2, np.arange(high) - high // 2)
    across = 0.1 / wide * np.stack([x, -y], axis=-1).reshape(-1, 2)
    down = -np.sqrt(1.0 - (across**2).sum(axis=1))
    inputs: dict[str, Any] = {"V": (math.sqrt(0.5), 0.0, math.sqrt(0.5)), "N": (0.0, 0.0, 1.0)}
    inputs |= {"L": np.column_stack([across, down]), "distortion": distortion}
    lobe = _result_of(technique, inputs | _lobe(technique, 2.0), backend).astype(np.float64).reshape(high, wide, 3)
    large = _colored(lobe).repeat(8, axis=0).repeat(8, axis=1)
    return np.pad(large, ((4, 4), (4, 4), (0, 0)), mode="edge")


def _lobe(technique: str, power: float) -> dict[str, float]:
    """The power and nothing in the way, by the names of Alisavakis and by ours."""
    if technique == "alisavakis_lobe":
        return {"concentration": power, "scale": 1.0, "d": 0.0}
    return {"power": power, "scale": 1.0, "ambient": 0.0, "through": 1.0}


def floor(technique: str, index: dict[str, float], backend: Backend) -> Array:
    """A floor with an inlay .3 below it: (240, 320, 3), encoded, row 0 on top."""
    camera = Camera((0.0, 1.0, 0.0), (0.0, 0.2, -1.0), 50.0)
    origin, rays = camera.rays(SIZE[0] * _SAMPLES, SIZE[1] * _SAMPLES)
    points = origin - rays * (origin[1] / rays[:, 1])[:, None]
    frame = {"T": (1.0, 0.0, 0.0), "B": (0.0, 0.0, -1.0), "N": (0.0, 1.0, 0.0)}
    inputs = {**frame, **index, "uv": np.stack([points[:, 0], -points[:, 2]], axis=1), "V": -rays, "depth": 0.3}
    return _picture(_inlay(_result_of(technique, inputs, backend)))


def mirrored(technique: str, signed: bool, index: dict[str, float], backend: Backend) -> Array:
    """A panel whose left half has the right one's texture, mirrored; an inlay .3 below it: (240, 320, 3), encoded.

    `signed`: whether the frame's B has the handedness that a tangent's w keeps; else it is cross(N, T).
    """
    camera = Camera((0.0, -2.6, 3.0), (0.0, 0.0, 0.0), 40.0)
    origin, rays = camera.rays(SIZE[0] * _SAMPLES, SIZE[1] * _SAMPLES)
    points = origin - rays * (origin[2] / rays[:, 2])[:, None]
    hand = np.where(points[:, 0] < 0.0, -1.0, 1.0)
    zero = np.zeros_like(hand)
    tangent = np.column_stack([hand, zero, zero])
    bitangent = np.column_stack([zero, np.ones_like(hand) if signed else hand, zero])
    inputs = {"T": tangent, "B": bitangent, "N": (0.0, 0.0, 1.0), **index, "depth": 0.3}
    inputs |= {"uv": np.column_stack([np.abs(points[:, 0]), points[:, 1]]), "V": -rays}
    return _picture(_inlay(_result_of(technique, inputs, backend)))


def _result_of(technique: str, inputs: dict[str, Any], backend: Backend) -> Array:
    """The result of a technique: of a published one without our guards."""
    published = bool(library.load(technique).attributes.superseded_by)
    return evaluate(subject_of(technique), inputs, backend, "none" if published else "auto")["result"]


def _inlay(uv: Array) -> Array:
    """Brass rings about whole numbers, in dark and light wood: linear colours, (n, 3)."""
    with np.errstate(invalid="ignore"):
        off = np.hypot(*(uv - np.round(uv)).T)
        dark = (np.floor(uv).sum(axis=1) % 2 == 0)[:, None]
    ring = ((off > 0.22) & (off < 0.36))[:, None]
    color = np.where(ring, _BRASS, np.where(dark, _DARK, _WOOD))
    return np.where(np.isfinite(uv).all(axis=1, keepdims=True), color, np.nan)


def _picture(samples: Array) -> Array:
    """Samples, row by row from the bottom, averaged to pixels."""
    width, height = SIZE
    pixels = samples.reshape(height, _SAMPLES, width, _SAMPLES, 3).mean(axis=(1, 3))
    return _colored(pixels[::-1])


def _colored(linear: Array) -> Array:
    """Linear light as encoded colours; NaN and infinity are magenta."""
    finite = np.isfinite(linear).all(axis=-1, keepdims=True)
    return np.where(finite, encode_srgb(np.nan_to_num(linear)), NO_NUMBER)
