"""The four points that stand for an area of light (`shells/towards_area.sss`), against the integral over the area."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sssgen.lang.loader import load_file
from sssgen.material.shell_assembly import SHELLS
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Array

GAUSS = 3.0**-0.5
RULES = {"one point": 0.0, "centres of quarters": 0.5, "Gauss": GAUSS}
"""The spread of the points."""
DISTANCES = (1.0, 2.0, 4.0)
"""From the plane of a square, in sides of it."""
LARGEST = {
    "one point": (0.25, 0.065, 0.017),
    "centres of quarters": (0.042, 0.016, 0.0045),
    "Gauss": (0.016, 0.0012, 0.0001),
}
"""The largest error of all light, by rule and distance."""
BESIDE = [(0.0, 0.0), (0.5, 0.0), (0.7, 0.7), (1.5, 0.3)]
"""Points in front of a square, of the side 1, and beside it."""


@cache
def shell(name: str) -> Any:
    """A function of the shells in NumPy."""
    functions: dict[str, Any] = {}
    files = transpile(load_file(str(Path(SHELLS) / f"{name}.sss"), (SHELLS,)), "numpy", "made").files
    exec(next(text for file, text in files.items() if file.endswith(".py")), functions)
    return functions[name]


def light(x: float, y: float, z: float, spread: float, parts: int = 1) -> float:
    """The light of a square at (x, y, -z), for the radiance 1: four points for each of `parts` x `parts`."""
    steps = (np.arange(parts) + 0.5) / parts - 0.5
    total = 0.0
    for u in steps:
        for v in steps:
            area = np.array([[u - x, v - y, z], [0.5 / parts, 0.0, 0.0], [0.0, 0.5 / parts, 0.0]])
            for index in range(4):
                way = shell("towards_area")(index, spread, area[..., None])
                total += shell("area_light")(area[..., None], way).item()
    return total


@cache
def integral(x: float, y: float, z: float) -> float:
    """The solid angle of the square, from its four corners."""
    corners = [(u - x, v - y) for u in (0.5, -0.5) for v in (0.5, -0.5)]
    angles = [np.arctan2(u * v, z * np.sqrt(u * u + v * v + z * z)) for u, v in corners]
    return float(angles[0] - angles[1] - angles[2] + angles[3])


@pytest.mark.parametrize("rule", RULES)
def test_four_points_have_the_light_of_the_area(rule: str) -> None:
    errors = [max(abs(light(x, y, z, RULES[rule]) / integral(x, y, z) - 1.0) for x, y in BESIDE) for z in DISTANCES]
    print(rule, [f"{error:.3%}" for error in errors])
    for error, largest in zip(errors, LARGEST[rule], strict=True):
        assert 0.5 * largest < error < largest


def test_parts_converge_to_the_integral() -> None:
    assert light(0.2, -0.1, 0.5, GAUSS, parts=8) == pytest.approx(integral(0.2, -0.1, 0.5), rel=1e-4)


def test_light_is_bounded_close_to_the_area_and_negative_behind_it() -> None:
    assert max(light(x, x, 1e-3, GAUSS) for x in np.linspace(-0.5, 0.5, 41)) < 2.0 * np.pi
    assert light(0.0, 0.0, -1.0, GAUSS) == pytest.approx(-light(0.0, 0.0, 1.0, GAUSS))
    assert np.isfinite(light(0.5 * GAUSS, 0.5 * GAUSS, 0.0, GAUSS))


def test_four_points_have_the_light_of_an_ellipse() -> None:
    """On the axis of a disk of the radius 1/2, whose solid angle is known."""
    for z, largest in zip(DISTANCES, (0.013, 0.001, 0.0001), strict=True):
        exact: Array = 2.0 * np.pi * (1.0 - z / np.hypot(z, 0.5))
        assert abs(light(0.0, 0.0, z, 0.5) * np.pi / 4.0 / exact - 1.0) < largest
