"""One run of a compute shader, and how OpenGL and WebGPU execute it: the buffers go in and come out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from sssgen.run.backends.backend_interface import Array, Block, Bound, Text, backend_failure, refusal
from sssgen.run.backends.opengl import OpenGL
from sssgen.run.backends.webgpu import WebGPU
from sssgen.run.backends.webgpu_mark import Mark
from sssgen.run.backends.webgpu_plan import BlockPlan, Plan, layout_entries, texture_plan
from sssgen.run.compilers.gl_driver import messages

_COMPUTE = 4
_STORAGE, _READ, _WRITTEN = 0x80, 0x4, 0x8


class Dispatch(NamedTuple):
    """A compute shader with all that it reads."""

    text: Text
    groups: tuple[int, int, int]
    size: tuple[int, int, int]
    """Of a workgroup."""
    buffers: Mapping[str, Array]
    """By the name of the block."""
    bindings: Mapping[str, int]
    """Of the buffers; OpenGL binds by name."""
    entry: str = "main"
    values: Mapping[str, Array] = {}
    """OpenGL: the uniforms by name."""
    block: bytes = b""
    """The others: the block of the uniforms."""
    textures: Mapping[str, Bound] = {}
    group: int = 0
    """WebGPU: the group of all resources; the block has the binding 0."""
    readonly: frozenset[str] = frozenset()
    """WebGPU: the buffers that the text only reads."""
    blocks: Mapping[str, Block] = {}
    """OpenGL: the uniform blocks by name."""


def by_opengl(backend: OpenGL, dispatch: Dispatch) -> dict[str, Array]:
    """The buffers after the run. Raises SssgenError where the driver refuses the text."""
    resources: list[Any] = []

    def keep(resource: Any) -> Any:
        resources.append(resource)
        return resource

    with backend.context as context:
        try:
            program = keep(context.compute_shader(dispatch.text.text))
        except Exception as error:
            raise refusal(backend.name, dispatch.text, messages(str(error))) from None
        try:
            backend.bind_uniforms(program, dispatch.textures, dispatch.values, keep)
            backend.bind_blocks(program, dispatch.blocks, keep)
            stores = {name: keep(context.buffer(data.tobytes())) for name, data in dispatch.buffers.items()}
            for number, (name, store) in enumerate(stores.items()):
                if name in program and type(program[name]).__name__ == "StorageBlock":
                    program[name].binding = number
                    store.bind_to_storage_buffer(number)
            program.run(*dispatch.groups)
            context.finish()
            return {name: _like(store.read(), dispatch.buffers[name]) for name, store in stores.items()}
        except Exception as error:
            raise backend_failure(backend.name, f"the driver failed: {error}") from error
        finally:
            for resource in resources:
                resource.release()


def by_webgpu(backend: WebGPU, dispatch: Dispatch) -> dict[str, Array]:
    """The buffers after the run. Raises SssgenError where naga refuses the text."""
    import wgpu

    gpu, group = backend.gpu, dispatch.group
    blocks = [BlockPlan(group, 0, dispatch.block)] if dispatch.block else []
    textures = [texture_plan(bound) for bound in dispatch.textures.values()]
    plan = Plan(dispatch.text.text, "", dispatch.entry, "rgba32uint", 1, 1, textures, blocks, b"", b"")
    try:
        listed = [entry | {"visibility": _COMPUTE} for entry in layout_entries(plan).get(group, [])]
        entries = backend.resources(plan).get(group, [])
        stores = {}
        for name, data in dispatch.buffers.items():
            usage = _STORAGE | _READ | _WRITTEN
            store = stores[name] = gpu.create_buffer_with_data(data=data.tobytes(), usage=usage)
            kind = "read-only-storage" if name in dispatch.readonly else "storage"
            listed.append({"binding": dispatch.bindings[name], "visibility": _COMPUTE, "buffer": {"type": kind}})
            entries.append({"binding": dispatch.bindings[name], "resource": {"buffer": store}})
        layouts = [gpu.create_bind_group_layout(entries=[]) for _ in range(group)]
        layouts.append(gpu.create_bind_group_layout(entries=listed))
        pipeline = gpu.create_compute_pipeline(
            layout=gpu.create_pipeline_layout(bind_group_layouts=layouts),
            compute={"module": gpu.create_shader_module(code=plan.code), "entry_point": dispatch.entry},
        )
        encoder = gpu.create_command_encoder()
        work = encoder.begin_compute_pass()
        work.set_pipeline(pipeline)
        for number in range(group):
            work.set_bind_group(number, gpu.create_bind_group(layout=layouts[number], entries=[]))
        work.set_bind_group(group, gpu.create_bind_group(layout=layouts[group], entries=entries))
        work.dispatch_workgroups(*dispatch.groups)
        work.end()
        mark = Mark(gpu, encoder)
        gpu.queue.submit([encoder.finish()])
        after = {name: _like(gpu.queue.read_buffer(store), dispatch.buffers[name]) for name, store in stores.items()}
    except wgpu.GPUError as error:
        if complaints := backend.naga.complaints(plan.code):
            raise refusal(backend.name, dispatch.text, complaints) from None
        raise backend_failure(backend.name, f"{type(error).__name__}: {error}") from error
    if not mark.is_there:
        backend.renew()
        raise backend_failure(backend.name, "the device did not execute the shader", "does another program block it?")
    return after


def _like(data: Any, array: Array) -> Array:
    """The bytes with the type and shape of an array."""
    result: Array = np.frombuffer(data, array.dtype).reshape(array.shape)
    return result
