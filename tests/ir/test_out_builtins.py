"""Builtins with out parameters, and projective reads: their results on every back end, and their overloads."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest

from qualification.parity_inputs import DTYPES, textures
from slow_cases import diagonal
from sssgen.ir.out_builtins import OUT_BUILTINS, is_out_builtin, out_builtin
from sssgen.ir.types import FLOAT, VEC2, VEC3, VEC4, Sampler, Type, kind_of, spell, vector_of
from sssgen.lang.loader import load_text
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import SINGLE, Array, Backend, Call, Text

BACKENDS = ("numpy", *(name for name in SINGLE if name != "bevy"))  # its text is that of webgpu, in a larger program
LANES = 64

KINDS: dict[str, tuple[str, ...]] = {
    "modf": ("float", "float"), "frexp": ("float", "int"), "uaddCarry": ("uint",) * 3, "usubBorrow": ("uint",) * 3,
    "umulExtended": ("uint",) * 4, "imulExtended": ("int",) * 4,
}  # fmt: skip
"""Name → the kinds of its arguments; the last ones are out, one where it has a result of its own, else two."""


def typed(name: str, size: int) -> list[Type]:
    return [vector_of(kind, size) for kind in KINDS[name]]


def program(name: str, size: int) -> tuple[str, list[Type]]:
    """A function for each output of a call, and the types of the outputs."""
    types = typed(name, size)
    outs = 2 if name.endswith("Extended") else 1
    source = out_builtin(name, types)
    assert source is not None
    inputs = types[:-outs]
    results = types[-outs:] if outs == 2 else [inputs[0], types[-1]]
    params = ", ".join(f"{spell(type_)} {letter}" for type_, letter in zip(inputs, "xy", strict=False))
    locals_ = "".join(f"{spell(type_)} out_{index}; " for index, type_ in enumerate(types[-outs:]))
    call = f"{name}({', '.join(['xy'[at] for at in range(len(inputs))] + [f'out_{at}' for at in range(outs)])})"
    first = f"{spell(results[0])} first({params}) {{ {locals_}"
    first += f"return {call}; }}" if outs == 1 else f"{call}; return out_0; }}"
    second = f"{spell(results[1])} second({params}) {{ {locals_}"
    second += f"{call}; return out_{outs - 1}; }}"
    return f"{source}{first}\n{second}", results


def run(backend: Backend, text: str, calls: Sequence[tuple[str, list[Type], Type, tuple[Any, ...]]]) -> list[Array]:
    compiled = transpile(load_glsl_text(text, "case").module, backend.target.name, "case")
    emitted = next(text for name, text in compiled.files.items() if not name.endswith(".json"))
    renames = compiled.reflection["renames"]
    prepared = [Call(renames.get(name, name), tuple(types), result, args) for name, types, result, args in calls]
    return backend.run(Text(emitted), prepared, textures())


def drawn(name: str, types: Sequence[Type]) -> tuple[Array, ...]:
    """Edges, small numbers and numbers of all sizes."""
    rng = np.random.default_rng(3)
    results = []
    for type_ in types:
        size = getattr(type_, "size", 1)
        if kind_of(type_) == "float":
            edges = [0.0, 0.5, -0.5, 1.0, -1.0, 1.75, -2.25, 2.0**23 - 0.5, 2.0**-126, 1.0 - 2.0**-24]
            values = rng.normal(size=(size, LANES)) * 2.0 ** rng.integers(-20, 20, (size, LANES))
            values[:, :10] = edges
        else:
            info = np.iinfo(DTYPES[kind_of(type_)])
            values = rng.integers(info.min, info.max, (size, LANES), endpoint=True)
            edges = [info.min, info.max, 0, 1, 65535, 65536]
            values[:, :36] = np.repeat(edges, 6) if not results else np.tile(edges, 6)
        results.append((values if size > 1 else values[0]).astype(DTYPES[kind_of(type_)]))
    return tuple(results)


def expected(name: str, args: tuple[Array, ...]) -> tuple[Array, Array]:
    """By NumPy's own functions and 64-bit integers."""
    x = args[0]
    if name == "modf":
        part, whole = np.modf(x.astype(np.float64))
        return part, whole
    if name == "frexp":
        significand, exponent = np.frexp(x.astype(np.float64))
        return significand, exponent
    wide, other = (arg.astype(np.int64) for arg in args)
    if name == "uaddCarry":
        return (wide + other) % 2**32, (wide + other) // 2**32
    if name == "usubBorrow":
        return (wide - other) % 2**32, (wide < other).astype(np.int64)
    exact = x.astype(object) * args[1].astype(object)  # Python's integers: the product of two uints needs 64 bits
    return (exact // 2**32).astype(np.int64), (exact % 2**32).astype(np.int64)


@pytest.mark.parametrize(("builtin", "name"), diagonal(KINDS, BACKENDS))
def test_both_results_on_every_back_end(builtin: str, name: str, backend: Callable[[str], Backend]) -> None:
    for size in (1, 3):
        text, results = program(builtin, size)
        types = typed(builtin, size)[: -2 if builtin.endswith("Extended") else -1]
        args = drawn(builtin, types)
        calls = [(function, types, result, args) for function, result in zip(("first", "second"), results, strict=True)]
        for actual, wanted in zip(run(backend(name), text, calls), expected(builtin, args), strict=True):
            if actual.dtype.kind in "iu":
                np.testing.assert_array_equal(actual, wanted.astype(actual.dtype), builtin)
            else:
                np.testing.assert_array_equal(actual.astype(np.float64), wanted, builtin)


# Projective reads

READS = [
    ("textureProj", Sampler("2D"), VEC3, ()), ("textureProj", Sampler("2D"), VEC4, (FLOAT,)),
    ("textureProjLod", Sampler("2D"), VEC3, (FLOAT,)), ("textureProjLod", Sampler("3D"), VEC4, (FLOAT,)),
    ("textureProjGrad", Sampler("2D"), VEC4, (VEC2, VEC2)), ("textureProjGrad", Sampler("3D"), VEC4, (VEC3, VEC3)),
]  # fmt: skip
REFUSED = {"tsl": READS[-1:], "tsl-webgl2": READS[-1:]}
"""The reads that the language of a back end does not have: an error with its place (docs/transpile.md)."""


@pytest.mark.parametrize("name", BACKENDS)
def test_projective_reads(name: str, backend: Callable[[str], Backend]) -> None:
    """They are the reads at the divided coordinate; of level 0, that the levels of derivatives are out of the way."""
    texts, calls, wanted = [], [], []
    rng = np.random.default_rng(5)
    reads = [read for read in READS if read not in REFUSED.get(name, ())]
    for number, (builtin, sampler, place, extra) in enumerate(reads):
        params = ", ".join(f"{spell(type_)} p{at}" for at, type_ in enumerate((sampler, place, *extra)))
        names = ", ".join(f"p{at}" for at in range(2 + len(extra)))
        texts.append(f"vec4 case_{number}({params}) {{ return {builtin}({names}); }}\n")
        map_ = textures()["map" if sampler.dim == "2D" else "volume"]
        reach = 2 if sampler.dim == "2D" else 3
        coord = np.full((place.size, 12), 0.5, np.float32)
        coord[:reach] = rng.uniform(0.2, 1.8, (reach, 1))  # the same for all lanes: no derivative
        coord[-1] = rng.uniform(0.5, 2.0, 1)
        rest = [np.zeros(12 if type_ == FLOAT else (type_.size, 12), np.float32) for type_ in extra]
        calls.append(
            (f"case_{number}", [sampler, place, *extra], VEC4, ("map" if reach == 2 else "volume", coord, *rest))
        )
        wanted.append(map_.sample(coord[:reach].astype(np.float64) / coord[-1], 0.0))
    for read, got, right in zip(reads, run(backend(name), "".join(texts), calls), wanted, strict=True):
        np.testing.assert_allclose(got, right, rtol=0.0, atol=2.0**-7, err_msg=str(read))


@pytest.mark.parametrize("name", ["numpy", "gl", "gl-es", "webgpu", "browser", "hlsl"])
def test_reads_that_compare(name: str, backend: Callable[[str], Backend]) -> None:
    """A reference is right of all texels, of none, and of some of them; old GLSL has the result as a grey."""
    map_ = textures()["shade"]
    depths = map_.levels[0][..., 0].astype(np.float64)
    shadow = Sampler("2D", shadow=True)
    texts, calls = [], []
    for builtin, place, result in (
        ("textureProj", VEC4, FLOAT), ("shadow2DProj", VEC4, VEC4), ("shadow2D", VEC3, VEC4),
    ):  # fmt: skip
        source = out_builtin(builtin, [shadow, place]) or ""
        head = f"{spell(result)} of_{builtin}(sampler2DShadow s, {spell(place)} P)"
        texts.append(f"{source}{head} {{ return {builtin}(s, P); }}\n")
        coord = np.ones((place.size, 12), np.float32)
        coord[:2] = np.array([[3.5 / 16.0], [2.5 / 8.0]])  # the middle of a texel
        coord[2] = np.where(np.arange(12) % 2, depths[2, 3] - 1.0 / 512.0, depths[2, 3] + 1.0 / 512.0)
        if place == VEC4:
            coord *= 2.0
        calls.append((f"of_{builtin}", [shadow, place], result, ("shade", coord)))
    reference = np.arange(12) % 2
    for actual in run(backend(name), "".join(texts), calls):
        np.testing.assert_allclose(actual if actual.ndim == 1 else actual[0], reference, atol=2.0**-7)
        if actual.ndim == 2:
            np.testing.assert_allclose(actual[3], 1.0)


# What there is


def test_each_size_has_an_out_builtin() -> None:
    for name in KINDS:
        for size in (1, 2, 3, 4):
            source = out_builtin(name, typed(name, size))
            assert source is not None
            assert "gen" not in source
            (function,) = load_text(source, "case").functions
            assert function.name == name
        assert out_builtin(name, typed(name, 2)[:-1]) is None
        assert out_builtin(name, [VEC2] * 5) is None
    assert out_builtin("modf", [VEC2, FLOAT]) is None
    assert out_builtin("mix", [VEC2, VEC2, VEC2]) is None


def test_every_definition_is_found_by_its_types() -> None:
    for name, source in OUT_BUILTINS.items():
        assert is_out_builtin(name)
        assert source.count(f" {name}(") >= 1
    assert not is_out_builtin("texture")


@pytest.mark.parametrize("name", KINDS)
def test_one_file_calls_it_with_several_types(name: str) -> None:
    """Also GLSL ES, which converts nothing."""
    calls = []
    for size in (1, 3, 2):
        names = [f"v{size}_{at}" for at in range(len(KINDS[name]))]
        calls += [f"{spell(type_)} {variable};" for type_, variable in zip(typed(name, size), names, strict=True)]
        calls.append(f"{name}({', '.join(names)});")
    text = f"#version 310 es\nprecision highp float;\nvoid f() {{ {' '.join(calls)} }}\n"
    names = [function.name for function in load_glsl_text(text, "case.frag").module.functions]
    assert names.count(name) == 3
