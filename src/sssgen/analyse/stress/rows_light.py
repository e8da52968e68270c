"""Rows of the dangerous table about light: powers, vectors, lamps, absorption, phase functions."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from sssgen.analyse.stress.base_inputs import angles, calls, directions, mix, plain, samplers, scalars
from sssgen.analyse.stress.contract_inputs import outer_contract
from sssgen.analyse.stress.subject import Specimen
from sssgen.analyse.stress.trial import Trial
from sssgen.ir.formats import FLOAT16
from sssgen.lang.check.quantities import SCALARS

AXES = [(0, 0, 1), (0, 0, -1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0.6, 0, 0.8), (-0.6, 0, -0.8)]
_EPS = 2.0**-21
VIEW_LENGTH = "view_thickness"


def powers(specimen: Specimen) -> Iterator[Trial]:
    """Every base and exponent at 0, at the ends, and next to 0."""
    if calls(specimen, "pow"):
        choices = scalars(specimen) | dict.fromkeys(directions(specimen), AXES)
        yield Trial("", specimen, mix(specimen, choices))


def large_powers(specimen: Specimen) -> Iterator[Trial]:
    """All exponents at their maximum, over the lobe from its peak to its end."""
    if calls(specimen, "pow", "exp2") and directions(specimen):
        sine, cosine = angles(0.0, 100.0)
        swept = np.stack([sine, 0.0 * sine, cosine])
        ends = {
            name: max(ends) for name, ends in scalars(specimen, FLOAT16).items() if name in specimen.subject.uniforms
        }
        yield Trial("", specimen, plain(specimen, len(sine), {**ends, "V": swept, "V_object": swept}))


def zero_vectors(specimen: Specimen) -> Iterator[Trial]:
    """L = -N up to the distortion at which the half vector is zero; zero vectors, and vectors that are far too long."""
    names = directions(specimen)
    if not names:
        return
    lanes = 2001
    near = np.linspace(0.99, 1.0, lanes)
    exact = {name: near for name in specimen.subject.uniforms if "distortion" in name}
    yield Trial("", specimen, plain(specimen, lanes, exact))
    lengths = {name: [np.multiply(axis, size) for axis in AXES for size in (0.0, 1e-30, 1e-4, 1.0)] for name in names}
    full = {name: [0.0, 1.0] for name in exact}
    yield Trial("", specimen, mix(specimen, {**lengths, **full}))
    longer = {name: [np.multiply(axis, size) for axis in AXES for size in (1.0, 2.0, 100.0, 1e4)] for name in names}
    yield Trial("", specimen, mix(specimen, {**longer, **full}), ranged=False)


def lamp_at_surface(specimen: Specimen) -> Iterator[Trial]:
    """No direction to the light, and the brightest light that a format holds."""
    if {"L", "L_object"} & specimen.subject.params.keys():
        nearby = [(0, 0, 0), (0, 0, 1e-30), (1e-4, 0, 0), (0, 0, 1), (0, 0, -1)]
        choices: dict[str, list[Any]] = {
            "L": nearby,
            "L_object": nearby,
            "light_color": [(65504.0,) * 3, (0, 0, 0)],
            "N": AXES,
        }
        yield Trial("", specimen, mix(specimen, choices, 512))


def long_vectors(specimen: Specimen) -> Iterator[Trial]:
    """Directions whose squares overflow in half precision."""
    lengths = [np.multiply(axis, size) for axis in AXES for size in (256.0, 1000.0, 1e4)]
    if names := [name for name in directions(specimen) if name in ("L", "L_object")]:
        yield Trial("", specimen, mix(specimen, dict.fromkeys(names, lengths), 512), ranged=False)


def wrong_quantities(specimen: Specimen) -> Iterator[Trial]:
    """Thickness, thinness and transmittance below 0 and above 1."""
    textures = samplers(specimen)
    params = specimen.subject.params.items()
    names = [name for name, param in params if param.quantity in SCALARS and name not in textures]
    if names:
        values = [-1e6, -1.0, -1e-6, -0.0, 0.0, 0.5, 1.0, 1.0 + 1e-6, 2.0, 1e6]
        choices: dict[str, list[Any]] = {**scalars(specimen)}
        choices |= {name: [*values, *(outer_contract(specimen, name)[:2])] for name in names}
        inputs = mix(specimen, choices, 512)
        yield Trial("", specimen, inputs, ranged=False)
        yield Trial("", specimen, inputs, counts=False)  # outputs are in their ranges only if the inputs are


def thick_matter(specimen: Specimen) -> Iterator[Trial]:
    """Infinite matter, and attenuation distances of 0: no matter transmits exactly 1, and any matter is opaque."""
    thickness = _thickness(specimen)
    distance = "attenuation_distance" in specimen.subject.params
    if not thickness or not (distance or "sigma_t" in specimen.subject.params):
        return
    choices: dict[str, list[Any]] = {
        thickness: [0.0, 1e-30, 1e-6, 1.0, 1e6, 3e38],
        "attenuation_distance": [0.0, 1e-45, 1e-30, 1e-6, 0.2, 10.0],
        "attenuation_color": [(0, 0, 0), (1, 1, 1), (0, 0.5, 1), (1e-30, 0.9, 0.4)],
    }
    yield Trial("", specimen, mix(specimen, choices))
    if not distance:
        return
    full = _full(specimen)
    colors = [(0, 0, 0), (1, 1, 1), (0, 0.5, 1), (1e-30, 0.9, 0.4)]
    clear = mix(specimen, {**choices, thickness: [0.0], "attenuation_color": colors, **full}, 512)
    yield Trial("", specimen, clear, expected={"result": np.ones(1)})
    opaque = {**choices, thickness: [1e-3, 1.0], "attenuation_distance": [0.0], "attenuation_color": [(0.5, 0.5, 0.5)]}
    yield Trial("", specimen, mix(specimen, {**opaque, **full}, 64), expected={"result": np.zeros(1)}, tolerance=1e-6)


def lengths_of_the_eye(specimen: Specimen) -> Iterator[Trial]:
    """The eye's ray does not enter, or has no end; eye and lamp in one direction; no normal; a point far from the body.

    Nothing is scattered along a ray of length 0. A technique that glows shows the sky along it.
    """
    name = next((name for name, param in specimen.subject.params.items() if param.quantity == VIEW_LENGTH), "")
    if not name or specimen.role != "translucency":
        return
    ways = [*AXES, (0, 0, 0)]
    choices: dict[str, list[Any]] = dict.fromkeys(directions(specimen), ways)
    choices |= {
        name: [-1.0, 0.0, 1e-30, 0.1, 6.1e4, 3e38, np.inf],
        "P": [(0.1, 0.2, 0.5), (0, 0, 0), (-3, 0.5, 7), (1e4, -1e4, 1e4)],
        "light_nearness": [0.0, 1e-30, 0.5, 1e4],
    }
    yield Trial("", specimen, mix(specimen, choices))
    if "glows" in specimen.doc:
        return
    inside = {**choices, name: [-1.0, 0.0]}
    yield Trial("", specimen, mix(specimen, inside, 512), expected={"result": np.zeros(1)})


def black_attenuation(specimen: Specimen) -> Iterator[Trial]:
    """A colour with a component of 0 transmits all light where there is no matter."""
    thickness = _thickness(specimen)
    if thickness and "attenuation_color" in specimen.subject.params:
        choices: dict[str, list[Any]] = {
            thickness: [0.0],
            "attenuation_color": [(0, 0, 0), (0, 1, 1), (1, 0, 0.5), (0.5, 0.5, 0)],
            "attenuation_distance": [0.0, 1e-6, 0.2, 10.0],
        }
        clear = mix(specimen, {**choices, **_full(specimen)}, 256)
        yield Trial("", specimen, clear, expected={"result": np.ones(1)})


def _thickness(specimen: Specimen) -> str:
    """The name of the thickness input, where the result is light or transmittance."""
    params = specimen.subject.params.items()
    lets_through = specimen.role == "translucency" or specimen.quantity("result") == "transmittance"
    return next((name for name, param in params if param.quantity == "thickness" and lets_through), "")


def _full(specimen: Specimen) -> dict[str, list[float]]:
    """The inputs with which all light enters."""
    return {name: [1.0] for name in ("weight", "transmission_factor") if name in specimen.subject.params}


def extreme_anisotropy(specimen: Specimen) -> Iterator[Trial]:
    """g at its ends, and beyond them up to 1 itself."""
    if name := next((name for name in specimen.subject.uniforms if name in ("anisotropy", "g")), ""):
        values = [-1.0, -1.0 + _EPS, -0.95, 0.0, 1e-30, 0.95, 1.0 - _EPS, 1.0]
        yield Trial("", specimen, mix(specimen, {name: values, "V": AXES, "L": AXES}))
