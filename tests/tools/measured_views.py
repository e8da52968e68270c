"""Small views of the measured scenes, with synthetic light, and chains of techniques to measure in them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from sssgen.lab.measure import (
    measurement as measure,
)
from sssgen.lab.measure.candidates import Candidate
from sssgen.lab.measure.measured_chain import Chain
from sssgen.lab.measure.measurement import View
from sssgen.lab.measure.problem import LightReference
from sssgen.lab.reference.inside_lengths import thickness
from sssgen.scene.measured import measured_scene
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.scene_body import body
from sssgen.scene.measured.view_points import points

SIZE = (12, 12)


def small(name: str) -> MeasuredScene:
    return replace(measured_scene.load(name), size=SIZE)


def synthetic_view(scene: MeasuredScene, name: str = "own") -> View:
    """A view with a synthetic reference: light that falls off with the thickness, more from the front, and noise."""
    surface = points(scene)
    references: list[LightReference] = []
    for light in scene.lights:
        assert light.direction is not None
        towards = np.tile(light.direction, (surface.count, 1))
        length = thickness(scene.geometry, np.ascontiguousarray(surface.inputs["P"].T), towards)
        front = np.maximum(surface.inputs["N"].T @ light.direction, 0.0)
        colors = np.array([0.9, 0.5, 0.3])[:, None]
        mean = colors * (0.4 * np.exp(-length / colors) + 0.5 * front)
        references.append((mean, np.full_like(mean, 1e-3)))
    return View(name, scene, tuple(references), "synthetic")


def candidate(*chain: str, role: str = "material", settings: tuple[tuple[str, int], ...] = ()) -> Candidate:
    return Candidate(role, chain[-1], " → ".join(chain), settings, chain)


def chain(tested: Candidate, view: View, folder: Path) -> Chain:
    result = measure.chain_of(tested, body(view.scene.geometry), str(folder))
    assert result is not None
    return result
