"""Volumes as one picture: a sheet of slices, which engines import as a volume."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from sssgen.scene.pictures.images import LARGEST_SIDE
from sssgen.support.diagnostics import failure


def columns_and_rows(depth: int, height: int, width: int) -> tuple[int, int]:
    """The columns and rows of slices on the sheet that is nearest to a square; columns × rows = depth.

    Raises SssgenError if each such sheet has a side longer than LARGEST_SIDE.
    """
    divisors = (columns for columns in range(1, depth + 1) if depth % columns == 0)
    columns = min(divisors, key=lambda columns: (max(columns * width, depth // columns * height), -columns))
    rows = depth // columns
    if max(columns * width, rows * height) > LARGEST_SIDE:
        raise failure(
            f"{depth} slices of {width} × {height} texels do not fit on a sheet: "
            f"the best has {columns * width} × {rows * height} pixels, and a side may have {LARGEST_SIDE}",
            "choose a number of slices that has more divisors, fewer texels, or another format",
        )
    return columns, rows


def sheet(texels: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """The picture of (depth, height, width) texels, (rows · height, columns · width), its row 0 at the top.

    Slice 0 is at the top left, and slices follow row by row. Within a slice y points up, like v of a picture: its top
    row has the largest y. In an engine whose v points down, like Unreal, sample it at 1 - v.
    """
    depth, height, width = texels.shape
    columns, rows = columns_and_rows(depth, height, width)
    tiles = texels[:, ::-1, :].reshape(rows, columns, height, width)
    return np.swapaxes(tiles, 1, 2).reshape(rows * height, columns * width)
