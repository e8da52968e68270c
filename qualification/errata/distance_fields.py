"""Cheap SSS and XT95: thinness from a distance field along the normal."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from qualification.errata.erratum import Erratum, Figures, Measure, Outputs, Right, about

_UP = (0.0, 1.0, 0.0)
_FRONT, _BEHIND = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)
_TAPS = [0.4 * i / 30 for i in range(30)]
"""Where 42yeah looks, below the surface."""

_BOX = {"body_distance": "box"}
_GROUND = {"body_distance": "ground_plane"}

_SLABS = (0.0, 0.01, 0.1, 0.4, 0.774)
_SLAB: dict[str, Any] = {
    "P": [(0.0, 0.5 * slab, 0.0) for slab in _SLABS],
    "N": _UP,
    "half_size": [(10.0, 0.5 * slab, 10.0) for slab in _SLABS],
}
_ENDLESS: dict[str, Any] = {"P": (0.0, 0.0, 0.0), "N": _UP}
_NOTHING: dict[str, Any] = {"P": (0.0, 0.0, 0.0), "N": _UP, "half_size": (10.0, 0.0, 10.0)}


def _thinness_of_slab(slab: float) -> float:
    """42yeah's mean: a tap in the first half of the slab adds nothing, one beyond it 2 d - slab."""
    return sum(max(2.0 * d - slab, 0.0) for d in _TAPS) / 30.0


def _face(points: Any) -> dict[str, Any]:
    """Points (x, y) of the front face of a unit cube."""
    return {"P": [(x, y, 0.5) for x, y in points], "N": _FRONT}


_SIDEWAYS = np.array((0.06, 0.04, -1.0)) / math.hypot(0.06, 0.04, 1.0)


def _lit_face(points: Any, light: Any = _SIDEWAYS) -> dict[str, Any]:
    """The same with a light behind the cube."""
    return {"P": _face(points)["P"], "L": light}


_STEP = 0.003
_ACROSS = [(side * 0.35 + offset, 0.35) for side in (-1, 1) for offset in (-_STEP, 0.0, _STEP)]
"""Three points on either side of both diagonals of the face, between two taps of 42yeah."""


def _bends(outputs: Outputs) -> Figures:
    """How much the slope changes where each diagonal is crossed, per unit length."""
    left, middle, right = outputs["result"].reshape(2, 3).T
    return tuple(float(bend) for bend in np.abs(right - 2.0 * middle + left) / _STEP)


_SLOPE = sum(d > 0.15 for d in _TAPS) / 30.0
"""How fast th falls with the distance to the edge, there."""

_CENTRE = [(x, y) for x in np.linspace(-0.11, 0.11, 23) for y in np.linspace(-0.11, 0.11, 23)]


def _largest(outputs: Outputs) -> Figures:
    return (float(outputs["result"].max()),)


def _smallest(outputs: Outputs) -> Figures:
    return (float(outputs["result"].min()),)


_CORNER = math.sqrt(0.5)
_SIDE = (0.5 * _CORNER, 0.02, 0.5 * _CORNER)
"""On the side of 42yeah's cube, in its middle, two centimetres above the floor; the cube reaches as deep below it."""
_CONTACT: dict[str, Any] = {"P": _SIDE, "N": (_CORNER, 0.0, _CORNER)}


def _far(outputs: Outputs) -> Figures:
    """How far from the origin a ray ended that met nothing."""
    with np.errstate(all="ignore"):
        return (float(np.sqrt((outputs["P"].astype(np.float64) ** 2).sum())),)


_MISS: dict[str, Any] = {"ray_origin": (0.0, 2.0, 0.0), "ray_direction": _UP}


_RADIUS = 0.05


def _directions() -> Any:
    """Unit vectors in all directions, (2000, 3)."""
    vectors = np.random.default_rng(1).normal(size=(2000, 3))
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


_OUTWARD = _directions()
_AT_BALL: dict[str, Any] = {"ray_origin": 2.0 * _OUTWARD, "ray_direction": -_OUTWARD, "radius": _RADIUS}


def _turned(outputs: Outputs) -> Figures:
    """By how much, in radians, the normals of a ball are off at most."""
    return (float(np.linalg.norm(np.cross(outputs["N"], _OUTWARD), axis=1).max()),)


def _sine_hash(n: int) -> float:
    return math.sin(n) * 3538.5453 % 1.0


def _xt95_of_nothing() -> float:
    """XT95's thickness where there is no matter: every tap adds 2 l."""
    depths = [6.0 * _sine_hash(n) for n in range(6)]
    return min(max(1.0 - sum(2.0 * x / math.pow(1.0 + x, 1.5) for x in depths) / 6.0, 0.0), 1.0)


def _as_thickness(outputs: Outputs) -> Figures:
    return (1.0 - float(outputs["result"][0]),)


CHEAP_SSS = (
    Erratum(
        "range",
        "Cheap SSS",
        "Thinness of slabs of 0, .01, .1, .4 and .774 m. 1 is no matter",
        Measure("cheap_sss_thinness", (_SLAB,), bind=_BOX),
        tuple(_thinness_of_slab(slab) for slab in _SLABS),
        Measure("thinness_uniform", (_SLAB,), bind=_BOX),
        tuple(about(_thinness_of_slab(slab) / _thinness_of_slab(0.0), 1e-5) for slab in _SLABS),
    ),
    Erratum(
        "nearest face",
        "Cheap SSS",
        "A cube's face, 0 and .2 m from its edge; the cube is 1 m deep at both. `sssgen`: metres towards the light, "
        "from 1 mm and .2 m",
        Measure("cheap_sss_thinness", (_face([(0.5, 0.0), (0.3, 0.0)]),), bind=_BOX),
        (sum(_TAPS) / 30.0, sum(max(d - 0.2, 0.0) for d in _TAPS) / 30.0),
        Measure("march_light", (_lit_face([(0.499, 0.0), (0.3, 0.0)], _BEHIND),), bind=_BOX),
        (about(1.0, 1e-5), about(1.0, 1e-5)),
    ),
    Erratum(
        "the X",
        "Cheap SSS",
        "Change of slope across the two diagonals of a cube's face, per metre",
        Measure("cheap_sss_thinness", (_face(_ACROSS),), _bends, _BOX),
        (_SLOPE, _SLOPE),
        Measure("march_light", (_lit_face(_ACROSS),), _bends, _BOX),
        (about(0.0, 1e-3), about(0.0, 1e-3)),
        tolerance=1e-3,
    ),
    Erratum(
        "the dead centre",
        "Cheap SSS",
        "The maximum in the middle .22 m of a cube's face. `sssgen`: the minimum, in metres of matter towards the "
        "light",
        Measure("cheap_sss_thinness", (_face(_CENTRE),), _largest, _BOX),
        (0.0,),
        Measure("march_light", (_lit_face(_CENTRE),), _smallest, _BOX),
        (about(math.hypot(0.06, 0.04, 1.0), 1e-5),),
    ),
    Erratum(
        "half-space",
        "Cheap SSS, attenuated",
        "Thinness of an infinite body; it is 0",
        Measure("cheap_sss_attenuated", (_ENDLESS,), bind=_GROUND),
        (sum((1.0 - 0.9**i) * d for i, d in enumerate(_TAPS)) / 30.0,),
        Measure("thinness_attenuated", (_ENDLESS,), bind=_GROUND),
        (about(0.0, 1e-6),),
    ),
    Erratum(
        "contrast",
        "Cheap SSS, attenuated",
        "Thinness of no matter; it is 1. Minus that of an infinite body, a sixth of the contrast remains",
        Measure("cheap_sss_attenuated", (_NOTHING,), bind=_BOX),
        (sum((1.0 + 0.9**i) * d for i, d in enumerate(_TAPS)) / 30.0,),
        Measure("thinness_attenuated", (_NOTHING,), bind=_BOX),
        (about(1.0, 1e-5),),
    ),
    Erratum(
        "contact",
        "Cheap SSS",
        "A side of a cube 2 cm above the floor, with floor and cube in one field: as thin as an edge. `sssgen`: "
        "metres of matter straight inwards, with an error of up to half a step",
        Measure("cheap_sss_thinness", (_CONTACT,), bind={"body_distance": "jelly_scene"}),
        (sum(max(d - 0.04, 0.0) for d in _TAPS) / 30.0,),
        Measure(
            "march_light", ({"P": _SIDE, "L": (-_CORNER, 0.0, -_CORNER)},), bind={"body_distance": "jelly_scene"}
        ),
        (about(1.0, 0.03125),),
    ),
    Erratum(
        "no far limit",
        "Cheap SSS",
        "The length of a ray that hits nothing, in metres",
        Measure("cheap_sss_raymarch", (_MISS,), _far, {"scene_distance": "ground_plane"}),
        (math.inf,),
        Measure("raymarch", (_MISS,), _far, {"scene_distance": "ground_plane"}),
        (Right(0.0, 104.0),),
    ),
    Erratum(
        "the sine hash",
        "XT95",
        "Thickness without matter; it is 0. The hash amplifies the rounding errors of each GPU's sine",
        Measure("xt95_thickness", (_NOTHING,), bind=_BOX),
        (_xt95_of_nothing(),),
        Measure("thinness_xt95", (_NOTHING,), _as_thickness, _BOX),
        (about(0.0, 1e-6),),
        everywhere=False,
    ),
)  # fmt: skip

OPEN = (
    Erratum(
        "biased normals",
        "Cheap SSS",
        "The largest error of the normal on a ball of 5 cm, in radians. Cheap SSS uses one-sided differences of 1 mm, "
        "`raymarch` the four corners of a tetrahedron 1 mm along each axis: its error is of the size of the mixed "
        "second derivatives",
        Measure("cheap_sss_raymarch", (_AT_BALL,), _turned, {"scene_distance": "sphere"}),
        (math.sqrt(0.5) * 1e-3 / _RADIUS,),
        Measure("raymarch", (_AT_BALL,), _turned, {"scene_distance": "sphere"}),
        (about(0.0, 1e-3),),
        tolerance=1e-3,
    ),
)
"""What ours does not keep yet."""
