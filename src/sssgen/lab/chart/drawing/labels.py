"""Finds places for labels beside points, where they cover neither each other nor what is drawn."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

SIZE = 10.5
"""Of the letters, in pixels."""
WIDTH = 0.6
"""Of a letter, in sizes: that of a wide sans-serif face."""
ROUNDS = 4
"""How often each label looks for a better place, as the others have theirs."""

RADII = (9.0, 14.0, 22.0, 32.0, 46.0, 64.0, 86.0)
ANGLES = 24
"""How far from its point a label may begin, and in how many directions."""
BEST = 80
"""Places of each label that are held against the others'."""


class Box(NamedTuple):
    """A rectangle: its left, top, right and bottom, in pixels, y down."""

    left: float
    top: float
    right: float
    bottom: float

    def overlap(self, other: Box) -> float:
        """The area that both have."""
        wide = min(self.right, other.right) - max(self.left, other.left)
        high = min(self.bottom, other.bottom) - max(self.top, other.top)
        return wide * high if wide > 0.0 and high > 0.0 else 0.0

    def has(self, x: float, y: float) -> bool:
        """Whether the place is inside."""
        return self.left <= x <= self.right and self.top <= y <= self.bottom

    def grown(self, by: float) -> Box:
        """With a margin around it."""
        return Box(self.left - by, self.top - by, self.right + by, self.bottom + by)


class Label(NamedTuple):
    """A text whose middle line begins, or ends, at a place; a leader goes from there to its point."""

    text: str
    x: float
    y: float
    anchor: str
    """start, middle or end: which part of the text is at x."""
    at: tuple[float, float]
    """The point that it tells of."""
    number: int
    """Which of those that were wanted it is."""

    @property
    def box(self) -> Box:
        """What it covers."""
        wide = SIZE * WIDTH * len(self.text)
        left = self.x - {"start": 0.0, "middle": 0.5, "end": 1.0}[self.anchor] * wide
        return Box(left - 1.0, self.y - 0.6 * SIZE, left + wide + 1.0, self.y + 0.6 * SIZE)

    @property
    def far(self) -> bool:
        """Whether it needs a leader to its point."""
        return math.hypot(self.x - self.at[0], self.y - self.at[1]) > 1.5 * RADII[1]


Place = tuple[float, float]


def placed(
    wanted: Sequence[tuple[str, Place]], bounds: Box, dots: Sequence[Place], paths: Sequence[Sequence[Place]]
) -> list[Label]:
    """Labels for texts at points, inside `bounds`, clear of `dots` and, if it can be, of `paths`.

    A label that would cover another one is left out.
    """
    along = [place for path in paths for place in _sampled(path)]
    choices: list[list[_Choice]] = []
    for number, (text, at) in enumerate(wanted):
        reach = Box(*at, *at).grown(RADII[-1] + SIZE * WIDTH * len(text))
        near = [place for place in along if reach.has(*place)]
        rated = [_rated(label, bounds, dots, near) for label in _candidates(text, at, number)]
        choices.append(sorted(rated, key=lambda one: one.bad)[:BEST])
    chosen: list[_Choice] = []
    for found in choices:
        chosen.append(_best(found, chosen))
    for _ in range(ROUNDS):
        for number, found in enumerate(choices):
            chosen[number] = _best(found, chosen[:number] + chosen[number + 1 :])
    kept: list[_Choice] = []
    for one in chosen:
        inside = one.box.overlap(bounds) >= 0.999 * _area(one.box)
        if inside and not any(one.box.overlap(other.box) for other in kept):
            kept.append(one)
    return [one.label for one in kept]


class _Choice(NamedTuple):
    """A place for a label, and how bad it is by itself."""

    label: Label
    box: Box
    leader: list[Place]
    bad: float


def _area(box: Box) -> float:
    return (box.right - box.left) * (box.bottom - box.top)


def _candidates(text: str, at: Place, number: int) -> list[Label]:
    found = []
    for radius in RADII:
        for step in range(ANGLES):
            angle = 2.0 * math.pi * step / ANGLES
            across, down = math.cos(angle), math.sin(angle)
            anchor = "start" if across > 0.3 else "end" if across < -0.3 else "middle"
            found.append(Label(text, at[0] + radius * across, at[1] + radius * down, anchor, at, number))
    return found


def _sampled(path: Sequence[Place], step: float = 6.0) -> list[Place]:
    found = []
    for (x, y), (to_x, to_y) in pairwise(path):
        count = max(1, int(math.hypot(to_x - x, to_y - y) / step))
        found += [(x + (to_x - x) * part / count, y + (to_y - y) * part / count) for part in range(count)]
    return [*found, *path[-1:]]


def _rated(label: Label, bounds: Box, dots: Sequence[Place], along: Sequence[Place]) -> _Choice:
    box = label.box
    wide, clear = box.grown(5.0), box.grown(2.0)
    outside = _area(box) - box.overlap(bounds)
    bad = (
        50.0 * outside + 120.0 * sum(wide.has(*dot) for dot in dots) + 20.0 * sum(clear.has(*place) for place in along)
    )
    leader = []
    if label.far:
        leader = _sampled([(label.x, label.y), label.at], 8.0)[:-1]
        bad += 15.0 + 25.0 * sum(_near(dot, (label.x, label.y), label.at) for dot in dots if dot != label.at)
        bad += 3.0 * sum(_near(place, (label.x, label.y), label.at) for place in along)
    bad += 0.5 * math.hypot(label.x - label.at[0], label.y - label.at[1])
    return _Choice(label, box, leader, bad)


def _best(found: Sequence[_Choice], others: Sequence[_Choice]) -> _Choice:
    """The best place beside the other labels; places by themselves too bad to be it are not looked at."""
    best, least = found[0], math.inf
    for one in found:
        if one.bad >= least:
            break
        bad = one.bad + _among(one, others)
        if bad < least:
            best, least = one, bad
    return best


def _among(one: _Choice, others: Sequence[_Choice]) -> float:
    """How bad it is beside the other labels: they cover each other, or leaders cross them."""
    bad = 0.0
    for other in others:
        bad += 100.0 * one.box.overlap(other.box)
        bad += 150.0 * sum(other.box.has(*place) for place in one.leader)
        bad += 150.0 * sum(one.box.has(*place) for place in other.leader)
        if one.leader and other.leader and _cross(one.label, other.label):
            bad += 200.0
    return bad


def _cross(one: Label, other: Label) -> bool:
    def side(a: Place, b: Place, c: Place) -> float:
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])

    a, b, c, d = one.at, (one.x, one.y), other.at, (other.x, other.y)
    return side(a, b, c) * side(a, b, d) < 0.0 and side(c, d, a) * side(c, d, b) < 0.0


def _near(place: Place, start: Place, end: Place, distance: float = 5.0) -> bool:
    """Whether a place lies that near to the way from start to end."""
    along = (end[0] - start[0], end[1] - start[1])
    length = along[0] ** 2 + along[1] ** 2
    share = ((place[0] - start[0]) * along[0] + (place[1] - start[1]) * along[1]) / max(length, 1e-9)
    share = min(max(share, 0.0), 1.0)
    return math.hypot(place[0] - start[0] - share * along[0], place[1] - start[1] - share * along[1]) < distance
