"""Fixtures of the tests of measurements."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import pytest

from measured_views import SIZE, small, synthetic_view
from sssgen.lab.fluence import traced_body
from sssgen.lab.measure import (
    scene_references as references,
)
from sssgen.lab.measure.measurement import View
from sssgen.scene.measured import measured_scene
from sssgen.support import cache


@pytest.fixture(scope="module")
def no_cache() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cache, "_folder", None)
        patch.setenv("SSSGEN_CACHE", "")
        yield
    cache._folder = None


@pytest.fixture
def few_voxels(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Bakes of this process have a few hundred voxels in the body."""
    monkeypatch.setattr(traced_body, "BUDGET", 300)
    traced_body.fitting_voxels.cache_clear()
    yield
    traced_body.fitting_voxels.cache_clear()


@pytest.fixture(scope="module")
def cube() -> View:
    return synthetic_view(small("cube"))


@pytest.fixture(scope="module")
def training() -> tuple[View, ...]:
    return tuple(
        synthetic_view(replace(scene, size=SIZE), scene.name)
        for scene in references.training_scenes(measured_scene.load("cube"))
    )
