"""42yeah's scene: the compiled jelly_cubes compared with a reference implementation in float64."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest

import sssgen
from jelly_cubes_by_hand import LEVEL, Array, Scene, image
from sssgen.targets.runtime.numpy_values import precision

WIDTH, HEIGHT = 80, 60
CONSTANTS = 1.0e-5
"""The compiler rounds computed constants, such as 1 / 2.2, to float32, which changes colours by about 1e-6."""


class View(NamedTuple):
    """The values that differ between the pictures."""

    time: float
    aspect: float = 1.0
    look_at: tuple[float, float, float] = (0.65, 0.5, 0.0)


VIEWS = {
    "one cube before the other": View(0.0),
    "side by side": View(1.2, aspect=4.0 / 3.0),
    "with the horizon": View(3.0, aspect=4.0 / 3.0, look_at=(0.65, 1.7, 0.0)),
    "from behind": View(5.1),
}
views = pytest.mark.parametrize("view", VIEWS.values(), ids=VIEWS)


@cache
def by_hand(view: View) -> Scene:
    return image(WIDTH, HEIGHT, *view)


def uniforms(reflection: dict[str, Any], view: View) -> dict[str, Any]:
    """The numbers of each uniform: the value of the view, or the default."""
    values = {uniform["name"]: uniform["default"] for uniform in reflection["uniforms"]}
    return values | {"aspect": [view.aspect], "look_at": list(view.look_at)}


def in_numpy(view: View) -> Array:
    """The picture by the emitted NumPy function, in float64."""
    compiled = sssgen.compile("jelly_cubes", "numpy", "functions")
    functions: dict[str, Any] = {}
    exec(compiled.files["jelly_cubes_functions.py"], functions)
    v, u = (np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5) / np.array([HEIGHT, WIDTH])[:, None, None]
    values = [np.reshape(value, (-1, 1)) for value in uniforms(compiled.reflection, view).values()]
    values = [value if len(value) > 1 else value[0, 0] for value in values]
    with precision(np.float64):
        color = functions["evaluate_color"](np.stack([u.ravel(), v.ravel()]), view.time, *values)
    assert color.dtype == np.float64
    return np.moveaxis(color[:3].reshape(3, HEIGHT, WIDTH), 0, 2)


def in_opengl(view: View, context: Any) -> Array:
    """The picture by the emitted shader in OpenGL, in float32; row 0 is at the bottom."""
    compiled = sssgen.compile("jelly_cubes", "glsl-330")
    vertex, fragment = (compiled.files[f"jelly_cubes.glsl-330.{stage}"] for stage in ("vert", "frag"))
    with context:
        program = context.program(vertex_shader=vertex, fragment_shader=fragment)
        for name, value in {**uniforms(compiled.reflection, view), "time": [view.time]}.items():
            if name in program:  # a driver removes unused uniforms
                program[name].write(np.array(value, np.float32).tobytes())
        frame = context.framebuffer([context.texture((WIDTH, HEIGHT), 4, dtype="f4")])
        frame.use()
        context.vertex_array(program, []).render(vertices=3)
        return np.frombuffer(frame.read(components=3, dtype="f4"), np.float32).reshape(HEIGHT, WIDTH, 3)


def difference(picture: Array, exact: Scene) -> float:
    """The largest difference outside the silhouettes; NaN if the picture has NaN."""
    return float(np.abs(picture - exact.color)[~exact.silhouette].max())


@views
def test_few_pixels_are_silhouettes(view: View) -> None:
    """The excluded share is small: 0.0007 of the pixels at 160 × 120."""
    assert by_hand(view).silhouette.mean() < 0.002


@views
def test_numpy(view: View) -> None:
    assert difference(in_numpy(view), by_hand(view)) <= CONSTANTS


@views
def test_opengl(view: View, compiler: Callable[[str], Any]) -> None:
    assert difference(in_opengl(view, compiler("gl").context), by_hand(view)) <= LEVEL


def test_silhouettes_are_where_rounding_decides() -> None:
    """The only excluded pixel of this view lies on an edge: a neighbour has another colour."""
    picture = by_hand(VIEWS["from behind"])
    ((row, column),) = np.argwhere(picture.silhouette)
    around = picture.color[row - 1 : row + 2, column - 1 : column + 2]
    assert np.abs(around - picture.color[row, column]).max() > 10.0 * LEVEL
