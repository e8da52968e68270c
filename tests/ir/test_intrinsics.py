"""The intrinsic table: its own order, its overloads, and its test vectors on the NumPy runtime."""

from __future__ import annotations

import inspect
import keyword
import math
import re
import subprocess
import sys
import warnings
from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np
import pytest

from sssgen.ir import signatures
from sssgen.ir.intrinsics import BUILTINS, Builtin
from sssgen.ir.signatures import candidates, overload, overloads, parse, resolve, text
from sssgen.ir.types import BOOL, FLOAT, INT, UINT, VEC2, VEC3, VEC4, Matrix, Sampler, Scalar, Type, Vector, kind_of
from sssgen.targets import numpy_runtime as rt

# Chapter 8 of GLSL ES 1.00 to GLSL 4.60: what is computed by a function without out parameters.
CHAPTER_8 = set(
    """
radians degrees sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh pow exp log exp2 log2 sqrt inversesqrt
abs sign floor trunc round roundEven ceil fract mod min max clamp mix step smoothstep isnan isinf floatBitsToInt
floatBitsToUint intBitsToFloat uintBitsToFloat packSnorm2x16 unpackSnorm2x16 packUnorm2x16 unpackUnorm2x16 packHalf2x16
unpackHalf2x16 length distance dot cross normalize faceforward reflect refract matrixCompMult outerProduct transpose
determinant inverse lessThan lessThanEqual greaterThan greaterThanEqual equal notEqual any all not textureSize texture
textureLod textureGrad texelFetch dFdx dFdy fwidth fma ldexp bitCount findLSB findMSB bitfieldReverse bitfieldExtract
bitfieldInsert packSnorm4x8 unpackSnorm4x8 packUnorm4x8 unpackUnorm4x8 dFdxFine dFdyFine fwidthFine dFdxCoarse
dFdyCoarse fwidthCoarse textureOffset textureLodOffset textureGradOffset texelFetchOffset textureGather
textureGatherOffset textureQueryLevels textureQueryLod
""".split()  # noqa: SIM905 (a hundred names)
)
LANGUAGES = (
    "glsl",
    "glsl-330",
    "glsl-godot",
    "hlsl",
    "hlsl-dx9",
    "hlsl-macros",
    "hlsl-unreal",
    "wgsl",
    "wgsl-metal",
    "tsl",
)
OWN = {
    *("saturate", "fmod", "unpackNormal", "textureLayer", "textureLayerLod", "textureLayerGrad", "texelFetchLayer"),
    *("textureCompare", "textureCompareLod", "textureLayerOffset", "textureLayerLodOffset", "textureLayerGradOffset"),
    *("textureCompareOffset", "textureCompareLodOffset", "textureGatherLayer", "textureGatherLayerOffset"),
}
REFUSED = {
    ("textureSize", "hlsl-dx9"), ("texelFetch", "hlsl-dx9"),
    ("textureQueryLevels", "glsl"), ("textureQueryLevels", "hlsl-dx9"),
    ("textureQueryLod", "glsl"), ("textureQueryLod", "hlsl-dx9"),
    ("textureOffset", "hlsl-dx9"), ("textureLodOffset", "hlsl-dx9"), ("textureGradOffset", "hlsl-dx9"),
    ("textureSize", "tsl"), ("textureQueryLevels", "tsl"), ("textureQueryLod", "tsl"), ("textureCompare", "tsl"),
    ("textureCompareLod", "tsl"), ("textureCompareOffset", "tsl"), ("textureCompareLodOffset", "tsl"),
}  # fmt: skip
PLACES = ("texture", "sampler", "bare_texture", "bare_sampler", "dim", "channel", "type")
VECTORS = [(row, *vector) for row in BUILTINS.values() for vector in row.vectors]


def function(name: str) -> Any:
    return getattr(rt, name + "_" * keyword.iskeyword(name))


def types_of(value: object) -> Iterator[Type]:
    """The types that a test vector's argument may have: an integer is an int or a uint."""
    if isinstance(value, tuple):
        for inner in types_of(value[0]):
            yield Vector(inner.kind, len(value)) if isinstance(inner, Scalar) else Matrix(len(value), len(value[0]))
    elif isinstance(value, bool):
        yield BOOL
    elif isinstance(value, int):
        if value < 2**31:
            yield INT
        if value >= 0:
            yield UINT
    else:
        yield FLOAT


def overload_of(row: Builtin, arguments: tuple[object, ...]) -> tuple[tuple[Type, ...], Type]:
    for types in product(*map(types_of, arguments)):
        result = resolve(row.name, types)
        if result is not None:
            return types, result
    raise AssertionError(f"{row.name}{arguments} fits no overload")


def dtype_of(type: Type, floating: str) -> str:
    return {"float": floating, "int": "int32", "uint": "uint32", "bool": "bool"}[kind_of(type)]


def missing(row: Builtin) -> list[str]:
    """What a row lacks."""
    present = {
        "signatures": row.signatures,
        "a doc that ends with a full stop": row.doc.endswith("."),
        "range (any_number or any_numbers if nothing is known)": row.range,
        "three test vectors": len(row.vectors) >= 3 or row.reads_neighbours_or_textures,
        "a kind of cost": row.kind in ("alu", "transcendental", "fetch", "derivative"),
        "a clause for more than 4 ulp": (row.ulp <= 4.0 and not row.absolute) or row.clause,
        "a function in targets/numpy_runtime.py": hasattr(rt, row.name + "_" * keyword.iskeyword(row.name)),
        "a polyfill": row.polyfill or all(
            text or (row.name, key.partition("/")[0]) in REFUSED for key, text in row.texts.items()
        ),
    }  # fmt: skip
    return [field for field, there in present.items() if not there]


@pytest.mark.parametrize("row", BUILTINS.values(), ids=lambda row: row.name)
def test_row_is_complete(row: Builtin) -> None:
    assert not missing(row), f"{row.name} lacks {', '.join(missing(row))}"


def test_missing_fields_of_a_row_are_named() -> None:
    lacking = missing(Builtin("no_such", ("genF(genF)",), "Of no use."))
    assert [field.split()[0] for field in lacking] == ["range", "three", "a"]
    assert missing(BUILTINS["sin"]._replace(clause="", vectors=())) == [
        "three test vectors",
        "a clause for more than 4 ulp",
    ]
    assert missing(BUILTINS["mod"]._replace(polyfill="")) == ["a polyfill"]


@pytest.mark.parametrize("row", BUILTINS.values(), ids=lambda row: row.name)
def test_functions_of_a_row_accept_the_arguments_of_every_overload(row: Builtin) -> None:
    for params in signatures.overloads(row.name):
        for taken, also in ((row.range, 1), (row.inside, 1), (row.size, 1), (row.fold, 0), (row.fold_uint, 0)):
            if taken not in (None, min, max, math.log):  # these have no signature
                inspect.signature(taken).bind(*range(also + len(params)))
        for guard in row.guards:
            if guard.safe is not None and (guard.replaces != "y" or len(params) > 1):
                inspect.signature(guard.safe).bind(*range(1 + len(params)))


@pytest.mark.parametrize("row", [row for row in BUILTINS.values() if row.componentwise], ids=lambda row: row.name)
def test_a_componentwise_builtin_computes_each_component_alone(row: Builtin) -> None:
    """Arguments with their components in reverse give the result in reverse."""
    for params, (result, _) in signatures.overloads(row.name).items():
        shapes = {type(type_) for type_ in (*params, result) if not isinstance(type_, Scalar)}
        assert len(shapes) <= 1 and (not shapes or not isinstance(result, Scalar)), "of vectors it gives a vector"
    for arguments, _ in row.vectors:
        types, _ = overload_of(row, arguments)
        kinds = [dtype_of(type, "float64") for type in types]
        values = [np.asarray(value, kind)[..., None] for value, kind in zip(arguments, kinds, strict=True)]
        reverse = [value[::-1] if value.ndim > 1 else value for value in values]
        with np.errstate(all="ignore"):
            once, other = function(row.name)(*values), function(row.name)(*reverse)
        np.testing.assert_array_equal(other[::-1] if other.ndim > 1 else other, once)


@pytest.mark.parametrize("row", BUILTINS.values(), ids=lambda row: row.name)
def test_row_is_sane(row: Builtin) -> None:
    params = {",".join(parse(signature)[1:]) for signature in row.signatures}
    assert len(params) == len(row.signatures)
    for key, value in row.texts.items():
        language, _, which = key.partition("/")
        assert language in LANGUAGES
        assert not which or which in params
        for place in re.findall(r"\{(\w+)\}", value):
            assert place in PLACES or int(place) < max(p.count(",") + 1 for p in params)
    used = [argument for types in overloads(row.name) for argument in row.constants(types).values()]
    assert set(used) == set(row.constant)
    for definition in re.findall(r"^\w+ (\w+)\(", row.polyfill, re.MULTILINE):
        assert definition == row.name


@pytest.mark.parametrize("row", [row for row in BUILTINS.values() if row.kind == "fetch"], ids=lambda row: row.name)
def test_offsets_and_channels_are_constant_arguments(row: Builtin) -> None:
    for types in overloads(row.name):
        constants = {argument.what: (types[position], argument) for position, argument in row.constants(types).items()}
        numbers = types.count(INT) - ("Layer" in row.name)
        assert ("offset" in constants) == ("Offset" in row.name)
        assert ("channel" in constants) == ("Gather" in row.name and numbers == 1)
        assert len(constants) == ("offset" in constants) + ("channel" in constants)
        for what, (type_, argument) in constants.items():
            assert isinstance(type_, Vector) == (what == "offset")
            assert (argument.lowest, argument.highest) == ((-8, 7) if what == "offset" else (0, 3))


def test_the_table_is_complete() -> None:
    assert set(BUILTINS) == CHAPTER_8 | OWN


@pytest.mark.parametrize("row, arguments, expected", VECTORS, ids=lambda value: getattr(value, "name", None))
@pytest.mark.parametrize("floating", ["float64", "float32", "float16"])
def test_vector(row: Builtin, arguments: tuple[object, ...], expected: object, floating: str) -> None:
    """Exact arguments, results within the limit for float32 (its ulp counted at the result's largest component)."""
    types, result_type = overload_of(row, arguments)
    values = []
    with np.errstate(over="ignore"):
        for argument, type in zip(arguments, types, strict=True):
            dtype = dtype_of(type, floating)
            value = np.asarray(argument, dtype)
            if floating == "float32":
                np.testing.assert_array_equal(value.astype("float64"), np.asarray(argument, "float64"))
            elif floating == "float16" and not np.array_equal(
                value, np.asarray(argument), equal_nan=value.dtype.kind == "f"
            ):
                pytest.skip("an argument beyond float16")
            values.append(value[..., None])
        reference = np.asarray(expected, dtype_of(result_type, "float64"))
        if floating == "float16" and reference.dtype.kind == "f" and np.abs(reference).max() > 65504:
            pytest.skip("a result beyond float16")
    with rt.precision(floating), warnings.catch_warnings():
        warnings.simplefilter("error")
        actual = function(row.name)(*values)
    assert actual.dtype == dtype_of(result_type, floating)
    assert actual.shape == (*reference.shape, 1)
    if reference.dtype.kind == "f":
        size = np.abs(reference).max() * float(np.finfo(floating).eps)
        np.testing.assert_allclose(actual[..., 0], reference, rtol=0, atol=2.0 * size)
    else:
        np.testing.assert_array_equal(actual[..., 0], reference)


@pytest.mark.parametrize("row", [row for row in BUILTINS.values() if row.vectors], ids=lambda row: row.name)
def test_lanes_and_python_numbers(row: Builtin) -> None:
    """A vector's arguments repeated over lanes, or as Python numbers beside float32 ones, give the same."""
    arguments, _ = row.vectors[0]
    types, _ = overload_of(row, arguments)
    values = [np.asarray(value, dtype_of(type, "float32")) for value, type in zip(arguments, types, strict=True)]
    with rt.precision("float32"):
        once = function(row.name)(*(value[..., None] for value in values))
        lanes = function(row.name)(*(np.repeat(value[..., None], 5, -1) for value in values))
        bare = function(row.name)(*(value[..., None] if value.ndim else value.item() for value in values))
    np.testing.assert_array_equal(lanes, np.repeat(once, 5, -1))
    np.testing.assert_array_equal(np.ravel(bare), np.ravel(once))
    if types[0].kind != "uint":
        assert bare.dtype == once.dtype


def test_resolve() -> None:
    assert resolve("mix", [VEC3, VEC3, FLOAT]) == VEC3
    assert resolve("mix", [VEC3, VEC3, Vector("bool", 3)]) == VEC3
    assert resolve("mix", [VEC3, VEC3, VEC2]) is None
    assert resolve("mix", [VEC3, VEC3, INT]) is None
    assert resolve("dot", [VEC4, VEC4]) == FLOAT
    assert resolve("lessThan", [FLOAT, FLOAT]) is None
    assert resolve("lessThan", [VEC2, VEC2]) == Vector("bool", 2)
    assert resolve("clamp", [Vector("int", 3), INT, INT]) == Vector("int", 3)
    assert resolve("inverse", [Matrix(4, 4)]) == Matrix(4, 4)
    assert resolve("outerProduct", [VEC2, VEC3]) == Matrix(3, 2)
    assert resolve("transpose", [Matrix(2, 4)]) == Matrix(4, 2)
    assert resolve("determinant", [Matrix(2, 4)]) is None
    assert resolve("matrixCompMult", [Matrix(2, 4), Matrix(4, 2)]) is None
    assert resolve("texture", [Sampler("Cube"), VEC3]) == VEC4
    assert resolve("texture", [Sampler("2D"), VEC3]) is None
    assert resolve("textureSize", [Sampler("3D"), INT]) == Vector("int", 3)
    assert resolve("no_such", [FLOAT]) is None


def test_text() -> None:
    for row in BUILTINS.values():
        for signature in row.signatures:
            assert any(result.params == ",".join(parse(signature)[1:]) for result in expanded(row.name))
    assert text("atan", "hlsl", [VEC2, VEC2]) == "atan2"
    assert text("atan", "hlsl-dx9", [VEC2]) == "atan"
    assert text("mix", "wgsl", [FLOAT, FLOAT, BOOL]) == "select"
    assert text("mix", "hlsl-macros", [FLOAT, FLOAT, FLOAT]) == "lerp"
    assert text("texelFetch", "hlsl-dx9", [Sampler("3D"), Vector("int", 3), INT]) == ""
    assert text("texture", "hlsl-macros", [Sampler("3D"), VEC3, FLOAT]).startswith("{bare_texture}.SampleBias(")
    with pytest.raises(KeyError):
        text("atan", "hlsl", [INT])


def expanded(name: str) -> list[Any]:
    overload(name, ())
    return list(signatures._overloads[name].values())


def test_candidates() -> None:
    assert candidates("cross") == ["vec3 cross(vec3, vec3)"]
    assert candidates("no_such") == []


def test_signatures_import_nothing_heavy() -> None:
    code = "import sys, sssgen.ir.signatures; print({'numpy', 'lark', 'jinja2'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"
