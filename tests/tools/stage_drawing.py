"""Two stages of plain GLSL, translated apart and drawn together: the colour of a pixel."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from sssgen.ir.nodes import Module
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Backend, Text
from sssgen.run.backends.backend_interface import Drawing, Stage
from sssgen.run.backends.hlsl_spirv import HLSL
from sssgen.run.backends.opengl import OpenGL
from sssgen.run.backends.webgpu import WebGPU

SIZE = 4, 4
BACKENDS = ("gl", "gl-es", "hlsl", "webgpu")
CORNER = """
const vec2 CORNERS[3] = vec2[3](vec2(-1.0, -1.0), vec2(3.0, -1.0), vec2(-1.0, 3.0));
void place() { gl_Position = vec4(CORNERS[gl_VertexID], 0.5, 1.0); }
"""
"""For vertex shaders: one triangle that covers the picture."""


def module_of(text: str, name: str) -> Module:
    return load_glsl_text(text, name).module


def draw_stages(vertex: str, fragment: str, backend: Backend, together: bool = False) -> Any:
    """The colour of the first pixel; `together`: each stage is translated with the other one."""
    modules = module_of(vertex, "a.vert"), module_of(fragment, "a.frag")
    partners = modules[::-1] if together else (None, None)
    target = backend.target.name
    texts = [
        next(iter(transpile(module, target, "a", keep=True, partner=partner).files.values()))
        for module, partner in zip(modules, partners, strict=True)
    ]
    draw: Callable[[str, str], Any] = _by_webgpu(backend) if isinstance(backend, WebGPU) else _by_opengl(backend)
    return draw(*texts)[0, 0]


def _by_opengl(backend: Backend) -> Callable[[str, str], Any]:
    assert isinstance(backend, OpenGL)
    entries = ("vertex_main", "fragment_main") if isinstance(backend, HLSL) else ("main", "main")

    def draw(vertex: str, fragment: str) -> Any:
        stages = Stage(Text(fragment), entries[1]), Stage(Text(vertex), entries[0])
        return backend.draw(Drawing(SIZE, *stages, floats=True))

    return draw


def _by_webgpu(backend: WebGPU) -> Callable[[str, str], Any]:
    """Draws two modules; the back end itself draws one."""
    gpu = backend.gpu

    def draw(vertex: str, fragment: str) -> Any:
        modules = [gpu.create_shader_module(code=text) for text in (vertex, fragment)]
        pipeline = gpu.create_render_pipeline(
            layout="auto",
            vertex={"module": modules[0], "entry_point": "vertex_main", "buffers": []},
            primitive={"topology": "triangle-list"},
            fragment={"module": modules[1], "entry_point": "fragment_main", "targets": [{"format": "rgba32float"}]},
        )
        target = gpu.create_texture(size=(*SIZE, 1), format="rgba32float", usage=0x10 | 0x1)
        encoder = gpu.create_command_encoder()
        attachment = {"view": target.create_view(), "load_op": "clear", "store_op": "store"}
        drawing = encoder.begin_render_pass(color_attachments=[attachment])
        drawing.set_pipeline(pipeline)
        drawing.draw(3)
        drawing.end()
        gpu.queue.submit([encoder.finish()])
        where, how = {"texture": target}, {"bytes_per_row": 16 * SIZE[0], "rows_per_image": SIZE[1]}
        data = gpu.queue.read_texture(where, how, (*SIZE, 1))
        return np.frombuffer(data, np.float32).reshape(SIZE[1], SIZE[0], 4)

    return draw
