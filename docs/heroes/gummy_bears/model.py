"""A gummy bear, 1 unit high, and the table it stands on."""

from __future__ import annotations

import numpy as np
from hero_stage.mesh import Mesh
from hero_stage.shapes import Array, capsule, cut, ellipsoid, joined, meshed, noise, sheet


def bear(p: Array) -> Array:
    """The distance to a sitting bear that looks along z; its back is flat, as it was cast in starch."""
    side = np.abs(p[:, :1]) * [1.0, 0.0, 0.0] + p * [0.0, 1.0, 1.0]  # both sides are alike
    belly = ellipsoid(p, (0, 0.31, 0.0), (0.235, 0.3, 0.2))
    head = ellipsoid(p, (0, 0.73, 0.03), (0.2, 0.185, 0.175))
    muzzle = ellipsoid(p, (0, 0.685, 0.185), (0.092, 0.07, 0.075))
    ear = ellipsoid(side, (0.155, 0.895, 0.0), (0.078, 0.078, 0.055))
    arm = capsule(side, (0.2, 0.46, 0.06), (0.125, 0.37, 0.19), 0.078, 0.072)
    leg = capsule(side, (0.175, 0.12, 0.05), (0.185, 0.105, 0.2), 0.11, 0.105)
    body = joined(belly, head, blend=0.12)
    body = joined(body, ear, blend=0.05)
    body = joined(body, muzzle, blend=0.05)
    body = joined(body, arm, leg, blend=0.06)
    body = cut(body, ellipsoid(side, (0.16, 0.9, 0.07), (0.036, 0.038, 0.034)), 0.03)
    body = cut(body, ellipsoid(side, (0.078, 0.765, 0.2), (0.021, 0.024, 0.03)), 0.015)
    body = joined(body, ellipsoid(p, (0, 0.712, 0.255), (0.034, 0.024, 0.022)), blend=0.015)
    body = cut(body, ellipsoid(p, (0, 0.655, 0.26), (0.05, 0.009, 0.03)), 0.012)
    for toe in (-0.045, 0.0, 0.045):
        body = cut(body, ellipsoid(side, (0.185 + toe, 0.135, 0.305), (0.007, 0.045, 0.026)), 0.012)
        body = cut(body, ellipsoid(side, (0.125 + 0.6 * toe, 0.37, 0.26), (0.006, 0.03, 0.02)), 0.01)
    body = cut(body, ellipsoid(p, (0, 0.27, 0.2), (0.016, 0.016, 0.02)), 0.02)
    body = cut(body, p[:, 2] + 0.165, 0.05)
    # the floor flattens it, and the starch left it a little uneven
    body = cut(body, p[:, 1] - 0.004, 0.03)
    return body + 0.0022 * noise(p, 9.0, 2) + 0.0006 * noise(p, 45.0, 2, seed=5)


def meshes(cells: int) -> dict[str, Mesh]:
    return {
        "bear": meshed(bear, (-0.36, -0.04, -0.24), (0.36, 1.04, 0.42), cells).with_colors(floor=0.0),
        "table": sheet(14.0),
    }
