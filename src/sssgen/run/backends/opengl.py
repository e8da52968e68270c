"""OpenGL through moderngl, off screen: a GPU's driver, or Mesa's llvmpipe where there is none."""

from __future__ import annotations

import ctypes
import ctypes.util
from collections import OrderedDict
from collections.abc import Collection, Mapping
from itertools import count
from time import perf_counter
from typing import Any

import numpy as np

from sssgen.run import compilers
from sssgen.run.backends.backend_interface import (
    Array,
    Block,
    Bound,
    Drawing,
    Text,
    backend_failure,
    refusal,
)
from sssgen.run.backends.draw_backend import DrawingBackend
from sssgen.run.compilers.gl_driver import DriverGL, later_version, messages
from sssgen.targets.runtime.numpy_textures import Texture

HEADS = {
    "glsl-330": "#version 330 core\n#line 1\n",
    "glsl-es-300": "#version 300 es\nprecision highp float;\nprecision highp int;\n"
    "precision highp sampler2D;\nprecision highp sampler3D;\nprecision highp samplerCube;\n"
    "#line 1\n",
}
_SCREEN = "void main() { gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0.0, 1.0); }"
_KEPT = 64
"""The most compiled programs of a process; the oldest is released first."""


class OpenGL(DrawingBackend):
    """Compiles GLSL in the driver and draws with it."""

    unsupported_types = frozenset(
        ("samplerCubeArray", "samplerCubeShadow", "sampler2DArrayShadow")
    )  # moderngl cannot bind them

    def __init__(self, name: str, target: str) -> None:
        super().__init__(name, target)
        driver = compilers.get("gl")
        assert isinstance(driver, DriverGL)
        self.driver = driver
        self.context: Any = driver.context
        kinds = {"2D": "GL_MAX_TEXTURE_SIZE", "3D": "GL_MAX_3D_TEXTURE_SIZE", "Cube": "GL_MAX_CUBE_MAP_TEXTURE_SIZE"}
        self.largest = {dim: int(self.context.info[name]) for dim, name in kinds.items()}
        self.programs: OrderedDict[tuple[str, str], Any] = OrderedDict()

    def device(self) -> str:
        return self.driver.version()

    def draw(self, drawing: Drawing) -> Array:
        self.check(drawing)
        vertex, fragment = self.stages(drawing)
        with self.context:  # other libraries may have made their context current
            program = self.program(vertex, fragment, drawing.fragment.text)
            try:
                return self.fill(program, drawing)
            except MemoryError:
                raise backend_failure(
                    self.name, f"no memory for a picture of {drawing.size[0]}×{drawing.size[1]}"
                ) from None
            except Exception as error:
                raise backend_failure(self.name, f"the driver failed: {error}") from error

    def stages(self, drawing: Drawing) -> tuple[str, str]:
        """The GLSL of the two stages."""
        fragment = drawing.fragment.text.text
        head = later_version(HEADS[self.target.name], fragment)
        fragment = fragment if fragment.startswith("#version") else head + fragment
        vertex = drawing.vertex.text.text if drawing.vertex else head + _SCREEN
        return vertex, fragment

    def program(self, vertex: str, fragment: str, origin: Text) -> Any:
        """The linked program, cached. `origin` has the places for messages."""
        key = (vertex, fragment)
        if key in self.programs:
            self.programs.move_to_end(key)
            return self.programs[key]
        try:
            program = self.context.program(vertex_shader=vertex, fragment_shader=fragment)
        except Exception as error:
            raise refusal(self.name, origin, messages(str(error))) from None
        self.programs[key] = program
        if len(self.programs) > _KEPT:
            self.programs.popitem(last=False)[1].release()
        return program

    def fill(self, program: Any, drawing: Drawing) -> Array:
        """Binds by name and draws; only the program is kept."""
        context, (width, height) = self.context, drawing.size
        resources: list[Any] = []

        def keep(resource: Any) -> Any:
            resources.append(resource)
            return resource

        try:
            kind = "f4" if drawing.floats else "u4"
            frame = keep(context.framebuffer([keep(context.texture(drawing.size, 4, dtype=kind))]))
            self.bind_uniforms(program, drawing.textures, drawing.values, keep)
            self.bind_blocks(program, drawing.blocks, keep)
            array = keep(self.vertex_array(program, drawing, keep))
            frame.use()
            context.viewport = (0, 0, width, height)
            context.disable(context.DEPTH_TEST | context.BLEND | context.CULL_FACE)
            frame.clear()
            context.finish()
            start = perf_counter()
            array.render(context.TRIANGLES, vertices=-1 if drawing.triangles is not None else 3)
            context.finish()
            self.draw_seconds = perf_counter() - start
            dtype: Any = np.float32 if drawing.floats else np.uint32
            data = frame.read(components=4, dtype=kind)
            return np.frombuffer(data, dtype).reshape(height, width, 4)
        finally:
            for resource in resources:
                resource.release()

    def bind_uniforms(
        self, program: Any, bound_textures: Mapping[str, Bound], values: Mapping[str, Array], keep: Any
    ) -> None:
        """Binds the textures and sets the uniforms that the program has."""
        textures = {name: keep(self.upload(bound.data)) for name, bound in bound_textures.items()}
        unit = count()
        for member in [name for name in program if is_loose(program[name])]:
            name = self.owner(member, textures)
            elements = [f"{member}[{index}]" for index in range(program[member].array_length)]
            default = next((element for element in elements if element in textures), "")
            bound = [name] if name else []
            if default and not name:
                bound = [element if element in textures else default for element in elements]
            if bound:
                units = [next(unit) for _ in bound]
                for number, texture in zip(units, bound, strict=True):
                    textures[texture].use(number)
                program[member].value = units[0] if len(units) == 1 else tuple(units)
            elif member in values:
                _write(program[member], values[member])

    def bind_blocks(self, program: Any, blocks: Mapping[str, Block], keep: Any) -> None:
        """Binds the uniform blocks that the program has."""
        members = [name for name in program if hasattr(program[name], "binding")]
        for number, member in enumerate(members):
            name = self.owner(member, blocks)
            if name:
                buffer = keep(self.context.buffer(blocks[name].data))
                program[member].binding = number
                buffer.bind_to_uniform_block(number)

    def owner(self, member: str, names: Collection[str]) -> str:
        """The name of the drawing's texture or block for a member of the program; '' where it is none."""
        return member if member in names else ""

    def vertex_array(self, program: Any, drawing: Drawing, keep: Any) -> Any:
        """The vertices, with the attributes that the program has."""
        if drawing.vertices is None or drawing.triangles is None:
            return self.context.vertex_array(program, [])
        buffer = keep(self.context.buffer(np.ascontiguousarray(drawing.vertices, np.float32)))
        index = keep(self.context.buffer(np.ascontiguousarray(drawing.triangles, np.uint32)))
        attributes = {name: self.attribute(program, name) for name in drawing.attributes}
        layout = " ".join(
            f"{size}f" if attributes[name] else f"{4 * size}x" for name, (_, size) in drawing.attributes.items()
        )
        names = [name for name in attributes.values() if name]
        return self.context.vertex_array(program, [(buffer, layout, *names)], index)

    def attribute(self, program: Any, name: str) -> str:
        """The program's name for an attribute; '' where it has none."""
        return name if name in program else ""

    def upload(self, data: Texture | Array) -> Any:
        """A texture with the same filter and wrapping; the driver computes further levels, but not those of a cube."""
        context = self.context
        if isinstance(data, np.ndarray):
            texture = context.texture((data.shape[1], data.shape[0]), 4, np.ascontiguousarray(data), dtype="u4")
            texture.filter = (context.NEAREST, context.NEAREST)
            return texture
        texture = self.depths(data) if data.compare else self.texels(data)
        if len(data.levels) > 1:
            texture.build_mipmaps()
            if data.dim == "Cube":
                write_cube_levels(texture.glo, data)
        with_levels, single_level = {
            "linear": (context.LINEAR_MIPMAP_LINEAR, context.LINEAR),
            "nearest": (context.NEAREST_MIPMAP_LINEAR, context.NEAREST),
        }[data.filter]
        texture.filter = (with_levels if len(data.levels) > 1 else single_level, single_level)
        if data.dim != "Cube":
            texture.repeat_x = texture.repeat_y = data.wrap == "repeat"
        if data.dim == "3D":
            texture.repeat_z = data.wrap == "repeat"
        return texture

    def texels(self, data: Texture) -> Any:
        """The first level of a texture, not yet filtered. Raises SssgenError for a kind that moderngl cannot create."""
        if data.layers and data.dim != "2D":
            raise backend_failure(self.name, "this back end has no layered cube maps", "WebGPU has them")
        name = {"2D": "texture", "3D": "texture3d", "Cube": "texture_cube"}[data.dim]
        name = "texture_array" if data.layers else name
        size = (*data.size(), len(data.levels[0])) if data.layers else data.size()
        dtype = {"float": "f2", "int": "i4", "uint": "u4"}[data.kind]
        level = np.ascontiguousarray(data.levels[0], np.float16 if data.kind == "float" else None)
        return getattr(self.context, name)(size, 4, level.tobytes(), dtype=dtype)

    def depths(self, data: Texture) -> Any:
        """A depth texture that compares. Raises SssgenError for a kind that moderngl cannot create or bind."""
        if data.layers or data.dim != "2D":
            raise backend_failure(self.name, "this back end has only 2D depth textures", "WebGPU has the others")
        depths = np.ascontiguousarray(data.levels[0][..., 0], np.float32)
        texture = self.context.depth_texture(data.size(), depths.tobytes())
        texture.compare_func = "<="
        return texture


def write_cube_levels(name: int, data: Texture) -> None:
    """Replaces the levels of a cube map by those of the texture. moderngl writes the first level only."""
    library: Any = ctypes.CDLL(ctypes.util.find_library("OpenGL") or ctypes.util.find_library("GL") or "opengl32")
    library.glBindTexture(_CUBE_MAP, name)
    for number, level in enumerate(data.levels[1:], 1):
        for face, texels in enumerate(np.ascontiguousarray(level, np.float16)):
            place = (_POSITIVE_X + face, number, 0, 0, texels.shape[1], texels.shape[0])
            library.glTexSubImage2D(*place, _RGBA, _HALF_FLOAT, texels.ctypes.data_as(ctypes.c_void_p))


_CUBE_MAP, _POSITIVE_X, _RGBA, _HALF_FLOAT = 0x8513, 0x8515, 0x1908, 0x140B


def is_loose(member: Any) -> bool:
    """Whether a program's member is a uniform outside of blocks."""
    import moderngl

    return isinstance(member, moderngl.Uniform)


def _write(member: Any, numbers: Array) -> None:
    kind = {"f": np.float32, "I": np.uint32}.get(member.fmt[-1], np.int32)
    size = 4 * member.dimension * member.array_length  # the driver may drop unread elements of an array
    member.write(np.ascontiguousarray(numbers, kind).tobytes()[:size])
