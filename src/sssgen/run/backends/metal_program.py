"""The C++ around emitted Metal: it calls a function for each pixel of a grid, with arguments from arrays.

An array has its components one after the other, each with all lanes. Textures and samplers are set before the calls.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from sssgen.ir.types import Matrix, Type, components, kind_of, spell
from sssgen.run.backends.backend_interface import ATTRIBUTES, VERTEX_SIZE, Call
from sssgen.run.compilers.metal_compiler import with_swizzles
from sssgen.targets.descriptor import Target

_DERIVATIVES = re.compile(r"\b(?:dfdx|dfdy|fwidth)\(|\.sample\(")
_STORED = {"float": "float", "int": "int", "uint": "uint", "bool": "uint"}


def program(target: Target, text: str, calls: Sequence[Call], textures: Sequence[str]) -> str:
    """C++ that defines `sssgen_texture` and, for each call, `sssgen_run_N(args, result, width, rows)`."""
    lines = [
        *declarations(len(textures)),
        "static const void* const* sssgen_args;",
        "static void* sssgen_result;",
        "static long sssgen_width, sssgen_lanes;",
    ]
    for number, call in enumerate(calls):
        lines += _call(target, number, call, textures, _needs_quads(text))
    return "\n".join([with_swizzles(text, included=True), *lines, ""])


def shading(text: str, textures: Sequence[str]) -> str:
    """C++ for a whole shader: `sssgen_texture`, and `sssgen_shade(blocks, points, result, width, rows, front)`.

    Each pixel has a vertex of its own, whose attributes are `VERTEX_SIZE` numbers of `points`; without `points` one
    triangle covers the picture. The blocks are those of the shell by their names, in the order of `BLOCKS`.
    """
    points = "VertexInput" in text
    vertex_args = ", ".join([_argument(name, kind, textures) for kind, name, _ in parameters(text, "vertex")[1:]])
    fragment_args = ", ".join([_argument(name, kind, textures) for kind, name, _ in parameters(text, "fragment")[1:]])
    listed = f", {vertex_args}" if vertex_args else ""
    lines = declarations(len(textures))
    lines += [
        "static const char* const* sssgen_blocks;",
        "static const float* sssgen_points;",
        "static float* sssgen_result;",
        "static long sssgen_width, sssgen_rows;",
        "static bool sssgen_front;",
        "static void sssgen_pixel(long x, long y) {",
        "    if (x >= sssgen_width) x = sssgen_width - 1;",
        "    long pixel = y * sssgen_width + x;",
    ]
    if points:
        lines += [f"    const float* at = sssgen_points + {VERTEX_SIZE} * pixel;", "    VertexInput given;"]
        for kind, name in _members(text, "VertexInput"):
            first, _ = ATTRIBUTES[name]
            numbers = ", ".join([f"at[{first + i}]" for i in range(int(kind[-1]))])
            lines.append(f"    given.{name} = {kind}({numbers});")
        lines.append(f"    Varyings varyings = vertex_main(given{listed});")
    else:
        lines += [
            "    Varyings varyings, corners[3];",
            f"    for (uint i = 0; i < 3; i++) corners[i] = vertex_main(i{listed});",
            "    float b = (x + 0.5f) / sssgen_width * 0.5f, c = (sssgen_rows - y - 0.5f) / sssgen_rows * 0.5f;",
            *[f"    varyings.{at} = corners[0].{at} * (1.0f - b - c) + corners[1].{at} * b + corners[2].{at} * c;"
              for _, at in _members(text, "Varyings")],
        ]  # fmt: skip
    lines += [
        f"    float4 color = fragment_main(varyings{f', {fragment_args}' if fragment_args else ''});",
        "    bool drawn = !quad_discarded[quad_lane] && varyings.clip_position.w > 0.0f;  // the rest is clipped",
        "    for (int i = 0; i < 4; i++) sssgen_result[4 * pixel + i] = drawn ? color[i] : 0.0f;",
        "}",
        'extern "C" void sssgen_shade(',
        "    const char* const* blocks, const float* points, float* result, long width, long rows, int front) {",
        "    sssgen_blocks = blocks, sssgen_points = points, sssgen_result = result;",
        "    sssgen_width = width, sssgen_rows = rows, sssgen_front = front;",
        f"    run_quads(sssgen_pixel, width, rows, {_needs_quads(text)});",
        "}",
    ]
    return "\n".join([with_swizzles(text), *lines, ""])


BLOCKS = ("Camera", "Lights", "Object", "Material")


def parameters(text: str, stage: str) -> list[tuple[str, str, str]]:
    """(type, name, attribute) of the parameters of a stage's entry."""
    entry = re.search(rf"^{stage} \w+ \w+\((.*?)\n?\) {{", text, re.MULTILINE | re.DOTALL)
    listed = re.findall(r"^\s*(.*?) (\w+)(?: \[\[(.*?)\]\])?,?$", entry[1] if entry else "", re.MULTILINE)
    return [(kind, name, attribute) for kind, name, attribute in listed]


def _members(text: str, struct: str) -> list[tuple[str, str]]:
    """(type, name) of a struct's members."""
    body = text.partition(f"struct {struct} {{\n")[2].partition("\n}")[0]
    return re.findall(r"^    (\w+) (\w+)", body, re.MULTILINE)


def _argument(name: str, kind: str, textures: Sequence[str]) -> str:
    """The value of an entry's parameter."""
    if kind.endswith("&"):
        block = kind.removeprefix("constant ").removesuffix("&")
        return f"*reinterpret_cast<const {block}*>(sssgen_blocks[{BLOCKS.index(block)}])"
    if kind == "bool":
        return "sssgen_front"
    if kind == "sampler":
        return f"sssgen_samplers[{textures.index(name.removesuffix('_sampler'))}]"
    return f"{kind}{{{{&sssgen_images[{textures.index(name)}]}}}}"


def _needs_quads(text: str) -> str:
    """Whether the pixels of a quad must run together."""
    return "true" if _DERIVATIVES.search(text) else "false"


def declarations(textures: int) -> list[str]:
    """What holds that many textures, and the function that sets them."""
    return [
        "#line 1 \"calls\"",
        "#include <metal_quads>",
        f"static metal_standin::image sssgen_images[{textures + 1}];",
        f"static metal_standin::sampler sssgen_samplers[{textures + 1}];",
        'extern "C" void sssgen_texture(int i, const float* t, const int* sizes, int levels, int linear, int wrap) {',
        "    sssgen_images[i] = metal_standin::image{t, sizes, levels};",
        "    sssgen_samplers[i] = metal_standin::sampler{linear, wrap};",
        "}",
    ]  # fmt: skip


def _call(target: Target, number: int, call: Call, textures: Sequence[str], together: str) -> list[str]:
    args = []
    for index, (type_, arg) in enumerate(zip(call.params, call.args, strict=True)):
        if isinstance(arg, str):
            at = textures.index(arg)
            args.append(f"{target.types[spell(type_)]}{{{{&sssgen_images[{at}]}}}}, sssgen_samplers[{at}]")
        else:
            args.append(_read(target, type_, index))
    result = target.types[spell(call.result)]
    stored = _STORED[kind_of(call.result)]
    return [
        f"static void sssgen_lane_{number}(long x, long y) {{",
        "    long lane = x < sssgen_width ? y * sssgen_width + x : sssgen_lanes;  // one more lane, beside the picture",
        f"    {result} value = {call.function}({', '.join(args)});",
        "    if (x >= sssgen_width) return;",
        f"    {stored}* out = static_cast<{stored}*>(sssgen_result) + lane;",
        *[f"    out[{i} * sssgen_lanes] = quad_discarded[quad_lane] ? {stored}(0) : {stored}({part});"
          for i, part in enumerate(_parts(call.result))],
        "}",
        f'extern "C" void sssgen_run_{number}(const void* const* args, void* result, long width, long rows) {{',
        "    sssgen_args = args, sssgen_result = result, sssgen_width = width, sssgen_lanes = width * rows;",
        f"    run_quads(sssgen_lane_{number}, width, rows, {together});",
        "}",
    ]  # fmt: skip


def _read(target: Target, type_: Type, index: int) -> str:
    """An argument of the lane; each component has one more number, for the lane beside the picture."""
    stored = f"static_cast<const {_STORED[kind_of(type_)]}*>(sssgen_args[{index}])"
    count = components(type_)
    texts = [f"{stored}[{i} * (sssgen_lanes + 1) + lane]" for i in range(count)]
    if kind_of(type_) == "bool":
        texts = [f"{text} != 0" for text in texts]
    return f"{target.types[spell(type_)]}({', '.join(texts)})"


def _parts(type_: Type) -> list[str]:
    """The numbers of a result."""
    if isinstance(type_, Matrix):
        return [f"value[{column}][{row}]" for column in range(type_.columns) for row in range(type_.rows)]
    count = components(type_)
    return [f"value[{i}]" for i in range(count)] if count > 1 else ["value"]
