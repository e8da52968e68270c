"""Picks from a chart: the cheapest chain within an error, the most accurate within a cost, and the explanation."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from processes import HANG
from sssgen.cli.main import main
from sssgen.jobs import executor
from sssgen.lab.chart import charting as chart
from sssgen.lab.chart.charting import Settings
from sssgen.lab.chart.engine_conditions import Conditions, by_bytes, under
from sssgen.lab.chart.picking import Pick, choose, cost_of, is_allowed, limit_of, pick
from sssgen.lab.chart.record import hypervolumes, on_fronts
from sssgen.lab.gpu import device_costs
from sssgen.lab.measure import candidates
from sssgen.scene.measured import measured_scene
from sssgen.support.diagnostics import SssgenError


def point(chain: Sequence[str], cost: float, error: float, role: str = "material", **more: Any) -> dict[str, Any]:
    """A point whose error bar ends 10 % above the error, and 20 % above it in the second view."""
    name = " → ".join(chain) or "none"
    views = {"own": {"value": error, "low": 0.9 * error, "high": 1.1 * error},
             "held out": {"value": error, "low": 0.9 * error, "high": 1.2 * error}}  # fmt: skip
    results = {
        "scene": "cube", "role": role, "name": name, "label": name, "chain": list(chain), "failed": "",
        "cost": {"value": cost}, "error": views["own"], "views": views,
    }  # fmt: skip
    return results | more


NONE = point((), 1.0, 0.9)
WRAP = point(("wrap_lighting",), 20.0, 0.7)
PLAIN = point(("constant_thickness", "beer_lambert", "lobe_exp2"), 50.0, 0.5)
MAP = point(("thickness_map", "beer_lambert", "lobe_exp2"), 60.0, 0.3)
MARCH = point(("march_light", "beer_lambert", "lobe_gdc2011"), 400.0, 0.1)
EXPENSIVE = point(("march_light", "beer_lambert", "lobe_normalized"), 500.0, 0.2)
PUBLISHED = point(("transmittance_map", "ice_shader_lobe"), 5.0, 0.01)
BROKEN = point(("thinness_map", "lobe_exp2"), 6.0, 0.01, failed="4 of 72 points are not finite")
ELSEWHERE = point(("wrap_lighting",), 2.0, 0.001, scene="torus")
RECORD = {"points": [EXPENSIVE, PUBLISHED, MARCH, BROKEN, NONE, ELSEWHERE, MAP, WRAP, PLAIN]}


def picked(max_error: float | None = None, max_cost: float | None = None) -> Pick:
    return pick(RECORD, "cube", max_error, max_cost)


@pytest.mark.parametrize(
    ("max_error", "expected"),
    [(2.0, NONE), (0.9, WRAP), (0.85, WRAP), (0.8, PLAIN), (0.61, PLAIN), (0.5, MAP), (0.35, MARCH), (0.13, MARCH)],
)
def test_the_cheapest_chain_within_an_error_uses_the_largest_upper_end(max_error: float, expected: Any) -> None:
    result = picked(max_error)
    assert result.chain is expected and result.met
    assert limit_of(expected) == pytest.approx(1.2 * expected["error"]["value"])


@pytest.mark.parametrize(
    ("max_cost", "expected"), [(1.0, NONE), (49.9, WRAP), (50.0, PLAIN), (399.0, MAP), (400.0, MARCH), (1e6, MARCH)]
)
def test_the_most_accurate_within_a_cost(max_cost: float, expected: Any) -> None:
    result = picked(None, max_cost)
    assert result.chain is expected and result.met


def test_without_a_chain_within_the_limit_the_nearest_is_picked() -> None:
    assert (picked(0.05).chain, picked(0.05).met) == (MARCH, False)
    assert (picked(None, 0.5).chain, picked(None, 0.5).met) == (NONE, False)


def test_the_next_cheaper_and_better_chains() -> None:
    result = picked(0.5)
    assert (result.chain, result.cheaper, result.better) == (MAP, PLAIN, MARCH)  # EXPENSIVE is not on the front
    assert (picked(2.0).cheaper, picked(2.0).better) == (None, WRAP)
    assert (picked(0.2).cheaper, picked(0.2).better) == (MAP, None)


def test_published_forms_and_failed_points_are_never_picked() -> None:
    assert [point for point in RECORD["points"] if not is_allowed(point)] == [PUBLISHED, BROKEN]
    for limit in (0.001, 0.02, 0.3, 0.7, 2.0):
        for result in (picked(limit), picked(None, 100.0 * limit)):
            assert PUBLISHED not in result and BROKEN not in result and ELSEWHERE not in result
    # the published forms of the library
    stored = {technique.name for technique in candidates.of_role("translucency") if candidates.is_published(technique)}
    assert {
        "alisavakis_lobe",
        "ice_shader_lobe",
        "gltf_volume",
        "three_js_port",
    } <= stored and "lobe_gdc2011" not in stored


def test_ties_are_broken_by_cost_then_error() -> None:
    assert choose([MAP, {**MAP, "cost": {"value": 40.0}}], 0.5, None)[0]["cost"]["value"] == 40.0  # type: ignore[index]
    twin = point(MAP["chain"], 60.0, 0.25)
    assert choose([MAP, twin], 0.5, None)[0] is twin
    assert choose([], 0.5, None) == (None, True)


def reasons(result: Pick) -> dict[str, tuple[str, str]]:
    return {role.role: (role.technique, role.why) for role in result.roles}


def test_roles_are_omitted_by_their_errors() -> None:
    message = reasons(picked(2.0))
    assert message["translucency"][0] == message["thickness"][0] == ""
    assert "the error without it is 1.08" in message["translucency"][1]
    assert "there is no inlay" in message["coordinates"][1]
    message = reasons(picked(0.85))
    assert message["translucency"] == ("wrap_lighting", "without transmitted light the error is 1.08")
    assert message["thickness"][0] == "" and "the best chain with one has the error 0.12" in message["thickness"][1]
    message = reasons(picked(0.61))
    assert message["thickness"][0] == "constant_thickness" and "the error would be 0.12" in message["thickness"][1]
    message = reasons(picked(0.5))
    assert message["thickness"][0] == "thickness_map"
    assert "with a constant thickness the error is 0.6;" in message["thickness"][1]
    assert "needs a baked thickness map" in message["thickness"][1]
    assert message["translucency"][0] == "lobe_exp2"


def test_coordinates_have_the_same_limit() -> None:
    none, slide = (
        point((), 1.0, 0.9, "coordinates"),
        point(("parallax_refracted", "shown_uv"), 40.0, 0.01, "coordinates"),
    )
    slide["name"] = "parallax_refracted"
    result = pick({"points": [slide, none]}, "cube", 0.1, None)
    assert (result.chain, result.coordinates, result.better, result.cheaper) == (None, slide, None, none)
    assert reasons(result)["coordinates"] == (
        "parallax_refracted",
        "the relative error of the offset is 0.012; without it 1.08",
    )
    assert reasons(pick({"points": [slide, none]}, "cube", 2.0, None))["coordinates"][0] == ""
    both = pick({"points": [slide, none, NONE]}, "cube", 0.1, None)
    assert (
        both.coordinates is slide and both.chain is NONE and not both.met
    )  # the coordinates are within the limit, the chain is not


def test_a_scene_without_points() -> None:
    with pytest.raises(SssgenError, match="no point of the scene 'ball'"):
        pick(RECORD, "ball", 0.5, None)


# --- conditions ---


BAKED = point(("thickness_map", "view_thickness_from_chord", "interior_sample"), 45.0, 0.2, path="depth_map_path",
              requires=["bake", "depth-map"], bytes=1000)  # fmt: skip
DRAWN = point(("back_face_thickness", "interior_sample"), 70.0, 0.25, path="depth_map_path",
              requires=["depth-map", "back-faces"], bytes=0)  # fmt: skip
VOLUME = point(("march_view", "interior_sample"), 30.0, 0.22, path="march_light",
               requires=["bake", "rigid"], bytes=5000)  # fmt: skip
STILL = point(("march_view", "interior_octaves"), 20.0, 0.21, path="march_light",
              requires=["bake", "rigid", "fixed-light"], bytes=400)  # fmt: skip
SUMMED = point(("back_face_thickness", "interior_sample"), 25.0, 0.19,
               requires=["bake", "inner-light", "rest-pose"], bytes=900)  # fmt: skip
CHOICES: dict[str, Any] = {"points": [NONE, WRAP, BAKED, DRAWN, VOLUME, STILL]}


@pytest.mark.parametrize(
    ("conditions", "expected", "option"),
    [
        (Conditions(), STILL, ""),
        (Conditions(light="moving"), VOLUME, "--light moving"),
        (Conditions(light="moving", max_bytes=4999), BAKED, "--light moving"),
        (Conditions(max_bytes=399), DRAWN, "--max-bytes 399"),
        (Conditions(max_bytes=400), STILL, ""),
        (Conditions(body="deforming"), BAKED, "--body deforming"),
        (Conditions(without=("bake",)), DRAWN, "--without bake"),
        (Conditions(body="deforming", max_bytes=0), DRAWN, "--body deforming"),
        (Conditions(without=("depth-map",), light="moving"), VOLUME, "--light moving"),
    ],
)
def test_a_pick_needs_only_what_the_engine_has(conditions: Conditions, expected: Any, option: str) -> None:
    result = pick(CHOICES, "cube", 0.4, None, conditions)
    assert result.chain is expected and result.met
    assert (result.excluded, result.excluded_by) == ((STILL, option) if option else (None, ""))


@pytest.mark.parametrize(("body", "expected"), [("rigid", STILL), ("skinned", SUMMED), ("deforming", BAKED)])
def test_a_skinned_body_keeps_what_the_rest_pose_has(body: str, expected: Any) -> None:
    result = pick({"points": [*CHOICES["points"], SUMMED]}, "cube", 0.4, None, Conditions(body=body))
    assert result.chain is expected
    assert result.excluded_by == ("" if body == "rigid" else f"--body {body}")


def test_without_a_chain_within_the_limit_the_nearest_usable_one_is_picked() -> None:
    conditions = Conditions(without=("depth-map", "bake"))
    result = pick(CHOICES, "cube", 0.4, None, conditions)
    assert (result.chain, result.met, result.excluded) == (WRAP, False, STILL)
    message = reasons(pick(CHOICES, "cube", 0.4, None))
    assert message["light path"] == ("march_light", "the best chain with another one has the error 0.24")


def test_conditions_that_leave_nothing() -> None:
    with pytest.raises(SssgenError, match="no technique is left") as caught:
        pick({"points": [NONE, BAKED, VOLUME]}, "cube", 0.4, None, Conditions(without=("depth-map",), body="deforming"))
    assert caught.value.diagnostics[0].hint == "omit --without depth-map or --body deforming"


def test_a_chart_under_conditions_has_other_fronts_and_volumes() -> None:
    points = [{"baseline": False, **one} for one in CHOICES["points"]]
    record = {"points": on_fronts(points), "hypervolume": hypervolumes(points), "cost": "static", "cost_unit": "x"}
    assert [one["front"] for one in record["points"]] == [True, False, True, False, False, True]
    changed = under(record, Conditions(body="deforming"))
    fronts = {one["name"]: one["front"] for one in changed["points"]}
    assert fronts == {"none": True, WRAP["name"]: True, BAKED["name"]: True, DRAWN["name"]: False}
    assert changed["hypervolume"][0]["ours"] < record["hypervolume"][0]["ours"]
    assert changed["conditions"]["body"] == "deforming" and under(record, Conditions()) == record
    drawn = by_bytes(record)
    assert [one["cost"]["value"] for one in drawn["points"]] == [1, 1, 1000, 1, 5000, 400]
    assert [one["cost"]["static"] for one in drawn["points"]] == [cost_of(one) for one in points]
    assert {one["name"] for one in drawn["points"] if one["front"]} == {DRAWN["name"], STILL["name"], BAKED["name"]}


# --- the command ---


@pytest.fixture(scope="module")
def measured_plate(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The cache folder of a small chart of a plate, which no test changes."""
    from sssgen.support import cache

    folder = tmp_path_factory.mktemp("chart") / "cache"
    with pytest.MonkeyPatch.context() as patched:
        patched.setenv("SSSGEN_CACHE", str(folder))
        patched.setattr(cache, "_folder", None)
        patched.setattr(measured_scene, "SIDE", 12)
        chart.chart_record([measured_scene.load("inlay_plate")], Settings(8, processes=0))
    return folder


@pytest.fixture
def stored_chart(measured_plate: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A copy of this folder for a test, in use."""
    from sssgen.support import cache

    folder = tmp_path / "cache"
    shutil.copytree(measured_plate, folder)
    monkeypatch.setenv("SSSGEN_CACHE", str(folder))
    monkeypatch.setattr(cache, "_folder", None)
    monkeypatch.setattr(measured_scene, "SIDE", 12)
    return str(folder)


@pytest.fixture(autouse=True)
def forget_the_cache_folder() -> Any:
    from sssgen.support import cache

    yield
    cache._folder = None


def run(*arguments: str) -> int:
    return main(["pick", "inlay_plate", "--samples", "8", *arguments])


def test_a_cached_chart_is_not_measured_again(
    stored_chart: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(chart, "run", lambda *_, **__: pytest.fail("it measures"))
    assert run("--max-error", "0.01", "--json") == 0
    report = json.loads(capsys.readouterr().out)
    assert report["ok"] and report["coordinates"]["name"].startswith("parallax") and report["chain"] is None
    assert report["cheaper"]["name"] == "none"
    assert [role["role"] for role in report["roles"]] == ["coordinates"]
    assert run("--max-cost", "5") == 0
    output = capsys.readouterr().out
    assert "next better" in output and "a cost of at most 5" in output
    # no chain is within this limit: the nearest is shown, and the exit status is an error
    assert run("--max-error", "1e-30") == 1
    assert "which no chain reaches; this is the nearest" in capsys.readouterr().out
    assert run("--max-error", "1e-30", "--json") == 1
    assert json.loads(capsys.readouterr().out)["ok"] is False


def test_a_pick_for_a_device_has_its_costs(stored_chart: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("--max-error", "0.01", "--json") == 0
    static = json.loads(capsys.readouterr().out)["coordinates"]
    options = ["--light", "moving", "--body", "deforming", "--without", "bake", "--without", "depth-map"]
    assert run("--max-error", "0.01", "--device", "llvmpipe", *options, "--json") == 0
    picked = json.loads(capsys.readouterr().out)["coordinates"]
    assert picked["label"] == static["label"] and picked["cost"]["static"] == static["cost"]["value"]
    assert picked["cost"]["value"] == device_costs.load("llvmpipe").predict(static["cost"])
    assert run("--max-cost", "5", "--device", "llvmpipe") == 0
    costs = re.findall(r"cost [\d.e-]+ ?(.*)", capsys.readouterr().out)
    assert len(costs) > 1 and set(costs) == {"ns"}


def test_another_number_of_samples_is_another_chart(stored_chart: str, monkeypatch: pytest.MonkeyPatch) -> None:
    calls = []
    real = executor.run
    monkeypatch.setattr(
        chart, "run", lambda items, *rest, **more: calls.append(len(items)) or real(items, *rest, **more)
    )
    assert run("--max-error", "0.01", "--seed", "3", "--processes", "1") == 0
    assert calls


def test_the_picked_chain_is_emitted(stored_chart: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert run("--max-error", "0.01", "--emit", str(out), "--target", "wgsl,glsl-330") == 0
    names = sorted(path.name for path in out.iterdir())
    assert (
        "inlay_plate.toml" in names and any("wgsl" in name for name in names) and any("330" in name for name in names)
    )
    output = capsys.readouterr().out
    assert all(f"wrote {out / name}" in output for name in names)
    assert main(["emit", str(out / "inlay_plate.toml"), "--target", "glsl-330", "-o", str(tmp_path / "again")]) == 0
    again = next((tmp_path / "again").glob("*330*.frag")).read_text(encoding="utf-8")
    assert again == next(out.glob("*330*.frag")).read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--max-error", "0"], "--max-error 0 is not a limit"),
        (["--max-error", "nan"], "--max-error nan is not a limit"),
        (["--max-cost", "-3"], "--max-cost -3 is not a limit"),
        (["--max-cost", "inf"], "--max-cost inf is not a limit"),
        ([], "required"),
        (["--max-cost", "3", "--max-error", "1"], "not allowed"),
        (["--max-cost", "3", "--device", "llvmpip"], "did you mean 'llvmpipe'"),
        (["--max-cost", "3", "--device", "gtx"], "devices: h200, llvmpipe"),
        (["--max-cost", "3", "--max-bytes", "-1"], "0 or more; 0 bakes nothing"),
        (["--max-cost", "3", "--light", "movin"], "did you mean 'moving'"),
        (["--max-cost", "3", "--body", "soft"], "choose from: rigid, skinned, deforming"),
        (["--max-cost", "3", "--without", "depthmap"], "did you mean 'depth-map'"),
        (["--max-cost", "3", "--samples", "1"], "--samples 1 is not a number of samples"),
        (["--max-cost", "99", "--emit", "out", "--target", "wgls"], "did you mean 'wgsl'"),
        (["--max-cost", "99", "--emit", __file__], "this is not a folder"),
    ],
)
def test_wrong_arguments(
    stored_chart: str, arguments: list[str], message: str, tmp_path: Path,
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert run(*arguments) == 2
    assert message in capsys.readouterr().err
    assert not Path("out").exists()


def test_another_process_uses_the_cache(stored_chart: str) -> None:
    code = (
        "from sssgen.cli.main import main; from sssgen.scene.measured import measured_scene; measured_scene.SIDE = 12; "
        "raise SystemExit(main())"
    )
    arguments = ["pick", "inlay_plate", "--samples", "8", "--max-error", "0.01"]
    environment = {**os.environ, "SSSGEN_CACHE": stored_chart}
    result = subprocess.run(
        [sys.executable, "-X", "importtime", "-c", code, *arguments],
        capture_output=True, text=True, check=False, timeout=HANG, env=environment,
    )  # fmt: skip
    assert result.returncode == 0, result.stderr
    # the modules that measure are not loaded
    assert "sssgen.lab.chart.picking" in result.stderr
    for heavy in ("scipy", "mitsuba", "embreex", "flip_evaluator"):
        assert f" {heavy}\n" not in result.stderr, heavy
