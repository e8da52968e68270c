"""Value numbers, and the facts about them that conditions establish.

Two expressions with the same number have the same value, such as the operands of `x * x`, or an expression in a
condition and in the code below it. A fact bounds a number; `upper` bounds a sum of numbers: `i < n` bounds `i - n`.
"""

from __future__ import annotations

from typing import NamedTuple

from sssgen.ir.intervals import INF, Range, maximum, minimum

Key = tuple[object, ...]
Terms = tuple[tuple[int, float], ...]
"""A sum of numbers, each multiplied by a factor, ordered by number."""
LEAST = 2.0**-149
"""The least number above 0. It is subnormal: devices may flush it to 0."""
_TERMS = 8
"""The largest number of terms of a sum; a longer sum is a term itself."""


class Sum(NamedTuple):
    """A value written as a sum of other values."""

    terms: Terms
    constant: float = 0.0
    slack: float = 0.0
    """The largest difference from the value, by rounding."""


class Numbers:
    """Assigns value numbers: the same definition gets the same number."""

    def __init__(self, tiny: float) -> None:
        self.tiny = tiny
        """Squares below this number may be flushed to 0."""
        self.existing: dict[Key, int] = {}
        self.definitions: list[Key] = []
        self.sums: dict[int, Sum] = {}

    def of(self, *key: object) -> int:
        number = self.existing.get(key)
        if number is None:
            number = self.existing[key] = len(self.definitions)
            self.definitions.append(key)
        return number

    def fresh(self) -> int:
        """The number of a value about which nothing is known: an input, or a join at the end of branches."""
        self.definitions.append(("new",))
        return len(self.definitions) - 1

    def sum(self, op: str, left: int, right: int, kind: str, slack: float) -> int:
        """The number of a sum or difference, which rounds by `slack` at most (infinite where an integer may wrap)."""
        number = self.of(op, *(sorted((left, right)) if op == "+" else (left, right)), kind)
        left_sum, right_sum = self.sum_of(left), self.sum_of(right)
        sign = 1.0 if op == "+" else -1.0
        slack += left_sum.slack + right_sum.slack
        earlier = self.sums.get(number)
        if earlier is None:
            terms = _add(left_sum.terms, right_sum.terms, sign)
            if len(terms) <= _TERMS:
                self.sums[number] = Sum(terms, left_sum.constant + sign * right_sum.constant, slack)
        elif slack > earlier.slack:
            self.sums[number] = Sum(earlier.terms, earlier.constant, slack)
        return number

    def sum_of(self, number: int) -> Sum:
        """A value as a sum; a value that is no sum is its only term."""
        key = self.definitions[number]
        if key[0] == "constant":
            return Sum((), float(key[1]))  # type: ignore[arg-type]  # a constant's definition holds its value
        return self.sums.get(number) or Sum(((number, 1.0),))

    def difference(self, left: int, right: int) -> Sum:
        """`left - right` as a sum."""
        left_sum, right_sum = self.sum_of(left), self.sum_of(right)
        terms = _add(left_sum.terms, right_sum.terms, -1.0)
        return Sum(terms, left_sum.constant - right_sum.constant, left_sum.slack + right_sum.slack)


def _add(first: Terms, second: Terms, sign: float) -> Terms:
    factors = dict(first)
    for number, factor in second:
        factors[number] = factors.get(number, 0.0) + sign * factor
    return tuple(sorted((number, factor) for number, factor in factors.items() if factor))


class Facts(NamedTuple):
    """The facts at one point of the program."""

    ranges: dict[int, Range]
    upper: dict[Terms, float]

    def copy(self) -> Facts:
        return Facts(dict(self.ranges), dict(self.upper))

    def joined(self, other: Facts) -> Facts:
        """The facts that hold on both paths."""
        if self.ranges is other.ranges:
            return self
        ranges = {n: r.joined(other.ranges[n]) for n, r in self.ranges.items() if n in other.ranges}
        upper = {t: max(bound, other.upper[t]) for t, bound in self.upper.items() if t in other.upper}
        return Facts(ranges, upper)

    def learn(self, numbers: Numbers, number: int, range: Range) -> None:
        """Adds that a number lies in a range, and what follows for the operands that it was computed from."""
        earlier = self.ranges.get(number)
        range = range if earlier is None else earlier.met(range)
        self.ranges[number] = range
        key = numbers.definitions[number]
        if key[0] == "abs":
            self.learn(numbers, _number(key[1]), Range(-range.high, range.high, max(range.low, 0.0)))
        elif key[0] == "neg":
            self.learn(numbers, _number(key[1]), -range)
        elif key[0] == "max" and range.high < INF:
            for operand in key[1:]:
                self.learn(numbers, _number(operand), Range(-INF, range.high))
        elif key[0] == "min" and range.low > -INF:
            for operand in key[1:]:
                self.learn(numbers, _number(operand), Range(range.low, INF))
        elif key[0] == "squares":
            # a little wider, for the rounding of the sum
            low, high = max(range.low, 0.0) ** 0.5 * 0.999, (max(range.high, 0.0) + numbers.tiny) ** 0.5 * 1.001
            self.learn(numbers, numbers.of("length", *key[1:]), Range(low, high))

    def compare(
        self, numbers: Numbers, left: tuple[int, Range], op: str, right: tuple[int, Range], whole: bool
    ) -> None:
        """Adds `left op right`; `whole` says that both are integers."""
        (a, x), (b, y) = left, right
        if op in (">", ">="):
            (a, x), (b, y), op = (b, y), (a, x), "<" if op == ">" else "<="
        if op in ("<", "<="):
            step = 1.0 if whole and op == "<" else 0.0
            self.learn(numbers, a, _below(y.high - step, op == "<"))
            self.learn(numbers, b, -_below(-(x.low + step), op == "<"))
            terms, constant, slack = numbers.difference(a, b)
            self.upper[terms] = min(self.upper.get(terms, INF), slack - constant - step)
            self.upper[_pair(a, b)] = -step
        elif op == "==":
            both = maximum(minimum(x, y.high), y.low)
            self.learn(numbers, a, both)
            self.learn(numbers, b, both)
        elif op == "!=" and y.low == y.high == 0.0:
            self.learn(numbers, a, Range(-INF, INF, 1.0 if whole else LEAST))

    def bound(self, numbers: Numbers, left: int, right: int) -> float:
        """The upper bound of `left - right`."""
        direct = self.upper.get(_pair(left, right))
        if direct is not None:
            return direct
        terms, constant, slack = numbers.difference(left, right)
        return (self.upper.get(terms, INF) if terms else 0.0) + constant + slack


def _below(high: float, strictly: bool) -> Range:
    """The numbers up to an end; if `strictly`, below 0 without 0 itself."""
    return Range(-INF, -LEAST) if strictly and high == 0.0 else Range(-INF, high)


def _pair(left: int, right: int) -> Terms:
    """The key of `left - right` of two numbers that are not expanded into sums."""
    return (left, 1.0), (right, -1.0)


def _number(part: object) -> int:
    assert isinstance(part, int)
    return part
