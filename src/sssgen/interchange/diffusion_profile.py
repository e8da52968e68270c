"""HDRP's diffusion profiles: how far light spreads below a surface."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass

from sssgen.interchange.albedo_inversion import subsurface_medium
from sssgen.interchange.unity_project import UnityProject
from sssgen.interchange.unity_yaml import Value, objects
from sssgen.scene.measured.media import Medium
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.support.paths import posix

_MM = 1e-3
THIN_OBJECT = 1
"""The transmission mode whose thickness is that of the texture; in the other one it is the body's."""


@dataclass(frozen=True)
class DiffusionProfile:
    """A profile. Lengths are metres."""

    name: str
    distance: tuple[float, float, float]
    """The scattering distance d of Burley's profile, per channel: 1 / S"""
    tint: tuple[float, float, float]
    """Multiplies the transmitted light"""
    thin: bool
    thickness: tuple[float, float]
    """For the values 0 and 1 of a thickness map"""
    unit: float
    """The metres of a world unit in the scenes that use the profile"""
    ior: float
    hash: int

    def transmittance(self, thickness: float) -> tuple[float, ...]:
        """The share of light that HDRP lets through at a thickness: tint / 4 (exp(-S t) + 3 exp(-S t / 3))."""
        shares = [0.25 * (math.exp(-thickness / d) + 3.0 * math.exp(-thickness / (3.0 * d))) for d in self.distance]
        return tuple(tint * share for tint, share in zip(self.tint, shares, strict=True))

    def interior(self, color: Sequence[float]) -> Medium:
        """The medium below a surface with an albedo, for which Burley's profile has this scattering distance."""
        radius = [d * shape(part) for d, part in zip(self.distance, color, strict=True)]
        return subsurface_medium(tuple(color), tuple(radius))


def shape(albedo: float) -> float:
    """Burley's s for light that enters diffusely: the scattering distance is the mean free path over s.

    Source: Christensen and Burley, Approximate Reflectance Profiles for Efficient Subsurface Scattering, 2015, eq. 6.
    """
    return 1.9 - albedo + 3.5 * (albedo - 0.8) ** 2


def read_profile(path: str) -> DiffusionProfile:
    """The profile of an .asset file. Raises SssgenError where it has none, or a value is wrong."""
    for body in objects(path, "MonoBehaviour"):
        if "profile" in body.mapping and "scatteringDistance" in body.mapping["profile"].mapping:
            name = body.mapping["m_Name"].text if "m_Name" in body.mapping else ""
            return _profile(body.mapping["profile"], name or os.path.splitext(os.path.basename(path))[0])
    raise failure("the file has no diffusion profile", "a profile of HDRP has the key 'profile'", posix(path))


def _profile(body: Value, name: str) -> DiffusionProfile:
    def number(key: str, default: float) -> float:
        return body.mapping[key].number if key in body.mapping else default

    multiplier = number("scatteringDistanceMultiplier", 1.0)
    distances = [_MM * multiplier * part for part in body.require("scatteringDistance").numbers("rgb")]
    if min(distances) < 0.0:
        raise body.require("scatteringDistance").error("a scattering distance is below 0")
    red, green, blue = (max(part, 1e-9) for part in distances)
    tint = body.mapping["transmissionTint"].numbers("rgb") if "transmissionTint" in body.mapping else (1.0, 1.0, 1.0)
    remap = body.mapping["thicknessRemap"].numbers("xy") if "thicknessRemap" in body.mapping else (0.0, 5.0)
    return DiffusionProfile(
        name,
        (red, green, blue),
        (tint[0], tint[1], tint[2]),
        number("transmissionMode", THIN_OBJECT) == THIN_OBJECT,
        (_MM * remap[0], _MM * remap[1]),
        max(number("worldScale", 1.0), 1e-3),
        min(max(number("ior", 1.4), 1.0), 2.0),
        int(number("hash", 0.0)),
    )


def profile_of(project: UnityProject, guid: str, profile_hash: int) -> DiffusionProfile | None:
    """The profile of a project with a GUID, else the one with a hash."""
    if guid and (path := project.file(guid)):
        return read_profile(path)
    if not profile_hash:
        return None
    for path in project.files(".asset"):
        try:
            profile = read_profile(path)
        except SssgenError:  # another kind of asset
            continue
        if profile.hash == profile_hash:
            return profile
    return None
