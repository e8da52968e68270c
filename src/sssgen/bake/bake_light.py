"""The light of a bake, directional or at a position, given by a JSON file or three numbers."""

from __future__ import annotations

import math
import os
from typing import Any, NamedTuple

import numpy as np

from sssgen.bake.voxel_grid import Array
from sssgen.scene.light_view import LightView, directional_view, is_before, point_view
from sssgen.support import json_source
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.paths import posix

_FORMS = '{"direction": [x, y, z]} towards a directional light, or {"position": [x, y, z]}, in the mesh\'s space'


class BakeLight(NamedTuple):
    """A light in the mesh's own space."""

    place: Array
    """(3,): the unit direction towards it, or its position"""
    afar: bool
    """Whether it is directional"""

    def towards(self, points: Array) -> Array:
        """Unit directions from points (n, 3) to the light."""
        if self.afar:
            return np.broadcast_to(self.place, points.shape).copy()
        directions = self.place - points
        unit: Array = directions / np.maximum(np.linalg.norm(directions, axis=1, keepdims=True), 1e-300)
        return unit

    def view(self, corners: Array, size: tuple[int, int]) -> LightView:
        """Its view of the box of corners (n, 3); `size`: width, height. Raises SssgenError for a light in it."""
        if self.afar:
            return directional_view(corners, self.place, size)
        if not is_before(corners, self.place):
            raise failure("the light is inside the body or next to it", "use a direction instead: a distant light")
        return point_view(corners, self.place, size)

    def facts(self) -> dict[str, list[float]]:
        """Its entry in a JSON file: its `direction` or its `position`."""
        return {"direction" if self.afar else "position": [float(value) for value in self.place]}


def read_light(text: str) -> BakeLight:
    """The light of a .json file, or of `X,Y,Z`, its direction. Raises SssgenError."""
    if not text.lower().endswith(".json"):
        try:
            return _light([float(part) for part in text.split(",")], True, "")
        except ValueError:
            raise failure(f"'{text}' is not a light", "three numbers, such as 0,1,0, or a .json file") from None
    shown = posix(text)
    if not os.path.isfile(text):
        raise failure("cannot find the light's file", f"write {_FORMS}", shown)
    try:
        with open(text, encoding="utf-8") as file:
            data = json_source.parse(file.read(2**20), shown)
    except (OSError, UnicodeDecodeError) as error:
        raise failure(f"cannot read the light: {error}", f"write {_FORMS}", shown) from None
    if not isinstance(data, dict) or len(data) != 1 or not data.keys() <= {"direction", "position"}:
        unknown = (
            next((key for key in data if key not in ("direction", "position")), "") if isinstance(data, dict) else ""
        )
        hint = did_you_mean(unknown, ("direction", "position")) or f"write {_FORMS}"
        raise failure("the light needs either a direction or a position", hint, shown)
    ((key, value),) = data.items()
    return _light(value, key == "direction", shown)


def _light(value: Any, afar: bool, shown: str) -> BakeLight:
    numbers = value if isinstance(value, list) else []
    valid = len(numbers) == 3 and all(
        isinstance(number, int | float) and not isinstance(number, bool) and math.isfinite(number) and abs(number) < 1e9
        for number in numbers
    )
    if not valid:
        raise failure(f"a light's {'direction' if afar else 'position'} is three numbers", f"write {_FORMS}", shown)
    place = np.array(numbers, float)
    length = float(np.linalg.norm(place))
    if afar and length < 1e-6:
        raise failure("the direction has no length", "give a vector towards the light", shown)
    return BakeLight(place / length if afar else place, afar)
