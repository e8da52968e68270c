"""Bodies that are many mean free paths thick: hardly any light comes through, so they reflect like matte surfaces."""

from __future__ import annotations

from dataclasses import replace

from sssgen.interchange.imported import Notes
from sssgen.interchange.scatter_color import multiscatter_of_albedo
from sssgen.interchange.surface_model import ZERO, Quantity, SurfaceModel
from sssgen.interchange.texels import mean_of

DENSE = 30.0
"""The mean chord of a body, in mean free paths, from which on it is matte."""


def as_matte(model: SurfaceModel, notes: Notes, mean_chord: float) -> SurfaceModel:
    """The record without scattering inside, where the body is dense: the medium's colour is in the base colour.

    Techniques that follow light into a body serve one light; those of matte surfaces serve all. `mean_chord`, in
    metres, is that of the body. A picture of the base colour is kept, and scaled so that its mean is right.
    """
    interior = model.interior
    if interior is None or model.thin_walled or not any(interior.scattering):
        return model
    forward = 1.0 - interior.anisotropy
    reduced = [a + forward * s for a, s in zip(interior.absorption, interior.scattering, strict=True)]
    depth = min(reduced) * mean_chord
    if depth < DENSE:
        return model
    through = 4.0 / (3.0 * depth + 4.0)
    reason = f"the matte colour of the medium: the body is {depth:.3g} mean free paths thick"
    error = f"at most {through:.1%} of the light would come through"
    for field in ("interior", "subsurface", "transmission", "diffuse_transmission"):
        notes.approximated(field, reason, error)
    weight = min(
        sum(mean_of(part)[0] for part in (model.transmission, model.diffuse_transmission, model.subsurface)), 1.0
    )
    base, color = mean_of(model.base_color), multiscatter_of_albedo(interior.albedo, interior.anisotropy)
    mixed = [(1.0 - weight) * b + weight * c for b, c in zip(base, color, strict=True)]
    if model.base_color.image is None or min(base) <= 0.0:
        matte = Quantity(tuple(mixed))
    else:
        factor = [f * m / b for f, m, b in zip(model.base_color.factor, mixed, base, strict=True)]
        matte = Quantity(tuple(factor), model.base_color.image)
    return replace(
        model, base_color=matte, subsurface=ZERO, transmission=ZERO, diffuse_transmission=ZERO, interior=None
    )
