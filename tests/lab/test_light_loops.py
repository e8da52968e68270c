"""The loops of docs/light_loops.py: ours and the reference show the same light, which moves."""

from __future__ import annotations

import dataclasses
import io
import runpy
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from folders import ROOT
from sssgen.scene import scene_loading
from sssgen.scene.example_scenes import measured_scenes
from sssgen.scene.measured import measured_scene

for package in ("scipy", "embreex", "igl"):
    pytest.importorskip(package, reason=f"{package} is missing: pip install -e '.[bake,chart]'")


@pytest.mark.slow
def test_a_lamp_and_surroundings_go_around(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "docs"))
    script = runpy.run_path(str(ROOT / "docs" / "light_loops.py"))
    scene = scene_loading.load(measured_scenes()["torus"], draws=False)
    body = measured_scene.of_scene(scene, "torus.toml")
    loop = script["Loop"](scene, dataclasses.replace(body, size=(40, 40)), 3, str(tmp_path))
    ours, (traced, noise) = loop.draw(16), loop.trace(64)
    for drawn, reference, error in zip(ours, traced, noise, strict=True):
        errors = [script["relative"](*frame) for frame in zip(drawn, reference, error, strict=True)]
        # those of each frame and the reference of the one before
        others = [script["relative"](*frame) for frame in zip(drawn, np.roll(reference, 1, axis=0), error, strict=True)]
        print(f"errors {np.round(errors, 3)}, to another frame {np.round(others, 3)}")
        assert max(errors) < 0.15
        assert all(own < 0.8 * other for own, other in zip(errors, others, strict=True))
    with Image.open(io.BytesIO(script["animation"](ours, traced))) as animation:
        assert (animation.format, getattr(animation, "n_frames", 1), animation.info["loop"]) == ("WEBP", 3, 0)
