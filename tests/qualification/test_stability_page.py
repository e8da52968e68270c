"""docs/stability.md has the current figures and pictures."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

from folders import DOCS
from qualification.errata import ERRATA, OPEN, TEXT_ERRATA, as_corrected, as_published
from qualification.pages import stability
from sssgen.run.backends import Backend
from sssgen.scene.pictures import images

FOLDER = DOCS / "stability"
MAGENTA = (1.0, 0.0, 1.0)
WIDTH, HEIGHT = 320, 240

Get = Callable[[str], Backend]


@cache
def script() -> dict[str, Any]:
    return vars(stability)


@cache
def rows() -> dict[str, list[str]]:
    """First cell → all cells of the row, for all tables."""
    text = (DOCS / "stability.md").read_text(encoding="utf-8")
    cells = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ")]
    return {row[0]: row for row in cells if len(row) == 6}


def panels(name: str) -> list[npt.NDArray[np.float64]]:
    """The stored pictures of a row of pictures."""
    stored = images.read(FOLDER / f"{name}.png")
    step = WIDTH + script()["GAP"]
    return [stored[:, start : start + WIDTH] for start in range(0, stored.shape[1], step)]


def figures(cell: str, backend: str) -> list[float]:
    """The figures of a cell for a back end."""
    groups = cell.split("<br>")
    named = [group for group in groups if f"`{backend}`" in group] if ":" in cell else groups
    numbers = named[0].rpartition(": ")[2].replace("∞", "inf").replace("NaN", "nan")
    return [float(number) for number in numbers.split(" · ")]


@pytest.mark.parametrize("name", ["numpy-f32", "gl"])
def test_the_figures_are_current(backend: Get, name: str) -> None:
    """Undefined results depend on the driver, so only those of NumPy are compared."""
    machine = backend(name)
    for erratum in (*ERRATA, *OPEN):
        cells = rows()[f"{erratum.source}: {erratum.name}"]
        assert cells[1] == erratum.demonstration, "run make stability"
        assert cells[2] == (script()["figures_text"](erratum.theory) if erratum.theory else "undefined")
        assert cells[5] == script()["_bounds"](erratum.right)
        close = {"rel": 1e-3, "abs": 2e-6, "nan_ok": True}
        assert figures(cells[4], name) == pytest.approx(as_corrected(erratum, machine), **close), erratum.name
        if erratum.everywhere or name == "numpy-f32":
            assert figures(cells[3], name) == pytest.approx(as_published(erratum, machine), **close), erratum.name


def test_the_page_has_everything_once() -> None:
    assert len(rows()) == len(ERRATA) + len(OPEN) + 1, "and the head of the table"
    text = (DOCS / "stability.md").read_text(encoding="utf-8")
    for erratum in TEXT_ERRATA:
        assert f"| {erratum.source} | {erratum.claim} | {erratum.reason} |" in text
    linked = re.findall(r"^!\[.+\]\(stability/(\w+)\.png\)$", text, re.MULTILINE)
    assert sorted(linked) == sorted(script()["PICTURES"]) == sorted(path.stem for path in FOLDER.glob("*.png"))
    assert sorted(path.name for path in FOLDER.iterdir() if path.is_dir()) == sorted(
        {
            panel.scene
            for picture in script()["PICTURES"].values()
            for panel in picture.panels
            if hasattr(panel, "scene")
        }
    )


def test_the_pictures_are_small() -> None:
    files = list(FOLDER.glob("*.png"))
    assert sum(file.stat().st_size for file in files) < 400_000
    for file in files:
        count = len(script()["PICTURES"][file.stem].panels)
        with Image.open(file) as picture:
            assert (picture.mode, picture.size) == ("RGB", (count * WIDTH + (count - 1) * script()["GAP"], HEIGHT))


@pytest.mark.slow
def test_the_pictures_are_current(backend: Get) -> None:
    """Scenes are drawn at a quarter of their size, maps at full size."""
    backend("gl"), backend("browser")
    for name, picture in script()["PICTURES"].items():
        for panel, stored in zip(picture.panels, panels(name), strict=True):
            if not hasattr(panel, "scene"):
                assert np.abs(stored - panel()).max(axis=2).mean() < 0.002, name
                continue
            small = images.decode_srgb(stored).reshape(HEIGHT // 4, 4, WIDTH // 4, 4, 3).mean(axis=(1, 3))
            far = np.abs(images.encode_srgb(small) - panel((WIDTH // 4, HEIGHT // 4)))
            assert far.mean() < 0.006, f"{name} {panel.material}: run make stability"


# The contents of the pictures


def no_number(picture: npt.NDArray[np.float64]) -> int:
    return int((picture == MAGENTA).all(axis=2).sum())


def test_the_published_cube_has_a_black_square() -> None:
    published, ours = (picture[120:155, 120:155].mean() for picture in panels("cube"))
    assert published < 0.02 and ours > 0.2


def test_the_published_ball_is_flat_and_the_other_glows() -> None:
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    inside = np.hypot(x - WIDTH / 2, y - HEIGHT / 2) < 90
    published, ours = (picture.mean(axis=2)[inside] for picture in panels("ball"))
    assert published.std() < 0.02 and ours.std() > 0.08
    assert ours.max() > published.max() + 0.3


def test_the_same_text_gives_two_pictures() -> None:
    in_gl, in_browser, ours = panels("wax")
    assert (np.abs(in_gl - in_browser).max(axis=2) > 0.5).mean() > 0.1
    edges = [np.abs(np.diff(picture[HEIGHT // 2, 80:240], axis=0)).max() for picture in (in_gl, ours)]
    assert edges[0] > 0.5 and edges[1] < 0.15, "the published rim is hard, the other is smooth"


def test_the_published_lobe_is_discontinuous() -> None:
    numpy, gl, ours = panels("half_vector")
    assert [no_number(picture) for picture in (numpy, gl, ours)] == [64, 0, 0]
    steps = [np.abs(np.diff(picture[100, :, 0])).max() for picture in (gl, ours)]
    middle = [np.abs(np.diff(picture[HEIGHT // 2, :, 0])).max() for picture in (gl, ours)]
    assert middle[0] > 0.5 > steps[0] and max(middle[1], steps[1]) < 0.05


def test_the_wedge_is_no_darker_where_it_is_thick() -> None:
    published, ours = (picture.mean(axis=(0, 2)) for picture in panels("wedge"))
    assert published[280:].mean() > published[:80].mean() - 0.03
    assert np.abs(np.diff(published)).max() > 0.03 > np.abs(np.diff(ours)).max(), (
        "the published face has stripes, the other has none"
    )
    assert ours[:40].mean() > ours[280:].mean() + 0.3 and (np.diff(ours) < 0.004).all()


def test_the_published_ring_is_blank_at_the_top() -> None:
    published, ours = (picture[38:58, 145:175].mean(axis=2) for picture in panels("ring"))
    assert published.std() < 0.01 < ours.std()


def test_the_published_floor_ends() -> None:
    published, ours = panels("floor")
    assert no_number(published) > 0.5 * WIDTH * HEIGHT and not no_number(ours)


def test_the_rings_are_broken_along_the_mirror() -> None:
    published, ours = panels("mirror")
    seams = [np.abs(picture[:, 159] - picture[:, 160]).mean() for picture in (published, ours)]
    assert seams[0] > 0.1 and seams[1] < 0.01
