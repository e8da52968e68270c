"""OpenGL and WebGPU draw the same picture with whole shaders: the same orientation, and the same depths."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from sssgen.run import compilers
from sssgen.run.compilers import CompilerMissing
from whole_shaders import emitted_shader

SIZE = 16, 8

VERTEX = """variable in int gl_VertexID [builtin("gl_VertexID")]
variable out vec2 uv
variable out int kind [interpolation("flat")]
variable out vec4 gl_Position [builtin("gl_Position")]
function void main() {
    var vec2 corner = ((vec2{float{($gl_VertexID % 2)}, float{($gl_VertexID / 2)}} * 4.0) - 1.0);
    set $uv = ((corner + 1.0) * 0.5);
    set $kind = 3;
    set $gl_Position = (vec4{corner, 0.5, 1.0} * 2.0);
}
"""
FRAGMENT = """uniform vec3 iResolution = (1.0, 1.0, 1.0)
variable private float step = ($iResolution.y * 0.25)
variable in vec2 uv
variable in int kind [interpolation("flat")]
variable in vec4 gl_FragCoord [builtin("gl_FragCoord")]
variable out vec4 color
function float slope() {
    set $step *= 2.0;
    return (dFdy($uv.y) * $step);
}
function void main() {
    var float before = $step;
    set $color = vec4{($gl_FragCoord.xy / $iResolution.xy), ($slope() + before), ($gl_FragCoord.z * $gl_FragCoord.w)};
    set $color.w += (($uv.y * 0.25) * float{$kind});
}
"""


def by_opengl() -> Any:
    """The picture; the first row is at the bottom."""
    try:
        context = compilers.get("gl").context  # type: ignore[attr-defined]  # the driver's
    except CompilerMissing as missing:
        pytest.skip(str(missing))
    with context:
        program = context.program(
            emitted_shader(VERTEX, "glsl-330"), fragment_shader=emitted_shader(FRAGMENT, "glsl-330")
        )
        program["iResolution"].value = (*SIZE, 1.0)
        frame = context.framebuffer([context.texture(SIZE, 4, dtype="f4")])
        frame.use()
        context.vertex_array(program, []).render(context.TRIANGLES, vertices=3)
        return np.frombuffer(frame.read(components=4, dtype="f4"), np.float32).reshape(SIZE[1], SIZE[0], 4)


def by_webgpu() -> Any:
    """The picture; the first row is at the top."""
    try:
        gpu = compilers.get("naga").gpu  # type: ignore[attr-defined]  # naga's device
    except CompilerMissing as missing:
        pytest.skip(str(missing))
    vertex, fragment = (gpu.create_shader_module(code=emitted_shader(text, "wgsl")) for text in (VERTEX, FRAGMENT))
    pipeline = gpu.create_render_pipeline(
        layout="auto",
        vertex={"module": vertex, "entry_point": "vertex_main", "buffers": []},
        primitive={"topology": "triangle-list"},
        fragment={"module": fragment, "entry_point": "fragment_main", "targets": [{"format": "rgba32float"}]},
    )
    target = gpu.create_texture(size=(*SIZE, 1), format="rgba32float", usage=0x10 | 0x1)
    block = gpu.create_buffer_with_data(data=np.array([*SIZE, 1.0, 0.0], np.float32).tobytes(), usage=0x40)
    entries = [{"binding": 0, "resource": {"buffer": block, "offset": 0, "size": 16}}]
    encoder = gpu.create_command_encoder()
    attachment = {"view": target.create_view(), "load_op": "clear", "store_op": "store"}
    drawing = encoder.begin_render_pass(color_attachments=[attachment])
    drawing.set_pipeline(pipeline)
    drawing.set_bind_group(1, gpu.create_bind_group(layout=pipeline.get_bind_group_layout(1), entries=entries))
    drawing.draw(3)
    drawing.end()
    gpu.queue.submit([encoder.finish()])
    source, layout = {"texture": target}, {"bytes_per_row": 16 * SIZE[0], "rows_per_image": SIZE[1]}
    data = gpu.queue.read_texture(source, layout, (*SIZE, 1))
    return np.frombuffer(data, np.float32).reshape(SIZE[1], SIZE[0], 4)


def test_both_draw_the_same_picture() -> None:
    """The shader writes the position of each pixel, the vertical derivative of a coordinate, and the depth."""
    width, height = SIZE
    x, y = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    # the depth is 0.75, 1 / w is 0.5; the derivative is 1 / height, multiplied by a step that has been doubled
    expected = np.stack([x, y, np.full_like(x, 0.5 + height * 0.25), 0.375 + 0.75 * y], axis=-1)
    np.testing.assert_allclose(by_opengl(), expected, atol=1e-5)
    np.testing.assert_allclose(by_webgpu()[::-1], expected, atol=1e-5)
