"""Subsurface Parallax: parallax below the surface."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from qualification.errata.erratum import Erratum, Figures, Measure, Outputs, Right, about

_DEPTH = 0.1
_X, _Y, _Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
_FRAME: dict[str, Any] = {"uv": (0.0, 0.0), "T": _X, "B": _Y, "N": _Z, "depth": _DEPTH}
_ANGLES = (15.0, 30.0, 45.0, 60.0, 75.0, 85.0)
_AIR_TO_GLASS = 1.0 / 1.5
_CRITICAL = math.degrees(math.asin(1.0 / 1.5))
"""Beyond this angle nothing is refracted where the index that Subsurface Parallax asks for is the wrong way round."""


def _view(degrees: Any, turned: float = 0.0) -> Any:
    """Views so many degrees off the normal, in the plane of x and z, turned about z by `turned` degrees."""
    angle, about_z = np.radians(degrees), math.radians(turned)
    return np.stack(
        [np.sin(angle) * math.cos(about_z), np.sin(angle) * math.sin(about_z), np.cos(angle)], axis=-1
    )  # fmt: skip


def _slide(degrees: float, eta: float) -> float:
    """How far a plane below a plane is displaced, over its depth."""
    sine = eta * math.sin(math.radians(degrees))
    return sine / math.sqrt(1.0 - sine * sine)


def _slides(outputs: Outputs) -> Figures:
    """The slide along u, over the depth."""
    return tuple(float(value) for value in -outputs["result"][:, 0] / _DEPTH)


def _both(outputs: Outputs) -> Figures:
    """The slide along u and v, over the depth."""
    return tuple(float(value) for value in np.ravel(-outputs["result"] / _DEPTH))


def _longest(outputs: Outputs) -> Figures:
    return (float(np.hypot(*outputs["result"].T).max() / _DEPTH),)


_SWEEP = np.arange(0.0, 90.0, 0.01)


def _first_bad(outputs: Outputs) -> Figures:
    """The first angle of the sweep that gives no number; 90 where all do."""
    bad = np.flatnonzero(~np.isfinite(outputs["result"]).all(axis=1))
    return (float(_SWEEP[bad[0]]) if len(bad) else 90.0,)


_SKEW = math.radians(60.0)
_SHEARED = (math.cos(_SKEW), math.sin(_SKEW), 0.0)
_SKEWED_VIEW = _view(45.0, 30.0)


def _published_slide(view: Any, tangent: Any, bitangent: Any, eta: float) -> tuple[float, float]:
    """Subsurface Parallax's slide over the depth with the frame by its transpose, whatever the frame."""
    x, y, z = (float(np.dot(axis, view)) for axis in (tangent, bitangent, _Z))
    r_z = -eta * z + (eta * z - math.sqrt(1.0 - eta * eta * (1.0 - z * z)))
    return -eta * x / r_z, -eta * y / r_z


def _true_slide(view: Any, tangent: Any, bitangent: Any, eta: float) -> tuple[float, float]:
    """The displacement of a plane below a plane, in a frame that is not at right angles."""
    across = math.hypot(view[0], view[1])
    length = _slide(math.degrees(math.asin(across)), eta)
    u, v = np.linalg.solve(np.stack([tangent, bitangent], axis=1)[:2], np.array(view[:2]) / across * length)
    return float(u), float(v)


_ODD = {"T": (0.5, 0.0, 0.0), "B": (0.0, 2.0, 0.0)}
"""A frame as long as the texture's steps, as meshes without normalised tangents have it."""
_DIAGONAL = _view(45.0, 45.0)
_NONE = (0.0, 0.0, 0.0)
_HALF = _slide(45.0, _AIR_TO_GLASS) * math.sqrt(0.5)

SUBSURFACE_PARALLAX = (
    Erratum(
        "undefined index: total reflection",
        "Subsurface Parallax",
        "`eta` 1.5, the index of glass: the smallest angle of the view, in degrees, that gives 0/0. 90: none does",
        Measure("subsurface_parallax", ({**_FRAME, "V": _view(_SWEEP), "eta": 1.5},), _first_bad),
        (_CRITICAL,),
        Measure("parallax_refracted", ({**_FRAME, "V": _view(_SWEEP), "ior": 1.0, "outside_ior": 1.5},), _first_bad),
        (about(90.0, 0.0),),
        tolerance=5e-4,
    ),
    Erratum(
        "past the critical angle",
        "Subsurface Parallax",
        "The same at 60°: the offset divided by the depth",
        Measure("subsurface_parallax", ({**_FRAME, "V": _view([60.0]), "eta": 1.5},), _slides),
        (math.nan,),
        Measure("parallax_refracted", ({**_FRAME, "V": _view([60.0]), "ior": 1.0, "outside_ior": 1.5},), _slides),
        (about(0.0, 0.0),),
    ),
    Erratum(
        "undefined index: the wrong direction",
        "Subsurface Parallax",
        "`eta` 1.5 at 15°, 30° and 40°: the offset divided by the depth. `sssgen`, `ior` 1.5: sin θ / √(n² − sin² θ)",
        Measure("subsurface_parallax", ({**_FRAME, "V": _view([15.0, 30.0, 40.0]), "eta": 1.5},), _slides),
        tuple(_slide(angle, 1.5) for angle in (15.0, 30.0, 40.0)),
        Measure("parallax_refracted", ({**_FRAME, "V": _view([15.0, 30.0, 40.0]), "ior": 1.5},), _slides),
        tuple(about(_slide(angle, _AIR_TO_GLASS), 1e-5) for angle in (15.0, 30.0, 40.0)),
        tolerance=1e-3,
    ),
    Erratum(
        "grazing",
        "Subsurface Parallax",
        "The largest offset divided by the depth, without refraction, up to 89.9°. `sssgen`: at most 1.054 / .2",
        Measure("subsurface_parallax", ({**_FRAME, "V": _view(_SWEEP[:8991]), "eta": 1.0},), _longest),
        (math.tan(math.radians(89.9)),),
        Measure("parallax_straight", ({**_FRAME, "V": _view(_SWEEP[:8991])},), _longest),
        (Right(math.tan(math.radians(78.0)), 1.054 / 0.2),),
        tolerance=1e-2,
    ),
    Erratum(
        "depth in texture coordinates",
        "Subsurface Parallax",
        "A mesh whose texture is twice as dense in u and half as dense in v: the offset along both, divided by the "
        "depth, at 45° along the diagonal",
        Measure("subsurface_parallax", ({**_FRAME, "V": [_DIAGONAL], "eta": _AIR_TO_GLASS},), _both),
        (_HALF, _HALF),
        Measure("parallax_refracted", ({**_FRAME, "V": [_DIAGONAL], "ior": 1.5, "uv_per_unit": (2.0, 0.5)},), _both),
        (about(2.0 * _HALF, 1e-5), about(0.5 * _HALF, 1e-5)),
    ),
    Erratum(
        "a sheared frame",
        "Subsurface Parallax",
        "T and B at 60°: the offset along both, divided by the depth, at 45°",
        Measure("subsurface_parallax", ({**_FRAME, "V": [_SKEWED_VIEW], "B": _SHEARED, "eta": _AIR_TO_GLASS},), _both),
        _published_slide(_SKEWED_VIEW, _X, _SHEARED, _AIR_TO_GLASS),
        Measure("parallax_refracted", ({**_FRAME, "V": [_SKEWED_VIEW], "B": _SHEARED, "ior": 1.5},), _both),
        tuple(about(value, 1e-5) for value in _true_slide(_SKEWED_VIEW, _X, _SHEARED, _AIR_TO_GLASS)),
    ),
    Erratum(
        "a scaled frame",
        "Subsurface Parallax",
        "T half as long, B twice as long: the offset along both, divided by the depth, at 45° along the diagonal. It "
        "is a length, as in the unit frame",
        Measure("subsurface_parallax", ({**_FRAME, "V": [_DIAGONAL], **_ODD, "eta": _AIR_TO_GLASS},), _both),
        _published_slide(_DIAGONAL, _ODD["T"], _ODD["B"], _AIR_TO_GLASS),
        Measure("parallax_refracted", ({**_FRAME, "V": [_DIAGONAL], **_ODD, "ior": 1.5},), _both),
        (about(_HALF, 1e-5), about(_HALF, 1e-5)),
    ),
    Erratum(
        "a mirrored frame",
        "Subsurface Parallax",
        "Mirrored texture coordinates, T = −x, at 45° along y; B = cross(N, T), an orthonormal frame: the offset "
        "along v, divided by the depth. `sssgen`: B with the sign in the tangent's w, as its shells compute it",
        Measure(
            "subsurface_parallax",
            ({**_FRAME, "V": [_view(45.0, 90.0)], "T": (-1.0, 0.0, 0.0), "B": (0.0, -1.0, 0.0), "eta": _AIR_TO_GLASS},),
            lambda outputs: _both(outputs)[1:],
        ),
        (-_slide(45.0, _AIR_TO_GLASS),),
        Measure(
            "parallax_refracted",
            ({**_FRAME, "V": [_view(45.0, 90.0)], "T": (-1.0, 0.0, 0.0), "B": (0.0, 1.0, 0.0), "ior": 1.5},),
            lambda outputs: _both(outputs)[1:],
        ),
        (about(_slide(45.0, _AIR_TO_GLASS), 1e-5),),
    ),
    Erratum(
        "no tangent",
        "Subsurface Parallax",
        "A mesh without tangents, T = 0, and a B: the largest offset divided by the depth, at 45° along the diagonal. "
        "`sssgen`: none",
        Measure("subsurface_parallax", ({**_FRAME, "V": [_DIAGONAL], "T": _NONE, "eta": _AIR_TO_GLASS},), _longest),
        (abs(_published_slide(_DIAGONAL, _NONE, _Y, _AIR_TO_GLASS)[1]),),
        Measure("parallax_refracted", ({**_FRAME, "V": [_DIAGONAL], "T": _NONE, "ior": 1.5},), _longest),
        (about(0.0, 0.0),),
    ),
)  # fmt: skip
