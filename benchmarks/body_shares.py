"""Fits what `sssgen import` writes for bodies that scatter light: src/sssgen/interchange/body_shares.toml.

    python benchmarks/body_shares.py [--samples 128]

For each size in mean free paths, a ball and a bar with that mean chord and of nine albedos are path traced (Mitsuba)
under five lamps and under uniform light from everywhere. The shares of `interior_octaves`, and of a matte reflection
with the colour that a dense body has, are fitted to all scattered light that leaves the surface, by least squares of
the lab's relative error. Only the matte reflection has light from everywhere. Prints the errors, beside those of the
technique's defaults.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.optimize import nnls

from sssgen.interchange.body_shares import FILE
from sssgen.lab.chart import charting
from sssgen.lab.measure import scene_inputs
from sssgen.lab.measure.candidates import Candidate
from sssgen.lab.measure.error_metric import EPSILON
from sssgen.lab.measure.measurement import chain_of, problem_of
from sssgen.lab.measure.problem import WHITE, Problem
from sssgen.lab.measure.scene_references import ROUND_LIGHTS, lit_body
from sssgen.lab.reference.transport import radiance_along
from sssgen.lab.reference.transport_mitsuba import Light
from sssgen.material.scatter_color import multiscatter_of_albedo
from sssgen.scene.geometry import Ball, Capsule
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.media import Medium
from sssgen.scene.measured.scene_body import body
from sssgen.scene.measured.view_points import points

Array = npt.NDArray[np.float64]

SIZES = (0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 30.0)
"""Mean chords in mean free paths."""
ALBEDOS = ((0.3, 0.6, 0.8), (0.9, 0.95, 0.98), (0.99, 0.997, 0.9995))
"""Three are traced at once, as the colour channels of a medium."""
LIGHTS = (*ROUND_LIGHTS, (0.0, 0.2, 1.0))
"""With one more in front: imports show most bodies so."""
SKY = np.sqrt(0.5)
"""The weight of uniform light beside a lamp's: its errors cannot be small, as octaves have none of it."""
CHAIN = Candidate(
    "material", "interior", "interior", (), ("exact_view_thickness", "interior_octaves"), path="march_light_traced"
)
DEFAULTS = np.array([1.0, 1.0, 0.25, 0.125, 0.0])


def scenes(size: float, albedos: tuple[float, ...]) -> list[MeasuredScene]:
    """A ball and a bar of the mean chord 1, whose medium has this many mean free paths in it."""
    red, green, blue = albedos
    absorbing = (size * (1.0 - red), size * (1.0 - green), size * (1.0 - blue))
    medium = Medium("grey", absorbing, (size * red, size * green, size * blue))
    ball, bar = Ball(0.75), Capsule(9.0 / 16.0, 45.0 / 16.0, rotation=(0.0, 0.0, 35.0))
    return [
        lit_body("ball", ball, medium, (0.0, 0.6, 4.8), LIGHTS),
        lit_body("bar", bar, medium, (2.0, 1.6, 12.4), LIGHTS),
    ]


def terms(problem: Problem, scene: MeasuredScene) -> Array:
    """(3, 5, lanes): the light of each octave alone, and the matte reflection, per channel."""
    with tempfile.TemporaryDirectory() as folder:
        chain = chain_of(CHAIN, body(scene.geometry), folder)
        assert chain is not None
        octaves = [problem.values(chain, {"octaves": unit}) for unit in np.eye(4)]
    return np.stack([*octaves, problem.lambert], axis=1)


def from_everywhere(scene: MeasuredScene, samples: int) -> Array:
    """The scattered light of uniform light with an irradiance of 1, (3, points): π times the radiance."""
    assert scene.medium is not None
    visible = points(scene)
    origins = np.broadcast_to(visible.origin, (visible.count, 3))
    towards = np.ascontiguousarray(-visible.inputs["V"].T)
    light = radiance_along(scene.geometry, scene.medium, Light(None), origins, towards, samples).mean.T
    unscattered: Array = np.exp(-np.array(scene.medium.extinction)[:, None] * scene_inputs.view_lengths(scene))
    return light - unscattered


def equations(scene: MeasuredScene, view: charting.View, samples: int) -> Iterator[tuple[Array, Array]]:
    """For each channel the weighted terms and the weighted target, (lanes, 5) and (lanes,)."""
    problem = problem_of("material", view, summed=False)
    assert problem is not None and scene.medium is not None
    everywhere = from_everywhere(scene, samples)
    gain = WHITE / float(np.percentile(everywhere, 99.0))
    colors = multiscatter_of_albedo(scene.medium.albedo)
    lamps = zip(terms(problem, scene), problem.target, strict=True)
    for (of_octaves, of_lamps), of_sky, color in zip(lamps, gain * everywhere, colors, strict=True):
        sky = np.zeros((5, of_sky.size))
        sky[4] = gain
        rows, target = np.concatenate([of_octaves, sky], axis=1), np.concatenate([of_lamps, of_sky])
        rows[4] *= color
        weight = 1.0 / np.sqrt((target**2 + EPSILON) * target.size)
        weight[of_lamps.size :] *= SKY
        yield (rows * weight).T, target * weight


def fitted(size: float, samples: int) -> tuple[Array, list[float], list[float]]:
    """The five shares of bodies of a size, their error for each albedo, and that of the defaults."""
    settings = charting.Settings(samples=samples)
    systems: list[tuple[Array, Array]] = []
    for albedos in ALBEDOS:
        bodies = scenes(size, albedos)
        views = charting.with_references({"": [(scene.name, scene) for scene in bodies]}, settings)[""]
        of_bodies = [list(equations(scene, view, samples)) for scene, view in zip(bodies, views, strict=True)]
        for channels in zip(*of_bodies, strict=True):
            rows, target = (np.concatenate(parts) for parts in zip(*channels, strict=True))
            systems.append((rows, target))
    rows, target = (np.concatenate(parts) for parts in zip(*systems, strict=True))
    shares = np.round(nnls(rows, target)[0], 3)
    errors = [
        [float(np.linalg.norm(rows @ tried - target)) / np.sqrt(2.0) for rows, target in systems]
        for tried in (shares, DEFAULTS)
    ]
    return shares, errors[0], errors[1]


def main() -> int:
    """Fits, prints and writes."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--samples", type=int, default=64, help="paths per point and channel")
    samples = options.parse_args().samples
    text = "# Written by benchmarks/body_shares.py: mean chord in mean free paths, the four octaves, the matte share.\n"
    text += "rows = [\n"
    print(f"Errors for the albedos {', '.join(f'{albedo:g}' for group in ALBEDOS for albedo in group)}:\n")
    print("| mean free paths | shares | errors | with the defaults |\n|---:|---|---|---|")
    for size in SIZES:
        shares, errors, before = fitted(size, samples)
        shown = (" ".join(f"{number:.2f}" for number in numbers) for numbers in (shares, errors, before))
        print(f"| {size:g} | {' | '.join(shown)} |", flush=True)
        text += f"  {[size, *shares.tolist()]},\n"
    Path(FILE).write_text(text + "]\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
