"""The program around emitted functions: it reads arguments from a texture, calls, and writes results as pixels.

Arguments are data, so no compiler can evaluate a call. Each pixel is one lane of one call. The lanes are in
an even number of rows, so that there are whole quads of 2×2 pixels, which derivatives need.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from sssgen.ir.types import Matrix, Sampler, Scalar, Type, Vector, column_size, components, kind_of, spell, vector_of
from sssgen.run.backends.backend_interface import Array, Bound, Call, Drawing, Place, Stage, Text
from sssgen.targets.descriptor import Target
from sssgen.targets.registry import load
from sssgen.targets.runtime.numpy_textures import Texture

WIDTH = 4096
"""The most lanes in a row; every driver takes pictures twice as wide."""

FRAGMENT, CORNER = "sssgen_main", "sssgen_corner"
"""The names of the added entry points, in languages where these are free."""

DTYPES = {"float": np.float32, "int": np.int32, "uint": np.uint32, "bool": np.uint32}


class Language(NamedTuple):
    """The texts of the program around the functions."""

    declare: str
    bits: Mapping[str, str]
    """Kind → the conversion from its bits; `{0}` is their text, `{type}` the type."""
    words: Mapping[str, str]
    """Kind → the conversion to its bits."""
    fetch: str
    main: str


LANGUAGES = {
    "glsl": Language(
        "{type} {name} = {value};",
        {"float": "uintBitsToFloat({0})", "int": "{type}({0})", "uint": "{0}", "bool": "notEqual({0}, {zero})"},
        {"float": "floatBitsToUint({0})", "int": "{unsigned}({0})", "uint": "{0}", "bool": "{unsigned}({0})"},
        "texelFetch(sssgen_data, ivec2(sssgen_lane.x, sssgen_lane.y + {row}), 0)",
        """
{textures}
uniform highp usampler2D sssgen_data;
out highp uvec4 sssgen_words;
void main() {{
    ivec2 sssgen_lane = ivec2(int(gl_FragCoord.x), int(gl_FragCoord.y) % {rows});
    int sssgen_slot = int(gl_FragCoord.y) / {rows};
    uvec4 sssgen_value = uvec4(0u);
{body}
    sssgen_words = sssgen_value;
}}
""",
    ),
    "hlsl": Language(
        "{type} {name} = {value};",
        {"float": "asfloat({0})", "int": "asint({0})", "uint": "{0}", "bool": "({0} != 0u)"},
        {"float": "asuint({0})", "int": "asuint({0})", "uint": "{0}", "bool": "({unsigned})({0})"},
        "sssgen_data.Load(int3(sssgen_lane.x, sssgen_lane.y + {row}, 0))",
        """
{textures}
Texture2D<uint4> sssgen_data;
uint4 sssgen_main(float4 sssgen_place : SV_Position) : SV_Target0 {{
    int2 sssgen_lane = int2(int(sssgen_place.x), int(sssgen_place.y) % {rows});
    int sssgen_slot = int(sssgen_place.y) / {rows};
    uint4 sssgen_value = uint4(0u, 0u, 0u, 0u);
{body}
    return sssgen_value;
}}
""",
    ),
    "wgsl": Language(
        "let {name}: {type} = {value};",
        {"float": "bitcast<{type}>({0})", "int": "bitcast<{type}>({0})", "uint": "{0}", "bool": "({0} != {zero})"},
        {
            "float": "bitcast<{unsigned}>({0})",
            "int": "bitcast<{unsigned}>({0})",
            "uint": "{0}",
            "bool": "{unsigned}({0})",
        },
        "textureLoad(sssgen_data, vec2i(sssgen_lane.x, sssgen_lane.y + {row}), 0)",
        """
{textures}
@group(0) @binding(0) var sssgen_data: texture_2d<u32>;
@vertex fn sssgen_corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {{
    return vec4f(vec2f(f32(index % 2u), f32(index / 2u)) * 4.0 - 1.0, 0.0, 1.0);
}}
@fragment fn sssgen_main(@builtin(position) sssgen_place: vec4f) -> @location(0) vec4u {{
    let sssgen_lane = vec2i(i32(sssgen_place.x), i32(sssgen_place.y) % {rows});
    let sssgen_slot = i32(sssgen_place.y) / {rows};
    var sssgen_value = vec4u(0u);
{body}
    return sssgen_value;
}}
""",
    ),
}
_HALF = {
    "bits": {"float": "{type}(bitcast<{single}>({0}))"},
    "words": {"float": "bitcast<{unsigned}>({single}({0}))"},
}
"""WGSL in half precision: arguments and results are float32, which holds every half; `{single}` is that type."""

_TEXTURES = {
    "glsl": "uniform highp {type} {name};",
    "hlsl": "{type} {name};\n{sampler_type} {sampler};",
    "hlsl-dx9": "{type} {name};",
    "wgsl": "@group(0) @binding({first}) var {name}: {type};\n"
    "@group(0) @binding({second}) var {sampler}: {sampler_type};",
}


class Grid(NamedTuple):
    """The size of the grid of lanes in the picture, row by row."""

    width: int
    rows: int


def grid(lanes: int) -> Grid:
    """The grid for that many lanes; `rows` is even."""
    rows = 2 * -(-lanes // (2 * WIDTH))
    return Grid(-(-lanes // rows), rows)


class Layout(NamedTuple):
    """The places of the results in the picture."""

    lanes: int
    grid: Grid
    places: list[tuple[int, int]]
    """The first slot of each call's result, and how many it takes; a slot is `rows` rows of pixels."""


def drawing(
    target: Target, text: Text, calls: Sequence[Call], textures: Mapping[str, Texture]
) -> tuple[Drawing, Layout]:
    """The draw that runs the calls. Its program starts with `text`, so that line numbers stay the same."""
    lanes = max(np.shape(arg)[-1] for call in calls for arg in call.args if not isinstance(arg, str))
    used = {arg for call in calls for arg in call.args if isinstance(arg, str)}
    bound = {name: Bound(texture, Place(0, 2 * i + 1, 2 * i + 2)) for i, (name, texture) in enumerate(
        (name, texture) for name, texture in textures.items() if name in used
    )}  # fmt: skip
    writer = _Writer(target, grid(lanes))
    for number, call in enumerate(calls):
        writer.call(number, call)
    declared = [_declaration(target, name, resource) for name, resource in bound.items()]
    body = "\n".join(f"    {line}" for line in writer.body)
    main = writer.language.main.format(textures="\n".join(declared), body=body, rows=writer.grid.rows)
    rows = writer.data or [np.zeros((writer.grid.rows * writer.grid.width, 4), np.uint32)]
    bound["sssgen_data"] = Bound(np.concatenate(rows).reshape(-1, writer.grid.width, 4), Place(0, 0))
    stage = Stage(Text(text.text + main, text.origin), "main" if _family(target) == "glsl" else FRAGMENT)
    vertex = Stage(stage.text, CORNER) if _family(target) == "wgsl" else None
    size = writer.grid.width, writer.slots * writer.grid.rows
    return Drawing(size, stage, vertex, textures=bound), Layout(lanes, writer.grid, writer.places)


def results(calls: Sequence[Call], layout: Layout, picture: Array) -> list[Array]:
    """The results in a picture of (height, width, 4) uint32."""
    words = picture.reshape(-1, layout.grid.rows * layout.grid.width, 4)
    return [
        _result(call.result, words[first : first + count], layout.lanes)
        for call, (first, count) in zip(calls, layout.places, strict=True)
    ]


class _Writer:
    """Writes one branch for each call: whole quads take it, so derivatives and implicit levels are defined in it."""

    def __init__(self, target: Target, grid: Grid) -> None:
        self.target, self.grid = target, grid
        self.language = LANGUAGES[_family(target)]
        self.half = bool(target.half_of)
        self.single = load(target.half_of).types if self.half else target.types
        if self.half:
            bits, words = {**self.language.bits, **_HALF["bits"]}, {**self.language.words, **_HALF["words"]}
            self.language = self.language._replace(bits=bits, words=words)
        self.data: list[Array] = []
        self.body: list[str] = []
        self.places: list[tuple[int, int]] = []
        self.slots = 0

    def call(self, number: int, call: Call) -> None:
        statements, args = [], []
        for index, (type_, arg) in enumerate(zip(call.params, call.args, strict=True)):
            name = f"sssgen_a{number}_{index}"
            if isinstance(arg, str):
                args.append(self.target.textures.argument.format(name=arg, sampler=f"{arg}_sampler"))
                continue
            statements.append(self._declare(type_, name, self._read(type_, len(self.data) * self.grid.rows)))
            args.append(name)
            self.data += rows_of(type_, self._round(np.asarray(arg)), self.grid)
        result = f"sssgen_r{number}"
        statements.append(self._declare(call.result, result, f"{call.function}({', '.join(args)})"))
        columns = call.result.columns if isinstance(call.result, Matrix) else 1
        for column in range(columns):
            part = f"{result}[{column}]" if isinstance(call.result, Matrix) else result
            statements.append(
                f"if (sssgen_slot == {self.slots + column}) {{ sssgen_value = {self._words(call.result, part)}; }}"
            )
        condition = f"if (sssgen_slot >= {self.slots} && sssgen_slot < {self.slots + columns}) {{"
        self.body += [condition, *statements, "}"]
        self.places.append((self.slots, columns))
        self.slots += columns

    def _round(self, arg: Array) -> Array:
        """An argument, rounded to the target's floating-point format."""
        if not self.half or arg.dtype.kind != "f":
            return arg
        with np.errstate(over="ignore"):
            return arg.astype(np.float16)

    def _declare(self, type_: Type, name: str, value: str) -> str:
        return self.language.declare.format(type=self.target.types[spell(type_)], name=name, value=value)

    def _read(self, type_: Type, row: int) -> str:
        if isinstance(type_, Matrix):
            columns = [self._read(Vector("float", type_.rows), row + self.grid.rows * i) for i in range(type_.columns)]
            return f"{self.target.types[spell(type_)]}({', '.join(columns)})"
        size = components(type_)
        fetched = f"{self.language.fetch.format(row=row)}.{'xyzw'[:size]}"
        unsigned = self.target.types["uint" if size == 1 else f"uvec{size}"]
        pattern = self.language.bits[kind_of(type_)]
        if pattern.startswith("notEqual") and size == 1:
            pattern = "({0} != {zero})"
        zero = f"{unsigned}(0u)" if size > 1 else "0u"
        types = {"type": self.target.types[spell(type_)], "single": self.single[spell(type_)]}
        return pattern.format(fetched, **types, zero=zero)

    def _words(self, type_: Type, value: str) -> str:
        """Four 32-bit components that start with those of the value."""
        size = column_size(type_)
        unsigned = self.target.types["uint" if size == 1 else f"uvec{size}"]
        single = self.single[spell(vector_of(kind_of(type_), size))]
        bits = self.language.words[kind_of(type_)].format(value, unsigned=unsigned, single=single)
        return f"{self.target.types['uvec4']}({', '.join([bits, *['0u'] * (4 - size)])})"


def _family(target: Target) -> str:
    """The language of the target's dialect: glsl, hlsl, wgsl."""
    return target.dialect.partition("-")[0]


def _declaration(target: Target, name: str, bound: Bound) -> str:
    assert isinstance(bound.data, Texture)
    pattern = _TEXTURES.get(target.dialect) or _TEXTURES[_family(target)]
    data = bound.data
    type_ = target.types[spell(Sampler(data.dim, data.kind, data.layers, data.compare))].removeprefix("highp ")
    sampler_type = target.types.get("samplerShadow" if data.compare else "sampler", "SamplerState")
    places = {"first": bound.place.binding, "second": bound.place.sampler}
    return pattern.format(name=name, sampler=f"{name}_sampler", type=type_, sampler_type=sampler_type, **places)


def rows_of(type_: Type, value: Array, grid: Grid) -> list[Array]:
    """An argument as rows of four 32-bit components for each lane."""
    if isinstance(type_, Matrix):
        return [row for column in value for row in rows_of(Vector("float", type_.rows), column, grid)]
    words = np.zeros((grid.rows * grid.width, 4), np.uint32)
    with np.errstate(over="ignore", invalid="ignore"):
        converted = value.reshape(components(type_), -1).astype(DTYPES[kind_of(type_)])
    words[: converted.shape[-1] if converted.shape[-1] > 1 else None, : len(converted)] = converted.T.view(np.uint32)
    return [words]


def _result(type_: Type, words: Array, lanes: int) -> Array:
    """The value in the layout of `numpy_values`."""
    size = column_size(type_)
    values: Array = np.ascontiguousarray(words[:, :lanes, :size]).view(DTYPES[kind_of(type_)])
    if kind_of(type_) == "bool":
        values = values != 0
    values = np.moveaxis(values, 1, 2)
    return values if isinstance(type_, Matrix) else values[0, 0] if isinstance(type_, Scalar) else values[0]
