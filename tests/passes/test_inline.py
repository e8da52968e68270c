"""Calls of functions that are one expression give way to it, where nothing is computed twice."""

from __future__ import annotations

import pytest

from pass_cases import assert_is, module_of
from sssgen.passes.inline import inline

FUNCTIONS = """
    uniform sampler2D map; uniform float k = 1.0;
    float square(float x) { return x * x; }
    float next(float x) { return x + k; }
    float both(float x) { return square(x + 1.0) + next(x); }
    float choose(float x, float y) { return x > 0.0 ? y : 0.0; }
    vec4 read(sampler2D t, vec2 uv) { return texture(t, uv); }
    float put(float x, out float y) { y = x; return x; }
    float longer(float x) { float y = x; return y; }
    """


def becomes(before: str, after: str, insist: bool = False, functions: str = FUNCTIONS) -> None:
    module = inline(module_of(FUNCTIONS + before), lambda function: function.name != "f", insist)
    assert_is(module, functions + after)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("square(a)", "a * a"),
        ("square(2.0)", "2.0 * 2.0"),
        ("square(uv.x)", "uv.x * uv.x"),
        ("square(k)", "k * k"),
        ("square(a + 1.0)", "square(a + 1.0)"),
        ("next(a + 1.0)", "a + 1.0 + k"),
        ("next(next(a))", "a + k + k"),
        ("read(map, uv * 2.0).x", "texture(map, uv * 2.0).x"),
        ("choose(a, sin(a))", "a > 0.0 ? sin(a) : 0.0"),
        ("choose(a, texture(map, uv).x)", "choose(a, texture(map, uv).x)"),
        ("longer(a)", "longer(a)"),
    ],
)
def test_arguments(before: str, after: str) -> None:
    functions = FUNCTIONS.replace("next(x); }", "(x + k); }")
    head = "float f(float a, vec2 uv) { return "
    becomes(f"{head}{before}; }}", f"{head}{after}; }}", functions=functions)


def test_arguments_are_held_where_that_is_insisted_on() -> None:
    becomes(
        """
        float f(float a, vec2 uv) {
            float x = square(a + 1.0);
            if (square(a + 2.0) > x) { x += square(square(uv.x + a)); }
            for (int i = 0; i < 4 && x < square(a + 3.0); i++) { x += both(a); }
            return x;
        }
        """,
        """
        float f(float a, vec2 uv) {
            float x_2 = a + 1.0;
            float x = x_2 * x_2;
            float x_3 = a + 2.0;
            if (x_3 * x_3 > x) { float x_4 = uv.x + a; float x_5 = x_4 * x_4; x += x_5 * x_5; }
            for (int i = 0; i < 4 && x < square(a + 3.0); i++) { float x_6 = a + 1.0; x += x_6 * x_6 + (a + k); }
            return x;
        }
        """,
        insist=True,
        functions=FUNCTIONS.replace(
            "return square(x + 1.0) + next(x);", "float x_2 = x + 1.0; return x_2 * x_2 + (x + k);"
        ),
    )


def test_nothing_is_moved_past_an_effect() -> None:
    before = "float f(float a) { float y = 0.0; float z = next(put(a, y)) + square(y + 1.0); return z; }"
    becomes(before, before, insist=True, functions=FUNCTIONS.replace(
        "return square(x + 1.0) + next(x);", "float x_2 = x + 1.0; return x_2 * x_2 + (x + k);"))  # fmt: skip


def test_nothing_to_inline_keeps_the_module() -> None:
    module = module_of(FUNCTIONS)
    assert inline(module, lambda function: False) is module
    assert inline(module, lambda function: function.name == "longer") is module
