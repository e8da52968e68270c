"""A source file with every construct of the language, and its module."""

from __future__ import annotations

from typing import Any

from sssgen.ir import nodes as ir
from sssgen.lang.check.module_checker import check
from sssgen.lang.syntax.parser import parse

SAMPLE = """\
/** What a body is made of. */
struct Body { vec3 color; thickness depth; float rings[2]; };
const int STEPS = 4;
const vec3 RED = vec3(1.0, 0.0, 0.0);
/// How much is lost on the way.
///   "Beer" \\ Lambert
uniform float density : hint_range(0.0, 10.0, 0.5), unit("1/m"), alias("sigma") = 0.5;
uniform mat2 turn = mat2(0.0, 1.0, -1.0, 0.0);
uniform bvec2 sides = bvec2(true, false);
uniform sampler2D map : holds(thickness), default_white;
float body_distance(world_position p);

void step_into(inout world_position p, in world_direction d, out bool hit) {
    float r = body_distance(p);
    p += r * d;
    hit = r < 1e-4;
}

/** What is left.
 *
 *  formula: exp(-density * d)
 */
transmittance left(world_position p, world_direction V, uv_position uv) {
    Body body = Body(RED, thickness(texture(map, uv).r), float[2](0.0, -0.0));
    uint bits = (floatBitsToUint(body.depth) & 0xffu) >> 1u;
    for (int i = 0; i < STEPS; i++) {
        bool hit;
        step_into(p, V, hit);
        if (hit) { body.rings[i % 2] -= 1.0; break; } else if (!hit && bits != 0u) continue; else discard;
    }
    int n = 3;
    while (n > 0) { n = n - 1; body.color.zx *= turn; }
    return transmittance(sides.x ? exp(-density * body.depth) : float(n));
}
"""


def of_source(source: str) -> ir.Module:
    return check(parse(source, "sample.sss"), source)


SAMPLE_MODULE = of_source(SAMPLE)


def exact(value: Any) -> Any:
    """A value with the classes of its parts, and floats as text, because `==` on tuples ignores these differences."""
    if isinstance(value, tuple):
        return (type(value).__name__, *map(exact, value))
    return (type(value).__name__, repr(value))
