"""Draws an emitted material on a sphere with OpenGL: in a window, or off screen into a picture (PPM).

    sssgen emit paper_lantern --target glsl-330 -o out
    python examples/opengl_program/program.py out/paper_lantern               # a window; needs glfw too
    python examples/opengl_program/program.py out/paper_lantern picture.ppm

It needs moderngl and NumPy, and sssgen for a material that reads pictures of the body, such as jade_ring. What the
material has, it reads from the reflection beside the shader.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import moderngl
import numpy as np

TEXELS = {"white": "ffffffff", "black": "000000ff", "gray": "808080ff", "bump": "8080ffff"}
FRAMEBUFFER_SRGB, SRGB8_ALPHA8 = 0x8DB9, 0x8C43  # OpenGL's numbers
ATTRIBUTES = {"position": "3f", "normal": "3f", "tangent": "4f", "uv": "2f"}


class Shader:
    """A material's program: every uniform at its default, every texture with one texel of its default."""

    def __init__(self, context: moderngl.Context, vertex: str, fragment: str, reflection: Any) -> None:
        self.context = context
        self.program = context.program(vertex_shader=vertex, fragment_shader=fragment)
        self.textures: dict[str, Any] = {}
        self.encoded = reflection["color"] == "encoded"
        self.reflection = reflection
        self.passes: Any = None
        for uniform in reflection["uniforms"]:
            self.put(uniform["name"], uniform["default"])
        for texture in reflection["textures"]:
            shape = (1, 1, 1, 4) if texture["type"] == "sampler3D" else (1, 1, 4)
            texel = bytes.fromhex(TEXELS[texture["default"]])
            self.picture(texture["name"], np.frombuffer(texel, np.uint8).reshape(shape))

    def put(self, name: str, value: Any) -> None:
        """Sets a uniform; a matrix by its columns. A name that the shader does not have is skipped."""
        if name in self.program:
            kind = {"f": "f4", "I": "u4"}.get(self.program[name].fmt[-1], "i4")
            self.program[name].write(np.ascontiguousarray(value, kind).tobytes())

    def picture(self, name: str, texels: Any) -> None:
        """Fills a texture: rows of texels, the lowest row first; a 3-D one has layers of rows."""
        make = self.context.texture if texels.ndim == 3 else self.context.texture3d
        size, kind = texels.shape[-2::-1], "f1" if texels.dtype == np.uint8 else "f4"
        self.textures[name] = make(size, texels.shape[-1], texels.tobytes(), dtype=kind)
        if texels.ndim == 3:
            self.textures[name].build_mipmaps()

    def draw(self, vertices: Any, triangles: Any) -> None:
        """Draws a mesh. A vertex is 12 numbers: position, normal, tangent with its handedness, uv.

        A raymarched material needs no mesh: it covers the screen.
        """
        for unit, (name, texture) in enumerate(self.textures.items()):
            texture.use(unit)
            self.put(name, unit)
        used = [name for name in ATTRIBUTES if name in self.program]
        if not used:
            self.context.vertex_array(self.program, []).render(vertices=3)
            return
        layout = " ".join(text if name in used else f"{4 * int(text[0])}x" for name, text in ATTRIBUTES.items())
        buffer = self.context.buffer(np.asarray(vertices, "f4").tobytes())
        index = self.context.buffer(np.asarray(triangles, "i4").tobytes())
        self.context.vertex_array(self.program, [(buffer, layout, *used)], index).render()


def sphere(rows: int = 64, columns: int = 128) -> tuple[Any, Any]:
    """A unit sphere's vertices and triangles; u goes once around from the back, v from the south pole up."""
    v, u = (axis.ravel() for axis in np.mgrid[0 : 1 : (rows + 1) * 1j, 0 : 1 : (columns + 1) * 1j])
    turn, tilt, zero = 2 * np.pi * (u - 0.5), np.pi * (v - 0.5), 0 * u
    normal = [np.cos(tilt) * np.sin(turn), np.sin(tilt), np.cos(tilt) * np.cos(turn)]
    tangent = [np.cos(turn), zero, -np.sin(turn), zero + 1]
    a = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    b = a + columns + 1
    triangles = np.concatenate([np.stack([a, a + 1, b]), np.stack([b, a + 1, b + 1])], axis=1).T
    return np.stack([*normal, *normal, *tangent, u, v], axis=1), triangles


def camera(eye: Any, target: Any, aspect: float, degrees: float = 40.0) -> Any:
    """The matrices from world space to the camera's, and from there to clip space."""
    back = np.subtract(eye, target) / np.linalg.norm(np.subtract(eye, target))
    right = np.cross([0.0, 1.0, 0.0], back)
    right /= np.linalg.norm(right)
    view, flatten = np.identity(4), np.zeros((4, 4))
    view[:3, :3] = right, np.cross(back, right), back
    view[:3, 3] = -view[:3, :3] @ eye
    flatten[1, 1] = 1 / np.tan(np.radians(degrees) / 2)
    flatten[0, 0] = flatten[1, 1] / aspect
    flatten[2, 2:], flatten[3, 2] = (-1.002, -0.2002), -1.0  # from 0.1 to 100
    return view, flatten


def view(shader: Shader, eye: Any, target: Any, aspect: float, lights: Any, ambient: Any) -> None:
    """Sets what the shell asks for. A light is (x, y, z, w), w = 1 at a place, w = 0 from afar, and a colour."""
    positions, colors = np.zeros((4, 4)), np.zeros((4, 3))
    for number, (position, color) in enumerate(lights):
        positions[number], colors[number] = position, color
    to_camera, projection = camera(eye, target, aspect)
    matrix = projection @ to_camera
    values = {"view_projection": matrix.T, "inverse_view_projection": np.linalg.inv(matrix).T}
    values |= {"model": np.identity(4), "inverse_model": np.identity(4), "camera_position": eye}
    values |= {"light_count": len(lights), "light_positions": positions, "light_colors": colors}
    for name, value in {**values, "ambient_color": ambient, "time": 0.0}.items():
        shader.put(name, value)


def draw_passes(shader: Shader, eye: Any, target: Any, size: tuple[int, int], lights: Any, ambient: Any) -> None:
    """Draws the pictures of the sphere that the material reads: in each frame, as the eye and the lights see it."""
    if not shader.reflection["passes"]:
        return
    from sssgen.run.moderngl_passes import Body, Passes

    if shader.passes is None:
        vertices, triangles = sphere()
        body = Body(shader.context, vertices[:, :3], vertices[:, 3:6], triangles, np.identity(4))
        shader.passes = Passes(shader.context, shader.reflection), body
    passes, body = shader.passes
    drawn = passes.draw(body, *camera(eye, target, size[0] / size[1]), lights, ambient, size)
    shader.textures |= drawn.textures
    for name, matrix in drawn.values.items():
        shader.put(name, matrix.T)


def load(context: moderngl.Context, stem: str) -> Shader:
    """The shader of `out/NAME`: out/NAME.glsl-330.vert, .frag and .reflection.json."""
    paths = [Path(f"{stem}.glsl-330.{end}") for end in ("vert", "frag", "reflection.json")]
    if not all(path.is_file() for path in paths):
        name = Path(stem).name
        sys.exit(f"there is no {paths[0]}: sssgen emit {name} --target glsl-330 -o {Path(stem).parent}")
    texts = [path.read_text("utf-8") for path in paths]
    context.gc_mode = "auto"  # what a frame makes is freed after it
    shader = Shader(context, texts[0], texts[1], json.loads(texts[2]))
    if "thickness_texture" in shader.textures:  # here a program would load a picture: thin, with thick ribs
        rows = np.where(np.arange(512) * 12 % 512 < 36, 255, 64).astype(np.uint8)
        shader.picture("thickness_texture", np.tile(rows[:, None, None], (1, 4, 4)))
    return shader


def frame(shader: Shader, turn: float, size: tuple[int, int]) -> None:
    """One picture: the sphere, a lamp behind it that goes around with `turn`, and the sky above the eye."""
    lamp = (1.6 * np.sin(turn), 0.6, -1.6 * np.cos(turn), 1.0)
    lights = [(lamp, (2.4, 2.2, 1.9)), ((1.0, 2.0, 2.0, 0.0), (0.15, 0.15, 0.2))]
    if any(drawn["seen_from"] == "distant light" for drawn in shader.reflection["passes"]):  # a light from afar alone
        lights = [((*(np.array(lamp[:3]) / np.linalg.norm(lamp[:3])), 0.0), (2.4, 2.2, 1.9))]
    eye, target = (0.0, 0.6, 3.4), (0.0, 0.0, 0.0)
    ambient = (0.05, 0.05, 0.06)
    view(shader, eye, target, size[0] / size[1], lights, ambient)
    draw_passes(shader, eye, target, size, lights, ambient)
    shader.context.enable(moderngl.DEPTH_TEST)
    if not shader.encoded:  # the shader's colours are linear
        shader.context.enable_direct(FRAMEBUFFER_SRGB)
    shader.context.clear(0.004, 0.004, 0.008)
    shader.draw(*sphere())


def off_screen(context: moderngl.Context, size: tuple[int, int]) -> moderngl.Framebuffer:
    """A framebuffer that encodes what is drawn into it, made current."""
    target = context.framebuffer(
        context.texture(size, 4, internal_format=SRGB8_ALPHA8), context.depth_renderbuffer(size)
    )
    target.use()
    return target


def to_picture(stem: str, path: str, size: tuple[int, int] = (640, 640)) -> None:
    """Draws without a window, into a PPM file."""
    backend: Any = {"backend": "egl"} if sys.platform == "linux" else {}
    context = moderngl.create_context(standalone=True, **backend)
    target = off_screen(context, size)
    frame(load(context, stem), 0.4, size)
    rows = np.frombuffer(target.read(components=3, alignment=1), np.uint8).reshape(size[1], -1)
    Path(path).write_bytes(b"P6 %d %d 255\n" % size + rows[::-1].tobytes())


def in_a_window(stem: str, size: tuple[int, int] = (640, 640)) -> None:
    """Draws until the window is closed."""
    import glfw

    glfw.init()
    hints = {glfw.CONTEXT_VERSION_MAJOR: 3, glfw.CONTEXT_VERSION_MINOR: 3, glfw.SRGB_CAPABLE: True}
    hints |= {glfw.OPENGL_PROFILE: glfw.OPENGL_CORE_PROFILE, glfw.OPENGL_FORWARD_COMPAT: True}
    for hint, value in hints.items():
        glfw.window_hint(hint, value)
    window = glfw.create_window(*size, Path(stem).name, None, None)
    glfw.make_context_current(window)
    shader = load(moderngl.create_context(), stem)
    while not glfw.window_should_close(window):
        shader.context.viewport = (0, 0, *glfw.get_framebuffer_size(window))
        frame(shader, glfw.get_time(), glfw.get_framebuffer_size(window))
        glfw.swap_buffers(window)
        glfw.poll_events()
    glfw.terminate()


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 3:
        sys.exit(__doc__)
    to_picture(*sys.argv[1:]) if len(sys.argv) == 3 else in_a_window(sys.argv[1])
