"""The loader of what `sssgen transpile --stages` writes: layouts and values in Node.js, pictures in Chromium."""

from __future__ import annotations

import importlib.util
import json
import subprocess
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from folders import ROOT
from sssgen.cli import main as cli
from sssgen.run.backends.browser_page import Page
from sssgen.run.machine_parts import all_lacks, node, node_modules
from sssgen.targets.program_reflection import ROWS

VERTEX = """#version 300 es
struct Light { vec3 color; float weights[2]; bvec2 isOn; };
uniform mat4 view;
uniform mat3 turns[2];
uniform mat2 skew;
uniform Light lights[2];
uniform bool isWide;
uniform ivec3 counts;
uniform uint number;
in vec3 position;
in mat4 place;
in vec4 shade;
flat out vec4 tint;
void main() {
    vec3 p = turns[1] * position + vec3(skew[1], float(number));
    tint = vec4(lights[1].color, lights[0].weights[1]) + shade;
    if (isWide && lights[1].isOn.y) { tint.x += float(counts.z); }
    gl_Position = view * place * vec4(p, 1.0);
}
"""
FRAGMENT = """#version 300 es
precision highp float;
uniform sampler2D map;
uniform samplerCube sky;
uniform highp sampler2DShadow shadow;
uniform highp sampler3D volume;
uniform highp usampler2DArray ids;
flat in vec4 tint;
out vec4 color;
void main() {
    color = tint + texture(map, tint.xy) + texture(sky, tint.xyz);
    color += texture(shadow, tint.xyz) + texture(volume, tint.xyz);
    color.a += float(texelFetch(ids, ivec3(0), 0).x);
}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The files of the program, as a page has them; Node.js wants another suffix of a module."""
    if lacking := all_lacks(["node", "npm webgpu"]):
        pytest.skip(lacking)
    place = tmp_path_factory.mktemp("program")
    (place / "a.vert").write_text(VERTEX, encoding="utf-8")
    (place / "a.frag").write_text(FRAGMENT, encoding="utf-8")
    stages = [str(place / f"a.{suffix}") for suffix in ("vert", "frag")]
    assert cli.main(["transpile", "--stages", *stages, "-t", "wgsl", "-o", str(place)]) == 0
    (place / "webgl_program.js").rename(place / "webgl_program.mjs")
    return place


def answer(folder: Path, commands: str) -> Any:
    """What the commands return; no message of WebGPU."""
    script = ROOT / "tests" / "tools" / "webgl_program.mjs"
    command = [node(), str(script), str(node_modules().parent), str(folder), "a", commands]
    process = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    reply = json.loads(process.stdout.splitlines()[-1])
    assert reply["fault"] == ""
    return reply["result"]


def test_a_draw_is_valid_with_nothing_set(folder: Path) -> None:
    assert answer(folder, "return draw({}).layouts.map(({ arrayStride }) => arrayStride)") == [0, 0, 0]


def test_interleaved_and_instanced_attributes(folder: Path) -> None:
    sources = """{
        position: { buffer, format: 'float32x3', stride: 16, offset: 32 },
        shade: { buffer, format: 'unorm8x4', stride: 16, offset: 44 },
        place: { buffer, offset: 256, perInstance: true },
    }"""
    made = answer(
        folder, f"const made = draw({sources}); return [made.layouts, made.buffers.map(({{ offset }}) => offset)]"
    )
    vertex = {"format": "float32x3", "offset": 0, "shaderLocation": 0}
    shade = {"format": "unorm8x4", "offset": 12, "shaderLocation": 5}
    columns = [{"format": "float32x4", "offset": 16 * column, "shaderLocation": 1 + column} for column in range(4)]
    assert made == [
        [
            {"arrayStride": 16, "stepMode": "vertex", "attributes": [vertex, shade]},
            {"arrayStride": 64, "stepMode": "instance", "attributes": columns},
        ],
        [32, 256],
    ]


def test_a_stride_that_webgpu_does_not_take_names_the_attribute(folder: Path) -> None:
    result = answer(folder, "return draw({ shade: { buffer, format: 'unorm8x4', stride: 1 } })")
    assert result == {"error": "the attribute 'shade' has a stride of 1 bytes: WebGPU takes multiples of 4"}


def place(folder: Path, name: str) -> dict[str, Any]:
    program = json.loads((folder / "a.program.json").read_text(encoding="utf-8"))
    found: dict[str, Any] = next(uniform for uniform in program["uniforms"] if uniform["name"] == name)
    return found


@pytest.mark.parametrize(
    ("name", "value", "uniform", "words"),
    [
        ("view", list(range(16)), "view", list(range(16))),
        ("turns[1]", list(range(1, 10)), "turns", [0] * 12 + [1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9]),
        ("turns", list(range(1, 19)), "turns", [1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0, 10, 11, 12, 0, 13]),
        ("skew", [1, 2, 3, 4], "skew", [1, 2, 0, 0, 3, 4]),
        ("lights[1].color", [[1, 2, 3]], "lights[].color", [0, 0, 0, 0, 1, 2, 3]),
        ("lights[0].weights[1]", 5, "lights[].weights", [0, 0, 0, 0, 5, 0]),
        ("lights[1].weights", [6, 7], "lights[].weights", [0] * 8 + [6, 0, 0, 0, 7]),
    ],
)
def test_places_of_numbers(folder: Path, name: str, value: object, uniform: str, words: list[float]) -> None:
    first = place(folder, uniform)["offset"] // 4
    set_ = f"values.set({json.dumps(name)}, {json.dumps(value)})"
    found = answer(folder, f"return [{set_}, [...values.floats.slice({first}, {first + len(words)})]]")
    assert found == [True, words]


def test_bools_and_integers(folder: Path) -> None:
    offsets = [place(folder, name)["offset"] // 4 for name in ("isWide", "counts", "number", "lights[].isOn")]
    commands = (
        "values.set('isWide', true); values.set('counts', [1, -2, 3]); values.set('number', 4000000000);"
        " values.set('lights[1].isOn', [false, true]); return [...values.integers]"
    )
    words = answer(folder, commands)
    wide, counts, number, is_on = offsets
    assert (words[wide], words[counts : counts + 3], words[number]) == (1, [1, -2, 3], 4000000000 - 2**32)
    assert words[is_on + 4 : is_on + 6] == [0, 1]


BLOCK = """#version 300 es
struct Light { vec3 color; float weights[3]; mat3 turn; };
layout(std140, row_major) uniform Scene { float first; Light lights[2]; layout(column_major) mat2 skew; } scene;
in vec2 p;
void main() {
    vec3 sum = scene.lights[1].turn * scene.lights[1].color + scene.lights[1].weights[2] + scene.first;
    gl_Position = vec4(p * scene.skew, sum.xy);
}
"""


def test_a_buffer_of_webgl(folder: Path, tmp_path: Path) -> None:
    """Byte k of the buffer is k / 4 as an integer: so each word names its place in the source."""
    (tmp_path / "a.vert").write_text(BLOCK, encoding="utf-8")
    text = "#version 300 es\nprecision highp float;\nout vec4 color;\nvoid main() { color = vec4(1.0); }\n"
    (tmp_path / "a.frag").write_text(text, encoding="utf-8")
    stages = [str(tmp_path / f"a.{suffix}") for suffix in ("vert", "frag")]
    assert cli.main(["transpile", "--stages", *stages, "-t", "wgsl", "-o", str(tmp_path)]) == 0
    (tmp_path / "webgl_program.js").rename(tmp_path / "webgl_program.mjs")
    set_ = "values.setBlock('Scene', Int32Array.from({ length: 68 }, (_, word) => word))"
    done, words = answer(tmp_path, f"return [{set_}, [...values.integers]]")
    assert done is True

    def stored(name: str, *steps: int) -> list[int]:
        first = (place(tmp_path, name)["offset"]) // 4
        return [words[first + step] for step in steps]

    assert stored("Scene.first", 0) == [0]
    assert stored("Scene.lights[].color", 4, 5, 6) == [32, 33, 34]  # of the second light
    assert stored("Scene.lights[].weights", 4 * 5) == [36 + 8]
    turn = [12 + 4 * column + row for column in range(3) for row in range(3)]
    assert stored("Scene.lights[].turn", *turn) == [48, 52, 56, 49, 53, 57, 50, 54, 58]
    assert stored("Scene.skew", 0, 1, 4, 5) == [60, 61, 64, 65]
    assert answer(tmp_path, "return values.setBlock('gone', new ArrayBuffer(4))") is False
    short = answer(tmp_path, "return values.setBlock('Scene', new Uint8Array(32))")
    assert short == {"error": "Scene: 32 bytes, but its members need 264"}


def write_program(folder: Path, vertex: str, fragment: str) -> None:
    """Translates two stages of GLSL 4.50 to WGSL, with the module that draws with them."""
    stages = [folder / "a.vert", folder / "a.frag"]
    for path, text in zip(stages, (vertex, fragment), strict=True):
        path.write_text(f"#version 450\n{text}", encoding="utf-8")
    assert cli.main(["transpile", "--stages", *map(str, stages), "-t", "wgsl", "-o", str(folder)]) == 0
    (folder / "webgl_program.js").rename(folder / "webgl_program.mjs")


def test_storage_buffers_and_images(folder: Path, tmp_path: Path) -> None:
    write_program(
        tmp_path,
        "layout(std430) buffer Places { vec4 places[]; };\nvoid main() { gl_Position = places[gl_VertexID]; }\n",
        "layout(std430) buffer Count { uint count; };\nlayout(rgba8) uniform image2D picture;\nout vec4 color;\n"
        "void main() { atomicAdd(count, 1u); imageStore(picture, ivec2(0), vec4(1.0)); color = vec4(1.0); }\n",
    )
    wrong = answer(tmp_path, "return draw({})")
    assert wrong == {"error": "a: 'places_buffer' has no value: call setBuffer or setImage"}
    commands = """
        const store = () => device.createBuffer({ size: 64, usage: GPUBufferUsage.STORAGE });
        const usage = GPUTextureUsage.STORAGE_BINDING;
        const image = device.createTexture({ size: [8, 8], format: 'rgba8unorm', usage });
        const set = ['Places', 'Count'].map((name) => values.setBuffer(name, store()));
        set.push(values.setImage('picture', image));
        draw({});
        return [...set, values.setBuffer('gone', store()), values.setImage('gone', image)]"""
    assert answer(tmp_path, commands) == [True, True, True, False, False]


def test_a_texture_with_several_samples(folder: Path, tmp_path: Path) -> None:
    write_program(
        tmp_path,
        "void main() { gl_Position = vec4(0.0); }\n",
        "uniform sampler2DMS scene;\nout vec4 color;\n"
        "void main() { color = texelFetch(scene, textureSize(scene) / 2, 3); }\n",
    )
    commands = """
        const usage = GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.TEXTURE_BINDING;
        const scene = device.createTexture({ size: [8, 8], format: 'rgba8unorm', sampleCount: 4, usage });
        values.setTexture('scene', scene);
        draw({});
        return true"""
    assert answer(tmp_path, commands) is True
    wrong = answer(tmp_path, "return draw({})")
    assert wrong == {"error": "a: 'scene' has no value: call setTexture with a texture of several samples"}


def test_what_was_not_set(folder: Path) -> None:
    names = answer(folder, "values.set('turns[1]', [1, 2, 3, 4, 5, 6, 7, 8, 9]); return values.missing()")
    assert "turns" not in names
    assert {"view", "lights[].color", "map", "ids"} <= set(names)


def test_names_and_lengths_that_do_not_fit(folder: Path) -> None:
    assert answer(folder, "return values.set('gone', 1)") is False
    assert answer(folder, "return values.set('turns[2]', [1])") is False
    assert answer(folder, "return values.set('turns', [1, 2])") == {"error": "turns: 2 numbers for 2 of mat3"}
    assert answer(folder, "return values.setTexture('gone', picture)") is False


def test_states_of_a_pipeline(folder: Path) -> None:
    options = (
        "{ cull: 'back', topology: 'triangle-strip', depth: { format: 'depth24plus', compare: 'less-equal', bias: 2 } }"
    )
    commands = f"""
        const vertices = program.vertices({{}}), options = {{ vertices, targets: ['rgba8unorm'], ...{options} }};
        return [program.isFlat, program.pipeline(options) === program.pipeline(options),
                program.pipeline(options) === program.pipeline({{ ...options, cull: 'none' }})]"""
    assert answer(folder, commands) == [True, True, False]


def test_pictures_are_shown_and_get_their_levels(folder: Path) -> None:
    commands = """
        const usage = GPUTextureUsage.RENDER_ATTACHMENT;
        const screen = device.createTexture({ size: [8, 8], format: 'bgra8unorm', usage });
        generateMipmaps(device, picture);
        show(device, picture, screen.createView(), 'bgra8unorm');
        return screen.width"""
    assert answer(folder, commands) == 8


def test_the_last_vertex_first(folder: Path) -> None:
    commands = (
        "return [lastVertexFirst([0, 1, 2, 2, 1, 3], 'triangle-list'), lastVertexFirst([0, 1, 2, 3], 'triangle-strip'),"
        " lastVertexFirst([0, 1, 2], 'line-strip'), lastVertexFirst([4, 5], 'point-list')]"
    )
    assert answer(folder, commands) == [[2, 0, 1, 3, 2, 1], [2, 0, 1, 3, 2, 1], [1, 0, 2, 1], [4, 5]]


# Pictures


@pytest.fixture(scope="module")
def bench() -> ModuleType:
    if lacking := all_lacks(["chromium", "npm three", "pip browser"]):
        pytest.skip(lacking)
    spec = importlib.util.spec_from_file_location("bench_engine_draws", ROOT / "benchmarks" / "bench_engine_draws.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def page(bench: ModuleType) -> Iterator[tuple[Page, list[str]]]:
    page, about = bench.open_page()
    yield page, about["scenes"]
    page.close()


@pytest.fixture(scope="module")
def babylon(bench: ModuleType) -> Iterator[tuple[Page, list[str]]]:
    if lacking := all_lacks(["babylon bundle"]):
        pytest.skip(lacking)
    page, about = bench.open_page("babylon")
    yield page, about["scenes"]
    page.close()


def pictures(bench: ModuleType, page: Page, scene: str, rows: str = ROWS[0]) -> list[Any]:
    """Both pictures, the bottom row first, (height, width, 4)."""
    facts, *data = bench.run(page, scene, rows)
    assert not facts.get("error"), facts["error"]
    assert facts["complaints"] == []
    return [np.frombuffer(each, np.uint8).astype(int).reshape(192, 256, 4) for each in data]


def compare(bench: ModuleType, page: Page, scene: str) -> None:
    first, second = pictures(bench, page, scene)
    assert np.ptp(first) > 50
    differing = (np.abs(first - second) > 1).any(axis=-1)
    assert np.mean(differing) <= bench.RASTERISED.get(scene, 0.0)


def test_a_page_of_three_js(bench: ModuleType, page: tuple[Page, list[str]]) -> None:
    compare(bench, page[0], "a shader of the page")


def test_the_rows_of_webgpu(bench: ModuleType, page: tuple[Page, list[str]]) -> None:
    first, second = pictures(bench, page[0], "matcap", "top-first")
    differing = (np.abs(first - second[::-1]) > 1).any(axis=-1)
    assert np.mean(differing) < 0.005  # an edge through the centre of a pixel belongs to the other side of it


@pytest.mark.slow
def test_all_scenes_of_three_js(bench: ModuleType, page: tuple[Page, list[str]]) -> None:
    for scene in page[1]:
        compare(bench, page[0], scene)


@pytest.mark.slow
def test_all_scenes_of_babylon_js(bench: ModuleType, babylon: tuple[Page, list[str]]) -> None:
    for scene in babylon[1]:
        compare(bench, babylon[0], scene)
