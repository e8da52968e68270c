"""Every technique on the back ends, compared with the oracle on random inputs; the inputs; `eval --samples`."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from folders import DOCS
from qualification.parity_techniques import BACKENDS, BOUND_LANES, LANES, Case, cases, excess, measure
from slow_cases import diagonal
from sssgen.cli import main as cli
from sssgen.material import library
from sssgen.run import backends
from sssgen.run.backends import Backend
from sssgen.run.evaluate.deviation import GOAL, MARGIN, compare, deviation, rounding_deviation
from sssgen.run.evaluate.evaluation import fit_inputs, run
from sssgen.run.evaluate.probes import subject
from sssgen.run.evaluate.random_inputs import samples
from sssgen.targets.runtime.numpy_textures import Texture

PAGE = DOCS / "parity_techniques.md"
FEW = 500

Get = Callable[[str], Backend]


# with g++ there is a compilation for each technique: make test-long
@pytest.mark.parametrize(
    ("technique", "name"), diagonal(sorted(library.index()), ["gl", "webgpu", "browser", "hlsl", "metal"])
)
def test_technique(backend: Get, technique: str, name: str) -> None:
    """Consecutive tests use the same technique, because `measure` caches the oracle of the latest techniques."""
    gpu, case = backend(name), Case(technique)
    assert not (message := excess(case, name, measure(case, gpu, FEW), FEW)), message


@pytest.mark.slow
def test_techniques_on_many_inputs(backend: Get) -> None:
    """All back ends, with the inputs of docs/parity_techniques.md and each function that fits a slot."""
    gpus = [backend(name) for name in BACKENDS]
    failures = []
    for case in cases():
        lanes = BOUND_LANES if case.bind else LANES
        failures += [message for gpu in gpus if (message := excess(case, gpu.name, measure(case, gpu, lanes), lanes))]
    assert not failures, "\n".join([f"{len(failures)}", *failures])


def test_the_page_lists_every_technique() -> None:
    text = PAGE.read_text(encoding="utf-8")
    listed = [line.split(" | ")[0].removeprefix("| ") for line in text.splitlines() if line.startswith("| ")]
    assert listed[1:] == sorted(library.index()), "run python -m qualification.pages.parity_techniques"
    for technique in library.load_all():
        declared = technique.attributes
        assert declared.deviation_bounds.keys() <= {"", *BACKENDS}
        assert declared.deviation in text, "run python -m qualification.pages.parity_techniques"


# The rounding deviation

CELLS = """
/**
 * Which of a thousand cells `x` is in.
 * role: distance
 */
float cells(float x)
{
    return floor(1000.0 * x) + x * 1.0e-3;
}
"""


def test_a_lane_at_a_step_is_excluded_and_a_wrong_one_is_not(tmp_path: Path) -> None:
    """At n / 1000, float32 may round into the neighbouring cell; 0.4 cells further on it may not."""
    (tmp_path / "cells.sss").write_text(CELLS, encoding="utf-8")
    chosen = subject(f"{tmp_path / 'cells.sss'}:cells")
    x = np.concatenate([np.arange(1, 1000) / 1000.0, np.arange(1, 1000) / 1000.0 + 4e-4])
    inputs = fit_inputs(chosen, {"x": x})
    oracle, (row,) = compare(chosen, inputs, ["numpy-f32"])
    assert row.deviation is not None and row.ok
    assert 100 < row.deviation.excluded < 1000, "float32 moves many of the steps"
    assert 1.0 / 999.0 <= row.deviation.furthest <= 1.0
    assert (
        f"{row.deviation.excluded} ill-conditioned lanes excluded" in row.text
        and row.as_json()["excluded"] == row.deviation.excluded
    )

    result = rounding_deviation(chosen, inputs, oracle)
    assert result["result"][:999].max() > GOAL and result["result"][999:].max() < GOAL / MARGIN
    off = {"result": oracle["result"] + 1.0}
    wrong = deviation(off, oracle, lambda: result)
    assert wrong.largest > GOAL and wrong.lane >= 999
    assert deviation(off, oracle).excluded == 0


def test_nan_is_not_an_excluded_lane() -> None:
    right = {"result": np.ones(4)}
    actual = {"result": np.array([1.0, np.nan, 1.0, 1.0])}
    worst = deviation(actual, right, lambda: {"result": np.full(4, 0.1)})
    assert worst.largest == np.inf and worst.lane == 1 and worst.excluded == 0


# The inputs


def sampled(name: str, count: int = 2000, seed: int = 3) -> dict[str, Any]:
    return samples(subject(name), count, seed)


def test_samples_have_the_quantity_of_a_parameter() -> None:
    result = sampled("lobe_normalized")
    for name in "VNL":
        assert np.linalg.norm(result[name], axis=1) == pytest.approx(np.ones(2000))
    cosine = np.abs((result["V"] * result["L"]).sum(axis=1))
    assert 0.05 < (cosine > 0.99).mean() < 0.3, "some directions are equal or opposite"
    for name, low, high in (("through", 0.0, 1.0), ("power", 1.0, 32.0), ("scale", 0.0, 20.0), ("ambient", 0.0, 1.0)):
        assert result[name].min() == low and result[name].max() == high, name
        assert 0.005 < (result[name] == low).mean() < 0.1, name
    assert result["distortion"].max() == 0.99, "the technique's limits: below 1"


def test_samples_of_frames_and_normals() -> None:
    result = sampled("parallax_refracted")
    volume = np.abs((result["T"] * np.cross(result["B"], result["N"])).sum(axis=1))
    assert volume.min() > 0.3
    handed = (result["T"] * np.cross(result["B"], result["N"])).sum(axis=1) < 0.0
    assert 0.2 < handed.mean() < 0.8
    assert sampled("normal_map")["normal"][:, 2].min() >= 0.0


def test_samples_of_textures_and_numbers() -> None:
    result = sampled("distance_texture")
    field = result["distance_map"]
    assert isinstance(field, Texture) and field.dim == "3D" and field.levels[0].dtype == np.float16
    stored = field.levels[0][..., 0].astype(np.float64)
    steps = [np.abs(np.diff(stored, axis=axis)).max() for axis in range(3)]
    assert stored.min() < 0.5 < stored.max() and max(steps) <= 0.5 / 16 + 1e-3, "a distance field"
    hard = sampled("base_color")["base_color_texture"].levels[0]
    assert hard.min() == 0.0 and hard.max() == 1.0
    taps = sampled("thinness_uniform")["taps"]
    assert taps.dtype.kind == "i" and taps.min() == 1 and taps.max() == 58
    matrix = sampled("depth_map_thickness")["light_matrix"]
    assert matrix.shape == (2000, 4, 4) and (matrix[..., 3] == [0.0, 0.0, 0.0, 1.0]).all()


def test_samples_are_the_same_for_the_same_seed() -> None:
    first, again, other_seed = (sampled("box", 50, seed) for seed in (3, 3, 4))
    assert all((first[name] == again[name]).all() and (first[name] != other_seed[name]).any() for name in first)
    assert (sampled("sphere", 50)["p"] == first["p"]).all(), "a parameter's numbers do not depend on the others"


def test_samples_give_finite_results_for_every_technique() -> None:
    """All results are finite, except those of the baseline without a far limit."""
    for name in library.index():
        chosen = subject(name)
        outputs = run(chosen, fit_inputs(chosen, samples(chosen, 200, 3)), backends.get("numpy"))
        bad = [key for key, value in outputs.items() if value.dtype.kind == "f" and not np.isfinite(value).all()]
        assert not bad or name == "cheap_sss_raymarch", f"{name}: {bad}"


# sssgen eval --samples


def test_eval_compares_on_samples(capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["eval", "voronoi_thickness", "--samples", "3000", "--seed", "5", "--backend", "numpy,numpy-f32"]
    assert cli.main(arguments) == 0
    output = capsys.readouterr().out
    assert "3000 lanes" in output and "ill-conditioned lanes excluded" in output and "result:" not in output
    assert cli.main([*arguments, "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["lanes"] == 3000 and data["outputs"] == {} and data["backends"][1]["excluded"] > 0


def test_inputs_of_eval_replace_samples(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "in.json").write_text('{"through": 0.0}', encoding="utf-8")
    arguments = ["eval", "lobe_gdc2011", "--samples", "20", "--inputs", str(tmp_path / "in.json"), "--json"]
    assert cli.main(arguments) == 0
    assert not np.any(json.loads(capsys.readouterr().out)["outputs"]["result"])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--samples", "0"], "--samples 0 is not a number of samples"),
        (["--samples", "2000000"], "from 1 to 1000000"),
        (["--samples", "many"], "expected a whole number, not 'many'"),
        (["--samples", "5", "--seed", "-1"], "--seed -1 is negative"),
    ],
)
def test_eval_refuses(arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["eval", "box", *arguments]) == 2
    assert message in capsys.readouterr().err
