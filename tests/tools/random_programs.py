"""Random programs of the language with control flow that differs between lanes, for property tests."""

from __future__ import annotations

from random import Random

HELPERS = """
const int TWO = 2;
struct Pair { float first; vec2 second; };

float half_of(float x) { if (x < 0.0) return -x; return 0.5 * x; }

float split(float x, out float rest, inout int count) {
    rest = 0.0;
    if (x > 4.0) { rest = x - 4.0; count++; return 4.0; }
    for (int i = 0; i < 3; i++) {
        if (x < float(i)) { count += 2; rest -= 1.0; break; }
        rest += x;
    }
    return x;
}
"""

DISCARDING = """
float keep(float x) { if (x > 3.0) discard; return x + 0.5; }
"""


class Programs:
    """Generates the text of a function `f(float a, float b, int n, inout float c, out float d)`.

    All arithmetic is exact or correctly rounded in float64, so that two runs can be compared to the last bit.
    """

    def __init__(self, random: Random, discards: bool = False, size: int = 4) -> None:
        self.random = random
        self.discards = discards
        self.size = size
        self.declared: list[str] = []
        """The names that may not be declared again in the block; sibling blocks use the same names."""
        self.floats: list[str] = []
        self.ints: list[str] = []
        self.counters: list[str] = []
        self.loops: list[bool] = []
        """The enclosing loops, and whether each allows `continue`."""

    def program(self) -> str:
        self.floats = ["a", "b", "c", "d", "v.x", "v.y", "v.z", "pair.first", "pair.second.y"]
        self.ints = ["k"]
        start = "    vec3 v = vec3(a, b, 0.5);\n    float list[3] = float[3](a, 1.0, b);\n    int k = 0;\n"
        start += "    Pair pair = Pair(b, v.xz);\n    d = 0.0;\n"
        body = start + self.block(1, self.size) + f"    return {self.number()};\n"
        helpers = HELPERS + (DISCARDING if self.discards else "")
        return f"{helpers}\nfloat f(float a, float b, int n, inout float c, out float d) {{\n{body}}}\n"

    def chance(self, percent: int) -> bool:
        return self.random.randrange(100) < percent

    def name(self, letter: str) -> str:
        count = 1
        while f"{letter}{count}" in self.declared:
            count += 1
        self.declared.append(f"{letter}{count}")
        return self.declared[-1]

    # Expressions

    def number(self, depth: int = 2) -> str:
        kind = self.random.randrange(9 if depth else 3)
        if kind == 0:
            return self.random.choice(["0.0", "0.5", "1.0", "2.0", "-1.5", "3.0"])
        if kind in (1, 2):
            return self.random.choice(self.floats)
        if kind == 3:
            return f"float({self.whole(1)})"
        if kind == 4:
            return f"({self.condition(1)} ? {self.number(depth - 1)} : {self.number(depth - 1)})"
        if kind == 5:
            return f"{self.random.choice(['min', 'max'])}({self.number(depth - 1)}, {self.number(depth - 1)})"
        if kind == 6:
            return f"list[{self.whole(1)}]"
        if kind == 7:
            call = "keep" if self.discards and self.chance(30) else "half_of"
            return f"{call}({self.number(depth - 1)})"
        return f"({self.number(depth - 1)} {self.random.choice('+-*')} {self.number(depth - 1)})"

    def whole(self, depth: int = 1) -> str:
        kind = self.random.randrange(5 if depth else 3)
        if kind == 0:
            return self.random.choice(["0", "1", "2", "TWO", "(n + 7)"])
        if kind in (1, 2):
            return self.random.choice([*self.ints, *self.counters, "n"])
        if kind == 3:
            return f"int({self.random.choice(self.floats)})"
        variable = self.random.choice([*self.ints, *self.counters])
        return f"({self.whole(depth - 1)} {self.random.choice('+-*/%')} {variable})"

    def condition(self, depth: int = 2) -> str:
        kind = self.random.randrange(6 if depth else 3)
        if kind == 0 and self.counters:
            return f"{self.random.choice(self.counters)} == {self.random.randrange(3)}"
        if kind == 1:
            return f"{self.whole(1)} {self.random.choice(['<', '==', '>='])} {self.whole(1)}"
        if kind == 3:
            return f"({self.condition(depth - 1)} {self.random.choice(['&&', '||', '^^'])} {self.condition(depth - 1)})"
        if kind == 4:
            return f"!({self.condition(depth - 1)})"
        if kind == 5 and self.chance(25):
            return f"split({self.number(0)}, {self.place()}, k) > 1.0"
        return f"{self.number(1)} {self.random.choice(['<', '>', '<=', '!='])} {self.number(1)}"

    def place(self) -> str:
        return self.random.choice([*self.floats, f"list[{self.whole(0)}]"])

    # Statements

    def block(self, indent: int, size: int) -> str:
        """Up to `size` statements; their declarations are local to the block."""
        floats, ints, declared = list(self.floats), list(self.ints), list(self.declared)
        text = "".join(self.statement(indent, size) for _ in range(self.random.randint(1, size)))
        self.floats, self.ints, self.declared = floats, ints, declared
        return text

    def statement(self, indent: int, size: int) -> str:
        pad = "    " * indent
        if self.loops and self.chance(20):
            return self.jump(pad)
        kind = self.random.randrange(16 if size > 1 else 8)
        if kind in (0, 1, 2):
            return f"{pad}{self.place()} {self.random.choice(['=', '+=', '-=', '*='])} {self.number()};\n"
        if kind == 3:
            target = self.random.choice(["k"] if self.chance(60) else self.ints)
            return f"{pad}{target} {self.random.choice(['=', '+='])} {self.whole()};\n"
        if kind == 4:
            swizzle = self.random.choice(["xy", "zx", "yz"])
            return f"{pad}v.{swizzle} = vec2({self.number(1)}, {self.number(1)});\n"
        if kind == 5:
            return self.declaration(pad)
        if kind == 6 or kind == 7:
            return self.jump(pad)
        if kind in (8, 9, 10, 11):
            text = f"{pad}if ({self.condition()}) {{\n{self.block(indent + 1, size - 1)}{pad}}}"
            if self.chance(45):
                text += f" else {{\n{self.block(indent + 1, size - 1)}{pad}}}"
            return f"{text}\n"
        if kind == 12:
            call = f"split({self.number(1)}, {self.place()}, k)"
            if self.chance(30):
                return f"{pad}if ({self.condition(1)}) {call};\n"
            return f"{pad}{self.place()} {self.random.choice(['=', '+='])} {call};\n"
        if kind == 13 and size > 2:
            return self.counting_while(pad, indent, size)
        return self.counting_for(pad, indent, size)

    def declaration(self, pad: str) -> str:
        if self.chance(30):
            name = self.name("t")
            text = f"{pad}int {name} = {self.whole()};\n"
            self.ints.append(name)
            return text
        name = self.name("t")
        if self.chance(50):
            text = f"{pad}float {name} = {self.number()};\n"
        else:
            text = f"{pad}float {name};\n{pad}if ({self.condition(1)}) {name} = {self.number(1)};"
            text += f" else {name} = {self.number(1)};\n"
        self.floats.append(name)
        return text

    def jump(self, pad: str) -> str:
        jumps = ["return", "return"] + (["discard"] if self.discards else [])
        if self.loops:
            jumps += ["break"] * 3 + (["continue"] * 3 if self.loops[-1] else [])
        jump = self.random.choice(jumps)
        if jump == "return":
            jump = f"return {self.number()}"
        return f"{pad}if ({self.condition()}) {jump};\n" if self.chance(88) else f"{pad}{jump};\n"

    def counting_for(self, pad: str, indent: int, size: int) -> str:
        name = self.name("i")
        bound = self.random.choice(["2", "3", "TWO", "n"])
        more = f" && {self.condition(1)}" if self.chance(20) else ""
        head = f"int {name} = 0; {name} < {bound}{more}; {name}++"
        if self.chance(20):
            head = self.random.choice(["int {0} = 2; {0} >= 0; {0}--", "int {0} = -1; {0} <= 3; {0} += 2"]).format(name)
        self.counters.append(name)
        self.loops.append(True)
        text = f"{pad}for ({head}) {{\n{self.block(indent + 1, size - 1)}{pad}}}\n"
        self.loops.pop()
        self.counters.pop()
        self.declared.remove(name)
        return text

    def counting_while(self, pad: str, indent: int, size: int) -> str:
        name = self.name("w")
        self.counters.append(name)
        self.loops.append(False)
        bound = self.random.choice(["2", "TWO", "n"])
        body = self.block(indent + 1, size - 1)
        text = f"{pad}int {name} = 0;\n{pad}while ({name} < {bound}) {{\n{body}{pad}    {name} += 1;\n{pad}}}\n"
        self.loops.pop()
        self.counters.pop()
        return text
