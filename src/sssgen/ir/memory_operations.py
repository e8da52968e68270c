"""Operations on memory that invocations of a compute shader share: atomics, barriers, the length of a buffer.

They are statements (`nodes.MemoryOperation`), as they write memory or wait; the table of builtins has functions of
values alone. A text has `{0}` for the place, `{1}` and `{2}` for the values, and `{result}` for the variable that takes
the old value. Where it may be left out, `{into}` is `RESULT = ` and `{also}` is `, RESULT`, or nothing. `{free}` is a
name that the function does not have.
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
    orders: tuple[str, ...] = ()
    """The memory that it orders: shared, buffer. Of a barrier without control it orders that alone."""
    texts: Mapping[str, str] = {}
    """Language → its text. WGSL and Metal have no barrier of memory alone: there the invocations wait, too."""


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
        "memoryBarrierImage", "Orders images, which are not translated.", "DeviceMemoryBarrier()", "storageBarrier()",
        ("buffer",),
    ),
    _barrier("memoryBarrier", "Orders all memory.", "AllMemoryBarrier()", "storageBarrier()", ("shared", "buffer")),
    _barrier(
        "groupMemoryBarrier", "Orders all memory for the workgroup.", "AllMemoryBarrier()", "storageBarrier()",
        ("shared", "buffer"),
    ),
    MemoryRow(
        "arrayLength", "How many elements a buffer's last member has.",
        texts={"glsl": "{into}{0}.length()", "wgsl": "{into}i32(arrayLength(&{0}))"},
    ),
)  # fmt: skip

MEMORY: dict[str, MemoryRow] = {row.name: row for row in ROWS}
"""The rows by their names."""
