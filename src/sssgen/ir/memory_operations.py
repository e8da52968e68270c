"""Operations on memory that invocations share: atomics, barriers, the length of a buffer, texels of images.

They are statements (`nodes.MemoryOperation`), as they write memory or wait; the table of builtins has functions of
values alone. A text has `{0}` for the place, `{1}` and `{2}` for the values, and `{result}` for the variable that takes
the old value. Where it may be left out, `{into}` is `RESULT = `, `{also}` is `, RESULT` and `{first}` is `.x`, or
nothing. `{free}` is a name that the function does not have, `{type}` the type of the result, or of the last value.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

KINDS = ("int", "uint")
"""What atomics work on."""


_METAL_FLAGS = {"shared": "mem_flags::mem_threadgroup", "buffer": "mem_flags::mem_device"}


class MemoryRow(NamedTuple):
    """One operation."""

    name: str
    doc: str
    values: int = 0
    """How many values follow the place."""
    has_place: bool = True
    returns: bool = True
    """Whether it has a result: of an atomic the old value."""
    needs_result: bool = False
    """Whether some language has it only with a result."""
    uniform_flow: bool = False
    """All invocations of a workgroup must reach it: control flow must be uniform."""
    image: bool = False
    """Whether the place is an image."""
    reads_only: bool = False
    """Whether it leaves the place as it is."""
    orders: tuple[str, ...] = ()
    """The memory that it orders: shared, buffer. Of a barrier without control it orders that alone."""
    texts: Mapping[str, str] = {}
    """Language → its text. WGSL and Metal have no barrier of memory alone: there the invocations wait, too. That of an
    image may depend on it: `wgsl-2DArray`, and `hlsl-one` for a format of one number."""

    @property
    def is_atomic(self) -> bool:
        """Whether it works on a number in shared memory or in a storage buffer."""
        return self.values > 0 and not self.image

    @property
    def loads_texel(self) -> bool:
        """Whether its result is a texel of an image."""
        return self.image and self.returns and self.values > 0

    @property
    def is_image_atomic(self) -> bool:
        """Whether it both loads and stores a texel."""
        return self.loads_texel and not self.reads_only


def _atomic(
    name: str, doc: str, hlsl: str, metal_name: str, values: int = 1, needs_result: bool = False, **other: str
) -> MemoryRow:
    args = ", ".join([f"{{{index}}}" for index in range(1, values + 1)])
    texts = {
        "glsl": f"{{into}}{name}({{0}}, {args})",
        "wgsl": f"{{into}}{name}(&{{0}}, {args})",
        "hlsl": f"{hlsl}({{0}}, {args}{{also}})",
        "metal": f"{{into}}{metal_name}(&{{0}}, {args}, memory_order_relaxed)",
    }
    return MemoryRow(name, doc, values, needs_result=needs_result, texts={**texts, **other})


_METAL_PLACES = {"metal": "uint2({1})", "metal-3D": "uint3({1})", "metal-2DArray": "uint2({1}.xy), uint({1}.z)"}


def _image_atomic(name: str, hlsl: str, metal_name: str, values: int = 1) -> MemoryRow:
    args = ", ".join([f"{{{index}}}" for index in range(1, values + 2)])
    new = ", ".join([f"{{{index}}}" for index in range(2, values + 2)])
    texts = {"glsl": f"{{into}}image{name}({{0}}, {args})", "hlsl": f"{hlsl}({{0}}[{{1}}], {new}{{also}})"}
    for key, place in _METAL_PLACES.items():  # Metal 3.1; all four numbers of a texel, of which the first counts
        texts[key] = f"{{into}}{{0}}.{metal_name}({place}, {{type}}4({{2}})){{first}}"
        if values > 1:
            texts[key] = (
                f"{{type}}4 {{free}} = {{type}}4({{2}});\n"
                f"while (!{{0}}.{metal_name}({place}, &{{free}}, {{type}}4({{3}})) && {{free}}.x == {{2}}) {{{{\n}}}}\n"
                "{result} = {free}.x"
            )
    doc = f"As {name[0].lower()}{name[1:]}, of a texel; gives the old value."
    needs_result = name in ("AtomicExchange", "AtomicCompSwap")
    return MemoryRow(f"image{name}", doc, values + 1, image=True, needs_result=needs_result, texts=texts)


def _barrier(name: str, doc: str, hlsl: str, wgsl: str, orders: tuple[str, ...], uniform: bool = False) -> MemoryRow:
    flags = " | ".join([_METAL_FLAGS[order] for order in orders])
    texts = {"glsl": f"{name}()", "hlsl": hlsl, "wgsl": wgsl, "metal": f"threadgroup_barrier({flags})"}
    return MemoryRow(name, doc, has_place=False, returns=False, uniform_flow=uniform, orders=orders, texts=texts)


ROWS = (
    _atomic("atomicAdd", "Adds, and gives the old value.", "InterlockedAdd", "atomic_fetch_add_explicit"),
    _atomic("atomicMin", "The smaller value; gives the old one.", "InterlockedMin", "atomic_fetch_min_explicit"),
    _atomic("atomicMax", "The larger value; gives the old one.", "InterlockedMax", "atomic_fetch_max_explicit"),
    _atomic("atomicAnd", "Bitwise and; gives the old value.", "InterlockedAnd", "atomic_fetch_and_explicit"),
    _atomic("atomicOr", "Bitwise or; gives the old value.", "InterlockedOr", "atomic_fetch_or_explicit"),
    _atomic("atomicXor", "Bitwise exclusive or; gives the old value.", "InterlockedXor", "atomic_fetch_xor_explicit"),
    _atomic(
        "atomicExchange", "Stores; gives the old value.", "InterlockedExchange", "atomic_exchange_explicit",
        needs_result=True,
    ),
    _atomic(
        "atomicCompSwap", "Stores the second value where the first is there; gives the old value.",
        "InterlockedCompareExchange", "", 2, True,
        wgsl="loop {{\n    let {free} = atomicCompareExchangeWeak(&{0}, {1}, {2});\n"
        "    if ({free}.exchanged || {free}.old_value != {1}) {{\n"
        "        {result} = {free}.old_value;\n        break;\n    }}\n}}",
        metal="{result} = {1};\n"
        "while (!atomic_compare_exchange_weak_explicit(&{0}, &{result}, {2}, memory_order_relaxed, "
        "memory_order_relaxed) && {result} == {1}) {{\n}}",
    ),
    _barrier(
        "barrier", "All invocations of the workgroup wait for each other; orders shared memory.",
        "GroupMemoryBarrierWithGroupSync()", "workgroupBarrier()", ("shared",), True,
    ),
    _barrier("memoryBarrierShared", "Orders shared memory.", "GroupMemoryBarrier()", "workgroupBarrier()", ("shared",)),
    _barrier(
        "memoryBarrierBuffer", "Orders storage buffers.", "DeviceMemoryBarrier()", "storageBarrier()", ("buffer",),
    ),
    _barrier(
        "memoryBarrierImage", "Orders images.", "DeviceMemoryBarrier()", "storageBarrier()",
        ("buffer",),
    ),
    _barrier("memoryBarrier", "Orders all memory.", "AllMemoryBarrier()", "storageBarrier()", ("shared", "buffer")),
    _barrier(
        "groupMemoryBarrier", "Orders all memory for the workgroup.", "AllMemoryBarrier()", "storageBarrier()",
        ("shared", "buffer"),
    ),
    MemoryRow(
        "imageLoad", "The texel of an image.", 1, image=True, reads_only=True, needs_result=True,
        texts={
            "glsl": "{result} = imageLoad({0}, {1})",
            "wgsl": "{result} = textureLoad({0}, {1})",
            "wgsl-2DArray": "{result} = textureLoad({0}, {1}.xy, {1}.z)",
            "hlsl": "{result} = {0}[{1}]",
            "hlsl-one": "{result} = {type}({0}[{1}], 0, 0, 1)",
            "metal": "{result} = {0}.read(uint2({1}))",
            "metal-3D": "{result} = {0}.read(uint3({1}))",
            "metal-2DArray": "{result} = {0}.read(uint2({1}.xy), uint({1}.z))",
        },
    ),
    MemoryRow(
        "imageStore", "Sets a texel of an image.", 2, returns=False, image=True,
        texts={
            "glsl": "imageStore({0}, {1}, {2})",
            "wgsl": "textureStore({0}, {1}, {2})",
            "wgsl-2DArray": "textureStore({0}, {1}.xy, {1}.z, {2})",
            "hlsl": "{0}[{1}] = {2}",
            "hlsl-one": "{0}[{1}] = ({2}).x",
            "metal": "{0}.write({2}, uint2({1}))",
            "metal-3D": "{0}.write({2}, uint3({1}))",
            "metal-2DArray": "{0}.write({2}, uint2({1}.xy), uint({1}.z))",
        },
    ),
    MemoryRow(
        "imageSize", "The size of an image, and its layers.", image=True, reads_only=True, needs_result=True,
        texts={
            "glsl": "{result} = imageSize({0})",
            "wgsl": "{result} = {type}(textureDimensions({0}))",
            "wgsl-2DArray": "{result} = {type}(vec2i(textureDimensions({0})), i32(textureNumLayers({0})))",
            "hlsl": "uint2 {free};\n{0}.GetDimensions({free}.x, {free}.y);\n{result} = {type}({free})",
            "hlsl-3D": "uint3 {free};\n{0}.GetDimensions({free}.x, {free}.y, {free}.z);\n{result} = {type}({free})",
            "hlsl-2DArray": "uint3 {free};\n{0}.GetDimensions({free}.x, {free}.y, {free}.z);\n"
            "{result} = {type}({free})",
            "metal": "{result} = {type}({0}.get_width(), {0}.get_height())",
            "metal-3D": "{result} = {type}({0}.get_width(), {0}.get_height(), {0}.get_depth())",
            "metal-2DArray": "{result} = {type}({0}.get_width(), {0}.get_height(), {0}.get_array_size())",
        },
    ),
    _image_atomic("AtomicAdd", "InterlockedAdd", "atomic_fetch_add"),
    _image_atomic("AtomicMin", "InterlockedMin", "atomic_fetch_min"),
    _image_atomic("AtomicMax", "InterlockedMax", "atomic_fetch_max"),
    _image_atomic("AtomicAnd", "InterlockedAnd", "atomic_fetch_and"),
    _image_atomic("AtomicOr", "InterlockedOr", "atomic_fetch_or"),
    _image_atomic("AtomicXor", "InterlockedXor", "atomic_fetch_xor"),
    _image_atomic("AtomicExchange", "InterlockedExchange", "atomic_exchange"),
    _image_atomic("AtomicCompSwap", "InterlockedCompareExchange", "atomic_compare_exchange_weak", 2),
    MemoryRow(
        "arrayLength", "How many elements a buffer's last member has.", reads_only=True,
        texts={"glsl": "{into}{0}.length()", "wgsl": "{into}i32(arrayLength(&{0}))"},
    ),
)  # fmt: skip

MEMORY: dict[str, MemoryRow] = {row.name: row for row in ROWS}
"""The rows by their names."""
