"""The cost on a GPU, with any OpenGL: timed programs compute the right values, and figures follow from the times.

No test depends on a clock: tests of figures count the rounds of a loop instead of milliseconds.
"""

from __future__ import annotations

import dataclasses
import importlib.util
from collections.abc import Callable
from types import ModuleType

import numpy as np
import pytest

from folders import ROOT
from sssgen.lab.gpu import gpu_timing as gpu_cost
from sssgen.lab.gpu import timed_programs as gpu_programs
from sssgen.lab.gpu.gpu_timing import Program, ProgramTimes
from sssgen.run import backends
from sssgen.run.backends import Backend
from sssgen.run.evaluate import evaluation as evaluate
from sssgen.run.evaluate.probes import subject
from sssgen.run.render import scene_render as render
from sssgen.scene import scene_loading
from sssgen.scene.camera import Camera
from sssgen.scene.pictures.images import decode_srgb
from sssgen.scene.pictures.picture_difference import compare
from sssgen.support.diagnostics import SssgenError

SIZE = (64, 36)
LOOP = """#version 330 core
uniform int count;
in vec2 v_uv;
out vec4 color;
void main() {
    color = vec4(0.0);
    for (int i = 0; i < count; i++) {
        color += sin(v_uv.xyxy * float(i));
    }
}
"""
FLOOR = """#version 330 core
in vec2 v_uv;
out vec4 color;
void main() { color = v_uv.xyxy; }
"""


@pytest.fixture(autouse=True)
def opengl(backend: Callable[[str], Backend]) -> Backend:
    return backend("gl")


@pytest.fixture(scope="module")
def benchmark() -> ModuleType:
    """The module benchmarks/gpu.py, which is not part of the package."""
    result = importlib.util.spec_from_file_location("gpu", ROOT / "benchmarks" / "gpu.py")
    assert result is not None and result.loader is not None
    module = importlib.util.module_from_spec(result)
    result.loader.exec_module(module)
    return module


@pytest.fixture
def loop_rounds(monkeypatch: pytest.MonkeyPatch) -> None:
    """Counts the rounds of LOOP instead of milliseconds."""
    monkeypatch.setattr(gpu_cost._TimedFrame, "time", lambda frame, linked: float(linked.array.program["count"].value))


def measure_times(*programs: Program) -> ProgramTimes:
    return gpu_cost.measure(programs, (128, 72), rounds=5, sample=1.0)


def test_a_ratio_is_the_quotient_of_the_times(loop_rounds: None) -> None:
    timing = measure_times(Program("few", LOOP, {"count": 20}), Program("many", LOOP, {"count": 2000}))
    assert timing.ratio("many", "few") == (100.0, 100.0, 100.0)
    assert timing.ratio("few", "many").median == 0.01


def test_the_floor_is_subtracted(loop_rounds: None) -> None:
    floored = Program("floored", LOOP, {"count": 500}, floor=LOOP.replace("sin", "cos"))
    timing = measure_times(floored, Program("bare", LOOP, {"count": 500}))
    assert timing.raw("floored").median == 500.0 and timing.net("floored").median == 0.0
    assert timing.net("bare") == timing.raw("bare") == (500.0, 500.0, 500.0)


def test_the_net_time_is_per_evaluation(loop_rounds: None) -> None:
    timing = measure_times(Program("ten", LOOP, {"count": 1000}, evaluations=10))
    assert timing.net("ten").median == 100.0 and timing.raw("ten").median == 1000.0


def test_the_record_names_the_device(opengl: Backend) -> None:
    timing = measure_times(Program("one", LOOP, {"count": 10}, floor=FLOOR))
    record = timing.record()
    assert record["device"] in opengl.device() and record["size"] == [128, 72] and record["rounds"] == 5
    assert record["software"] == ("llvmpipe" in record["device"] or "softpipe" in record["device"])
    frame = record["programs"]["one"]["frame_ms"]
    assert 0.0 < frame["low"] <= frame["median"] <= frame["high"]


def test_a_program_that_the_driver_refuses() -> None:
    with pytest.raises(SssgenError, match=r"gl: broken: .*unknown"):
        measure_times(Program("broken", FLOOR.replace("v_uv.xyxy", "unknown")))


def test_without_opengl(monkeypatch: pytest.MonkeyPatch) -> None:
    def lacks(name: str) -> Backend:
        raise backends.CompilerMissing("pip install moderngl")

    monkeypatch.setattr(backends, "get", lacks)
    with pytest.raises(SssgenError, match="the back end gl is missing"):
        measure_times(Program("one", FLOOR))


def test_a_technique_is_computed() -> None:
    points = gpu_programs.ball_points(SIZE)
    measured = gpu_cost.picture(gpu_programs.of_technique("lobe_normalized", points), SIZE)[..., 0].ravel()
    place, normal = points.position[..., :3].reshape(-1, 3), points.normal[..., :3].reshape(-1, 3)
    uv = np.stack([points.position[..., 3], points.normal[..., 3]], axis=-1).reshape(-1, 2)
    view, light = (np.array(at) - place for at in (gpu_programs.EYE, gpu_programs.LIGHT))
    values = {"V": view, "L": light, "N": normal}
    values = {name: value / np.linalg.norm(value, axis=1, keepdims=True) for name, value in values.items()}
    expected = evaluate.evaluate(
        subject("lobe_normalized"), {**values, "through": (uv @ [3.0, 5.0]) % 1.0}, backends.get("numpy")
    )
    np.testing.assert_allclose(measured, expected["result"][:, 0], atol=2e-4)


def test_values_of_a_technique() -> None:
    points = gpu_programs.ball_points(SIZE)
    ball = {"body_distance": "sphere"}
    # the result is (1 - diameter / (2 reach))^2 on a ball, and 0 if all taps are in its nearer half
    for reach, expected in ((0.9, 0.0), (2.0, 0.25)):
        program = gpu_programs.of_technique("thinness_uniform", points, ball, values={"reach": reach, "taps": 60})
        np.testing.assert_allclose(gpu_cost.picture(program, SIZE)[..., 0], expected, atol=0.01)
    with pytest.raises(SssgenError, match="has no parameter 'reech'"):
        gpu_programs.of_technique("thinness_uniform", points, ball, values={"reech": 1.0})


def test_evaluations_add_up() -> None:
    points = gpu_programs.ball_points(SIZE)
    programs = [gpu_programs.of_technique("wrap_lighting", points, evaluations=count) for count in (1, 8)]
    once, often = (gpu_cost.picture(program, SIZE) for program in programs)
    np.testing.assert_allclose(often[..., :3], 8.0 * once[..., :3], atol=0.01)
    assert np.abs(often - 8.0 * once).max() > 1e-4  # each evaluation is at another place


@pytest.mark.parametrize("name", ["paper_lantern", "jade_ring"])
def test_a_material_has_its_scene_s_colours(opengl: Backend, name: str) -> None:
    """The timing pass stretches the visible points over the picture, so only the mean is compared."""
    scene = render.with_samples(scene_loading.load(name), 1)
    points = gpu_programs.surface_points(scene, SIZE)
    result = gpu_cost.picture(gpu_programs.of_material(name, scene.material, scene, points), SIZE)[..., :3]
    picture = render.render(dataclasses.replace(scene, shell={}), opengl, size=SIZE)  # the timing has no environment
    mean = picture.linear[picture.covered == 1.0].mean(axis=0) / scene.exposure
    np.testing.assert_allclose(result.mean(axis=(0, 1)), mean, rtol=0.25)


def test_a_material_with_its_own_camera_is_rendered(opengl: Backend) -> None:
    scene = dataclasses.replace(render.with_samples(scene_loading.load("jelly_cubes"), 1), size=SIZE)
    points = gpu_programs.surface_points(scene, SIZE)
    result = gpu_cost.picture(gpu_programs.of_material("cubes", scene.material, scene, points), SIZE)[::-1, :, :3]
    picture = render.render(scene, opengl)
    np.testing.assert_allclose(decode_srgb(result) * scene.exposure, picture.linear, atol=0.01)


def test_costs_of_materials() -> None:
    names = ("resin_inlay", "wax_mouse")
    scenes = [scene_loading.load(name) for name in names]
    points = [gpu_programs.TimedMaterial(scene.material, scene.material, scene) for scene in scenes]
    timing = gpu_programs.costs(points, size=SIZE, rounds=3)
    assert all(timing.raw(name).low > 0.0 for name in names)


def test_a_camera_that_sees_nothing() -> None:
    scene = scene_loading.load("wax_mouse")
    away = Camera(position=scene.camera.position, target=(0.0, 100.0, 0.0), field_of_view=1.0)
    with pytest.raises(SssgenError, match="sees nothing"):
        gpu_programs.surface_points(dataclasses.replace(scene, camera=away), SIZE)


def test_emitted_techniques_equal_those_written_by_hand(benchmark: ModuleType) -> None:
    """Emitted and handwritten programs compute the same, for every technique of benchmarks/by_hand."""
    pairs = benchmark.techniques(gpu_programs.ball_points(SIZE), 1)
    assert len(pairs) > 40
    for program, reference in pairs:
        emitted, by_hand = gpu_cost.picture(program, SIZE), gpu_cost.picture(reference, SIZE)
        scale = np.abs(emitted).max() + 1e-3
        assert np.abs(emitted - by_hand).max() < 1e-3 * scale, program.name


def test_the_published_seed_0_equals_the_emitted_one(benchmark: ModuleType) -> None:
    size = (320, 180)
    pictures = [
        gpu_cost.picture(make(size[0] / size[1]), size)[::-1, :, :3]
        for make in (benchmark.published, benchmark.emitted)
    ]
    assert compare(*pictures).flip <= 0.01
