"""The time in which a GPU sums the light inside a body, with the compute shader of sssgen-webgpu.js:

python benchmarks/relight_gpu.py wax.bin [--lights 1 2 4 8] [--runs N]

The file is of `sssgen bake fluence SCENE --relit 32 -o wax.bin`. Half of the lights are distant, half near. The time
is that of a run among many in one submission, by the clock; the volume is compared with that of NumPy first.
"""

from __future__ import annotations

import argparse
import json
import re
import time
from pathlib import Path
from typing import Any

import numpy as np
import wgpu

import sssgen
from sssgen.run.backends import Array
from sssgen.scene import octahedron
from sssgen.scene.light_response import (
    HARMONICS,
    UNSCATTERED,
    Incoming,
    LightResponse,
    arriving_shares,
    from_bytes,
    volume,
)  # fmt: skip

KERNEL = Path(sssgen.__file__).parent / "targets/javascript/webgpu_relight.js"
WORKGROUP = 64


def kernel() -> str:
    """The compute shader, from the module that has it."""
    text = KERNEL.read_text(encoding="utf-8")
    (found,) = re.findall(r"RELIGHT = /\* wgsl \*/ `(.*?)`;", text, re.DOTALL)
    return str(found).replace("${WORKGROUP}", str(WORKGROUP))


def data_of(response: LightResponse) -> list[Array]:
    """What does not change with the light, by binding, as `dataOf` of the module has it."""
    rank, count = response.latents.shape
    groups = -(-rank // 4)
    latents = np.zeros((4 * groups, count), np.uint8)
    latents[:rank] = response.latents
    table = np.zeros((len(response.table), 4 * groups + 1, 4), np.float32)
    table[:, : rank + 1, :3] = response.table
    arriving = response.arriving if response.arriving.size else np.zeros((1, 4), np.uint8)
    around = np.zeros((HARMONICS, count, 4), np.float32)
    around[..., :3] = np.moveaxis(response.surroundings * (response.largest / 127.0)[..., None], 1, 2)
    roots: Array = np.arange(256) * (response.highest / 255.0)
    shares = np.zeros((256, 4), np.float32)
    shares[:, :3] = UNSCATTERED * arriving_shares(roots, response.powers)
    by_voxel = np.ascontiguousarray(np.moveaxis(latents.reshape(groups, 4, count), 1, 2))
    return [response.cells.astype(np.uint32), by_voxel, table, arriving, around, shares]


def frame_of(response: LightResponse, lights: list[tuple[Array, bool, Array]], around: Array) -> Array:
    """The numbers of a frame whose model is the identity; a light has its place, whether it is near, and its colour."""
    floats = np.zeros(32 + 36 + 8 * max(len(lights), 1), np.float32)
    step = (response.high - response.low) / response.shape
    floats[:24] = [*np.eye(4).ravel(), *response.low, 0.0, *step, 0.0]
    rank, count = response.latents.shape
    counts = [count, -(-rank // 4), octahedron.side_of(response.table), int(response.arriving.size > 0)]
    floats[24:32].view(np.uint32)[:] = [*response.shape, len(lights), *counts]
    floats[32:68].reshape(9, 4)[:, :3] = around
    for number, (place, near, color) in enumerate(lights):
        floats[68 + 8 * number :][:8] = [*place, float(near), *color, 0.0]
    return floats


class Machine:
    """The compute shader with a response."""

    def __init__(self, device: Any, response: LightResponse) -> None:
        self.device, self.response = device, response
        module = device.create_shader_module(code=kernel())
        self.pipelines = [
            device.create_compute_pipeline(layout="auto", compute={"module": module, "entry_point": name})
            for name in ("light_up", "show")
        ]
        self.texture = device.create_texture(
            size=response.shape, dimension="3d", format="rgba16float",
            usage=wgpu.TextureUsage.STORAGE_BINDING | wgpu.TextureUsage.COPY_SRC,
        )  # fmt: skip
        self.data = [self.buffer(part) for part in data_of(response)]
        self.sums = device.create_buffer(
            size=16 * response.latents.shape[1], usage=wgpu.BufferUsage.STORAGE | wgpu.BufferUsage.COPY_SRC
        )
        texels = response.nearest.astype(np.uint32) | (response.distance.astype(np.uint32) << 24)
        self.texels = self.buffer(texels)

    def buffer(self, data: Array) -> Any:
        return self.device.create_buffer_with_data(
            data=np.ascontiguousarray(data).tobytes(), usage=wgpu.BufferUsage.STORAGE
        )

    def run(self, frame: Array, times: int = 1) -> float:
        """Sums the light of a frame; the seconds of one of `times` runs."""
        buffers = [self.buffer(frame), *self.data, self.sums]
        counts = [self.response.latents.shape[1], self.response.nearest.size]
        bound: list[dict[int, Any]] = [
            {number: {"buffer": buffer, "offset": 0, "size": buffer.size} for number, buffer in enumerate(buffers)},
            {
                8: {"buffer": self.texels, "offset": 0, "size": self.texels.size},
                9: {"buffer": self.sums, "offset": 0, "size": self.sums.size},
                10: self.texture.create_view(),
            },
        ]
        groups = [
            self.device.create_bind_group(
                layout=pipeline.get_bind_group_layout(0),
                entries=[{"binding": binding, "resource": resource} for binding, resource in own.items()],
            )
            for pipeline, own in zip(self.pipelines, bound, strict=True)
        ]
        encoder = self.device.create_command_encoder()
        for _ in range(times):
            work = encoder.begin_compute_pass()
            for pipeline, group, count in zip(self.pipelines, groups, counts, strict=True):
                work.set_pipeline(pipeline)
                work.set_bind_group(0, group)
                work.dispatch_workgroups(-(-count // WORKGROUP))
            work.end()
        start = time.perf_counter()
        self.device.queue.submit([encoder.finish()])
        self.device.queue.read_buffer(self.sums, size=16)  # waits
        return (time.perf_counter() - start) / times

    def texels_of(self) -> Array:
        """The texture, (z, y, x, 4)."""
        x, y, z = self.response.shape
        row = 256 * -(-8 * x // 256)
        data = self.device.queue.read_texture(
            {"texture": self.texture}, {"bytes_per_row": row, "rows_per_image": y}, (x, y, z)
        )
        halves = np.frombuffer(data, np.float16).reshape(z, y, row // 2)[..., : 4 * x]
        return halves.reshape(z, y, x, 4).astype(float)


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("file")
    options.add_argument("--lights", type=int, nargs="+", default=[0, 1, 2, 4, 8])
    options.add_argument("--runs", type=int, default=200)
    arguments = options.parse_args()
    facts = json.loads(Path(f"{arguments.file}.json").read_text("utf-8"))
    response = from_bytes(Path(arguments.file).read_bytes(), facts)
    adapter = wgpu.gpu.request_adapter_sync(power_preference="high-performance")
    print(f"{adapter.info['device']}: {response.latents.shape[1]} voxels, {len(response.latents)} numbers in each")
    machine = Machine(adapter.request_device_sync(), response)
    ways = octahedron.directions(8)
    around = np.linspace(0.2, 1.0, 27).reshape(9, 3)
    size = float((response.high - response.low).max())
    middle = 0.5 * (response.low + response.high)
    before = None
    for count in arguments.lights:
        lights, incoming = [], []
        for number in range(count):
            near, way, color = bool(number % 2), ways[7 * number % len(ways)], np.array([1.0, 0.7, 0.4])
            place = middle + size * way if near else way
            lights.append((place, near, color))
            towards = place - response.places() if near else way[None]
            away = np.linalg.norm(towards, axis=1, keepdims=True)
            incoming.append(Incoming(towards / away, color / (away**2 if near else 1.0) * np.ones_like(away)))
        frame = frame_of(response, lights, around)
        machine.run(frame)
        expected = volume(response, incoming, around)
        wrong = float((np.abs(machine.texels_of() - expected) / (0.1 + np.abs(expected))).max())
        ms = 1e3 * min(machine.run(frame, arguments.runs) for _ in range(5))
        more = "" if before is None or count == 0 else f", {(ms - before) / count:.4f} ms a light"
        before = ms if count == 0 else before
        print(f"{count} lights and surroundings: {ms:.4f} ms{more}; largest deviation from NumPy {wrong:.1e}")


if __name__ == "__main__":
    main()
