"""Charts: each point is measured once, results do not depend on the executor, records are valid, errors readable."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from sssgen.cli.chart import announce, summary
from sssgen.cli.main import main
from sssgen.jobs import executor
from sssgen.jobs import work_items as work
from sssgen.jobs.executor import Failure
from sssgen.lab.chart import charting as chart
from sssgen.lab.chart.charting import Settings
from sssgen.lab.chart.picked_material import stages_of
from sssgen.lab.chart.record import LEAST, check_record, hypervolume, hypervolumes, to_csv, to_json
from sssgen.lab.gpu import chart_times as chart_gpu
from sssgen.lab.measure import candidates
from sssgen.lab.measure import measurement as measure
from sssgen.lab.measure import scene_references as references
from sssgen.run.backends import Backend
from sssgen.scene.measured import measured_scene
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.scene_body import Body, body
from sssgen.support import cache
from sssgen.support.diagnostics import SssgenError

pytest.importorskip("scipy")
pytest.importorskip("mitsuba")
pytest.importorskip("flip_evaluator")

SAMPLES = 8


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    work.code_stamp.cache_clear()  # the source files may change while the tests run
    work._package_digest.cache_clear()
    in_cache(tmp_path / "cache", monkeypatch)
    yield
    cache._folder = None


def in_cache(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SSSGEN_CACHE", str(folder))
    monkeypatch.setattr(cache, "_folder", None)


@pytest.fixture(autouse=True)
def few_candidates(monkeypatch: pytest.MonkeyPatch) -> None:
    """Small pictures, three settings of thickness techniques, and the materials that use them."""
    monkeypatch.setattr(references, "TRAINING_SIDE", 8)
    monkeypatch.setattr(measured_scene, "SIDE", 8)
    lengths, lights, whole = candidates.thickness, candidates.translucency, candidates.materials
    views, stored_views = candidates.view_thickness, ("back_face_thickness", "march_view, 3 steps")
    monkeypatch.setattr(
        candidates, "view_thickness", lambda: [candidate for candidate in views() if candidate.label in stored_views]
    )
    stored_lengths = ("constant_thickness", "march_light, 4 steps", "march_light, 6 steps")
    stored = (
        "none",
        "Unity ice",
        "wrap_lighting",
        "march_light → absorption_tint",
        "constant_thickness → absorption_tint",
        "march_view → interior_octaves",
    )
    monkeypatch.setattr(
        candidates, "thickness", lambda: [candidate for candidate in lengths() if candidate.label in stored_lengths]
    )
    monkeypatch.setattr(
        candidates,
        "translucency",
        lambda *paths: [candidate for candidate in lights(*paths) if candidate.name in stored],
    )
    monkeypatch.setattr(
        candidates, "materials", lambda *inputs: [candidate for candidate in whole(*inputs) if candidate.name in stored]
    )


def settings(**more: Any) -> Settings:
    return Settings(SAMPLES, **{"processes": 0, **more})


def cube() -> MeasuredScene:
    return measured_scene.load("cube")


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A cache folder for tests that need the results of `cube` and not their measurement."""
    return tmp_path_factory.mktemp("measured")


@pytest.fixture
def cube_measured(measured: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """The record of `cube`. The first test that asks measures it; each has its own copy of the cache."""
    in_cache(measured, monkeypatch)
    record = chart.chart_record([cube()], settings())
    in_cache(shutil.copytree(measured, tmp_path / "copy"), monkeypatch)
    return record


def record_titles(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The titles of the items that are computed from now on, in this process."""
    ran: list[str] = []
    real = executor.execute

    def execute(task: Any) -> bytes:
        ran.append(task.name)
        return real(task)

    monkeypatch.setattr(executor, "execute", execute)
    return ran


def test_measurements_are_cached(
    cube_measured: dict[str, Any], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    ran = record_titles(monkeypatch)
    scene, first = cube(), cube_measured
    assert to_json(chart.chart_record([scene], settings())) == to_json(first)
    assert not ran
    # without the file of the scene, the stored results of the items are used
    (stored,) = (tmp_path / "copy").glob("chart-*.json")
    stored.unlink()
    assert to_json(chart.chart_record([scene], settings())) == to_json(first)
    assert not ran
    # a damaged file is replaced
    stored.write_bytes(b"{")
    assert to_json(chart.chart_record([scene], settings())) == to_json(first)
    assert not ran
    # an interrupted run continues
    stored.unlink()
    results = sorted((tmp_path / "copy" / "lab" / "results").glob("*/*"))
    assert len(results) > 20
    lost = results[::5]
    for path in lost:
        path.unlink()
    assert to_json(chart.chart_record([scene], settings())) == to_json(first)
    assert 0 < len(ran) <= len(lost)
    # a chart with another seed is measured
    del ran[:]
    chart.chart_record([scene], settings(seed=1, roles=("thickness",)))
    assert ran


@pytest.mark.slow
def test_roles_without_light_need_no_reference(monkeypatch: pytest.MonkeyPatch) -> None:
    ran = record_titles(monkeypatch)
    points = chart.chart_record([cube()], settings(roles=("thickness",)))["points"]
    assert ran and not any("reference" in title for title in ran)
    chart.chart_record([cube()], settings(roles=("thickness", "translucency")))
    assert (
        sum("reference" in title for title in ran) == 2 + 19
    )  # the two views and the training views, each with a light
    assert [point["label"] for point in points] == [candidate.label for candidate in candidates.thickness()]


@pytest.mark.slow
def test_results_do_not_depend_on_processes(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    scenes, roles = [cube(), measured_scene.load("inlay_ball")], ("coordinates", "translucency")
    expected = to_json(chart.chart_record(scenes, settings(roles=roles)))
    in_cache(tmp_path / "other", monkeypatch)
    measure._problems.clear()
    assert to_json(chart.chart_record(scenes, settings(roles=roles, processes=2))) == expected
    assert json.loads(expected)["points"]


def test_a_record_is_valid_and_complete(cube_measured: dict[str, Any]) -> None:
    scenes = [cube(), measured_scene.load("inlay_plate")]
    record = chart.chart_record(scenes, settings())
    assert check_record(record) == record == json.loads(to_json(record))
    assert [scene["name"] for scene in record["scenes"]] == ["cube", "inlay_plate"]
    assert record["scenes"][0]["medium"]["name"] == "marble" and "medium" not in record["scenes"][1]
    assert record["scenes"][0]["fitted_to"] == ["ball", "bar", "ball", "bar", "slab"]
    assert (record["record"]["samples"], record["record"]["seed"]) == (SAMPLES, 0)
    assert record["record"]["versions"]["mitsuba"]
    roles = {(point["scene"], point["role"]) for point in record["points"]}
    assert roles == {
        ("cube", "thickness"),
        ("cube", "view_thickness"),
        ("cube", "translucency"),
        ("cube", "material"),
        ("inlay_plate", "coordinates"),
    }
    for point in record["points"]:
        assert not point["failed"] and point["error"]["low"] <= point["error"]["value"] <= point["error"]["high"]
        assert set(point["views"]) == {"own", "held out"}
        assert ("flip" in point["error"]) == (point["role"] == "material")
    assert len(to_csv(record).splitlines()) == 1 + len(record["points"])
    # a point is on the front if no other point dominates it; errors below LEAST are rounding, and equal
    error_of = {id(entry): max(entry["error"]["value"], LEAST) for entry in record["points"]}
    for point in record["points"]:
        rivals = [
            other for other in record["points"] if (other["scene"], other["role"]) == (point["scene"], point["role"])
        ]
        cost, error = point["cost"]["value"], error_of[id(point)]
        beaten = any(
            rival["cost"]["value"] <= cost and error_of[id(rival)] <= error
            and (rival["cost"]["value"], error_of[id(rival)]) != (cost, error)
            for rival in rivals
        )  # fmt: skip
        assert point["front"] == (not beaten), point["label"]
    # expected: no chain has the least cost, more steps are more accurate, no parallax has the largest error
    error = {(entry["role"], entry["label"]): entry["error"]["value"] for entry in record["points"]}
    assert error["thickness", "march_light, 6 steps"] < error["thickness", "constant_thickness"]
    assert error["coordinates", "parallax_refracted"] < 1e-6
    assert error["coordinates", "parallax_straight"] > 0.01
    message = summary(record)
    assert "cube, material:" in message and "inlay_plate, coordinates:" in message


def test_hypervolumes_of_the_library_and_of_the_baselines() -> None:
    def point(cost: float, error: float, baseline: bool, name: str = "a") -> dict[str, Any]:
        return {"scene": "s", "role": "material", "name": name, "cost": {"value": cost}, "error": {"value": error},
                "baseline": baseline, "failed": ""}  # fmt: skip

    points = [
        point(10.0, 0.5, True),
        point(10.0, 0.1, False),
        point(1.0, 0.9, False, "none"),
        point(100.0, 0.05, False),
    ]
    (result,) = hypervolumes(points)
    assert result["reference_point"] == pytest.approx([110.0, 1.0])
    assert result["ours"] == pytest.approx(hypervolume(points[1:], [110.0, 1.0]))
    assert result["baselines"] == pytest.approx(hypervolume([points[0], points[2]], [110.0, 1.0]))
    assert result["ours"] > result["baselines"] > 0.0


def test_failures_are_named() -> None:
    with pytest.raises(SssgenError) as caught:
        chart.results_of([executor.Item("executor_items:fail", ("said",), "fit this")], settings())
    assert "fit this: the scene has no light" in str(caught.value)
    assert caught.value.diagnostics[0].hint == "add one"
    names = ("one", "two", "two", "three")
    again = [executor.Item("executor_items:fail", ("said",), name) for name in names]
    with pytest.raises(SssgenError) as caught:
        chart.results_of([*again, executor.Item("executor_items:fail", ("x",), "that")], settings())
    messages = [diagnostic.message for diagnostic in caught.value.diagnostics]
    assert len(messages) == 2 and messages[0].startswith("one and 2 more: the scene has no light")
    assert messages[1].startswith("that: ValueError: no such thing")
    assert isinstance(executor.run([executor.Item("executor_items:fail", ("x",), "that")], processes=0)[0], Failure)


def test_equal_scenes_are_measured_once(monkeypatch: pytest.MonkeyPatch) -> None:
    ran = record_titles(monkeypatch)
    plate = measured_scene.load("inlay_plate")
    chart.chart_record([plate, replace(plate)], settings())
    assert ran and len(set(ran)) == len(ran)


# --- all candidates ---


def test_every_technique_with_a_reference_is_a_candidate(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.undo()
    lengths, views = (
        [length for length in every if not length.settings or length.settings[0][1] == 4]
        for every in (candidates.thickness(), candidates.view_thickness())
    )
    paths = list(filter(candidates.fits_path, lengths))
    whole = candidates.materials(lengths, views, paths)
    for role, result in (("thickness", [*candidates.thickness(), *candidates.view_thickness()]),
                        ("translucency", candidates.translucency()),
                        ("coordinates", candidates.coordinates())):  # fmt: skip
        assert {candidate.name for candidate in result} - {"none"} == {
            technique.name for technique in candidates.of_role(role)
        }
        keys = {(one.techniques, one.settings, one.path, one.path_settings) for one in result}
        assert len(keys) == len(result)
        assert len({(candidate.role, candidate.label) for candidate in result}) == len(result)
        for candidate in result:
            assert candidate.baseline == any(candidates.load(name).baseline for name in candidate.techniques)
    assert {candidate.name for candidate in whole if candidate.baseline} == set(candidates.baselines())
    assert len({candidate.label for candidate in whole}) == len(whole)
    for candidate in whole:
        # each stage reads the result of the previous one
        inputs = ""
        for name in candidate.techniques:
            technique = candidates.load(name)
            assert candidates.quantity_read(technique) in ("", inputs), candidate.label
            inputs = technique.function.quantity or inputs


def test_a_technique_that_measures_inside_has_every_view_and_every_path(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.undo()
    views = [view for view in candidates.view_thickness() if view.settings in ((), (("steps", 4),))]
    paths = [path for path in filter(candidates.fits_path, candidates.thickness()) if path.settings != (("steps", 4),)]
    inside = [whole for whole in candidates.materials([], views, paths) if whole.path]
    by_path = {(whole.path, whole.path_settings) for whole in inside}
    assert by_path == {(path.name, path.settings) for path in paths} and len(by_path) > 10
    for technique in ("interior_sample", "interior_octaves"):
        chains = {whole.techniques for whole in inside if whole.techniques[-1] == technique}
        assert chains == {(*view.techniques[:-1], technique) for view in views}
        # conversions of lengths along the eye's ray only follow lengths without a direction
        firsts = {chain[0] for chain in chains}
        assert {"back_face_thickness", "march_view", "thickness_map"} <= firsts and "march_light" not in firsts
    assert len({whole.label for whole in inside}) == len(inside)
    (one,) = (
        whole for whole in inside if whole.label == "march_view, 4 steps → interior_octaves by march_light, 8 steps"
    )
    assert (dict(one.settings), one.path, dict(one.path_settings)) == ({"steps": 4}, "march_light", {"steps": 8})
    # the counts of the two marches are apart, and the body sets the reach of both
    view, light = one.stages(Body("sphere", span=1.5))
    assert dict(view.values) == {"steps": 4, "reach": 1.5} and dict(light.values) == {"steps": 8, "reach": 1.5}
    assert light.bind == (("light_path", "march_light"), ("body_distance", "sphere"))


def test_more_expensive_lengths_with_the_same_requirements_are_used_if_they_halve_the_error(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.undo()
    rigid, depth = ["rigid"], ["depth-map"]
    layers = [*depth, "depth-layers"]
    rows = [("march_light, 4 steps", 0.5, rigid), ("march_light_traced, 4 steps", 0.2, rigid),
            ("march_light, 16 steps", 0.11, rigid), ("depth_map_path", 0.6, depth), ("depth_layers_path", 0.6, layers),
            ("constant_thickness", 0.1, [])]  # fmt: skip
    points = [
        {
            "role": "thickness", "label": label, "chain": [label], "training_error": error, "requires": requires,
            "cost": {"value": cost},
        }
        for cost, (label, error, requires) in enumerate(rows)
    ]  # fmt: skip
    # constant_thickness is no function of a point
    labels = [path.label for path in chart.useful_paths(points)]
    assert labels == ["march_light, 4 steps", "march_light_traced, 4 steps", "depth_map_path", "depth_layers_path"]


def test_a_record_restores_its_candidates(cube_measured: dict[str, Any]) -> None:
    record = json.loads(to_json(cube_measured))
    (point,) = (
        point
        for point in record["points"]
        if point["name"] == "march_view → interior_octaves" and point["path_settings"] == {"steps": 4}
    )
    assert point["label"] == "march_view, 3 steps → interior_octaves by march_light, 4 steps"
    candidate = chart.candidate_of(point)
    assert (candidate.path, dict(candidate.path_settings)) == ("march_light", {"steps": 4})
    assert (point["requires"], point["bytes"]) == (["rigid"], 0)
    row = next(line for line in to_csv(record).splitlines() if point["label"] in line)
    assert ",march_light," in row and ",rigid,0," in row
    # the material of the point has the medium's parameters, and binds the path
    shape = body(cube().geometry)
    stages = stages_of(point, shape, cube().medium)
    values = dict(stages[-1].values)
    assert values["steps"] == 4 and values["reach"] == shape.span and dict(stages[0].values)["steps"] == 3
    assert values["extinction"] == pytest.approx(list(cube().medium.extinction))
    assert values["scattering_albedo"] == pytest.approx(list(cube().medium.albedo))
    assert ("light_path", "march_light") in stages[-1].bind
    for name, wrong in (("requires", ["sunshine"]), ("bytes", -1), ("path", 3)):
        with pytest.raises(SssgenError, match=name if name != "requires" else "requires 'sunshine'"):
            check_record({**record, "points": [{**point, name: wrong}]})


# --- costs on a GPU, computed from fixed times ---


def test_ranks_and_their_correlation() -> None:
    from scipy.stats import rankdata, spearmanr

    values = [3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0, 6.0, 5.0, 3.0]
    times = [1.0, 3.0, 2.0, 2.0, 7.0, 1.0, 8.0, 2.0, 8.0, 9.0]
    assert chart_gpu.ranks(values).tolist() == rankdata(values).tolist()
    points = [{"role": "material", "cost": {"value": a, "gpu_ratio": b}} for a, b in zip(values, times, strict=True)]
    points += [{"role": "thickness", "cost": {"value": 1.0, "gpu_ms": None}}] * 3
    assert chart_gpu.correlations(points) == {"material": pytest.approx(spearmanr(values, times).statistic)}


def test_gpu_times_as_costs() -> None:
    points = [{"cost": {"value": 10.0, "gpu_ms": 0.5}}, {"cost": {"value": 20.0, "gpu_ms": None}}]
    result = chart_gpu.by_gpu({"points": points, "record": {"software": False}})
    assert result["points"] == [{"cost": {"value": 0.5, "gpu_ms": 0.5, "static": 10.0}}]
    assert (result["cost"], result["cost_unit"]) == ("gpu", "ms at 1080p")


@pytest.mark.slow
def test_a_users_scene_is_timed(tmp_path: Path, backend: Callable[[str], Backend]) -> None:
    backend("gl")
    text = '[inlay]\ndepth = 0.1\n[geometry]\nkind = "box"\n[camera]\nposition = [0.5, 1.0, 3.0]\n'
    (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
    scene = measured_scene.load(str(tmp_path / "mine.toml"))
    record = chart.chart_record([scene], settings())
    timed = chart_gpu.with_gpu_cost(record, [scene], (32, 32), 2)
    assert timed["record"]["device"] and timed["record"]["size"] == [32, 32]
    for before, after in zip(record["points"], timed["points"], strict=True):
        cost = after["cost"]
        assert cost["value"] == before["cost"]["value"]
        assert cost["gpu_ratio"] > 0.0
        if not timed["record"]["software"]:
            assert cost["gpu_ms"] >= chart_gpu.LEAST and cost["gpu_ms_low"] <= cost["gpu_ms_high"]
    assert check_record(chart_gpu.by_gpu(timed))["cost"] == "gpu"


# --- the commands ---


def test_the_chart_command_writes_and_lists_its_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("matplotlib")
    expected = ["chart", "inlay_plate", "--samples", "8", "--processes", "1", "-o", str(tmp_path / "out")]
    assert main([*expected, "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["ok"] and {point["scene"] for point in report["points"]} == {"inlay_plate"}
    files = {Path(file).name for file in report["files"]}
    assert files == {path.name for path in (tmp_path / "out").iterdir()} and len(files) > 3
    assert main(expected) == 0
    assert all(f"{name}" in capsys.readouterr().out for name in ["inlay_plate, coordinates"])


@pytest.mark.slow
def test_a_chart_of_bytes_or_of_a_device(capsys: pytest.CaptureFixture[str]) -> None:
    expected = ["chart", "inlay_plate", "--samples", "8", "--processes", "1", "--json"]
    assert main([*expected, "--cost", "bytes", "--max-bytes", "0"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["cost_unit"] == "bytes baked" and report["conditions"]["max_bytes"] == 0
    assert {point["cost"]["value"] for point in report["points"]} == {1}
    assert main([*expected, "--device", "llvmpipe"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["cost_unit"] == "ns per pixel on llvmpipe, predicted"
    assert all(point["cost"]["static"] >= 1.0 for point in report["points"])


@pytest.mark.slow
def test_the_fit_command_shows_parameters(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["fit", "cube", "wrap_lighting", "--samples", "8", "--processes", "1"]) == 0
    output = capsys.readouterr().out
    assert "Marble cube, lit from behind: fitted" in output
    (line,) = (line for line in output.splitlines() if "wrap_lighting" in line)
    assert "wrap 0." in line or "wrap 1" in line
    assert "subsurface_color ×" in line and "none" not in output
    assert main(["fit", "cube", "wrap_lighting", "--samples", "8", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert [point["name"] for point in report["points"]] == ["wrap_lighting"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["chart", "cueb"], "did you mean 'cube'"),
        (["chart", "none.toml"], "none.toml"),
        (["chart", "cube", "--samples", "1"], "--samples 1 is not a number of samples"),
        (["chart", "cube", "--samples", "1000000"], "is not a number of samples"),
        (["chart", "cube", "--samples", "many"], "many"),
        (["chart", "cube", "--seed", "-1"], "--seed -1 is negative"),
        (["chart", "cube", "--device", "llvmpipe", "--cost", "bytes"], "are two costs"),
        (["chart", "cube", "--role", "thicknes"], "did you mean 'thickness'"),
        (
            ["chart", "cube", "--role", "colour"],
            "roles: coordinates, thickness, view_thickness, ",
        ),
        (["chart", "cube", "cube"], "two scenes are called 'cube'"),
        (["chart", "ice.toml"], "does not describe the medium of its body"),
        (["fit", "cube", "wrap_lightning"], "did you mean 'wrap_lighting'"),
        (["fit", "cueb"], "did you mean 'cube'"),
    ],
)
def test_errors_have_readable_messages(
    arguments: list[str],
    message: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("ice.toml").write_text('material = "ice"\n[geometry]\nkind = "ball"\n', encoding="utf-8")
    monkeypatch.setattr(chart, "run", lambda *_, **__: pytest.fail("it measures"))
    assert main(arguments) == 2
    output = capsys.readouterr().err
    assert message in output and "Traceback" not in output


def test_materials_select_their_thickness_technique(monkeypatch: pytest.MonkeyPatch) -> None:
    requests: list[Settings] = []

    def chart_record(_: Any, inputs: Settings) -> dict[str, Any]:
        requests.append(inputs)
        return {"points": [], "hypervolume": []}

    monkeypatch.setattr(chart, "chart_record", chart_record)
    for role in ("material", "coordinates,material", "translucency"):
        assert main(["chart", "cube", "--role", role]) == 0
    assert [inputs.roles for inputs in requests] == [
        ("thickness", "view_thickness", "material"),
            ("coordinates", "thickness", "view_thickness", "material"),
            ("translucency",),
    ]  # fmt: skip
    assert [inputs.samples for inputs in requests] == [512] * 3


def test_the_scenes_that_take_minutes_are_announced(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    scenes = [measured_scene.load(name) for name in ("cube", "torus", "inlay_plate")]
    monkeypatch.setattr(chart, "cached_points", lambda scene, _: {} if scene.name == "torus" else None)
    announce(scenes, settings())
    shown = capsys.readouterr()
    assert shown.err.startswith("measuring cube: minutes") and shown.out == ""  # an inlay takes seconds
    announce(scenes[1:], settings())
    assert capsys.readouterr().err == ""
