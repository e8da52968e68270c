"""The passes of a material in a program with moderngl: pictures of the body alone, as the eye or a light sees it.

    passes = Passes(context, reflection)                 # of sssgen emit --target glsl-330
    body = Body(context, positions, normals, triangles, model)
    drawn = passes.draw(body, view, projection, lights, ambient, size)
    drawn.textures, drawn.values                         # by the names in the shader

It executes the list of the reflection (ir/frame_passes.py), for each frame. The framebuffer, the viewport and the depth
test are as before afterwards.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from sssgen.ir.frame_passes import FAR, MATT
from sssgen.scene.arrays import Array
from sssgen.scene.drawn_views import TILES, shown_lights
from sssgen.scene.light_view import directional_view, point_view
from sssgen.targets.reflection_record import PassRecord, Reflection

SIDE = 1024
"""The width of what one light sees, in texels."""
LAYER_GAP = 1e-3
"""The least distance between two layers, in diagonals of the body."""

VERTEX = """#version 330 core
uniform mat4 to_clip;
uniform mat4 to_world;
in vec3 position;
in vec3 normal;
out vec3 v_normal;
out vec3 v_position;
void main() {
    vec4 place = to_world * vec4(position, 1.0);
    v_position = place.xyz;
    v_normal = normal * inverse(mat3(to_world));
    gl_Position = to_clip * place;
}
"""
DISTANCE = """#version 330 core
uniform vec4 plane;  // its product with a place is the distance; zeros: the distance from the eye
uniform vec3 eye;
uniform sampler2D front;
uniform float margin;  // above 0: of surfaces that lie so far behind those of `front`
in vec3 v_position;
out vec4 texel;
void main() {
    float way = plane == vec4(0.0) ? distance(eye, v_position) : dot(plane, vec4(v_position, 1.0));
    if (margin > 0.0 && way < texelFetch(front, ivec2(gl_FragCoord.xy), 0).r + margin) discard;
    texel = vec4(way);
}
"""
LIGHT = """#version 330 core
uniform vec4 plane;
uniform vec4 positions[4];
uniform vec3 colors[4];
uniform vec3 ambient;
in vec3 v_position;
in vec3 v_normal;
out vec4 texel;
void main() {
    vec3 light = ambient;
    for (int i = 0; i < 4; i++) {
        vec3 way = positions[i].xyz - v_position * positions[i].w;
        float square = max(dot(way, way), 1e-4);
        float fall = inversesqrt(square) * mix(1.0, 1.0 / square, positions[i].w);
        light += colors[i] * max(dot(normalize(v_normal), way), 0.0) * fall;
    }
    texel = vec4(light, dot(plane, vec4(v_position, 1.0)));
}
"""
SCREEN = """#version 330 core
void main() {
    gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}
"""
PACKING = """#version 330 core
uniform sampler2D layers[4];
out vec4 texel;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    texel = vec4(texelFetch(layers[0], at, 0).r, texelFetch(layers[1], at, 0).r, texelFetch(layers[2], at, 0).r,
        texelFetch(layers[3], at, 0).r);
}
"""


class Body:
    """A mesh for the passes. Its corners are those of its box, so that lights see all of it."""

    def __init__(self, context: Any, positions: Array, normals: Array, triangles: Array, model: Array) -> None:
        """`positions` and `normals` (n, 3) in object space, `triangles` (m, 3), counter-clockwise seen from outside;
        `model` (4, 4) is from object space to world space, for column vectors."""
        data = np.concatenate([positions, normals], axis=1)
        self.vertices = context.buffer(np.ascontiguousarray(data, "f4").tobytes())
        self.triangles = context.buffer(np.ascontiguousarray(triangles, "i4").tobytes())
        self.model = np.asarray(model, np.float64)
        ends = np.stack([np.min(positions, axis=0), np.max(positions, axis=0)])
        self._corners = np.array([[*ends[[i, j, k], range(3)], 1.0] for i in (0, 1) for j in (0, 1) for k in (0, 1)])

    @property
    def corners(self) -> Array:
        """(8, 3), in world space; `model` may change between two frames."""
        corners: Array = (self._corners @ self.model.T)[:, :3]
        return corners


class Drawn(NamedTuple):
    """What a shader reads of passes, by the names in its text."""

    textures: dict[str, Any]
    """moderngl textures"""
    values: dict[str, Array]
    """Matrices (4, 4), for column vectors"""


class View(NamedTuple):
    """What a camera sees of a body."""

    to_picture: Array
    """(4, 4): world space to (u w, v w, distance from a plane, w)"""
    to_clip: Array
    """(4, 4): world space to clip space"""
    far: float
    """The distance of the body's farthest corner from that plane"""


class Passes:
    """The passes of a material on one body: bodies that are shaded one after the other may share it."""

    def __init__(self, context: Any, reflection: Reflection) -> None:
        """Raises ValueError for a pass that shows other bodies or the surroundings: the program draws these."""
        self.context = context
        self.passes = [
            drawn for drawn in reflection["passes"] if drawn["of"] != "surroundings" and drawn["seen_from"] != "inside"
        ]
        if others := [drawn["name"] for drawn in self.passes if drawn["of"] != "body"]:
            raise ValueError(f"{', '.join(others)}: only pictures of the body are drawn here")
        entries = (*reflection["textures"], *reflection["uniforms"])
        self._names = {entry["source_name"]: entry["name"] for entry in entries}
        self._programs = {
            name: context.program(vertex_shader=VERTEX, fragment_shader=text)
            for name, text in (("distance", DISTANCE), ("light", LIGHT))
        }
        packing = context.program(vertex_shader=SCREEN, fragment_shader=PACKING)
        packing["layers"].value = (0, 1, 2, 3)
        self._packing = context.vertex_array(packing, [])
        self._targets: dict[tuple[Any, ...], Any] = {}
        self._arrays: WeakKeyDictionary[Body, dict[str, Any]] = WeakKeyDictionary()

    def draw(
        self,
        body: Body,
        view: Array,
        projection: Array,
        lights: Sequence[tuple[Sequence[float], Sequence[float]]],
        ambient: Sequence[float],
        size: tuple[int, int],
    ) -> Drawn:
        """Draws the pictures of a frame, the eye's in `size`, and gives them with the matrices of their views.

        `view` and `projection` are (4, 4), for column vectors, as in OpenGL. A light is (x, y, z, w), w = 1 at a place,
        w = 0 the direction towards it, and a colour. A light that a picture needs and that is missing leaves zeros.
        """
        screen = self.context.fbo
        if not hasattr(getattr(screen, "mglo", None), "viewport"):  # none is in use, or it has been released
            screen = None
        viewport = screen.viewport if screen is not None else None
        positions = np.array([position for position, _ in lights], float).reshape(-1, 4)
        colors = np.array([color for _, color in lights], float).reshape(-1, 3)
        textures: dict[str, Any] = {}
        values: dict[str, Array] = {}
        for drawn in self.passes:
            tiles = TILES if len(drawn["views"]) > 1 else 1
            seen = [self._eye(body, view, projection)]
            if drawn["seen_from"] != "eye":
                shown = shown_lights(drawn["name"], body.corners.mean(axis=0), positions, colors)
                seen = [_light_view(body.corners, positions[index]) for index in shown]
            whole = size if drawn["seen_from"] == "eye" else (tiles * SIDE, tiles * SIDE)
            if drawn["name"] == MATT:
                target = self._light_on_body(body, drawn, seen[0], view, lights, ambient, whole)
            else:
                target = self._layers(body, drawn, seen, view, whole, tiles)
            textures[self._names[drawn["texture"]]] = target.color_attachments[0]
            for number, name in enumerate(drawn["views"]):
                row, column = divmod(number, tiles)
                matrix = seen[number].to_picture.copy() if number < len(seen) else np.zeros((4, 4))
                matrix[0] = (matrix[0] + column * matrix[3]) / tiles
                matrix[1] = (matrix[1] + row * matrix[3]) / tiles
                values[self._names[name]] = matrix
        if screen is not None:
            screen.use()
            screen.viewport = viewport
        return Drawn(textures, values)

    def _eye(self, body: Body, view: Array, projection: Array) -> View:
        """The eye's view, with the plane in the middle of the body."""
        clip = projection @ view
        x, y, _, w = clip
        distances = body.corners @ w[:3] + w[3]
        middle = np.array([0.0, 0.0, 0.0, float(distances.mean())])
        return View(np.stack([0.5 * (x + w), 0.5 * (y + w), w - middle, w]), clip, float(distances.max()))

    def _layers(
        self, body: Body, drawn: PassRecord, seen: Sequence[View], view: Array, size: tuple[int, int], tiles: int
    ) -> Any:
        margin = LAYER_GAP * float(np.linalg.norm(np.ptp(body.corners, axis=0)))
        by_eye = drawn["seen_from"] == "eye"
        # filters blend the texels of what lights see, so that a large number would spread into the body's edge
        far = FAR if by_eye else max((each.far for each in seen), default=1.0)
        empty = far if drawn["empty"] == "far" else 0.0
        layers: list[Any] = []
        for number, layer in enumerate(drawn["layers"]):
            target = self._target((drawn["name"], number), size, 1, False)
            target.use()
            target.clear(empty)
            side, place = layer.split()
            before = f"exit {int(place) - 1}" if side == "entry" else f"entry {place}"
            front = layers[drawn["layers"].index(before)] if int(place) > 1 else None
            if front is not None:
                front.color_attachments[0].use(0)
            for tile, each in enumerate(seen):
                width = size[0] // tiles
                self.context.viewport = (
                    ((tile % tiles) * width, (tile // tiles) * width, width, width) if tiles > 1 else (0, 0, *size)
                )
                eye = -view[:3, :3].T @ view[:3, 3]
                plane = np.zeros(4) if by_eye else each.to_picture[2]
                values = {"plane": plane, "eye": eye, "margin": 0.0 if front is None else margin, "front": 0}
                self._render("distance", body, each, values, "front" if side == "exit" else "back")
            layers.append(target)
        if len(layers) == 1:
            return layers[0]
        packed = self._target((drawn["name"], "packed"), size, 4, not by_eye)
        packed.use()
        self.context.viewport = (0, 0, *size)
        for unit in range(4):
            layers[min(unit, len(layers) - 1)].color_attachments[0].use(unit)
        with self.context.scope(framebuffer=packed, enable_only=self.context.NOTHING):
            self._packing.render(vertices=3)
        return packed

    def _light_on_body(
        self,
        body: Body,
        drawn: PassRecord,
        seen: View,
        view: Array,
        lights: Sequence[tuple[Sequence[float], Sequence[float]]],
        ambient: Sequence[float],
        size: tuple[int, int],
    ) -> Any:
        """What a white matt body reflects, without shadows: the shells of programs have none either."""
        target = self._target((drawn["name"], 0), size, 4, True)
        target.use()
        target.clear(0.0, 0.0, 0.0, FAR)
        self.context.viewport = (0, 0, *size)
        positions, colors = np.zeros((4, 4)), np.zeros((4, 3))
        for number, (position, color) in enumerate(lights[:4]):
            positions[number], colors[number] = position, color
        values = {"plane": seen.to_picture[2], "positions": positions, "colors": colors, "ambient": ambient}
        self._render("light", body, seen, values, "back")
        return target

    def _render(self, name: str, body: Body, seen: View, values: Mapping[str, Any], culled: str) -> None:
        program, context = self._programs[name], self.context
        for key, value in {**values, "to_clip": seen.to_clip.T, "to_world": body.model.T}.items():
            if key in program:
                kind = "i4" if key == "front" else "f4"
                program[key].write(np.ascontiguousarray(value, kind).tobytes())
        arrays = self._arrays.setdefault(body, {})
        if name not in arrays:
            names = [attribute for attribute in ("position", "normal") if attribute in program]
            layout = " ".join("3f" if attribute in names else "12x" for attribute in ("position", "normal"))
            arrays[name] = context.vertex_array(program, [(body.vertices, layout, *names)], body.triangles)
        context.cull_face = culled
        with context.scope(framebuffer=context.fbo, enable_only=context.DEPTH_TEST | context.CULL_FACE):
            arrays[name].render()

    def _target(self, key: tuple[Any, ...], size: tuple[int, int], channels: int, smooth: bool) -> Any:
        """A framebuffer with a picture, kept until its size changes."""
        target = self._targets.get(key)
        if target is None or target.size != size:
            texture = self.context.texture(size, channels, dtype="f4")
            texture.repeat_x = texture.repeat_y = False
            kind = self.context.LINEAR if smooth else self.context.NEAREST
            texture.filter = (kind, kind)
            target = self._targets[key] = self.context.framebuffer([texture], self.context.depth_renderbuffer(size))
        return target


def _light_view(corners: Array, light: Array) -> View:
    """A light's view of a body within corners (8, 3). Raises SssgenError for a light at the body."""
    if light[3]:
        matrix = point_view(corners, light[:3], (1, 1)).matrix
    else:
        matrix = directional_view(corners, light[:3] / np.linalg.norm(light[:3]), (1, 1)).matrix
    x, y, z, w = matrix
    distances = corners @ z[:3] + z[3]
    end = float(distances.max())
    near, far = 0.99 * float(distances.min()), 1.01 * end
    # in a parallel view w is 1; in one from a point w is z
    depth = (far + near) * z - 2.0 * far * near * np.eye(4)[3] if light[3] else 2.0 * z - (far + near) * w
    return View(matrix, np.stack([2.0 * x - w, 2.0 * y - w, depth / (far - near), w]), end)
