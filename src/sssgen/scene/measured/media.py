"""Translucent media for light transport, and presets from published measurements."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

from sssgen.scene.toml_table import Table, number, other, text, vector
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.paths import posix
from sssgen.support.text_files import read_text
from sssgen.support.toml_source import parse

Spectrum = tuple[float, float, float]

_FILE = os.path.join(os.path.dirname(__file__), "media.toml")
_COEFFICIENT = (0.0, 1e6)
_KEYS = {
    "reduced_scattering": vector(3, _COEFFICIENT),
    "absorption": vector(3, _COEFFICIENT),
    "ior": number((1.0, 10.0)),
    "measured": other(),
    "source": text(),
}
CLEAR = 1e-6
"""A smaller mean extinction per world unit counts as this, so that the mean free path is finite."""


@dataclass(frozen=True)
class Medium:
    """A homogeneous medium, for linear red, green and blue. Raises SssgenError for impossible values."""

    name: str
    absorption: Spectrum
    """σa per world unit; at least 0"""
    scattering: Spectrum
    """σs per world unit; at least 0"""
    anisotropy: float = 0.0
    """g of Henyey and Greenstein's phase function, the mean cosine: between −1 and 1, 0 for isotropic scattering"""
    ior: float = 1.0
    """Refractive index relative to the outside; 1 for a boundary without reflection and refraction"""
    source: str = ""
    roughness: float = 0.0
    """Of the boundary, 0 to 1: 0 is smooth; the alpha of GGX is its square. Without effect if `ior` is 1"""

    def __post_init__(self) -> None:
        for coefficient in (*self.absorption, *self.scattering):
            if not 0.0 <= coefficient < float("inf"):
                raise failure(f"the medium '{self.name}' has the coefficient {coefficient:g}", "it is at least 0")
        if not -1.0 < self.anisotropy < 1.0:
            message = f"the medium '{self.name}' has the anisotropy {self.anisotropy:g}"
            raise failure(message, "it is between -1 and 1; 0 is isotropic scattering")
        if not 1.0 <= self.ior <= 10.0:
            raise failure(f"the medium '{self.name}' has the refractive index {self.ior:g}", "it is from 1 to 10")
        if not 0.0 <= self.roughness <= 1.0:
            raise failure(f"the medium '{self.name}' has the roughness {self.roughness:g}", "it is from 0 to 1")

    @property
    def extinction(self) -> Spectrum:
        """σt = σa + σs per world unit."""
        red, green, blue = (a + s for a, s in zip(self.absorption, self.scattering, strict=True))
        return red, green, blue

    @property
    def albedo(self) -> Spectrum:
        """σs / σt, the share of the light that is not absorbed in a collision; 0 in empty space."""
        red, green, blue = (s / t if t > 0.0 else 0.0 for s, t in zip(self.scattering, self.extinction, strict=True))
        return red, green, blue

    @property
    def parameters(self) -> dict[str, float | list[float]]:
        """The medium's parameters by their names in techniques, as TOML values."""
        return {
            "ior": self.ior,
            "extinction": [*self.extinction],
            "scattering_albedo": [*self.albedo],
            "mean_free_path": self.mean_free_path,
        }

    @property
    def mean_free_path(self) -> float:
        """That of the channels' mean extinction, in world units; large but finite in a clear medium."""
        return 1.0 / max(sum(self.extinction) / 3.0, CLEAR)

    def matched(self) -> Medium:
        """The same medium with a boundary without reflection and refraction."""
        return replace(self, ior=1.0, roughness=0.0)


@dataclass(frozen=True)
class MediumData:
    """An entry of a file of media."""

    reduced_scattering: Spectrum
    """σs′ = σs (1 − g) per millimetre"""
    absorption: Spectrum
    """Per millimetre"""
    ior: float
    measured: bool
    """Whether all values are published; `source` states which are not"""
    source: str


def preset(name: str, unit_mm: float = 1.0, anisotropy: float = 0.0, file: str = "") -> Medium:
    """The medium `name` of `media.toml`, or of `file`, where one world unit is `unit_mm` millimetres.

    Publications give the reduced scattering. With g = 0 it is the scattering coefficient: isotropic scattering with the
    reduced coefficient gives the same light deep inside (Wyman, Patterson and Wilson, Similarity relations for the
    interaction parameters in radiation transport, 1989). With another g the coefficient is σs′ / (1 − g).

    Raises SssgenError for an unknown medium, an invalid file, a unit that is not positive, and |g| ≥ 1.
    """
    presets = media(file)
    if name not in presets:
        raise failure(f"unknown medium '{name}'", did_you_mean(name, presets) or f"media: {', '.join(presets)}")
    if not 0.0 < unit_mm < float("inf"):
        raise failure(f"a world unit cannot be {unit_mm:g} mm", "unit_mm is above 0")
    if not -1.0 < anisotropy < 1.0:
        raise failure(f"the anisotropy cannot be {anisotropy:g}", "it is between -1 and 1")
    entry = presets[name]
    return Medium(
        name,
        _scale(entry.absorption, unit_mm),
        _scale(entry.reduced_scattering, unit_mm / (1.0 - anisotropy)),
        anisotropy,
        entry.ior,
        entry.source,
    )


def media(file: str = "") -> Mapping[str, MediumData]:
    """The media of `media.toml`, or of `file`, by name. Raises SssgenError with all errors in the file."""
    path = file or _FILE
    return _media_of(read_text(path, posix(path)), posix(path))


@lru_cache(maxsize=8)
def _media_of(source: str, path: str) -> Mapping[str, MediumData]:
    """The media of a file's text."""
    document = parse(source, path)
    result = {}
    for name, content in document.data.items():
        table = Table(document, (name,), content, _KEYS)
        for key in ("reduced_scattering", "absorption", "source"):
            if key not in table.content:
                document.error(document.place(name).key, f"the medium '{name}' has no '{key}'", f"write {key} = …")
        measured = table.content.get("measured", False)
        if not isinstance(measured, bool):
            table.error("measured", "'measured' is true or false")
        result[name] = MediumData(
            table.vector("reduced_scattering", (1.0, 1.0, 1.0)),
            table.vector("absorption", (0.0, 0.0, 0.0)),
            table.number("ior", 1.0),
            measured is True,
            table.text("source", ""),
        )
    document.reporter.check()
    return result


def _scale(coefficients: Spectrum, factor: float) -> Spectrum:
    red, green, blue = (factor * coefficient for coefficient in coefficients)
    return red, green, blue
