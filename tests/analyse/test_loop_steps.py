"""Steps of loops that a target cannot have in a loop's head, on every back end."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from results_of_glsl import check_results
from sssgen.run.backends import Backend

CASES = [
    ("float f(float x) { ivec2 y = ivec2(0);"
     " for (int u = 0; u < 3; ++u, y[u & 1] = u) { if (u == 1) continue; x += 1.0; }"
     " return x * 100.0 + float(y.x * 10 + y.y); }", 1.0, 323.0),
    ("float f(float x) { vec3 y = vec3(0.0); int u = 0;"
     " for (; u < 4; y[u % 3] = x) { u++; if (x > 2.0) continue; x += 1.0; }"
     " return y.x * 100.0 + y.y * 10.0 + y.z; }", 1.0, 333.0),
    ("float f(float x) { mat2 m = mat2(0.0); for (int i = 0; i < 5; i++, m[i & 1].yx = vec2(i, x)) x += 0.5;"
     " return m[0].y * 10.0 + m[1].y; }", 1.0, 45.0),
]  # fmt: skip


@pytest.mark.parametrize(("text", "argument", "expected"), CASES)
def test_steps_that_store_into_a_part(
    backend: Callable[[str], Backend], text: str, argument: float, expected: float
) -> None:
    check_results(text, expected, backend, (argument,))
