"""The numbers in a glTF file: buffers, views and accessors, also sparse and normalised ones.

trimesh, with which `scene.mesh_files` reads meshes, has no second set of texture coordinates and does not keep the
numbers of materials; its errors do not name an element.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from sssgen.interchange.gltf_container import Container
from sssgen.interchange.gltf_json import JsonElement
from sssgen.scene.arrays import Array
from sssgen.support.diagnostics import SssgenError

_TYPES = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
"""Component type → NumPy's name."""
_COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
MOST_NUMBERS = 100_000_000
"""Of an accessor."""


class Buffers:
    """The buffers of a file, read when they are needed."""

    def __init__(self, container: Container) -> None:
        self.container, self.root = container, container.root
        self._contents: dict[str, bytes] = {}

    @cached_property
    def accessors(self) -> list[JsonElement]:
        """All accessors."""
        return self.root.objects("accessors")

    @cached_property
    def views(self) -> list[JsonElement]:
        """All buffer views."""
        return self.root.objects("bufferViews")

    def view(self, element: JsonElement) -> bytes:
        """The bytes of a buffer view. Raises SssgenError where it leaves its buffer."""
        buffer = element.reference("buffer", self.root.objects("buffers"), "buffer")
        content = self._content(buffer)
        start, length = element.whole("byteOffset", 0, 0, 2**40), element.whole("byteLength", None, 0, 2**40)
        if start + length > len(content):
            raise element.fault(f"it ends at byte {start + length}, and its buffer {buffer.path} has {len(content)}")
        return content[start : start + length]

    def _content(self, buffer: JsonElement) -> bytes:
        if buffer.path not in self._contents:
            if buffer.has("uri"):
                content = self.container.resource(buffer)
            elif self.container.binary is not None and buffer.path == "/buffers/0":
                content = self.container.binary
            else:
                raise buffer.fault("'uri' is missing, and there is no binary chunk", "export the file again")
            length = buffer.whole("byteLength", len(content), 0, 2**40)
            if length > len(content):
                raise buffer.fault(f"it has {len(content)} of {length} bytes", "copy or export the file again")
            self._contents[buffer.path] = content
        return self._contents[buffer.path]

    def numbers(self, accessor: JsonElement, components: int) -> Array:
        """The values of an accessor, (count, components); normalised integers as fractions. Raises SssgenError."""
        kind = accessor.text("type")
        if kind not in _COMPONENTS:
            raise accessor.fault(f"unknown type '{kind[:20]}'")
        if _COMPONENTS[kind] != components:
            raise accessor.fault(f"its values have {_COMPONENTS[kind]} components, not {components}")
        dtype, count = self._dtype(accessor), accessor.whole("count", None, 1)
        if count * components > MOST_NUMBERS:
            raise accessor.fault(f"it has {count * components} numbers; at most {MOST_NUMBERS} are read")
        stored = np.zeros((count, components), dtype)
        if accessor.has("bufferView"):
            stored = self._view_array(accessor, accessor, dtype, count, components)
        if (sparse := accessor.child("sparse")) is not None:
            stored = stored.copy()
            self._replace(stored, sparse, dtype, components)
        values: Array = stored.astype(np.float64)
        if accessor.flag("normalized") and dtype.kind in "iu":
            values = np.maximum(values / float(np.iinfo(dtype).max), -1.0)
        if not np.isfinite(values).all():
            raise accessor.fault("it has values that are not finite numbers", "export the file again")
        return values

    def _dtype(self, element: JsonElement) -> np.dtype[Any]:
        number = element.whole("componentType")
        if number not in _TYPES:
            raise element.fault(f"unknown component type {number}")
        return np.dtype(_TYPES[number])

    def _view_array(
        self, element: JsonElement, place: JsonElement, dtype: np.dtype[Any], count: int, components: int
    ) -> np.ndarray[tuple[int, int], np.dtype[Any]]:
        view = element.reference("bufferView", self.views, "buffer view")
        data = self.view(view)
        if not len(data):
            raise view.fault("it is empty")
        size = dtype.itemsize * components
        stride = view.whole("byteStride", 0, 0, 252) or size
        start = element.whole("byteOffset", 0, 0, 2**40)
        if stride < size or start + stride * (count - 1) + size > len(data):
            raise place.fault(f"it needs {start + stride * (count - 1) + size} bytes, and {view.path} has {len(data)}")
        return np.ndarray((count, components), dtype, data, start, (stride, dtype.itemsize))

    def _replace(
        self, stored: np.ndarray[tuple[int, int], np.dtype[Any]], sparse: JsonElement,
        dtype: np.dtype[Any], components: int,
    ) -> None:  # fmt: skip
        count = sparse.whole("count", None, 1, len(stored))
        indices, values = sparse.child("indices"), sparse.child("values")
        if indices is None or values is None:
            raise sparse.fault("'indices' or 'values' is missing")
        places = self._view_array(indices, sparse, self._dtype(indices), count, 1)[:, 0].astype(np.int64)
        if places.max() >= len(stored) or places.min() < 0:
            raise indices.fault("an index is beyond the accessor's values")
        stored[places] = self._view_array(values, sparse, dtype, count, components)


def read_attribute(element: JsonElement, key: str, buffers: Buffers, components: int) -> Array | None:
    """The values of an optional attribute, or None without it. Raises SssgenError."""
    if not element.has(key):
        return None
    try:
        return buffers.numbers(element.reference(key, buffers.accessors, "accessor"), components)
    except SssgenError:
        if components != 4:
            raise
        color = buffers.numbers(element.reference(key, buffers.accessors, "accessor"), 3)
        with_alpha: Array = np.c_[color, np.ones(len(color))]
        return with_alpha
