"""glTF's volume and the depth map of GPU Gems: absorption."""

from __future__ import annotations

import math
from typing import Any

from qualification.errata.erratum import Erratum, Measure, about, flat_result

_CLEAR: dict[str, Any] = {"d": 0.0, "attenuation_color": [(0.0, 0.5, 1.0)]}
_OPAQUE: dict[str, Any] = {**_CLEAR, "attenuation_distance": 0.0}

_BEFORE_THE_MAP: dict[str, Any] = {"P": (0.0, 0.0, 0.9)}
"""A lit point .1 m before what a map of ones says the light meets first."""

ABSORPTION = (
    Erratum(
        "pow(0, 0)",
        "glTF volume",
        "Thickness 0, `attenuation_color` (0, .5, 1): all light is transmitted, 1 in each component. three.js #23448 "
        "renders black",
        Measure("gltf_volume", ({**_CLEAR, "attenuation_distance": 1.0},)),
        (),
        Measure("absorption_tint", ({**_CLEAR, "attenuation_distance": 1.0, "weight": 1.0},)),
        (about(1.0, 0.0),) * 3,
        everywhere=False,
    ),
    Erratum(
        "attenuationDistance 0",
        "glTF volume",
        "The same with an attenuation distance of 0: 0/0. There is no matter: 1 in each component",
        Measure("gltf_volume", (_OPAQUE,)),
        (),
        Measure("absorption_tint", ({**_OPAQUE, "weight": 1.0},)),
        (about(1.0, 0.0),) * 3,
        everywhere=False,
    ),
    Erratum(
        "more light than the lamp has",
        "GPU Gems 16",
        "A lit point .1 m in front of the surface in the coarse depth map, `sigma_t` 5: exp(5 · .1). `sssgen`: a "
        "thickness of 0, and so a transmittance of 1",
        Measure("depth_map_absorption", (_BEFORE_THE_MAP,), flat_result),
        (math.exp(0.5),),
        Measure("depth_map_thickness", (_BEFORE_THE_MAP,), flat_result),
        (about(0.0, 0.0),),
    ),
)
