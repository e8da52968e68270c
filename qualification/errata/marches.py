"""3D Distance Fields: thickness marched through a distance texture."""

from __future__ import annotations

from typing import Any

import numpy as np

from qualification.errata.erratum import Erratum, Figures, Measure, Outputs, about

_FRONT, _BEHIND = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)
_PUBLISHED, _OURS = "distance_field_march", "march_distance_texture"
_FROM_BOX, _FROM_BALL = {"distance_at": "box:box_object"}, {"distance_at": "sphere:sphere_object"}
_FROM_TEXTURE = {"distance_at": "distance_texture"}

_INSIDE = 1e-3
"""How far below its face a slab is asked, so that no tap lies just on a face."""


def _march(slab: float, light: float, steps: int, stored: float, size: float = 2.0) -> float:
    """The article's sum, for the axis through the front face of a slab, by hand.

    `light` is 1 or -1: the light before or behind; `stored` the distance that the texture's 1 stands for; `size` the
    length of a box about the slab's middle.
    """
    start, h, total = 0.5 * slab - _INSIDE, size / steps, 0.0
    for i in range(steps):
        for j in range(steps):
            distance = abs(start - h * i + light * h * j) - 0.5 * slab
            value = min(max(0.5 + 0.5 * distance / stored, 0.0), 1.0)
            total += value / steps if value < 0.5 else 0.0
    return total


def _slab(slab: float, light: Any = _BEHIND, scale: float = 1.0, **more: Any) -> dict[str, Any]:
    """The axis through a wide slab, about the origin."""
    return {
        "P_object": (0.0, 0.0, scale * (0.5 * slab - _INSIDE)),
        "V_object": _FRONT,
        "L_object": light,
        "center": (0.0, 0.0, 0.0),
        "half_size": (5.0 * scale, 5.0 * scale, 0.5 * slab * scale),
        "box_min": (-scale, -scale, -scale),
        "box_max": (scale, scale, scale),
        **more,
    }


def _published(slab: float, steps: int, stored: float, *, scale: float = 1.0, **more: Any) -> dict[str, Any]:
    return _slab(slab, scale=scale, steps=steps, stored_range=stored * scale, **more)


def _ours(slab: float, steps: int, *, scale: float = 1.0, **more: Any) -> dict[str, Any]:
    return _slab(slab, scale=scale, view_steps=steps, light_steps=steps, **more)


def _figure(outputs: Outputs) -> Figures:
    return (float(np.ravel(outputs["result"])[0]),)


_SLABS = (0.21, 0.61, 0.99)
_THICK = 0.99
_LONG: dict[str, Any] = {"box_min": (-1.0, -1.0, -2.0), "box_max": (1.0, 1.0, 2.0)}


def _ball(height: float, **more: Any) -> dict[str, Any]:
    """The axis through a ball in the middle of a box of its own, both `height` above the origin."""
    return {
        "P_object": (0.0, 0.0, height + 0.499),
        "V_object": _FRONT,
        "L_object": _BEHIND,
        "center": (0.0, 0.0, height),
        "radius": 0.5,
        "box_min": (-1.0, -1.0, height - 1.0),
        "box_max": (1.0, 1.0, height + 1.0),
        **more,
    }


def _filled(texel: float) -> dict[str, Any]:
    """A distance texture with the same texel everywhere, seen from the top of its box."""
    return {
        "P_object": (0.0, 0.0, 1.0),
        "V_object": _FRONT,
        "L_object": _BEHIND,
        "distance_map": np.full((2, 2, 2, 1), texel),
    }


_FLAT: dict[str, Any] = {
    "P_object": (0.25, 0.0, 0.0),
    "V_object": _FRONT,
    "L_object": _BEHIND,
    "center": (0.0, 0.0, 0.0),
    "half_size": (0.5, 0.5, 0.0),
    "box_min": (-1.0, -1.0, 0.0),
    "box_max": (1.0, 1.0, 0.0),
}
"""A sheet without any thickness, and the box that just holds it."""

DISTANCE_FIELDS = (
    Erratum(
        "polarity",
        "3D Distance Fields",
        "An empty box and a box of matter. In the text 0 to .5 is outside, so .25 and .75 are stored; the code counts "
        "values below .5. `sssgen`, with its own encoding: metres",
        Measure(_PUBLISHED, (_filled(0.25), _filled(0.75)), bind=_FROM_TEXTURE),
        (0.25 * 8, 0.0),
        Measure(_OURS, (_filled(0.75), _filled(0.25)), bind=_FROM_TEXTURE),
        (about(0.0, 0.0), about(2.0, 1e-5)),
    ),
    Erratum(
        "deep counts least",
        "3D Distance Fields",
        "Slabs of .21, .61 and .99 m, the light in front of them, 32 steps, .1 m stored: a thicker slab has a smaller "
        "sum. `sssgen`: metres",
        Measure(_PUBLISHED, tuple(_published(slab, 32, 0.1, light=_FRONT) for slab in _SLABS), bind=_FROM_BOX),
        tuple(_march(slab, 1.0, 32, 0.1) for slab in _SLABS),
        Measure(_OURS, tuple(_ours(slab, 32, light=_FRONT) for slab in _SLABS), bind=_FROM_BOX),
        tuple(about(slab, 0.01) for slab in _SLABS),
    ),
    Erratum(
        "no length: steps",
        "3D Distance Fields",
        "A slab of .99 m, the light behind it, with 8, 16 and 32 steps. `sssgen`: metres",
        Measure(_PUBLISHED, tuple(_published(_THICK, steps, 1.0) for steps in (8, 16, 32)), bind=_FROM_BOX),
        tuple(_march(_THICK, -1.0, steps, 1.0) for steps in (8, 16, 32)),
        Measure(_OURS, tuple(_ours(_THICK, steps) for steps in (8, 16, 32)), bind=_FROM_BOX),
        (about(_THICK, 0.01),) * 3,
    ),
    Erratum(
        "no length: units",
        "3D Distance Fields",
        "The same slab, and the whole scene twice as large: 16 steps. `sssgen`: metres",
        Measure(_PUBLISHED, tuple(_published(_THICK, 16, 1.0, scale=scale) for scale in (1.0, 2.0)), bind=_FROM_BOX),
        (_march(_THICK, -1.0, 16, 1.0),) * 2,
        Measure(_OURS, tuple(_ours(_THICK, 16, scale=scale) for scale in (1.0, 2.0)), bind=_FROM_BOX),
        (about(_THICK, 0.01), about(2.0 * _THICK, 0.02)),
    ),
    Erratum(
        "a box that is not a cube",
        "3D Distance Fields",
        "The same slab in a box of 2 × 2 × 2 m, and of 2 × 2 × 4 m: 16 steps. `sssgen`: metres",
        Measure(_PUBLISHED, (_published(_THICK, 16, 1.0), _published(_THICK, 16, 1.0, **_LONG)), bind=_FROM_BOX),
        (_march(_THICK, -1.0, 16, 1.0), _march(_THICK, -1.0, 16, 1.0, 4.0)),
        Measure(_OURS, (_ours(_THICK, 16), _ours(_THICK, 16, **_LONG)), bind=_FROM_BOX),
        (about(_THICK, 0.01),) * 2,
    ),
    Erratum(
        "a box above the origin",
        "3D Distance Fields",
        "A ball of 1 m in a box of 2 m around the origin, and both 3 m higher: p + abs(min) is outside of the box, "
        "where nothing is stored. `sssgen`: metres",
        Measure(_PUBLISHED, (_ball(0.0, steps=16), _ball(3.0, steps=16)), bind=_FROM_BALL),
        (_march(1.0, -1.0, 16, 1.0), 0.0),
        Measure(
            _OURS,
            (_ball(0.0, view_steps=16, light_steps=16), _ball(3.0, view_steps=16, light_steps=16)),
            bind=_FROM_BALL,
        ),
        (about(1.0, 0.01),) * 2,
    ),
    Erratum(
        "a flat box",
        "3D Distance Fields",
        "A sheet in a box without height: 0 / 0. There is no matter; it is 0",
        Measure(_PUBLISHED, (_FLAT,), bind=_FROM_BOX),
        (),
        Measure(_OURS, (_FLAT,), bind=_FROM_BOX),
        (about(0.0, 1e-6),),
        everywhere=False,
    ),
)
