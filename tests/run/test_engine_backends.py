"""Engines as back ends: `sssgen render` draws a scene in them, and commands for functions refuse them."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
import pytest

from folders import EXAMPLES
from slow_cases import some_slow
from sssgen.cli.main import main
from sssgen.run import backends
from sssgen.run.backend_registry import BACKENDS
from sssgen.run.backends import Backend
from sssgen.run.render.scene_render import render
from sssgen.scene import scene_loading

ENGINES = [name for name, record in BACKENDS.items() if record.scenes_only]


@pytest.mark.parametrize("name", some_slow(ENGINES, "babylonjs"))
def test_an_engine_draws_a_scene(name: str, backend: Callable[[str], Backend]) -> None:
    """The light is the engine's own: not the oracle's numbers, but the same picture."""
    scene = scene_loading.load(str(EXAMPLES / "paper_lantern" / "scene.toml"))
    scene = dataclasses.replace(scene, samples=1, ambient=(0.0, 0.0, 0.0), time=0.0)
    drawn, oracle = (render(scene, runs, (64, 48)) for runs in (backend(name), backends.get("numpy")))
    ours, theirs = (np.clip(picture.encoded, 0.0, 1.0) for picture in (oracle, drawn))
    assert np.array_equal(oracle.covered > 0.0, drawn.covered > 0.0)
    assert np.ptp(ours) > 0.3 and np.abs(ours - theirs).mean() < 0.03


@pytest.mark.parametrize("command", ["eval", "stress"])
def test_an_engine_evaluates_no_functions(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([command, "lobe_gdc2011", "--backend", "threejs"]) == 2
    assert "threejs draws scenes and evaluates no functions" in capsys.readouterr().err
