"""Limits the numbers of a record to those that materials have; files have others by mistake."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from sssgen.interchange.imported_material import Notes
from sssgen.interchange.surface_model import Quantity, SurfaceModel

BRIGHTEST = 1000.0
"""The largest emission of a material."""
_LARGEST = {"emission": BRIGHTEST, "thickness": 1e6, "normal": 4.0, "specular": 1e3, "specular_color": 1e3}
"""Field → its largest number, where that is not 1."""


def limit_numbers(model: SurfaceModel, notes: Notes) -> SurfaceModel:
    """The record with constants from 0 to the largest number of their field; `notes` gets what was outside.

    The factor of a picture is only kept from being negative, as a dark picture may have a large one; that of the
    thickness is a length.
    """
    changed: dict[str, Any] = {}
    if model.ior < 0.0:
        changed["ior"] = 1.0
        notes.add_approximation("ior", "1: an index of refraction is not negative")
    for field, value in vars(model).items():
        if not isinstance(value, Quantity):
            continue
        of_picture = value.image is not None and field != "thickness"
        most = float("inf") if of_picture else _LARGEST.get(field, 1.0)
        factor = tuple(min(max(part, 0.0), most) for part in value.factor)
        if factor != value.factor:
            changed[field] = value._replace(factor=factor)
            notes.add_approximation(field, "limited to 0" if of_picture else f"limited to 0 to {most:g}")
    return replace(model, **changed) if changed else model
