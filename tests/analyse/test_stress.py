"""`sssgen stress`: the table of dangerous inputs, the checks of results, the reduction of faults, the report."""

from __future__ import annotations

import copy
import json
import os
import shlex
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from folders import DOCS
from processes import HANG, enable_interrupts, wait_until_busy
from slow_cases import diagonal, some_slow
from sssgen.analyse.stress import boundaries, energy, jumps
from sssgen.analyse.stress import dangerous_inputs as dangerous
from sssgen.analyse.stress.contract_inputs import contract, sample_inputs
from sssgen.analyse.stress.result_checks import faults_of, non_finite
from sssgen.analyse.stress.stress_run import Fault, Machines, Settings, exact, stress
from sssgen.analyse.stress.subject import Specimen, specimens, technique
from sssgen.analyse.stress.trial import RANDOM, Trial
from sssgen.cli.main import main
from sssgen.run.backends import Backend
from sssgen.run.evaluate.evaluation import Inputs
from sssgen.run.render.scene_render import render
from sssgen.scene import scene_loading

QUICK = ("numpy-f32", "gl")
ROWS = [row.name for row in dangerous.ROWS if row.trials is not None]

PLANTED = """/**
 * A planted fault: no number where a is above 3.
 * role: conversion
 */
transmittance planted(float a, vec3 b, thickness d)
{
    return transmittance(1.0e-4 * exp(-clamp(d, 0.0, 80.0)) * sqrt(3.0 - a) * step(0.0, dot(b, b)));
}
"""


@pytest.fixture(scope="module")
def machines(backend: Callable[[str], Backend]) -> Iterator[Callable[[str], Machines]]:
    """`machines("gl")` is the back end `gl`, opened once per module. If missing, it skips the test (in CI: fails)."""
    result: dict[str, Machines] = {}

    def get(name: str) -> Machines:
        backend(name)
        if name not in result:
            result[name] = Machines([name])
        return result[name]

    yield get
    for opened in result.values():
        opened.__exit__(None, None, None)


@pytest.fixture
def planted(tmp_path: Path) -> Callable[..., str]:
    """Writes a technique with a planted fault."""

    def write(text: str = PLANTED, name: str = "planted") -> str:
        path = tmp_path / f"{name}.sss"
        path.write_text(text, encoding="utf-8")
        return str(path)

    return write


def faults_in(specimen: Specimen, result: Machines, settings: Settings) -> list[Fault]:
    """The faults of a technique that count."""
    (column,) = stress(specimen, result, settings).columns
    assert not column.error
    return [fault for fault in column.faults if fault.counts]


# The table


@pytest.mark.parametrize(("row", "name"), diagonal(ROWS, QUICK))
def test_dangerous_row(row: str, name: str, machines: Callable[[str], Machines]) -> None:
    """No technique of the library fails on the row."""
    result = machines(name)
    faults, concerned = [], 0
    for specimen in specimens([]):
        if any(True for _ in dangerous.trials(specimen, (row,))):
            concerned += 1
            faults += [
                (specimen.title, *fault[:3], fault.command)
                for fault in faults_in(specimen, result, Settings(1, rows=(row,)))
            ]
    assert concerned
    assert not faults


def test_the_table_is_complete() -> None:
    """Every row has its own name, its requirement, and inputs, or the test that covers it."""
    assert len({row.name for row in dangerous.ROWS}) == len(dangerous.ROWS) == 27
    assert all(row.inputs and row.requires and (row.trials or row.elsewhere) for row in dangerous.ROWS)
    page = (DOCS / "harness.md").read_text(encoding="utf-8")
    assert all(f"| `{row.name}` | " in page and f" | {row.requires} |" in page for row in dangerous.ROWS)


def test_dangerous_row_meshes(tmp_path: Path) -> None:
    """The distance to an open box is negative inside, positive outside. An error names a mesh without triangles."""
    reason = "a mesh's distance needs libigl and trimesh: pip install -e '.[render]'"
    pytest.importorskip("igl", reason=reason)
    trimesh = pytest.importorskip("trimesh", reason=reason)
    from sssgen.scene.mesh import Mesh
    from sssgen.support.diagnostics import SssgenError

    box = trimesh.creation.box()
    box.update_faces(np.arange(len(box.faces)) > 0)
    box.export(tmp_path / "open.ply")
    distance = Mesh(path=str(tmp_path / "open.ply")).distance(np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]]))
    assert distance[0] < 0.0 < distance[1]
    (tmp_path / "none.obj").write_text("v 0 0 0\n", encoding="utf-8")
    with pytest.raises(SssgenError, match="triangles"):
        Mesh(path=str(tmp_path / "none.obj")).bounds()


def test_dangerous_row_lamp_at_surface_in_the_shell(backend: Callable[[str], Backend], tmp_path: Path) -> None:
    """In a whole shader, the falloff of a lamp that touches the ball is bounded."""
    (tmp_path / "lamp.toml").write_text(
        'material = "ice"\nsize = [32, 32]\n[geometry]\nkind = "ball"\n'
        "[[light]]\nposition = [0.0, 0.0, 1.0]\ncolor = [100.0, 100.0, 100.0]\n",
        encoding="utf-8",
    )
    picture = render(scene_loading.load(str(tmp_path / "lamp.toml")), backend("gl")).linear
    assert not non_finite(picture).any() and picture.max() > 0.0


# Planted faults


@pytest.mark.parametrize("name", some_slow(["numpy-f32", "gl", "webgpu", "browser", "hlsl"], "numpy-f32", "webgpu"))
def test_a_planted_nan_is_caught_and_shrunk(
    name: str, planted: Callable[..., str], machines: Callable[[str], Machines]
) -> None:
    """Shrinking finds the simplest input: 10 is the first plain number above 3; no other input matters.

    The square root of a negative number is undefined in a shader: a driver may give a number.
    """
    faults = faults_in(technique(planted()), machines(name), Settings(2000, guards="none"))
    if name != "numpy-f32" and not faults:
        pytest.skip(f"{name} has a number for sqrt(-7)")
    fault = next(fault for fault in faults if fault.kind == "non-finite")
    assert non_finite(fault.actual).any() and fault.inputs.lanes == 1
    values = {key: value.ravel().tolist() for key, value in fault.inputs.values.items()}
    assert values == {"a": [10.0], "b": [0.0, 0.0, 1.0], "d": [0.0]}
    assert shlex.split(fault.command)[1] == '{"a": 10.0, "b": [0.0, 0.0, 1.0], "d": 0.0}'


def test_the_printed_line_shows_the_fault(
    planted: Callable[..., str], machines: Callable[[str], Machines], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (
        "/**\n * Light below 0.\n * role: translucency\n */\nvec3 planted(float a) { return vec3(-1.5 - 0.0 * a); }\n"
    )
    result = faults_in(technique(planted(text)), machines("numpy-f32"), Settings(100))
    fault = next(fault for fault in result if fault.kind == "out of range")
    before, _, command = fault.command.partition(" | sssgen ")
    (tmp_path / "in.json").write_text(shlex.split(before)[1], encoding="utf-8")
    assert main([str(tmp_path / "in.json") if word == "-" else word for word in shlex.split(command)]) == 0
    assert "1.5" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("body", "kind", "counts"),
    [
        ("return transmittance(1.0 + 0.001 * step(0.7, a));", "out of range", True),
        ("return transmittance(clamp(d * 0.5, 0.0, 1.0));", "energy", True),
    ],
)
def test_other_planted_faults(
    body: str, kind: str, counts: bool, planted: Callable[..., str], machines: Callable[[str], Machines]
) -> None:
    head, _, _ = PLANTED.partition("    return")
    faults = faults_in(
        technique(planted(f"{head}    {body}\n}}\n")), machines("numpy-f32"), Settings(500, guards="none")
    )
    assert kind in {fault.kind for fault in faults} and all(fault.counts == counts for fault in faults)


def test_a_jump_of_the_formula_is_reported(planted: Callable[..., str]) -> None:
    head, _, _ = PLANTED.partition("    return")
    jumping = technique(planted(f"{head}    return transmittance(0.25 + 0.5 * step(0.7, a) + 0.0 * d * b.x);\n}}\n"))
    (result,) = jumps.of_model(jumping, exact(jumping, Settings(1)))
    assert result.input == "a" and result.size == pytest.approx(0.5, rel=1e-3)
    assert float(result.inputs.values["a"].item()) == pytest.approx(0.7, abs=1e-3)
    steep = technique(planted(f"{head}    return transmittance(clamp(a * 5.0 + 0.0 * d * b.x, 0.0, 1.0));\n}}\n"))
    assert not jumps.of_model(steep, exact(steep, Settings(1)))


def test_a_jump_of_a_back_end_alone() -> None:
    """A back end that rounds to 1/25 jumps where the formula is smooth."""
    specimen = technique("transmittance_from_thinness")
    oracle = exact(specimen, Settings(1))

    def rounding(inputs: Inputs) -> dict[str, Any]:
        return {name: np.round(25.0 * value) / 25.0 for name, value in oracle(inputs).items()}

    size, name, _ = jumps.largest_jump(specimen, rounding, oracle)
    assert size == pytest.approx(0.04) and name == "th"
    assert jumps.largest_jump(specimen, oracle, oracle)[0] < 1e-3


def test_a_back_end_with_wrong_results(monkeypatch: pytest.MonkeyPatch) -> None:
    """An error of 0.001 is a failure in a row of the table, and only a remark on random inputs."""
    off = Machines(["numpy-f32"])
    right = off.backends["numpy-f32"]
    off.backends["numpy-f32"] = wrong = copy.copy(right)
    monkeypatch.setattr(wrong, "run", lambda *inputs: [value + 1e-3 for value in right.run(*inputs)])
    (column,) = stress(technique("beer_lambert"), off, Settings(100)).columns
    results = {(fault.trial, fault.counts) for fault in column.faults if fault.kind == "disagreement"}
    assert {("thick-matter", True), (RANDOM, False)} <= results and column.deviation == pytest.approx(1e-3, rel=0.01)


def test_a_back_end_may_not_jump_on_a_path() -> None:
    """A jump of a back end is a fault unless the oracle has a jump within a step."""
    specimen = technique("transmittance_from_thinness")
    inputs = sample_inputs(specimen, 10, np.random.default_rng(0))
    trial = Trial("", specimen, inputs, path=True)
    leap = np.where(np.arange(10) < 5, 0.2, 0.9)
    late = {"result": np.where(np.arange(10) < 6, 0.2, 0.9)}
    assert [fault.kind for fault in faults_of(trial, {"result": leap}, {"result": np.full(10, 0.2)})] == ["jump"]
    assert not faults_of(trial, {"result": leap}, late)


# Inputs


def test_random_inputs_are_in_the_contract_and_reach_its_ends() -> None:
    """All inputs are in the contract; the ends and 0 occur; directions have all lengths up to 1."""
    specimen = technique("lobe_normalized")
    inputs = sample_inputs(specimen, 1 << 16, np.random.default_rng(1))
    for name, value in inputs.values.items():
        ends = contract(specimen, name)
        low, high = np.float32(ends.low), np.float32(ends.high)
        assert value.dtype == np.float32 and (value >= low).all() and (value <= high).all(), name
        if name not in ("V", "N", "L"):
            assert (value == low).any() and (value == high).any() and (value == 0.0).any() == (low <= 0.0), name
    length = {name: np.linalg.norm(inputs.values[name], axis=0) for name in "VNL"}
    assert all(
        lengths.max() <= 1.001 and (lengths == 0.0).any() and (lengths > 1.0 + 1e-5).any()
        for lengths in length.values()
    )
    assert (np.abs(inputs.values["L"] + inputs.values["N"]).max(axis=0) == 0.0).sum() > 100


def test_random_inputs_are_the_same_for_a_seed() -> None:
    specimen = technique("thickness_map")
    first, again, other = (sample_inputs(specimen, 64, np.random.default_rng(seed)) for seed in (1, 1, 2))
    assert np.array_equal(first.values["uv"], again.values["uv"])
    assert not np.array_equal(first.values["uv"], other.values["uv"])


def test_boundary_values_come_in_pairs() -> None:
    """Every pair of values of two inputs occurs."""
    specimen = technique("beer_lambert")
    d, distance = (boundaries.values(specimen, name) for name in ("d", "attenuation_distance"))
    assert d is not None and distance is not None
    assert {0.0, float(np.float32(1e-45)), 1.0} <= set(d.tolist()) and {0.0, 10.0} <= set(distance.tolist())
    pairs = next(boundaries.trials(specimen, 0)).inputs
    met = set(zip(pairs.values["d"].tolist(), pairs.values["attenuation_distance"].tolist(), strict=True))
    assert {(a, b) for a in d.tolist() for b in distance.tolist()} <= met
    beyond = [trial for trial in boundaries.trials(specimen, 0) if not trial.counts]
    assert beyond and all((trial.inputs.values["d"] < 0.0).any() for trial in beyond)


def test_techniques_that_are_checked_for_energy() -> None:
    checked = [specimen.title for specimen in specimens([]) if any(True for _ in energy.trials(specimen, 0))]
    assert {"beer_lambert", "absorption_tint", "thinness_from_thickness"} <= set(checked)
    assert "lobe_normalized" not in checked


def test_materials_are_stressed_stage_by_stage() -> None:
    results = {specimen.title: specimen for specimen in specimens(["jelly_cubes"])}
    assert results["jelly_cubes: thinness_traced"].bind == {"body_distance": "jelly_cubes"}
    fixed = results["jelly_cubes: gamma"]
    assert fixed.settings["display_gamma"] == pytest.approx((2.2,))
    trial = next(boundaries.trials(fixed, 0))
    assert trial.inputs.values["display_gamma"] == pytest.approx(2.2)


def test_a_row_skips_what_a_material_fixes(machines: Callable[[str], Machines]) -> None:
    """Resin in air has no critical angle."""
    (resin,) = [specimen for specimen in specimens(["resin_inlay"]) if specimen.technique == "parallax_refracted"]
    assert not list(dangerous.trials(resin, ("critical-angle",)))
    assert list(dangerous.trials(technique("parallax_refracted"), ("critical-angle",)))
    assert not faults_in(resin, machines("numpy-f32"), Settings(100))


def test_non_finite_numbers_are_recognized_by_their_bits() -> None:
    for dtype in (np.float16, np.float32, np.float64):
        values = np.array([0.0, np.nan, np.inf, -np.inf, 1.0, np.finfo(dtype).max, np.finfo(dtype).tiny], dtype)
        assert non_finite(values).tolist() == [False, True, True, True, False, False, False]


# The command


def answer(capsys: pytest.CaptureFixture[str], *arguments: str, status: int) -> Any:
    assert main(["stress", *arguments, "--json"]) == status
    return json.loads(capsys.readouterr().out)


def test_the_report_in_json(capsys: pytest.CaptureFixture[str], planted: Callable[..., str], tmp_path: Path) -> None:
    file = planted(PLANTED.replace("1.0e-4", "2.0"))
    written = tmp_path / "report.json"
    report = answer(
        capsys,
        file,
        "-b",
        "numpy-f32",
        "--samples",
        "1000",
        "--seed",
        "3",
        "--guards",
        "none",
        "-o",
        str(written),
        status=1,
    )
    assert json.loads(written.read_text(encoding="utf-8")) == report
    assert {key: report[key] for key in ("ok", "samples", "seed", "precision")} == {
        "ok": False, "samples": 1000, "seed": 3, "precision": "f32",
    }  # fmt: skip
    assert [row["name"] for row in report["rows"]] == [row.name for row in dangerous.ROWS]
    (entry,) = report["techniques"]
    assert (entry["name"], entry["role"], entry["baseline"], entry["ok"]) == (file, "conversion", False, False)
    (column,) = entry["backends"]
    assert column["name"] == "numpy-f32" and column["evaluations"] > 1000 and column["error"] == ""
    fault = column["faults"][0]
    assert set(fault) == {"trial", "kind", "output", "counts", "lanes", "of", "got", "inputs", "eval"}
    assert fault["counts"] and 0 < fault["lanes"] <= fault["of"] and set(fault["inputs"]) == {"a", "b", "d"}


def test_the_report_in_markdown(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    written = tmp_path / "report.md"
    row = ("--row", "black-attenuation", "-b", "numpy-f32", "-o", str(written), "--guards", "none")
    assert main(["stress", "gltf_volume", "beer_lambert", *row]) == 1
    printed = capsys.readouterr().out
    assert "published baseline" in printed and "black-attenuation: non-finite" in printed and "wrote" in printed
    text = written.read_text(encoding="utf-8")
    assert "| gltf_volume | FAIL |" in text and "published baseline" in text


def test_the_library_without_baselines() -> None:
    names = [specimen.title for specimen in specimens([])]
    assert "lobe_normalized" in names and "alisavakis_lobe" not in names
    assert specimens(["alisavakis_lobe"])[0].baseline


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["lobe_normalised"], "did you mean 'lobe_normalized'"),
        (["beer_lambert", "--row", "pow"], "unknown row 'pow'"),
        (["beer_lambert", "-b", "gll"], "unknown back end"),
        (["beer_lambert", "-b", "gl", "--precision", "f16"], "gl does not compute in half precision"),
        (["beer_lambert", "-b", "numpy-f16"], "numpy-f16 computes in half precision"),
        (["beer_lambert", "--samples", "0"], "not a number of samples"),
        (["beer_lambert", "--seed", "-1"], "is negative"),
        (["beer_lambert", "-o", "report.html"], "a report cannot be a '.html' file"),
        (["beer_lambert", "-o", "."], "a report cannot be a '' file"),
        (["beer_lambert", "-o", f"{__file__}/report.md"], "cannot write"),
    ],
)
def test_wrong_arguments(arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["stress", *arguments]) == 2
    assert message in capsys.readouterr().err


def test_a_missing_back_end_is_reported() -> None:
    """The other back ends run. A missing back end is a failure if CI is set, or if none is available."""
    command = [sys.executable, "-m", "sssgen", "stress", "beer_lambert", "--samples", "10", "-b"]
    bare = {**os.environ, "SSSGEN_CHROMIUM": "/nowhere/chromium", "CI": ""}
    among = subprocess.run([*command, "numpy-f32,browser"], env=bare, capture_output=True, text=True, check=False)
    assert among.returncode == 0 and "browser    not here: chromium" in among.stdout
    for environment, names in ((bare, "browser"), ({**bare, "CI": "true"}, "numpy-f32,browser")):
        process = subprocess.run([*command, names], env=environment, capture_output=True, check=False)
        assert process.returncode == 1


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for another process")
def test_an_interrupted_run_leaves_no_report(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "sssgen", "stress", "beer_lambert", "--samples", "900000000", "-b", "numpy-f32"]
    process = subprocess.Popen(
        [*command, "-o", str(tmp_path / "report.md")], stderr=subprocess.PIPE, preexec_fn=enable_interrupts
    )
    try:
        wait_until_busy(process, 4.0)
        process.send_signal(signal.SIGINT)
        _, message = process.communicate(timeout=HANG)
    finally:
        process.kill()
    assert process.returncode == 130 and b"interrupted" in message
    assert not list(tmp_path.iterdir())


def test_half_precision_has_its_own_limits(capsys: pytest.CaptureFixture[str]) -> None:
    report = answer(capsys, "beer_lambert", "--precision", "f16", "-b", "numpy", "--samples", "1000", status=0)
    assert report["precision"] == "f16" and report["backends"][0]["name"] == "numpy-f16"


@pytest.mark.slow
@pytest.mark.parametrize("name", ["gl", "webgpu"])
def test_many_random_inputs(name: str, machines: Callable[[str], Machines]) -> None:
    """A million random inputs for each technique; docs/harness.md has the command for more."""
    for specimen in specimens([]):
        faults = [fault for fault in faults_in(specimen, machines(name), Settings(1_000_000)) if fault.trial == RANDOM]
        assert not faults, (specimen.title, faults[0].command)
