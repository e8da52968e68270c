"""Images of plain GLSL: a compute shader loads and stores texels in OpenGL and WebGPU; compilers read other shaders."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from folders import TESTS
from qualification.suites.compiled_texts import complaint
from sssgen.lang.plain_glsl import load_glsl, load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Backend
from sssgen.support.diagnostics import SssgenError

Array = np.ndarray[Any, Any]
SIZE = 8
SOURCE = (np.arange(SIZE * SIZE) % 51 / 51.0).astype(np.float32).reshape(SIZE, SIZE)
COUNTS = np.arange(SIZE * SIZE, dtype=np.uint32).reshape(SIZE, SIZE)


def translated(target: str) -> tuple[str, dict[str, int]]:
    """The text, and the binding of each image."""
    result = transpile(load_glsl(TESTS / "transpile" / "images.comp", "images.comp").module, target, "images")
    images = {image["name"]: image["binding"]["binding"] for image in result.reflection["storage_images"]}
    return next(iter(result.files.values())), images


def check(picture: Array, counts: Array, layers: Array) -> None:
    mean = 0.5 * (SOURCE + SOURCE[:, ::-1])
    np.testing.assert_allclose(picture[..., 0] / 255.0, mean, atol=1.0 / 255.0)
    assert (picture[..., 1:] == [255, 0, 255]).all()
    np.testing.assert_array_equal(counts, (COUNTS + 1) * 2)
    np.testing.assert_array_equal(layers[1, ..., 0], counts)
    assert not layers[0].any()


def test_opengl(backend: Callable[[str], Backend]) -> None:
    machine: Any = backend("gl")
    text, bindings = translated("glsl-330")
    with machine.context as context:
        program = context.compute_shader(text)
        source = context.texture((SIZE, SIZE), 1, SOURCE.tobytes(), dtype="f4")
        picture = context.texture((SIZE, SIZE), 4, dtype="f1")
        counts = context.texture((SIZE, SIZE), 1, COUNTS.tobytes(), dtype="u4")
        layers = context.texture_array((SIZE, SIZE, 2), 4, bytes(SIZE * SIZE * 32), dtype="f4")
        for name, texture in {"source": source, "picture": picture, "counts": counts, "layers": layers}.items():
            texture.bind_to_image(bindings[name], read=True, write=True)
        program.run(2, 2, 1)
        context.finish()
        check(
            np.frombuffer(picture.read(), np.uint8).reshape(SIZE, SIZE, 4),
            np.frombuffer(counts.read(), np.uint32).reshape(SIZE, SIZE),
            np.frombuffer(layers.read(), np.float32).reshape(2, SIZE, SIZE, 4),
        )
        for resource in (program, source, picture, counts, layers):
            resource.release()


def test_webgpu(backend: Callable[[str], Backend]) -> None:
    machine: Any = backend("webgpu")
    gpu = machine.gpu
    text, bindings = translated("wgsl")
    usage = 0x1 | 0x2 | 0x8  # copied from and to, and a storage texture
    formats = {"source": "r32float", "picture": "rgba8unorm", "counts": "r32uint", "layers": "rgba32float"}
    textures = {
        name: gpu.create_texture(size=(SIZE, SIZE, 2 if name == "layers" else 1), format=format_, usage=usage)
        for name, format_ in formats.items()
    }
    layout = {"bytes_per_row": SIZE * 4, "rows_per_image": SIZE}
    for name, data in (("source", SOURCE), ("counts", COUNTS)):
        gpu.queue.write_texture({"texture": textures[name]}, data.tobytes(), layout, (SIZE, SIZE, 1))
    module = gpu.create_shader_module(code=text)
    pipeline = gpu.create_compute_pipeline(layout="auto", compute={"module": module, "entry_point": "compute_main"})
    entries = []
    for name, texture in textures.items():
        dimension = "2d-array" if name == "layers" else "2d"
        entries.append({"binding": bindings[name], "resource": texture.create_view(dimension=dimension)})
    encoder = gpu.create_command_encoder()
    work = encoder.begin_compute_pass()
    work.set_pipeline(pipeline)
    work.set_bind_group(0, gpu.create_bind_group(layout=pipeline.get_bind_group_layout(0), entries=[]))
    work.set_bind_group(1, gpu.create_bind_group(layout=pipeline.get_bind_group_layout(1), entries=entries))
    work.dispatch_workgroups(2, 2, 1)
    work.end()
    gpu.queue.submit([encoder.finish()])

    def read(name: str, numbers: int, dtype: Any, layers: int = 1) -> Array:
        texture = {"texture": textures[name]}
        width = numbers * np.dtype(dtype).itemsize * SIZE
        rows = {"bytes_per_row": width, "rows_per_image": SIZE}
        data = gpu.queue.read_texture(texture, rows, (SIZE, SIZE, layers))
        result: Array = np.frombuffer(data, dtype).reshape(layers, SIZE, SIZE, numbers)
        return result

    layers = read("layers", 4, np.float32, 2)
    check(read("picture", 4, np.uint8)[0], read("counts", 1, np.uint32)[0, ..., 0], layers)


FRAGMENT = """#version 310 es
precision highp float;
layout(r32f, binding = 0) readonly uniform highp image2D source;
layout(rgba8, binding = 1) writeonly uniform highp image2D picture;
layout(r32ui, binding = 2) uniform highp uimage2D counts;
out vec4 color;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    color = imageLoad(source, at);
    imageStore(picture, at, color.bgra);
    COUNT
}
"""
COUNT = "color.a = float(imageAtomicAdd(counts, at, 1u) + imageAtomicCompSwap(counts, at, 0u, 5u));"


@pytest.mark.parametrize(
    ("target", "count"), [("glsl-330", COUNT), ("hlsl", COUNT), ("wgsl", "imageStore(counts, at, uvec4(1));")]
)
def test_a_fragment_shader_with_images_compiles(target: str, count: str) -> None:
    result = transpile(load_glsl_text(FRAGMENT.replace("COUNT", count), "images.frag").module, target, "images")
    assert complaint(result.files) == ""


@pytest.mark.parametrize(
    ("target", "text", "message"),
    [
        ("wgsl", FRAGMENT.replace("COUNT", COUNT), "this target has no imageAtomicAdd"),
        ("wgsl", FRAGMENT.replace("rgba8", "rg8"), "images of this target have no format rg8"),
        ("wgsl", FRAGMENT.replace("layout(rgba8, binding = 1)", ""), "the image 'picture' needs a format here"),
        (
            "wgsl",
            FRAGMENT.replace("writeonly", "").replace("COUNT", "color = imageLoad(picture, at);"),
            "'picture' is read and written, which this target can only with one number of 32 bits",
        ),
        ("metal", FRAGMENT, "'source' is an image, which this target has in compute shaders alone"),
        ("glsl-es-300", FRAGMENT, "'source' is an image, which this target lacks"),
        ("numpy", FRAGMENT, "'source' is an image, which this target lacks"),
    ],
)
def test_what_a_target_lacks_is_an_error(target: str, text: str, message: str) -> None:
    module = load_glsl_text(text.replace("COUNT", ""), "images.frag").module
    with pytest.raises(SssgenError, match=message) as caught:
        transpile(module, target, "images")
    assert caught.value.diagnostics[0].span is not None


ATOMICS = """#version 430
layout(local_size_x = 4) in;
layout(r32ui) uniform uimage2D counts;
layout(r32i) uniform iimage3D volume;
layout(r32i) uniform iimage2DArray layers;
void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    imageAtomicAdd(counts, at, 1u);
    int old = imageAtomicMin(volume, ivec3(at, 0), -1) + imageAtomicMax(layers, ivec3(at, 1), 2);
    old += imageAtomicAnd(volume, ivec3(at, 0), 3) + imageAtomicOr(layers, ivec3(at, 1), 4);
    uint swapped = imageAtomicCompSwap(counts, at, 0u, uint(old)) ^ imageAtomicExchange(counts, at, 5u);
    imageAtomicXor(counts, at, swapped);
    imageAtomicCompSwap(layers, ivec3(at, 1), 1, old);
}
"""


@pytest.mark.parametrize("target", ["metal", "hlsl", "glsl-330"])
def test_atomics_of_images_compile(target: str) -> None:
    files = transpile(load_glsl_text(ATOMICS, "atomics.comp").module, target, "atomics").files
    assert complaint(files) == ""
    if target == "metal":
        text = next(iter(files.values()))
        assert "counts.atomic_fetch_add(uint2(at), uint4(1u));" in text
        assert "old_7 = counts.atomic_exchange(uint2(at), uint4(5u)).x;" in text
        assert "while (!counts.atomic_compare_exchange_weak(uint2(at), &swapped_2, uint4(uint(old_3)))" in text


def test_hlsl_and_metal_compile() -> None:
    for target in ("hlsl", "metal"):
        assert complaint(transpile(load_glsl(TESTS / "transpile" / "images.comp").module, target, "images").files) == ""
