"""The chain for each distance of a budget: the pixels, the errors at a size, the choice, and the material."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from measured_views import candidate
from sssgen.cli.main import main
from sssgen.lab.chart.levels import COLUMNS, ROWS, Goal, Level, choice, goals, levels
from sssgen.lab.chart.picked_material import by_level, level_files
from sssgen.lab.chart.race import Entrant, within_budget
from sssgen.lab.gpu import device_costs
from sssgen.lab.measure import measurement as measure
from sssgen.lab.measure.error_metric import compare
from sssgen.lab.measure.measurement import View
from sssgen.lab.measure.seen_size import error_at
from sssgen.material.material_loading import parse_material
from sssgen.material.material_text import MaterialSection
from sssgen.pipeline.compiler import compile
from sssgen.scene.measured import measured_scene
from sssgen.scene.measured.view_points import points
from sssgen.scene.pictures.images import read
from sssgen.support import cache

# --- distances and sizes ---


def test_the_pixels_fall_with_the_square_of_the_distance() -> None:
    scene = measured_scene.load("cube")
    near, camera, far = goals(scene, 0.5, (0.125, 1.0, 64.0))
    covered = points(scene).count * (ROWS / scene.size[1]) ** 2
    assert near.pixels == ROWS * COLUMNS  # the body is larger than the screen
    assert camera.pixels == pytest.approx(covered) and far.pixels == pytest.approx(covered / 64.0**2)
    assert camera.max_cost * camera.pixels == pytest.approx(0.5e6)
    assert (camera.rows, far.rows) == (scene.size[1], 17)
    # the same body in a picture of twice the size covers the same part of the screen
    larger = replace(scene, size=(2 * scene.size[0], 2 * scene.size[1]))
    assert goals(larger, 0.5, (1.0,))[0].pixels == pytest.approx(covered, rel=0.02)


def test_the_error_at_the_whole_size_is_that_of_the_picture() -> None:
    rng = np.random.default_rng(3)
    valid = rng.random((9, 12)) < 0.7
    reference = 0.5 + rng.random((3, valid.sum()))
    values, noise = reference + 0.1 * rng.random(reference.shape), np.full_like(reference, 0.01)
    whole = compare(values, reference, noise)
    for rows in (9, 1080):
        error = error_at(rows, valid, values, reference, noise)
        assert [error[name] for name in ("value", "low", "high")] == pytest.approx(
            [whole[name] for name in ("value", "low", "high")]
        )


def test_fine_detail_is_not_seen_from_afar() -> None:
    """A checkerboard has no error where each box has as many of both; an offset has the same error at each size."""
    valid = np.ones((8, 12), bool)
    board = np.indices(valid.shape).sum(axis=0) % 2 * 2.0 - 1.0
    reference = np.ones((3, valid.size))
    noise = np.full_like(reference, 0.2)
    for values, expected in ((reference + 0.3 * board.ravel(), 0.0), (1.3 * reference, 0.3)):
        near, far = (error_at(rows, valid, values, reference, 0.0 * noise)["value"] for rows in (8, 4))
        assert near == pytest.approx(0.3, rel=0.01) and far == pytest.approx(expected, rel=0.01, abs=1e-6)
    # the noise of a box of 4 pixels is half of that of a pixel
    bars = error_at(4, valid, 1.3 * reference, reference, noise)
    single = compare(np.full((3, 24), 1.3), np.ones((3, 24)), np.full((3, 24), 0.1))
    assert [bars[name] for name in ("value", "high")] == pytest.approx([single[name] for name in ("value", "high")])


def test_pixels_without_the_body_are_black_in_both_pictures() -> None:
    valid = np.array([[True, False], [False, False]])
    one = np.full((1, 1), 4.0)
    error = error_at(1, valid, 1.5 * one, one, 0.0 * one)
    assert error["value"] == pytest.approx(0.5, rel=1e-2)


# --- the choice ---


def point(label: str, cost: float, near: float, far: float = 0.0) -> dict[str, Any]:
    """A point whose error bar is 10 % to either side: `near` where the view has 48 rows, `far` where it has 17."""
    bars = {rows: {"own": {"value": error, "low": 0.9 * error, "high": 1.1 * error}}
            for rows, error in (("48", near), ("17", far or near))}  # fmt: skip
    return {"label": label, "cost": {"value": cost}, "views_at": bars, "views": bars["48"], "failed": "", "bytes": 7}


NONE, WRAP, MAP = point("none", 0.001, 0.9), point("wrap", 0.1, 0.6, 0.04), point("map", 0.5, 0.3)
CLOSE, BAKE = point("close", 0.9, 0.105), point("bake", 1.0, 0.1)


@pytest.mark.parametrize(
    ("max_cost", "max_error", "expected"),
    [(9.0, 0.7, WRAP), (9.0, 0.65, MAP), (9.0, 0.2, CLOSE), (9.0, 0.112, BAKE), (9.0, 0.05, CLOSE), (0.7, 0.05, MAP),
     (0.2, 0.05, WRAP), (1e-9, 0.05, NONE)],
)  # fmt: skip
def test_the_chain_within_the_budget(max_cost: float, max_error: float, expected: Any) -> None:
    """Within the error the cheapest one; beyond it the cheapest of those that the bars cannot tell from the best."""
    assert choice([BAKE, MAP, NONE, CLOSE, WRAP], max_cost, max_error) is expected


def test_neighbouring_distances_with_the_same_chain_are_one_level() -> None:
    wanted = [
        Goal(1.0, 1e6, 48, 0.2), Goal(2.0, 2.5e5, 48, 0.8), Goal(4.0, 6e4, 48, 3.3), Goal(8.0, 1.5e4, 48, 13.0),
        Goal(64.0, 244.0, 17, 820.0),
    ]  # fmt: skip
    result = levels([NONE, WRAP, MAP, BAKE], wanted, 0.2)
    assert [(level.point["label"], level.begin, level.end) for level in result] == [
        ("wrap", 1.0, 2.0), ("map", 2.0, 4.0), ("bake", 4.0, 64.0), ("wrap", 64.0, None),
    ]  # fmt: skip
    assert [level.within for level in result] == [False, False, True, True]
    # a frame's milliseconds where the body is nearest, and the error of the size at which it is seen
    assert [level.ms for level in result] == pytest.approx([0.1, 0.125, 0.06, 0.1 * 244e-6])
    assert (result[0].error, result[3].error) == (0.6, 0.04)
    assert all(level.ms <= 0.2 * 1e6 * 1e-6 + 1e-9 for level in result)


def test_the_race_measures_what_a_budget_allows() -> None:
    entrants = [Entrant(1.0, 1, 0.5, 0.6), Entrant(2.0), Entrant(3.0), Entrant(9.0)]
    assert within_budget(entrants, 5.0, 0.3, 2) == [1, 2]
    # one is inside: what costs more is not measured; without one, those that may be the best are measured again
    inside = [*entrants[:1], Entrant(2.0, 2, 0.2, 0.25), *entrants[2:]]
    assert within_budget(inside, 5.0, 0.3, 2) == []
    outside = [*entrants[:1], Entrant(2.0, 1, 0.35, 0.45), Entrant(3.0, 1, 0.4, 0.5), *entrants[3:]]
    assert within_budget(outside, 5.0, 0.3, 2) == [1, 2]
    assert within_budget(outside, 0.5, 0.3, 2) == []


def test_what_is_computed_once_costs_the_same_for_any_number_of_lights() -> None:
    """The code knows it from the function of the material that does it: of the surface, or of a light."""
    scene, device = measured_scene.load("cube"), device_costs.load("h200")
    for chain, share in ((("fluence_relit",), 1.0), (("wrap_lighting",), 3.0)):
        cost = measure.price(candidate(*chain), scene).cost
        assert device.predict(cost, 1) == device.predict(cost)
        assert device.predict(cost, 3) == pytest.approx(share * device.predict(cost))


# --- the material ---


def stage(name: str, value: float, *numbers: int) -> MaterialSection:
    return MaterialSection("thickness", name, (("x", value),), levels=numbers)


def test_equal_stages_of_several_levels_are_one() -> None:
    a, b, c = stage("a", 1.0), stage("b", 1.0), stage("c", 1.0)
    assert by_level([[a, b], [c, b], [a, c]]) == [stage("a", 1.0, 0, 2), stage("c", 1.0, 1, 2), stage("b", 1.0, 0, 1)]
    assert by_level([[a, b], [a]]) == [a, stage("b", 1.0, 0)]
    # the order of each level is kept, and another value is another stage
    assert by_level([[a, b], [b, a]]) == [stage("b", 1.0, 1), a, stage("b", 1.0, 0)]
    assert by_level([[a], [stage("a", 2.0)]]) == [stage("a", 1.0, 0), stage("a", 2.0, 1)]


def test_the_material_has_a_level_for_each_chain(cube: View, training: tuple[View, ...], tmp_path: Path) -> None:
    chains = []
    for names in (("wrap_lighting",), ("constant_thickness", "beer_lambert", "lobe_exp2"), ()):
        tested = candidate(*names) if names else measure.Candidate("material", "none", "none", (), ())
        measured = measure.fit_and_measure(tested, training[:1], None, [cube], (17, cube.scene.size[1]))
        assert measured["views_at"][str(cube.scene.size[1])]["own"] == pytest.approx(measured["views"]["own"])
        end = float(len(chains) + 2) if names else None
        chains.append(Level(len(chains) + 1.0, end, {"scene": "cube", **measured}, 0.1, 0.1, 0.1, 0.1, True))
    for name, text in level_files(cube.scene, chains, "mine").items():
        (tmp_path / name).write_text(text)
    material = parse_material((tmp_path / "mine.toml").read_text(), str(tmp_path / "mine.toml"))
    assert material.levels == 3 and material.doc.endswith(": level 0: 1 to 2; level 1: 2 to 3; level 2: from 3.")
    assert [stage.levels for stage in material.stages if stage.technique.role == "translucency"] == [(0,), (1,)]
    for target in ("glsl-330", "wgsl", "hlsl"):
        compiled = compile(material, target)
        assert "detail_level" in [uniform["name"] for uniform in compiled.reflection["uniforms"]]
        assert [texture["name"] for texture in compiled.reflection["textures"]].count("base_color_texture") == 1


# --- the command ---


@pytest.fixture
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A cache folder of this test, and small pictures."""
    monkeypatch.setenv("SSSGEN_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(cache, "_folder", None)
    monkeypatch.setattr(measured_scene, "SIDE", 12)
    yield
    cache._folder = None


@pytest.mark.parametrize(
    ("scene", "arguments", "message"),
    [
        ("cube", ["--budget-ms", "0"], "--budget-ms 0 is not a limit"),
        ("cube", ["--budget-ms", "0.5"], "--budget-ms needs the device"),
        ("cube", ["--budget-ms", "0.5", "--device", "h20"], "did you mean 'h200'"),
        ("cube", ["--budget-ms", "0.5", "--device", "h200", "--max-cost", "3"], "not allowed with --budget-ms"),
        ("cube", ["--budget-ms", "0.5", "--device", "h200", "--lights", "0"], "--lights 0 is not a number of lights"),
        ("cube", ["--budget-ms", "0.5", "--device", "h200", "--distances", "1,0"], "is not a list of distances"),
        ("cube", ["--budget-ms", "0.5", "--device", "h200", "--distances", "near"], "numbers above 0, such as"),
        ("cube", ["--budget-ms", "0.5", "--device", "h200", "--distances", "1,2,3,4,5,6,7,8,9"], "1 to 8 numbers"),
        ("cube", ["--max-error", "0.5", "--lights", "3"], "--lights has no meaning without --budget-ms"),
        ("cube", ["--max-cost", "5", "--distances", "1"], "--distances has no meaning without --budget-ms"),
        ("inlay_plate", ["--budget-ms", "0.5", "--device", "h200"], "it has no [medium]"),
    ],
)
@pytest.mark.usefixtures("own_cache")
def test_wrong_arguments(scene: str, arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pick", scene, "--samples", "8", *arguments]) == 2
    assert message in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.usefixtures("own_cache")
def test_a_budget_ends_with_a_table_and_a_material(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("mitsuba", reason="mitsuba is missing: pip install -e '.[reference]'")
    out = tmp_path / "out"
    common = ["pick", "cube", "--budget-ms", "0.5", "--device", "h200", "--lights", "3", "--max-error", "0.6"]
    common += ["--distances", "0.5,1,64", "--samples", "16", "--processes", "1", "-o", str(out), "--target", "wgsl"]
    main(common)
    output = capsys.readouterr().out
    assert "0.5 ms a frame on h200 with 3 lights, predicted" in output
    assert main([*common, "--json"]) in (0, 1)
    report = json.loads(capsys.readouterr().out)
    assert report["levels"] and all(0.0 < level["ms"] <= 0.5 for level in report["levels"])
    assert report["ok"] == all(level["within"] for level in report["levels"])
    distances = [level["begin"] for level in report["levels"]]
    assert distances == sorted(set(distances)) and distances[0] == 0.5 and report["levels"][-1]["end"] is None
    assert "levels = " in (out / "cube.toml").read_text() or len(distances) == 1
    texels = read(out / "cube_beside_path_tracing.png")
    assert texels.shape[1] == 160 + len(distances) * 164
    for number in range(len(distances) + 1):
        assert texels[:, 164 * number : 164 * number + 160].std() > 0.02
