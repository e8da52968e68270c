"""Derivatives: how values change from pixel to pixel."""

from __future__ import annotations

from .table import F1, Builtin

# A table: several fields to a line.
# fmt: off
ROWS = (
    Builtin("dFdx", F1, "Change of x from one pixel to the next, to the right.",
        range="x - x",
        domain="uniform control flow", texts={"hlsl": "ddx", "wgsl": "dpdx"}, kind="derivative",
    ),
    Builtin("dFdy", F1,
        "Change of x from one pixel to the next along framebuffer y: up in OpenGL, down in D3D and WebGPU.",
        range="x - x",
        domain="uniform control flow", texts={"hlsl": "ddy", "wgsl": "dpdy"}, kind="derivative",
    ),
    Builtin("fwidth", F1, "abs(dFdx(x)) + abs(dFdy(x)).",
        range="absolute(x - x) * 2.0",
        domain="uniform control flow", kind="derivative", cost=3,
    ),
)
