"""Constants that GLSL leaves undefined, where a target refuses them and the author's text is kept."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from results_of_glsl import check_results
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import Compiled, transpile
from sssgen.run.backends import Backend
from sssgen.run.compilers import Source

TEXT = """const float LOG = log2(-8.9), ROOT = sqrt(-1.0), POWER = pow(-1.0, 0.5);
const float BIG = 3e38 * 10.0, BIGGER = 1e39 * 2.0, LOW = -BIG;
const int WHOLE = 7 / 0, REST = 5 % 0, SHIFTED = 1 << 33;
const vec3 UP = normalize(vec3(0.0));
float undefined() { return LOG + ROOT + POWER + UP.x + asin(2.0) + inverse(mat2(1.0, 2.0, 2.0, 4.0))[0].x; }
int whole(int n) { n /= 0; return n % 0 + WHOLE + REST + SHIFTED + int(1e20) + bitfieldExtract(7, 30, 8); }
ivec2 pair(ivec2 n) { return n / ivec2(0, 2) + ivec2(3, 4) % ivec2(0); }
float f(float x) { return x < BIG && x < BIGGER && x > LOW && x < 1.0 / 0.0 ? x : 0.0; }
"""


def translated(target: str) -> Compiled:
    return transpile(load_glsl_text(TEXT, "case.glsl").module, target, "case", keep=True)


@pytest.mark.parametrize("target", ["wgsl", "hlsl", "glsl-330", "glsl-es-300", "metal"])
def test_they_are_accepted(target: str, assert_compiles: Callable[[Source], None]) -> None:
    text = next(content for name, content in translated(target).files.items() if not name.endswith(".json"))
    assert_compiles(Source(text, target, "library", name="case"))


def test_they_are_reported_where_they_become_other_numbers() -> None:
    messages = [warning.message for warning in translated("wgsl").warnings]
    assert "log2(-8.9) has no value: the logarithm of 0 or less" in messages
    assert "a constant divided by 0 is infinite" in messages
    assert len(messages) == 17
    assert not translated("glsl-330").warnings


def test_infinity_is_more_than_every_number(backend: Callable[[str], Backend]) -> None:
    check_results(TEXT, 1e30, backend, [1e30])


def test_an_integer_divided_by_0_is_itself_in_wgsl() -> None:
    text = next(iter(translated("wgsl").files.values()))
    assert "const WHOLE: i32 = 7 / 1;" in text
    assert "const SHIFTED: i32 = 1 << 1u;" in text
