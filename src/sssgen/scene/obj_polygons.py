"""Concave polygons of a Wavefront .obj file as triangles: its reader makes fans of them, which fold over their edges.

The polygons have five or more corners. An ear of a polygon is a triangle of three neighbouring corners without another
corner inside; ears are cut off until a triangle is left (Meisters, Polygons have ears, 1975).
"""

from __future__ import annotations

import re
from bisect import bisect
from collections.abc import Sequence

_VERTEX = re.compile(rb"^v +(\S+) +(\S+) +(\S+)", re.MULTILINE)
_POLYGON = re.compile(rb"^f((?: +[-\d/]+){5,}) *\r?$", re.MULTILINE)

_Point = tuple[float, float]


def without_concave(data: bytes) -> bytes:
    """The file with its concave polygons as triangles. A file with wrong numbers stays as it is."""
    if _POLYGON.search(data) is None:
        return data
    matches = list(_VERTEX.finditer(data))
    starts = [match.start() for match in matches]

    def replaced(match: re.Match[bytes]) -> bytes:
        words = match[1].split()
        before = bisect(starts, match.start())
        numbers = [int(word.split(b"/")[0]) for word in words]
        rows = [matches[number - 1 if number > 0 else before + number].groups() for number in numbers]
        triangles = _triangles(_flattened([(float(x), float(y), float(z)) for x, y, z in rows]))
        lines = [b"f " + b" ".join(words[corner] for corner in triangle) for triangle in triangles]
        return b"\n".join(lines) or match[0]

    try:
        return _POLYGON.sub(replaced, data)
    except (ValueError, LookupError):
        return data


def _flattened(places: Sequence[tuple[float, float, float]]) -> list[_Point]:
    """A polygon in the plane of two axes that sees most of it, counter-clockwise."""
    sums = [0.0, 0.0, 0.0]  # twice the area that each axis sees
    for first, second in zip(places, [*places[1:], places[0]], strict=True):
        for axis in range(3):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            sums[axis] += first[u] * second[v] - second[u] * first[v]
    axis = max(range(3), key=lambda index: abs(sums[index]))
    u, v = ((axis + 1) % 3, (axis + 2) % 3) if sums[axis] > 0.0 else ((axis + 2) % 3, (axis + 1) % 3)
    return [(place[u], place[v]) for place in places]


def _triangles(points: Sequence[_Point]) -> list[tuple[int, int, int]]:
    """The triangles of a concave polygon; [] of a convex one."""
    rest = list(range(len(points)))
    if all(_turn(*(points[index] for index in ear)) >= 0.0 for ear in _corners(rest)):
        return []
    triangles = []
    while len(rest) > 3:
        ears = _corners(rest)
        ear = next((corner for corner in ears if _is_ear(corner, rest, points)), ears[0])
        triangles.append(ear)
        rest.remove(ear[1])
    return [*triangles, (rest[0], rest[1], rest[2])]


def _corners(rest: Sequence[int]) -> list[tuple[int, int, int]]:
    """Each corner between its neighbours."""
    return list(zip([rest[-1], *rest[:-1]], rest, [*rest[1:], rest[0]], strict=True))


def _is_ear(corner: tuple[int, int, int], rest: Sequence[int], points: Sequence[_Point]) -> bool:
    first, tip, last = (points[index] for index in corner)
    if _turn(first, tip, last) <= 0.0:
        return False
    others = (points[index] for index in rest if index not in corner)
    return not any(
        min(_turn(first, tip, other), _turn(tip, last, other), _turn(last, first, other)) >= 0.0
        for other in others
        if other not in (first, tip, last)
    )


def _turn(first: _Point, second: _Point, third: _Point) -> float:
    """Twice the area of a triangle: above 0 if it is counter-clockwise."""
    return (second[0] - first[0]) * (third[1] - first[1]) - (third[0] - first[0]) * (second[1] - first[1])
