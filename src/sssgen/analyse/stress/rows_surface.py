"""Rows of the dangerous table about the surface: parallax, tangent frames, texture coordinates, texels."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from sssgen.analyse.stress.base_inputs import angles, mix, plain, samplers
from sssgen.analyse.stress.contract_inputs import TEXELS
from sssgen.analyse.stress.rows_light import AXES
from sssgen.analyse.stress.subject import Specimen
from sssgen.analyse.stress.trial import Trial
from sssgen.ir.types import Sampler
from sssgen.run.backends import Array, get
from sssgen.run.evaluate.evaluation import run
from sssgen.targets.runtime.numpy_textures import Texture

UV = np.array([0.3, 0.6], np.float32)
_NANS = (0x7E00, 0x7C01, 0xFE00, 0xFFFF, 0x7C00, 0xFC00)
"""Half-precision bit patterns: quiet, signalling, negative and all-ones NaN, infinities."""


def _parallax(specimen: Specimen) -> bool:
    return {"uv", "V", "T", "B", "N"} <= specimen.subject.params.keys() and specimen.role == "coordinates"


def _free(specimen: Specimen, values: dict[str, float]) -> bool:
    """Whether a material leaves these uniforms free, or fixes them at these values."""
    return all(specimen.settings.get(name, (value,)) == (value,) for name, value in values.items())


def _swept(specimen: Specimen, start: float, end: float, changes: dict[str, Any] | None = None) -> Trial:
    """The view from one angle to the normal to another, in degrees: a path."""
    sine, cosine = angles(start, end)
    view = np.stack([sine, 0.0 * sine, cosine])
    inputs = plain(specimen, len(sine), {"V": view, "uv": UV, **(changes or {})})
    return Trial("", specimen, inputs, path=True)


def _longest(specimen: Specimen) -> float:
    """The documented maximum of the slide, with the defaults."""
    uniforms = specimen.subject.uniforms
    fade = uniforms["grazing_fade"].default[0] if "grazing_fade" in uniforms else 1.0
    return 1.055 * float(uniforms["depth"].default[0] if "depth" in uniforms else 0.05) / fade


def grazing_view(specimen: Specimen) -> Iterator[Trial]:
    """The view becomes grazing, without refraction: the slide is bounded, and 0 at 90 degrees."""
    still = {"ior": 1.0, "outside_ior": 1.0, "eta": 1.0}
    if _parallax(specimen) and _free(specimen, still):
        swept = _swept(specimen, -90.0, 90.0, still)
        yield swept._replace(expected={"result": UV}, tolerance=_longest(specimen))
        flat = mix(specimen, {"V": [(1, 0, 0), (0, 1, 0), (-1, 0, 0), (1, 0, 1e-30)], "uv": [UV]}, 64)
        flat.values.update({name: np.array([1.0], np.float32) for name in still if name in flat.values})
        yield Trial("", specimen, flat, expected={"result": UV}, tolerance=1e-6)


def past_the_critical_angle(specimen: Specimen) -> Iterator[Trial]:
    """Into a medium with a lower index: a smooth fade to the base texture coordinates, where no ray enters."""
    thinner = {"ior": 1.0, "outside_ior": 1.5, "eta": 1.5}
    refracts = {"ior", "eta"} & specimen.subject.params.keys()
    if _parallax(specimen) and refracts and _free(specimen, thinner):
        yield _swept(specimen, 0.0, 90.0, thinner)
        beyond = _swept(specimen, 42.5, 90.0, thinner)
        yield beyond._replace(expected={"result": UV}, tolerance=1e-6)


def from_behind(specimen: Specimen) -> Iterator[Trial]:
    """The view direction turns to the back of the surface."""
    if {"V", "N"} <= specimen.subject.params.keys():
        sine, cosine = angles(0.0, 180.0)
        view = np.stack([sine, 0.0 * sine, cosine])
        yield Trial("", specimen, plain(specimen, len(sine), {"V": view}), path=True)
        yield Trial("", specimen, mix(specimen, {"V": AXES, "N": AXES, "L": AXES, "uv": [UV]}))


def bad_frames(specimen: Specimen) -> Iterator[Trial]:
    """Mirrored, sheared, scaled, flat and missing tangents; without a tangent there is no slide."""
    if not {"T", "B", "N"} <= specimen.subject.params.keys():
        return
    frames: dict[str, list[Any]] = {
        "T": [(1, 0, 0), (-1, 0, 0), (0.7, 0.1, 0.7), (0, 0, 0), (0, 0, 1), (1e-20, 0, 0), (0.3, 0, 0)],
        "B": [(0, 1, 0), (0, -1, 0), (0.6, 0.8, 0), (0, 0, 0), (1, 0, 0), (0, 1e-20, 0), (0, 0.3, 0)],
        "N": [(0, 0, 1), (0, 0, -1), (0.6, 0, 0.8), (0, 0, 0)],
        "V": AXES,
        "uv": [UV],
    }
    yield Trial("", specimen, mix(specimen, frames))
    if _parallax(specimen):
        missing = mix(specimen, {**frames, "T": [(0, 0, 0)], "N": [(0, 0, 1)]}, 256)
        yield Trial("", specimen, missing, expected={"result": UV})


def seams(specimen: Specimen) -> Iterator[Trial]:
    """Texture coordinates that jump from pixel to pixel, and a texture with mip levels."""
    if "uv" not in specimen.subject.params or not (names := samplers(specimen)):
        return
    lanes = 1024
    leap = np.stack([np.where(np.arange(lanes) % 2, 0.999, 0.001), np.where(np.arange(lanes) % 3, 0.5, 1e4)])
    rng = np.random.default_rng(5)
    textures = {
        name: Texture(rng.random((TEXELS, TEXELS, 4)).astype(np.float16), mipmaps=True)
        for name in names
        if specimen.subject.params[name].type == Sampler("2D")
    }
    if textures:
        yield Trial("", specimen, plain(specimen, lanes, {"uv": leap, **textures}))


def _swept_texels(specimen: Specimen, lanes: int) -> dict[str, Any]:
    """Random positions over a whole texture, for every kind of coordinate."""
    rng = np.random.default_rng(11)
    flat, solid = rng.random((2, lanes)), rng.uniform(-1.0, 1.0, (3, lanes))
    return {"uv": flat, "P": solid, "p": solid, "P_object": solid}


def bad_texels(specimen: Specimen) -> Iterator[Trial]:
    """Texels below 0, above 1, and NaN, in textures that hold a quantity: results must stay in the range."""
    yield from _with_texels(specimen, (0xC000, 0x8001, 0x4000, 0x7BFF, 0xFBFF, *_NANS[:1]))


def fast_math(specimen: Specimen) -> Iterator[Trial]:
    """Every kind of NaN and infinity in such textures, which a compiler may assume to be impossible."""
    yield from _with_texels(specimen, _NANS)


def _with_texels(specimen: Specimen, kinds: tuple[int, ...]) -> Iterator[Trial]:
    names = [name for name in samplers(specimen) if specimen.subject.uniforms[name].quantity]
    for kind in kinds if names else ():
        textures = {}
        for name in names:
            size = {"2D": (8, 8, 4), "3D": (8, 8, 8, 4), "Cube": (6, 8, 8, 4)}[_dim(specimen, name)]
            texels = np.full(size, 0.5, np.float16)
            texels.reshape(-1, 4)[::3] = np.array(kind, np.uint16).view(np.float16)
            textures[name] = Texture(texels, dim=_dim(specimen, name))
        yield Trial("", specimen, plain(specimen, 256, {**_swept_texels(specimen, 256), **textures}))


def _dim(specimen: Specimen, name: str) -> str:
    type_ = specimen.subject.params[name].type
    assert isinstance(type_, Sampler)
    return type_.dim


def eight_bits(specimen: Specimen) -> Iterator[Trial]:
    """A map in 8 bits deviates by at most half a step from the same map in 16 bits."""
    names = samplers(specimen, data=True)
    if not names or specimen.role not in ("thickness", "distance") or specimen.slots:
        return
    fine, coarse = {}, {}
    rng = np.random.default_rng(13)
    for name in names:
        size = {"2D": (8, 8, 4), "3D": (8, 8, 8, 4), "Cube": (6, 8, 8, 4)}[_dim(specimen, name)]
        texels = rng.random(size)
        fine[name] = Texture(texels.astype(np.float16), dim=_dim(specimen, name))
        coarse[name] = Texture((np.round(texels * 255.0) / 255.0).astype(np.float16), dim=_dim(specimen, name))
    places = _swept_texels(specimen, 512)
    expected: dict[str, Array] = run(specimen.subject, plain(specimen, 512, {**places, **fine}), get("numpy"))
    step = (2.0 if specimen.role == "distance" else 1.0) * (0.5 / 255.0 + 2.0**-11)
    yield Trial("", specimen, plain(specimen, 512, {**places, **coarse}), expected=expected, tolerance=1.01 * step)
