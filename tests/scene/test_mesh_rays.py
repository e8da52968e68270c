"""Rays at triangles: distances along rays that begin at a surface."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("embreex", reason="embreex is missing: pip install -e '.[bake]'")

from sssgen.scene.mesh_rays import MeshRays


def test_a_ray_that_begins_at_a_plane_never_goes_back() -> None:
    """Float32 still sees a plane in front of some origins that in float64 are behind it by less than its rounding."""
    places = np.array([[-0.9, -0.96, -0.9], [0.9, -0.96, -0.9], [0.9, -0.96, 0.9], [0.0, 1.2, 0.0]])
    rays = MeshRays(places, np.array([[0, 1, 2], [0, 1, 3], [1, 2, 3], [2, 0, 3]]))
    generator = np.random.default_rng(2)
    origins = generator.uniform((0.2, -0.96 - 1e-7, -0.7), (0.6, -0.96, -0.3), (2000, 3))
    ways = generator.normal(size=origins.shape)
    ways[:, 1] = generator.uniform(0.001, 0.003, len(ways)) * generator.choice([-1.0, 1.0], len(ways))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    faces, ahead = rays.nearest(origins, ways)
    behind = (faces == 0) & ((-0.96 - origins[:, 1]) / ways[:, 1] < 0.0)
    assert behind.sum() > 100
    assert (ahead[behind] == 0.0).all() and ahead.min() >= 0.0
