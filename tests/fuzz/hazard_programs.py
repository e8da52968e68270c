"""Random programs full of operations with domains, whose guarded forms must compute finite numbers for all inputs.

The grammar is that of `shader_programs`, with other rules. A value may be anything that an operation gives, or is kept
in a range by a bound, a condition or a loop, which is what the range pass draws its proofs from. {LIT} is a literal and
{SMALL} one above 0; a leaf is always a variable, so that no expression is constant. Two holes with the same digit are
filled alike.
"""

from __future__ import annotations

import re
from random import Random

from shader_programs import ShaderPrograms

PARAMETERS = "float a, float b, vec2 p, vec3 d, vec3 u, vec4 e, mat2 k2, mat3 k3, mat4 k4, int n, uint h"
TYPES = ("float", "float", "vec2", "vec3", "vec3", "vec4", "mat2", "mat3", "mat4", "int", "uint")
NAMES = "a, b, p, d, u, e, k2, k3, k4, n, h"

HELPERS = """
struct Item { float size; vec3 at; mat2 turn; float list[2]; };
const float LEAST = 1.0e-6;
const float STEPS[3] = float[3](1.0e-4, 0.5, 1.0e12);

float over(float x, float y) { return x / y; }
float kept(float x) { return clamp(x, -1.0e4, 1.0e4); }
float length_over(vec3 x, float y) { if (abs(y) > 1.0e-3) return length(x) / y; return 0.0; }
vec3 towards(vec3 x, vec3 y) { return normalize(y - x) * distance(x, y); }
mat2 turned(float x, float y) { return mat2(x, y, -y, x) / (x * x + y * y); }
float mean(float x[3], int count) {
    float sum = 0.0;
    for (int i = 0; i < (count & 15); i++) sum += x[i % 3];
    return sum / float(count);
}
Item item_of(float x, vec3 y, int i) {
    Item made;
    made.size = x; made.at = y / x;
    made.turn = mat2(x, 1.0, float(i), x * x);
    made.list[0] = x; made.list[1] = sqrt(x);
    return made;
}
void split(float x, out float whole, out float rest) { whole = floor(x); rest = x - whole; rest = 1.0 / rest; }
float grow(inout vec3 x, inout float y, float by) {
    x *= by;
    y += dot(x, x); if (by < 0.0) return x.y;
    x = reflect(x, x);
    return y * by;
}
"""

RULES: dict[str, list[str]] = {
    "float": [
        "({float} + {float})", "({float} - {float})", "({float} * {float})", "({float} / {float})", "({float} + {LIT})",
        "({float} * {LIT})", "({LIT} / {float})", "({float} / {SMALL})", "-({float})", "({float} - {LIT})",
        "({FLOAT:1} * {FLOAT:1} + {SMALL})", "(1.0 / ({FLOAT:1} * {FLOAT:1} + {SMALL}))",
        "({float} * {float} - {float} * {float})",
        "abs({float})", "min({float}, {LIT})", "max({float}, {LIT})", "max({float}, {float})",
        "(abs({float}) + {SMALL})",
        "clamp({float}, -{SMALL}, {SMALL})", "clamp({float}, 0.0, 1.0)", "clamp({float}, {float}, {float})",
        "fract({float})",
        "sqrt({float})", "sqrt(abs({float}))", "sqrt(1.0 - {FLOAT:1} * {FLOAT:1})", "inversesqrt({float})",
        "inversesqrt(abs({float}) + {SMALL})",
        "log({float})", "log2({float})", "log(abs({float}) + {SMALL})", "exp({float})", "exp2({float})",
        "exp(-abs({float}))", "exp(-({float}) / {SMALL})",
        "pow({float}, {float})", "pow(abs({float}), {float})", "pow({float}, {LIT})",
        "pow(clamp({float}, 0.0, 1.0), {float})", "pow(abs({float}) + {SMALL}, {LIT})",
        "sin({float})", "cos({float})", "tan({float})", "asin({float})", "acos({float})", "atan({float})",
        "atan({float}, {float})",
        "asin(clamp({float}, -1.0, 1.0))", "acos(dot(normalize({vec3}), normalize({vec3})))",
        "sinh({float})", "cosh({float})", "tanh({float})", "asinh({float})", "acosh({float})", "atanh({float})",
        "mod({float}, {float})", "mod({float}, {SMALL})", "fmod({float}, {float})", "floor({float})",
        "round({float})", "sign({float})", "trunc({float})",
        "step({float}, {float})", "smoothstep({float}, {float}, {float})",
        "smoothstep({FLOAT:1}, {FLOAT:1} + {SMALL}, {float})", "smoothstep({LIT}, {LIT}, {float})",
        "mix({float}, {float}, {float})", "mix({float}, {float}, clamp({float}, 0.0, 1.0))",
        "mix({float}, {LIT}, {float})", "fma({float}, {float}, {float})",
        "radians({float})", "degrees({float})", "saturate({float})",
        "length({vec2})", "length({vec3})", "distance({vec3}, {vec3})", "distance({vec4}, {vec4})",
        "dot({vec3}, {vec3})", "dot({VEC3:1}, {VEC3:1})", "dot({vec4}, {vec4})",
        "(1.0 / length({vec3}))", "(1.0 / dot({VEC3:1}, {VEC3:1}))", "reflect({float}, {float})",
        "refract({float}, {float}, {float})", "faceforward({float}, {float}, {float})",
        "normalize({vec3}).x", "normalize({float})", "length({float})", "distance({float}, {float})",
        "{vec2}.y", "{vec3}.x", "{vec4}.w", "{vec3}[{int}]", "{mat2}[1].x", "{mat3}[{int}].z", "{mat4}[2][{int}]",
        "list[{int}]", "list[{INT} & 3]", "STEPS[{int}]",
        "determinant({mat2})", "determinant({mat3})", "determinant({mat4})", "(1.0 / determinant({mat3}))",
        "({bool} ? {float} : {float})", "({FLOAT:1} > {SMALL} ? 1.0 / {FLOAT:1} : {float})",
        "({FLOAT:1} > {LIT} ? sqrt({FLOAT:1}) : {float})",
        "({FLOAT:1} != 0.0 ? {float} / {FLOAT:1} : 0.0)", "(abs({FLOAT:1}) < {SMALL} ? exp({FLOAT:1}) : {FLOAT:1})",
        "({FLOAT:1} < {FLOAT:2} ? {float} / ({FLOAT:2} - {FLOAT:1}) : {float})",
        "({FLOAT:1} < {FLOAT:2} ? sqrt({FLOAT:2} - {FLOAT:1}) : {float})",
        "(length({VEC3:1}) > {SMALL} ? {VEC3:1} / length({VEC3:1}) : {vec3}).y",
        "(dot({VEC3:1}, {VEC3:1}) > {SMALL} ? inversesqrt(dot({VEC3:1}, {VEC3:1})) : {float})",
        "(length({VEC3:1}) <= {SMALL} ? 1.0 / ({SMALL} - {VEC3:1}.x) : {float})",
        "float({int})", "float({uint})", "({float} / float({int}))", "({float} / float({uint}))",
        "(1.0 / float({INT:1} * {INT:1} + 1))", "float({bool})",
        "intBitsToFloat({int})", "uintBitsToFloat({uint})", "intBitsToFloat(floatBitsToInt({float}) + {int})",
        "uintBitsToFloat(floatBitsToUint({float}) & {uint})",
        "unpackHalf2x16({uint}).x", "unpackSnorm2x16({uint}).y", "unpackUnorm4x8({uint}).z", "ldexp({float}, {int})",
        "(ldexp({float}, {int} & 63) * {float})",
        "over({float}, {float})", "kept({float})", "length_over({vec3}, {float})",
        "mean(float[3]({float}, {float}, {float}), {int})", "aid({float}, {vec3}, {mat2})",
        "{Item}.size", "{Item}.at.y", "{Item}.turn[1].y", "item.list[{INT} & 1]", "item.size", "grow(v, t, {float})",
    ],
    "vec2": [
        "vec2({float}, {float})", "vec2({float})", "({vec2} + {vec2})", "({vec2} - {float})", "({vec2} * {vec2})",
        "({vec2} * {float})", "({vec2} / {vec2})", "({vec2} / {float})",
        "({float} / {vec2})", "({mat2} * {vec2})", "({vec2} * {mat2})", "{vec3}.xz", "{vec4}.wy", "{vec2}.yx",
        "normalize({vec2})", "sqrt({vec2})", "pow({vec2}, {vec2})", "mod({vec2}, {float})",
        "log({vec2})", "exp({vec2})", "mix({vec2}, {vec2}, {float})", "mix({vec2}, {vec2}, {bvec2})",
        "clamp({vec2}, -{SMALL}, {SMALL})", "{mat2}[1]", "reflect({vec2}, {vec2})",
        "reflect({vec2}, normalize({vec2}))", "refract({vec2}, {vec2}, {float})",
        "smoothstep({vec2}, {vec2}, {vec2})", "smoothstep({float}, {float}, {vec2})", "atan({vec2}, {vec2})",
        "faceforward({vec2}, {vec2}, {vec2})", "vec2({ivec2})", "intBitsToFloat({ivec2})", "unpackHalf2x16({uint})",
        "inversesqrt({vec2})", "acos({vec2})", "({bool} ? {vec2} : {vec2})",
        "(inverse({mat2}) * {vec2})", "abs({vec2})", "max({vec2}, {SMALL})", "tan({vec2})", "ldexp({vec2}, {ivec2})",
    ],
    "vec3": [
        "vec3({float}, {float}, {float})", "vec3({vec2}, {float})", "vec3({float})", "({vec3} + {vec3})",
        "({vec3} - {vec3})", "({vec3} * {vec3})", "({vec3} * {float})", "({vec3} * {LIT})",
        "({vec3} / {vec3})", "({vec3} / {float})", "({vec3} / {SMALL})", "cross({vec3}, {vec3})",
        "cross({VEC3:1}, {VEC3:1})", "normalize({vec3})", "normalize({vec3} - {vec3})",
        "normalize(cross({vec3}, {vec3}))", "{vec4}.yzw", "{vec3}.zxy", "{vec3}.xxy",
        "({mat3} * {vec3})", "({vec3} * {mat3})", "(inverse({mat3}) * {vec3})", "{mat3}[2]", "{mat3}[{int}]",
        "reflect({vec3}, {vec3})", "reflect({vec3}, normalize({vec3}))", "refract({vec3}, {vec3}, {float})",
        "refract(normalize({vec3}), normalize({vec3}), {float})",
        "refract({vec3}, {vec3}, clamp({float}, 0.0, {SMALL}))", "faceforward({vec3}, {vec3}, {vec3})",
        "mix({vec3}, {vec3}, {vec3})",
        "pow({vec3}, vec3({SMALL}))", "pow({vec3}, {vec3})", "exp({vec3})", "sqrt({vec3})", "log2({vec3})",
        "mod({vec3}, {SMALL})", "towards({vec3}, {vec3})", "{Item}.at", "clamp({vec3}, {LIT}, {LIT})",
        "clamp({vec3}, -{SMALL}, {SMALL})", "clamp({vec3}, {vec3}, {vec3})", "fract({vec3})",
        "smoothstep({float}, {float}, {vec3})", "max({vec3}, {SMALL})", "abs({vec3})", "sin({vec3})",
        "({bool} ? {vec3} : {vec3})", "asin({vec3})",
        "(dot({vec3}, {VEC3:1}) * {VEC3:1} / dot({VEC3:1}, {VEC3:1}))",
    ],
    "vec4": [
        "vec4({vec2}, {vec2})", "vec4({vec3}, {float})", "vec4({float})", "({vec4} - {vec4})", "({vec4} * {vec4})",
        "({vec4} / {float})", "({vec4} / {vec4})", "{vec3}.xyzx", "normalize({vec4})",
        "({mat4} * {vec4})", "({vec4} * {mat4})", "(inverse({mat4}) * {vec4})", "({vec4} / {vec4}.w)",
        "outerProduct({vec4}, {vec4})[{int}]", "unpackSnorm4x8({uint})", "atan({vec4}, {vec4})", "atanh({vec4})",
        "acosh({vec4})",
        "asinh({vec4})", "sinh({vec4})", "cosh({vec4})", "tanh({vec4})", "fma({vec4}, {vec4}, {vec4})",
        "mix({vec4}, {vec4}, {float})", "clamp({vec4}, -{SMALL}, {SMALL})", "{mat4}[{int}]",
    ],
    "mat2": [
        "mat2({vec2}, {vec2})", "mat2({float})", "mat2({mat3})", "({mat2} * {mat2})", "({mat2} * {float})",
        "({float} * {mat2})", "({mat2} / {float})", "({float} / {mat2})", "({mat2} / {mat2})", "({mat2} + {mat2})",
        "({mat2} - {float})", "(-{mat2})", "inverse({mat2})",
        "inverse(mat2({float} / {float}, {float}, {float}, {LIT}))", "transpose({mat2})",
        "outerProduct({vec2}, {vec2})", "matrixCompMult({mat2}, {mat2})",
        "inverse({mat2} + mat2({SMALL}))", "turned({float}, {float})", "{Item}.turn", "({bool} ? {mat2} : {mat2})",
        "mat2(clamp({vec2}, -{SMALL}, {SMALL}), {vec2})",
    ],
    "mat3": [
        "mat3({vec3}, {vec3}, {vec3})", "mat3({float})", "mat3({mat2})", "mat3({mat4})", "({mat3} * {mat3})",
        "({mat3} * {LIT})", "({mat3} / {float})", "({mat3} / {mat3})", "({mat3} - {mat3})", "inverse({mat3})",
        "transpose({mat3})", "outerProduct({vec3}, {vec3})", "matrixCompMult({mat3}, {mat3})",
        "(inverse({mat3}) * {mat3})", "mat3(normalize({vec3}), normalize({vec3}), normalize({vec3}))",
    ],
    "mat4": [
        "mat4({vec4}, {vec4}, {vec4}, {vec4})", "mat4({float})", "mat4({mat3})", "({mat4} * {mat4})",
        "({mat4} * {LIT})", "({mat4} / {float})", "({float} / {mat4})", "({mat4} + {mat4})", "inverse({mat4})",
        "transpose({mat4})", "outerProduct({vec4}, {vec4})", "matrixCompMult({mat4}, {mat4})",
    ],
    "int": [
        "({int} + {int})", "({int} - {int})", "({int} * {int})", "({int} / {int})", "({int} % {int})",
        "({int} & {int})", "({int} ^ {int})", "({int} << {int})", "({int} >> {uint})", "(~{int})", "-({int})",
        "abs({int})", "sign({int})", "min({int}, {int})", "clamp({int}, {int}, {int})", "clamp({int}, -3, 9)",
        "({int} & 15)", "int({float})", "int({uint})", "({bool} ? {int} : {int})", "{ivec2}.y",
        "floatBitsToInt({float})",
        "bitfieldExtract({int}, 3, 5)", "findMSB({int})", "bitCount({int})",
    ],
    "uint": [
        "({uint} + {uint})", "({uint} * {uint})", "({uint} / {uint})", "({uint} % {uint})", "({uint} >> {uint})",
        "({uint} << {int})", "({uint} ^ {uint})", "uint({int})", "uint({float})", "uint(abs({float}))",
        "floatBitsToUint({float})", "packHalf2x16({vec2})", "packUnorm4x8({vec4})", "({uint} & 0xffu)",
    ],
    "ivec2": ["ivec2({int}, {int})", "({ivec2} + {ivec2})", "({ivec2} / {ivec2})", "ivec2({vec2})",
        "floatBitsToInt({vec2})", "({ivec2} % {int})", "abs({ivec2})"],
    "bool": [
        "({float} < {float})", "({float} >= {LIT})", "({float} == {float})", "({int} < {int})", "({int} == {int})",
        "({uint} > {uint})", "({bool} && {bool})", "({bool} || {bool})", "!({bool})", "any({bvec2})",
        "(abs({FLOAT}) > {SMALL})", "isnan({float})", "isinf({float})", "({vec2} == {vec2})",
    ],
    "bvec2": ["bvec2({bool}, {bool})", "lessThan({vec2}, {vec2})",
        "greaterThanEqual({vec2}, vec2({float}))", "equal({ivec2}, {ivec2})"],
    "Item": ["Item({float}, {vec3}, {mat2}, float[2]({float}, {float}))", "item_of({float}, {vec3}, {int})", "item"],
}  # fmt: skip

_SIZES = ["1.0e-37", "1.0e-30", "1.0e-20", "1.0e-12", "1.0e-6", "1.0e-3", "0.5", "1.0", "1.5", "3.0", "87.0", "1.0e4",
          "1.0e6", "1.0e10", "1.0e15", "1.0e19", "1.8e19", "1.0e20", "1.0e30", "1.0e37", "2.0e38"]  # fmt: skip
SMALL = [*_SIZES, *["1.0e-6", "0.5", "1.0", "3.0", "100.0"] * 3]
LIT = [*SMALL, "0.0", *(f"(-{size})" for size in _SIZES)]

START = """\
    float s = a * 0.5;
    float t = b;
    vec3 v = d;
    vec4 q = e;
    mat2 m2 = k2;
    mat3 m3 = k3;
    int i = n;
    uint w = h;
    float list[4] = float[4](a, b, 0.5, d.x);
    Item item = Item(a, u, k2, float[2](b, 1.0));
    one = a;
    three = k2;
"""
VARIABLES = [("a", "float"), ("b", "float"), ("p", "vec2"), ("d", "vec3"), ("u", "vec3"), ("e", "vec4"), ("k2", "mat2"),
         ("k3", "mat3"), ("k4", "mat4"), ("n", "int"), ("h", "uint"), ("s", "float"), ("t", "float"), ("v", "vec3"),
         ("q", "vec4"), ("m2", "mat2"), ("m3", "mat3"), ("i", "int"), ("w", "uint"), ("item", "Item"),
         ("two", "vec3")]  # fmt: skip
PLACES = [("float", "s"), ("float", "t"), ("vec3", "v"), ("vec4", "q"), ("mat2", "m2"), ("mat3", "m3"), ("int", "i"),
          ("uint", "w"), ("Item", "item"), ("vec2", "v.xy"), ("vec2", "v.zx"), ("float", "q.w"), ("float", "q[{int}]"),
          ("vec2", "m2[{int}]"), ("float", "m2[1][{INT} & 1]"), ("vec3", "m3[0]"), ("float", "list[{int}]"),
          ("float", "list[2]"), ("float", "item.size"), ("vec3", "item.at"), ("mat2", "item.turn"),
          ("vec2", "item.turn[{int}]"), ("float", "item.list[{int}]"), ("float", "one"), ("vec3", "two"),
          ("mat2", "three"), ("vec2", "two.zx")]  # fmt: skip
CHANGES = [
    "s += {float};", "s -= {float};", "s *= {float};", "s /= {float};", "t *= {LIT};", "t += abs({float});",
    "t /= {SMALL};", "s = s * s;",
    "v += {vec3};", "v *= {vec3};", "v /= {float};", "v *= {mat3};", "q /= {vec4};", "q *= {mat4};",
    "q.xw *= {float};", "m2 *= {float};",
    "m2 *= {mat2};", "m2 /= {float};", "m2 += {mat2};", "m2 /= {mat2};", "m3 *= {mat3};", "m3 /= {float};",
    "m3 -= {float};", "m2[1] *= {float};",
    "m3[0] /= {float};", "m2 = m2 * m2;", "m3 = inverse(m3);", "i += {int};", "i *= {int};", "i /= {int};",
    "w >>= {uint};", "w *= {uint};", "i++;",
    "list[{int}] *= {float};", "item.size /= {float};", "item.at *= {vec3};", "item.turn *= {LIT};",
    "item.turn = inverse(item.turn);",
    "split({float}, s, t);", "split({float}, v.x, list[1]);", "s = grow(v, t, {float});",
    "t = grow(item.at, item.size, {float});", "v = normalize(v);",
]  # fmt: skip
COUNTS = ["int {0} = 0; {0} < 3; {0}++", "int {0} = 0; {0} < 40; {0}++", "int {0} = 0; {0} < (n & 15); {0}++",
         "int {0} = 1; {0} <= 9; {0} += 3", "int {0} = 5; {0} > 0; {0}--",
          "uint {0} = 0u; {0} < (h & 7u); {0}++"]  # fmt: skip


SIZED = ("float", "vec2", "vec3", "vec4", "mat2", "mat3", "mat4")
SCALES = ["1.0e-37", "1.0e-30", "1.0e-25", "1.0e-20", "1.0e-12", "1.0e-6", "1.0e-3", "1.0e3", "1.0e4", "1.0e6",
          "1.0e10", "1.0e12", "1.0e13", "1.0e15", "1.0e20", "1.0e25", "1.0e30", "1.0e32", "1.9e32"]  # fmt: skip
LITERALS = {"LIT": LIT, "SMALL": SMALL}
OUTPUTS = "out float one, inout vec3 two, out mat2 three"
PACKED = {"float": "vec4(result)", "vec2": "vec4(result, result)", "vec3": "vec4(result, 0.0)", "vec4": "result",
          "mat2": "vec4(result[0], result[1])"}  # fmt: skip
"""The type of a result → what shows it."""
LEAVES = {"bool": "(n > 2)", "ivec2": "ivec2(n, i)", "bvec2": "bvec2(n > 2, b < 1.0)"}
AID_VARIABLES = [("x", "float"), ("y", "vec3"), ("z", "mat2")]
AID_LEAVES = {
    "int": "int(x)", "uint": "uint(y.x)", "vec2": "y.xy", "vec4": "vec4(y, x)", "mat3": "mat3(z)", "mat4": "mat4(z)",
    "bool": "(x > 1.0)", "bvec2": "bvec2(x > 1.0, y.x < 2.0)", "ivec2": "ivec2(y.xy)",
    "Item": "Item(x, y, z, float[2](x, 1.0))",
}  # fmt: skip
AID_RULES = {
    type_: [rule for rule in rules if not re.search(r"\b(list\[|item\b|grow|aid)", rule)]
    for type_, rules in RULES.items()
}
"""Without those that name a variable of the program."""


class HazardPrograms(ShaderPrograms):
    """Makes the text of functions of `PARAMETERS`, which stand behind `HELPERS`."""

    rules, changes, counts = RULES, CHANGES, COUNTS

    def __init__(self, random: Random, size: int = 3) -> None:
        super().__init__(random, size)
        self.variables, self.places = list(VARIABLES), list(PLACES)
        self.leaves = LEAVES
        self.aid = ""

    def program(self, name: str) -> str:
        """A helper, the program `name_inner`, and `name`, a function that packs all that the program gives."""
        self.aid = aid = f"{name}_aid"
        text = f"float {aid}(float x, vec3 y, mat2 z) {{ return {self.of_aid()}; }}\n"
        self.result = self.random.choice(list(PACKED))
        body = self.block(1, self.size)
        body += f"    one = {self.filled('{float} + t', 2)};\n    two = {self.filled('{vec3} + v', 2)};\n"
        body += f"    three = {self.filled('{mat2} + item.turn', 2)};\n    return {self.expr(self.result)};\n"
        if f"{aid}(" not in body:
            text = ""
        body = _used(START, body) + body
        text += f"{self.result} {name}_inner({PARAMETERS}, {OUTPUTS}) {{\n{body}}}\n"
        text += f"mat4 {name}({PARAMETERS}) {{\n    float one; vec3 two = d; mat2 three;\n"
        text += f"    {self.result} result = {name}_inner({NAMES}, one, two, three);\n"
        return f"{text}    return mat4({PACKED[self.result]}, vec4(two, one), three[0], three[1], vec4(1.0));\n}}\n"

    def of_aid(self) -> str:
        """What the helper returns: an expression of its parameters alone."""
        self.variables, self.leaves, self.rules = AID_VARIABLES, AID_LEAVES, AID_RULES
        text = self.expr("float", 2)
        self.variables, self.leaves, self.rules = list(VARIABLES), LEAVES, RULES
        return text

    def expr(self, type_: str, depth: int = 3) -> str:
        if type_ in LITERALS:
            return self.random.choice(LITERALS[type_])
        names = [
            name
            for name, variable_type in self.variables
            if variable_type == (type_.lower() if type_.isupper() else type_)
        ]
        if type_.isupper() or ((depth <= 0 or self.chance(20)) and names):
            leaf = self.random.choice(names) if names else self.leaves[type_.lower()]
            return self.sized(leaf) if type_ in SIZED and self.chance(40) else leaf
        if depth <= 0:
            return self.leaves[type_]
        return self.filled(self.random.choice(self.rules[type_]), depth - 1)

    def sized(self, leaf: str) -> str:
        """A variable in another order of magnitude, or within bounds."""
        limit = self.random.choice(SMALL)
        return self.random.choice([
            f"({leaf} * {self.random.choice(SCALES)})", f"({leaf} * {self.random.choice(SCALES)})",
            f"({leaf} / {limit})",
        ])  # fmt: skip

    def filled(self, rule: str, depth: int = 1) -> str:
        alike: dict[str, str] = {}

        def fill(match: re.Match[str]) -> str:
            hole, number = match.groups()
            if number is None:
                return self.expr(hole, depth)
            if number not in alike:
                alike[number] = self.expr(hole, depth)
            return alike[number]

        return re.sub(r"\{(\w+)(?::(\d))?\}", fill, rule.replace("aid(", f"{self.aid}("))

    def kept(self, type_: str, depth: int = 3) -> str:
        text = self.expr(type_, depth)
        if type_ in ("float", "vec2", "vec3", "vec4") and self.chance(25):
            limit = self.random.choice(SMALL)
            return f"clamp({text}, -{limit}, {limit})"
        return text

    def call(self, pad: str, indent: int, size: int) -> str:
        return self.changed(pad, indent, size)

    def counting_while(self, pad: str, indent: int, size: int) -> str:
        self.names += 1
        name = f"i{self.names}"
        start = f"{pad}int {name} = 0;\n{pad}while ({name} < {self.random.choice(['2', '9', '(n & 7)'])}) {{\n"
        return self.loop(start, f"{pad}    {name} += 1;\n{pad}}}\n", (name, "int"), False, indent, size)


def _used(declarations: str, body: str) -> str:
    """The declarations that a body needs."""
    lines = declarations.splitlines(keepends=True)
    return "".join([line for line in lines if re.search(rf"\b{line.split('=')[0].split()[-1].split('[')[0]}\b", body)])


def source(random: Random, count: int, size: int = 3) -> str:
    """A text of `count` programs, `program_0` and so on, of `PARAMETERS`, each with a mat4 as result.

    Each has up to `size` statements in a block.
    """
    sizes = [random.randint(1, size) for _ in range(count)]
    programs = [HazardPrograms(random, size).program(f"program_{number}") for number, size in enumerate(sizes)]
    return "\n".join([HELPERS, *programs])
