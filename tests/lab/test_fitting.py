"""The fit of a chain to measured light, and the emitted material, which must equal the measured point."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from carried import carrying
from measured_views import SIZE, candidate, chain, small
from sssgen.lab.chart.picked_material import material_files, stages_of
from sssgen.lab.chart.picking import Pick
from sssgen.lab.measure import (
    candidates,
)
from sssgen.lab.measure import (
    fitting as fit,
)
from sssgen.lab.measure import (
    measurement as measure,
)
from sssgen.lab.measure import (
    scene_references as references,
)
from sssgen.lab.measure.candidates import Candidate
from sssgen.lab.measure.measured_chain import Chain
from sssgen.lab.measure.measurement import View
from sssgen.lab.measure.problem import Problem
from sssgen.material.material_loading import parse_material
from sssgen.pipeline.compiler import compile
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.scene_body import body

pytest.importorskip("scipy")
pytest.importorskip("flip_evaluator")

Array = npt.NDArray[np.float64]

pytestmark = pytest.mark.usefixtures("no_cache")


# --- the fit ---


def synthetic(view: View, result: Chain, inputs: Mapping[str, Any], scale: Array) -> Problem:
    """The light that the chain computes with these parameters."""
    fit_problem = measure.problem_of("translucency", view, summed=False)
    assert fit_problem is not None
    return replace(
        fit_problem, target=scale[:, None] * fit_problem.values(result, inputs), noise=np.zeros_like(fit_problem.target)
    )


@pytest.mark.parametrize(
    ("names", "values", "scale"),
    [
        (("lobe_gdc2011",), {"distortion": 0.35, "power": 3.0, "scale": 4.0, "ambient": 0.2}, [0.8, 0.5, 0.3]),
        (("lobe_exp2",), {"distortion": 0.1, "power": 9.0}, [2.0, 1.0, 0.5]),
        (("lobe_henyey_greenstein",), {"anisotropy": -0.3}, [0.4, 0.9, 1.4]),
    ],
)
def test_the_fit_recovers_the_parameters_of_synthetic_light(
    names: tuple[str, ...], values: dict[str, float], scale: list[float], training: tuple[View, ...], tmp_path: Path
) -> None:
    chosen = candidate("exact_thickness", "beer_lambert", *names, role="translucency")
    values = {**values, "attenuation_distance": 0.6}
    chains = [chain(chosen, view, tmp_path) for view in training[:2]]
    requests = [synthetic(view, built, values, np.array(scale)) for view, built in zip(training, chains, strict=False)]
    result = fit.fit(chains, requests)
    assert result.error < 1e-4
    assert result.factor == "subsurface_color"
    for name in {"distortion", "power", "anisotropy", "attenuation_distance"} & set(values):
        assert result.parameters[name] == pytest.approx((values[name],), rel=2e-3)
    if "scale" in values:  # scale and ambient light share the factor of the colour, so only their ratio is determined
        ratio = result.parameters["ambient"][0] / result.parameters["scale"][0]
        assert ratio == pytest.approx(values["ambient"] / values["scale"], rel=2e-3)
    channels = np.array(result.scale)
    assert channels / channels[0] == pytest.approx(np.array(scale) / scale[0], rel=2e-3)


def test_the_fit_is_deterministic(training: tuple[View, ...]) -> None:
    chosen = candidate("exact_thickness", "beer_lambert", "lobe_normalized", role="translucency")
    assert measure.fit_candidate(chosen, training) == measure.fit_candidate(chosen, training)


def test_scale_and_matte_are_not_negative(training: tuple[View, ...], tmp_path: Path) -> None:
    # the target is darker than the front reflection, so the best scale of the lobe is 0
    view = training[0]
    chosen = candidate("exact_thickness", "beer_lambert", "lobe_gdc2011")
    built = chain(chosen, view, tmp_path)
    fit_problem = measure.problem_of("material", view, summed=False)
    assert fit_problem is not None
    lambert = np.maximum(fit_problem.lambert, 1e-3)
    targets = [
        replace(
            fit_problem, target=np.maximum(0.8 * lambert - 0.2 * fit_problem.values(built, {}), 0.0), lambert=lambert
        ),
        replace(fit_problem, target=0.3 * fit_problem.values(built, {"scale": 3.0}) - 0.01 * lambert, lambert=lambert),
    ]
    less_lobe, less_matte = (fit.fit([built], [target]) for target in targets)
    for result in (less_lobe, less_matte):
        assert min(*result.scale, *result.matte) >= 0.0
        assert np.isfinite(result.error)
    assert max(less_matte.matte) == 0.0 and min(less_matte.scale) > 0.0
    assert min(less_lobe.matte) > 0.3


def test_scale_and_matte_are_least_squares(training: tuple[View, ...], tmp_path: Path) -> None:
    # the factor is `weight`, which is a number: all channels have the same scale
    view = training[1]
    built = chain(candidate("exact_thickness", "absorption_tint"), view, tmp_path)
    fit_problem = measure.problem_of("material", view, summed=False)
    assert fit_problem is not None
    fit_problem = fit_problem.thin_out(300)  # fewer lanes than the limit of a fit
    result = fit.fit([built], [fit_problem])
    values = fit_problem.values(built, fit.chain_values(result.parameters))

    def error(scale: Array, matte: Array) -> float:
        target, weight = fit_problem.fit_target
        apart = result._replace(scale=tuple(scale), matte=tuple(matte)).apply(values, fit_problem) - target
        return float(np.sqrt((weight * apart**2).mean()))

    scale, matte = np.array(result.scale), np.array(result.matte)
    assert np.ptp(scale) == 0.0
    assert error(scale, matte) == pytest.approx(result.error, rel=1e-6)
    for more in (0.97, 1.03):
        if more < 1.0 or scale[0] * more <= 1.0 / 0.5:  # `weight` is the scale, and at most 1
            assert error(more * scale, matte) > result.error
        for channel in range(3):
            assert error(scale, matte * np.where(np.arange(3) == channel, more, 1.0)) >= result.error


def test_the_scale_is_within_the_range_of_its_parameter(training: tuple[View, ...], tmp_path: Path) -> None:
    # `weight` is 0.5 by default and at most 1, so the scale is at most 2
    built = chain(candidate("exact_thickness", "absorption_tint"), training[0], tmp_path)
    fit_problem = measure.problem_of("translucency", training[0], summed=False)
    assert fit_problem is not None
    bright = replace(fit_problem, target=np.full_like(fit_problem.target, 20.0 * fit_problem.gain))
    result = fit.fit([built], [bright])
    assert result.factor == "weight"
    assert result.scale == pytest.approx((2.0, 2.0, 2.0))


def test_an_empty_chain_is_fitted_by_front_reflection(training: tuple[View, ...]) -> None:
    result = measure.fit_candidate(Candidate("material", "none", "none", (), ()), training)
    assert result.parameters == {} and result.scale == (0.0, 0.0, 0.0)
    assert [round(matte, 1) for matte in result.matte] != [0.0, 0.0, 0.0]


# --- the emitted material equals the measured point ---

CHAINS = {
    "a colour takes the scale": ("exact_thickness", "beer_lambert", "lobe_gdc2011"),
    "a number takes it": ("exact_thickness", "absorption_tint"),
    "a march": ("march_light", "beer_lambert", "lobe_exp2"),
    "thinness": ("thinness_uniform", "transmittance_from_thinness", "gltf_diffuse_transmission"),
    "a map": ("transmittance_map", "lobe_normalized"),
    "no thickness": ("wrap_lighting",),
    "a distance texture": ("march_distance_texture", "beer_lambert", "lobe_henyey_greenstein"),
}
QUICK = ("a number takes it", "a march", "a map")
MARKS = {title: [] if title in QUICK else [pytest.mark.slow] for title in CHAINS}


def picked(scene: MeasuredScene, point: Mapping[str, Any]) -> Pick:
    return Pick(scene.name, point, None, (), None, None, True)


@pytest.mark.parametrize("names", [pytest.param(CHAINS[title], id=title, marks=MARKS[title]) for title in CHAINS])
def test_the_emitted_material_gives_the_measured_light(
    names: tuple[str, ...], cube: View, training: tuple[View, ...], tmp_path: Path
) -> None:
    settings = (("steps", 3),) if names[0] == "march_light" else ()
    if names[0] == "march_distance_texture":
        settings = candidates.settings(candidates.load(names[0]))[1]
    chosen = candidate(*names, settings=settings)
    result = measure.fit_candidate(chosen, training[:2])
    assert result.factor and max(result.scale) > 0.0
    point = measure.measure_candidate(chosen, result, [cube])
    fit_problem = measure.problem_of("material", cube)
    assert fit_problem is not None
    picture = result.apply(
        fit_problem.values(chain(chosen, cube, tmp_path), fit.chain_values(result.parameters)), fit_problem
    )

    files = material_files(cube.scene, picked(cube.scene, point), "mine")
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    material = parse_material(files["mine.toml"], str(tmp_path / "mine.toml"))
    emitted = Chain(material._replace(surroundings=False))  # the light is that of a lamp
    albedo = emitted.surface(fit_problem.parts[0].inputs, "albedo")
    # its text contains the fitted parameters; only those of the scene's body are set
    light = fit_problem.values(emitted, {}) + albedo * fit_problem.lambert
    assert light == pytest.approx(picture, rel=1e-4, abs=1e-6)
    assert albedo[:, 0] == pytest.approx(result.matte, rel=1e-5)


@pytest.mark.parametrize("names", [CHAINS["a march"], CHAINS["a map"]])
def test_the_emitted_material_compiles_for_every_target(
    names: tuple[str, ...], cube: View, training: tuple[View, ...], tmp_path: Path
) -> None:
    chosen = candidate(*names)
    point = measure.measure_candidate(chosen, measure.fit_candidate(chosen, training[:1]), [cube])
    files = material_files(cube.scene, picked(cube.scene, point), "mine")
    assert ("body.sss" in files) == (names[0] == "march_light")
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    material = parse_material(files["mine.toml"], str(tmp_path / "mine.toml"))
    targets = carrying(material)
    assert len(targets) > 5
    for target in targets:
        assert compile(material, target).files, target


def test_every_translucency_technique_has_a_scale_parameter(training: tuple[View, ...], tmp_path: Path) -> None:
    # otherwise the emitted material could not be as bright as the measured point
    for option in candidates.translucency():
        technique = candidates.load(option.name) if option.techniques else None
        if technique and not candidates.is_published(technique) and not technique.attributes.calibrated:
            fit_problem = measure.problem_of("translucency", training[0], summed=False)
            assert fit_problem is not None
            built = chain(option, training[0], tmp_path)
            names = {name for part in fit_problem.parts for name in part.values}
            assert fit.free_parameters(built, names, fit_problem)[1] is not None, option.label


def test_the_parallax_of_an_inlay_has_the_scenes_parameters(tmp_path: Path) -> None:
    scene = small("inlay_plate")
    requests = [option for option in candidates.coordinates() if option.name == "parallax_refracted"]
    plate = View("plate", replace(references.plate(scene), size=SIZE))
    point = measure.measure_candidate(requests[0], measure.fit_candidate(requests[0], [plate]), [View("own", scene)])
    files = material_files(scene, Pick(scene.name, None, point, (), None, None, True), "mine")
    built = Chain(parse_material(files["mine.toml"], str(tmp_path / "mine.toml")))
    values = {uniform["technique_name"]: uniform["default"] for uniform in built.uniforms}
    assert (values["depth"], values["ior"]) == ([0.1], [1.5])
    assert [stage.section for stage in stages_of(point, body(scene.geometry))] == ["coordinates", "surface"]
