"""Every builtin on every back end, compared with NumPy in float64: errors are within the limits of the table."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
import pytest

from folders import DOCS
from qualification.pages import parity as parity_page
from qualification.parity import BACKENDS, FULL, Figure, cases, measure, oracle, supported
from slow_cases import back_end_cases
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.types import FLOAT
from sssgen.lang import polyfills
from sssgen.run.backends import Backend

LANES = 240


def failures(figures: dict[str, Figure]) -> str:
    return "\n".join(f"{name}: {figure}" for name, figure in figures.items() if not figure.right)


@pytest.mark.parametrize("name", back_end_cases([*BACKENDS, "metal"], "unity"))
def test_every_builtin_is_within_its_limits(name: str, backend: Callable[[str], Backend]) -> None:
    gpu = backend(name)
    figures = measure(gpu, cases(LANES))
    assert set(figures) == {case.name for case in cases(LANES) if supported(case, gpu)}
    assert not failures(figures), failures(figures)


@pytest.mark.slow
@pytest.mark.parametrize("name", BACKENDS)
def test_every_builtin_is_within_its_limits_on_many_arguments(name: str, backend: Callable[[str], Backend]) -> None:
    figures = measure(backend(name), cases(FULL))
    assert not failures(figures), failures(figures)


def test_the_cases_cover_all_overloads_and_are_deterministic() -> None:
    result = cases(LANES)
    titles = {case.title for case in result}
    assert len(titles) == len(result)
    assert {case.name for case in result} == set(BUILTINS)
    assert {"mix(vec3, vec3, bvec3)", "mod(vec4, float)", "clamp(uvec2, uint, uint)", "inverse(mat4)"} <= titles
    cases.cache_clear()
    for case, repeated in zip(result, cases(LANES), strict=True):
        for argument, repeated_argument in zip(case.args, repeated.args, strict=True):
            np.testing.assert_array_equal(argument, repeated_argument)


@pytest.mark.parametrize("name", ["floor", "exp", "mod", "packHalf2x16", "clamp", "inverse"])
def test_arguments_reach_the_edges_and_stay_in_the_domain(name: str) -> None:
    chosen = [case for case in cases(LANES) if case.name == name]
    assert all(case.lanes == LANES for case in chosen)
    for case in chosen:
        assert np.isfinite(oracle(case)).mean() > 0.9
    first = np.concatenate([case.args[0].ravel() for case in chosen])
    assert 0 in first and (first < 0).any() and len(np.unique(first)) > 50


# A faulty rule is detected


@contextmanager
def mod_as_fmod(monkeypatch: pytest.MonkeyPatch, native: bool) -> Iterator[None]:
    """A table whose `mod` computes `fmod`; with `native`, HLSL calls its own function."""
    fmod = BUILTINS["fmod"]
    texts = {**fmod.texts, "hlsl": "fmod"} if native else fmod.texts
    broken = BUILTINS["mod"]._replace(texts=texts, polyfill=fmod.polyfill.replace(" fmod(", " mod("))
    with monkeypatch.context() as patch:
        patch.setitem(BUILTINS, "mod", broken)
        polyfills._polyfill.cache_clear()
        yield
    polyfills._polyfill.cache_clear()


@pytest.mark.parametrize(
    ("name", "native"),
    [("gl", False), ("gl-es", False), ("webgpu", False), ("browser", False), ("hlsl", False), ("hlsl", True),
     ("hlsl-glslang", False), ("unity", False), ("unity-urp", False), ("unity-urp", True)],
)  # fmt: skip
def test_a_faulty_rule_is_detected(
    name: str, native: bool, backend: Callable[[str], Backend], monkeypatch: pytest.MonkeyPatch
) -> None:
    gpu = backend(name)
    chosen = [case for case in cases(LANES) if case.result == FLOAT and set(case.params) == {FLOAT}]
    with mod_as_fmod(monkeypatch, native):
        figures = measure(gpu, chosen)
    assert {result for result, figure in figures.items() if not figure.right} == {"mod"}
    title, _, rest = figures["mod"].at.partition(" at ")
    arguments = [float(number) for number in rest.partition(":")[0].split(", ")]
    assert title == "mod(float, float)"
    assert min(arguments) < 0.0 < max(arguments)
    assert measure(gpu, [case for case in chosen if case.name == "mod"])["mod"].right


# The page


def test_the_page_of_parity_has_every_builtin_and_its_limit() -> None:
    rows = re.findall(r"^\| `(\w+)` \| (.*?) \|", (DOCS / "parity.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert rows == [(name, parity_page.allowed(row)) for name, row in BUILTINS.items()], (
        "run python -m qualification.pages.parity"
    )
