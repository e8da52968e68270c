"""TSL: the text of each construct, what three makes of it in node, and its results in three's renderers."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

import sssgen
from folders import TESTS
from skips import or_skip
from snapshot import check_snapshot
from sssgen.analyse.verify.machines import Machines, backends_of, start_machines
from sssgen.analyse.verify.verification import verify
from sssgen.analyse.verify.verified_function import Options
from sssgen.ir.nodes import Module
from sssgen.ir.types import FLOAT, INT, VEC3
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run import backends, machine_parts
from sssgen.run.backends import Backend, Call, Text
from sssgen.run.compilers import Source
from sssgen.support.diagnostics import SssgenError

CONSTRUCTS = (TESTS / "targets" / "tsl_constructs.glsl").read_text(encoding="utf-8")
RENDERERS = ("tsl", "tsl-webgl2")


def translated(text: str) -> str:
    """The module of TSL for a text of GLSL."""
    compiled = transpile(load_glsl_text(text, "case.glsl").module, "tsl", "case", keep=True)
    (module,) = [file for name, file in compiled.files.items() if not name.endswith(".json")]
    return module


def body(text: str) -> list[str]:
    """The lines of the last function, without its head and its layout."""
    lines = translated(text).rpartition("export const f = ")[2].splitlines()
    end = next(number for number, line in enumerate(lines) if line.startswith("}"))
    return [line.strip() for line in lines[1:end]]


def refusal(text: str) -> str:
    """The error for a text, with its place."""
    with pytest.raises(SssgenError) as error:
        translated(text)
    return error.value.diagnostics[0].render()


def test_the_text_of_every_construct() -> None:
    check_snapshot("tsl/constructs.tsl.js", translated(CONSTRUCTS))


def test_three_builds_every_construct(assert_compiles: Callable[[Source], None]) -> None:
    assert_compiles(Source(translated(CONSTRUCTS), "tsl", "library", name="constructs.tsl.js"))


def test_node_imports_the_module(tmp_path: Path) -> None:
    """Each name that the module imports is in three, and each function is exported."""
    node, three = machine_parts.node(), machine_parts.node_modules() / "three" / "package.json"
    if not node or not three.is_file():
        pytest.skip("node or npm three is missing: make setup")
    (tmp_path / "node_modules").symlink_to(three.parent.parent)
    (tmp_path / "case.mjs").write_text(translated(CONSTRUCTS), encoding="utf-8")
    script = "import * as own from './case.mjs'; console.log(Object.keys(own).join(' '))"
    command = [node, "--input-type=module", "-e", script]
    result = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False)
    assert result.returncode == 0, result.stderr
    functions = set(re.findall(r"^\w+ (\w+)\(", CONSTRUCTS, re.MULTILINE))
    assert functions <= set(result.stdout.split())


@pytest.fixture(scope="module")
def machines(backend: Callable[[str], Backend]) -> Iterator[Machines]:
    """OpenGL for the author's text, and three's renderers."""
    for name in backends_of("tsl"):
        backend(name)
    with start_machines(backends_of("tsl")) as running:
        yield running


def test_every_construct_has_its_results_in_three(machines: Machines) -> None:
    report = verify(CONSTRUCTS, "constructs.glsl", Options(64), machines=machines)
    assert [row.function for row in report.rows if not row.ok] == [], "\n".join(report.lines())
    assert all({"tsl", "tsl-gl2"} <= set(row.comparisons) for row in report.rows)
    assert "hlsl" not in next(iter(report.lines()))


def test_a_wrong_translation_is_seen(machines: Machines) -> None:
    def misread(text: str, shown: str) -> Module:
        return load_glsl_text(text.replace("x * 2.0", "x * 2.5"), shown).module

    (row,) = verify(
        "float f(float x) { return x * 2.0; }", "case.glsl", Options(32), read=misread, machines=machines
    ).rows
    assert not row.comparisons["tsl"].ok and not row.comparisons["tsl-gl2"].ok


@pytest.mark.parametrize("name", RENDERERS)
def test_an_error_of_three_is_reported(backend: Callable[[str], Backend], name: str) -> None:
    text = Text("import { Fn, vec3 } from 'three/tsl'; export const f = Fn(([x]) => { return vec3(x).missing(); });")
    call = Call("f", (FLOAT,), VEC3, (np.zeros(4),))
    with pytest.raises(SssgenError, match="missing is not a function"):
        backend(name).run(text, [call])
    good = Text("import { Fn } from 'three/tsl'; export const f = Fn(([x]) => { return x.mul(2.0); });")
    (result,) = backend(name).run(good, [call._replace(result=FLOAT, args=(np.arange(4.0),))])
    assert result.tolist() == [0.0, 2.0, 4.0, 6.0]


@pytest.mark.parametrize(
    ("glsl", "lines"),
    [
        ("float f(float x) { return 1.0 - x; }", ["return float(1.0).sub(x);"]),
        ("int f(int n) { return n + 2; }", ["return n.add(int(2));"]),
        ("uint f() { return uint(-1); }", ["return uint(0xffffffff);"]),
        ("vec3 f() { return vec3(1, 2u, 3.0); }", ["return vec3(1.0, 2.0, 3.0);"]),
        (
            "float f(float x) { float y = x; y += 1.0; return y; }",
            ["const y = x.toVar();", "y.addAssign(1.0);", "return y;"],
        ),
        ("float f(float x) { float y = x * x; return y; }", ["const y = x.mul(x).toConst();", "return y;"]),
        ("float f(vec3 v, int i) { return v[i] + v[1]; }", ["return v.element(i).add(v.element(1));"]),
        ("float f(float x) { return inversesqrt(atan(x, 2.0)); }", ["return inverseSqrt(atan(x, 2.0));"]),
        ("float f(float x) { return dFdx(x) + fwidth(x); }", ["return dFdx(x).add(fwidth(x));"]),
        ("vec2 f(vec2 a, vec2 b, bvec2 c) { return mix(a, b, c); }", ["return select(c, b, a);"]),
        ("int f(float x) { return floatBitsToInt(0.5) + int(x); }", ["return floatBitsToInt(float(0.5)).add(int(x));"]),
        ("void f(float x) { if (x < 0.0) discard; }", ["If(x.lessThan(0.0), () => {", "Discard();", "});"]),
        (
            "float f(float x) { if (x > 1.0) { x = 1.0; } else if (x < 0.0) { x = 0.0; } return x; }",
            ["const x = x_in.toVar();", "If(x.greaterThan(1.0), () => {", "x.assign(1.0);",
             "}).ElseIf(x.lessThan(0.0), () => {", "x.assign(0.0);", "});", "return x;"],
        ),
        (
            "float f(float x) { for (int i = 8; i > 0; i -= 2) { x += 1.0; } return x; }",
            ["const x = x_in.toVar();",
             "Loop({ start: 8, end: 0, type: 'int', condition: '>', name: 'i', update: '-= 2' }, ({ i }) => {",
             "x.addAssign(1.0);", "});", "return x;"],
        ),
    ],
)  # fmt: skip
def test_the_text_of_a_statement(glsl: str, lines: list[str]) -> None:
    assert body(glsl) == lines


def test_a_layout_names_the_authors_parameters() -> None:
    text = translated("float luma(vec3 color) { return color.g; }")
    layout = "}).setLayout({ name: 'luma', type: 'float', inputs: [{ name: 'color', type: 'vec3' }] });"
    assert text.splitlines()[-3:] == [
        "export const luma = /*@__PURE__*/ Fn(([color]) => {", "    return color.g;", layout,
    ]  # fmt: skip
    assert "import { Fn } from 'three/tsl';" in text


def test_functions_with_textures_and_arrays_are_expanded() -> None:
    """three's layouts have neither; a function that returns nothing discards, and is a statement."""
    for glsl in ("vec4 f(sampler2D map, vec2 p) { return texture(map, p); }", "float f(float w[2]) { return w[0]; }"):
        assert "setLayout" not in translated(glsl)
    assert translated("void f(float x) { if (x < 0.0) discard; }").splitlines()[-1] == "}, 'void');"


def test_names_avoid_javascript_and_the_languages_that_three_writes() -> None:
    text = translated(
        "float half(float new, float sample, float Loop) { float await = new; return await + sample + Loop; }"
    )
    assert "Fn(([new_, sample_, Loop_])" in text and "const await_ = new_" in text and "half_" in text


@pytest.mark.parametrize(
    ("glsl", "message", "place"),
    [
        ("mat2x3 f(mat2x3 m) { return m; }", "has no mat2x3", "1:29"),
        ("float f(vec3 v) { mat3x2 m = mat3x2(v.x); return m[0][0]; }", "has no mat3x2", "1:30"),
        ("struct S { float w[3]; };\nfloat f(S s) { return s.w[1]; }", "has no arrays in arrays and structs", "1:8"),
        ("float f(float w[2][3]) { return w[0][1]; }", "has no arrays in arrays and structs", "1:33"),
        ("float f(sampler2DShadow map, vec3 p) { return texture(map, p); }", "this target has no texture", "1:47"),
        ("ivec3 f(sampler3D map) { return textureSize(map, 0); }", "this target has no textureSize", "1:33"),
        ("void f(out float w[2], out int n) { w[0] = w[1] = 1.0; n = 2; }", "an array is among several results", "1:6"),
    ],
)
def test_what_three_lacks_is_an_error_with_a_place(glsl: str, message: str, place: str) -> None:
    shown = refusal(glsl)
    assert message in shown and f"case.glsl:{place}" in shown


def test_a_materials_functions(assert_compiles: Callable[[Source], None]) -> None:
    compiled = sssgen.compile("ice", "tsl", form="functions")
    text = compiled.files["ice.functions.tsl.js"]
    assert "export const evaluate_surface = " in text and "uniform" not in text
    assert_compiles(Source(text, "tsl", "library", name="ice.functions.tsl.js"))


def test_a_module_runs_in_both_renderers(backend: Callable[[str], Backend]) -> None:
    """Integers, loops and results of several parts, apart from the verification."""
    module = translated(
        "int sum(int n) { int s = 0; for (int i = 0; i < 9; i++) { if (i > n) break; s += i; } return s; }"
    )
    counts = np.arange(-2, 12)
    wanted = [sum(range(min(n, 8) + 1)) for n in counts]
    for name in RENDERERS:
        or_skip(backends.get, name)
        (result,) = backend(name).run(Text(module), [Call("sum", (INT,), INT, (counts,))])
        assert result.tolist() == wanted
