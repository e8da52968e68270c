"""Unused code of a material is removed; code with an effect is not."""

from __future__ import annotations

import pytest

from pass_cases import assert_is, key, module_of
from sssgen.ir.verify import verify
from sssgen.passes.prune import prune


def becomes(before: str, after: str, *roots: str) -> None:
    module = module_of(before)
    result = prune(module, [key(module, root) for root in roots or ("f",)])
    assert_is(result, after)
    assert verify(result, linked=True) == []
    again = prune(result, [key(result, root) for root in roots or ("f",)])
    assert all(one is other for one, other in zip(again, result, strict=True)), "pruning twice changes nothing"


def test_unreachable_declarations_are_removed() -> None:
    becomes(
        """
        struct Used { float a; }; struct Unused { float a; }; struct Outer { Used inner; };
        uniform float depth = 1.0; uniform float gone = 1.0; uniform sampler2D map;
        const float A = 1.0; const float B = A * 2.0; const float C = B;
        float dead(float x) { return x * gone * C; }
        float g(float x) { Outer o; o.inner.a = x; return o.inner.a * B; }
        float f(float x) { return g(x) * depth; }
        """,
        """
        struct Used { float a; }; struct Outer { Used inner; };
        uniform float depth = 1.0;
        const float A = 1.0; const float B = A * 2.0;
        float g(float x) { Outer o; o.inner.a = x; return o.inner.a * B; }
        float f(float x) { return g(x) * depth; }
        """,
    )


def test_chains_of_unused_variables_are_removed() -> None:
    becomes(
        """
        uniform float k = 1.0;
        float helper(float x) { return x * k; }
        float f(float x) {
            float a = helper(x); float b = a * 2.0; b += a; vec3 c = vec3(b); c.x = a; float d;
            return x;
        }
        """,
        "float f(float x) { return x; }",
    )


def test_self_referencing_unused_variables_are_removed() -> None:
    becomes(
        "float f(float x) { float n = 0.0; for (int i = 0; i < 4; i++) { n = n + x; if (n > 2.0) { break; } } "
        "return x; }",
        "float f(float x) { return x; }",
    )


def test_loops_keep_their_counters_and_jumps() -> None:
    source = """
        float f(float x) {
            float n = x;
            for (int i = 0; i < 4; i++) { if (n > 2.0) { break; } if (n < 0.0) { continue; } n += 1.0; }
            int j = 0;
            while (j < 4) { n *= 2.0; j++; }
            return n;
        }
        """
    becomes(source, source)


def test_a_dead_loop_is_removed_though_another_uses_its_names() -> None:
    becomes(
        """
        float f(float x) {
            float n = 0.0; float m = 0.0;
            for (int i = 0; i < 4; i++) { float k = x; n += k; }
            for (int i = 0; i < 3; i++) { float k = x; m += k; }
            return m;
        }
        """,
        """
        float f(float x) {
            float m = 0.0;
            for (int i = 0; i < 3; i++) { float k = x; m += k; }
            return m;
        }
        """,
    )


def test_unreachable_statements_are_removed() -> None:
    becomes(
        """
        float f(float x) {
            for (int i = 0; i < 4; i++) { if (x > 0.0) { continue; x = 1.0; } else { break; } x = 2.0; }
            if (x > 0.0) { return x; x = 2.0; } else { return 1.0; }
            x = 3.0;
            return x;
        }
        """,
        """
        float f(float x) {
            if (x > 0.0) { return x; } else { return 1.0; }
        }
        """,
    )


def test_empty_arms() -> None:
    becomes(
        """
        float f(float x) {
            float n = 0.0; float dead = 0.0;
            if (x > 1.0) { dead = 1.0; }
            if (x > 2.0) { dead = 1.0; } else { n = 1.0; }
            if (x == 3.0) { } else { n = 2.0; }
            if (!(x > 4.0)) { } else { n = 3.0; }
            return n;
        }
        """,
        """
        float f(float x) {
            float n = 0.0;
            if (!(x > 2.0)) { n = 1.0; }
            if (x != 3.0) { n = 2.0; }
            if (x > 4.0) { n = 3.0; }
            return n;
        }
        """,
    )


def test_out_parameters_are_effects() -> None:
    becomes(
        """
        float g(float x, out float y) { y = x; return x; }
        float h(inout float y) { y += 1.0; return y; }
        void f(inout vec3 c, out float d, float e) {
            float a; float unread = g(c.x, a); float b; float read = g(c.y, b); float gone = h(a);
            c.x = b; d = 1.0; e = 2.0;
        }
        """,
        """
        float g(float x, out float y) { y = x; return x; }
        void f(inout vec3 c, out float d, float e) {
            float b; float read = g(c.y, b);
            c.x = b; d = 1.0;
        }
        """,
    )


def test_a_call_that_discards_stays() -> None:
    becomes(
        """
        float cut(float x) { if (x < 0.0) { discard; } return x; }
        float deeper(float x) { return cut(x); }
        float f(float x) { float unused = deeper(x); float gone = x; return x; }
        """,
        """
        float cut(float x) { if (x < 0.0) { discard; } return x; }
        float deeper(float x) { return cut(x); }
        float f(float x) { float unused = deeper(x); return x; }
        """,
    )


def test_a_return_after_a_discard_is_kept() -> None:
    source = "float f(float x) { discard; return x; }"
    becomes(source, source)


def test_callees_are_first_and_the_order_is_stable() -> None:
    module = module_of(
        """
        float c(float x);
        float a(float x) { return c(x); }
        float b(float x) { return x; }
        float d(float x) { return b(x); }
        float f(float x) { return a(x) + d(x) + b(x); }
        """
    )
    bound = module_of("float c(float x) { return x; }").functions[0]
    shuffled = module._replace(functions=(*module.functions[1:], bound))
    result = prune(shuffled, [key(shuffled, "f")])
    assert [function.name for function in result.functions] == ["c", "a", "b", "d", "f"]
    assert verify(result, linked=True) == []


def test_a_run_without_changes_keeps_every_node() -> None:
    module = module_of("uniform float k = 1.0; float f(float x) { float y = x; if (x > 0.0) { y = k; } return y; }")
    result = prune(module, [key(module, "f")])
    assert result.functions is module.functions and result.uniforms is module.uniforms


def test_an_unknown_root() -> None:
    with pytest.raises(KeyError):
        prune(module_of("float f(float x) { return x; }"), ["g(float)"])
