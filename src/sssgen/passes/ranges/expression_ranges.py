"""Ranges of expressions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, cast

from sssgen.ir import nodes as ir
from sssgen.ir import vector_ranges as vectors
from sssgen.ir.contracts import INTEGERS
from sssgen.ir.formats import FLOAT32
from sssgen.ir.intervals import ANY, INF, Range, as_range, clip, hull, square, widened
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.rules import element_type
from sssgen.ir.types import BOOL, Array, Matrix, Struct, kind_of
from sssgen.ir.vector_ranges import Value, length_of
from sssgen.passes.ranges import polynomials
from sssgen.passes.ranges.call_ranges import CallRanges
from sssgen.passes.ranges.polynomials import Factor, Polynomial
from sssgen.passes.ranges.range_state import State, global_key
from sssgen.passes.ranges.scalar_parts import field_at, hull_of, matrix_product, scalars
from sssgen.passes.ranges.sites import (
    COUNT,
    DIVISION,
    ELEMENT,
    SIGNED_COUNT,
    TEXEL,
    WHOLE_DIVISION,
    WHOLE_NUMBER,
    subnormal,
)


class ExpressionRanges(CallRanges):
    """The part of the analysis for expressions."""

    def expr(self, node: ir.Expr) -> Value:
        return _METHODS[type(node)](self, node)

    def literal(self, node: ir.Literal) -> Value:
        number = float(node.value) if kind_of(node.type) != "float" else self.format.rounded(float(node.value))
        return Value((Range(number, number),), (self.numbers.of("constant", number),), Range(abs(number), abs(number)))

    def local(self, node: ir.Local) -> Value:
        value = self.state.env.get(node.name)
        return self.unknown(node.type) if value is None else self.refine(value)

    def global_(self, node: ir.Global) -> Value:
        if node.name in self.variables:
            value = self.state.env.get(global_key(node.name))
            return self.unknown(node.type) if value is None else self.refine(value)
        return self.refine(self.globals[node.name])

    def unary(self, node: ir.Unary) -> Value:
        value = self.expr(node.operand)
        if node.op == "!":
            parts = [Range(1.0 - part.high, 1.0 - part.low) for part in value.parts]
            return self.computed(node, parts, [self.numbers.of("!", n) for n in value.numbers])
        if node.op == "~":
            return self.unknown(node.type)
        kind = kind_of(node.type)
        # negation of an integer may wrap
        numbers = [self.negate(n) if kind == "float" else self.numbers.of("negated", kind, n) for n in value.numbers]
        return self.computed(node, [-part for part in value.parts], numbers, value.length)

    def negate(self, number: int) -> int:
        key = self.numbers.definitions[number]
        return cast(int, key[1]) if key[0] == "neg" else self.numbers.of("neg", number)

    def binary(self, node: ir.Binary) -> Value:
        if node.op in ("&&", "||", "^^"):
            return self.logic(node)
        return self.operation(node, self.expr(node.left), self.expr(node.right))

    def logic(self, node: ir.Binary) -> Value:
        left = self.expr(node.left)
        outer = self.state
        if node.op != "^^":  # the right side runs only if the left one does not decide
            self.state = outer.copy()
            self.learn(left.numbers[0], node.op == "&&")
        right = self.expr(node.right)
        self.state = self.after_either(outer, [self.state])
        a, b = left.parts[0], right.parts[0]
        part = {
            "&&": Range(min(a.low, b.low), min(a.high, b.high)),
            "||": Range(max(a.low, b.low), max(a.high, b.high)),
        }.get(node.op, hull(0.0, 1.0))
        return self.computed(node, [part], [self.numbers.of(node.op, left.numbers[0], right.numbers[0])])

    def operation(self, node: ir.Binary, left: Value, right: Value) -> Value:
        """`left op right`."""
        op, kind = node.op, kind_of(node.left.type)
        if node.type == BOOL and op in ("<", ">", "<=", ">=", "==", "!="):
            return self.comparison(node, left, right)
        if op == "*" and (isinstance(node.left.type, Matrix) or isinstance(node.right.type, Matrix)):
            slack = 8.0 * self.format.epsilon
            product = matrix_product(
                node.left.type, left.parts, node.right.type, right.parts, slack, self.format.largest
            )
            if product is not None:
                value = self.computed(node, product, [self.numbers.fresh() for _ in product])
                return self.with_stretch(node, left, right, value)
        if op in ("%", "<<", ">>", "&", "|", "^") or (op == "/" and kind != "float"):
            return self.integer(node, left, right)
        if op == "/":
            return self.division(node, left, right)
        parts, numbers, signs = [], [], _signs(node)
        for a, m, b, n in _components(left, right):
            if op == "*":
                part = self.product(a, m, b, n) if kind == "float" else square(a) if m == n else a * b
                if m == n and kind == "float":
                    number = self.numbers.of("squares", m)
                else:  # a product of integers may wrap, unlike one of floats with the same numbers
                    number = self.numbers.of("*", *sorted((m, n)), kind)
            else:
                part = self.sum(a, m, b, n, op)
                number = self.numbers.sum(op, m, n, kind, self.slack(a, b, part, kind))
                if op == "-" and signs is not None:
                    part = part.met(signs)
            if self.unguarded and kind == "float":
                part = self.expand(op, number, part, (m, a), (n, b))
            parts.append(part)
            numbers.append(number)
        return self.computed(node, parts, numbers, self.length_after(op, left, right))

    def expand(self, op: str, number: int, part: Range, left: tuple[int, Range], right: tuple[int, Range]) -> Range:
        """The range of a sum or product, met with that of the polynomial that it is."""
        for of, range_ in (left, right):
            span = self.spans.get(of)
            self.spans[of] = range_ if span is None else span.joined(range_)
        first, second = self.polynomial(left[0]), self.polynomial(right[0])
        if op == "*":
            polynomial = polynomials.product(first, second)
        else:
            polynomial = polynomials.total(first, second, 1.0 if op == "+" else -1.0)
        if polynomial is None:
            return part
        self.polynomials[number] = polynomial
        if part.gap > 0.0:  # its sign is known
            return part
        tighter = polynomials.bounds(polynomial, self.spans, self.format.epsilon)
        if tighter is None or tighter.high < part.low or tighter.low > part.high:
            return part
        return Range(max(part.low, tighter.low), min(part.high, tighter.high), max(part.gap, tighter.gap))

    def polynomial(self, number: int) -> Polynomial:
        """A number as a polynomial: of itself, if it is neither a sum nor a product."""
        key = self.numbers.definitions[number]
        if key[0] == "constant":
            return {(): Factor(cast(float, key[1]), abs(cast(float, key[1])))}
        if key[0] == "neg":
            positive = self.polynomial(cast(int, key[1])).items()
            return {monomial: Factor(-value, weight) for monomial, (value, weight) in positive}
        return self.polynomials.get(number) or {(number,): Factor(1.0, 1.0)}

    def with_stretch(self, node: ir.Binary, left: Value, right: Value, product: Value) -> Value:
        """A product with a matrix of which the stretch is known: a vector's length, or a matrix's stretch."""
        slack = 16.0 * self.format.epsilon
        if isinstance(node.type, Matrix):
            return product._replace(stretch=widened(left.stretch * right.stretch, slack))
        matrix, vector = (left, right) if isinstance(node.left.type, Matrix) else (right, left)
        type_ = cast(Matrix, node.left.type if matrix is left else node.right.type)
        if matrix.stretch.high == INF or type_.columns != type_.rows:
            return product
        if len(vector.parts) == 4:  # a direction, if its last component is 0
            if vector.parts[3].size > 0.0:
                return product
            return product._replace(head=widened(matrix.stretch * vector.head, slack))
        return self.value(product.parts, product.numbers, widened(matrix.stretch * vector.length, slack))

    def product(self, a: Range, m: int, b: Range, n: int) -> Range:
        """A product of floats, which may be of a number with itself or with its negative."""
        if m == n:
            return square(a)
        definitions = self.numbers.definitions
        return -square(a) if definitions[m] == ("neg", n) or definitions[n] == ("neg", m) else a * b

    def sum(self, a: Range, m: int, b: Range, n: int, op: str) -> Range:
        if op == "+":
            return a + b
        # a compiler may fuse a product into the sum, which then is not the rounded product that was compared
        products = any(self.numbers.definitions[number][0] in ("*", "squares") for number in (m, n))
        fused = self.format.epsilon * (a.size + b.size) if products else 0.0
        if m == n:
            return Range(-fused, fused)
        difference = a - b
        facts = self.state.facts
        if facts.upper:
            high, low = facts.bound(self.numbers, m, n) + fused, -facts.bound(self.numbers, n, m) - fused
            difference = difference.met(Range(low, high)) if low <= high else difference
        return difference

    def slack(self, a: Range, b: Range, sum: Range, kind: str) -> float:
        """How far a sum of a and b may be from the exact one."""
        limits = self.limits(kind)
        if sum.low < limits.low or sum.high > limits.high:  # the sum wraps, or is clamped
            return INF
        return self.format.epsilon * (a.size + b.size) if kind == "float" else 0.0

    def length_after(self, op: str, left: Value, right: Value) -> Range:
        """The length of a sum of vectors, or of a vector's product with a scalar."""
        if len(left.parts) == len(right.parts) and op in "+-":
            slack = 8.0 * self.format.epsilon  # rounding is relative to the sum of the lengths
            return widened(
                vectors.total_length(left.length, right.length), 0.0, slack * (left.length.high + right.length.high)
            )
        if op == "*" and 1 in (len(left.parts), len(right.parts)) and len(left.parts) != len(right.parts):
            scalar, vector = (left, right) if len(left.parts) == 1 else (right, left)
            scale = length_of(scalar.parts)
            return widened(scale * vector.length, 8.0 * self.format.epsilon) if vector.length.high < INF else ANY
        return ANY

    def division(self, node: ir.Binary, left: Value, right: Value) -> Value:
        least = self.format.tiny
        counts = _is_count(node.right)
        smallest = 1.0 if counts else self.format.divisor
        parts, numbers, proven, has_zero = [], [], True, False
        for a, m, b, n in _components(left, right):
            safe = b.gap >= least
            proven &= safe
            if not safe:  # the range behind the guard
                has_zero |= b.has_zero()
                gap = max(b.gap, smallest)
                b = Range(gap if b.low >= 0.0 else min(b.low, -gap), max(b.high, gap), gap)
                if self.unguarded:  # each cause is reported once
                    self.state.facts.learn(self.numbers, n, b)
            part = widened(a / b, 3.0 * self.format.epsilon)
            if b.size * self.format.tiny > 1.0:  # the divisor's inverse may be flushed to 0
                part = part.joined(as_range(0.0))
            if b.low > 0.0 and (slack := self.ratio(a, m, b, n)) is not None:
                part = part.met(Range(-INF, slack))
            parts.append(part)
            numbers.append(self.numbers.of("/", m, n))
        dividend, divisor = hull_of(left.parts), hull_of(right.parts)
        guard = DIVISION if not counts else COUNT if divisor.low >= 0.0 else SIGNED_COUNT
        failures = () if proven else (guard if has_zero else subnormal(guard),)
        self.note(node, "/", failures, guard, (dividend, divisor))
        return self.computed(node, parts, numbers)

    def ratio(self, a: Range, m: int, b: Range, n: int) -> float | None:
        """The upper bound of a/b for b above 0 that follows from facts about a - b: a/b = 1 + (a - b)/b."""
        facts = self.state.facts
        if not facts.upper:
            return None
        over = facts.bound(self.numbers, m, n)
        if over == INF:
            return None
        return widened(as_range(1.0 + over / (b.low if over > 0.0 else b.high)), 3.0 * self.format.epsilon).high

    def integer(self, node: ir.Binary, left: Value, right: Value) -> Value:
        """The other integer operators. `legalise` defines what languages leave undefined."""
        parts, numbers = [], []
        if self.unguarded and node.op in ("/", "%"):
            by_zero = any(b.has_zero() for _, _, b, _ in _components(left, right))
            ranges = hull_of(left.parts), hull_of(right.parts)
            self.note(node, node.op, by_zero, WHOLE_DIVISION, ranges)
        for a, _, b, _ in _components(left, right):
            part = self.limits(kind_of(node.type))
            if node.op == "/" and b.low > 0.0 and a.low >= 0.0:
                part = Range(float(int(a.low / b.high)), float(int(a.high / b.low)))
            elif node.op == "%" and b.low > 0.0 and a.low >= 0.0:
                part = Range(0.0, min(a.high, b.high - 1.0))
            elif node.op == ">>" and b.low == b.high and 0.0 <= b.low < 32.0 and a.low >= 0.0:
                part = Range(float(int(a.low) >> int(b.low)), float(int(a.high) >> int(b.low)))
            elif node.op == "&" and max(a.low, b.low) >= 0.0:  # one of them masks the sign
                part = Range(0.0, min(factor.high for factor in (a, b) if factor.low >= 0.0))
            parts.append(part)
            numbers.append(self.numbers.fresh())
        return self.computed(node, parts, numbers)

    def comparison(self, node: ir.Binary, left: Value, right: Value) -> Value:
        if len(left.parts) != 1 or not left.parts:
            return self.unknown(BOOL)
        (a,), (b,), (m,), (n,) = left.parts, right.parts, left.numbers, right.numbers
        kind = kind_of(node.left.type)
        low, high = {
            "<": (a.high < b.low, a.low < b.high), "<=": (a.high <= b.low, a.low <= b.high),
            ">": (a.low > b.high, a.high > b.low), ">=": (a.low >= b.high, a.high >= b.low),
            "==": (a.low == a.high == b.low == b.high, a.low <= b.high and b.low <= a.high),
            "!=": (a.high < b.low or b.high < a.low, not a.low == a.high == b.low == b.high),
        }[node.op]  # fmt: skip
        number = self.numbers.of("compare", node.op, m, n, kind != "float", a, b)
        return self.computed(node, [Range(float(low), float(high))], [number])

    def select(self, node: ir.Select) -> Value:
        condition = self.expr(node.condition)
        outer = self.state
        arms = []
        for truth, arm in ((True, node.yes), (False, node.no)):
            self.state = outer.copy()
            self.learn(condition.numbers[0], truth)
            arms.append((self.refine(self.expr(arm)), self.state))
        self.state = self.after_either(outer, [state for _, state in arms])
        if condition.parts[0].low == 1.0 or condition.parts[0].high == 0.0:
            return arms[0 if condition.parts[0].low == 1.0 else 1][0]
        return self.joined(arms[0][0], arms[1][0], arms[0][1].facts, arms[1][1].facts)

    def after_either(self, before: State, after: list[State]) -> State:
        """The state after parts of which at most one ran; their calls may have written variables."""
        for state in after:
            if any(value is not state.env[name] for name, value in before.env.items()):
                return cast(State, self.join_all([before, *after]))
        return before

    def intrinsic(self, node: ir.Intrinsic) -> Value:
        args = tuple([self.expr(arg) for arg in node.args])
        return self.builtin(node, args, True)

    def construct(self, node: ir.Construct) -> Value:
        args = [self.expr(arg) for arg in node.args]
        type_ = node.type
        if isinstance(type_, Array):
            elements = args[0]
            for arg in args[1:]:
                elements = Value(
                    tuple([a.joined(b) for a, b in zip(elements.parts, arg.parts, strict=True)]),
                    tuple([self.numbers.fresh() for _ in elements.parts]),
                )
            return elements
        parts = [part for arg in args for part in arg.parts]
        numbers = [number for arg in args for number in arg.numbers]
        if isinstance(type_, Struct):
            return Value(tuple(parts), tuple(numbers))
        if len(args) == 1 and kind_of(node.args[0].type) != kind_of(type_):
            return self.conversion(node, args[0])
        if isinstance(type_, Matrix) and len(args) == 1:
            return self.matrix(node, args[0])
        if len(parts) == 1:
            parts, numbers = parts * scalars(type_), numbers * scalars(type_)
        length = args[0].length if len(args) == 1 and len(args[0].parts) == len(parts) else ANY
        value = self.value(tuple(parts), tuple(numbers), length)
        head = args[0].length if len(args) == 2 and len(args[0].parts) == 3 else ANY
        return value if head is ANY else value._replace(head=head)

    def matrix(self, node: ir.Construct, value: Value) -> Value:
        type_, old = cast(Matrix, node.type), node.args[0].type
        zero, one = self.numbers.of("constant", 0.0), self.numbers.of("constant", 1.0)
        parts, numbers = [], []
        for column in range(type_.columns):
            for row in range(type_.rows):
                if len(value.parts) == 1:
                    parts.append(value.parts[0] if row == column else as_range(0.0))
                    numbers.append(value.numbers[0] if row == column else zero)
                elif isinstance(old, Matrix) and row < old.rows and column < old.columns:
                    parts.append(value.parts[column * old.rows + row])
                    numbers.append(value.numbers[column * old.rows + row])
                else:
                    parts.append(as_range(float(row == column)))
                    numbers.append(one if row == column else zero)
        keeps = isinstance(old, Matrix) and min(type_.columns, type_.rows) > 2  # the first three rows and columns
        return self.value(tuple(parts), tuple(numbers))._replace(stretch=value.stretch if keeps else ANY)

    def conversion(self, node: ir.Construct, value: Value) -> Value:
        """Between float, int, uint and bool."""
        source, kind = kind_of(node.args[0].type), kind_of(node.type)
        if kind == "bool":
            parts = [hull(0.0 if part.has_zero() else 1.0, 1.0 if part.size else 0.0) for part in value.parts]
            return self.value(tuple(parts), tuple([self.numbers.of("bool", n) for n in value.numbers]))
        exact = 2.0**24 if self.format is FLOAT32 else 2.0**11
        if kind == "float":
            numbers = [
                n if part.size <= exact and source != "bool" else self.numbers.of("float", source, n)
                for part, n in zip(value.parts, value.numbers, strict=True)
            ]
            return self.computed(node, list(value.parts), numbers)
        if source == "float":
            # the largest float below the end of the integers
            low, high = INTEGERS[kind][0], 2147483520.0 if kind == "int" else 4294967040.0
            parts = [Range(float(int(part.low)), float(int(part.high))) for part in value.parts]
            proven = all(low <= part.low and part.high <= high for part in parts)
            self.note(
                node, kind, not proven, WHOLE_NUMBER, (hull_of(value.parts),), (low, min(high, self.format.largest))
            )
            parts = [clip(part, low, high) for part in parts]
            return self.computed(node, parts, [self.numbers.of(kind, n) for n in value.numbers])
        limits = self.limits(kind)
        parts = [part if part.within(limits) or (part.low >= limits.low and part.high <= limits.high) else limits
                 for part in value.parts]  # fmt: skip
        return self.value(tuple(parts), tuple([self.numbers.of(kind, source, n) for n in value.numbers]))

    def swizzle(self, node: ir.Swizzle) -> Value:
        inner = node.value
        if isinstance(inner, ir.Intrinsic) and BUILTINS[inner.name].reads_texels:
            args = tuple([self.expr(arg) for arg in inner.args])
            value = self.builtin(inner, args, False)
            texel = args[0].texel
            if texel is not None and not texel.finite:
                self.note(node, "texel", True, TEXEL, (ANY,), (texel.low, texel.high))
        else:
            value = self.expr(inner)
        at = ["xyzw".index(letter) for letter in node.components]
        length = ANY  # with a repeated component, only the components bound it
        if len(set(at)) == len(at):
            if len(at) == len(value.parts):
                length = value.length
            elif sorted(at) == [0, 1, 2] and value.head is not ANY:
                length = value.head.met(Range(0.0, value.length.high))
            else:
                length = Range(0.0, value.length.high)
        return self.value(tuple([value.parts[i] for i in at]), tuple([value.numbers[i] for i in at]), length)

    def index(self, node: ir.Index) -> Value:
        value, index = self.expr(node.value), self.expr(node.index).parts[0]
        count = self.check_index(node, index)
        if isinstance(node.value.type, Array):
            numbers = tuple([self.numbers.fresh() for _ in value.parts])
            for at, old in enumerate(value.numbers) if self.lengths else ():
                vector, length = self.lengths.get(old, ((), ANY))
                if vector and value.numbers[at : at + len(vector)] == vector:
                    self.lengths[numbers[at]] = numbers[at : at + len(vector)], length
            return self.value(value.parts, numbers, value.length)
        size = scalars(node.type)
        if index.low == index.high and 0 <= index.low < count:
            start = int(index.low) * size
            return self.value(value.parts[start : start + size], value.numbers[start : start + size])
        parts = []
        for row in range(size):
            part = value.parts[row]
            for column in range(1, count):
                part = part.joined(value.parts[column * size + row])
            parts.append(part)
        return self.value(tuple(parts), tuple([self.numbers.fresh() for _ in parts]))

    def check_index(self, node: ir.Index, index: Range) -> int:
        """Notes an index that may be beyond the elements; returns how many there are."""
        elements = element_type(node.value.type)
        assert elements is not None
        if not isinstance(node.index, ir.Literal) and elements[1]:  # the length of a buffer is not known
            outside = index.low < 0.0 or index.high > elements[1] - 1.0
            self.note(node, "index", outside, ELEMENT, (index,), (0.0, elements[1] - 1.0))
        return elements[1]

    def member(self, node: ir.Member) -> Value:
        value = self.expr(node.value)
        start, count = field_at(cast(Struct, node.value.type), node.field)
        numbers = value.numbers[start : start + count]
        vector, length = self.lengths.get(numbers[0], ((), ANY)) if numbers else ((), ANY)
        return self.value(value.parts[start : start + count], numbers, length if vector == numbers else ANY)


def _components(left: Value, right: Value) -> Iterator[tuple[Range, int, Range, int]]:
    """The range and the number of each component of two operands; a scalar counts for all components."""
    if len(left.parts) == len(right.parts):
        return zip(left.parts, left.numbers, right.parts, right.numbers, strict=True)
    if len(left.parts) == 1:
        return ((left.parts[0], left.numbers[0], b, n) for b, n in zip(right.parts, right.numbers, strict=True))
    return ((a, m, right.parts[0], right.numbers[0]) for a, m in zip(left.parts, left.numbers, strict=True))


def _signs(node: ir.Expr) -> Range | None:
    """The range of `k * step(…) - c`, which is -c or k - c, if their signs differ: -1 or 1 of `2.0 * step(…) - 1.0`."""
    if not (isinstance(node, ir.Binary) and isinstance(node.left, ir.Binary) and isinstance(node.right, ir.Literal)):
        return None
    factor, stepped = node.left.left, node.left.right
    if node.left.op != "*" or not (isinstance(stepped, ir.Intrinsic) and stepped.name == "step"):
        return None
    if not isinstance(factor, ir.Literal) or not 0.0 < float(node.right.value) < float(factor.value):
        return None
    low, high = -float(node.right.value), float(factor.value) - float(node.right.value)
    slack = 1.0 - 2.0**-20  # the difference is rounded
    return Range(low / slack, high / slack, min(-low, high) * slack)


def _is_count(node: ir.Expr) -> bool:
    """Whether this is an integer converted to float."""
    return isinstance(node, ir.Construct) and len(node.args) == 1 and kind_of(node.args[0].type) in ("int", "uint")


_METHODS: dict[type, Callable[[Any, Any], Value]] = {
    ir.Literal: ExpressionRanges.literal,
    ir.Local: ExpressionRanges.local,
    ir.Global: ExpressionRanges.global_,
    ir.Unary: ExpressionRanges.unary,
    ir.Binary: ExpressionRanges.binary,
    ir.Select: ExpressionRanges.select,
    ir.Call: lambda self, node: cast(Value, self.call(node)),
    ir.Intrinsic: ExpressionRanges.intrinsic,
    ir.Construct: ExpressionRanges.construct,
    ir.Swizzle: ExpressionRanges.swizzle,
    ir.Index: ExpressionRanges.index,
    ir.Member: ExpressionRanges.member,
}
