"""Values as polynomials of other values, whose ranges are tighter than those of their operations one by one.

`a*(a*(3.0*a - 6.0)) + 4.0` computes with `a` three times, and intervals take each for another number. A polynomial of
one number has its extremes at the ends or where its derivative is 0; one that is linear in each of its numbers has them
at the corners of their box.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from typing import NamedTuple

from sssgen.ir.intervals import INF, Range

Monomial = tuple[int, ...]
"""The numbers that are multiplied, in order, each as often as its power."""


class Factor(NamedTuple):
    """The factor of a monomial."""

    value: float
    weight: float
    """The sum of the sizes of all that it was added up from: what cancels has rounded, too."""


Polynomial = Mapping[Monomial, Factor]
NOTHING = Factor(0.0, 0.0)

MAX_TERMS, MAX_DEGREE, MAX_NUMBERS = 12, 4, 4
_NARROW = 1e3
"""The size of numbers up to which a range is taken as a whole."""
_ROUNDINGS = 16
"""Roundings of each term, at most: of its products and of the sums that it is a part of."""


def product(first: Polynomial, second: Polynomial) -> Polynomial | None:
    """The product of two polynomials; None where it is too long."""
    if len(first) * len(second) > MAX_TERMS:
        return None
    terms: dict[Monomial, Factor] = {}
    for a, x in first.items():
        for b, y in second.items():
            monomial = tuple(sorted((*a, *b)))
            if len(monomial) > MAX_DEGREE:
                return None
            value, weight = terms.get(monomial, NOTHING)
            terms[monomial] = Factor(value + x.value * y.value, weight + x.weight * y.weight)
    return terms


def total(first: Polynomial, second: Polynomial, sign: float) -> Polynomial | None:
    """The sum of two polynomials, the second one multiplied by `sign`; None where it is too long."""
    terms = dict(first)
    for monomial, factor in second.items():
        value, weight = terms.get(monomial, NOTHING)
        terms[monomial] = Factor(value + sign * factor.value, weight + factor.weight)
    return terms if len(terms) <= MAX_TERMS else None


def bounds(polynomial: Polynomial, ranges: Mapping[int, Range], epsilon: float) -> Range | None:
    """The range of a polynomial's rounded value; None where this says no more than intervals do."""
    numbers = sorted({number for monomial in polynomial for number in monomial})
    terms = [monomial for monomial, factor in polynomial.items() if monomial and factor.value]
    cancels = any(abs(factor.value) < factor.weight for factor in polynomial.values())
    repeats = sum(len(set(monomial)) for monomial in terms) > len(numbers) or cancels
    if len(numbers) > MAX_NUMBERS or not repeats:
        return None
    if any(number not in ranges or ranges[number].size == INF for number in numbers):
        return None
    powers = {number: {monomial.count(number) for monomial in terms} - {0} for number in numbers}
    if len(numbers) == 1:
        pieces = [_of_one(polynomial, piece, epsilon) for piece in _pieces(ranges[numbers[0]])]
        return Range(min(piece.low for piece in pieces), max(piece.high for piece in pieces))
    if all(len(of_number) == 1 and max(of_number) <= 2 for of_number in powers.values()):
        return _at_corners(polynomial, numbers, powers, ranges, epsilon)
    return None


def _rounded(polynomial: Polynomial, ranges: Mapping[int, Range], epsilon: float, values: list[float]) -> Range:
    """The hull of exact values, with the errors of the roundings."""
    size = sum(
        factor.weight * math.prod(ranges[number].size for number in monomial) for monomial, factor in polynomial.items()
    )
    slack = _ROUNDINGS * epsilon * size
    return Range(min(values) - slack, max(values) + slack)


def _pieces(over: Range) -> list[Range]:
    """Parts of a wide range in which a polynomial's error is small beside its terms."""
    if over.size <= _NARROW:
        return [over]
    ends = [0.0]
    while ends[-1] < over.size:
        ends.append(max(16.0 * ends[-1], 4.0))
    ends = sorted(
        {
            over.low,
            over.high,
            *(sign * end for end in ends for sign in (-1.0, 1.0) if over.low < sign * end < over.high),
        }
    )
    return [Range(low, high) for low, high in itertools.pairwise(ends)] or [over]


def _of_one(polynomial: Polynomial, over: Range, epsilon: float) -> Range:
    """The range of a polynomial of one number."""
    factors = [0.0] * (MAX_DEGREE + 1)
    for monomial, factor in polynomial.items():
        factors[len(monomial)] += factor.value
    points = [over.low, over.high, *(root for root in _roots(_derivative(factors), over.low, over.high))]
    number = next(number for monomial in polynomial for number in monomial)
    return _rounded(polynomial, {number: over}, epsilon, [_value(factors, point) for point in points])


def _derivative(factors: list[float]) -> list[float]:
    return [power * factor for power, factor in enumerate(factors)][1:]


def _value(factors: list[float], at: float) -> float:
    value = 0.0
    for factor in reversed(factors):
        value = value * at + factor
    return value


def _roots(factors: list[float], low: float, high: float) -> list[float]:
    """Where a polynomial is 0 between two numbers: between the extremes, it is monotonic, so each root is bracketed."""
    while factors and factors[-1] == 0.0:
        factors = factors[:-1]
    if len(factors) <= 1:
        return []
    points = [low, *sorted(_roots(_derivative(factors), low, high)), high]
    roots = []
    for start, end in itertools.pairwise(points):
        first, last = _value(factors, start), _value(factors, end)
        if first == 0.0 or last == 0.0:
            roots.append(start if first == 0.0 else end)
        elif (first < 0.0) != (last < 0.0):
            for _ in range(60):
                middle = 0.5 * (start + end)
                if (_value(factors, middle) < 0.0) == (first < 0.0):
                    start = middle
                else:
                    end = middle
            roots.append(start)
    return roots


def _at_corners(
    polynomial: Polynomial, numbers: list[int], powers: Mapping[int, set[int]], ranges: Mapping[int, Range],
    epsilon: float,
) -> Range:  # fmt: skip
    """The range of a polynomial that is linear in each of its numbers, or in their squares."""
    ends = []
    for number in numbers:
        over = ranges[number]
        squared = powers[number] == {2}
        ends.append((over.gap * over.gap, over.size * over.size) if squared else (over.low, over.high))
    values = []
    for corner in itertools.product(*ends):
        at = dict(zip(numbers, corner, strict=True))
        values.append(
            sum(
                factor.value * math.prod(at[number] for number in set(monomial))
                for monomial, factor in polynomial.items()
            )
        )
    return _rounded(polynomial, ranges, epsilon, values)
