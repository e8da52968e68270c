"""WebGPU through wgpu, whose compiler is naga: a GPU's Vulkan or Metal, or Mesa's lavapipe where there is none."""

from __future__ import annotations

from collections import OrderedDict
from time import perf_counter
from typing import Any

import numpy as np

from sssgen.run import compilers
from sssgen.run.backends.backend_interface import Array, Drawing, backend_failure, refusal
from sssgen.run.backends.draw_backend import DrawingBackend
from sssgen.run.backends.webgpu_mark import Mark
from sssgen.run.backends.webgpu_plan import Plan, TexturePlan, layout_entries, plan
from sssgen.run.compilers import CompilerMissing
from sssgen.run.compilers.naga import Naga, find

_KEPT = 64
_TO_TEXTURE, _FROM_TEXTURE, _BOUND, _TARGET = 0x2, 0x1, 0x4, 0x10
_INDEX, _VERTEX, _UNIFORM = 0x10, 0x20, 0x40


class WebGPU(DrawingBackend):
    """Compiles WGSL and draws with it. In half precision it runs functions only."""

    top_first = True

    def __init__(self, name: str, target: str) -> None:
        super().__init__(name, target)
        naga = compilers.get("naga")
        assert isinstance(naga, Naga)
        self.start(naga)
        if self.target.half_of and "shader-f16" not in self.gpu.features:
            raise CompilerMissing(f"a WebGPU adapter with the feature shader-f16, which {self.device()} lacks")

    def start(self, naga: Naga) -> None:
        """Uses naga's device, with an empty cache."""
        self.naga = naga
        self.gpu: Any = naga.gpu
        flat = int(self.gpu.limits["max-texture-dimension-2d"])
        self.largest = {"2D": flat, "Cube": flat, "3D": int(self.gpu.limits["max-texture-dimension-3d"])}
        self.pipelines: OrderedDict[tuple[object, ...], Any] = OrderedDict()

    def device(self) -> str:
        return self.naga.version()

    def draw(self, drawing: Drawing) -> Array:
        """Tries a second time on a new device: software drivers lose one now and then, whatever the text is."""
        self.check(drawing)
        drawing_plan = plan(drawing)
        result = self.draw_once(drawing, drawing_plan)
        if result is None:
            result = self.draw_once(drawing, drawing_plan)
        if result is None:
            raise backend_failure(self.name, "the device was lost twice", "the next run uses a new one")
        return result

    def draw_once(self, drawing: Drawing, drawing_plan: Plan) -> Array | None:
        """The picture; None where the device was lost, and there is a new one."""
        import wgpu

        try:
            picture = self.execute(drawing_plan)
            if picture is None:
                self.renew()
            return picture
        except wgpu.GPUError as error:
            if self.is_lost():
                self.renew()
                return None
            messages = self.naga.complaints(drawing_plan.code)
            if not messages and drawing_plan.vertex_code:
                messages = self.naga.complaints(drawing_plan.vertex_code)
            if messages:
                raise refusal(self.name, drawing.fragment.text, messages) from None
            raise backend_failure(self.name, f"{type(error).__name__}: {error}") from error

    def renew(self) -> None:
        """Takes a new device."""
        self.naga.gpu = find().gpu  # the compiler's device is the same
        self.start(self.naga)

    def is_lost(self) -> bool:
        """Whether the device is lost."""
        import wgpu

        try:
            self.gpu.create_buffer(size=4, usage=_UNIFORM)
        except wgpu.GPUError:
            return True
        return False

    def execute(self, drawing_plan: Plan) -> Array | None:
        """Draws and reads the picture; None where the device did not draw, which it need not report."""
        gpu, size = self.gpu, (drawing_plan.width, drawing_plan.height, 1)
        pipeline, layouts = self.pipeline(drawing_plan)
        target = gpu.create_texture(size=size, format=drawing_plan.format, usage=_TARGET | _FROM_TEXTURE)
        encoder = gpu.create_command_encoder()
        attachment = {"view": target.create_view(), "load_op": "clear", "store_op": "store"}
        drawing = encoder.begin_render_pass(color_attachments=[attachment])
        drawing.set_pipeline(pipeline)
        for group, entries in self.resources(drawing_plan).items():
            drawing.set_bind_group(group, gpu.create_bind_group(layout=layouts[group], entries=entries))
        if drawing_plan.triangles:
            vertices = gpu.create_buffer_with_data(data=drawing_plan.vertices, usage=_VERTEX)
            triangles = gpu.create_buffer_with_data(data=drawing_plan.triangles, usage=_INDEX)
            drawing.set_vertex_buffer(0, vertices)
            drawing.set_index_buffer(triangles, "uint32")
            drawing.draw_indexed(len(drawing_plan.triangles) // 4)
        else:
            drawing.draw(3)
        drawing.end()
        mark = Mark(gpu, encoder)
        start = perf_counter()
        gpu.queue.submit([encoder.finish()])
        layout = {"offset": 0, "bytes_per_row": drawing_plan.width * 16, "rows_per_image": drawing_plan.height}
        read = gpu.queue.read_texture({"texture": target}, layout, size)  # waits for the draw
        self.draw_seconds = perf_counter() - start
        if not mark.is_there:
            return None
        dtype: Any = np.float32 if drawing_plan.format == "rgba32float" else np.uint32
        return np.frombuffer(read, dtype).reshape(drawing_plan.height, drawing_plan.width, 4)

    def pipeline(self, drawing_plan: Plan) -> tuple[Any, list[Any]]:
        """The pipeline and the layouts of its groups, cached."""
        groups = layout_entries(drawing_plan)
        key = (
            drawing_plan.code,
            drawing_plan.vertex_code,
            drawing_plan.vertex,
            drawing_plan.fragment,
            drawing_plan.format,
            repr(drawing_plan.attributes) if drawing_plan.triangles else "",
            repr(groups),
        )
        if key in self.pipelines:
            self.pipelines.move_to_end(key)
            cached: tuple[Any, list[Any]] = self.pipelines[key]
            return cached
        gpu = self.gpu
        module = gpu.create_shader_module(code=drawing_plan.code)
        vertex_code = drawing_plan.vertex_code
        vertex_module = gpu.create_shader_module(code=vertex_code) if vertex_code else module
        layouts = [gpu.create_bind_group_layout(entries=groups.get(i, [])) for i in range(max(groups, default=-1) + 1)]
        attributes = [
            {"format": each["format"], "offset": each["offset"], "shader_location": each["shaderLocation"]}
            for each in drawing_plan.attributes
        ]
        buffer = {"array_stride": drawing_plan.stride, "step_mode": "vertex", "attributes": attributes}
        buffers = [buffer] if drawing_plan.triangles else []
        pipeline = gpu.create_render_pipeline(
            layout=gpu.create_pipeline_layout(bind_group_layouts=layouts),
            vertex={"module": vertex_module, "entry_point": drawing_plan.vertex, "buffers": buffers},
            fragment={
                "module": module,
                "entry_point": drawing_plan.fragment,
                "targets": [{"format": drawing_plan.format}],
            },
            primitive={"topology": "triangle-list", "cull_mode": "none"},
        )
        self.pipelines[key] = pipeline, layouts
        if len(self.pipelines) > _KEPT:
            self.pipelines.popitem(last=False)
        return pipeline, layouts

    def resources(self, drawing_plan: Plan) -> dict[int, list[dict[str, Any]]]:
        """Group → the entries of its bind group."""
        groups: dict[int, list[dict[str, Any]]] = {}
        for block in drawing_plan.blocks:
            buffer = self.gpu.create_buffer_with_data(data=block.data, usage=_UNIFORM)
            resource = {"buffer": buffer, "offset": 0, "size": len(block.data)}
            groups.setdefault(block.group, []).append({"binding": block.binding, "resource": resource})
        for texture in drawing_plan.textures:
            view = self.upload(texture).create_view(dimension=texture.view)
            entries = groups.setdefault(texture.group, [])
            entries.append({"binding": texture.binding, "resource": view})
            if texture.sampler >= 0:
                wraps = {f"address_mode_{axis}": texture.wrap for axis in "uvw"}
                filters = dict.fromkeys(("mag_filter", "min_filter"), texture.filter) | {
                    "mipmap_filter": texture.between
                }
                sampler = self.gpu.create_sampler(**filters, **wraps, compare=texture.compare or None)
                entries.append({"binding": texture.sampler, "resource": sampler})
        return groups

    def upload(self, texture: TexturePlan) -> Any:
        """The texture with all its levels."""
        size = texture.levels[0].size
        created = self.gpu.create_texture(
            size=size, format=texture.format, usage=_BOUND | _TO_TEXTURE, dimension=texture.dimension,
            mip_level_count=len(texture.levels),
        )  # fmt: skip
        for number, level in enumerate(texture.levels):
            layout = {"bytes_per_row": level.size[0] * texture.bytes_per_texel, "rows_per_image": level.size[1]}
            self.gpu.queue.write_texture({"texture": created, "mip_level": number}, level.data, layout, level.size)
        return created
