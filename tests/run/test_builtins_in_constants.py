"""Every builtin in a constant at file scope has the value of its test vectors, on every back end."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
import pytest

from results_of_glsl import check_results
from slow_cases import back_end_cases, diagonal
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.signatures import overloads
from sssgen.ir.types import FLOAT, Matrix, Scalar, Type, components, kind_of, spell
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Backend, Call, Text

PYTHON = {"float": float, "int": int, "uint": int, "bool": bool}
BACKENDS = ("numpy", "gl", "gl-es", "webgpu", "browser", "hlsl", "hlsl-glslang", "unity", "metal")


class Case(NamedTuple):
    """One constant, and its value."""

    name: str
    text: str
    type: Type
    value: Any


def flat(value: Any) -> list[Any]:
    return [part for one in value for part in flat(one)] if isinstance(value, tuple) else [value]


def fits(type_: Type, value: Any) -> bool:
    """Whether a value of a test vector can be of this type."""
    numbers = flat(value)
    if len(numbers) != components(type_) or isinstance(type_, Matrix) != isinstance(value, tuple) & (
        isinstance(value, tuple) and isinstance(value[0], tuple)
    ):
        return False
    kind = kind_of(type_)
    limits: dict[str, tuple[float, float]] = {"int": (-(2**31), 2**31 - 1), "uint": (0, 2**32 - 1)}
    low, high = limits.get(kind, (-3e38, 3e38))
    return all(
        isinstance(number, float | int) and type(number) is PYTHON[kind] and low <= number <= high for number in numbers
    )


def written(type_: Type, value: Any) -> str:
    """A value as GLSL."""
    if isinstance(type_, Scalar):
        return str(value).lower() if type_.kind == "bool" else f"{value}{'u' if type_.kind == 'uint' else ''}"
    kind = Scalar(kind_of(type_))
    return f"{spell(type_)}({', '.join(written(kind, number) for number in flat(value))})"


def cases() -> Iterator[Case]:
    """The test vectors of every builtin without textures, each with the first overload that it fits."""
    for row in BUILTINS.values():
        if row.reads_neighbours_or_textures or row.name in ("fmod", "saturate", "unpackNormal"):
            continue
        for number, (arguments, expected) in enumerate(row.vectors):
            for types, overload in overloads(row.name).items():
                if len(types) == len(arguments) and all(map(fits, types, arguments)):
                    if not fits(overload.result, expected):
                        continue
                    call = f"{row.name}({', '.join(map(written, types, arguments))})"
                    yield Case(f"{row.name}_{number}", call, overload.result, expected)
                    break


CASES = list(cases())


def test_nearly_every_vector_is_a_case() -> None:
    rows = [row for row in BUILTINS.values() if not row.reads_neighbours_or_textures]
    assert len({case.name.rpartition("_")[0] for case in CASES}) >= len(rows) - 6
    assert len(CASES) > 2.5 * len(rows)


@pytest.mark.parametrize(("name", "qualifier"), diagonal(back_end_cases(BACKENDS), ["const ", ""]))
def test_builtins_of_constants(backend: Callable[[str], Backend], name: str, qualifier: str) -> None:
    """In a constant, and in a variable at file scope."""
    gpu = backend(name)
    if name == "numpy" and not qualifier:
        pytest.skip("a function has no variables at file scope")
    if name == "unity" and not qualifier:
        pytest.skip("the variables become local ones, and glslang folds comparisons of vectors in HLSL wrongly")
    declarations = [f"{qualifier}{spell(case.type)} K_{case.name} = {case.text};\n" for case in CASES]
    functions = [f"{spell(case.type)} f_{case.name}(float x) {{ return K_{case.name}; }}\n" for case in CASES]
    module = load_glsl_text("".join(declarations + functions), "constants.glsl").module
    compiled = transpile(module, gpu.target.name, "constants", keep=True)
    text = next(text for file, text in compiled.files.items() if not file.endswith(".json"))
    calls = [Call(f"f_{case.name}", (FLOAT,), case.type, (np.ones(4),)) for case in CASES]
    wrong = []
    for case, result in zip(CASES, gpu.run(Text(text), calls), strict=True):
        got = np.broadcast_to(result, (*np.shape(result)[:-1], 4))[..., 0].ravel()
        tolerance = max(1e-5, BUILTINS[case.name.rpartition("_")[0]].absolute)
        if not np.allclose(got.astype(np.float64), np.array(flat(case.value), np.float64), tolerance, tolerance):
            wrong.append(f"{case.text}: {got}, expected {case.value}")
    assert not wrong, "\n".join(wrong)


CHOICES = {
    "mix(vec3(vec2(1.0), 3.0), vec3(4.0), bvec3(true, false, false))": 2.0 + 4.0 + 3.0,
    "mix(A, B, bvec3(false, true, K))": 2.0 + 1.0 + 5.0,
    "K ? A : B": 2.0 + 1.0 + 3.0,
    "ONE > 2.0 ? A : B * 2.0": 2.0 + 10.0 + 10.0,
    "ONE > 2.0 ? vec3(A.xy, 1.0) : B": 2.0 + 5.0 + 5.0,
    "K ? C : B": 2.0 + 1.0 + 3.0,
    "D": 2.0 + 1.0 + 3.0,
    "x > 1.0 ? A : B": 2.0 + 1.0 + 3.0,
}


@pytest.mark.parametrize("value", CHOICES)
def test_a_choice_of_constants_made_of_vectors(backend: Callable[[str], Backend], value: str) -> None:
    """naga crashed on `select` of these."""
    text = f"""
        const vec3 A = vec3(vec2(1.0), 3.0);
        const vec3 B = vec3(5.0);
        const bool K = true;
        const float ONE = 1.0;
        const vec3 D = K ? A : B;
        float f(float x) {{
            const vec3 C = vec3(vec2(1.0), 3.0);
            vec3 y = {value};
            return x + y.x + y.z;
        }}
    """
    check_results(text, CHOICES[value], backend, (2.0,))
