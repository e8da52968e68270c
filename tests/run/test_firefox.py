"""The back end `firefox`: pictures of the examples, and its name. `make setup` does not install Firefox."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
import pytest

from folders import EXAMPLES
from sssgen.run import backends
from sssgen.run.backends import Backend
from sssgen.run.backends.browser import Browser
from sssgen.run.render.scene_render import render
from sssgen.scene import scene_loading


@pytest.mark.parametrize("name", ["ice", "jade_ring", "paper_lantern", "wax_mouse"])
def test_a_scene_is_that_of_numpy(name: str, backend: Callable[[str], Backend]) -> None:
    scene = dataclasses.replace(scene_loading.load(str(EXAMPLES / name / "scene.toml")), samples=1)
    drawn, oracle = (render(scene, runs, (64, 48)).encoded for runs in (backend("firefox"), backends.get("numpy")))
    assert np.ptp(oracle) > 0.3
    assert np.abs(np.clip(drawn, 0.0, 1.0) - np.clip(oracle, 0.0, 1.0)).max() < 1.0 / 255.0


def test_its_name(backend: Callable[[str], Backend]) -> None:
    firefox = backend("firefox")
    assert isinstance(firefox, Browser) and firefox.device().startswith("naga in Firefox 1")
