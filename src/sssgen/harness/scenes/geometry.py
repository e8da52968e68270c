"""Geometry that rays meet on the CPU, in float64, so that every back end shades exactly the same points."""

from __future__ import annotations

from .compound import Capsule, Union
from .distance_field import Distance
from .mesh import Mesh
from .placed import Geometry, Hits
from .solids import Ball, Box, Slab, Torus

__all__ = ["Ball", "Box", "Capsule", "Distance", "Geometry", "Hits", "Mesh", "Slab", "Torus", "Union"]
