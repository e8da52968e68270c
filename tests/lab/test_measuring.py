"""Measurements of chains: the inputs of a scene, the errors, and results with an independent solution."""

from __future__ import annotations

import functools
import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from measured_views import SIZE, candidate, chain, small, synthetic_view
from sssgen.lab.measure import (
    candidates,
    problem,
    scene_inputs,
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
from sssgen.lab.measure.fitting import FitResult
from sssgen.lab.measure.measured_chain import Chain, material_of
from sssgen.lab.measure.measurement import View
from sssgen.lab.measure.problem import Problem
from sssgen.lab.reference.inside_lengths import thickness
from sssgen.material.material_text import MaterialSection, material_text
from sssgen.scene.camera import Camera
from sssgen.scene.environment import Environment
from sssgen.scene.geometry import Ball, Box, Union
from sssgen.scene.measured import measured_scene
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.media import Medium
from sssgen.scene.measured.view_points import points
from sssgen.scene.scene import Light
from sssgen.scene.scene_loading import parse_scene
from sssgen.support.diagnostics import SssgenError

pytest.importorskip("scipy")
pytest.importorskip("flip_evaluator")

Array = npt.NDArray[np.float64]

pytestmark = pytest.mark.usefixtures("no_cache")


# --- chains ---


def from_afar(x: float, y: float, z: float) -> Light:
    return Light(None, (x, y, z), (1.0, 1.0, 1.0))


def test_a_chain_computes_its_formula(tmp_path: Path) -> None:
    names = (("thickness", "constant_thickness"), ("thickness", "beer_lambert"), ("translucency", "lobe_gdc2011"))
    built = Chain(material_of([MaterialSection(*section) for section in names], str(tmp_path)))
    surface = points(small("torus"))
    light = surface.light(from_afar(0.6, 0.0, -0.8))
    color = np.array([0.9, 0.5, 0.2])
    built.set(
        {
            "thickness_factor": 0.3, "attenuation_distance": 0.7, "distortion": 0.25, "power": 3.0,
            "scale 1": 1.5, "scale": 99.0, "ambient": 0.1, "subsurface_color": color, "unknown": 1.0,
        },
        {},
    )  # fmt: skip
    (result,) = built.run(surface.inputs, [light])
    bent = light["L"] + 0.25 * surface.inputs["N"]
    lobe = np.clip(-(surface.inputs["V"] * bent).sum(axis=0), 0.0, 1.0) ** 3.0
    assert result == pytest.approx(color[:, None] * (1.5 * lobe + 0.1) * np.exp(-0.3 / 0.7), rel=1e-9)
    # a parameter may have a value for each point; the other parameters are unchanged
    lengths = np.linspace(0.1, 1.0, surface.count)
    built.set({"thickness_factor": lengths}, {})
    (result,) = built.run(surface.inputs, [light])
    assert result == pytest.approx(color[:, None] * (1.5 * lobe + 0.1) * np.exp(-lengths / 0.7), rel=1e-9)


def test_separate_lights_sum_and_emission_counts_once(tmp_path: Path) -> None:
    text = "/** Shines.\nrole: surface\n*/\nvoid lamp(out vec3 emission)\n{\n    emission = vec3(0.25, 0.0, 0.0);\n}\n"
    (tmp_path / "lamp.sss").write_text(text, encoding="utf-8")
    built = Chain(
        material_of(
            [MaterialSection("surface", "lamp.sss"), MaterialSection("translucency", "wrap_lighting")], str(tmp_path)
        )
    )
    surface = points(small("torus"))
    lights = [surface.light(from_afar(0.0, 0.0, 1.0)), surface.light(from_afar(0.0, 0.6, -0.8))]
    first, second = built.run(surface.inputs, lights)
    assert built.run(surface.inputs, lights[:1])[0] == pytest.approx(first)
    assert built.run(surface.inputs, lights[1:])[0] == pytest.approx(second + np.array([[0.25], [0.0], [0.0]]))
    for light, result, more in ((lights[0], first, 0.25), (lights[1], second, 0.0)):
        facing = (surface.inputs["N"] * light["L"]).sum(axis=0)
        wrapped = np.maximum(np.maximum((facing + 0.5) / 1.5, 0.0) - np.maximum(facing, 0.0), 0.0)
        assert result[0] == pytest.approx(wrapped + more, abs=1e-12)


def test_the_text_of_a_chain_lists_its_stages() -> None:
    stages = [
        MaterialSection("thickness", "march_light", (("steps", 5), ("reach", 1e-5)), ("steps",), (("sdf", "a.sss:b"),)),
        MaterialSection(
            "surface", "base_color", (("tint", [1.0, 0.5, 1e7, np.float64(1.0)]), ("on", True), ("a", 'b"\n'))
        ),
    ]
    assert material_text("mine", stages, 'A "title"', "doc").splitlines() == [
        "[material]",
        'name = "mine"',
        'title = "A \\"title\\""',
        'doc = "doc"',
        "",
        "[[thickness]]",
        'technique = "march_light"',
        'bind = { sdf = "a.sss:b" }',
        "steps = { value = 5, fixed = true }",
        "reach = 1e-05",
        "",
        "[[surface]]",
        'technique = "base_color"',
        "tint = [1.0, 0.5, 1e+07, 1.0]",
        "on = true",
        'a = "b\\" "',
    ]


# --- the inputs of a scene ---


def test_the_mean_chord_of_a_ball_is_four_thirds_of_its_radius() -> None:
    scene = replace(small("cube"), geometry=Ball(0.6, scale=1.5))
    assert scene_inputs.mean_chord(scene) == pytest.approx(np.full(points(scene).count, 4.0 / 3.0 * 0.9), rel=2e-3)


def test_each_point_reads_its_own_texel() -> None:
    scene = small("bracket")
    scene_data, chord = scene_inputs.of_scene(scene), scene_inputs.mean_chord(scene)
    uv = scene_data.inputs["uv"]
    read = {name: scene_data.textures[name].sample(uv)[0] for name in scene_data.textures if name.endswith("_texture")}
    assert read["thickness_texture"] == pytest.approx(chord / chord.max())
    assert read["thinness_texture"] == pytest.approx(1.0 - chord / chord.max())
    assert read["transmittance_texture"] == pytest.approx(np.exp(-chord / np.median(chord)))


def thickness_error(scene: MeasuredScene, *names: str, **settings: int) -> float:
    """The error of a thickness technique on a scene, without a fit."""
    requests = candidate(*names, "shown_thickness", role="thickness", settings=tuple(settings.items()))
    point = measure.measure_candidate(
        requests, FitResult({}, (1.0, 1.0, 1.0), (0.0, 0.0, 0.0), 0.0), [View("own", scene)]
    )
    return float(point["error"]["value"])


def test_the_exact_length_has_no_error() -> None:
    for name in ("cube", "bracket", "torus"):
        assert thickness_error(small(name), "exact_thickness") < 1e-9


def test_a_depth_map_counts_gaps_as_matter() -> None:
    # the bias of the depth map is 0.01, and a texel is 1/200 of the body
    assert thickness_error(small("cube"), "depth_map_thickness") < 0.1
    assert thickness_error(small("bracket"), "depth_map_thickness") > 0.25


def test_lights_without_matter_in_their_way_give_no_thickness_problem() -> None:
    scene = small("inlay_plate")
    lit = replace(scene, medium=Medium("m", (1.0,) * 3, (1.0,) * 3), lights=(Light(None, (0.0, 0.0, 1.0), (1.0,) * 3),))
    with pytest.raises(SssgenError, match="no light passes through the body of 'inlay_plate'"):
        problem.thickness_problem(lit)


@pytest.mark.parametrize(
    ("names", "values"),
    [
        (("exact_thickness", "beer_lambert", "lobe_gdc2011"), {"power": 2.0}),
        (("preintegrated_skin",), {"millimetres_per_unit": 3.0}),  # reads a curvature of each point, for every light
    ],
)
def test_lights_in_one_call_equal_separate_calls(
    cube: View, tmp_path: Path, names: tuple[str, ...], values: dict[str, float]
) -> None:
    scene = small("capsule")
    fit_problem = problem.translucency_problem(scene, synthetic_view(scene).references)
    assert fit_problem is not None and len(fit_problem.parts) == 2
    built = chain(candidate(*names), View("own", scene), tmp_path)
    together = fit_problem.values(built, values)
    alone = []
    for part in fit_problem.parts:
        built.set({**part.values, **values}, part.textures)
        alone.append(built.run(part.inputs, [part.light])[0])
    assert together == pytest.approx(np.concatenate(alone, axis=1)[:, fit_problem.keep] * fit_problem.gain)
    # the thinned problem has the values of some of the lanes
    thinned = fit_problem.thin_out(10)
    assert thinned.target.shape == (3, 10)
    chosen = [int(np.flatnonzero((fit_problem.target == lane[:, None]).all(axis=0))[0]) for lane in thinned.target.T]
    assert thinned.values(built, values) == pytest.approx(together[:, chosen])


def test_colours_of_all_lights_are_added() -> None:
    scene = small("capsule")
    view = synthetic_view(scene)
    separate, whole = (problem.material_problem(scene, view.references, summed) for summed in (False, True))
    count = points(scene).count
    by_light = (separate.target / separate.gain).reshape(3, 2, count)
    colors = np.array([light.color for light in scene.lights]).T[..., None]
    assert whole.target / whole.gain == pytest.approx((by_light * colors).sum(axis=1))
    assert np.percentile(whole.target.max(axis=0), 99.0) == pytest.approx(problem.WHITE)
    assert whole.noise / whole.gain == pytest.approx(1e-3 * np.sqrt((colors**2).sum(axis=1)) * np.ones((3, count)))


def test_shadowed_points_get_no_light_from_the_front() -> None:
    body_of = Union((Box(size=(2.0, 0.2, 2.0)), Ball(0.4, position=(0.0, 0.9, 0.0))))  # a ball over a board
    scene = replace(small("bracket"), geometry=body_of, lights=(Light(None, (0.0, 1.0, 0.0), (1.0, 1.0, 1.0)),))
    scene = replace(scene, camera=Camera((0.0, 2.5, 3.0), (0.0, 0.0, 0.0), 40.0), size=(24, 24))
    references = synthetic_view(scene).references
    fit_problem = problem.material_problem(scene, references, False)
    surface = points(scene)
    direction = np.array(scene.lights[0].direction)
    facing = surface.inputs["N"].T @ direction > 0.05
    shaded = fit_problem.lambert[0] == 0.0
    beyond = thickness(
        scene.geometry, (surface.inputs["P"] + 1e-3 * surface.inputs["N"]).T, np.tile(direction, (surface.count, 1))
    )
    assert (facing & shaded).any() and (facing & ~shaded).any()
    assert (beyond[facing & shaded] > 1e-3).all() and (beyond[facing & ~shaded] < 1e-3).all()
    x, y, z = surface.inputs["P"]
    board = np.isclose(y, 0.1)
    assert (shaded[board] == (np.hypot(x, z)[board] < 0.4)).all()


# --- errors, and expected results ---


def test_a_chain_with_nan_has_failed(cube: View, monkeypatch: pytest.MonkeyPatch) -> None:
    chosen = candidate("wrap_lighting")
    values = Problem.values

    def broken(self: Problem, built: Chain, inputs: Mapping[str, Any]) -> Array:
        result = values(self, built, inputs)
        result[1, :4] = np.nan
        return result

    monkeypatch.setattr(Problem, "values", broken)
    point = measure.measure_candidate(chosen, FitResult({}, (1.0,) * 3, (0.0,) * 3, 0.0), [cube])
    assert point["failed"] == f"4 of {points(cube.scene).count} points are not finite"


def test_the_published_seed_3_is_ambient_light_times_transmittance(
    cube: View, training: tuple[View, ...], tmp_path: Path
) -> None:
    (ice,) = (item for item in candidates.materials([]) if item.name == "Unity ice")
    built = chain(ice, cube, tmp_path)
    fit_problem = measure.problem_of("material", cube)
    assert fit_problem is not None
    values = {"distortion": 0.3, "power": 2.0, "ambient": 0.2, "attenuation": 0.7}
    loud, silent = (fit_problem.values(built, {**values, "scale": scale}) for scale in (20.0, 0.0))
    assert (loud == silent).all() and (silent > 0.0).any()
    part = fit_problem.parts[0]
    through = part.textures["transmittance_texture"].sample(part.inputs["uv"])[0]
    # the scene has only one light
    assert silent == pytest.approx(fit_problem.gain * part.color * (0.2 * 0.7 * through), rel=1e-6)
    # the point of the chart does not depend on the scale either
    result = measure.fit_candidate(ice, training)
    mute = result._replace(parameters={**result.parameters, "scale": (0.0,)})
    with_lobe, without = (measure.measure_candidate(ice, fitted, [cube]) for fitted in (result, mute))
    assert with_lobe["error"] == without["error"]
    # the original lobe, which the source cites, depends on the scale
    other = chain(candidate("transmittance_map", "lobe_gdc2011"), cube, tmp_path)
    assert np.abs(fit_problem.values(other, {**values, "scale": 20.0}) - silent).max() > 0.1


def test_seed_0_mistakes_a_cube_and_a_march_to_the_light_does_not() -> None:
    # both are fitted only to the training scenes
    cube = small("cube")
    fitted_to = [View(scene.name, replace(scene, size=SIZE)) for scene in references.training_scenes(cube)]
    error: dict[str, float] = {}
    for option in candidates.thickness():
        if option.name == "cheap_sss_thinness" or option.label == "march_light, 16 steps":
            result = measure.measure_candidate(option, measure.fit_candidate(option, fitted_to), [View("own", cube)])[
                "error"
            ]["value"]
            error[option.name] = min(error.get(option.name, np.inf), result)
    assert error["march_light"] < 0.2
    assert error["cheap_sss_thinness"] > 0.6


def parallax_errors(name: str) -> dict[str, float]:
    """The errors on a scene with an inlay, by technique, in depths."""
    scene = small(name)
    plate = View("plate", replace(references.plate(scene), size=SIZE))
    results = {}
    for option in candidates.coordinates():
        point = measure.measure_candidate(option, measure.fit_candidate(option, [plate]), [View("own", scene)])
        results[option.name] = point["error"]["max"]
    return results


def test_seed_4_corrected_is_exact_on_a_plane_and_nearly_on_a_ball() -> None:
    plane, ball = parallax_errors("inlay_plate"), parallax_errors("inlay_ball")
    assert plane["parallax_refracted"] < 1e-6
    assert plane["parallax_straight"] > 0.05
    assert plane["subsurface_parallax"] < 1e-6  # with the reciprocal of the index, which the source does not state
    assert plane["none"] > 1.0
    assert 1e-3 < ball["parallax_refracted"] < ball["none"]


@pytest.mark.parametrize("name", ["inlay_ball", "inlay_torus"])
def test_parallax_by_curvature_is_more_accurate_on_curved_bodies_at_little_cost(name: str) -> None:
    """At a tenth of the radius: less than a twentieth of the error at less than twice the cost."""
    scene = small(name)
    plate = View("plate", replace(references.plate(scene), size=SIZE))
    points = {}
    for option in candidates.coordinates():
        if option.name.startswith("parallax_"):
            fit = measure.fit_candidate(option, [plate])
            points[option.name] = measure.measure_candidate(option, fit, [View("own", scene)])
    for flat, curved in (
        ("parallax_refracted", "parallax_curved"),
        ("parallax_refracted", "parallax_curved_map"),
        ("parallax_orthonormal", "parallax_curved_orthonormal"),
    ):
        assert points[curved]["error"]["value"] < 0.05 * points[flat]["error"]["value"]
        assert points[curved]["cost"]["value"] < 2.0 * points[flat]["cost"]["value"]
        assert points[flat]["error"]["value"] > 0.05


@pytest.mark.slow
def test_light_transport_ranks_the_techniques() -> None:
    # with references by light transport, exact thickness with a lobe is better than no chain and the Unity ice lobe
    pytest.importorskip("mitsuba")
    cube = small("cube")

    def view(scene: MeasuredScene) -> View:
        scene = replace(scene, size=SIZE)
        return View(
            scene.name, scene, tuple(references.transport(scene, n, 64, 0) for n in range(len(scene.lights))), "64 0"
        )

    fitted_to, own = [view(scene) for scene in references.training_scenes(cube)], [view(cube)]
    listed = [candidate for candidate in candidates.materials([]) if candidate.name in ("none", "Unity ice")]
    listed.append(candidate("exact_thickness", "absorption_tint"))
    error = {
        scene.name: measure.measure_candidate(scene, measure.fit_candidate(scene, fitted_to), own)["error"]["value"]
        for scene in listed
    }
    assert error["absorption_tint"] < 0.8 * min(error["none"], error["Unity ice"])


def test_a_view_keeps_the_size_and_the_lanes_of_its_pixels() -> None:
    scene = replace(small("torus"), size=(20, 10), camera=Camera((0.0, 0.0, 3.4), (0.0, 0.0, 0.0), 26.0))
    surface = points(scene)
    picture = surface.picture(surface.inputs["P"], -9.0)
    assert picture.shape == (10, 20, 3)
    assert (picture != -9.0).all(axis=2).sum() == surface.count
    values = picture[::-1][surface.valid].T
    assert (values == surface.inputs["P"]).all()
    heights = [row[row[:, 1] != -9.0, 1].mean() for row in picture if (row[:, 1] != -9.0).any()]
    assert len(heights) > 4 and heights == sorted(heights, reverse=True)  # row 0 is at the top
    away = np.array([[0.0], [0.0], [3.4]]) - surface.inputs["P"]
    assert surface.inputs["V"] == pytest.approx(away / np.linalg.norm(away, axis=0))


# --- errors of scenes that cannot be measured ---


def test_scenes_without_visible_light_are_refused() -> None:
    plate = small("inlay_plate")
    with pytest.raises(SssgenError, match="the camera of 'inlay_plate' does not see its body"):
        points(replace(plate, camera=Camera((0.0, 0.0, 3.0), (0.0, 0.0, 6.0), 30.0)))
    assert plate.inlay is not None
    deep = replace(small("inlay_ball"), geometry=Ball(0.2), inlay=replace(plate.inlay, depth=0.5))
    with pytest.raises(SssgenError, match="no ray meets the inlay of 'inlay_ball'"):
        problem.coordinates_problem(deep)
    cube = small("cube")
    dark = View("own", cube, tuple((np.zeros((3, points(cube).count)),) * 2 for _ in cube.lights), "dark")
    through = candidate("wrap_lighting", role="translucency")
    with pytest.raises(SssgenError, match="no light passes through the bodies for fitting"):
        measure.fit_candidate(through, [dark])
    with pytest.raises(SssgenError, match="no light passes through the body of 'cube'"):
        measure.measure_candidate(through, FitResult({}, (1.0,) * 3, (0.0,) * 3, 0.0), [dark])


def test_fitting_in_two_steps_equals_fitting_the_chain(training: tuple[View, ...]) -> None:
    whole = candidate("march_light", "beer_lambert", "lobe_exp2", settings=(("steps", 4),))
    before = {"reach": (0.8,)}
    result = measure.fit_candidate(whole, training[:2], before)
    assert result.parameters["reach"] == (0.8,) and set(result.parameters) > {"attenuation_distance", "power"}
    squares = []
    for view in training[:2]:
        fit_problem = measure.problem_of("material", view, summed=False)
        assert fit_problem is not None
        fit_problem = fit_problem.thin_out(fit.LANES)
        with tempfile.TemporaryDirectory() as folder:
            values = fit_problem.values(chain(whole, view, Path(folder)), fit.chain_values(result.parameters))
        target, weight = fit_problem.fit_target
        squares.append((weight * (result.apply(values, fit_problem) - target) ** 2).mean())
    assert np.sqrt(np.mean(squares)) == pytest.approx(result.error, rel=1e-6)


def test_cost_counts_steps_and_no_output(tmp_path: Path) -> None:
    view = View("own", small("cube"))

    def cost(*names: str, **counts: int) -> float:
        built = chain(candidate(*names, role="thickness", settings=tuple(counts.items())), view, tmp_path)
        return float(measure.static_cost(built).weight)

    four, eight, twelve = (cost("march_light", "shown_thickness", steps=steps) for steps in (4, 8, 12))
    assert 0.0 <= cost("exact_thickness", "shown_thickness") < 0.2 * four
    assert twelve - eight == eight - four > 0.0
    assert measure.static_cost(None).weight == 0.0
    march = chain(candidate("march_light", "shown_thickness", settings=(("steps", 8),)), view, tmp_path)
    assert 8 <= measure.static_cost(march).distance_evaluations <= 12


# --- lights and surfaces of scenes ---


def test_references_with_a_surface_are_traced_for_all_lights_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        references, "readings", functools.partial(references.readings, rays=4000)
    )  # 120,000 take seconds
    scene = small("capsule")
    assert scene.medium is not None and len(scene.lights) == 2
    refracting = replace(scene, medium=replace(scene.medium, ior=1.4))
    lamp = replace(scene, lights=(Light((0.5, 1.5, -2.0), None, (1.0, 1.0, 1.0)),))
    assert [len(references.items([case])) for case in (scene, refracting, lamp)] == [2, 1, 1]
    results = [references.trace(case, 16, 0) for case in (refracting, lamp)]
    by_scene = references.by_scene([refracting, lamp], results)
    assert [len(by_scene[case.key]) for case in (refracting, lamp)] == [2, 1]
    for mean, error in (*results[0], *results[1]):
        assert mean.shape == (3, points(refracting).count) and mean.max() > 0.0 and (error > 0.0).any()


def test_a_point_light_has_its_direction_and_fall_off_at_each_point() -> None:
    place = (0.4, 1.2, -2.5)
    scene = replace(small("cube"), lights=(Light(place, None, (1.0, 0.5, 0.25)),))
    visible = points(scene)
    count = visible.count
    whole = problem.material_problem(scene, [(np.ones((3, count)), np.zeros((3, count)))], summed=True)
    (part,) = whole.parts
    way = np.array(place)[:, None] - visible.inputs["P"]
    distance = np.linalg.norm(way, axis=0)
    assert part.light["L"] == pytest.approx(way / distance)
    assert part.color == pytest.approx(np.array([[1.0], [0.5], [0.25]]) / distance**2)
    facing = np.maximum(np.einsum("cn,cn->n", visible.inputs["N"], way / distance), 0.0)
    assert whole.lambert / whole.gain == pytest.approx(part.color * facing)  # the cube has no shadow on itself
    # its depth map and the exact length agree away from edges
    depths = whole.thin_out(10).parts
    assert depths and np.isfinite(part.values["exact_length"]).all()
    matrix = part.values["light_matrix"][..., 0].T
    projected = matrix @ np.vstack([visible.inputs["P"], np.ones(count)])
    assert (projected[:2] / projected[3] > 0.0).all() and (projected[:2] / projected[3] < 1.0).all()
    far_light = Light((40.0 * place[0], 40.0 * place[1], 40.0 * place[2]), None, (1.0, 1.0, 1.0))
    x, y, z = np.array(place) / np.linalg.norm(place)
    near, far = (
        scene_inputs.of_light(scene, light).values["exact_length"] for light in (far_light, from_afar(x, y, z))
    )
    assert near == pytest.approx(far, abs=0.05)


def test_an_environment_is_many_lights_with_its_total() -> None:
    for environment in (Environment((0.5, 0.25, 1.0)), Environment((2.0, 2.0, 2.0))):
        lights = environment.lights()
        assert len(lights) == 32
        # under an even sky a Lambert surface shows the sky: the sum over the lights of E cos / π is L
        directions, colors = (np.array([getattr(light, key) for light in lights]) for key in ("direction", "color"))
        for normal in (np.array([0.0, 1.0, 0.0]), np.array([0.6, -0.8, 0.0])):
            shown = (np.maximum(directions @ normal, 0.0)[:, None] * colors).sum(axis=0)
            assert shown == pytest.approx(np.array(environment.color), rel=0.03)
        assert colors.sum(axis=0) == pytest.approx(4.0 * np.array(environment.color), rel=1e-6)


def test_a_picture_of_the_surroundings_has_its_directions(tmp_path: Path) -> None:
    pixels = np.zeros((64, 128, 3))
    pixels[:4] = [3.0, 0.0, 0.0]  # up
    pixels[30:34, 62:66] = [0.0, 5.0, 0.0]  # +x
    pixels[30:34, 94:98] = [0.0, 0.0, 7.0]  # +z
    np.save(tmp_path / "sky.npy", np.flipud(pixels))
    surroundings = "[environment]\nfile = 'sky.npy'\nintensity = 2\n"
    text = '[medium]\npreset = "wax"\nior = 1.3\n[geometry]\nkind = "ball"\n' + surroundings
    scene = measured_scene.of_scene(parse_scene(text, tmp_path / "s.toml"), "s.toml")
    assert scene.environment is not None and scene.lit_by == ["picture of the surroundings"]
    light = scene.environment.sky()(np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]]))
    assert light == pytest.approx(np.array([[6.0, 0.0, 0.0], [0.0, 10.0, 0.0], [0.0, 0.0, 14.0], [0.0, 0.0, 0.0]]))
    for light_from in scene.environment.lights():
        assert light_from.direction is not None
        axis = np.argmax(light_from.color)
        assert light_from.direction[{0: 1, 1: 0, 2: 2}[int(axis)]] > 0.97
    np.save(tmp_path / "sky.npy", pixels)
    assert measured_scene.of_scene(parse_scene(text, tmp_path / "s.toml"), "s.toml") != scene


def test_an_environment_is_part_of_whole_materials() -> None:
    scene = replace(small("cube"), environment=Environment((1.0, 1.0, 1.0)), lights=())
    count = points(scene).count
    reference = (np.full((3, count), 0.5), np.full((3, count), 0.01))
    whole = problem.material_problem(scene, [reference], summed=True)
    assert len(whole.parts) == 32 and whole.target.shape == (3, count)
    # a convex body does not shadow itself: its Lambert light is that of the sky
    assert whole.lambert / whole.gain == pytest.approx(1.0, rel=0.05)
    assert problem.translucency_problem(scene, [reference]) is None
