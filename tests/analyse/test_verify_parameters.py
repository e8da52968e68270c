"""`sssgen transpile --verify` of functions without parameters, and of parameters without names."""

from __future__ import annotations

from sssgen.analyse.verify.machines import Machines
from sssgen.analyse.verify.plain_probes import probe_functions
from sssgen.analyse.verify.verification import verify
from sssgen.analyse.verify.verification_report import Row
from sssgen.analyse.verify.verified_function import Options
from sssgen.lang.plain_glsl import load_glsl_text

SAMPLES = 200
UNNAMED = """
#define NUMBER float
#define SAME(x) x
struct Pair { vec2 both; };
float unnamed;
float some(NUMBER, const in highp
  vec2, SAME(int), Pair, float[2], float unnamed_1, int count, inout float more) {
    more += 1.0;
    return unnamed_1 * 2.0 + float(count & 3);
}
float few(int) { return 3.0; }
"""


def rows(machines: Machines, text: str) -> dict[str, Row]:
    report = verify(text, "shader.glsl", Options(SAMPLES), machines=machines)
    return {row.function: row for row in report.rows}


def test_parameters_need_no_names(machines: Machines) -> None:
    results = rows(machines, UNNAMED)
    assert list(results) == ["some(float,vec2,int,Pair,float[2],float,int,float)", "few(int)"]
    assert all(row.ok and row.lanes for row in results.values()), results


def test_a_function_without_inputs_runs_once(machines: Machines) -> None:
    text = """
    float constant() { float s = 0.0; for (int i = 0; i < 300; i++) { s += float(i); } return s; }
    float slope() { return dFdx(constant()); }
    uniform float u;
    float bent() { return u; }
    """
    results = rows(machines, text)
    assert all(row.ok for row in results.values()), results
    assert [row.lanes for row in results.values()][:2] == [1, 4]
    assert results["bent()"].lanes > 100


def test_the_driver_gets_no_textures_of_one_dimension() -> None:
    """So it is not blamed for what it reads in their place."""
    text = """uniform sampler1D ramp;
vec4 look(float x) { return texture(ramp, x); }
float twice(float x) { return 2.0 * x; }
float bright(float x) { return look(x).x; }
"""
    module = load_glsl_text(text, "a.glsl").module
    reasons = [bool(each.reason) for each in probe_functions(module, list(module.functions), text)]
    assert reasons == [True, False, True]


def test_four_gathers_in_one(machines: Machines) -> None:
    """The driver has textureGatherOffsets itself."""
    text = """#version 450
    uniform sampler2D map;
    const ivec2 corners[4] = ivec2[4](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 2));
    vec4 gathered(vec2 p) { return textureGatherOffsets(map, p * 2.0, corners, 2); }
    """
    results = rows(machines, text)
    assert all(row.ok and row.lanes for row in results.values()), results
