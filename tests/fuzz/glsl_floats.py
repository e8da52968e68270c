"""Random expressions of floats: exact ones, which may decide, and smooth ones, which may be rounded."""

from __future__ import annotations

from glsl_integers import Integers
from glsl_scope import EIGHTHS, LIMIT, MATRIX_LIMIT, Bound, binary, call, literal
from glsl_tree import Node
from glsl_values import matrix_size, vector, vector_size


def _number(value: float) -> Node:
    return literal("float", value)


class Expressions(Integers):
    """Expressions of every type."""

    # Floats without rounding

    def fit(self, bound: Bound, limit: float = LIMIT, places: int = EIGHTHS) -> Node:
        """The expression, limited to what variables hold."""
        node, type_ = bound.node, bound.node.type
        if size := matrix_size(type_):
            if bound.limit <= MATRIX_LIMIT and bound.places <= 1:
                return node
            return self.matrix_leaf(size)
        if bound.limit > limit:
            node = call("clamp", type_, node, literal("float", -limit), literal("float", limit))
        if bound.places > places:
            scale = float(1 << places)
            node = binary(
                "/",
                type_,
                call("floor", type_, binary("*", type_, node, literal("float", scale))),
                literal("float", scale),
            )
        return node

    def exact(self, type_: str, depth: int) -> Bound:
        if size := matrix_size(type_):
            return self.matrix(size, depth)
        bound = self.exact_rule(type_, depth)
        if bound.limit * 2.0**bound.places > 1 << 22 or bound.places > 10:
            return Bound(self.fit(bound), LIMIT, EIGHTHS)
        return bound

    def float_leaf(self, type_: str) -> Bound:
        leaf = self.leaf(type_) if self.chance(78) else None
        if leaf is not None:
            return Bound(leaf, LIMIT, EIGHTHS)
        numbers = (0.0, 0.5, 1.0, 1.5, 2.0, 0.125, 3.0, 0.25, 7.5, 10.0, 16.0, 63.875)
        number = self.float_literal(self.random.choice(numbers))
        if size := vector_size(type_):
            if self.chance(40):
                return Bound(Node("construct", type_, [number], type_), LIMIT, EIGHTHS)
            rest = [self.float_literal(self.random.choice(numbers)) for _ in range(size - 1)]
            return Bound(Node("construct", type_, [number, *rest], type_), LIMIT, EIGHTHS)
        return Bound(number, LIMIT, EIGHTHS)

    def float_literal(self, number: float) -> Node:
        texts = [repr(number), repr(number), f"{number}f", f"{number:e}"]
        if number == int(number):
            texts += [f"{int(number)}.", f"{int(number)}.f"]
        if 0.0 < number < 1.0:
            texts.append(repr(number)[1:])
        text = self.random.choice(texts)
        return Node("literal", "float", [], (-number, f"-{text}") if self.chance(25) and number else (number, text))

    def exact_rule(self, type_: str, depth: int) -> Bound:
        if depth <= 0 or self.chance(12):
            return self.float_leaf(type_)
        size, inner, rule = vector_size(type_) or 1, depth - 1, self.random.randrange(100)
        if (shared := self.shared(type_, depth)) is not None:
            return Bound(shared, LIMIT, EIGHTHS)
        if rule < 40:
            op = self.random.choice("++-*")
            types = [type_, type_]
            if size > 1 and self.chance(30):
                types[self.random.randrange(2)] = "float"
            a, b = (self.exact(operand_type, inner) for operand_type in types)
            if op == "*":
                if a.limit * b.limit * 2.0 ** (a.places + b.places) > 1 << 22:
                    a, b = Bound(self.fit(a), LIMIT, EIGHTHS), Bound(self.fit(b), LIMIT, EIGHTHS)
                return Bound(binary("*", type_, a.node, b.node), a.limit * b.limit, a.places + b.places)
            return Bound(binary(op, type_, a.node, b.node), a.limit + b.limit, max(a.places, b.places))
        x = self.exact(type_, inner)
        if rule < 45:
            return x._replace(node=Node("unary", type_, [x.node], self.random.choice("--+")))
        if rule < 50:
            return Bound(
                binary("/", type_, x.node, literal("float", self.random.choice((2.0, 4.0, -2.0)))),
                x.limit,
                x.places + 2,
            )
        if rule < 60:
            name = self.random.choice(("abs", "floor", "ceil", "trunc", "roundEven", "sign", "fract"))
            return Bound(call(name, type_, x.node), x.limit + 1.0, x.places)
        if rule < 70:
            y = self.exact("float" if self.chance(20) else type_, inner)
            name = self.random.choice(("min", "max", "step", "mod"))
            if name == "step":
                return Bound(
                    call(name, type_, y.node if y.node.type == "float" or y.node.type == type_ else x.node, x.node),
                    1.0,
                    0,
                )
            if name == "mod":
                return Bound(
                    call(name, type_, x.node, literal("float", self.random.choice((1.0, 2.0, 4.0, 0.5)))),
                    x.limit,
                    max(x.places, 1),
                )
            return Bound(call(name, type_, x.node, y.node), max(x.limit, y.limit), max(x.places, y.places))
        if rule < 76:
            y = self.exact(type_, inner)
            if self.chance(60):
                flag = self.boolean(vector("bool", size), inner)
                return Bound(call("mix", type_, x.node, y.node, flag), max(x.limit, y.limit), max(x.places, y.places))
            return Bound(
                call("mix", type_, x.node, y.node, literal("float", 0.5)),
                x.limit + y.limit,
                max(x.places, y.places) + 1,
            )
        if rule < 80 and size > 1:
            return Bound(self.assembled(type_, inner), LIMIT, EIGHTHS)
        if rule < 86:
            return self.product(type_, inner)
        if rule < 88 and not self.constant:
            a, b = (Bound(self.fit(self.exact(type_, inner)), LIMIT, EIGHTHS) for _ in range(2))
            return Bound(call("fma", type_, a.node, b.node, self.fit(x)), LIMIT * LIMIT + LIMIT, 6)
        if rule < 89 and not self.constant:
            power = binary("&", vector("int", size), self.integer(vector("int", size), 1), literal("int", 3))
            return Bound(call("ldexp", type_, self.fit(x), power), LIMIT * 8.0, EIGHTHS)
        if rule < 90 and type_ == "float" and not self.constant:
            half = call("abs", type_, self.fit(x))  # -0.0 may become 0.0
            packed = call("packHalf2x16", "uint", Node("construct", "vec2", [half], "vec2"))
            both = call("unpackHalf2x16", "vec2", packed)  # Mesa's Vulkan driver computes 0 for y of a constant
            return Bound(Node("swizzle", type_, [both], "x"), LIMIT, EIGHTHS)
        place = (
            self.target(type_, pure=True) if rule < 91 and not self.quiet and self.chance(2 * self.effects) else None
        )
        if place is not None and not self.constant:
            return Bound(call("modf", type_, self.fit(x), place), LIMIT, EIGHTHS)
        return Bound(self.cast(type_, inner), LIMIT, EIGHTHS)

    def product(self, type_: str, depth: int) -> Bound:
        """Products of vectors and matrices."""
        size = vector_size(type_) or 1
        if size == 1:
            other = f"vec{self.random.randint(2, 4)}"
            if self.chance(15):
                return Bound(call("determinant", "float", self.matrix_leaf(2)), 2.0 * MATRIX_LIMIT**2, 2)
            return Bound(
                call("dot", type_, *(self.fit(self.exact(other, depth)) for _ in range(2))), 4.0 * LIMIT * LIMIT, 6
            )
        if size == 3 and self.chance(25):
            return Bound(
                call("cross", type_, *(self.fit(self.exact(type_, depth)) for _ in range(2))), 2.0 * LIMIT * LIMIT, 6
            )
        if self.chance(15):
            return Bound(
                call("faceforward", type_, *(self.fit(self.exact(type_, depth)) for _ in range(3))), LIMIT, EIGHTHS
            )
        factors = [self.matrix(size, depth - 1), self.exact(type_, depth)]
        factors = [
            Bound(self.fit(factor), MATRIX_LIMIT if matrix_size(factor.node.type) else LIMIT, EIGHTHS)
            for factor in factors
        ]
        if self.chance(40):
            factors.reverse()
        return Bound(binary("*", type_, factors[0].node, factors[1].node), 4.0 * LIMIT * MATRIX_LIMIT, 6)

    def matrix_leaf(self, size: int) -> Node:
        type_ = f"mat{size}"
        if (leaf := self.leaf(type_) if self.chance(60) else None) is not None:
            return leaf
        if self.chance(30):
            return Node("construct", type_, [literal("float", self.random.choice((1.0, -1.0, 2.0, 0.5)))], type_)
        numbers = [literal("float", self.random.choice((0.0, 1.0, -1.0, 2.0, 0.5, 3.0))) for _ in range(size * size)]
        return Node("construct", type_, numbers, type_)

    def matrix(self, size: int, depth: int) -> Bound:
        type_, rule = f"mat{size}", self.random.randrange(100)
        leaf = Bound(self.matrix_leaf(size), MATRIX_LIMIT, 1)
        if depth <= 0 or rule < 25:
            return leaf
        if rule < 35:
            columns = [self.fit(self.exact(f"vec{size}", depth - 1), MATRIX_LIMIT, 1) for _ in range(size)]
            return Bound(Node("construct", type_, columns, type_), MATRIX_LIMIT, 1)
        if rule < 45:
            return leaf._replace(node=call("transpose", type_, leaf.node))
        if rule < 52:
            return leaf._replace(node=Node("unary", type_, [leaf.node], "-"))
        if rule < 60:
            other_size = self.random.choice([candidate for candidate in (2, 3, 4) if candidate != size])
            matrix = self.matrix_leaf(other_size)
            return Bound(Node("construct", type_, [matrix], type_), MATRIX_LIMIT, 1)
        if rule < 70 and (shared := self.shared(type_, depth)) is not None:
            return Bound(shared, MATRIX_LIMIT, 1)
        factor = self.matrix_leaf(size)
        if rule < 78:
            return Bound(call("matrixCompMult", type_, leaf.node, factor), MATRIX_LIMIT**2, 2)
        if rule < 84:
            vectors = [self.fit(self.exact(f"vec{size}", depth - 1), MATRIX_LIMIT, 1) for _ in range(2)]
            return Bound(call("outerProduct", type_, *vectors), MATRIX_LIMIT**2, 2)
        if rule < 90:
            scale = literal("float", self.random.choice((2.0, 0.5, -1.0)))
            op = self.random.choice("*/")
            return Bound(binary(op, type_, leaf.node, scale), 2.0 * MATRIX_LIMIT, 2)
        op = self.random.choice("+-*")
        limit = size * MATRIX_LIMIT**2 if op == "*" else 2.0 * MATRIX_LIMIT
        return Bound(binary(op, type_, leaf.node, factor), limit, 2)

    # Floats that are rounded

    def smooth(self, type_: str, depth: int) -> Node:
        """A value of modest size from builtins that may be off a little; it depends smoothly on everything rounded."""
        exact_type = type_[1:]
        if depth <= 0 or self.chance(15):
            leaf = self.leaf(type_) if self.chance(70) else None
            return leaf or Node("binary", type_, [self.fit(self.exact(exact_type, 1)), literal("float", 0.0625)], "*")
        x = self.smooth(type_, depth - 1)
        rule = self.random.randrange(16)
        if rule < 4:
            return call(self.random.choice(("sin", "cos", "tanh", "atan", "asinh", "abs")), type_, x)
        if rule < 6:
            safe = binary("+", type_, call("abs", type_, x), _number(0.5))
            return call(self.random.choice(("sqrt", "inversesqrt", "log2", "log", "radians")), type_, safe)
        if rule == 6:
            return call(
                self.random.choice(("exp", "exp2", "sinh", "cosh")),
                type_,
                call("clamp", type_, x, _number(-2.0), _number(1.0)),
            )
        if rule == 7:
            return call(
                self.random.choice(("asin", "acos", "atanh")),
                type_,
                call("clamp", type_, x, _number(-0.75), _number(0.75)),
            )
        if rule == 8:
            base = binary("+", type_, call("abs", type_, x), _number(0.5))
            return (
                call("pow", type_, base, Node("construct", type_, [_number(1.5)], exact_type))
                if vector_size(type_)
                else call("pow", type_, base, _number(1.5))
            )
        if rule == 9:
            return call("smoothstep", type_, _number(-1.0), _number(2.0), x)
        y = self.smooth(type_, depth - 1)
        if rule == 10:
            return call("mix", type_, x, y, _number(0.25))
        if rule == 11 and vector_size(type_):
            return call("normalize", type_, binary("+", type_, call("abs", type_, x), _number(0.5)))
        if rule == 12 and type_ == "~float":
            v = self.smooth("~vec3", depth - 1)
            return call("length", type_, binary("+", "~vec3", call("abs", "~vec3", v), _number(0.5)))
        if rule == 13 and type_ == "~float":
            return call("atan", type_, x, binary("+", type_, call("abs", type_, y), _number(0.5)))
        return binary(self.random.choice("+-"), type_, binary("*", type_, x, _number(0.5)), y)
