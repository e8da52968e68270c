"""Geometry that rays meet on the CPU, in float64, so that every back end shades exactly the same points."""

from __future__ import annotations

from sssgen.scene.compound import Capsule, Union
from sssgen.scene.distance_field import Distance
from sssgen.scene.geometry_base import Geometry, Hits
from sssgen.scene.mesh import Mesh
from sssgen.scene.solids import Ball, Box, Slab, Torus

__all__ = ["Ball", "Box", "Capsule", "Distance", "Geometry", "Hits", "Mesh", "Slab", "Torus", "Union"]
