"""Times the passes of materials on a GPU: python benchmarks/gpu_passes.py.

    python benchmarks/gpu_passes.py --size 1920x1080 --rounds 30 --json out.json

A body of 65,536 triangles, which covers a third of the screen, is drawn as the runtimes of engines draw it: its
first exit, second entrance and second exit as the eye sees them; entry and exit from two lights, in 1024 × 1024 texels
each; what it would reflect if it were white and matt, of two lamps. The gather of `screen_diffusion` is the emitted
function at all pixels of the body. Each is a share of the time that the published thinness of 30 taps adds to a scene,
which is measured in the same run.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np
import numpy.typing as npt

import gpu
from sssgen.lab.gpu import gpu_timing
from sssgen.pipeline.compiler import transpile
from sssgen.run import backends
from sssgen.run.backends.opengl import OpenGL
from sssgen.run.evaluate import probes
from sssgen.scene.camera import Camera

Array = npt.NDArray[Any]
SIDE = 1024
MARGIN = 1e-3
FAR = 6e4
AROUND, ACROSS = 256, 128
SPREAD = (0.03, 0.015, 0.01)
LAMPS = [(0.69, 0.69, 0.23), (-0.44, 0.22, 0.87)]
DRAWS = 8
EYE = (0.0, 0.0, 3.6)
WITHOUT = "the same without its call"

VERTEX = """#version 330 core
uniform mat4 clip;
uniform mat4 view;
in vec3 position;
in vec3 normal;
out vec3 P;
out vec3 N;
out float way;
void main() {
    P = position;
    N = normal;
    way = -(view * vec4(position, 1.0)).z;
    gl_Position = clip * vec4(position, 1.0);
}
"""
DISTANCE = """#version 330 core
uniform sampler2D front;
uniform float margin;
in vec3 P;
in vec3 N;
in float way;
out vec4 texel;
void main() {
    if (margin > 0.0 && way < texelFetch(front, ivec2(gl_FragCoord.xy), 0).r + margin) discard;
    texel = vec4(way, 0.0, 0.0, 1.0);
}
"""
MATT = """#version 330 core
uniform vec3 lamps[2];
in vec3 P;
in vec3 N;
in float way;
out vec4 light;
void main() {
    vec3 n = normalize(N);
    light = vec4(vec3(max(dot(n, lamps[0]), 0.0)) + vec3(0.3, 0.4, 0.5) * max(dot(n, lamps[1]), 0.0), way);
}
"""
POINTS = """#version 330 core
in vec3 P;
in vec3 N;
in float way;
layout(location = 0) out vec4 place;
layout(location = 1) out vec4 normal;
void main() {
    place = vec4(P, way);
    normal = vec4(normalize(N), 0.0);
}
"""
SCREEN = """#version 330 core
void main() {
    vec2 at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
    gl_Position = vec4(at, 0.0, 1.0);
}
"""
GATHER = """
uniform mat4 eye_matrix;
uniform vec3 spread_length;
uniform sampler2D matt_light_map;
uniform sampler2D place;
uniform sampler2D normal;
out vec4 color;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 P = texelFetch(place, at, 0);
    vec3 albedo = vec3(0.8, 0.6, 0.5), emission = vec3(0.0);
    vec3 N = texelFetch(normal, at, 0).xyz, V = normalize(vec3(EYE) - P.xyz);
    if (dot(N, N) > 0.5) { CALL }
    color = vec4(albedo + emission + 1e-6 * N, 1.0);
}
"""


def ring() -> tuple[Array, Array]:
    """Vertices (n, 6) and triangles (m, 3) of a ring with waves."""
    u, v = np.meshgrid(*(np.arange(n) * 2.0 * np.pi / n for n in (AROUND, ACROSS)), indexing="ij")
    radius = 0.35 + 0.04 * np.sin(9.0 * u) * np.sin(5.0 * v)
    out = np.stack([np.cos(u), np.zeros_like(u), -np.sin(u)], axis=-1)
    normal = np.cos(v)[..., None] * out + np.sin(v)[..., None] * np.array([0.0, 1.0, 0.0])
    turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.5, -0.8660254], [0.0, 0.8660254, 0.5]])
    vertices = np.concatenate([(0.8 * out + radius[..., None] * normal) @ turn.T, normal @ turn.T], axis=-1)
    index = np.arange(AROUND * ACROSS).reshape(AROUND, ACROSS)
    a, b, c, d = (np.roll(index, (-i, -j), (0, 1)).ravel() for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)))
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return vertices.reshape(-1, 6).astype(np.float32), triangles.astype(np.int32)


class Pass:
    """One draw of the body into a target, by a program of its own: little work of the CPU lies between two draws."""

    def __init__(
        self, body: Body, fragment: str, target: Any, view: tuple[Array, Array], back: bool = False, front: Any = None
    ) -> None:
        self.context, self.target, self.front = body.context, target, front
        self.cull = "front" if back else "back"
        program = body.context.program(vertex_shader=VERTEX, fragment_shader=fragment)
        values = {"margin": 0.0 if front is None else MARGIN, "lamps": LAMPS}
        for name, matrix in zip(("view", "clip"), view, strict=True):
            program[name].write(matrix.T.astype("f4").tobytes())
        for name in (name for name in values if name in program):
            program[name].value = values[name]
        names = [name for name in ("position", "normal") if name in program]
        layout = " ".join("3f" if name in names else "12x" for name in ("position", "normal"))
        self.array = body.context.vertex_array(program, [(body.vertices, layout, *names)], body.triangles)

    def clear(self) -> None:
        self.target.use()
        four = self.target.color_attachments[0].components == 4
        self.target.clear(*((0.0, 0.0, 0.0, FAR) if four else (FAR,)))

    def draw(self) -> None:
        self.clear()
        self.context.cull_face = self.cull
        if self.front is not None:
            self.front.color_attachments[0].use(0)
        self.array.render()


class Clear:
    """What a pass does before it draws."""

    def __init__(self, drawn: Pass) -> None:
        self.draw = drawn.clear


class Body:
    """The body's buffers."""

    def __init__(self, context: Any) -> None:
        self.context = context
        vertices, triangles = ring()
        self.vertices, self.triangles = context.buffer(vertices.tobytes()), context.buffer(triangles.tobytes())


class Gather:
    """The emitted gather at the body's pixels, or the same without its call."""

    def __init__(self, context: Any, target: Any, pictures: Sequence[Any], matrix: Array, calls: bool) -> None:
        self.target, self.pictures = target, pictures
        subject = probes.subject("screen_diffusion", {})
        compiled = transpile(subject.module, "glsl-330", "timed", "auto", subject.called, chained=subject.chained)
        text = next(iter(compiled.files.values()))
        call = (
            "screen_diffusion(P.xyz, N, V, albedo, emission, eye_matrix, spread_length, matt_light_map);"
            if calls
            else ""
        )
        fragment = f"#version 330 core\n{text}\n{GATHER.replace('CALL', call).replace('EYE', ', '.join(map(str, EYE)))}"
        program = context.program(vertex_shader=SCREEN, fragment_shader=fragment)
        for unit, name in enumerate(("matt_light_map", "place", "normal")):
            if name in program:
                program[name].value = unit
        if calls:
            program["eye_matrix"].write(matrix.T.astype("f4").tobytes())
            program["spread_length"].value = SPREAD
        self.array = context.vertex_array(program, [])

    def draw(self) -> None:
        self.target.use()
        for unit, picture in enumerate(self.pictures):
            picture.use(unit)
        self.array.render(vertices=3)


def passes(context: Any, size: tuple[int, int]) -> tuple[dict[str, list[Any]], float]:
    """What is drawn, by its name; and the share of the screen that the body covers."""

    def target(formats: str, side: tuple[int, int] = size) -> Any:
        textures = [context.texture(side, int(format[0]), dtype=format[1:]) for format in formats.split()]
        return context.framebuffer(textures, context.depth_renderbuffer(side))

    body, square = Body(context), (SIDE, SIDE)
    camera = Camera(EYE, (0.0, 0.0, 0.0), 40.0)
    eye = camera.view(), camera.view_projection(size[0] / size[1])
    lamps = [Camera(place, (0.0, 0.0, 0.0), 32.0) for place in ((3.0, 3.0, 1.0), (-2.0, 1.0, 4.0))]
    layers = [target("1f4") for _ in range(3)]
    first = Pass(body, DISTANCE, layers[0], eye, True)
    others = [
        Pass(body, DISTANCE, layers[1], eye, False, layers[0]), Pass(body, DISTANCE, layers[2], eye, True, layers[1])
    ]  # fmt: skip
    lights = [
        Pass(body, DISTANCE, target("1f4", square), (lamp.view(), lamp.view_projection(1.0)), back)
        for lamp in lamps
        for back in (False, True)
    ]
    matt, points = Pass(body, MATT, target("4f2"), eye), Pass(body, POINTS, target("4f4 4f4"), eye)
    view, clip = eye
    matrix = np.stack([0.5 * (clip[0] + clip[3]), 0.5 * (clip[1] + clip[3]), -view[2], clip[3]])
    pictures = [*matt.target.color_attachments, *points.target.color_attachments]
    color = target("4f2")
    context.enable_only(context.DEPTH_TEST | context.CULL_FACE)
    for each in (matt, points):
        each.draw()
    normals = np.frombuffer(points.target.read(components=3, attachment=1, dtype="f4"), np.float32).reshape(-1, 3)
    covered = float((np.einsum("nc,nc->n", normals, normals) > 0.5).mean())
    return {
        "eye: first exit": [first],
        "eye: first exit, second entrance, second exit": [first, *others],
        "two lights: entry and exit, 1024 x 1024": lights,
        "eye layers and two lights: clearing alone": [Clear(drawn) for drawn in (first, *others, *lights)],
        "white and matt, two lamps": [matt],
        "gather of screen_diffusion": [Gather(context, color, pictures, matrix, True)],
        WITHOUT: [Gather(context, color, pictures, matrix, False)],
    }, covered


def median_ms(context: Any, parts: Sequence[Any], rounds: int) -> float:
    """The median time of some draws; several of each share a query."""
    times, query = [], context.query(time=True)
    for _ in range(rounds + 3):
        with query:
            for _ in range(DRAWS):
                for part in parts:
                    part.draw()
        times.append(1e-6 * query.elapsed / DRAWS)
    return float(np.median(times[3:]))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", default="1920x1080")
    parser.add_argument("--rounds", type=int, default=30)
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    width, height = map(int, arguments.size.split("x"))
    size = width, height
    scene = gpu.published(width / height)
    without = scene._replace(name="without", fragment=scene.fragment.replace("= thinness(p, n)", "= 0.0"))
    published = gpu_timing.measure([scene, without], size, arguments.rounds)
    thinness = published.raw(scene.name).median - published.raw("without").median
    context: Any = cast(OpenGL, backends.require("gl")).context
    with context:
        drawn, covered = passes(context, size)
        times = {}
        for name, parts in drawn.items():
            context.enable_only(
                context.NOTHING if isinstance(parts[0], Gather) else context.DEPTH_TEST | context.CULL_FACE
            )
            times[name] = median_ms(context, parts, arguments.rounds)
    times["gather of screen_diffusion"] -= times.pop(WITHOUT)
    rows = {name: {"ms": ms, "of_thinness": ms / thinness} for name, ms in times.items()}
    together = {"eye layers and two lights": [1, 2], "diffusion": [4, 5]}
    values = list(times.values())
    for name, parts in together.items():
        ms = sum(values[part] for part in parts)
        rows[name] = {"ms": ms, "of_thinness": ms / thinness}
    print(f"{published.device.renderer}, {width} x {height}; the body covers {covered:.0%} of the screen")
    print(f"published thinness of 30 taps: {thinness:.4g} ms")
    for name, row in rows.items():
        print(f"{name:60} {row['ms']:8.4f} ms  {row['of_thinness']:.3f} of it")
    if arguments.json:
        record = {"device": published.device.renderer, "size": list(size), "thinness_ms": thinness, "covered": covered}
        arguments.json.write_text(json.dumps(record | {"rows": rows}, indent=2))


if __name__ == "__main__":
    main()
