"""Random programs that read uniforms and textures, for the properties of passes."""

from __future__ import annotations

from random import Random

from hypothesis import assume, reject

from random_programs import Programs
from sssgen.ir.nodes import Module
from sssgen.ir.verify import verify
from sssgen.lang.check.module_checker import check
from sssgen.lang.syntax.parser import parse
from sssgen.support.diagnostics import SssgenError

UNIFORMS = """
uniform sampler2D map; uniform float level = 2.0; uniform int mode = 1; uniform vec3 tint = vec3(0.5, 1.0, 2.0);
"""
HELPERS = """
float look(float x) { return texture(map, vec2(x, level)).y; }
float shine(vec2 at, inout float c) { if (level > 0.5) { c += texture(map, at).x; } return c * tint.y; }
float twice(float x) { return x + x * level; }
float pick(float x, float y) { return x > 1.0 ? y : 0.5; }
"""


class ShadedPrograms(Programs):
    """Random programs that read uniforms and textures too."""

    def program(self) -> str:
        text = super().program()
        index = text.index("float f(")
        return UNIFORMS + text[:index] + HELPERS + text[index:]

    def number(self, depth: int = 2) -> str:
        if depth and self.chance(30):
            inner = [super(ShadedPrograms, self).number(depth - 1) for _ in range(2)]
            return self.random.choice(
                [
                    f"texture(map, vec2({inner[0]}, {inner[1]})).x", f"look({inner[0]})", f"twice({inner[0]})",
                    f"pick({inner[0]}, {inner[1]})", "level", "tint.z", f"texture(map, v.xy + {inner[0]}).y",
                    f"shine(vec2({inner[0]}), {self.random.choice(self.floats)})",
                ]
            )  # fmt: skip
        return super().number(depth)

    def condition(self, depth: int = 2) -> str:
        if self.chance(25):
            return self.random.choice(["level > 1.0", "mode == 1", "tint.x < 0.25", "TWO > 1"])
        return super().condition(depth)


def module_for(seed: int, discards: bool) -> Module:
    """A random module with the function `f` of `Programs`; for use inside a property test."""
    source = ShadedPrograms(Random(seed), discards).program()
    try:
        module = check(parse(source, "random.sss"), source)
    except SssgenError:  # an index is outside its array
        reject()
    assume(not verify(module))
    return module
