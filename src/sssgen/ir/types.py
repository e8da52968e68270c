"""The types of the IR: GLSL's, and nothing a target adds.

Types are immutable values and compare by content. Matrices are column-major (`M * v`), as in GLSL.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias


class Scalar(NamedTuple):
    """One number or truth value; `kind` is float, int, uint or bool."""

    kind: str


class Vector(NamedTuple):
    """2 to 4 scalars of one kind."""

    kind: str
    size: int


class Matrix(NamedTuple):
    """`columns` columns of `rows` floats: GLSL's mat2x3 has 2 columns of 3."""

    columns: int
    rows: int
    kind: str = "float"


class Array(NamedTuple):
    """A fixed number of elements of one type; 0 at the end of a storage buffer, whose size the program sets."""

    element: Type
    length: int


class Field(NamedTuple):
    """A member of a struct. `quantity` is the quantity type it was declared with, or ''."""

    name: str
    type: Type
    quantity: str = ""


class Struct(NamedTuple):
    """A named record."""

    name: str
    fields: tuple[Field, ...]


class Sampler(NamedTuple):
    """A texture together with its sampler.

    `dim` is 2D, 3D, Cube or 2DMS (several samples to a texel), `kind` that of its texels: float, int or uint; `array`
    says that it has layers, `shadow` that a read compares. `line`: the source has one dimension; after the check it is
    a texture of two with one row.
    """

    dim: str
    kind: str = "float"
    array: bool = False
    shadow: bool = False
    line: bool = False


class Image(NamedTuple):
    """A texture whose texels a shader loads and stores by their places, without a sampler."""

    dim: str
    """2D or 3D"""
    kind: str = "float"
    array: bool = False


class Void(NamedTuple):
    """The result of a function that returns nothing."""


Type: TypeAlias = Scalar | Vector | Matrix | Array | Struct | Sampler | Image | Void

FLOAT, INT, UINT, BOOL, VOID = Scalar("float"), Scalar("int"), Scalar("uint"), Scalar("bool"), Void()

_VECTOR_NAMES = {"float": "vec", "int": "ivec", "uint": "uvec", "bool": "bvec"}

BY_NAME: dict[str, Type] = {"void": VOID, "float": FLOAT, "int": INT, "uint": UINT, "bool": BOOL}
for _kind, _prefix in _VECTOR_NAMES.items():
    for _size in (2, 3, 4):
        BY_NAME[f"{_prefix}{_size}"] = Vector(_kind, _size)
for _columns in (2, 3, 4):
    BY_NAME[f"mat{_columns}"] = Matrix(_columns, _columns)
    for _size in (2, 3, 4):
        BY_NAME[f"mat{_columns}x{_size}"] = Matrix(_columns, _size)
for _dim in ("2D", "3D", "Cube"):
    BY_NAME[f"sampler{_dim}"] = Sampler(_dim)
for _dim in ("2D", "Cube"):
    BY_NAME[f"sampler{_dim}Array"] = Sampler(_dim, array=True)
    BY_NAME[f"sampler{_dim}Shadow"] = Sampler(_dim, shadow=True)
BY_NAME["sampler2DArrayShadow"] = Sampler("2D", array=True, shadow=True)
BY_NAME["sampler2DMS"] = Sampler("2DMS")
for _kind, _prefix in (("int", "i"), ("uint", "u")):
    for _dim in ("2D", "3D", "Cube", "2DMS"):
        BY_NAME[f"{_prefix}sampler{_dim}"] = Sampler(_dim, _kind)
    BY_NAME[f"{_prefix}sampler2DArray"] = Sampler("2D", _kind, array=True)

IMAGES: dict[str, Image] = {
    f"{prefix}image{dim}{'Array' if array else ''}": Image(dim, kind, array)
    for prefix, kind in (("", "float"), ("i", "int"), ("u", "uint"))
    for dim, array in (("2D", False), ("3D", False), ("2D", True))
}
"""The names of images, which are variables of whole shaders alone."""

LINES: dict[str, Sampler] = {
    f"{prefix}sampler1D{'Array' if array else ''}{'Shadow' if shadow else ''}": Sampler("2D", kind, array, shadow, True)
    for prefix, kind in (("", "float"), ("i", "int"), ("u", "uint"))
    for array in (False, True)
    for shadow in ((False, True) if kind == "float" else (False,))
}
"""The names of textures of one dimension, which plain GLSL alone has."""

_NAMES: dict[Type, str] = {}
for _name, _type in (*BY_NAME.items(), *IMAGES.items(), *LINES.items()):
    _NAMES.setdefault(_type, _name)

VEC2, VEC3, VEC4 = Vector("float", 2), Vector("float", 3), Vector("float", 4)


def spell(type: Type) -> str:
    """The type as it is written in the language, for messages and the IR's text form."""
    name = _NAMES.get(type)
    if name is not None:
        return name
    if isinstance(type, Array):
        innermost, lengths = unnested(type)
        return spell(innermost) + "".join([f"[{length or ''}]" for length in lengths])
    if isinstance(type, Struct):
        return type.name
    raise TypeError(f"not an IR type: {type!r}")


def unnested(type: Type) -> tuple[Type, tuple[int, ...]]:
    """The innermost element of an array of arrays, and the lengths, the outermost first; no lengths for other types."""
    lengths: list[int] = []
    while isinstance(type, Array):
        lengths.append(type.length)
        type = type.element
    return type, tuple(lengths)


def with_article(noun: str) -> str:
    """A type's name (or another noun) with its article, for messages: `a float`, `an ivec2`, `a uint`."""
    return f"{'an' if noun[0] in 'aeioAEIO' else 'a'} {noun}"


def vector_of(kind: str, size: int) -> Type:
    """The scalar (size 1) or vector type with `size` components of `kind`."""
    return Scalar(kind) if size == 1 else Vector(kind, size)


def components(type: Type) -> int:
    """How many scalars a value of this type holds (0 for what holds none)."""
    if isinstance(type, Scalar):
        return 1
    if isinstance(type, Vector):
        return type.size
    if isinstance(type, Matrix):
        return type.columns * type.rows
    if isinstance(type, Array):
        return type.length * components(type.element)
    if isinstance(type, Struct):
        return sum(components(field.type) for field in type.fields)
    return 0


def uniform_locations(type: Type) -> int:
    """How many locations a uniform of this type takes: one for each member and element that is no struct or array."""
    if isinstance(type, Array):
        return type.length * uniform_locations(type.element)
    return sum(uniform_locations(field.type) for field in type.fields) if isinstance(type, Struct) else 1


def passed_locations(type: Type) -> int:
    """How many locations an input or output of this type takes: one for each scalar, vector and column of a matrix."""
    if isinstance(type, Array):
        return type.length * passed_locations(type.element)
    if isinstance(type, Struct):
        return sum(passed_locations(field.type) for field in type.fields)
    return type.columns if isinstance(type, Matrix) else 1


def component_kinds(type: Type) -> list[str]:
    """The kind of each of these scalars, in their order."""
    if isinstance(type, Array):
        return component_kinds(type.element) * type.length
    if isinstance(type, Struct):
        return [kind for field in type.fields for kind in component_kinds(field.type)]
    return [kind_of(type)] * components(type)


def column_size(type: Type) -> int:
    """How many components a column of a matrix has; of a scalar or vector: how many itself has."""
    return type.rows if isinstance(type, Matrix) else components(type)


_OF_SCALARS = (Scalar, Vector, Matrix)


def kind_of(type: Type) -> str:
    """The scalar kind inside a scalar, vector or matrix, else ''."""
    return type.kind if isinstance(type, _OF_SCALARS) else ""


def is_numeric(type: Type) -> bool:
    """Whether arithmetic is defined on the type."""
    return kind_of(type) in ("float", "int", "uint")
