"""The fit of a chain to measured light, and the emitted material, which is the point that was measured."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

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
from sssgen.lab.scene.measured_scene import MeasuredScene
from sssgen.lab.scene.scene_body import body
from sssgen.material.material_loading import parse_material
from sssgen.pipeline.compiler import all_targets, compile

pytest.importorskip("scipy")
pytest.importorskip("flip_evaluator")

Array = npt.NDArray[np.float64]

pytestmark = pytest.mark.usefixtures("no_cache")


# --- the fit ---


def synthetic(view: View, made: Chain, given: Mapping[str, Any], scale: Array) -> Problem:
    """The light that a chain gives itself with these parameters."""
    asked = measure.problem_of("translucency", view, summed=False)
    assert asked is not None
    return replace(asked, target=scale[:, None] * asked.values(made, given), noise=np.zeros_like(asked.target))


@pytest.mark.parametrize(
    ("names", "given", "scale"),
    [
        (("lobe_gdc2011",), {"distortion": 0.35, "power": 3.0, "scale": 4.0, "ambient": 0.2}, [0.8, 0.5, 0.3]),
        (("lobe_exp2",), {"distortion": 0.1, "power": 9.0}, [2.0, 1.0, 0.5]),
        (("lobe_henyey_greenstein",), {"anisotropy": -0.3}, [0.4, 0.9, 1.4]),
    ],
)
def test_the_fit_recovers_the_parameters_of_synthetic_light(
    names: tuple[str, ...], given: dict[str, float], scale: list[float], training: tuple[View, ...], tmp_path: Path
) -> None:
    one = candidate("exact_thickness", "beer_lambert", *names, role="translucency")
    given = {**given, "attenuation_distance": 0.6}
    chains = [chain(one, view, tmp_path) for view in training[:2]]
    asked = [synthetic(view, made, given, np.array(scale)) for view, made in zip(training, chains, strict=False)]
    found = fit.fit(chains, asked)
    assert found.error < 1e-4
    assert found.factor == "subsurface_color"
    for name in {"distortion", "power", "anisotropy", "attenuation_distance"} & set(given):
        assert found.parameters[name] == pytest.approx((given[name],), rel=2e-3)
    if "scale" in given:  # strength and ambient light share the colour's factor: their ratio is what shows
        ratio = found.parameters["ambient"][0] / found.parameters["scale"][0]
        assert ratio == pytest.approx(given["ambient"] / given["scale"], rel=2e-3)
    channels = np.array(found.scale)
    assert channels / channels[0] == pytest.approx(np.array(scale) / scale[0], rel=2e-3)


def test_the_fit_is_deterministic(training: tuple[View, ...]) -> None:
    one = candidate("exact_thickness", "beer_lambert", "lobe_normalized", role="translucency")
    assert measure.fitted(one, training) == measure.fitted(one, training)


def test_scale_and_matte_are_not_negative(training: tuple[View, ...], tmp_path: Path) -> None:
    # light that the lobe would have to take away: the best there is, is none of it
    view = training[0]
    one = candidate("exact_thickness", "beer_lambert", "lobe_gdc2011")
    made = chain(one, view, tmp_path)
    asked = measure.problem_of("material", view, summed=False)
    assert asked is not None
    lambert = np.maximum(asked.lambert, 1e-3)
    both = [
        replace(asked, target=np.maximum(0.8 * lambert - 0.2 * asked.values(made, {}), 0.0), lambert=lambert),
        replace(asked, target=0.3 * asked.values(made, {"scale": 3.0}) - 0.01 * lambert, lambert=lambert),
    ]
    less_lobe, less_matte = (fit.fit([made], [wanted]) for wanted in both)
    for found in (less_lobe, less_matte):
        assert min(*found.scale, *found.matte) >= 0.0
        assert np.isfinite(found.error)
    assert max(less_matte.matte) == 0.0 and min(less_matte.scale) > 0.0
    assert min(less_lobe.matte) > 0.3


def test_scale_and_matte_are_least_squares(training: tuple[View, ...], tmp_path: Path) -> None:
    # without a colour to set, all channels have one scale; wrap lighting has none of its own
    view = training[1]
    made = chain(candidate("exact_thickness", "absorption_tint"), view, tmp_path)
    asked = measure.problem_of("material", view, summed=False)
    assert asked is not None
    asked = asked.thinned(300)  # fewer than are left out of a fit
    found = fit.fit([made], [asked])
    values = asked.values(made, fit.exact(found.parameters))

    def error(scale: Array, matte: Array) -> float:
        apart = found._replace(scale=tuple(scale), matte=tuple(matte)).apply(values, asked) - asked.target
        return float(np.sqrt((apart**2 / (asked.target**2 + fit.EPSILON)).mean()))

    scale, matte = np.array(found.scale), np.array(found.matte)
    assert np.ptp(scale) == 0.0
    assert error(scale, matte) == pytest.approx(found.error, rel=1e-6)
    for more in (0.97, 1.03):
        if more < 1.0 or scale[0] * more <= 1.0 / 0.5:  # `weight` takes the scale, and goes to 1
            assert error(more * scale, matte) > found.error
        for channel in range(3):
            assert error(scale, matte * np.where(np.arange(3) == channel, more, 1.0)) >= found.error


def test_the_scale_is_no_more_than_its_parameter_can_be(training: tuple[View, ...], tmp_path: Path) -> None:
    # `weight` is 0.5 by default and goes to 1: light that is brighter cannot be reached
    made = chain(candidate("exact_thickness", "absorption_tint"), training[0], tmp_path)
    asked = measure.problem_of("translucency", training[0], summed=False)
    assert asked is not None
    bright = replace(asked, target=np.full_like(asked.target, 20.0 * asked.gain))
    found = fit.fit([made], [bright])
    assert found.factor == "weight"
    assert found.scale == pytest.approx((2.0, 2.0, 2.0))


def test_an_empty_chain_is_fitted_by_front_reflection(training: tuple[View, ...]) -> None:
    found = measure.fitted(Candidate("material", "none", "none", (), ()), training)
    assert found.parameters == {} and found.scale == (0.0, 0.0, 0.0)
    assert [round(matte, 1) for matte in found.matte] != [0.0, 0.0, 0.0]


# --- the emitted material is the point that was measured ---

CHAINS = {
    "a colour takes the scale": ("exact_thickness", "beer_lambert", "lobe_gdc2011"),
    "a number takes it": ("exact_thickness", "absorption_tint"),
    "a march": ("march_light", "beer_lambert", "lobe_exp2"),
    "thinness": ("thinness_uniform", "transmittance_from_thinness", "gltf_diffuse_transmission"),
    "a map": ("transmittance_map", "lobe_normalized"),
    "no thickness": ("wrap_lighting",),
    "a distance texture": ("march_distance_texture", "beer_lambert", "lobe_henyey_greenstein"),
}


def picked(one: MeasuredScene, point: Mapping[str, Any]) -> Pick:
    return Pick(one.name, point, None, (), None, None, True)


@pytest.mark.parametrize("names", CHAINS.values(), ids=CHAINS)
def test_the_emitted_material_gives_the_measured_light(
    names: tuple[str, ...], cube: View, training: tuple[View, ...], tmp_path: Path
) -> None:
    settings = (("steps", 3),) if names[0] == "march_light" else ()
    if names[0] == "march_distance_texture":
        settings = candidates.settings(candidates.load(names[0]))[1]
    one = candidate(*names, settings=settings)
    found = measure.fitted(one, training[:2])
    assert found.factor and max(found.scale) > 0.0
    point = measure.measured(one, found, [cube])
    asked = measure.problem_of("material", cube)
    assert asked is not None
    shown = found.apply(asked.values(chain(one, cube, tmp_path), fit.exact(found.parameters)), asked)

    files = material_files(cube.scene, picked(cube.scene, point), "mine")
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    emitted = Chain(parse_material(files["mine.toml"], str(tmp_path / "mine.toml")))
    albedo = emitted.surface(asked.parts[0].inputs, "albedo")
    # its parameters are in its text; only what the scene's body gives is set
    light = asked.values(emitted, {}) + albedo * asked.lambert
    assert light == pytest.approx(shown, rel=1e-4, abs=1e-6)
    assert albedo[:, 0] == pytest.approx(found.matte, rel=1e-5)


@pytest.mark.parametrize("names", [CHAINS["a march"], CHAINS["a map"]])
def test_the_emitted_material_compiles_for_every_target(
    names: tuple[str, ...], cube: View, training: tuple[View, ...], tmp_path: Path
) -> None:
    one = candidate(*names)
    point = measure.measured(one, measure.fitted(one, training[:1]), [cube])
    files = material_files(cube.scene, picked(cube.scene, point), "mine")
    assert ("body.sss" in files) == (names[0] == "march_light")
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    material = parse_material(files["mine.toml"], str(tmp_path / "mine.toml"))
    targets = all_targets()
    assert len(targets) > 5
    for target in targets:
        assert compile(material, target).files, target


def test_every_translucency_technique_has_a_scale_parameter(training: tuple[View, ...], tmp_path: Path) -> None:
    # else what is emitted could not be as bright as what was measured
    for one in candidates.translucency():
        if one.techniques and not candidates.is_published(candidates.load(one.name)):
            asked = measure.problem_of("translucency", training[0], summed=False)
            assert asked is not None
            made = chain(one, training[0], tmp_path)
            names = {name for part in asked.parts for name in part.values}
            assert fit.free_parameters(made, names, asked)[1] is not None, one.label


def test_the_parallax_of_an_inlay_has_the_scenes_parameters(tmp_path: Path) -> None:
    one = small("inlay_plate")
    asked = [each for each in candidates.coordinates() if each.name == "parallax_refracted"]
    plate = View("plate", replace(references.plate(one), size=SIZE))
    point = measure.measured(asked[0], measure.fitted(asked[0], [plate]), [View("own", one)])
    files = material_files(one, Pick(one.name, None, point, (), None, None, True), "mine")
    made = Chain(parse_material(files["mine.toml"], str(tmp_path / "mine.toml")))
    values = {uniform["technique_name"]: uniform["default"] for uniform in made.uniforms}
    assert (values["depth"], values["ior"]) == ([0.1], [1.5])
    assert [stage.section for stage in stages_of(point, body(one.geometry))] == ["coordinates", "surface"]
