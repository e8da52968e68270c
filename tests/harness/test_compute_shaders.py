"""Compute shaders of plain GLSL run in WebGPU and OpenGL, compared with NumPy: a prefix sum, a histogram, a blur."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest

from folders import TESTS
from sssgen.harness.backends import Backend
from sssgen.lang.plain_glsl import load_glsl
from sssgen.pipeline.compiler import Compiled, transpile

Array = np.ndarray[Any, Any]
Buffers = Mapping[str, Array]
Uniforms = Mapping[str, Any]
Run = Callable[[str, tuple[int, int], Buffers, Uniforms, "Array | None"], dict[str, Array]]


def compiled(name: str, target: str) -> Compiled:
    module = load_glsl(TESTS / "transpile" / f"{name}.comp", f"{name}.comp").module
    return transpile(module, target, name, keep=True)


def by_webgpu(backend: Any) -> Run:
    gpu = backend.gpu

    def run(
        name: str, groups: tuple[int, int], buffers: Buffers, uniforms: Uniforms, picture: Array | None
    ) -> dict[str, Array]:
        result = compiled(name, "wgsl")
        reflection = result.reflection
        entries = []
        if reflection["uniforms"]:
            block = np.zeros(reflection["uniform_block_size"] // 4, np.uint32)
            for uniform in reflection["uniforms"]:
                for index, value in enumerate(np.atleast_1d(uniforms[uniform["name"]])):
                    start = uniform["offset"] // 4 + 4 * index
                    block[start : start + 1] = np.atleast_1d(value).view(np.uint32)
            entries.append((0, {"buffer": gpu.create_buffer_with_data(data=block.tobytes(), usage=0x40)}))
        if picture is not None:
            (texture,) = reflection["textures"]
            height, width = picture.shape[:2]
            stored = gpu.create_texture(size=(width, height, 1), format="rgba32float", usage=0x4 | 0x2)
            gpu.queue.write_texture(
                {"texture": stored}, picture.astype(np.float32).tobytes(), {"bytes_per_row": 16 * width},
                (width, height, 1),
            )  # fmt: skip
            entries.append((texture["binding"]["texture"], stored.create_view()))
        stores = {}
        for buffer in reflection["storage_buffers"]:
            data = buffers[buffer["block"]]
            stores[buffer["block"]] = gpu.create_buffer_with_data(data=data.tobytes(), usage=0x80 | 0x4)
            entries.append((buffer["binding"]["binding"], {"buffer": stores[buffer["block"]]}))
        module = gpu.create_shader_module(code=next(iter(result.files.values())))
        pipeline = gpu.create_compute_pipeline(layout="auto", compute={"module": module, "entry_point": "compute_main"})
        encoder = gpu.create_command_encoder()
        work = encoder.begin_compute_pass()
        work.set_pipeline(pipeline)
        listed = [{"binding": place, "resource": resource} for place, resource in entries]
        work.set_bind_group(1, gpu.create_bind_group(layout=pipeline.get_bind_group_layout(1), entries=listed))
        work.dispatch_workgroups(*groups)
        work.end()
        gpu.queue.submit([encoder.finish()])
        return {
            block: np.frombuffer(gpu.queue.read_buffer(store), buffers[block].dtype).reshape(buffers[block].shape)
            for block, store in stores.items()
        }

    return run


def by_opengl(backend: Any) -> Run:
    def run(
        name: str, groups: tuple[int, int], buffers: Buffers, uniforms: Uniforms, picture: Array | None
    ) -> dict[str, Array]:
        result = compiled(name, "glsl-330")
        with backend.context as context:
            program = context.compute_shader(next(iter(result.files.values())))
            for uniform, value in uniforms.items():
                program[uniform].value = value.tolist() if isinstance(value, np.ndarray) else value
            if picture is not None:
                texture = context.texture(picture.shape[1::-1], 4, picture.astype(np.float32).tobytes(), dtype="f4")
                texture.use(0)
            stores = {}
            for buffer in result.reflection["storage_buffers"]:
                stores[buffer["block"]] = context.buffer(buffers[buffer["block"]].tobytes())
                stores[buffer["block"]].bind_to_storage_buffer(buffer["binding"]["binding"])
            program.run(*groups)
            context.finish()
            return {
                block: np.frombuffer(store.read(), buffers[block].dtype).reshape(buffers[block].shape)
                for block, store in stores.items()
            }

    return run


@pytest.fixture(params=["gl", "webgpu"])
def run(request: pytest.FixtureRequest, backend: Callable[[str], Backend]) -> Run:
    machine = backend(request.param)
    return by_webgpu(machine) if request.param == "webgpu" else by_opengl(machine)


def test_a_prefix_sum(run: Run) -> None:
    values = np.random.default_rng(1).integers(0, 100, 200).astype(np.float32)
    buffers = {"Input": values, "Output": np.zeros(200, np.float32), "Totals": np.zeros(4, np.float32)}
    results = run("prefix_sum", (4, 1), buffers, {}, None)
    groups = np.pad(values, (0, 56)).reshape(4, 64)
    np.testing.assert_array_equal(results["Output"], groups.cumsum(axis=1).ravel()[:200])
    np.testing.assert_array_equal(results["Totals"], groups.sum(axis=1))


def test_a_histogram(run: Run) -> None:
    rng = np.random.default_rng(2)
    texels = np.zeros(150, [("place", np.float32, 2), ("value", np.float32), ("weight", np.uint32)])
    texels["place"], texels["value"] = rng.integers(-50, 50, (150, 2)), rng.uniform(0.0, 1.0, 150)
    texels["weight"] = rng.integers(1, 5, 150)
    extremes = np.array([900, -900, 0, 0, 0, 0], np.int32)
    buffers = {"Texels": texels, "Bins": np.zeros(16, np.uint32), "Extremes": extremes}
    results = run("histogram", (3, 1), buffers, {"count": np.uint32(150), "scale": np.float32(16.0)}, None)
    bins = np.minimum(texels["value"] * np.float32(16.0), 15.0).astype(int)
    np.testing.assert_array_equal(results["Bins"], np.bincount(bins, texels["weight"], 16))
    low, high, flag, mixed, old, new = results["Extremes"]
    assert (low, high) == (texels["place"][:, 0].min(), texels["place"][:, 1].max())
    assert (flag, mixed, new) == (1, np.bitwise_xor.reduce(np.arange(150)), 7)
    assert old in (0, 7)


def test_a_blur(run: Run) -> None:
    picture = np.random.default_rng(3).random((5, 70, 4)).astype(np.float32)
    weights = np.array([0.4, 0.2, 0.1], np.float32)
    buffers = {"Result": np.zeros((5, 70, 4), np.float32)}
    results = run("blur", (3, 5), buffers, {"weights": weights}, picture)
    padded = np.pad(picture, ((0, 0), (2, 2), (0, 0)), mode="edge")
    expected = sum(weights[abs(step)] * padded[:, 2 + step : 72 + step] for step in range(-2, 3))
    np.testing.assert_allclose(results["Result"], expected, rtol=1e-5)
