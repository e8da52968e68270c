"""Random expressions of integers over their whole range, and of bools."""

from __future__ import annotations

from glsl_scope import INTEGERS, LARGE, Scoped, binary, call, literal
from glsl_tree import Node
from glsl_values import kind, vector, vector_size, wrapped


class Integers(Scoped):
    """Expressions of ints, uints and bools."""

    # Integers

    def integer_literal(self, kind_: str) -> Node:
        value = self.random.choice(INTEGERS[:12] if self.chance(55) else INTEGERS + LARGE)
        if kind_ == "uint":
            spelled = self.random.choice((f"{value}u", f"{value}U", f"0x{value:x}u", f"0x{value:X}U"))
            return Node("literal", "uint", [], (value, spelled))
        if value > 0x7FFFFFFF:
            return Node("literal", "int", [], (wrapped("int", value), f"0x{value:08x}"))
        if self.chance(25):
            return Node("literal", "int", [], (-value, f"-{value}"))
        spelled = self.random.choice((str(value), str(value), f"0x{value:x}", f"0{value:o}"))
        return Node("literal", "int", [], (value, spelled))

    def atom(self, type_: str) -> Node:
        """A variable or a literal."""
        leaf = self.leaf(type_) if self.chance(78) else None
        if leaf is not None:
            return leaf
        kind_, size = kind(type_), vector_size(type_)
        number = literal("bool", self.chance(50)) if kind_ == "bool" else self.integer_literal(kind_)
        if not size:
            return number
        if self.chance(40):
            return Node("construct", type_, [number], type_)
        rest = [
            literal("bool", self.chance(50)) if kind_ == "bool" else self.integer_literal(kind_)
            for _ in range(size - 1)
        ]
        return Node("construct", type_, [number, *rest], type_)

    def count(self, type_: str) -> Node:
        """A shift's count."""
        kind_ = kind(type_)
        if self.constant or self.chance(50):
            number = literal(kind_, self.random.choice((0, 1, 2, 3, 4, 8, 15, 16, 24, 28, 30, 31)))
            return number if not vector_size(type_) else Node("construct", type_, [number], type_)
        return binary("&", type_, self.integer(type_, 1), literal(kind_, self.random.choice((1, 3, 7, 15, 31))))

    def divisor(self, type_: str) -> Node:
        kind_ = kind(type_)
        if self.constant or self.chance(40):
            values = (1, 2, 3, 5, 7, 10, 16, 255, 65536, 2147483647)
            number = literal(
                kind_,
                self.random.choice(values + ((0xFFFFFFFF, 0x80000001) if kind_ == "uint" else (-2, -3, -7, -100))),
            )
            return number if not vector_size(type_) else Node("construct", type_, [number], type_)
        if kind_ == "uint" and self.chance(60):
            return binary("|", type_, self.integer(type_, 1), literal(kind_, 1))
        low = binary("&", type_, self.integer(type_, 1), literal(kind_, self.random.choice((1, 7, 15, 255))))
        value = binary("+", type_, low, literal(kind_, self.random.choice((1, 2, 3))))
        return (
            Node("unary", type_, [binary("+", type_, value, literal(kind_, 1))], "-")
            if kind_ == "int" and self.chance(30)
            else value
        )

    def integer(self, type_: str, depth: int) -> Node:
        if depth <= 0 or self.chance(12):
            return self.atom(type_)
        shared = self.shared(type_, depth)
        if shared is not None:
            return shared
        kind_, size, inner = kind(type_), vector_size(type_) or 1, depth - 1
        rule = self.random.randrange(100)
        if rule < 42:
            op = self.random.choice(("+", "-", "*", "&", "|", "^", "+", "-", "*"))
            types = [type_, type_]
            if size > 1 and self.chance(30):
                types[self.random.randrange(2)] = kind_
            elif kind_ == "uint" and self.chance(12):
                types[self.random.randrange(2)] = vector("int", size)
            return binary(op, type_, *(self.integer(operand_type, inner) for operand_type in types))
        if rule < 48:
            left = self.integer(type_, inner)
            if self.chance(50) and kind_ == "int":
                left = binary("&", type_, left, literal("int", 0x7FFFFFFF))
                low = binary("&", type_, self.integer(type_, 1), literal("int", 63))
                return binary("%", type_, left, binary("+", type_, low, literal("int", 1)))
            return binary(self.random.choice(("/", "%")) if kind_ == "uint" else "/", type_, left, self.divisor(type_))
        if rule < 58:
            counts = vector(self.random.choice(("int", "uint")), 1 if self.chance(40) else size)
            return binary(self.random.choice(("<<", ">>", ">>")), type_, self.integer(type_, inner), self.count(counts))
        if rule < 64:
            op = self.random.choice(("-", "~", "+", "-"))
            return Node("unary", type_, [self.integer(type_, inner)], op)
        if rule < 80:
            return self.integer_builtin(type_, inner)
        if rule < 86 and size > 1:
            return self.assembled(type_, inner)
        if rule < 88 and not self.constant:
            symbol = self.leaf(self.random.choice(("int[2]", "int[3]", "vec3", "ivec2", "float[3]")))
            if symbol is not None and type_ == "int" and symbol.kind == "name":
                return Node("length", "int", [symbol])
        return self.cast(type_, inner)

    def integer_builtin(self, type_: str, depth: int) -> Node:
        kind_, size = kind(type_), vector_size(type_) or 1
        x = self.integer(type_, depth)
        rule = self.random.randrange(12)
        if rule == 0 and kind_ == "int":
            if self.chance(50):
                return call("sign", type_, x)
            return call(
                "abs",
                type_,
                binary(">>", type_, x, literal("int", 1))
                if self.chance(50)
                else call("max", type_, x, literal("int", -100)),
            )
        if rule < 3:
            second = self.integer(kind_ if self.chance(20) else type_, depth)
            return call(self.random.choice(("min", "max")), type_, x, second)
        if rule == 3:
            low, high = sorted(
                (self.random.randrange(-9 if kind_ == "int" else 0, 9), self.random.choice((9, 100, 2147483647)))
            )
            return call("clamp", type_, x, literal(kind_, low), literal(kind_, high))
        if rule == 4:
            a, b = self.integer(type_, depth), self.boolean(vector("bool", size), depth)
            return call("mix", type_, x, a, b)
        if rule in (5, 6):
            offset, bits = self.field()
            if rule == 5:
                return call("bitfieldExtract", type_, x, offset, bits)
            return call("bitfieldInsert", type_, x, self.integer(type_, depth), offset, bits)
        if rule == 7:
            return call("bitfieldReverse", type_, x)
        if kind_ == "int" and rule in (8, 9):
            name = self.random.choice(("bitCount", "findLSB", "findMSB"))
            return call(name, type_, self.integer(vector(self.random.choice(("int", "uint")), size), depth))
        if rule == 10 and not self.constant:
            value = self.exact(vector("float", size), depth)
            safe = binary("+", value.node.type, call("abs", value.node.type, self.fit(value)), literal("float", 1.0))
            return call("floatBitsToInt" if kind_ == "int" else "floatBitsToUint", type_, safe)
        if rule == 11 and type_ == "uint" and not self.quiet and not self.constant and self.chance(self.effects * 2):
            place = self.target("uint", pure=True)
            if place is not None:
                return call(
                    self.random.choice(("uaddCarry", "usubBorrow")), "uint", x, self.integer("uint", depth), place
                )
        if type_ == "uint" and not self.constant:
            positive = call("abs", "vec2", self.fit(self.exact("vec2", depth)))  # the sign of 0 can be another
            return call("packHalf2x16", "uint", positive)
        return x

    def field(self) -> tuple[Node, Node]:
        """An offset and a number of bits, at most 32 together."""
        if self.constant or self.chance(50):
            offset = self.random.randrange(33)
            bits = self.random.choice((0, min(1, 32 - offset), 32 - offset, self.random.randint(0, 32 - offset)))
            return literal("int", offset), literal("int", bits)
        return tuple(
            binary("&", "int", self.integer("int", 1), literal("int", mask))
            for mask in self.random.choice(((15, 15), (7, 15), (15, 7)))
        )

    def assembled(self, type_: str, depth: int) -> Node:
        """A vector's constructor of scalars and vectors of any kind, or a part of a longer vector."""
        kind_, size = kind(type_), vector_size(type_)
        if self.chance(25) and size < 4:
            return Node("construct", type_, [self.cast_source(kind_, size + 1, depth)], type_)
        args, left = [], size
        while left:
            take = self.random.randint(1, min(left, 3))
            args.append(self.cast_source(kind_, take, depth))
            left -= take
        return Node("construct", type_, args, type_)

    def cast_source(self, kind_: str, size: int, depth: int) -> Node:
        """An operand for a conversion to a kind, where every conversion is defined."""
        from_ = self.random.choice(("int", "uint", "bool", "float", kind_, kind_))
        if kind_ == "float":
            return self.exact_source(from_, size, depth)
        source = vector(from_, size)
        if from_ == "float":
            value = self.fit(self.exact(source, depth))
            return call("abs", source, value) if kind_ == "uint" else value
        return self.boolean(source, depth) if from_ == "bool" else self.integer(source, depth)

    def exact_source(self, from_: str, size: int, depth: int) -> Node:
        source = vector(from_, size)
        if from_ == "float":
            return self.fit(self.exact(source, depth))
        if from_ == "bool":
            return self.boolean(source, depth)
        return binary("&", source, self.integer(source, depth), literal(from_, self.random.choice((3, 15, 63))))

    def cast(self, type_: str, depth: int) -> Node:
        size = vector_size(type_) or 1
        extra = self.random.randint(size, 4) if size == 1 and self.chance(10) else size
        return Node("construct", type_, [self.cast_source(kind(type_), extra, depth)], type_)

    # Booleans

    def boolean(self, type_: str, depth: int) -> Node:
        if depth <= 0 or self.chance(10):
            return self.atom(type_)
        shared = self.shared(type_, depth)
        if shared is not None:
            return shared
        size, inner, rule = vector_size(type_) or 1, depth - 1, self.random.randrange(100)
        if size > 1:
            if rule < 55:
                operand = vector(self.random.choice(("int", "uint", "float")), size)
                names = ("lessThan", "lessThanEqual", "greaterThan", "greaterThanEqual", "equal", "notEqual")
                return call(self.random.choice(names), type_, self.value(operand, inner), self.value(operand, inner))
            if rule < 65:
                return call("not", type_, self.boolean(type_, inner))
            if rule < 75:
                return call(
                    self.random.choice(("equal", "notEqual")),
                    type_,
                    self.boolean(type_, inner),
                    self.boolean(type_, inner),
                )
            return self.assembled(type_, inner) if rule < 90 else self.cast(type_, inner)
        if rule < 45:
            operand = self.random.choice(("int", "int", "uint", "float"))
            other = "int" if operand == "uint" and self.chance(10) else operand
            op = self.random.choice(("<", ">", "<=", ">=", "==", "!="))
            return binary(op, "bool", self.value(operand, inner), self.value(other, inner))
        if rule < 62:
            op = self.random.choice(("&&", "||", "&&", "||", "^^"))
            return binary(op, "bool", self.boolean("bool", inner), self.boolean("bool", inner))
        if rule < 70:
            return Node("unary", "bool", [self.boolean("bool", inner)], "!")
        if rule < 82:
            types = ["ivec2", "uvec3", "vec2", "bvec3", "bool", "mat2", *self.program.structs, "int[2]", "float[3]"]
            operand = self.random.choice(types)
            if not (self.constant and (operand in self.program.structs or "[" in operand)):
                return binary(
                    self.random.choice(("==", "!=")), "bool", self.value(operand, inner), self.value(operand, inner)
                )
        if rule < 90:
            return call(
                self.random.choice(("any", "all")), "bool", self.boolean(f"bvec{self.random.randint(2, 4)}", inner)
            )
        return self.cast("bool", inner)
