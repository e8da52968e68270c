"""Runs emitted functions on real back ends: text and arrays in, arrays out.

    gpu = backend("gl")                                     # or another of TARGETS
    sums, = gpu.run(text, [Call("add", (FLOAT, VEC3), VEC3, (x, y))])

`text` is the functions form of the back end's target. Arguments are data, read from a texture, so no compiler computes
with them beforehand. Each pixel of one image is one lane of one call; values stand component first and lane last, as in
`sssgen.targets.numpy_values`. HLSL runs in OpenGL, over SPIR-V.
"""

from __future__ import annotations

import os
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from sssgen.harness import compilers
from sssgen.ir.types import Matrix, Sampler, Scalar, Type, Vector, components, kind_of, spell
from sssgen.targets import descriptor
from sssgen.targets.numpy_textures import Texture

HEIGHT = 2
"""The lanes stand in two rows, so that there are whole quads of 2×2 pixels, which derivatives need."""

TARGETS = {
    "gl": "glsl-330",
    "gl-es": "glsl-es-300",
    "wgpu": "wgsl",
    "hlsl-glslang": "hlsl",
    "hlsl-dxc": "hlsl",
    "hlsl-dx9": "unity-builtin",
}
"""Back end → the target whose text it runs."""

_DTYPES = {"float": np.float32, "int": np.int32, "uint": np.uint32, "bool": np.uint32}
_VERTEX = "void main() { gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0.0, 1.0); }"


class Call(NamedTuple):
    """One function applied to arrays of lanes; an argument for a texture is its name."""

    function: str
    params: tuple[Type, ...]
    result: Type
    args: tuple[Any, ...]


class Uniforms(NamedTuple):
    """What a material's uniforms are set to: the bytes of its block, or where there is none each one's numbers."""

    block: bytes
    values: Mapping[str, tuple[float, ...]]


class Language(NamedTuple):
    """How the program around the functions is written."""

    declare: str
    bits: Mapping[str, str]
    """Kind → how its bits become it; `{0}` has the components, `{type}` is the type."""
    words: Mapping[str, str]
    """Kind → how it becomes its bits."""
    fetch: str
    main: str


_GLSL = Language(
    "{type} {name} = {value};",
    {"float": "uintBitsToFloat({0})", "int": "{type}({0})", "uint": "{0}", "bool": "notEqual({0}, {zero})"},
    {"float": "floatBitsToUint({0})", "int": "{unsigned}({0})", "uint": "{0}", "bool": "{unsigned}({0})"},
    "texelFetch(sssgen_data, ivec2(lane.x, lane.y + {row}), 0)",
    """
{textures}
uniform highp usampler2D sssgen_data;
out highp uvec4 sssgen_words;
void main() {{
    ivec2 lane = ivec2(int(gl_FragCoord.x), int(gl_FragCoord.y) % 2);
    int slot = int(gl_FragCoord.y) / 2;
    uvec4 words = uvec4(0u);
{body}
    sssgen_words = words;
}}
""",
)
_HLSL = Language(
    "{type} {name} = {value};",
    {"float": "asfloat({0})", "int": "asint({0})", "uint": "{0}", "bool": "({0} != 0u)"},
    {"float": "asuint({0})", "int": "asuint({0})", "uint": "{0}", "bool": "({unsigned})({0})"},
    "sssgen_data.Load(int3(lane.x, lane.y + {row}, 0))",
    """
{textures}
Texture2D<uint4> sssgen_data;
uint4 sssgen_main(float4 place : SV_Position) : SV_Target0 {{
    int2 lane = int2(int(place.x), int(place.y) % 2);
    int slot = int(place.y) / 2;
    uint4 words = uint4(0u, 0u, 0u, 0u);
{body}
    return words;
}}
""",
)
_WGSL = Language(
    "let {name}: {type} = {value};",
    {"float": "bitcast<{type}>({0})", "int": "bitcast<{type}>({0})", "uint": "{0}", "bool": "({0} != {zero})"},
    {"float": "bitcast<{unsigned}>({0})", "int": "bitcast<{unsigned}>({0})", "uint": "{0}", "bool": "{unsigned}({0})"},
    "textureLoad(sssgen_data, vec2i(lane.x, lane.y + {row}), 0)",
    """
{textures}
@group(0) @binding(0) var sssgen_data: texture_2d<u32>;
@vertex fn sssgen_corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {{
    return vec4f(vec2f(f32(index % 2u), f32(index / 2u)) * 4.0 - 1.0, 0.0, 1.0);
}}
@fragment fn sssgen_main(@builtin(position) place: vec4f) -> @location(0) vec4u {{
    let lane = vec2i(i32(place.x), i32(place.y) % 2);
    let slot = i32(place.y) / 2;
    var words = vec4u(0u);
{body}
    return words;
}}
""",
)
_TEXTURE = {
    "glsl": "uniform highp {type} {name};",
    "hlsl": "{type} {name};\nSamplerState {name}_sampler;",
    "hlsl-dx9": "{type} {name};",
}
_UNITY = "float3 UnpackNormal(float4 texel) { return texel.xyz * 2.0 - 1.0; }\n"
"""What Unity's own headers bring, where it leaves normal maps as they are."""


class Program(NamedTuple):
    """A text with its entry point, what it reads, and where its results lie."""

    text: str
    rows: list[np.ndarray[Any, Any]]
    """The data, a row of four words a lane each."""
    places: list[tuple[int, int]]
    """The first slot of each call's result, and how many it takes."""
    slots: int


class Backend:
    """What all back ends share: the program around the functions, the data, and reading the results."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.target = descriptor.load(TARGETS[name])
        self.language = {"glsl": _GLSL, "hlsl": _HLSL, "wgsl": _WGSL}[self.target.language]

    def run(
        self,
        text: str,
        calls: Sequence[Call],
        textures: Mapping[str, Texture] | None = None,
        uniforms: Uniforms | None = None,
    ) -> list[np.ndarray[Any, Any]]:
        """The results of the calls, all of which have the same number of lanes; 0 where a call discards."""
        lanes = max(np.shape(arg)[-1] for call in calls for arg in call.args if not isinstance(arg, str))
        width = -(-lanes // HEIGHT)
        used = {arg for call in calls for arg in call.args if isinstance(arg, str)}
        bound = {name: texture for name, texture in (textures or {}).items() if name in used}
        program = self.program(text, calls, bound, width)
        data = np.concatenate(program.rows).reshape(-1, width, 4)
        image = self.draw(program.text, data, bound, (width, program.slots * HEIGHT), uniforms or Uniforms(b"", {}))
        words = image.reshape(program.slots, HEIGHT * width, 4)
        return [
            _result(call.result, words[first : first + count], lanes)
            for call, (first, count) in zip(calls, program.places, strict=True)
        ]

    def draw(
        self,
        text: str,
        data: np.ndarray[Any, Any],
        textures: Mapping[str, Texture],
        size: tuple[int, int],
        uniforms: Uniforms,
    ) -> np.ndarray[Any, Any]:
        """The image, (height, width, 4) of uint32, that the program draws."""
        raise NotImplementedError

    def program(self, text: str, calls: Sequence[Call], textures: Mapping[str, Texture], width: int) -> Program:
        """One branch a call: whole quads take it, so derivatives and implicit levels are defined in it."""
        rows: list[np.ndarray[Any, Any]] = []
        places: list[tuple[int, int]] = []
        body: list[str] = []
        slots = 0
        for number, call in enumerate(calls):
            before, args = [], []
            for index, (type_, arg) in enumerate(zip(call.params, call.args, strict=True)):
                name = f"a{number}_{index}"
                if isinstance(arg, str):
                    pattern = self.target.textures.get("argument", "{name}")
                    args.append(pattern.format(name=arg, sampler=f"{arg}_sampler"))
                    continue
                before.append(self._declare(type_, name, self._read(type_, len(rows) * HEIGHT)))
                args.append(name)
                rows += _rows(type_, np.asarray(arg), width)
            value = f"{call.function}({', '.join(args)})"
            before.append(self._declare(call.result, f"r{number}", value))
            columns = call.result.size if isinstance(call.result, Matrix) else 1
            keep = []
            for column in range(columns):
                part = f"r{number}[{column}]" if isinstance(call.result, Matrix) else f"r{number}"
                keep.append(f"if (slot == {slots + column}) {{ words = {self._words(call.result, part)}; }}")
            inside = f"if (slot >= {slots} && slot < {slots + columns}) {{"
            body += [inside, *before, *keep, "}"]
            places.append((slots, columns))
            slots += columns
        declared = [self._texture(*item, index) for index, item in enumerate(textures.items())]
        main = self.language.main.format(textures="\n".join(declared), body="\n".join(f"    {line}" for line in body))
        unity = _UNITY if self.target.dialect == "hlsl-dx9" else ""
        return Program(unity + text + main, rows or [np.zeros((HEIGHT * width, 4), np.uint32)], places, slots)

    def _declare(self, type_: Type, name: str, value: str) -> str:
        return self.language.declare.format(type=self.target.types[spell(type_)], name=name, value=value)

    def _read(self, type_: Type, row: int) -> str:
        if isinstance(type_, Matrix):
            columns = [self._read(Vector("float", type_.size), row + HEIGHT * i) for i in range(type_.size)]
            return f"{self.target.types[spell(type_)]}({', '.join(columns)})"
        size = components(type_)
        words = f"{self.language.fetch.format(row=row)}.{'xyzw'[:size]}"
        unsigned = self.target.types["uint" if size == 1 else f"uvec{size}"]
        pattern = self.language.bits[kind_of(type_)]
        if pattern.startswith("notEqual") and size == 1:
            pattern = "({0} != {zero})"
        return pattern.format(words, type=self.target.types[spell(type_)], zero=f"{unsigned}(0u)" if size > 1 else "0u")

    def _words(self, type_: Type, value: str) -> str:
        """Four words, the value's in front."""
        size = type_.size if isinstance(type_, Matrix | Vector) else 1
        unsigned = self.target.types["uint" if size == 1 else f"uvec{size}"]
        words = self.language.words[kind_of(type_)].format(value, unsigned=unsigned)
        return f"{self.target.types['uvec4']}({', '.join([words, *['0u'] * (4 - size)])})"

    def _texture(self, name: str, texture: Texture, index: int) -> str:
        type_ = self.target.types[spell(Sampler(texture.dim))]
        if self.target.language == "wgsl":
            place = "@group(0) @binding({0}) var {1}: {2};"
            sampler = place.format(2 * index + 2, f"{name}_sampler", "sampler")
            return place.format(2 * index + 1, name, type_) + "\n" + sampler
        return _TEXTURE[self.target.dialect.removesuffix("-330")].format(type=type_, name=name)


def _rows(type_: Type, value: np.ndarray[Any, Any], width: int) -> list[np.ndarray[Any, Any]]:
    """An argument as rows of four words a lane."""
    if isinstance(type_, Matrix):
        return [row for column in value for row in _rows(Vector("float", type_.size), column, width)]
    words = np.zeros((HEIGHT * width, 4), np.uint32)
    whole = value.reshape(components(type_), -1).astype(_DTYPES[kind_of(type_)])
    words[: whole.shape[-1] if whole.shape[-1] > 1 else None, : len(whole)] = whole.T.view(np.uint32)
    return [words]


def _result(type_: Type, words: np.ndarray[Any, Any], lanes: int) -> np.ndarray[Any, Any]:
    """The value in the layout of `numpy_values`."""
    size = type_.size if isinstance(type_, Matrix | Vector) else 1
    values = np.ascontiguousarray(words[:, :lanes, :size]).view(_DTYPES[kind_of(type_)])
    if kind_of(type_) == "bool":
        values = values != 0
    values = np.moveaxis(values, 1, 2)
    return values if isinstance(type_, Matrix) else values[0, 0] if isinstance(type_, Scalar) else values[0]


class _Gl(Backend):
    """OpenGL; HLSL comes here as GLSL."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.context = compilers.get("gl")._context  # type: ignore[attr-defined]

    def draw(
        self,
        text: str,
        data: np.ndarray[Any, Any],
        textures: Mapping[str, Texture],
        size: tuple[int, int],
        uniforms: Uniforms,
    ) -> np.ndarray[Any, Any]:
        text = self.glsl(text)
        made: list[Any] = []
        with self.context as context:
            try:
                program = context.program(vertex_shader=f"{text.splitlines()[0]}\n{_VERTEX}", fragment_shader=text)
                target = context.texture(size, 4, dtype="u4")
                source = context.texture((data.shape[1], data.shape[0]), 4, data.tobytes(), dtype="u4")
                source.filter = (context.NEAREST, context.NEAREST)
                frame, array = context.framebuffer([target]), context.vertex_array(program, [])
                made += [program, target, source, frame, array]
                bound = {"sssgen_data": source} | {name: self.upload(texture) for name, texture in textures.items()}
                made += bound.values()
                for unit, member in enumerate(name for name in program if not name.startswith("gl_")):
                    owner = next((name for name in sorted(bound, key=len, reverse=True) if name in member), None)
                    if owner is not None:
                        bound[owner].use(unit)
                        program[member].value = unit
                    elif member in uniforms.values:
                        program[member].value = _as_moderngl(program[member], uniforms.values[member])
                    else:  # the block of HLSL
                        program[member].binding = 0
                        made.append(context.buffer(uniforms.block))
                        made[-1].bind_to_uniform_block(0)
                frame.use()
                array.render(context.TRIANGLES, vertices=3)
                return np.frombuffer(frame.read(components=4, dtype="u4"), np.uint32).reshape(size[1], size[0], 4)
            finally:
                for one in made:
                    one.release()

    def glsl(self, text: str) -> str:
        if self.name == "gl":
            return f"#version 330 core\n{text}"
        if self.name == "gl-es":
            return f"#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler3D;\n{text}"
        return _glsl_of(spirv(text, "sssgen_main", self.name.removeprefix("hlsl-")))

    def upload(self, texture: Texture) -> Any:
        """The texture in OpenGL, whose driver makes the levels, with the same wrapping."""
        level = np.ascontiguousarray(texture.levels[0], np.float16).tobytes()
        make = getattr(self.context, {"2D": "texture", "3D": "texture3d", "Cube": "texture_cube"}[texture.dim])
        made = make(texture.size(), 4, level, dtype="f2")
        if len(texture.levels) > 1:
            made.build_mipmaps()
        smooth = self.context.LINEAR_MIPMAP_LINEAR if len(texture.levels) > 1 else self.context.LINEAR
        made.filter = (smooth, self.context.LINEAR)
        if texture.dim != "Cube":
            made.repeat_x = made.repeat_y = texture.wrap == "repeat"
        if texture.dim == "3D":
            made.repeat_z = texture.wrap == "repeat"
        return made


class _Wgpu(Backend):
    """WebGPU through naga."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.device = compilers.get("naga")._device  # type: ignore[attr-defined]

    def draw(
        self,
        text: str,
        data: np.ndarray[Any, Any],
        textures: Mapping[str, Texture],
        size: tuple[int, int],
        uniforms: Uniforms,
    ) -> np.ndarray[Any, Any]:
        device = self.device
        shader = device.create_shader_module(code=text)
        target = device.create_texture(size=(*size, 1), format="rgba32uint", usage=0x11)  # drawn to, copied from
        state = {"module": shader, "entry_point": "sssgen_main", "targets": [{"format": "rgba32uint"}]}
        vertex = {"module": shader, "entry_point": "sssgen_corner"}
        pipeline = device.create_render_pipeline(layout="auto", vertex=vertex, fragment=state, primitive={})
        source = self.create(data[None], (data.shape[1], data.shape[0], 1), "2d")
        entries = [{"binding": 0, "resource": source.create_view()}]
        for index, texture in enumerate(textures.values()):
            wrap = {"repeat": "repeat", "clamp": "clamp-to-edge", "mirror": "mirror-repeat"}[texture.wrap]
            sampler = device.create_sampler(
                mag_filter="linear", min_filter="linear", mipmap_filter="linear",
                address_mode_u=wrap, address_mode_v=wrap, address_mode_w=wrap,
            )  # fmt: skip
            view = self.upload(texture).create_view(dimension=texture.dim.lower())
            entries += [{"binding": 2 * index + 1, "resource": view}, {"binding": 2 * index + 2, "resource": sampler}]
        group = device.create_bind_group(layout=pipeline.get_bind_group_layout(0), entries=entries)
        encoder = device.create_command_encoder()
        attachment = {"view": target.create_view(), "load_op": "clear", "store_op": "store"}
        drawing = encoder.begin_render_pass(color_attachments=[attachment])
        drawing.set_pipeline(pipeline)
        drawing.set_bind_group(0, group)
        if uniforms.block:
            block = device.create_buffer_with_data(data=uniforms.block, usage=0x40)
            entry = {"binding": 0, "resource": {"buffer": block, "offset": 0, "size": len(uniforms.block)}}
            place = self.target.table["material_group"]
            layout = pipeline.get_bind_group_layout(place)
            drawing.set_bind_group(place, device.create_bind_group(layout=layout, entries=[entry]))
        drawing.draw(3)
        drawing.end()
        device.queue.submit([encoder.finish()])
        layout = {"offset": 0, "bytes_per_row": size[0] * 16, "rows_per_image": size[1]}
        read = device.queue.read_texture({"texture": target}, layout, (*size, 1))
        return np.frombuffer(read, np.uint32).reshape(size[1], size[0], 4)

    def create(self, data: np.ndarray[Any, Any], size: tuple[int, ...], dim: str, levels: int = 1) -> Any:
        whole = "rgba32uint" if data.dtype == np.uint32 else "rgba16float"
        made = self.device.create_texture(size=size, format=whole, usage=0x6, dimension=dim, mip_level_count=levels)
        self.write(made, data, size, 0)
        return made

    def write(self, texture: Any, data: np.ndarray[Any, Any], size: tuple[int, ...], level: int) -> None:
        layout = {"bytes_per_row": size[0] * data.itemsize * 4, "rows_per_image": size[1]}
        place = {"texture": texture, "mip_level": level}
        self.device.queue.write_texture(place, np.ascontiguousarray(data), layout, size)

    def upload(self, texture: Texture) -> Any:
        """The texture in WebGPU, with the same levels."""
        levels = [level.astype(np.float16) for level in texture.levels]
        sizes = [(*level.shape[-2:-4:-1], level.shape[0] if texture.dim != "2D" else 1) for level in levels]
        made = self.create(levels[0], sizes[0], "3d" if texture.dim == "3D" else "2d", len(levels))
        for number in range(1, len(levels)):
            self.write(made, levels[number], sizes[number], number)
        return made


def _as_moderngl(member: Any, numbers: tuple[float, ...]) -> Any:
    """Numbers as moderngl takes them: a scalar, a tuple, or for an array of vectors a list of tuples."""
    size = len(numbers) // member.array_length
    parts = [numbers[start] if size == 1 else numbers[start : start + size] for start in range(0, len(numbers), size)]
    return parts[0] if member.array_length == 1 else parts


def spirv(text: str, entry: str, compiler: str) -> bytes:
    """HLSL as SPIR-V, by `glslang` or `dxc`, or by glslang with the samplers of `dx9`."""
    compilers.get("dxc" if compiler == "dxc" else "glslang")  # raises CompilerMissing
    if compiler == "dxc":
        from compushady.shaders import hlsl

        return bytes(hlsl.compile(text, entry, "ps_6_0"))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "out.spv"
        options = ["--stdin", "-D", "-V", "-S", "frag", "-e", entry, "--auto-map-bindings", "--auto-map-locations"]
        options += ["--hlsl-dx9-compatible"] if compiler == "dx9" else []
        command = [os.environ.get("SSSGEN_GLSLANG", "glslangValidator"), *options, "-o", str(path)]
        done = subprocess.run(command, input=text, capture_output=True, text=True, check=False)
        if done.returncode:
            raise ValueError(f"{done.stdout}\n{text}")
        return path.read_bytes()


def cross(module: bytes, *options: str) -> str:
    """What spirv-cross makes of SPIR-V."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "in.spv"
        path.write_bytes(module)
        done = subprocess.run(["spirv-cross", str(path), *options], capture_output=True, text=True, check=False)
    if done.returncode:
        raise ValueError(done.stderr)
    return done.stdout


def _glsl_of(module: bytes) -> str:
    return cross(module, "--version", "430", "--no-es")


@cache
def backend(name: str) -> Backend:
    """A back end by name. Raises CompilerMissing where this machine lacks it."""
    return _Wgpu(name) if name == "wgpu" else _Gl(name)
