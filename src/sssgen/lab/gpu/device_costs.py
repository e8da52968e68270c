"""The cost of operators on a device, measured once: nanoseconds of a chain without drawing it.

A device's file has the nanoseconds per pixel of an operation, a transcendental, a fetch of a picture and of a volume,
and a distance evaluation, which benchmarks/device_costs.py measures. The predicted cost of a chain is their sum over
its static counts.
"""

from __future__ import annotations

import os
import tomllib
from functools import cache
from typing import Literal, NamedTuple

from sssgen.lab.chart.record import Measurement, Point, Record, fronts_of
from sssgen.lab.measure.measured_point import PointCost
from sssgen.support.diagnostics import did_you_mean, failure

FOLDER = os.path.join(os.path.dirname(__file__), "devices")
Operator = Literal["operations", "transcendentals", "fetches", "volume_fetches", "distance_evaluations"]

OPERATORS: tuple[Operator, ...] = ("operations", "transcendentals", "fetches", "volume_fetches", "distance_evaluations")
"""The static counts of a chain that have a cost."""
LEAST = 1e-3
"""The least predicted cost, in nanoseconds: an empty chain costs nothing."""


class Device(NamedTuple):
    """What operators cost on a device."""

    name: str
    renderer: str
    driver: str
    software: bool
    """Whether it is a rasteriser on the CPU: its costs order chains there, and say nothing about GPUs"""
    ns: tuple[float, ...]
    """Nanoseconds per pixel, in the order of OPERATORS"""

    def predict(self, cost: PointCost, lights: int = 1) -> float:
        """The nanoseconds per pixel of a chain with these static counts. What it does `once`, it does not repeat for
        each light."""
        once = cost.get("once", {})
        counts = [lights * cost[name] - (lights - 1) * once.get(name, 0) for name in OPERATORS]
        return max(sum(ns * float(count) for ns, count in zip(self.ns, counts, strict=True)), LEAST)

    def text(self) -> str:
        """The device's file."""
        lines = [
            f'renderer = "{self.renderer}"',
            f'driver = "{self.driver}"',
            f"software = {str(self.software).lower()}",
        ]
        lines += ["", "[ns]"]
        return "\n".join([*lines, *(f"{name} = {ns:.5g}" for name, ns in zip(OPERATORS, self.ns, strict=True))]) + "\n"


@cache
def names() -> tuple[str, ...]:
    """The devices with a file."""
    return tuple(sorted(file.removesuffix(".toml") for file in os.listdir(FOLDER) if file.endswith(".toml")))


def load(name: str) -> Device:
    """A device by its name, or by the path of its file. Raises SssgenError."""
    path = name if name.endswith(".toml") else os.path.join(FOLDER, f"{name}.toml")
    if not os.path.isfile(path):
        listed = f"devices: {', '.join(names())}; benchmarks/device_costs.py measures another one"
        raise failure(f"unknown device '{name}'", did_you_mean(name, names()) or listed)
    try:
        with open(path, "rb") as file:
            data = tomllib.load(file)
        ns = tuple(float(data["ns"][operator]) for operator in OPERATORS)
        about = (str(data["renderer"]), str(data["driver"]), bool(data["software"]))
    except (OSError, tomllib.TOMLDecodeError, KeyError, TypeError, ValueError) as error:
        raise failure(
            f"'{name}' is not the file of a device: {error}", "benchmarks/device_costs.py writes one"
        ) from None
    if not all(0.0 <= cost < float("inf") for cost in ns):
        raise failure(f"'{name}' has a cost below 0 or without a limit")
    return Device(os.path.basename(path).removesuffix(".toml"), *about, ns)


def by_device(record: Record, device: Device, lights: int = 1) -> Record:
    """The record with the predicted nanoseconds as the cost, for drawing and picking."""
    points: list[Point] = [
        {
            **point,
            "cost": {
                **point["cost"],
                "static": point["cost"]["value"],
                "value": device.predict(point["cost"], lights),
            },
        }
        for point in record["points"]
    ]
    about: Measurement = {
        **record["record"], "device": device.renderer, "driver": device.driver, "software": device.software
    }  # fmt: skip
    unit = f"ns per pixel on {device.name}, predicted" + (f", {lights} lights" if lights > 1 else "")
    return fronts_of({**record, "record": about, "points": points, "cost": "device", "cost_unit": unit})
