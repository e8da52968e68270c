"""Bodies that scatter light inside: those that are many mean free paths thick reflect like matte surfaces."""

from __future__ import annotations

from dataclasses import replace

from sssgen.interchange.imported_material import Notes
from sssgen.interchange.surface_model import ZERO, Quantity, SurfaceModel
from sssgen.interchange.texels import mean_of
from sssgen.material.scatter_color import multiscatter_of_albedo
from sssgen.scene.measured.media import Medium

DENSE = 30.0
"""The mean chord of a body, in mean free paths, from which on it is matte."""


def scatters_inside(model: SurfaceModel) -> bool:
    """Whether light enters the body and is scattered between its surfaces."""
    interior = model.interior
    return interior is not None and not model.thin_walled and any(interior.scattering) and weight_inside(model) > 0.0


def weight_inside(model: SurfaceModel) -> float:
    """The share of the light that enters the body, 0 to 1; none enters a metal."""
    shares = (model.transmission, model.diffuse_transmission, model.subsurface)
    return (1.0 - mean_of(model.metalness)[0]) * min(sum(mean_of(share)[0] for share in shares), 1.0)


def isotropic_medium(medium: Medium) -> Medium:
    """A medium with isotropic scattering that looks the same from afar: the similarity relation."""
    red, green, blue = ((1.0 - medium.anisotropy) * part for part in medium.scattering)
    return replace(medium, scattering=(red, green, blue), anisotropy=0.0)


def as_matte(model: SurfaceModel, notes: Notes, mean_chord: float) -> SurfaceModel:
    """The record without scattering inside, where the body is dense: the medium's colour is in the base colour.

    Techniques that follow light into a body serve one light; those of matte surfaces serve all. `mean_chord`, in
    metres, is that of the body. A picture of the base colour is kept, and scaled so that its mean is right.
    """
    if not scatters_inside(model):
        return model
    interior = model.interior
    assert interior is not None
    depth = min(isotropic_medium(interior).extinction) * mean_chord
    if depth < DENSE:
        return model
    through = 4.0 / (3.0 * depth + 4.0)
    reason = f"the matte colour of the medium: the body is {depth:.3g} mean free paths thick"
    error = f"at most {through:.1%} of the light would come through"
    for field in ("interior", "subsurface", "transmission", "diffuse_transmission"):
        notes.add_approximation(field, reason, error)
    weight = weight_inside(model)
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
