"""Several bodies in one picture: the order in which they are drawn, and the picture with its depth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from sssgen.ir.frame_passes import BEHIND
from sssgen.material.model import Material
from sssgen.material.shell_stages import NONE
from sssgen.pipeline.compiler import Compiled
from sssgen.run import backends
from sssgen.run.evaluate.evaluation import evaluate
from sssgen.run.evaluate.probes import subject
from sssgen.run.render.screen_window import Window
from sssgen.run.render.shell_values import Shell
from sssgen.scene.arrays import Array
from sssgen.scene.bounds import world_corners
from sssgen.scene.camera import Camera
from sssgen.scene.scene import Scene

_BAND = 1 << 18
"""The number of colours that are mapped at once."""


class Body(NamedTuple):
    """A body with its shader and the values of it."""

    scene: Scene
    material: Material
    compiled: Compiled
    shell: Shell

    @property
    def corners(self) -> Array:
        """(8, 3): of its box in world space."""
        assert self.scene.geometry is not None
        return world_corners(self.scene.geometry)

    @property
    def shows_behind(self) -> bool:
        """Whether its picture depends on what is behind it."""
        reflection = self.compiled.reflection
        blends = reflection["alpha_mode"] == "blend"
        return blends or any(drawn["name"] == BEHIND for drawn in reflection["passes"])


def in_order(bodies: Sequence[Body], camera: Camera) -> list[Body]:
    """The opaque bodies, then those that show what is behind them, by the depth of their middle, the farthest first."""
    forward = camera.axes()[2]

    def depth(body: Body) -> float:
        return float((body.corners.mean(axis=0) - np.array(camera.position)) @ forward)

    late = sorted((body for body in bodies if body.shows_behind), key=depth, reverse=True)
    return [body for body in bodies if not body.shows_behind] + late


@dataclass
class Canvas:
    """The picture so far, row 0 at the bottom."""

    color: Array
    """(height, width, 3): linear, before tone mapping; at first the backdrop."""
    distance: Array = field(init=False)
    """(height, width): of the opaque surfaces from the eye; inf for none."""
    covered: Array = field(init=False)
    """(height, width): where a body is."""
    mapped: Array = field(init=False)
    """(height, width): where the nearest body is a lit one, whose colours are mapped for the display."""

    def __post_init__(self) -> None:
        self.color = np.array(self.color, np.float64)
        shape = self.color.shape[:2]
        self.distance, self.covered, self.mapped = np.full(shape, np.inf), np.zeros(shape, bool), np.zeros(shape, bool)

    def shows(self, window: Window, distance: Array) -> bool:
        """Whether any part of a surface at these distances is in front of the opaque ones."""
        return bool((distance < window.of(self.distance)).any())

    def draw(self, body: Body, window: Window, color: Array, cover: Array, distance: Array) -> None:
        """Adds a body's colours (height, width, 3) where it covers, and no opaque surface is nearer."""
        cover = np.where(distance < window.of(self.distance), cover, 0.0)
        drawn = cover > 0.0
        shown = np.where(drawn[..., None], color, 0.0)
        behind = window.of(self.color)
        behind[:] = behind * (1.0 - cover[..., None]) + shown * cover[..., None]
        window.of(self.covered)[drawn] = True
        window.of(self.mapped)[drawn] = body.compiled.reflection["shading"] == "lit"
        if not body.shows_behind:
            window.of(self.distance)[drawn] = distance[drawn]

    def tone_mapped(self, shell: Mapping[str, str]) -> Array:
        """The colours after the tone mapping of a shell, where a lit body is."""
        result = self.color.copy()
        if self.mapped.any():
            result[self.mapped] = tone_mapped(self.color[self.mapped], shell)
        return result


def tone_mapped(color: Array, shell: Mapping[str, str]) -> Array:
    """Linear colours (…, 3) after the tone mapping of a shell."""
    name = shell.get("tone_mapping", NONE)
    if name == NONE:
        return color
    technique, oracle = subject(name), backends.require("numpy")
    flat = color.reshape(-1, 3)
    bands = [flat[start : start + _BAND] for start in range(0, len(flat), _BAND)]
    mapped = [evaluate(technique, {"color": band}, oracle)["result"] for band in bands]
    result: Array = np.concatenate(mapped).reshape(color.shape)
    return result
