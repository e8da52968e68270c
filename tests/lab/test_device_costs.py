"""The cost of operators on a device: from times to costs, and from costs to the order of chains. No clock decides."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest

import operator_times
from operator_times import TimedChains
from sssgen.lab.chart.record import check_record, hypervolumes, on_fronts
from sssgen.lab.gpu import device_costs
from sssgen.lab.gpu.device_costs import OPERATORS, Device
from sssgen.lab.gpu.gpu_timing import Device as Driver
from sssgen.lab.measure.measurement import chain_of, static_cost
from sssgen.run.backends import Backend
from sssgen.scene.measured import measured_scene
from sssgen.scene.measured.scene_body import body
from sssgen.support.diagnostics import SssgenError

pytest.importorskip("scipy", reason="scipy is missing: pip install -e '.[chart]'")

NS = (0.05, 0.4, 7.0, 9.0, 2.0)
DRIVER = Driver("A device", "4.6", False)


def counted() -> list[dict[str, int]]:
    """The static counts of the programs that measure the operators, on the cube."""
    shape = body(measured_scene.load("cube").geometry)
    with TemporaryDirectory() as folder:
        chains = [chain_of(candidate, shape, folder) for candidate in operator_times.operator_chains()]
        return [static_cost(chain)._asdict() for chain in chains]


def timed(counts: list[dict[str, int]], ns: tuple[float, ...] = NS, noise: float = 0.0) -> TimedChains:
    """Times that follow from the counts; noise only lengthens them."""
    exact = np.array([[sum(cost * count[name] for cost, name in zip(ns, OPERATORS, strict=True))] for count in counts])
    rounds = exact * (1.0 + noise * np.random.default_rng(3).exponential(size=(len(counts), 21)))
    return TimedChains(tuple(map(str, range(len(counts)))), tuple(counts), rounds, DRIVER)


def test_each_operator_has_a_program_that_mostly_consists_of_it() -> None:
    counts = counted()
    for index, operator in enumerate(OPERATORS):
        few, many = counts[2 * index : 2 * index + 2]
        assert many[operator] - few[operator] >= operator_times.ROUNDS[1] - operator_times.ROUNDS[0]
        assert all(few[other] <= 1 for other in OPERATORS[2:] if other != operator), operator
    matrix = np.array([[count[operator] for operator in OPERATORS] for count in counts], float)
    assert np.linalg.cond(matrix / np.linalg.norm(matrix, axis=0)) < 100.0  # the times determine all costs


def test_costs_follow_from_times() -> None:
    counts = counted()
    device = operator_times.measured_device("mine", timed(counts))
    assert device.ns == pytest.approx(NS, rel=1e-6) and device.renderer == "A device"
    disturbed = operator_times.measured_device("mine", timed(counts, noise=0.03))
    assert disturbed.ns[0] == pytest.approx(NS[0], rel=0.05) and disturbed.ns[2] == pytest.approx(NS[2], rel=0.1)
    with pytest.raises(SssgenError, match="too fast for the clock"):
        operator_times.measured_device("mine", timed(counts, (0.0, 0.0, 7.0, 0.0, 0.0)))


def test_the_order_of_pairs() -> None:
    counts = [dict.fromkeys(OPERATORS, 0) | {"operations": count} for count in (10, 20, 30, 40)]
    chains = timed(counts)
    assert operator_times.order_of_pairs(chains, [1.0, 2.0, 3.0, 4.0]) == (6, 6, 6, 6)
    assert operator_times.order_of_pairs(chains, [4.0, 3.0, 2.0, 1.0]) == (6, 0, 6, 0)
    assert operator_times.order_of_pairs(chains, [1.0, 1.0, 3.0, 4.0]) == (
        6,
        5,
        6,
        5,
    )  # equal: no order
    # the first two chains' times overlap: the clock cannot tell them apart
    rounds = chains.ns[:, :1] + np.array([-0.4, -0.2, 0.0, 0.2, 0.4]) * np.array([[1], [1], [0], [0]])
    result = operator_times.order_of_pairs(chains._replace(ns=rounds), [2.0, 1.0, 3.0, 4.0])
    assert result == (6, 5, 5, 5)


def test_a_device_is_stored_and_loaded(tmp_path: Path) -> None:
    device = Device("mine", "A device", "4.6", False, NS)
    (tmp_path / "mine.toml").write_text(device.text(), encoding="utf-8")
    assert device_costs.load(str(tmp_path / "mine.toml")) == device
    counts = dict(zip(OPERATORS, (100, 10, 2, 1, 3), strict=True))
    assert device.predict(counts) == pytest.approx(5.0 + 4.0 + 14.0 + 9.0 + 6.0)
    assert device.predict(dict.fromkeys(OPERATORS, 0)) == device_costs.LEAST
    for text in ("", "ns = 3", device.text().replace("\nfetches = 7", '\nfetches = "x"'), "["):
        (tmp_path / "wrong.toml").write_text(text, encoding="utf-8")
        with pytest.raises(SssgenError, match="is not the file of a device"):
            device_costs.load(str(tmp_path / "wrong.toml"))
    (tmp_path / "wrong.toml").write_text(device.text().replace("\nfetches = 7", "\nfetches = -7"), encoding="utf-8")
    with pytest.raises(SssgenError, match="below 0"):
        device_costs.load(str(tmp_path / "wrong.toml"))
    with pytest.raises(SssgenError, match="unknown device 'llvmpip'") as caught:
        device_costs.load("llvmpip")
    assert caught.value.diagnostics[0].hint == "did you mean 'llvmpipe'?"


def test_stored_devices_are_complete() -> None:
    assert "llvmpipe" in device_costs.names()
    for name in device_costs.names():
        device = device_costs.load(name)
        assert device.renderer and device.driver and all(cost >= 0.0 for cost in device.ns) and max(device.ns) > 0.0
        assert device.software == ("llvmpipe" in device.renderer)


def test_a_record_with_predicted_costs_has_their_fronts() -> None:
    def point(label: str, counts: tuple[int, ...], error: float) -> dict[str, Any]:
        cost = dict(zip(OPERATORS, counts, strict=True))
        return {"scene": "s", "role": "material", "name": label, "label": label, "baseline": False, "failed": "",
                "error": {"value": error}, "cost": {"value": float(counts[0]), **cost, "gpu_ms": None}}  # fmt: skip

    points = on_fronts([point("reads", (50, 0, 4, 0, 0), 0.3), point("computes", (100, 0, 0, 0, 0), 0.2)])
    record = {"format": 1, "record": {}, "scenes": [{"name": "s"}], "points": points, "cost": "static",
              "cost_unit": "operations", "hypervolume": hypervolumes(points)}  # fmt: skip
    assert [one["front"] for one in points] == [True, True]
    result = check_record(device_costs.by_device(record, Device("mine", "A device", "4.6", False, NS)))
    assert [one["cost"]["value"] for one in result["points"]] == pytest.approx([30.5, 5.0])
    assert [one["cost"]["static"] for one in result["points"]] == [50.0, 100.0]
    assert [one["front"] for one in result["points"]] == [False, True]
    assert (result["cost"], result["cost_unit"]) == ("device", "ns per pixel on mine, predicted")
    assert result["record"]["device"] == "A device"


def test_the_programs_run(backend: Callable[[str], Backend]) -> None:
    backend("gl")
    chains = operator_times.time_chains(operator_times.operator_chains(), measured_scene.load("cube"), (32, 32), 2)
    assert chains.ns.shape == (10, 2) and np.isfinite(chains.ns).all() and chains.driver.renderer
    assert chains.labels[0] == "operations, 64 rounds" and chains.counts[1]["operations"] > 2000


@pytest.mark.slow
def test_operators_and_materials_are_fitted_together() -> None:
    operators = timed(counted())
    materials = timed([dict(zip(OPERATORS, row, strict=True)) for row in ((90, 5, 2, 1, 0), (40, 2, 1, 3, 0))])
    first, second = operator_times.subset(materials, [0]), operator_times.subset(materials, [1])
    assert (first.labels, second.labels) == (("0",), ("1",)) and first.counts[0]["operations"] == 90
    assert operator_times.union(first, second).typical == pytest.approx(materials.typical)
    device = operator_times.measured_device("mine", operator_times.union(operators, first))
    assert device.predict(second.counts[0]) == pytest.approx(second.typical[0])
