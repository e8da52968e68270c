"""A chart's second cost: milliseconds on this machine's GPU, of each chain's emitted shader at its scene's points.

The emitted shader is timed with the scene's lights; the time of the same shader without the chain is subtracted.
"""

from __future__ import annotations

import dataclasses
import os
import tempfile
from collections.abc import Callable, Sequence
from typing import Literal

import numpy as np

from sssgen.lab.chart.picked_material import stages_of
from sssgen.lab.chart.record import Point, Record
from sssgen.lab.gpu import gpu_timing as gpu_cost
from sssgen.lab.gpu import timed_programs as gpu_programs
from sssgen.lab.gpu.gpu_timing import ProgramTimes
from sssgen.lab.measure.measured_chain import material_of
from sssgen.lab.measure.measured_point import FittedChain, GpuTimes
from sssgen.material import library
from sssgen.material.material_text import MaterialSection
from sssgen.material.model import Material
from sssgen.pipeline.compiler import compile
from sssgen.scene.measured import scene_body as body
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.scene import Scene
from sssgen.scene.scene_loading import parse_scene

AT_ONCE = 40
"""Programs that alternate; with more of them, a round is so long that clocks change in it."""
EVALUATIONS = 8
"""Evaluations of a chain per pixel: the reads of the points would hide the time of a single evaluation."""
LEAST = 1e-4
"""The least cost in milliseconds: smaller times are not measurable."""
EMPTY = "without"

Progress = Callable[[int, int, str], None]


def with_gpu_cost(
    record: Record,
    scenes: Sequence[MeasuredScene],
    size: tuple[int, int] = gpu_cost.SIZE,
    rounds: int = gpu_cost.ROUNDS,
    progress: Progress = lambda *_: None,
) -> Record:
    """The record with each point's time as its cost, the static cost's rank correlation with it, and the device.

    Failed points are not timed. Raises SssgenError without OpenGL.
    """
    points = [point.copy() for point in record["points"]]
    about = record["record"].copy()
    finished = 0
    for measured in scenes:
        scene_points = [point for point in points if point["scene"] == measured.name and not point["failed"]]
        for start in range(0, len(scene_points), AT_ONCE):
            batch = scene_points[start : start + AT_ONCE]
            times = time_points(measured, batch, size, rounds)
            for number, point in enumerate(batch):
                net = times.net_times[str(number)] - times.net_times[EMPTY]
                low, median, high = (float(value) for value in np.percentile(net, [10.0, 50.0, 90.0]))
                point["cost"] = {**point["cost"], **_cost(low, median, high, times)}
            finished += len(batch)
            progress(finished, len(points), measured.name)
            about |= {"device": times.device.renderer, "driver": times.device.version}
            about |= {"software": times.device.software, "size": list(size), "rounds": rounds}
    about["rank_correlation"] = correlations(points)
    return {**record, "record": about, "points": points}


def _cost(low: float, median: float, high: float, times: ProgramTimes) -> GpuTimes:
    """Times as a cost; on a software rasteriser only the ratio to the shader without the chain."""
    without = max(float(np.median(times.net_times[EMPTY])), LEAST)
    ratio: GpuTimes = {"gpu_ratio": max(median, LEAST) / without}
    if times.device.software:
        return ratio
    return {**ratio, "gpu_ms": max(median, LEAST), "gpu_ms_low": low, "gpu_ms_high": high}


def by_gpu(record: Record) -> Record:
    """The record with GPU times as the cost for drawing and picking; it omits points without a time."""
    software = bool(record["record"].get("software"))
    kind: Literal["gpu_ratio", "gpu_ms"] = "gpu_ratio" if software else "gpu_ms"
    points: list[Point] = [
        {**point, "cost": {**point["cost"], "static": point["cost"]["value"], "value": value}}
        for point in record["points"]
        if (value := point["cost"].get(kind)) is not None
    ]
    unit = "× the bare shader" if software else "ms at 1080p"
    return {**record, "points": points, "cost": "gpu", "cost_unit": unit}


def time_points(
    measured: MeasuredScene, points: Sequence[FittedChain], size: tuple[int, int], rounds: int
) -> ProgramTimes:
    """The times of the points' shaders, named by their numbers, and of the shader without a chain, EMPTY."""
    scene = _drawable(measured)
    surface_points = gpu_programs.surface_points(scene, size)
    shape = body.body(measured.geometry)
    programs = []
    with tempfile.TemporaryDirectory() as folder:
        for name, text in shape.files.items():
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
        chains: list[tuple[str, Sequence[MaterialSection]]] = [(EMPTY, ())]
        chains += [(str(number), stages_of(point, shape, measured.medium)) for number, point in enumerate(points)]
        plain = MaterialSection("surface", library.setter("albedo")[0])
        for name, stages in chains:
            surface = [] if any(stage.section == "surface" for stage in stages) else [plain]
            material = material_of([*stages, *surface], folder)
            fitting = _with_parameters(scene, measured, material)
            programs.append(gpu_programs.of_material(name, material, fitting, surface_points, EVALUATIONS))
    return gpu_cost.measure(programs, size, rounds)


def _drawable(measured: MeasuredScene) -> Scene:
    """The scene as a Scene for drawing."""
    scene = parse_scene("[medium]", f"{measured.name}.toml")  # everything else has its default
    return dataclasses.replace(scene, geometry=measured.geometry, camera=measured.camera, lights=measured.lights)


def _with_parameters(scene: Scene, measured: MeasuredScene, material: Material) -> Scene:
    """The scene with the parameters and textures of the body that the material's shader reads."""
    reflection = compile(material, gpu_programs.TARGET).reflection
    texture = body.distance_texture(measured.geometry)
    values = {
        **body.texture_parameters(texture),
        **(measured.inlay.parameters if measured.inlay is not None else {}),
    }
    read = {uniform["source_name"] for uniform in reflection["uniforms"]}
    textures = {declared["source_name"] for declared in reflection["textures"]}
    return dataclasses.replace(
        scene,
        parameters={name: value for name, value in values.items() if name in read},
        textures={"distance_map": texture} if "distance_map" in textures else {},
    )


def correlations(points: Sequence[Point]) -> dict[str, float]:
    """Spearman's rank correlation of static and measured cost, over all scenes, by role."""
    result = {}
    for role in dict.fromkeys(point["role"] for point in points):
        timed = [point["cost"] for point in points if point["role"] == role and "gpu_ratio" in point["cost"]]
        if len(timed) > 1:
            static = ranks([float(cost.get("static", cost["value"])) for cost in timed])
            measured = ranks([float(cost["gpu_ratio"]) for cost in timed])
            if np.ptp(static) > 0.0 and np.ptp(measured) > 0.0:
                result[role] = float(np.corrcoef(static, measured)[0, 1])
    return result


def ranks(values: Sequence[float]) -> np.ndarray:
    """The values' ranks; equal values have the mean of their ranks."""
    _, inverse, counts = np.unique(np.array(values), return_inverse=True, return_counts=True)
    last = np.cumsum(counts)
    return (last - 0.5 * (counts - 1))[inverse]
