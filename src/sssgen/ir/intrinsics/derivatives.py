"""Derivatives: how values change from pixel to pixel."""

from __future__ import annotations

from sssgen.ir.intervals import absolute
from sssgen.ir.intrinsics.table import F1, Builtin

_VARIANTS = {"Fine": "for each pair of pixels", "Coarse": "possibly one for each quad of pixels"}

# A table: several fields to a line.
# fmt: off
ROWS = (
    Builtin("dFdx", F1, "Change of x from one pixel to the next, to the right.",
        es=300, axis="x", range=lambda F, x: x - x,
        uniform_flow=True, texts={"hlsl": "ddx", "wgsl": "dpdx", "wgsl-metal": "dfdx"}, kind="derivative",
    ),
    Builtin("dFdy", F1,
        "Change of x from one pixel to the next along framebuffer y: up in OpenGL, down in D3D and WebGPU.",
        es=300, axis="y", range=lambda F, x: x - x,
        uniform_flow=True, texts={"hlsl": "ddy", "wgsl": "dpdy", "wgsl-metal": "dfdy"}, kind="derivative",
    ),
    Builtin("fwidth", F1, "abs(dFdx(x)) + abs(dFdy(x)).",
        es=300, range=lambda F, x: absolute(x - x) * 2.0, uniform_flow=True, kind="derivative", cost=3,
    ),
    *(
        Builtin(f"dFd{axis}{variant}", F1, f"dFd{axis}, {how}; in languages without this choice, dFd{axis}.",
            range=lambda F, x: x - x, uniform_flow=True, axis=axis, kind="derivative",
            texts={"glsl": f"dFd{axis}", "tsl": f"dFd{axis}", "hlsl": f"dd{axis}_{variant.lower()}", "hlsl-dx9": f"dd{axis}", "wgsl": f"dpd{axis}{variant}",
                "wgsl-metal": f"dfd{axis}"},
        )
        for axis in "xy" for variant, how in _VARIANTS.items()
    ),
    *(
        Builtin(f"fwidth{variant}", F1, f"abs(dFdx{variant}(x)) + abs(dFdy{variant}(x)).",
            range=lambda F, x: absolute(x - x) * 2.0, uniform_flow=True, kind="derivative", cost=3,
            texts={"glsl": "fwidth", "tsl": "fwidth", "hlsl": "", "hlsl-dx9": "fwidth", "wgsl-metal": "fwidth"},
            polyfill=f"genF fwidth{variant}(genF x) {{ return abs(dFdx{variant}(x)) + abs(dFdy{variant}(x)); }}",
        )
        for variant in _VARIANTS
    ),
)
