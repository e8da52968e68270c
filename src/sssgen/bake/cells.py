"""Voronoi cells as a picture: cracked ice, scales, cobbles.

Steven Worley, A Cellular Texture Basis Function, SIGGRAPH 1996.
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from sssgen.scene.pictures.images import LARGEST_SIDE
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.progress import Progress, silent

Array: TypeAlias = npt.NDArray[np.float64]
Bits: TypeAlias = npt.NDArray[np.uint32]

FEATURES = ("f1", "f2-f1", "faceted")

_BLOCK = 2**15
"""Texels per block: their arrays fit a processor's cache."""


class Pattern(NamedTuple):
    """A picture of Voronoi cells. Distances are in cells, so square cells need as many cells per texel across as up."""

    size: tuple[int, int]
    """Width and height in texels, 1..16384"""
    cells: tuple[int, int]
    """Their numbers across and up, with one site in each; at most the numbers of texels"""
    jitter: float = 1.0
    """0..1, the share of its cell's sides in which a site may lie; near 1 two sites may be so close that their cells
    are low, because F2 - F1 is small everywhere in them"""
    seed: int = 0
    """0..2³² - 1"""
    tileable: bool = True
    """Whether opposite edges match"""
    feature: str = "faceted"
    """f1, the distance to the nearest site; f2-f1, the difference of the distances to the second and the nearest site,
    0 on edges. Both are divided by `scale`, so that no value exceeds 1. faceted: level · smoothstep(0, bevel, F2 - F1)
    with level = 1 - variation · hash(cell), as the technique voronoi_thickness: the same cells with jitter 0.6, seed 0,
    and not tileable."""
    bevel: float = 0.35
    """Above 0, in cells"""
    variation: float = 0.6
    """0..1"""


def voronoi(pattern: Pattern, progress: Progress = silent) -> Array:
    """Voronoi cells as heights 0..1, (height, width), row 0 at the top (v = 1), sampled at the texels' centres.

    The result is the same on every platform: sites come from an integer hash, not from a generator that NumPy may
    change. Raises SssgenError for values out of the pattern's ranges.
    """
    size, cells, jitter, seed, tileable, feature, bevel, variation = pattern
    _check(size, cells, seed, feature)
    for name, value, allowed, limits in (
        ("jitter", jitter, 0.0 <= jitter <= 1.0, "from 0 to 1"),
        ("bevel", bevel, 0.0 < bevel < math.inf, "above 0"),
        ("variation", variation, 0.0 <= variation <= 1.0, "from 0 to 1"),
    ):
        if not allowed:
            raise failure(f"the cells' {name} is {value}", f"a number {limits}")
    width, height = size
    across, up = cells
    picture = np.empty((height, width))
    x = (np.arange(width) + 0.5) * across / width
    rows = max(1, _BLOCK // width)
    for top in range(0, height, rows):
        progress(top, height, "rows of cells")
        y = (height - np.arange(top, min(top + rows, height)) - 0.5) * up / height
        first, second, owner = _nearest(x, y, cells if tileable else None, jitter, seed)
        if feature == "faceted":
            rise = np.clip((second - first) / bevel, 0.0, 1.0)
            block = (1.0 - variation * _unit(owner + np.uint32(3))) * rise * rise * (3.0 - 2.0 * rise)
        else:
            block = (first if feature == "f1" else second - first) / scale(feature, jitter)
        picture[top : top + rows] = block
    progress(height, height, "rows of cells")
    return picture


def scale(feature: str, jitter: float) -> float:
    """The distance, in cells, that a picture stores as 1; 1 for "faceted".

    It is the largest possible value. F1 is largest at a corner of four cells whose sites lie in the opposite corners.
    F2 - F1 is largest in a cell's middle: there the sites of the four adjacent cells are furthest, and F1 may be 0.
    """
    _check_feature(feature)
    largest = {
        "f1": (1.0 + jitter) * math.sqrt(0.5),
        "f2-f1": math.hypot(1.0 + 0.5 * jitter, 0.5 * jitter),
        "faceted": 1.0,
    }
    return largest[feature]


class Nearest(NamedTuple):
    """The nearest sites of points: arrays (rows, columns)."""

    first: Array
    """F1, the distance to the nearest site, in cells"""
    second: Array
    """F2, the distance to the second nearest site"""
    owner: Bits
    """The hash of the nearest site's cell"""


def _nearest(x: Array, y: Array, period: tuple[int, int] | None, jitter: float, seed: int) -> Nearest:
    """The nearest sites of the points of a grid with the coordinates x (columns) and y (rows), in cells.

    The 5 x 5 cells around a point, without the corner cells, contain both sites. By symmetry assume that the point lies
    in its cell [0, 1]² at 1/2 <= y <= x <= 1. Its cell and the cell to the right have a site each, within
    √((2 - x)² + y²) <= √2.5. Sites more than two cells away have a distance of at least 2, and sites in the corner
    cells of at least √((2 - x)² + (2 - y)²), which is not less than √((2 - x)² + y²), because y <= 1.
    """
    home_x, home_y = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    left, low = home_x.min() - 2, home_y.min() - 2
    columns, rows = np.arange(left, home_x.max() + 3), np.arange(low, home_y.max() + 3)
    keys = _keys(columns, rows, period, seed)
    sites_x, sites_y = _sites(keys, columns, rows, jitter)
    first = np.full((len(y), len(x)), np.inf)
    second = first.copy()
    owner = np.zeros(first.shape, np.uint32)
    for j in range(-2, 3):
        for i in range(-2, 3):
            if abs(i) == abs(j) == 2:
                continue
            cell = np.ix_(home_y - low + j, home_x - left + i)
            square = (sites_x[cell] - x) ** 2 + (sites_y[cell] - y[:, None]) ** 2
            owner = np.where(square < first, keys[cell], owner)
            second = np.minimum(second, np.maximum(first, square))
            first = np.minimum(first, square)
    return Nearest(np.sqrt(first), np.sqrt(second), owner)


def _keys(
    columns: npt.NDArray[np.int64], rows: npt.NDArray[np.int64], period: tuple[int, int] | None, seed: int
) -> Bits:
    """A hash of each cell, (rows, columns); the same for cells that are a period apart."""
    if period is not None:
        columns, rows = columns % period[0], rows % period[1]
    of_seed = _hash(np.array([seed], np.uint32))
    of_row = _hash(rows.astype(np.uint32) + of_seed + np.uint32(1))  # negative numbers wrap around
    return _hash(columns.astype(np.uint32) + of_row[:, None])


def _sites(
    keys: Bits, columns: npt.NDArray[np.int64], rows: npt.NDArray[np.int64], jitter: float
) -> tuple[Array, Array]:
    """The positions of the cells' sites, x and y, each (rows, columns)."""
    x = columns + 0.5 + jitter * (_unit(keys + np.uint32(1)) - 0.5)
    y = rows[:, None] + 0.5 + jitter * (_unit(keys + np.uint32(2)) - 0.5)
    return x, y


def _hash(x: Bits) -> Bits:
    """Scrambles bits, as the techniques' common/hash.sss ("lowbias32", Chris Wellons, 2018)."""
    x = (x ^ (x >> np.uint32(16))) * np.uint32(0x7FEB352D)
    x = (x ^ (x >> np.uint32(15))) * np.uint32(0x846CA68B)
    return x ^ (x >> np.uint32(16))


def _unit(x: Bits) -> Array:
    """A number in [0, 1) from 24 bits of the hash."""
    number: Array = (_hash(x) >> np.uint32(8)) / 2.0**24
    return number


def _check(size: tuple[int, int], cells: tuple[int, int], seed: int, feature: str) -> None:
    _check_feature(feature)
    if not all(1 <= side <= LARGEST_SIDE for side in size):
        raise failure(
            f"a picture of {size[0]} x {size[1]} texels cannot be baked", f"1 to {LARGEST_SIDE} along each side"
        )
    if not all(1 <= count <= side for count, side in zip(cells, size, strict=True)):
        hint = "at least 1 cell along each side, and at most as many as texels"
        raise failure(f"{cells[0]} x {cells[1]} cells cannot be baked in {size[0]} x {size[1]} texels", hint)
    if not 0 <= seed < 2**32:
        raise failure(f"the cells' seed is {seed}", "0 to 4294967295")


def _check_feature(feature: str) -> None:
    if feature not in FEATURES:
        raise failure(f"'{feature}' is not a feature of cells", did_you_mean(feature, FEATURES) or ", ".join(FEATURES))
