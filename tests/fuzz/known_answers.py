"""Programs whose result is known by construction: each returns its argument.

A value is encoded, what is inside of it encodes and decodes another part, and it is decoded again. Each level is in
control flow that runs once, which no compiler can see: its conditions depend on a uniform, `SWITCHES`. Statements that
would change the value are where no lane gets.
"""

from __future__ import annotations

from random import Random

SWITCHES = "sssgen_switches"
"""A uniform ivec4 whose value is (0, 1, 2, 3)."""
HEAD = f"uniform ivec4 {SWITCHES};\n"
NONE, ONE = f"{SWITCHES}.x", f"{SWITCHES}.y"
FALSE = (
    f"{NONE} == 1", f"{NONE} > {ONE}", f"{SWITCHES}.z < {ONE}", f"!({NONE} == 0)", f"{ONE} != 1 && {NONE} == 0",
    f"any(notEqual({SWITCHES}.xy, ivec2(0, 1)))", f"float({NONE}) >= 0.5", f"({SWITCHES}.w & 4) != 0",
)  # fmt: skip
TRUE = (
    f"{NONE} == 0", f"{NONE} < {ONE}", f"{ONE} == 1 || {NONE} == 1", f"!({NONE} > {ONE})", f"uint({ONE}) == 1u",
    f"all(equal({SWITCHES}.zw, ivec2(2, 3)))", f"float({ONE}) > 0.5", f"({SWITCHES}.w & 2) != 0",
)  # fmt: skip
INVERSES = {3: -1431655765, 5: -858993459, 7: -1227133513, 9: 954437177}
"""Odd factors and their inverses modulo 2^32."""


class KnownAnswer:
    """Writes one program, of integers."""

    type = "ivec4"

    def __init__(self, random: Random, number: int) -> None:
        self.random, self.number, self.names = random, number, 0
        self.functions: list[str] = []

    def name(self, word: str = "t") -> str:
        self.names += 1
        return f"{word}{self.number}_{self.names}"

    def text(self) -> tuple[str, str]:
        """The name of the entry, and the text."""
        entry = f"known{self.number}"
        body = self.level("v", self.random.choice((1, 2, 2, 3, 3, 4)))
        whole = f"{self.type} {entry}({self.type} given) {{\n{self.type} v = given;\n{body}return v;\n}}\n"
        return entry, "".join(self.functions) + whole

    def level(self, v: str, depth: int) -> str:
        """Statements after which `v` is what it was."""
        if depth == 0:
            return self.random.choice(("", f"if ({self.false()}) {{ {self.junk(v)} }}\n"))
        encode, decode = self.codec(v)
        inside = self.level(v, depth - 1)
        if self.random.random() < 0.3:
            inside += self.level(v, depth - 1)
        return encode + self.once(v, inside) + decode

    def true(self) -> str:
        return self.random.choice(TRUE)

    def false(self) -> str:
        return self.random.choice(FALSE)

    def junk(self, v: str) -> str:
        """A statement that no lane reaches."""
        part = f"{v}.{self.random.choice('xyzw')}"
        return self.random.choice((
            f"{part} = {self.random.randrange(100)};", f"{part}++;", f"{v} = ivec4({NONE});", f"{v} = -{v};",
            f"{v} += {v}.wzyx;", f"{part} /= {ONE} + 1;", f"for (int k = 0; k < {ONE}; k++) {{ {part} += k; }}",
            f"{v}[{NONE}] = 7;", f"{part} <<= 3;", f"{v} = {v} * 3 - 1;", f"{part} = int(sqrt(float({ONE})));",
        ))  # fmt: skip

    def once(self, v: str, body: str) -> str:
        """Control flow in which the body runs once."""
        r, i, ran = self.random, self.name("i"), self.name("ran")
        shape = r.randrange(16)
        if f"return {v}" in body and shape in (9, 10, 12, 13):
            shape = 0  # the return is that of the entry
        if shape == 0:
            return f"for (int {i} = {NONE}; {i} < {ONE}; {i}++) {{\n{body}}}\n"
        if shape == 1:
            return f"do {{\n{body}}} while ({self.false()});\n"
        if shape == 2:
            return f"while (true) {{\n{body}if ({self.true()}) {{ break; }}\n{self.junk(v)}\n}}\n"
        if shape == 3:
            return (
                f"switch ({NONE}) {{\ncase 1:\n{self.junk(v)}\nbreak;\ncase 0: {{\n{body}}}\nbreak;\n"
                f"default:\n{self.junk(v)}\n}}\n"
            )
        if shape == 4:
            return (
                f"switch ({SWITCHES}.z) {{\ncase 2:\ncase 7: {{\n{body}}}\nbreak;\n"
                f"case 0:\ndefault:\n{self.junk(v)}\nbreak;\n}}\n"
            )
        if shape == 5:
            return f"if ({self.true()}) {{\n{body}}} else {{\n{self.junk(v)}\n}}\n"
        if shape == 6:
            return f"if ({self.false()}) {{\n{self.junk(v)}\n}} else {{\n{body}}}\n"
        if shape == 7:
            place = r.randrange(4)
            return f"for (int {i} = 0; {i} < 4; {i}++) {{\nif ({i} != {place} + {NONE}) {{ continue; }}\n{body}}}\n"
        if shape == 8:
            return f"bool {ran} = false;\nfor (;;) {{\nif ({ran}) {{ break; }}\n{ran} = true;\n{body}}}\n"
        if shape == 9:
            return self.outlined(v, body, early=False)
        if shape == 10:
            return self.outlined(v, body, early=True)
        if shape == 11:
            return (
                f"for (int {i} = {SWITCHES}.z; {i} > {NONE}; {i} -= 2) {{\n"
                f"do {{\nif ({self.false()}) {{ break; }}\n{body}}} while ({self.false()});\n}}\n"
            )
        if shape == 12:
            function = self.function("bool", v, f"{body}return true;\n")
            return f"if ({self.true()} && {function}({v})) {{ }} else {{ {self.junk(v)} }}\n"
        if shape == 13:
            function = self.function("int", v, f"{body}return 0;\n")
            return f"int {i} = {self.true()} ? {function}({v}) : int({v}.x = {self.type}(5).x);\n"
        if shape == 14:
            return f"if ({self.false()}) {{ return {v} * 2; }}\n{body}"
        outer = self.name("i")
        return (
            f"for (int {outer} = 0; {outer} < 3; {outer}++) {{\nint {i} = {outer};\nwhile ({i} < 3) {{\n"
            f"if ({i} == 1 && {outer} == 1) {{\n{body}}}\n{i} += 2;\nif ({outer} > 1) {{ continue; }}\nbreak;\n}}\n}}\n"
        )

    def function(self, result: str, v: str, body: str) -> str:
        """A function of `v`, whose name it returns."""
        name = self.name("part")
        self.functions.append(f"{result} {name}(inout {self.type} {v}) {{\n{body}}}\n")
        return name

    def outlined(self, v: str, body: str, early: bool) -> str:
        if not early:
            return f"{self.function('void', v, body)}({v});\n"
        name = self.function("void", v, f"if ({self.true()}) {{\n{body}return;\n}}\n{self.junk(v)}\n")
        return f"{name}({v});\n"

    def codec(self, v: str) -> tuple[str, str]:
        """Statements that encode a part of `v`, and those that decode it."""
        r = self.random
        part, other = (f"{v}.{letter}" for letter in r.sample("xyzw", 2))
        number, shift, t, u = r.randrange(-(2**31), 2**31), r.randrange(1, 31), self.name(), self.name()
        factor, inverse = r.choice(list(INVERSES.items()))
        literal = str(number) if number > -(2**31) else "(-2147483647 - 1)"
        codecs = [
            (f"{part} ^= {literal};\n", f"{part} ^= {literal};\n"),
            (f"{part} += {literal};\n", f"{part} -= {literal};\n"),
            (f"{v} = ~{v};\n", f"{v} = ~{v};\n"),
            (f"{part} *= {factor};\n", f"{part} *= {inverse};\n"),
            (f"{v} = {v}.wzyx;\n", f"{v} = {v}.wzyx;\n"),
            (f"{v} = {v}.yzwx;\n", f"{v}.yzwx = {v};\n"),
            (f"{part} = {part} ^ {other};\n", f"{part} = {part} ^ {other};\n"),
            (f"uvec4 {t} = uvec4({v}) + {abs(number)}u;\n{v} = ivec4({t});\n",
             f"{t} = uvec4({v}) - {abs(number)}u;\n{v} = ivec4({t});\n"),
            (f"{part} = int(uint({part}) << {shift} | uint({part}) >> {32 - shift});\n",
             f"{part} = int(uint({part}) >> {shift} | uint({part}) << {32 - shift});\n"),
            (f"{part} = bitfieldReverse({part});\n", f"{part} = bitfieldReverse({part});\n"),
            (f"int {t}[3] = int[3](1, {part}, 2);\n{part} = {t}[{NONE}];\n", f"{part} = {t}[{ONE}];\n"),
            (f"ivec4 {t}[2];\n{t}[{NONE}] = {v};\n{t}[1] = {v}.yxwz;\n{v} = {t}[{ONE}];\n", f"{v} = {v}.yxwz;\n"),
            (f"float {t} = float({part} & 0xFFFF);\nint {u} = {part} >> 16;\n{part} = 0;\n",
             f"{part} = {u} << 16 | int({t});\n"),
            (f"vec2 {t} = vec2({part} & 0xFFF, {part} >> 12 & 0xFFF);\nint {u} = {part} >> 24;\n{part} = {u};\n",
             f"{part} = {u} << 24 | int({t}.y) << 12 | int({t}.x);\n"),
            (f"mat3 {t} = mat3({SWITCHES}.z);\n{t}[{ONE}][{SWITCHES}.z] = float({part} & 0xFFFFF);\n{part} >>= 20;\n",
             f"{part} = {part} << 20 | int(transpose({t})[2][1]);\n"),
            (f"uint {t} = uint({part}) / {factor}u, {u} = uint({part}) % {factor}u;\n{part} = 3;\n",
             f"{part} = int({t} * {factor}u + {u});\n"),
            (f"bvec4 {t} = lessThan({v}, ivec4(0));\n{v} &= 0x7FFFFFFF;\n",
f"{v} |= ivec4({t}) << 31;\n"),
            (self.bytes_of(part, t), f"{part} = 0;\nfor (int {u} = 3; {u} >= 0; {u}--) "
                                     f"{{ {part} = {part} << 8 | {t}[{u}]; }}\n"),
            self.packed(v, t),
            self.swapped(part, other),
        ]  # fmt: skip
        return r.choice(codecs)

    def bytes_of(self, part: str, t: str) -> str:
        i = self.name("i")
        return (
            f"int {t}[4];\nfor (int {i} = 0; {i} < 4; {i}++) {{ {t}[{i}] = {part} >> 8 * {i} & 0xFF; }}\n{part} = 1;\n"
        )

    def packed(self, v: str, t: str) -> tuple[str, str]:
        """Into a struct in a struct, and back."""
        inner, outer = self.name("Inner"), self.name("Outer")
        self.functions.append(f"struct {inner} {{ ivec2 low; int high[2]; }};\n")
        self.functions.append(f"struct {outer} {{ float before; {inner} parts[2]; }};\n")
        into = f"{outer} {t};\n{t}.parts[{NONE}] = {inner}({v}.xy, int[2]({v}.z, {v}.w));\n"
        return (
            f"{into}{t}.parts[1] = {t}.parts[0];\n{v} = ivec4({ONE});\n",
            f"{v} = ivec4({t}.parts[{ONE}].low, {t}.parts[1].high[{NONE}], {t}.parts[1].high[1]);\n",
        )

    def swapped(self, part: str, other: str) -> tuple[str, str]:
        """By a function, twice."""
        name = self.name("swap")
        self.functions.append(f"void {name}(inout int a, inout int b) {{ int c = a; a = b; b = c; }}\n")
        return f"{name}({part}, {other});\n", f"{name}({other}, {part});\n"


class KnownFloats(KnownAnswer):
    """Writes one program, of floats that are eighths: every operation is exact."""

    type = "vec4"

    def junk(self, v: str) -> str:
        part = f"{v}.{self.random.choice('xyzw')}"
        return self.random.choice((
            f"{part} = {self.random.randrange(100)}.5;", f"{part}++;", f"{v} = vec4({NONE});", f"{v} = -{v};",
            f"{v} += {v}.wzyx;", f"{part} /= float({ONE} + 1);", f"{v} *= mat4(2.0);", f"{v} = normalize({v});",
            f"for (int k = 0; k < {ONE}; k++) {{ {part} += sin(float(k)); }}", f"{v}[{NONE}] = 7.0;",
        ))  # fmt: skip

    def codec(self, v: str) -> tuple[str, str]:
        r = self.random
        part, other = (f"{v}.{letter}" for letter in r.sample("xyzw", 2))
        number, t, u = 8.0 * r.randrange(-64, 64), self.name(), self.name()
        order = r.sample(range(4), 4)
        columns = ", ".join("".join(", 1.0" if row == order[column] else ", 0.0" for row in range(4))[2:]
                            for column in range(4))  # fmt: skip
        codecs = [
            (f"{v} *= 4.0;\n", f"{v} *= 0.25;\n"),
            (f"{v} = -{v};\n", f"{v} = -{v};\n"),
            (f"{v} = {v}.wzyx;\n", f"{v}.wzyx = {v};\n"),
            (f"{part} += {number};\n", f"{part} -= {number};\n"),
            (f"mat4 {t} = mat4({columns});\n{v} = {t} * {v};\n", f"{v} = {v} * {t};\n"),
            (f"vec4 {t} = floor({v});\n{v} = fract({v});\n", f"{v} += {t};\n"),
            (f"float {t};\n{part} = modf({part}, {t});\n", f"{part} = {t} + {part};\n"),
            (f"int {t};\n{part} = frexp({part}, {t});\n", f"{part} = ldexp({part}, {t});\n"),
            (f"vec4 {t} = sign({v});\n{v} = abs({v});\n", f"{v} = mix({v}, {v} * {t}, notEqual({t}, vec4(0.0)));\n"),
            (f"mat4 {t} = outerProduct({v}, vec4(0.0, 1.0, 0.0, 0.0));\n{v} = vec4({ONE});\n", f"{v} = {t}[{ONE}];\n"),
            (f"mat2x4 {t};\n{t}[{NONE}] = {v};\n{t}[1] = {v}.yxwz;\n{v} = {t}[{ONE}];\n", f"{v} = {v}.yxwz;\n"),
            (f"float {t} = {part};\n{part} = {other};\n{other} = {t};\n",
             f"float {u} = {other};\n{other} = {part};\n{part} = {u};\n"),
            (f"{part} = {part} + {other};\n", f"{part} = {part} - {other};\n"),
            (f"ivec4 {t} = floatBitsToInt({v});\n{v} = vec4({SWITCHES});\n", f"{v} = intBitsToFloat({t});\n"),
            (f"vec2 {t}[3] = vec2[3]({v}.xy, vec2(0.0), {v}.zw);\n{v} = vec4(1.0);\n",
             f"{v} = vec4({t}[{NONE}], {t}[{SWITCHES}.z]);\n"),
            self.in_struct(v, t),
        ]  # fmt: skip
        return r.choice(codecs)

    def in_struct(self, v: str, t: str) -> tuple[str, str]:
        """Into the matrix of a struct in an array, by a function, and back."""
        name, function = self.name("Kept"), self.name("keep")
        self.functions.append(f"struct {name} {{ mat2 both; int place; }};\n")
        self.functions.append(
            f"void {function}(out {name} kept[2], vec4 a, int place) {{\n"
            f"kept[0] = {name}(mat2(a), place);\nkept[place].both = mat2(a);\nkept[1].place = 0;\n}}\n"
        )
        return (
            f"{name} {t}[2];\n{function}({t}, {v}, {ONE});\n{v} = -{v};\n",
            f"{v} = vec4({t}[{t}[{NONE}].place].both[{NONE}], {t}[1].both[{ONE}]);\n",
        )
