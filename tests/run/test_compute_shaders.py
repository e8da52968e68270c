"""Compute shaders of plain GLSL run in WebGPU, OpenGL and, as Metal, on the processor, and are compared with NumPy."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest

from folders import TESTS
from sssgen.lang.plain_glsl import load_glsl
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Backend, Bound, Place, Text
from sssgen.run.backends.dispatch import Dispatch, by_opengl, by_webgpu
from sssgen.run.backends.metal_kernel import run_kernel
from sssgen.run.render import metal_values, shell_values
from sssgen.targets.runtime.numpy_textures import Texture

Array = np.ndarray[Any, Any]
Run = Callable[[str, tuple[int, int, int], Mapping[str, Array], Mapping[str, Any], "Array | None"], dict[str, Array]]
TARGETS = {"gl": "glsl-330", "webgpu": "wgsl", "metal": "metal"}


@pytest.fixture(params=list(TARGETS))
def run(request: pytest.FixtureRequest, backend: Callable[[str], Backend]) -> Run:
    machine: Any = backend(request.param)

    def run(
        name: str, groups: tuple[int, int, int], buffers: Mapping[str, Array], values: Mapping[str, Any],
        picture: Array | None,
    ) -> dict[str, Array]:  # fmt: skip
        module = load_glsl(TESTS / "transpile" / f"{name}.comp", f"{name}.comp").module
        result = transpile(module, TARGETS[request.param], name, keep=True)
        reflection = result.reflection
        x, y, z = module.workgroup
        dispatch = Dispatch(
            Text(next(iter(result.files.values()))), groups, (x, y, z), buffers,
            {one["block"]: one["binding"]["binding"] for one in reflection["storage_buffers"]},
            next(iter(reflection["files"][0]["stages"].values())), values,
            group=1 if request.param == "webgpu" else 0,
            readonly=frozenset(one["block"] for one in reflection["storage_buffers"] if one["access"] == "readonly"),
        )  # fmt: skip
        if picture is not None:
            (texture,) = reflection["textures"]
            binding = texture.get("binding", {})
            place = Place(binding.get("group", 0), binding.get("texture", 0), binding.get("sampler", -1))
            dispatch = dispatch._replace(textures={texture["name"]: Bound(Texture(picture), place)})
        if request.param == "gl":
            return by_opengl(machine, dispatch)
        if request.param == "webgpu":
            size = reflection["uniform_block_size"] or 0
            block = shell_values.material_block(size, reflection["uniforms"], values)
            return by_webgpu(machine, dispatch._replace(block=block))
        lengths = {one["name"]: [buffers[block].size] for one in reflection["uniforms"]
                   for block in buffers if f" of {block}." in one["doc"]}  # fmt: skip
        block = metal_values.material_block(reflection, {**values, **lengths})
        after = run_kernel(machine, dispatch._replace(block=block), order=2)
        assert after.fault == ""
        return after.buffers

    return run


def test_a_prefix_sum(run: Run) -> None:
    values = np.random.default_rng(1).integers(0, 100, 200).astype(np.float32)
    buffers = {"Input": values, "Output": np.zeros(200, np.float32), "Totals": np.zeros(4, np.float32)}
    results = run("prefix_sum", (4, 1, 1), buffers, {}, None)
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
    results = run("histogram", (3, 1, 1), buffers, {"count": np.array(150), "scale": np.array(16.0)}, None)
    bins = np.minimum(texels["value"] * np.float32(16.0), 15.0).astype(int)
    np.testing.assert_array_equal(results["Bins"], np.bincount(bins, texels["weight"], 16))
    low, high, flag, mixed, old, new = results["Extremes"]
    assert (low, high) == (texels["place"][:, 0].min(), texels["place"][:, 1].max())
    assert (flag, mixed, new) == (1, np.bitwise_xor.reduce(np.arange(150)), 7)
    assert old in (0, 7)


def test_a_blur(run: Run) -> None:
    picture = np.random.default_rng(3).random((5, 70, 4)).astype(np.float16).astype(np.float32)
    weights = np.array([0.4, 0.2, 0.1], np.float32)
    buffers = {"Result": np.zeros((5, 70, 4), np.float32)}
    results = run("blur", (3, 5, 1), buffers, {"weights": weights}, picture)
    padded = np.pad(picture, ((0, 0), (2, 2), (0, 0)), mode="edge")
    expected = sum(weights[abs(step)] * padded[:, 2 + step : 72 + step] for step in range(-2, 3))
    np.testing.assert_allclose(results["Result"], expected, rtol=1e-5)
