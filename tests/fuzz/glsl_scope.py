"""The names in scope, and what random expressions of all kinds share.

Expressions never do what GLSL leaves undefined, or almost never: the interpreter finds the rest.

Floats are multiples of a power of two within bounds that each expression carries, so that nothing is rounded.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from random import Random
from typing import NamedTuple

from glsl_names import LOCALS, PLAIN_NAMES
from glsl_tree import Function, Macro, Node, Program
from glsl_values import element, kind, matrix_size, vector, vector_size

INTEGERS = (
    0, 1, 2, 3, 5, 7, 8, 15, 16, 31, 32, 63, 64, 100, 127, 128, 255, 256, 1023, 32767, 32768, 65535, 65536, 1 << 24,
    (1 << 24) + 1, (1 << 30) - 1, 1 << 30, 0x55555555, 0x0F0F0F0F, 2147483646, 2147483647,
)  # fmt: skip
LARGE = (0x7FFFFFFF, 0x80000000, 0x80000001, 0xFFFFFFFF, 0xFFFFFFFE, 0xDEADBEEF, 0xAAAAAAAA, 0xC0000000)
EIGHTHS = 3
LIMIT = 64.0
MATRIX_LIMIT = 8.0
SETS = ("xyzw", "rgba", "stpq")


class Bound(NamedTuple):
    """A float expression whose components are multiples of 2 to the power of -`places`, and at most `limit` large."""

    node: Node
    limit: float
    places: int


class Symbol(NamedTuple):
    """What a name means at this point; the type is '' for functions, types and macros."""

    name: str
    type: str
    writable: bool


def call(name: str, type_: str, *args: Node) -> Node:
    """A call of a builtin."""
    return Node("builtin", type_, list(args), name)


def binary(op: str, type_: str, left: Node, right: Node) -> Node:
    """A binary operator."""
    return Node("binary", type_, [left, right], op)


def literal(type_: str, value: object) -> Node:
    """A literal in its plainest spelling."""
    if type_ == "bool":
        return Node("literal", type_, [], (value, str(value).lower()))
    if type_ == "uint":
        return Node("literal", type_, [], (value, f"{value}u"))
    if type_ == "int" and value == -0x80000000:
        return Node("literal", type_, [], (value, "(-2147483647 - 1)"))
    return Node("literal", type_, [], (value, repr(value)))


class Scoped(ABC):
    """The names in scope, and expressions over them."""

    def __init__(self, random: Random) -> None:
        self.random = random
        self.program = Program()
        self.scopes: list[dict[str, Symbol]] = [{}]
        self.callable: list[Function] = []
        self.constant = False
        """Whether only constant expressions are allowed."""
        self.quiet = 0
        """Above 0: expressions have no effects."""
        self.effects = random.choice((0, 5, 10, 25))
        """The share of expressions with effects, in percent."""
        self.names: tuple[str, ...] = PLAIN_NAMES if random.random() < 0.4 else LOCALS
        self.used_globals: set[str] = set()

    def chance(self, percent: int) -> bool:
        return self.random.randrange(100) < percent

    # Names

    def visible(self) -> dict[str, Symbol]:
        symbols: dict[str, Symbol] = {}
        for scope in self.scopes:
            symbols |= scope
        return symbols

    def new_name(self, names: tuple[str, ...] = ()) -> str:
        """A name that is free in the innermost scope; it may hide one outside, but no struct: that is constructed."""
        scope, names = self.scopes[-1], names or self.names
        taken = self.program.macros.keys() | self.program.structs.keys()
        taken |= self.used_globals if len(self.scopes) == 1 else set()
        for _ in range(20):
            name = self.random.choice(names)
            if name not in scope and name not in taken:
                return name
        number = 3
        while f"{name}_{number}" in scope or f"{name}_{number}" in taken:
            number += 1
        return f"{name}_{number}"

    def declare(self, name: str, type_: str, writable: bool = True) -> None:
        self.scopes[-1][name] = Symbol(name, type_, writable)

    # Parts of variables

    def parts(self, type_: str) -> Iterator[str]:
        """The types one step inside a type."""
        if "[" in type_:
            yield element(type_)[0]
        elif type_ in self.program.structs:
            for field, _ in self.program.structs[type_]:
                yield field
        elif size := matrix_size(type_):
            yield f"vec{size}"
        elif size := vector_size(type_):
            for count in range(1, size + 1):
                yield vector("~float" if type_[0] == "~" else kind(type_), count)

    def reaches(self, type_: str, wanted: str) -> bool:
        return type_ == wanted or any(self.reaches(part, wanted) for part in set(self.parts(type_)) if part != type_)

    def part_of(self, node: Node, wanted: str, write: bool) -> Node:
        """A random part of that type."""
        while node.type != wanted or (vector_size(wanted) and self.chance(15)):
            type_ = node.type
            if type_ in self.program.structs:
                fields = [
                    (part_type, name)
                    for part_type, name in self.program.structs[type_]
                    if self.reaches(part_type, wanted)
                ]
                part_type, name = self.random.choice(fields)
                node = Node("member", part_type, [node], name)
            elif "[" in type_:
                inner, length = element(type_)
                node = Node("index", inner, [node, self.index(length)])
            elif size := matrix_size(type_):
                node = Node("index", f"vec{size}", [node, self.index(size)])
            else:
                size, wanted_size = vector_size(type_), vector_size(wanted) or 1
                if wanted_size == 1 and self.chance(35):
                    node = Node("index", wanted, [node, self.index(size)])
                    continue
                letters = self.random.choice(SETS)[:size]
                if write and wanted_size > size:
                    return node
                chosen = (
                    self.random.sample(letters, wanted_size) if write else self.random.choices(letters, k=wanted_size)
                )
                if "".join(chosen) == letters and write and self.chance(50):
                    continue
                node = Node("swizzle", wanted, [node], "".join(chosen))
        return node

    def index(self, length: int) -> Node:
        """An index that is in range."""
        if self.constant or self.chance(45):
            type_ = "uint" if self.chance(15) else "int"
            return literal(type_, self.random.randrange(length))
        type_ = "uint" if self.chance(25) else "int"
        if length & (length - 1) == 0:
            return binary("&", type_, self.integer(type_, 1), literal(type_, length - 1))
        if type_ == "uint":
            choices = [call("min", type_, self.integer(type_, 1), literal(type_, length - 1)),
                       binary("%", type_, self.integer(type_, 1), literal(type_, length))]  # fmt: skip
            return self.random.choice(choices)
        if self.chance(50):
            return call("clamp", type_, self.integer(type_, 1), literal(type_, 0), literal(type_, length - 1))
        low = binary("&", type_, self.integer(type_, 1), literal(type_, self.random.choice((15, 255, 0x7FFFFFFF))))
        return binary("%", type_, low, literal(type_, length))

    def leaf(self, type_: str) -> Node | None:
        """A part of a variable in scope."""
        symbols = [
            symbol for symbol in self.visible().values()
            if symbol.type and self.reaches(symbol.type, type_) and (not self.constant or not symbol.writable)
        ]  # fmt: skip
        if self.constant:
            symbols = [symbol for symbol in symbols if symbol.name in self.constants]
        if not symbols:
            return None
        symbol = self.random.choice(symbols)
        self.quiet += self.chance(80)
        quiet, node = self.quiet, Node("name", symbol.type, [], symbol.name)
        node = self.part_of(node, type_, write=False)
        self.quiet = max(0, quiet - 1) if quiet else 0
        return node

    constants: frozenset[str] | set[str] = frozenset()
    """The names of constants."""

    def target(self, type_: str, pure: bool = False) -> Node | None:
        """A place of that type that can be written."""
        symbols = [
            symbol
            for symbol in self.visible().values()
            if symbol.type and symbol.writable and self.reaches(symbol.type, type_)
        ]
        if not symbols:
            return None
        symbol = self.random.choice(symbols)
        self.quiet += pure
        node = self.part_of(Node("name", symbol.type, [], symbol.name), type_, write=True)
        self.quiet -= pure
        return node

    def value(self, type_: str, depth: int = 2) -> Node:
        """An expression of any type, fit to be stored."""
        if "[" in type_ or type_ in self.program.structs:
            return self.whole(type_, depth)
        if type_.startswith("~"):
            return self.smooth(type_, depth)
        kind_ = kind(type_)
        if kind_ == "float":
            return self.fit(self.exact(type_, depth))
        return self.boolean(type_, depth) if kind_ == "bool" else self.integer(type_, depth)

    def stored(self, type_: str, depth: int = 2) -> Node:
        """A value for a place of the type, sometimes with an implicit conversion."""
        size = vector_size(type_) or 1
        if type_ in ("uint", "uvec2", "uvec3", "uvec4") and self.chance(12):
            return self.integer(vector("int", size), depth)
        if type_ in ("float", "vec2", "vec3", "vec4") and self.chance(8):
            kind_ = self.random.choice(("int", "uint"))
            small = self.integer(vector(kind_, size), depth - 1)
            return Node("binary", small.type, [small, literal(kind_, 31)], "&")
        return self.value(type_, depth)

    def whole(self, type_: str, depth: int) -> Node:
        """An array or a struct."""
        leaf = self.leaf(type_) if self.chance(40) else None
        if leaf is not None:
            return leaf
        if depth > 0 and not self.constant and self.chance(20):
            return Node("choice", type_, [self.boolean("bool", 1), self.whole(type_, 0), self.whole(type_, 0)])
        call_ = self.called(type_, depth) if self.chance(25) else None
        if call_ is not None:
            return call_
        if "[" in type_:
            inner, length = element(type_)
            spelled = f"{inner}[]" if self.chance(30) else type_
            return Node("construct", type_, [self.stored(inner, depth - 1) for _ in range(length)], spelled)
        return Node(
            "construct",
            type_,
            [self.stored(part_type, depth - 1) for part_type, _ in self.program.structs[type_]],
            type_,
        )

    # What all kinds share

    def shared(self, type_: str, depth: int) -> Node | None:
        """A choice, call, macro, comma, or an expression with an effect; None if none was chosen."""
        if self.constant:
            return None
        percent = self.random.randrange(100)
        if percent < 6:
            return Node(
                "choice",
                type_,
                [self.boolean("bool", depth - 1), self.value(type_, depth - 1), self.value(type_, depth - 1)],
            )
        if percent < 14:
            return self.called(type_, depth)
        if percent < 18:
            return self.from_macro(type_, depth)
        if percent < 20:
            return self.of_temporary(type_, depth)
        if not self.quiet and self.chance(self.effects):
            return self.effect(type_, depth)
        return None

    def of_temporary(self, type_: str, depth: int) -> Node | None:
        """A part of a constructor or of a call's result."""
        size = self.random.randint(2, 4)
        if "[" in type_ or type_ in self.program.structs or matrix_size(type_) or depth < 1:
            return None
        whole = self.whole(f"{type_}[{size}]", 0)
        if whole.kind == "construct" or whole.kind == "call":
            return Node("index", type_, [whole, self.index(size)])
        return None

    def called(self, type_: str, depth: int) -> Node | None:
        """A call of a function that returns the type."""
        visible = self.visible()
        functions = [
            function for function in self.callable
            if function.result == type_ and visible.get(function.name, Symbol("", "", False)).type == ""
            and (not self.quiet or all(param.direction in ("", "in", "const in") for param in function.params))
        ]  # fmt: skip
        if not functions or depth < 1 or self.constant:
            return None
        return self.call_of(self.random.choice(functions), depth)

    def call_of(self, function: Function, depth: int) -> Node | None:
        """A call; places of `out` parameters are often the same."""
        args: list[Node] = []
        places: list[Node] = []
        for param in function.params:
            if param.direction in ("out", "inout"):
                candidates = [place for place in places if place.type == param.type]
                place = (
                    self.random.choice(candidates)
                    if candidates and self.chance(35)
                    else self.target(param.type, self.chance(60))
                )
                if place is None:
                    return None
                places.append(place)
                args.append(place)
            else:
                args.append(self.value(param.type, depth - 1))
        return Node("call", function.result, args, function.name)

    def effect(self, type_: str, depth: int) -> Node | None:
        """An assignment, a step, or a comma."""
        kind_ = kind(type_)
        if self.chance(12):
            first = self.effect(type_, depth)
            if first is not None:
                return Node("brackets", type_, [Node("comma", type_, [first, self.value(type_, depth - 1)])])
        if "[" in type_ or type_ in self.program.structs or matrix_size(type_) or type_.startswith("~"):
            return None
        place = self.target(type_, pure=self.chance(70))
        if place is None:
            return None
        if kind_ in ("int", "uint") and self.chance(55):
            return Node("step", type_, [place], (self.random.choice(("++", "--")), self.chance(50)))
        return self.assignment(place, depth - 1)

    def assignment(self, place: Node, depth: int) -> Node:
        """`=` or a compound assignment."""
        type_, kind_ = place.type, kind(place.type)
        op = "="
        value = None
        if kind_ in ("int", "uint") and "[" not in type_ and type_ not in self.program.structs and self.chance(60):
            op = self.random.choice(("+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="))
            operand = kind_ if self.chance(30) else type_
            if op in ("<<=", ">>="):
                value = self.count(vector(self.random.choice(("int", "uint")), vector_size(operand) or 1))
            elif op == "%=" and kind_ == "int":
                op = "+="
            elif op in ("/=", "%="):
                value = self.divisor(operand)
            value = value or self.integer(operand, depth)
        elif kind_ == "float" and not type_.startswith("~") and "[" not in type_ and self.chance(40):
            if type_ in self.program.structs or matrix_size(type_):
                pass
            elif self.chance(50):
                op = self.random.choice(("+=", "-="))
                operand = "float" if self.chance(30) else type_
                value = self.fit(self.exact(operand, depth), 8.0, 1)
            else:
                op, value = "*=", literal("float", self.random.choice((-1.0, 0.5, 1.0, 2.0)))
        return Node("assign", type_, [place, value or self.stored(type_, depth)], op)

    def from_macro(self, type_: str, depth: int) -> Node | None:
        """A use of a macro; its arguments have no effects, as they may be repeated."""
        macros: list[Macro] = [macro for macro in self.program.macros.values() if macro.body.type == type_]
        if not macros:
            return None
        macro = self.random.choice(macros)
        self.quiet += 1
        args = [self.integer(type_, depth - 1) for _ in macro.params]
        self.quiet -= 1
        return Node("macro", type_, args, macro.name)

    # What the other modules define

    @abstractmethod
    def integer(self, type_: str, depth: int) -> Node:
        """An expression of an int or uint, or of a vector of them."""

    @abstractmethod
    def boolean(self, type_: str, depth: int) -> Node:
        """An expression of a bool or a vector of bools."""

    @abstractmethod
    def count(self, type_: str) -> Node:
        """A shift's count."""

    @abstractmethod
    def divisor(self, type_: str) -> Node:
        """A divisor that is not 0, nor -1 where that could overflow."""

    @abstractmethod
    def exact(self, type_: str, depth: int) -> Bound:
        """An expression of floats that are not rounded."""

    @abstractmethod
    def fit(self, bound: Bound, limit: float = LIMIT, places: int = EIGHTHS) -> Node:
        """The expression, limited to what variables hold."""

    @abstractmethod
    def smooth(self, type_: str, depth: int) -> Node:
        """A value that may be rounded."""
