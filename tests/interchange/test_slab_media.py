"""Imported media of glTF volumes reflect and transmit what the extensions define: a few points of the benchmark."""

from __future__ import annotations

import importlib.util

import pytest

from folders import ROOT

pytest.importorskip("iadpython")
pytest.importorskip("scipy")

spec = importlib.util.spec_from_file_location("slab_check", ROOT / "benchmarks" / "slab_check.py")
assert spec is not None and spec.loader is not None
slab_check = importlib.util.module_from_spec(spec)
spec.loader.exec_module(slab_check)


def test_imported_media_are_those_of_the_extensions() -> None:
    differences = slab_check.run_slabs(9)
    assert differences["largest difference of reflectance"] < 0.01
    assert differences["largest difference of transmittance"] < 0.01
    assert differences["largest difference if the colour were the albedo"] > 0.05


@pytest.mark.parametrize(("albedo", "depth"), [(0.0, 1.0), (1.0, 3.0)])
def test_the_doubling_method_keeps_energy(albedo: float, depth: float) -> None:
    reflected, transmitted = slab_check.doubled(albedo, depth, 0.5)
    if albedo == 0.0:
        assert reflected == pytest.approx(0.0, abs=1e-6)
        assert transmitted == pytest.approx(2.718281828**-depth, rel=1e-5)
    else:
        assert reflected + transmitted == pytest.approx(1.0, abs=1e-4)
