"""The texture functions of GLSL ES 3.00 and 3.10: each has a row, a polyfill or a rewriting of the front end.

Source: section 8.8 of GLSL ES 3.00, and 8.9 of GLSL ES 3.10; without textures of several samples, which WebGPU cannot
sample.
"""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from sssgen.lang.plain_glsl import load_glsl_text

KINDS = ("", "i", "u")
PLACES = {"2D": "vec2", "3D": "vec3", "Cube": "vec3", "2DArray": "vec3"}
ALONG = {"2D": "vec2", "3D": "vec3", "Cube": "vec3", "2DArray": "vec2"}
SHADOWS = {"2D": "vec3", "Cube": "vec4", "2DArray": "vec4"}
FLAT = ("2D", "3D", "2DArray")


def offset(dim: str) -> str:
    return "ivec3" if dim == "3D" else "ivec2"


def projected(forms: tuple[str, ...] = ("",)) -> Iterator[tuple[str, ...]]:
    """The parameters of projective reads: with each of these forms, in which OFFSET and ALONG depend on the texture."""
    for kind in KINDS:
        for dim, place in (("2D", "vec3"), ("2D", "vec4"), ("3D", "vec4")):
            for form in forms:
                yield (
                    f"{kind}sampler{dim}",
                    place,
                    *form.replace("OFFSET", offset(dim)).replace("ALONG", ALONG[dim]).split(),
                )
    for form in forms:
        yield "sampler2DShadow", "vec4", *form.replace("OFFSET", "ivec2").replace("ALONG", "vec2").split()


def plain(dims: tuple[str, ...], forms: tuple[str, ...] = ("",)) -> Iterator[tuple[str, ...]]:
    """The parameters of reads of textures that do not compare."""
    for kind in KINDS:
        for dim in dims:
            for form in forms:
                parts = form.replace("OFFSET", offset(dim)).replace("ALONG", ALONG[dim])
                yield f"{kind}sampler{dim}", PLACES[dim], *parts.split()


def fetched(form: str) -> Iterator[tuple[str, ...]]:
    for kind in KINDS:
        for dim, place in (("2D", "ivec2"), ("3D", "ivec3"), ("2DArray", "ivec3")):
            yield f"{kind}sampler{dim}", place, "int", *form.replace("OFFSET", offset(dim)).split()


def shadows(dims: tuple[str, ...], form: str = "") -> Iterator[tuple[str, ...]]:
    for dim in dims:
        yield f"sampler{dim}Shadow", SHADOWS[dim], *form.replace("ALONG", ALONG[dim]).split()


FUNCTIONS = {
    "textureSize": [
        *((f"{kind}sampler{dim}", "int") for kind in KINDS for dim in PLACES),
        *((f"sampler{dim}Shadow", "int") for dim in SHADOWS),
    ],
    "texture": [
        *plain(tuple(PLACES), ("", "float")), *shadows(("2D", "Cube", "2DArray")), *shadows(("2D", "Cube"), "float"),
    ],
    "textureProj": [*projected(("", "float"))],
    "textureLod": [*plain(tuple(PLACES), ("float",)), *shadows(("2D",), "float")],
    "textureOffset": [
        *plain(FLAT, ("OFFSET", "OFFSET float")), *shadows(("2D",), "ivec2"), *shadows(("2D",), "ivec2 float"),
    ],
    "texelFetch": [*fetched("")],
    "texelFetchOffset": [*fetched("OFFSET")],
    "textureProjOffset": [*projected(("OFFSET", "OFFSET float"))],
    "textureLodOffset": [*plain(FLAT, ("float OFFSET",)), *shadows(("2D",), "float ivec2")],
    "textureProjLod": [*projected(("float",))],
    "textureProjLodOffset": [*projected(("float OFFSET",))],
    "textureGrad": [*plain(tuple(PLACES), ("ALONG ALONG",)), *shadows(tuple(SHADOWS), "ALONG ALONG")],
    "textureGradOffset": [*plain(FLAT, ("ALONG ALONG OFFSET",)), *shadows(("2D", "2DArray"), "ALONG ALONG ivec2")],
    "textureProjGrad": [*projected(("ALONG ALONG",))],
    "textureProjGradOffset": [*projected(("ALONG ALONG OFFSET",))],
    "textureGather": [
        *plain(("2D", "2DArray", "Cube"), ("", "int")),
        ("sampler2DShadow", "vec2", "float"), ("sampler2DArrayShadow", "vec3", "float"),
        ("samplerCubeShadow", "vec3", "float"),
    ],
    "textureGatherOffset": [
        *plain(("2D", "2DArray"), ("OFFSET", "OFFSET int")),
        ("sampler2DShadow", "vec2", "float", "ivec2"), ("sampler2DArrayShadow", "vec3", "float", "ivec2"),
    ],
}  # fmt: skip
COUNTS = {
    "textureSize": 15, "texture": 29, "textureProj": 20, "textureLod": 13, "textureOffset": 20, "texelFetch": 9,
    "texelFetchOffset": 9, "textureProjOffset": 20, "textureLodOffset": 10, "textureProjLod": 10,
    "textureProjLodOffset": 10, "textureGrad": 15, "textureGradOffset": 11, "textureProjGrad": 10,
    "textureProjGradOffset": 10, "textureGather": 21, "textureGatherOffset": 14,
}  # fmt: skip
"""How many the specifications list."""


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_overload_is_accepted(name: str) -> None:
    lines = ["#version 310 es", "precision highp float;"]
    for number, types in enumerate(FUNCTIONS[name]):
        sampler, *rest = types
        constant = [type_.startswith("ivec") and "Fetch" not in name for type_ in rest]
        constant[1:] = [is_it or type_.startswith("ivec") for is_it, type_ in zip(constant[1:], rest[1:], strict=True)]
        if name.startswith("textureGather"):
            constant = [is_it or type_ == "int" for is_it, type_ in zip(constant, rest, strict=True)]
        params = [f"{type_} p{at}" for at, type_ in enumerate(rest) if not constant[at]]
        values = [f"{type_}(1)" if constant[at] else f"p{at}" for at, type_ in enumerate(rest)]
        result = "vec4" if "Gather" in name or not sampler.endswith("Shadow") else "float"
        result = f"{sampler[0]}vec4" if sampler[0] in "iu" else result
        if name == "textureSize":
            result = "ivec3" if sampler.removesuffix("Shadow").endswith(("3D", "Array")) else "ivec2"
        head = ", ".join([f"highp {sampler} map", *params])
        lines.append(f"{result} f{number}({head}) {{ return {name}({', '.join(['map', *values])}); }}")
    assert len(FUNCTIONS[name]) == COUNTS[name]
    load_glsl_text("\n".join(lines) + "\n", "functions.frag")
