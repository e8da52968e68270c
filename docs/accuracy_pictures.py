"""Draws docs/accuracy/pictures.png: each body by path tracing, and by what is the cheapest for some errors."""

from __future__ import annotations

import io
from collections.abc import Sequence
from textwrap import fill

import numpy as np
from choice_pictures import Choice, ScenePictures
from PIL import Image

from sssgen.lab.chart.drawing import figure as charts
from sssgen.run.backends import Array
from sssgen.scene.pictures.images import encode_srgb
from sssgen.support.extras import need

LIMITS = (0.3, 0.2, 0.1)
"""The errors of the columns."""
CELL, CAPTION = 1.75, 0.48
"""Inches: the side of a picture, and the height of the text below it."""
DPI = 120
BACKGROUND = 0.015
"""Linear light."""
MARGIN = 4
"""Pixels around a body."""
WIDEST = 1400
"""Pixels."""
LETTERS = 34
"""In a line of a caption."""


def drawn(scenes: Sequence[ScenePictures]) -> bytes:
    """The pictures as a PNG: a row for each scene; the reference, and a column for each choice."""
    with charts.settings():
        columns = 1 + len(scenes[0].choices)
        size = (CELL * columns + 0.1, (CELL + CAPTION) * len(scenes))
        figure = need("matplotlib.figure", extra="chart").Figure(figsize=size)
        for row, scene in enumerate(scenes):
            cells = [(scene.reference, "path traced", scene.title)]
            cells += [(choice.picture, choice.title, caption(choice)) for choice in scene.choices]
            inner = frame(scene.reference)
            for column, (picture, title, text) in enumerate(cells):
                top = 1.0 - (row * (CELL + CAPTION) + 0.2) / size[1]
                height, width = (CELL - 0.2) / size[1], (CELL - 0.05) / size[0]
                axes = figure.add_axes(((column * CELL + 0.05) / size[0], top - height, width, height))
                axes.imshow(displayed(picture[inner]), interpolation="nearest")
                axes.axis("off")
                axes.set_title(title, size=7.5, weight="bold", pad=3.0, loc="left")
                axes.text(0.0, -0.03, text, size=5.8, va="top", transform=axes.transAxes, linespacing=1.25)
        png = io.BytesIO()
        figure.savefig(png, format="png", dpi=DPI, metadata={"Software": None})
    return png.getvalue()


def frame(picture: Array) -> tuple[slice, slice]:
    """The square around the body, as large as it is with a margin."""
    rows, columns = np.nonzero(picture.any(axis=2))
    side = min(max(np.ptp(rows), np.ptp(columns)) + 1 + 2 * MARGIN, *picture.shape[:2])

    def part(places: Array, size: int) -> slice:
        start = (int(places.min()) + int(places.max()) + 1 - side) // 2
        start = min(max(start, 0), size - side)
        return slice(start, start + side)

    return part(rows, picture.shape[0]), part(columns, picture.shape[1])


def displayed(picture: Array) -> Array:
    """The picture as sRGB, with pixels outside of the body in a dark grey."""
    outside = (picture == 0.0).all(axis=2, keepdims=True)
    colors: Array = encode_srgb(np.where(outside, BACKGROUND, picture))
    return colors


def caption(choice: Choice) -> str:
    """The chain of a choice with its figures."""
    point = choice.point
    figures = f"cost {point['cost']['value']:.0f} · error {point['error']['value']:.3f} · FLIP {choice.flip:.3f}"
    missed = "" if choice.met else "No chain is so accurate. The best is:\n"
    return f"{missed}{fill(point['label'], LETTERS)}\n{figures}"


def moderate(png: bytes) -> bytes:
    """A chart as a PNG that pages load fast: at most `WIDEST` pixels wide, with a palette of 256 colours."""
    with Image.open(io.BytesIO(png)) as opened:
        picture = opened.convert("RGB")
    if picture.width > WIDEST:
        picture = picture.resize((WIDEST, round(picture.height * WIDEST / picture.width)), Image.Resampling.LANCZOS)
    result = io.BytesIO()
    picture.quantize(256, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE).save(result, format="png", optimize=True)
    return result.getvalue()
