"""Geometry that rays meet on the CPU, in float64, so that every back end shades exactly the same points."""

from __future__ import annotations

from sssgen.harness.scenes.compound import Capsule, Union
from sssgen.harness.scenes.distance_field import Distance
from sssgen.harness.scenes.mesh import Mesh
from sssgen.harness.scenes.placed import Geometry, Hits
from sssgen.harness.scenes.solids import Ball, Box, Slab, Torus

__all__ = ["Ball", "Box", "Capsule", "Distance", "Geometry", "Hits", "Mesh", "Slab", "Torus", "Union"]
