"""Alisavakis and Unity ice, GDC 2011 and the three.js port: back-light lobes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from qualification.errata.erratum import Erratum, Figures, Measure, Outputs, Right, about

_FRONT, _BEHIND, _SIDE = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0)

_COUNT = 100_000


def _white(outputs: Outputs) -> Figures:
    """The lobe of each lane: all of these are white."""
    return tuple(float(value) for value in outputs["result"][:, 0])


def _largest(outputs: Outputs) -> Figures:
    return (float(outputs["result"].max()),)


def _unit(vectors: Any) -> Any:
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


def _spread() -> dict[str, Any]:
    """Random normals, lights and distortions; the eye stands where the lobe is meant to peak."""
    random = np.random.default_rng(3)
    normal, light = (_unit(random.normal(size=(_COUNT, 3))) for _ in range(2))
    distortion = random.uniform(0.0, 0.99, _COUNT)
    return {"N": normal, "L": light, "V": -_unit(light + normal * distortion[:, None]), "distortion": distortion}


_LOBE: dict[str, Any] = {"through": 1.0, "power": 4.0, "scale": 1.0, "ambient": 0.0, "attenuation": 1.0}
_SPREAD = _spread() | _LOBE
_NO_EYE = {name: value for name, value in _SPREAD.items() if name != "V"}

_LIGHTS: dict[str, Any] = {"N": _FRONT, "L": [_FRONT, _SIDE, _BEHIND], "distortion": 0.2}
_ICE: dict[str, Any] = {"through": 0.8, "power": 4.0, "scale": 2.0, "ambient": 0.1, "attenuation": 0.5}

_BACK_LIT: dict[str, Any] = {"V": _FRONT, "N": _FRONT, "L": _BEHIND}
"""The light just behind the surface, the eye just before it."""
_NO_LOBE: dict[str, Any] = {"V": _SIDE, "N": _FRONT, "L": _FRONT}
"""The eye at a right angle to the light."""
_TILTED = math.sqrt(0.5)
_BESIDE = 1e-3
_ZERO_HALF: dict[str, Any] = {
    "V": (_TILTED, 0.0, _TILTED),
    "N": _FRONT,
    "L": [(x, 0.0, -math.sqrt(1.0 - x * x)) for x in (_BESIDE, 0.0, -_BESIDE)],
    "distortion": 1.0,
}
"""The light a little to one side; just behind, so that L + N is no direction; to the other. The eye at 45 degrees."""
_JUST_BEHIND: dict[str, Any] = {**_ZERO_HALF, "L": _BEHIND}

ALISAVAKIS = (
    Erratum(
        "pow(0, 0)",
        "Alisavakis",
        "The default `concentration`, 0, `scale` 1, the eye outside of the lobe. x^0 is 1 for every x > 0; at 0 the "
        "languages differ. `sssgen`, with the smallest `power`, 1: no light",
        Measure("alisavakis_lobe", ({**_NO_LOBE, "d": 0.0, "scale": 1.0},), _white),
        (),
        Measure("lobe_normalized", ({**_NO_LOBE, **_LOBE, "power": 1.0},), _white),
        (about(0.0, 1e-6),),
        everywhere=False,
    ),
    Erratum(
        "dark by default",
        "Alisavakis",
        "All defaults (`concentration` 0, `scale` 0), the light behind: pow(1, 0) · 0, no glow. `sssgen`: its defaults",
        Measure("alisavakis_lobe", ({**_BACK_LIT, "d": 0.0},), _white),
        (0.0,),
        Measure("lobe_normalized", ({**_BACK_LIT, "through": 1.0},), _white),
        (about(2.05, 1e-5),),
    ),
    Erratum(
        "the zero half vector",
        "Alisavakis",
        "`distortion` 1, `scale` 1, the light .001 to one side, directly behind, and .001 to the other side. Directly "
        "behind, L + N is 0 and has no direction. `sssgen` (`lobe_gdc2011`) does not normalise",
        Measure("alisavakis_lobe", ({**_ZERO_HALF, "d": 0.0, "concentration": 4.0, "scale": 1.0},), _white),
        (),
        Measure("lobe_gdc2011", ({**_ZERO_HALF, **_LOBE},), _white),
        (about(0.0, 1e-6),) * 3,
        everywhere=False,
    ),
    Erratum(
        "the zero half vector, normalised",
        "Alisavakis",
        "The same, only directly behind. `sssgen` (`lobe_normalized`) normalises, too, but with a guard: a lobe from "
        "0 to 1",
        Measure("alisavakis_lobe", ({**_JUST_BEHIND, "d": 0.0, "concentration": 4.0, "scale": 1.0},), _white),
        (),
        Measure("lobe_normalized", ({**_JUST_BEHIND, **_LOBE},), _white),
        (Right(0.0, 1.0),),
        everywhere=False,
    ),
)

UNITY_ICE = (
    Erratum(
        "the zero lobe",
        "Unity ice",
        f"The largest lobe over {_COUNT:,} random N, L and `distortion` below 1, without `ambient`, with the eye at "
        "the peak of the lobe; it is 1",
        Measure("ice_shader_lobe", (_NO_EYE,), _largest),
        (0.0,),
        Measure("lobe_normalized", (_SPREAD,), _largest),
        (about(1.0, 1e-4),),
    ),
    Erratum(
        "constant ambient",
        "Unity ice",
        "The light in front, at the side and behind; `attenuation` .5, `ambient` .1, map .8, `scale` 2, `power` 4: "
        "always attenuation · ambient · map. `sssgen`: a glow with the light behind",
        Measure("ice_shader_lobe", ({**_LIGHTS, **_ICE},), _white),
        (0.04, 0.04, 0.04),
        Measure("lobe_normalized", ({**_LIGHTS, **_ICE, "V": _FRONT},), _white),
        (about(0.04, 1e-6), about(0.04, 1e-6), about(0.84, 1e-5)),
    ),
    Erratum(
        "a lower peak",
        "GDC 2011",
        "The eye, the normal and the light in one line, `distortion` .2, `power` 6: (1 − .2)^6. `sssgen`, with a unit "
        "half vector: 1",
        Measure("lobe_gdc2011", ({**_BACK_LIT, **_LOBE, "power": 6.0, "distortion": 0.2},), _white),
        (0.8**6,),
        Measure("lobe_normalized", ({**_BACK_LIT, **_LOBE, "power": 6.0, "distortion": 0.2},), _white),
        (about(1.0, 1e-5),),
    ),
    Erratum(
        "a minimum of light",
        "Barré-Brisebois 2012",
        "The same with the light in front of the surface: 2^−6 remains. `sssgen`: 0",
        Measure("lobe_exp2", ({**_BACK_LIT, "L": _FRONT, **_LOBE, "power": 6.0},), _white),
        (2.0**-6,),
        Measure("lobe_normalized", ({**_BACK_LIT, "L": _FRONT, **_LOBE, "power": 6.0},), _white),
        (about(0.0, 0.0),),
    ),
    Erratum(
        "not the lobe that it cites",
        "three.js",
        "Its own defaults, with eye, normal and light in one line: 1. GDC 2011, which it cites, gives (1 − .1)²",
        Measure("three_js_port", ({**_BACK_LIT, "through": 1.0},), _white),
        (1.0,),
        Measure(
            "lobe_gdc2011",
            ({**_BACK_LIT, **_LOBE, "power": 2.0, "scale": 10.0, "attenuation": 0.1, "distortion": 0.1},),
            _white,
        ),
        (about(0.81, 1e-5),),
    ),
)
