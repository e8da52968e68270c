"""Errata: on every back end, published techniques have the predicted errors, and those of the library are correct."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from qualification.errata import (
    BACKENDS,
    CHAPTERS,
    ERRATA,
    OPEN,
    TEXT_ERRATA,
    WITHOUT_ERRATA,
    Erratum,
    Right,
    as_corrected,
    as_published,
    holds,
    shows,
)
from sssgen.material import library
from sssgen.run.backends import Backend

Get = Callable[[str], Backend]

PUBLISHED_FIGURES = {
    ("Cheap SSS", "range"): (0.38667, 0.37700, 0.29467, 0.09333, 0.0),
    ("Cheap SSS", "nearest face"): (0.19333, 0.04667),
    ("Cheap SSS", "the dead centre"): (0.0,),
    ("Cheap SSS, attenuated", "half-space"): (0.16068,),
    ("Unity ice", "the zero lobe"): (0.0,),
    ("Subsurface Parallax", "undefined index: total reflection"): (41.81,),
}
"""Figures that were computed by hand from the formulas of the sources."""


def description(erratum: Erratum, result: tuple[float, ...]) -> str:
    return f"{erratum.source}, {erratum.name}: {result}"


@pytest.mark.parametrize("name", BACKENDS)
def test_the_published_techniques_have_the_predicted_errors(backend: Get, name: str) -> None:
    machine = backend(name)
    for erratum in ERRATA:
        if erratum.everywhere:
            result = as_published(erratum, machine)
            assert shows(erratum, result), description(erratum, result)
            assert not holds(erratum, result), description(erratum, result)


@pytest.mark.parametrize("name", BACKENDS)
def test_the_corrected_techniques_are_within_their_bounds(backend: Get, name: str) -> None:
    machine = backend(name)
    for erratum in ERRATA:
        result = as_corrected(erratum, machine)
        assert holds(erratum, result), description(erratum, result)
        assert not erratum.everywhere or not shows(erratum, result), description(erratum, result)


def test_undefined_results_are_wrong_somewhere(backend: Get) -> None:
    """Undefined results are wrong in NumPy's float32, where pow(0, 0) is 1. A driver may give the right number."""
    undefined = [erratum for erratum in ERRATA if not erratum.everywhere and erratum.name != "pow(0, 0)"]
    assert len(undefined) >= 4
    for erratum in undefined:
        result = as_published(erratum, backend("numpy-f32"))
        assert not holds(erratum, result), description(erratum, result)


def test_predicted_errors_equal_the_published_figures() -> None:
    for erratum in ERRATA:
        if published := PUBLISHED_FIGURES.get((erratum.source, erratum.name)):
            assert erratum.theory == pytest.approx(published, abs=6e-6, rel=1e-5)
    assert set(PUBLISHED_FIGURES) <= {(erratum.source, erratum.name) for erratum in ERRATA}


def test_every_published_source_has_errata() -> None:
    baselines = {name for name, path in library.index().items() if library.folder_of(path) == "baselines"}
    wrong = {erratum.published.technique for erratum in (*ERRATA, *OPEN)} & baselines
    assert baselines == wrong | set(WITHOUT_ERRATA)
    assert not wrong & set(WITHOUT_ERRATA)
    assert not {erratum.correction.technique for erratum in ERRATA} & baselines
    assert {"Cheap SSS", "Alisavakis", "3D Distance Fields", "Unity ice", "Subsurface Parallax"} <= set(CHAPTERS)
    assert len({(erratum.source, erratum.name) for erratum in ERRATA}) == len(ERRATA)
    assert all(entry.reason for entry in TEXT_ERRATA)


def test_open_errata_are_not_fixed(backend: Get) -> None:
    for erratum in OPEN:
        assert shows(erratum, as_published(erratum, backend("numpy-f32")))
        result = as_corrected(erratum, backend("numpy-f32"))
        assert not holds(erratum, result), f"{description(erratum, result)} is within its bound: move it to its chapter"


def test_errata_are_compared_with_tolerances() -> None:
    erratum = ERRATA[0]._replace(theory=(1.0, math.nan, math.inf), right=(Right(0.0, 1.0),))
    assert shows(erratum, (1.00009, math.nan, math.inf)) and shows(erratum, (1.0, math.nan, math.nan))
    for wrong in ((1.001, math.nan, math.inf), (1.0, 0.0, math.inf), (1.0, math.nan, 9.0), (1.0, math.nan)):
        assert not shows(erratum, wrong), wrong
    assert holds(erratum, (0.0,)) and holds(erratum, (1.0,))
    for bad in ((1.1,), (-0.1,), (math.nan,), (math.inf,), (0.5, 0.5), ()):
        assert not holds(erratum, bad), bad
