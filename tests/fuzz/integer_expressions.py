"""Random integer expressions of GLSL at the boundaries of the types, with their values in 32-bit arithmetic.

The values are computed here, not by the project. Expressions consist of literals, module constants and the parameters
`a`, `b` (int) and `u`, `v` (uint); whatever GLSL leaves undefined does not occur for the given parameters.
"""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import NamedTuple

LOWEST, HIGHEST, MOST = -(2**31), 2**31 - 1, 2**32 - 1
CONSTANTS = """
const int LOW = -2147483648;
const int HIGH = 2147483647;
const int SHIFTED = 1 << 31;
const uint MOST = ~0u;
const uint ONE = 1u;
const ivec3 EDGES = ivec3(-2147483648, 0, 2147483647);
const int LIST[4] = int[4](-1, 1 << 30, 65536 * 65535, 7);
"""
_INTS = {
    "0": 0, "1": 1, "2": 2, "3": 3, "5": 5, "7": 7, "31": 31, "32": 32, "255": 255, "65535": 65535, "65536": 65536,
    "1073741824": 2**30, "2147483647": HIGHEST, "-2147483648": LOWEST, "-2147483647": -HIGHEST, "-1": -1, "-7": -7,
    "0x7fffffff": HIGHEST, "0x80000000": LOWEST, "0xffffffff": -1, "0x55555555": 0x55555555, "LOW": LOWEST,
    "HIGH": HIGHEST, "SHIFTED": LOWEST, "LIST[0]": -1, "LIST[1]": 2**30, "LIST[2]": -65536, "LIST[3]": 7,
    "EDGES.x": LOWEST, "EDGES.z": HIGHEST, "EDGES[2]": HIGHEST,
}  # fmt: skip
_UINTS = {
    "0u": 0, "1u": 1, "2u": 2, "7u": 7, "31u": 31, "65535u": 65535, "65536u": 65536, "2147483648u": 2**31,
    "4294967295u": MOST, "0x80000000u": 2**31, "0xffffffffu": MOST, "0xaaaaaaaau": 0xAAAAAAAA, "MOST": MOST, "ONE": 1,
}  # fmt: skip
PARAMETERS: dict[str, int] = {"a": LOWEST + 5, "b": 3, "u": MOST - 2, "v": 1}
"""The arguments with which the values are computed."""


class Part(NamedTuple):
    """An expression and its value: a number, or the numbers of a vector."""

    text: str
    value: tuple[int, ...]


def int32(value: int) -> int:
    return (value + 2**31) % 2**32 - 2**31


def uint32(value: int) -> int:
    return value % 2**32


def divided(x: int, y: int) -> int:
    return abs(x) // abs(y) * (1 if (x < 0) == (y < 0) else -1)


class UndefinedError(Exception):
    """GLSL does not define the value."""


def checked(value: int, *conditions: bool) -> int:
    if not all(conditions):
        raise UndefinedError
    return value


Operator = Callable[[int, int], int]
_OPERATORS: dict[str, Operator] = {
    "+": lambda x, y: x + y, "-": lambda x, y: x - y, "*": lambda x, y: x * y,
    # spirv-opt computes -(x / y) as -x / y, and the remainder of two constants of glslang as (x + y) % y
    "/": lambda x, y: divided(x, checked(y, y != 0, x != LOWEST)),
    "%": lambda x, y: x % checked(y, x >= 0, y > 0, x + y <= HIGHEST),
    "&": lambda x, y: x & y, "|": lambda x, y: x | y, "^": lambda x, y: x ^ y,
    "<<": lambda x, y: x << checked(y, 0 <= y < 32), ">>": lambda x, y: x >> checked(y, 0 <= y < 32),
}  # fmt: skip
_COMPARISONS: dict[str, Callable[[int, int], bool]] = {
    "<": lambda x, y: x < y, ">": lambda x, y: x > y, "<=": lambda x, y: x <= y, ">=": lambda x, y: x >= y,
    "==": lambda x, y: x == y, "!=": lambda x, y: x != y,
}  # fmt: skip


def _reversed(x: int) -> int:
    return int(f"{uint32(x):032b}"[::-1], 2)


def _extracted(wrap: Callable[[int], int], x: int, start: int, count: int) -> int:
    checked(0, start >= 0, count >= 0, start + count <= 32)
    bits = uint32(x) >> start & (1 << count) - 1
    return bits - (1 << count) if wrap is int32 and count and bits >> count - 1 else bits


def _inserted(x: int, y: int, start: int, count: int) -> int:
    checked(0, start >= 0, count >= 0, start + count <= 32)
    mask = (1 << count) - 1 << start
    return uint32(x) & ~mask | uint32(y) << start & mask


def _highest(x: int) -> int:
    return (x if x >= 0 else ~x).bit_length() - 1


def _lowest(x: int) -> int:
    return (x & -x).bit_length() - 1


class Expressions:
    """Random expressions; of `parameters` only the named ones, none for constant expressions."""

    def __init__(self, random: Random, parameters: tuple[str, ...] = tuple(PARAMETERS)) -> None:
        self.random = random
        self.parameters = parameters

    def whole(self, depth: int) -> Part:
        """An expression of type int."""
        while True:
            try:
                kind = self.random.choice(("int", "int", "int", "uint", "bool", "ivec", "uvec", "float"))
                if kind == "int":
                    return self.number("int", depth)
                if kind == "float":
                    return self.through_float(depth)
                if kind in ("ivec", "uvec"):
                    part = self.component("int" if kind == "ivec" else "uint", depth)
                    return Part(f"int({part.text})", (int32(part.value[0]),))
                part = self.number("uint", depth) if kind == "uint" else self.condition(depth)
                return Part(f"int({part.text})", (int32(part.value[0]),))
            except UndefinedError:
                pass

    def leaf(self, kind: str) -> Part:
        names = [name for name in self.parameters if (name in "ab") == (kind == "int")]
        if names and self.random.random() < 0.4:
            name = self.random.choice(names)
            return Part(name, (PARAMETERS[name],))
        text, value = self.random.choice([*(_INTS if kind == "int" else _UINTS).items()])
        return Part(text if text[0] != "-" else f"({text})", (value,))

    def number(self, kind: str, depth: int) -> Part:
        """A scalar."""
        if depth <= 0:
            return self.leaf(kind)
        make = self.random.choice(
            (self.binary, self.binary, self.binary, self.shift, self.unary, self.chosen, self.conversion, self.builtin,
             self.builtin, self.component)
        )  # fmt: skip
        for _ in range(8):
            try:
                return make(kind, depth)
            except UndefinedError:
                pass
        return self.leaf(kind)

    def binary(self, kind: str, depth: int) -> Part:
        op = self.random.choice(("+", "-", "*", "/", "%", "&", "|", "^"))
        left, right = self.number(kind, depth - 1), self.number(kind, depth - 1)
        return Part(f"({left.text} {op} {right.text})", (_wrap(kind, _OPERATORS[op](left.value[0], right.value[0])),))

    def shift(self, kind: str, depth: int) -> Part:
        op = self.random.choice(("<<", ">>"))
        left, right = self.number(kind, depth - 1), self.amount()
        return Part(f"({left.text} {op} {right.text})", (_wrap(kind, _OPERATORS[op](left.value[0], right.value[0])),))

    def amount(self) -> Part:
        count = self.random.choice((0, 1, 4, 15, 16, 30, 31))
        if self.parameters and self.random.random() < 0.3:
            return self.random.choice((Part("b", (PARAMETERS["b"],)), Part("v", (PARAMETERS["v"],))))
        return Part(f"{count}{self.random.choice(('', 'u'))}", (count,))

    def unary(self, kind: str, depth: int) -> Part:
        part = self.number(kind, depth - 1)
        if self.random.random() < 0.5:
            return Part(f"(-{part.text})", (_wrap(kind, -part.value[0]),))
        return Part(f"(~{part.text})", (_wrap(kind, ~part.value[0]),))

    def condition(self, depth: int) -> Part:
        """A bool."""
        kind, pick = self.random.choice(("int", "uint")), self.random.random()
        if pick < 0.2:
            part = self.number(kind, depth - 1)
            return Part(f"bool({part.text})", (int(part.value[0] != 0),))
        if pick < 0.3:
            value = self.random.random() < 0.5
            return Part(str(value).lower(), (int(value),))
        op = self.random.choice([*_COMPARISONS])
        left, right = self.number(kind, depth - 1), self.number(kind, depth - 1)
        return Part(f"({left.text} {op} {right.text})", (int(_COMPARISONS[op](left.value[0], right.value[0])),))

    def chosen(self, kind: str, depth: int) -> Part:
        condition, yes, no = self.condition(depth - 1), self.number(kind, depth - 1), self.number(kind, depth - 1)
        value = yes.value if condition.value[0] else no.value
        if self.random.random() < 0.5:
            return Part(f"mix({no.text}, {yes.text}, {condition.text})", value)
        return Part(f"({condition.text} ? {yes.text} : {no.text})", value)

    def conversion(self, kind: str, depth: int) -> Part:
        source = self.random.choice(("int", "uint", "bool"))
        part = self.condition(depth - 1) if source == "bool" else self.number(source, depth - 1)
        return Part(f"{kind}({part.text})", (_wrap(kind, part.value[0]),))

    def through_float(self, depth: int) -> Part:
        """A comparison of the converted number, or the number itself where a float holds it."""
        kind = self.random.choice(("int", "uint"))
        part = self.number(kind, depth - 1)
        if abs(part.value[0]) < 2**24:
            return Part(f"int(float({part.text}))", (int32(part.value[0]),))
        return Part(f"int(float({part.text}) < 0.0)", (int(part.value[0] < 0),))

    def builtin(self, kind: str, depth: int) -> Part:
        name = self.random.choice(
            ("abs", "sign", "min", "max", "clamp", "bitCount", "findLSB", "findMSB", "bitfieldReverse",
             "bitfieldExtract", "bitfieldExtract", "bitfieldInsert")
        )  # fmt: skip
        if name in ("bitCount", "findLSB", "findMSB"):
            part = self.number(self.random.choice(("int", "uint")), depth - 1)
            return Part(f"{kind}({name}({part.text}))", (_wrap(kind, _COUNTS[name](part.value[0])),))
        if name in ("abs", "sign"):
            part = self.number("int", depth - 1)
            value = abs(part.value[0]) if name == "abs" else (part.value[0] > 0) - (part.value[0] < 0)
            return Part(f"{kind}({name}({part.text}))", (_wrap(kind, int32(value)),))
        first = self.number(kind, depth - 1)
        rest, values = self.of_components(name, kind, first, depth)
        text = ", ".join([part.text for part in (first, *rest)])
        return Part(f"{name}({text})", (_wrap(kind, values[0]),))

    def of_components(self, name: str, kind: str, first: Part, depth: int) -> tuple[list[Part], list[int]]:
        """The other arguments of a builtin, scalars, and the results for the components of the first one."""
        if name.startswith("bitfield"):
            start = self.random.choice((0, 0, 1, 8, 31, 32))
            count = self.random.choice((0, 1, 8, 31 - start, 32 - start))
            field = [Part(str(start), (start,)), Part(str(count), (count,))]
            if name == "bitfieldReverse":
                return [], [_reversed(x) for x in first.value]
            if name == "bitfieldExtract":
                return field, [_extracted(_WRAPS[kind], x, start, count) for x in first.value]
            y = self.number(kind, depth - 1)
            return [y, *field], [_inserted(x, y.value[0], start, count) for x in first.value]
        rest = [self.number(kind, depth - 1) for _ in range(2 if name == "clamp" else 1)]
        low, high = rest[0].value[0], rest[-1].value[0]
        if name == "clamp":
            return rest, [checked(min(max(x, low), high), low <= high) for x in first.value]
        return rest, [(min if name == "min" else max)(x, low) for x in first.value]

    def component(self, kind: str, depth: int) -> Part:
        """One component of a vector."""
        vector = self.vector(kind, depth)
        place = self.random.randrange(len(vector.value))
        text = f"{vector.text}.{'xyzw'[place]}" if self.random.random() < 0.7 else f"{vector.text}[{place}]"
        return Part(text, (vector.value[place],))

    def vector(self, kind: str, depth: int) -> Part:
        size = self.random.choice((2, 3, 4))
        type_ = f"{'i' if kind == 'int' else 'u'}vec{size}"
        parts = [self.number(kind, depth - 1) for _ in range(size if self.random.random() < 0.7 else 1)]
        values = [part.value[0] for part in parts] * (size // len(parts))
        whole = Part(f"{type_}({', '.join([part.text for part in parts])})", tuple(values))
        return self.vector_operation(whole, kind, depth) if self.random.random() < 0.7 else whole

    def vector_operation(self, left: Part, kind: str, depth: int) -> Part:
        op = self.random.choice(
            ("+", "-", "*", "&", "^", "<<", ">>", "-", "~", "min", "max", "bitCount", "findLSB", "findMSB",
             "bitfieldReverse", "bitfieldExtract", "bitfieldInsert", "mix", "clamp")
        )  # fmt: skip
        type_ = f"{'i' if kind == 'int' else 'u'}vec{len(left.value)}"
        if op == "~":
            return Part(f"(~{left.text})", tuple([_wrap(kind, ~value) for value in left.value]))
        if op in _COUNTS:
            return Part(f"{type_}({op}({left.text}))", tuple([_wrap(kind, _COUNTS[op](x)) for x in left.value]))
        if op == "mix":
            right, condition = self.number(kind, depth - 1), self.condition(depth - 1)
            bools = f"bvec{len(left.value)}({condition.text})"
            mixed = right.value * len(left.value) if condition.value[0] else left.value
            return Part(f"mix({left.text}, {type_}({right.text}), {bools})", mixed)
        if op.startswith("bitfield") or op in ("min", "max", "clamp"):
            rest, values = self.of_components(op, kind, left, depth)
            first = rest[:1] if op != "bitfieldInsert" else [Part(f"{type_}({rest[0].text})", ())]
            texts = [part.text for part in (left, *first, *rest[1:])]
            return Part(f"{op}({', '.join(texts)})", tuple([_wrap(kind, value) for value in values]))
        right = self.amount() if op in ("<<", ">>") else self.number(kind, depth - 1)
        results = tuple([_wrap(kind, _OPERATORS[op](value, right.value[0])) for value in left.value])
        return Part(f"({left.text} {op} {right.text})", results)


_WRAPS = {"int": int32, "uint": uint32}
_COUNTS: dict[str, Callable[[int], int]] = {
    "bitCount": lambda x: uint32(x).bit_count(), "findLSB": _lowest, "findMSB": _highest
}  # fmt: skip


def _wrap(kind: str, value: int) -> int:
    return _WRAPS[kind](value)


def program(parts: list[Part]) -> str:
    """A function `f` that returns the expression number `n`."""
    lines = [f"    if (n == {number}) {{ return {part.text}; }}" for number, part in enumerate(parts)]
    head = "int f(int n, int a, int b, uint u, uint v) {"
    return "\n".join([CONSTANTS, head, *lines, "    return 0;", "}"])


def result_of(builtin: str, kind: str, x: int, y: int, start: int, count: int) -> int:
    """A builtin of x, or of x, y and a field."""
    if builtin in _COUNTS:
        return _COUNTS[builtin](x)
    results: dict[str, Callable[[], int]] = {
        "abs": lambda: abs(x), "sign": lambda: (x > 0) - (x < 0), "bitfieldReverse": lambda: _reversed(x),
        "bitfieldExtract": lambda: _extracted(_WRAPS[kind], x, start, count),
        "bitfieldInsert": lambda: _inserted(x, y, start, count),
    }  # fmt: skip
    return _wrap(kind, results[builtin]())
