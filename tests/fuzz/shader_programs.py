"""Random programs of the whole language, made by a grammar, that every machine must compute alike.

Two kinds of floats keep float32 and float64 together. `exact` ones are multiples of 1/8 in -64..64, made by operations
that lose nothing of them; only these decide (comparisons, casts, `floor`), so that no lane takes another branch for a
rounding. `float` ones and vectors go through the smooth builtins, stay in -9..9, and never decide.

A rule is a text with the names of what it needs in braces; in capitals it is a variable, as no divisor may be the
constant 0.
"""

from __future__ import annotations

import re
from random import Random

PARAMETERS = "float a, float b, vec3 d, int n, uint h, bool f, out vec2 o, inout ivec2 g, inout float t, out Pair made"
"""a and b are exact; the rest is anything."""
INPUTS = "float a, float b, vec3 d, int n, uint h, bool f, ivec2 g, float t"

HELPERS = """
struct Pair { float first; vec2 second; int count; };
const int TWO = 2;
const float HALF[2] = float[2](0.5, -0.5);
const mat2 TURN = mat2(0.6, 0.8, -0.8, 0.6);

float snap(float x) { return floor(clamp(x, -64.0, 64.0) * 8.0) / 8.0; }
float tweak(float x) { if (x < 0.0) return -0.5 * x; return 0.25 * x + 1.0; }
vec2 tweak(vec2 x) { return TURN * x; }
int tweak(int x) { for (int i = 0; i < 4; i++) { if ((x & 1) == 0) { x >>= 1; continue; } x = 3 * x + 1; } return x; }
float tweak(float x, int i) { return x * HALF[i & 1]; }
Pair pair_of(float x, int i) { Pair p; p.first = x; p.second = vec2(0.5 * x, 1.0); p.count = i; return p; }
void trade(inout float x, inout float y) { float z = x; x = y; y = 0.5 * z; }
int count_to(int x, out float rest, inout int count) {
    rest = 0.0;
    for (int i = 0; i < 5; i++) {
        if (i > x) { count += i; return i; }
        if (i == 3) { rest -= 1.0; break; }
        rest += 0.5;
    }
    return count;
}
"""

RULES: dict[str, list[str]] = {
    "exact": [
        "({exact} + {exact})", "({exact} - {exact})", "({exact} * 0.5)", "(- {exact} * 1.5)", "(- {exact})",
        "abs({exact})",
        "min({exact}, {exact})", "max({exact}, {exact})", "clamp({exact}, -2.0, 3.0)", "floor({exact})",
        "ceil({exact})",
        "trunc({exact})", "roundEven({exact})", "sign({exact})", "fract({exact})", "step({exact}, {exact})",
        "mod({exact}, 2.0)", "fmod({exact}, 4.0)", "float({int} & 7)", "float({uint} & 15u)", "float({bool})",
        "({bool} ? {exact} : {exact})", "intBitsToFloat(floatBitsToInt({exact}))",
        "vec3({exact}, {exact}, {exact}).zx.y",
    ],
    "float": [
        "{exact}", "{exact}", "({float} + {float})", "({float} - {float})", "({float} * 0.3)",
        "({float} * sin({float}))",
        "({float} / (2.0 + cos({float})))", "-({float})", "sin({float})", "cos({float})", "tan(sin({float}))",
        "asin(0.9 * sin({float}))", "acos(0.9 * cos({float}))", "atan({float})",
        "atan(sin({float}), 2.0 + cos({float}))",
        "sinh(sin({float}))", "cosh(sin({float}))", "tanh({float})", "asinh({float})", "acosh(abs({float}) + 1.5)",
        "atanh(0.8 * sin({float}))", "pow(abs({float}) + 0.5, sin({float}))", "exp(sin({float}))", "exp2(cos({float}))",
        "log(abs({float}) + 0.5)", "log2(abs({float}) + 0.5)", "sqrt(abs({float}) + 0.25)", "saturate({float})",
        "inversesqrt(abs({float}) + 0.5)", "abs({float})", "min({float}, {float})", "max({float}, {float})",
        "clamp({float}, -1.0, 2.0)", "mix({float}, {float}, 0.25)", "smoothstep(-1.0, 2.0, {float})",
        "radians({float})",
        "degrees(0.01 * {float})", "length({vec2})", "distance({vec3}, {vec3})", "(0.2 * dot({vec2}, {vec2}))",
        "{vec2}.y", "{vec3}.x", "{vec4}.w", "{vec4}.zyx.y", "{vec3}[{int} & 1]", "{mat2}[1].x", "{mat3}[{int} & 1].z",
        "{mat2}[0][1]", "(0.1 * determinant({mat2}))", "({bool} ? {float} : {float})", "{Pair}.first",
        "{Pair}.second.y",
        "tweak({float}, {int})", "list[{int} & 3]", "list[abs({INT}) % 4]", "tweak({float})", "HALF[{uint} & 1u]",
        "(sign({exact}) * {float})",
    ],
    "vec2": [
        "vec2({float}, {float})", "vec2({float})", "({vec2} + {vec2})", "({vec2} - {float})", "(0.5 * {vec2})",
        "(sin({vec2}) * {vec2})", "({mat2} * {vec2} * 0.2)", "({vec2} * {mat2} * 0.2)", "{vec3}.xz", "{vec4}.wy",
        "{vec2}.yx",
        "{vec2}.xx", "mix({vec2}, {vec2}, {bvec2})", "mix({vec2}, {vec2}, 0.5)", "clamp({vec2}, -2.0, 2.0)",
        "{mat2}[1]",
        "max({vec2}, vec2({float}, 0.0))", "abs({vec2})", "tweak({vec2})", "{Pair}.second", "vec2({ivec2} & 7)",
        "({bool} ? {vec2} : {vec2})", "reflect({vec2}, TURN[0])", "vec2({bvec2})", "smoothstep(-1.0, 1.5, {vec2})",
    ],
    "vec3": [
        "vec3({float}, {float}, {float})", "vec3({vec2}, {float})", "vec3({float}, {vec2})", "({vec3} + {vec3})",
        "({vec3} * 0.3)", "cross(sin({vec3}), cos({vec3}))", "normalize(sin({vec3}) + vec3(1.5, 2.0, 3.0))",
        "{vec4}.yzw",
        "{vec3}.zxy", "{vec2}.xyx", "({mat3} * {vec3} * 0.1)", "{mat3}[2]",
        "faceforward({vec3}, vec3(0.0, 0.0, {exact}), vec3(0.0, 0.0, 1.0))",
        "refract(normalize(sin({vec3}) + 2.0), vec3(0.0, 0.6, 0.8), 0.7)", "(- {vec3})", "max({vec3}, {float})", "d",
    ],
    "vec4": [
        "vec4({vec2}, {vec2})", "vec4({vec3}, {float})", "vec4({float})", "({vec4} - {vec4})", "{vec4}.wzyx",
        "(0.2 * {vec4})",
        "{vec3}.xyzx", "(outerProduct({vec4}, sin({vec4}))[{int} & 3] * 0.1)", "(mat4(0.5) * {vec4})", "atan({vec4})",
    ],
    "mat2": [
        "mat2({vec2}, {vec2})", "mat2({float})", "({mat2} * {mat2} * 0.1)", "transpose({mat2})", "TURN", "mat2({mat3})",
        "matrixCompMult({mat2}, TURN)", "({mat2} + {mat2})", "outerProduct({vec2}, TURN[1])",
        "({mat2} * {float} * 0.1)",
        "inverse(mat2(sin({vec2}), cos({vec2})) * 0.3 + mat2(2.0))",
    ],
    "mat3": [
        "mat3({vec3}, {vec3}, {vec3})", "mat3({mat2})", "transpose({mat3})", "(0.5 * {mat3})", "mat3({float})",
        "(mat3(0.1) * {mat3} - {mat3})",
    ],
    "int": [
        "({int} + {int})", "({int} - {int})", "({int} * {int})", "({int} / {INT})", "({int} % {INT})",
        "({int} & {int})",
        "({int} | {int})", "({int} ^ {int})", "({int} << {INT})", "({int} >> {UINT})", "(~{int})", "-({int})",
        "abs({INT})",
        "sign({int})", "min({int}, {int})", "max({int}, {int})", "clamp({int}, -3, 9)", "int({exact})", "int({uint})",
        "int({bool})", "({bool} ? {int} : {int})", "{ivec2}.y", "{ivec2}[{int} & 1]", "{Pair}.count", "tweak({int})",
        "TWO",
        "floatBitsToInt(float({int} & 1023))",
    ],
    "uint": [
        "({uint} + {uint})", "({uint} - {uint})", "({uint} * {uint})", "({uint} / {UINT})", "({uint} % {UINT})",
        "({uint} & {uint})", "({uint} | {uint})", "({uint} ^ {uint})", "({uint} >> 3)", "({uint} << {INT})",
        "(~{uint})",
        "uint({int})", "uint(abs({exact}))", "min({uint}, {uint})", "({bool} ? {uint} : {uint})", "uint({bool})",
        "floatBitsToUint(1.0 + float({uint} & 63u))",
    ],
    "ivec2": [
        "ivec2({int}, {int})", "ivec2({int})", "({ivec2} + {ivec2})", "({ivec2} * {int})", "{ivec2}.yx",
        "({ivec2} / {IVEC2})",
        "({ivec2} % {INT})", "({ivec2} ^ {ivec2})", "({ivec2} << {IVEC2})", "(- {ivec2})", "max({ivec2}, {ivec2})",
        "abs({IVEC2})",
        "ivec2({bvec2})", "grid[{int} & 1]",
    ],
    "bool": [
        "({exact} < {exact})", "({exact} >= {exact})", "({exact} == {exact})", "({exact} != {exact})",
        "({int} < {int})",
        "({int} == {int})", "({int} >= {int})", "({uint} > {uint})", "({uint} <= 9u)", "({bool} && {bool})",
        "({bool} || {bool})",
        "({bool} ^^ {bool})", "!({bool})", "any({bvec2})", "all({bvec2})", "({ivec2} == {ivec2})", "bool({int})",
        "(({bool}) == ({bool}))", "({bool} ? {bool} : {bool})", "isnan({float})",
    ],
    "bvec2": [
        "bvec2({bool}, {bool})", "lessThan({ivec2}, {ivec2})", "greaterThanEqual({ivec2}, {ivec2})", "not({bvec2})",
        "equal({ivec2}, {ivec2})", "notEqual({ivec2}, ivec2({int}))", "bvec2({ivec2})",
        "lessThan(vec2({exact}), vec2({exact}))",
    ],
    "Pair": ["Pair({float}, {vec2}, {int})", "pair_of({float}, {int})"],
}  # fmt: skip

LITERALS = {
    "exact": ["0.0", "1.0", "-0.5", "2.0", "0.125", "3.0"], "float": ["0.7", "-1.3", "2.5"],
        "vec2": ["vec2(0.3, -0.9)"],
    "vec3": ["vec3(0.2, 1.1, -0.6)"], "vec4": ["vec4(0.1, -0.2, 0.9, 1.4)"], "mat2": ["mat2(0.8, 0.1, -0.4, 1.2)"],
    "mat3": ["mat3(0.5)"], "int": ["0", "1", "-1", "3", "7", "-2147483648", "2147483647"], "ivec2": ["ivec2(2, -5)"],
    "uint": ["0u", "1u", "5u", "4294967295u"], "bool": ["true", "false"], "bvec2": ["bvec2(true, false)"],
    "Pair": ["Pair(0.5, vec2(1.0, -1.0), 3)"],
}  # fmt: skip

KEPT = {"exact": "snap({})", **dict.fromkeys(("float", "vec2", "vec3", "vec4"), "clamp({}, -9.0, 9.0)")}
"""What keeps a value in its range, where it is stored."""

STORES = [
    ("vec2", "v.xy"), ("vec2", "v.zx"), ("float", "q.w"), ("vec3", "q.wzx"), ("float", "q[{int} & 3]"), ("vec2",
    "m[1]"),
    ("vec2", "m[{int} & 1]"), ("float", "m[{int} & 1].y"), ("float", "pair.first"), ("vec2", "pair.second"),
    ("float", "pair.second.x"), ("int", "pair.count"), ("float", "list[{int} & 3]"), ("float", "list[2]"), ("int",
    "g.x"),
    ("ivec2", "g.yx"), ("int", "grid[{int} & 1].y"), ("float", "t"), ("vec2", "o"), ("float", "o.y"), ("Pair", "made"),
    ("int", "made.count"), ("ivec2", "g"), ("ivec2", "grid[0]"),
]  # fmt: skip

START = """\
    float e = snap(a + b);
    vec3 v = clamp(d, -9.0, 9.0);
    vec4 q = vec4(v.yx, 0.5, -1.5);
    mat2 m = mat2(v.x, 0.5, -0.25, v.y);
    int k = n;
    uint w = h;
    float list[4] = float[4](a, 0.5, b, v.z);
    ivec2 grid[2] = ivec2[2](g, ivec2(k, 1));
    Pair pair = pair_of(v.x, k);
    t = clamp(t, -9.0, 9.0);
    o = vec2(0.0);
    made = pair;
"""
VARIABLES = [
    ("a", "exact"), ("b", "exact"), ("e", "exact"), ("n", "int"), ("k", "int"), ("h", "uint"), ("w", "uint"), ("f",
    "bool"),
    ("g", "ivec2"), ("t", "float"), ("o", "vec2"), ("v", "vec3"), ("q", "vec4"), ("m", "mat2"), ("pair", "Pair"),
    ("made", "Pair"),
]  # fmt: skip
PLACES = [("exact", "e"), ("int", "k"), ("uint", "w"), ("vec3", "v"), ("vec4", "q"), ("mat2", "m"), ("Pair", "pair")]


CHANGES = [
    "k += {int};", "k -= {int};", "k *= {int};", "k /= {INT};", "k %= {INT};", "k &= {int};", "k ^= {int};",
    "k |= {int};", "k <<= {INT};", "k >>= {INT};", "w += {uint};", "w ^= {uint};", "w >>= {UINT};", "k++;",
    "--k;", "w--;", "v.zx *= vec2(0.5, -0.5);", "q *= 0.5;", "m *= 0.5;", "q.yw -= 0.25 * q.zx;", "g += {ivec2};",
    "g.y++;", "list[{int} & 3] *= -0.5;", "v = TURN[0].x * v;", "m[1] *= HALF[{int} & 1];", "pair.count ^= {int};",
]  # fmt: skip
COUNTS = [
    "int {0} = 0; {0} < 3; {0}++", "int {0} = 2; {0} >= 0; {0}--", "int {0} = -1; {0} <= 3; {0} += 2",
    "int {0} = 0; {0} < TWO && f; ++{0}", "int {0} = 0; {0} < (n & 3); {0}++", "uint {0} = 0u; {0} < 3u; {0}++",
]  # fmt: skip


class ShaderPrograms:
    """Makes the text of one function of `PARAMETERS`, which stands behind `HELPERS`."""

    rules, changes, counts = RULES, CHANGES, COUNTS

    def __init__(self, random: Random, size: int = 4) -> None:
        self.random = random
        self.size = size
        self.variables = list(VARIABLES)
        self.places = PLACES + STORES
        self.names = 0
        self.loops: list[bool] = []
        """The loops around, and whether each may be continued."""

    def program(self, name: str) -> str:
        self.result = self.random.choice(["float", "vec2", "vec3", "vec4", "int", "uint", "ivec2"])
        body = START + self.block(1, self.size) + f"    return {self.kept(self.result)};\n"
        return f"{self.result} {name}({PARAMETERS}) {{\n{body}}}\n"

    def output_functions(self, name: str) -> str:
        """Functions without out parameters that show what the program gives: its result, floats, whole numbers."""
        start = (
            f"({INPUTS}) {{ vec2 o; Pair made; {self.result} result = {name}(a, b, d, n, h, f, o, g, t, made); return "
        )
        return (
            f"{self.result} {name}_result{start}result; }}\n"
            f"vec4 {name}_floats{start}vec4(o, t, made.first + made.second.x + made.second.y); }}\n"
            f"ivec3 {name}_whole{start}ivec3(g, made.count); }}\n"
        )

    def chance(self, percent: int) -> bool:
        return self.random.randrange(100) < percent

    # Expressions

    def expr(self, type_: str, depth: int = 3) -> str:
        names = [name for name, variable_type in self.variables if variable_type == type_.lower()]
        if type_.isupper():
            return self.random.choice(names)
        if depth == 0 or self.chance(20):
            return self.random.choice(names if names and self.chance(80) else LITERALS[type_])
        return self.filled(self.random.choice(RULES[type_]), depth - 1)

    def filled(self, rule: str, depth: int = 1) -> str:
        return re.sub(r"\{(\w+)\}", lambda match: self.expr(match[1], depth), rule)

    def kept(self, type_: str, depth: int = 3) -> str:
        return KEPT.get(type_, "{}").replace("{}", self.expr(type_, depth))

    # Statements

    def block(self, indent: int, size: int) -> str:
        """Up to `size` statements; their declarations are local to the block."""
        variables, places = list(self.variables), list(self.places)
        text = "".join(self.statement(indent, size) for _ in range(self.random.randint(1, size)))
        self.variables, self.places = variables, places
        return text

    def statement(self, indent: int, size: int) -> str:
        pad = "    " * indent
        simple = [self.store, self.store, self.store, self.declaration, self.changed, self.call, self.jump]
        nested = [self.branch, self.branch, self.counting_for, self.counting_while, self.scope]
        result = self.random.choice(simple + (nested if size > 1 else []))
        return str(result(pad, indent, size))

    def store(self, pad: str, indent: int, size: int) -> str:
        type_, place = self.random.choice(self.places)
        return f"{pad}{self.filled(place)} = {self.kept(type_)};\n"

    def changed(self, pad: str, indent: int, size: int) -> str:
        return f"{pad}{self.filled(self.random.choice(self.changes))}\n"

    def call(self, pad: str, indent: int, size: int) -> str:
        call = self.random.choice(
            ["trade(t, q.x);", "trade(list[1], v.y);", "k = count_to({int}, t, g.x);",
            "g.y += count_to(k & 7, list[3], k);",
             "trade(o.x, pair.first);", "count_to({int}, v.z, pair.count);", "trade(v.x, v.z);"]
        )  # fmt: skip
        return f"{pad}{self.filled(call)}\n"

    def declaration(self, pad: str, indent: int, size: int) -> str:
        type_ = self.random.choice(list(self.rules))
        self.names += 1
        name, spelled = f"x{self.names}", "float" if type_ == "exact" else type_
        text = f"{pad}{spelled} {name} = {self.kept(type_)};\n"
        if self.chance(30):
            text = f"{pad}{spelled} {name};\n{pad}if ({self.expr('bool', 2)}) {name} = {self.kept(type_)}; "
            text += f"else {name} = {self.kept(type_, 1)};\n"
        self.variables.append((name, type_))
        self.places.append((type_, name))
        return text

    def jump(self, pad: str, indent: int, size: int) -> str:
        jump = f"return {self.kept(self.result, 2)}"
        if self.loops and self.chance(70):
            jump = "continue" if self.loops[-1] and self.chance(50) else "break"
        return f"{pad}if ({self.expr('bool')}) {jump};\n" if self.chance(93) else f"{pad}{jump};\n"

    def branch(self, pad: str, indent: int, size: int) -> str:
        text = f"{pad}if ({self.expr('bool')}) {{\n{self.block(indent + 1, size - 1)}{pad}}}"
        while self.chance(30):
            text += f" else if ({self.expr('bool', 2)}) {{\n{self.block(indent + 1, size - 1)}{pad}}}"
        if self.chance(40):
            text += f" else {{\n{self.block(indent + 1, size - 1)}{pad}}}"
        return f"{text}\n"

    def scope(self, pad: str, indent: int, size: int) -> str:
        return f"{pad}{{\n{self.block(indent + 1, size - 1)}{pad}}}\n"

    def counting_for(self, pad: str, indent: int, size: int) -> str:
        self.names += 1
        name = f"i{self.names}"
        head = self.random.choice(self.counts).format(name)
        return self.loop(f"{pad}for ({head}) {{\n", f"{pad}}}\n", (name, head.split()[0]), True, indent, size)

    def counting_while(self, pad: str, indent: int, size: int) -> str:
        self.names += 1
        name = f"i{self.names}"
        start = f"{pad}int {name} = 0;\n{pad}while ({name} < {self.random.choice(['2', 'TWO', '(n & 3)'])}) {{\n"
        return self.loop(start, f"{pad}    {name} += 1;\n{pad}}}\n", (name, "int"), False, indent, size)

    def loop(self, start: str, end: str, counter: tuple[str, str], continues: bool, indent: int, size: int) -> str:
        self.variables.append(counter)
        self.loops.append(continues)
        body = self.block(indent + 1, size - 1)
        self.loops.pop()
        self.variables.remove(counter)
        return f"{start}{body}{end}"


def source(random: Random, count: int, size: int = 4) -> str:
    """A text of `count` programs and what shows their outputs: `program_0_result` and so on."""
    parts = [HELPERS]
    for number in range(count):
        programs = ShaderPrograms(random, size)
        parts += [programs.program(f"program_{number}"), programs.output_functions(f"program_{number}")]
    return "\n".join(parts)
