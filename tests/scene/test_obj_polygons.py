"""Concave polygons of .obj files are read as they are."""

from __future__ import annotations

import numpy as np
import pytest

from sssgen.scene import mesh_files
from sssgen.scene.obj_polygons import without_concave

pytest.importorskip("trimesh", reason="trimesh is missing: pip install -e '.[import]'")

LETTER_U = [(0, 0), (4, 0), (4, 4), (3, 4), (3, 1), (1, 1), (1, 4), (0, 4)]
AREA = 10.0
COMB = [(0, 0), (5, 0), (5, 3), (4, 1), (3, 3), (2, 1), (1, 3), (0.5, 1), (0, 3)]


def areas(text: str) -> np.ndarray:
    """The vectors of the triangles' areas, (f, 3)."""
    content = mesh_files.parse(text.encode(), "polygon.obj")
    first, second, third = np.moveaxis(content.vertices[content.faces], 1, 0)
    vectors: np.ndarray = 0.5 * np.cross(second - first, third - first)
    return vectors


def polygon(points: list[tuple[float, float]], turn: int, corners: list[str]) -> str:
    """A polygon in the plane across an axis."""
    rows = ["v " + " ".join(map(str, np.roll([x, y, 2.0], turn))) for x, y in points]
    return "\n".join([*rows, "vt 0 0", "f " + " ".join(corners), ""])


@pytest.mark.parametrize("turn", [0, 1, 2])
@pytest.mark.parametrize("start", [0, 3, 5])
@pytest.mark.parametrize("form", ["{0}", "{0}/1", "-{1}"])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_triangles_cover_a_concave_polygon_once(turn: int, start: int, form: str, side: float) -> None:
    order = np.roll(np.arange(8), start)[:: int(side)]
    vectors = areas(polygon(LETTER_U, turn, [form.format(index + 1, 8 - index) for index in order]))
    axis = (2 + turn) % 3
    assert len(vectors) == 6 and (side * vectors[:, axis] > 0.0).all()
    assert vectors.sum(axis=0)[axis] == pytest.approx(side * AREA)


def test_a_comb_is_covered_once() -> None:
    x, y = np.array(COMB).T
    area = 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    vectors = areas(polygon(COMB, 0, [str(index + 1) for index in range(len(COMB))]))
    assert (vectors[:, 2] > 0.0).all() and vectors[:, 2].sum() == pytest.approx(area)


def test_other_faces_stay_as_they_are() -> None:
    angles = np.linspace(0.0, 2.0 * np.pi, 7)[:-1]
    convex = polygon([*zip(np.cos(angles), np.sin(angles), strict=True)], 0, ["1", "2", "3", "4", "5", "6"])
    for text in (convex, "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n", convex.replace("v 1.0", "v x"), "f 1 2 3 4 9\n"):
        assert without_concave(text.encode()) == text.encode()


def test_lines_of_errors_are_those_of_the_file() -> None:
    from sssgen.support.diagnostics import SssgenError

    text = polygon(LETTER_U, 0, [str(index + 1) for index in range(8)]) + "f 1 2 99\n"
    with pytest.raises(SssgenError) as caught:
        mesh_files.parse(text.encode(), "polygon.obj")
    assert caught.value.diagnostics[0].span.line == 11


def test_tabs_are_spaces() -> None:
    text = "v\t0\t0\t0\nv\t1\t0\t0\nv\t1\t1\t0\nf\t1\t2\t3\n"
    assert areas(text)[:, 2].sum() == pytest.approx(0.5)
