"""Every builtin, and every technique, run on real back ends and compared with the numbers expected of it.

One program a back end holds all overloads. What comes back is held against the intrinsic table's test vectors, and
against the NumPy runtime in float64 on those and on random arguments, within the table's limits.
"""

from __future__ import annotations

import keyword
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

import sssgen
from against_numpy import (
    DTYPES,
    HEIGHT,
    TEXTURES,
    Array,
    arguments,
    differences,
    drawn_beside_textures,
    pixels,
    shape,
    textures,
    transpiled,
)
from against_numpy import drawn as drawn_freely
from sssgen.harness.backends import Backend, Block, Call, DrawingBackend, Place, Text
from sssgen.harness.backends.calls import drawing, results
from sssgen.ir import signatures
from sssgen.ir.intrinsics import BUILTINS, Builtin
from sssgen.ir.types import (
    BY_NAME,
    FLOAT,
    INT,
    VEC2,
    VEC4,
    Matrix,
    Sampler,
    Scalar,
    Type,
    Vector,
    components,
    kind_of,
    spell,
)
from sssgen.lang.loader import load_file, load_text
from sssgen.targets import numpy_runtime as rt
from test_pitfalls import program as pitfalls
from validate import code

LANES = 12

# Where random arguments come from: (low, high) for all, or one for each; else [-2, 2].
RANGES: dict[str, Any] = {
    "asin": (-0.9, 0.9), "acos": (-0.9, 0.9), "atanh": (-0.9, 0.9), "acosh": (1.1, 4.0), "tan": (-1.0, 1.0),
    "pow": ((0.1, 3.0), (-2.0, 2.0)), "log": (0.1, 10.0), "log2": (0.1, 10.0), "sqrt": (0.0, 10.0),
    "inversesqrt": (0.1, 10.0), "mod": ((-3.0, 3.0), (0.5, 2.0)), "fmod": ((-3.0, 3.0), (0.5, 2.0)),
    "clamp": ((-3.0, 3.0), (-2.0, 0.0), (0.0, 2.0)), "smoothstep": ((-1.0, 0.0), (0.5, 2.0), (-2.0, 3.0)),
    "mix": ((0.25, 2.0), (0.25, 2.0), (0.0, 1.0)), "refract": ((-1.0, 1.0), (-1.0, 1.0), (0.25, 0.9)),
    "dot": (0.25, 2.0), "textureLod": ((-1.0, 2.0), (0.0, 3.0)),
}  # fmt: skip
NEIGHBOURS = {"texture", "textureGrad", "dFdx", "dFdy", "fwidth"}
UNIT = {"reflect": (1,), "refract": (0, 1)}
"""Arguments that are unit vectors."""


class Overload(NamedTuple):
    """One overload of a builtin, its arguments over all lanes, and how many lanes in front are test vectors."""

    row: Builtin
    params: tuple[Type, ...]
    result: Type
    args: tuple[Any, ...]
    vectors: tuple[object, ...]

    @property
    def title(self) -> str:
        return f"{self.row.name}({', '.join(map(spell, self.params))})"


TARGETS = ["gl", "gl-es", "webgpu", "hlsl-glslang", "hlsl", "unity"]


@pytest.fixture(params=TARGETS)
def gpu(request: pytest.FixtureRequest, backend: Callable[[str], Backend]) -> Backend:
    """Each back end that draws."""
    return backend(request.param)


# Arguments


def lane_of(value: object, type_: Type) -> Array:
    return np.asarray(value, DTYPES[kind_of(type_)])


def fits(value: object, type_: Type) -> bool:
    """Whether a test vector's value has a type; an integer is an int or a uint."""
    if isinstance(type_, Vector | Matrix):
        inner = Vector("float", type_.size) if isinstance(type_, Matrix) else Scalar(type_.kind)
        return isinstance(value, tuple) and len(value) == type_.size and all(fits(part, inner) for part in value)
    kind = kind_of(type_)
    if kind == "uint":
        return type(value) is int and value >= 0
    return type(value).__name__ == kind and (kind != "int" or -(2**31) <= value < 2**31)  # type: ignore[operator]


def from_vectors(row: Builtin, params: tuple[Type, ...]) -> tuple[list[tuple[Any, ...]], list[object]]:
    """Lanes of arguments from the test vectors: those of this overload, and of its scalar one put together."""
    given = [(args, result) for args, result in row.vectors if len(args) == len(params)]
    own = [(args, result) for args, result in given if all(map(fits, args, params))]
    lanes = [args for args, _ in own]
    scalars = [Scalar(kind_of(type_)) for type_ in params]
    alike = [args for args, _ in given if all(map(fits, args, scalars))]
    if row.signatures[0].startswith("gen") and any(isinstance(type_, Vector) for type_ in params):
        lanes += [
            tuple(
                tuple(alike[(lane + part) % len(alike)][index] for part in range(type_.size))
                if isinstance(type_, Vector) else alike[lane][index]
                for index, type_ in enumerate(params)
            )
            for lane in range(len(alike))
        ]  # fmt: skip
    return lanes, [result for _, result in own]


def drawn(name: str, index: int, type_: Type, rng: np.random.Generator) -> Any:
    """A random argument, (components…)."""
    kind, size = kind_of(type_), shape(type_) or (1,)
    if kind == "bool":
        return rng.random(size) < 0.5
    if name == "unpackHalf2x16":
        return rng.uniform(-2.0, 2.0, 2).astype(np.float16).view(np.uint32)
    if name.endswith("BitsToFloat"):
        return rng.uniform(-2.0, 2.0, size).astype(np.float32).view(DTYPES[kind])
    if kind in ("int", "uint"):
        low, high = (-9, 9) if kind == "int" else (0, 2**32)
        if name in ("texelFetch", "textureSize"):  # the same level for all lanes: not all drivers know more
            return np.ones(size, np.int32) if type_ == INT else rng.integers(0, 2, size)
        if name == "clamp" and index > 0:
            low, high = (low, high // 4) if index == 1 else (high // 4, high)
        return rng.integers(low, high, size)
    if isinstance(type_, Matrix):
        return 2.0 * np.eye(type_.size) + rng.uniform(-0.5, 0.5, size)
    ranges = RANGES.get(name, (-2.0, 2.0))
    if isinstance(ranges[0], tuple):
        index -= name.startswith("texture")
        ranges = ranges[min(index, len(ranges) - 1)]
    first, last = ranges
    value = rng.uniform(first, last, size)
    if name == "textureLod" and size == (3,):
        value[1] = 3.0  # to the middle of a cube's face
    if index in UNIT.get(name, ()) and size != (1,):
        value /= np.linalg.norm(value)
    return value.astype(np.float16) if name == "packHalf2x16" else value


@cache
def overloads() -> list[Overload]:
    """Every overload with its lanes: test vectors first, the rest random."""
    rng = np.random.default_rng(7)
    found = []
    for row in BUILTINS.values():
        signatures.overload(row.name, ())
        for params, (result, _) in signatures._overloads[row.name].items():
            plain = [type_ for type_ in params if not isinstance(type_, Sampler)]
            lanes, vectors = from_vectors(row, params)
            args: list[Any] = []
            for index, type_ in enumerate(params):
                if isinstance(type_, Sampler):
                    args.append(TEXTURES[type_.dim])
                    continue
                value: Array = np.zeros((*shape(type_), LANES), DTYPES[kind_of(type_)])
                for lane in range(LANES):
                    given = lanes[lane][index] if lane < len(lanes) else drawn(row.name, index, type_, rng)
                    with np.errstate(over="ignore"):
                        value[..., lane] = np.asarray(given).astype(value.dtype).reshape(shape(type_))
                args.append(value)
            assert plain
            found.append(Overload(row, params, result, tuple(args), tuple(vectors)))
    return found


def over_the_image(overload: Overload) -> Overload:
    """With arguments for what looks at neighbours: linear over the image, two texels a pixel, so level 1 everywhere.

    Levels between, and the coarse and the fine derivatives of anything else, are an implementation's own.
    """
    x, y = (places - middle for places, middle in zip(pixels(LANES), (2.0, 0.5), strict=True))
    row, first = overload.row, overload.params[0]
    if not isinstance(first, Sampler):
        slope = 0.5 * x - 0.25 * y
        args = [slope * np.arange(1, components(type_) + 1)[:, None] for type_ in overload.params]
        return overload._replace(args=tuple(arg.reshape(*shape(first), LANES).astype(np.float32) for arg in args))
    sizes = np.array(textures()[str(overload.args[0])].size()).reshape(-1, 1)
    cube = first.dim == "Cube"
    steps = np.zeros((2, 3 if cube else len(sizes), LANES))
    steps[0, 0], steps[1, 1] = 2.0 / sizes[0], 2.0 / sizes[1]
    coord = steps[0] * x + steps[1] * y + 0.3
    if cube:
        coord, steps = np.array([coord[0], np.full(LANES, 2.0), coord[1]]), 4.0 * steps[:, [0, 2, 1]]
    given = [coord, *steps] if row.name == "textureGrad" else [coord]
    if overload.params[-1] == FLOAT:
        given.append(np.full(LANES, 0.5))
    return overload._replace(args=(overload.args[0], *[arg.astype(np.float32) for arg in given]))


# Running and comparing


def unsupported(overload: Overload, dialect: str) -> bool:
    text = signatures.text(overload.row.name, dialect, overload.params)
    return text == "" and not overload.row.polyfill


def run(gpu: Backend, chosen: list[Overload]) -> list[Array]:
    """The results of all overloads, from one program of functions `case_N`."""
    lines, calls = [], []
    for number, overload in enumerate(chosen):
        names = "abcd"[: len(overload.params)]
        params = ", ".join(f"{spell(type_)} {name}" for type_, name in zip(overload.params, names, strict=True))
        value = f"{overload.row.name}({', '.join(names)})"
        lines.append(f"{spell(overload.result)} case_{number}({params}) {{ return {value}; }}")
        calls.append(Call(f"case_{number}", overload.params, overload.result, overload.args))
    text = code(load_text("\n".join(lines), "cases"), gpu.target.name)
    return gpu.run(Text(text), calls, textures())


def oracle(overload: Overload) -> Array:
    """What the NumPy runtime gives in float64."""
    args: list[Any] = [
        textures()[arg] if isinstance(arg, str) else arg.astype(np.float64) if arg.dtype.kind == "f" else arg
        for arg in overload.args
    ]
    name = overload.row.name
    if name in ("texelFetch", "textureSize"):
        args[-1] = args[-1][0]
    with rt.precision("float64"), rt.grid(HEIGHT, LANES // HEIGHT):
        return np.asarray(getattr(rt, name + "_" * keyword.iskeyword(name))(*args))


def difference(row: Builtin, got: Array, wanted: Array) -> str:
    """How a result of one lane is wrong, or ''."""
    if wanted.dtype.kind != "f":
        return "" if np.array_equal(got, wanted) else f"{got} is not {wanted}"
    size = float(np.abs(wanted).max())
    limit = max(row.absolute, row.ulp * float(np.spacing(np.float32(size))))
    if row.kind == "fetch":
        limit = 2.0**-7 if row.name != "texelFetch" else 0.0  # weights have eight bits
    error = np.abs(got.astype(np.float64) - wanted).max()
    return "" if error <= limit else f"{got} is off {wanted} by {error:.3g}, of {limit:.3g} allowed"


def compare(overload: Overload, got: Array) -> list[str]:
    """What is wrong with a result."""
    dtype = np.float64 if kind_of(overload.result) == "float" else DTYPES[kind_of(overload.result)]
    wanted: Array = np.broadcast_to(oracle(overload), got.shape).astype(dtype)
    wrong = []
    for lane in range(LANES):
        told = difference(overload.row, got[..., lane], wanted[..., lane])
        if not told and lane < len(overload.vectors):
            told = difference(overload.row, got[..., lane], np.asarray(overload.vectors[lane], dtype))
        if told:
            args = [arg if isinstance(arg, str) else arg[..., lane].tolist() for arg in overload.args]
            wrong.append(f"{overload.title} at {args}: {told}")
    return wrong[:2]


def test_builtins(gpu: Backend) -> None:
    known = [overload for overload in overloads() if not unsupported(overload, gpu.target.dialect)]
    chosen = [over_the_image(one) if one.row.name in NEIGHBOURS else one for one in known]
    wrong = [line for one, got in zip(chosen, run(gpu, chosen), strict=True) for line in compare(one, got)]
    assert not wrong, "\n".join([f"{len(wrong)} of {len(known)}", *wrong])


# Whole functions


def test_pitfalls(gpu: Backend) -> None:
    """Each case's function, against the text that the numpy target makes of it."""
    module, functions = pitfalls()
    calls = []
    for case, function in functions:
        params = tuple(param.type for param in function.params)
        textured = any(isinstance(type_, Sampler) for type_ in params)
        args = arguments(function, drawn_beside_textures if textured else drawn_freely, LANES)
        calls.append((case.source, Call(function.name, params, function.result, args)))
    wrong = differences(gpu, module, calls, textures())
    assert not wrong, "\n\n".join(wrong)


# Uniforms

PROBE = """
uniform float a; uniform vec3 b; uniform vec2 c; uniform bool d; uniform float e; uniform mat3 f; uniform vec3 g;
uniform int h; uniform mat2 k; uniform uint m; uniform vec4 n; uniform float o[3]; uniform vec2 q[2]; uniform mat4 r;
uniform bvec2 s; uniform float t; uniform mat3 u[2]; uniform mat2 v[2]; uniform bool w[2]; uniform float z;

float total(float values[3]) { return values[0] + 2.0 * values[1] + 3.0 * values[2]; }

/** Shows the uniforms, one after the other.
role: lighting
*/
vec3 layout_probe(uv_position uv) {
    int i = int(uv.x);
    int j = int(uv.y);
    if (i == 0) { return vec3(a, c); }
    if (i == 1) { return b; }
    if (i == 2) { return vec3(d ? 1.0 : 0.0, e, float(h)); }
    if (i == 3) { return f[0] + f[1] * 10.0 + f[2] * 100.0; }
    if (i == 4) { return f * vec3(1.0, 2.0, 3.0); }
    if (i == 5) { return g; }
    if (i == 6) { return vec3(k * vec2(1.0, 2.0), float(m)); }
    if (i == 7) { return n.xyz + n.w; }
    if (i == 8) { return vec3(o[j], o[1], total(o)); }
    if (i == 9) { return vec3(q[0] + q[1] * 10.0, q[j].y); }
    if (i == 10) { return (r * vec4(1.0, 2.0, 3.0, 4.0)).xyz; }
    if (i == 11) { return vec3(s, t); }
    if (i == 12) { return u[j] * vec3(1.0, 2.0, 3.0) + u[0][2]; }
    if (i == 13) { return vec3(v[j] * vec2(1.0, 2.0), v[1][1].x); }
    return vec3(w[0] ? 1.0 : 0.0, w[j] ? 1.0 : 0.0, z);
}
"""
MATERIAL = '[material]\nname = "layout"\nshading = "unlit"\n[lighting]\ntechnique = "layout_probe.sss"\n'


def uniforms_of(reflection: dict[str, Any]) -> tuple[bytes, dict[str, tuple[float, ...]]]:
    """Other numbers in each component, in a block at the places that the reflection names, and by name."""
    block = np.zeros((reflection["uniform_block_size"] or 0) // 4, np.uint32)
    values: dict[str, tuple[float, ...]] = {}
    for number, uniform in enumerate(sorted(reflection["uniforms"], key=lambda uniform: str(uniform["name"]))):
        base, _, length = uniform["type"].rstrip("]").partition("[")
        type_ = BY_NAME[base]
        count = components(type_) * int(length or 1)
        kind = kind_of(type_)
        given = np.arange(1, count + 1) + 10 * number if kind != "bool" else np.arange(1, count + 1) % 2
        values[uniform["name"]] = tuple(given.tolist())
        if "offset" in uniform:  # std140: a row of 16 bytes for each column and each element
            rows = given.astype(DTYPES[kind]).astype(np.float32 if kind == "float" else np.int32)
            size = type_.size if isinstance(type_, Matrix | Vector) else 1
            for place, row in enumerate(rows.reshape(-1, size)):
                start = uniform["offset"] // 4 + 4 * place
                block[start : start + size] = row.view(np.uint32)
    return block.tobytes(), values


@pytest.mark.parametrize("gpu", [name for name in TARGETS if name != "unity"], indirect=True)  # has no block
def test_uniforms_lie_where_the_reflection_says(gpu: Backend, tmp_path: Path) -> None:
    (tmp_path / "layout_probe.sss").write_text(PROBE, encoding="utf-8")
    (tmp_path / "layout.toml").write_text(MATERIAL, encoding="utf-8")
    made = sssgen.compile(tmp_path / "layout.toml", gpu.target.name)
    text = next(text for name, text in made.files.items() if not name.endswith((".json", ".vert")))
    text = re.sub(r"(?m)^(#version|precision|in|out) .*\n", "", text.partition("void main()")[0])
    uv = np.array(np.meshgrid(np.arange(15), np.arange(2))).reshape(2, -1) + 0.5
    call = Call(made.reflection["entries"]["color"]["function"], (VEC2,), VEC4, (uv,))
    block, values = uniforms_of(made.reflection)
    assert isinstance(gpu, DrawingBackend)
    bare, layout = drawing(gpu.target, Text(text), [call], {})
    blocks = {"Material": Block(block, Place(gpu.target.table.get("material_group", 0), 0))} if block else {}
    filled = bare._replace(blocks=blocks, values={name: np.array(value) for name, value in values.items()})
    (got,) = results([call], layout, gpu.draw(filled))

    names: dict[str, Any] = {}
    exec(transpiled(load_file(tmp_path / "layout_probe.sss", "probe"), "numpy"), names)
    wanted = names["layout_probe"](uv, **{
        name: in_layout(BY_NAME[type_.partition("[")[0]], "[" in type_, values[name])
        for name, type_ in ((uniform["name"], uniform["type"]) for uniform in made.reflection["uniforms"])
    })  # fmt: skip
    np.testing.assert_allclose(got[:3], np.broadcast_to(wanted, (3, 30)), rtol=1e-6)


def in_layout(type_: Type, is_array: bool, numbers: tuple[float, ...]) -> Array:
    """A uniform's numbers as the numpy target has them, in one lane."""
    dtype = np.float64 if kind_of(type_) == "float" else DTYPES[kind_of(type_)]
    return np.array(numbers, dtype).reshape(*([-1] if is_array else []), *shape(type_), 1)
