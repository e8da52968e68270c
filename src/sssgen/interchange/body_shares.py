"""The shares of the light that `interior_octaves` and the matte reflection of a body have, by its size.

benchmarks/body_shares.py fits them to path traced balls and bars, and writes the table that is read here.
"""

from __future__ import annotations

import os
import tomllib
from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.material.scatter_color import multiscatter_of_albedo

Array = npt.NDArray[np.float64]

FILE = os.path.join(os.path.dirname(__file__), "body_shares.toml")


class Shares(NamedTuple):
    """How the light in a body is divided between the terms of a material."""

    octaves: tuple[float, ...]
    """The four shares of `interior_octaves`"""
    matte: tuple[float, ...]
    """The reflectance of the Lambert reflection, per channel: a share of the colour that a dense body has"""


def shares_of(sizes: Sequence[float], albedos: Sequence[float]) -> Shares:
    """The shares for a body of isotropic scattering whose mean chord is `sizes` mean free paths, per channel.

    They are those of the mean over the channels, so that the matte reflection has the hue of a dense body. Sizes
    between those of the table are interpolated, those beyond are the nearest.
    """
    table = _table()
    places = np.log(np.maximum(sizes, 1e-9))
    means = [float(np.interp(places, np.log(table[:, 0]), column).mean()) for column in table[:, 1:].T]
    *octaves, matte = means
    return Shares(
        tuple(round(share, 3) for share in octaves), tuple(matte * part for part in multiscatter_of_albedo(albedos))
    )


@cache
def _table() -> Array:
    """(n, 6): the mean chord in mean free paths in rising order, the four octaves, the matte share."""
    with open(FILE, "rb") as file:
        return np.array(tomllib.load(file)["rows"], np.float64)
