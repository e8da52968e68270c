"""Draws docs/stability/ and writes docs/stability.md: python -m qualification.pages.stability

The page shows the errata of docs/errata.md: pictures drawn by the emitted shaders, and the figures of
`qualification.errata`, of the published techniques and of those of the library. `SECTIONS` has a function per section.
"""

from __future__ import annotations

import dataclasses
import io
from collections.abc import Callable
from functools import cache
from pathlib import Path
from textwrap import wrap
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from PIL import Image

from qualification.errata import BACKENDS, CHAPTERS, OPEN, TEXT_ERRATA, Erratum, Right, as_corrected, as_published, maps
from sssgen.run import backends
from sssgen.run.backends import Backend
from sssgen.run.render.scene_render import render
from sssgen.scene.scene_loading import load
from sssgen.support.file_writer import write_files

DOCS = Path(__file__).parents[2] / "docs"
PAGE = DOCS / "stability.md"
FOLDER = DOCS / "stability"

GAP = 8
"""Pixels between two pictures of a row."""

Panel = Callable[[], npt.NDArray[np.float64]]
"""Draws an encoded picture, (height, width, 3), row 0 at the top."""


@dataclasses.dataclass(frozen=True)
class Shot:
    """A scene of docs/stability/, drawn with one of its materials."""

    scene: str
    material: str = "published"

    def __call__(self, size: tuple[int, int] | None = None) -> npt.NDArray[np.float64]:
        """The picture; by default in the scene's size."""
        folder = FOLDER / self.scene
        scene = dataclasses.replace(load(folder / "scene.toml"), material=str(folder / f"{self.material}.toml"))
        guards = "none" if self.material == "published" else "auto"
        return render(scene, backends.get("gl"), size, guards=guards).encoded


class Picture(NamedTuple):
    """Pictures side by side."""

    panels: tuple[Panel, ...]
    alternative_text: str
    """The alternative text."""
    caption: str


class Chapter(NamedTuple):
    """One source: what goes wrong, what it looks like, what to use instead."""

    title: str
    text: str
    pictures: tuple[str, ...]
    """The names of their files."""


PICTURES = {
    "cube": Picture(
        (Shot("cube"), Shot("cube", "mended")),
        "Two cubes with the light behind them: one with a dark X and a black square on each face, one lit smoothly "
        "from the edges near the light",
        "42yeah's thinness, and `march_light` with `beer_lambert`. The light is behind, above and to the left.",
    ),
    "wax": Picture(
        (
            lambda: maps.ball("alisavakis_lobe", 0.0, backends.get("gl")),
            lambda: maps.ball("alisavakis_lobe", 0.0, backends.get("browser")),
            lambda: maps.ball("lobe_normalized", 1.0, backends.get("gl")),
        ),
        "Three balls: one with a dark disc and a hard rim, one bright everywhere, one with a glow that fades smoothly",
        "Alisavakis with its default `concentration`, 0: the same shader text in OpenGL and in a browser. Where the "
        "lobe ends it computes pow(0, 0), which is 0 in OpenGL and 1 in the browser. Right: `lobe_normalized` at "
        "`power` 1.",
    ),
    "half_vector": Picture(
        (
            lambda: maps.half_vector("alisavakis_lobe", 1.0, backends.get("numpy-f32")),
            lambda: maps.half_vector("alisavakis_lobe", 1.0, backends.get("gl")),
            lambda: maps.half_vector("lobe_normalized", 0.9, backends.get("gl")),
        ),
        "Three gray maps: two change abruptly from bright to black in the middle, the first with a magenta square "
        "there; the third is smooth",
        "The lobe as a function of the light's direction, over a tenth of a radian; in the middle the light is "
        "directly behind. Alisavakis with `distortion` 1, in NumPy's float32 (magenta: NaN) and in OpenGL, where "
        "clamp() hides the NaN but the discontinuity remains; `lobe_normalized` with `distortion` .9.",
    ),
    "wedge": Picture(
        (Shot("wedge"), Shot("wedge", "mended")),
        "Two panels: one evenly bright with stripes, one that darkens evenly from left to right",
        "The face of a wedge, .2 m thick at the left and 1.2 m at the right. The article's sum with 32 steps: the "
        "thick end is not darker, and stripes appear where steps reach the back. Right: `march_distance_texture` with "
        "16 steps.",
    ),
    "ring": Picture(
        (Shot("ring"), Shot("ring", "mended")),
        "Two rings with the light behind them: one blank at the top and black at the bottom, one shaded all around",
        "A ring of wax whose box begins above the origin. 3D Distance Fields reads the texture at the wrong place. "
        "Right: `march_distance_texture`.",
    ),
    "ball": Picture(
        (Shot("ball"), Shot("ball", "mended")),
        "Two balls with a lamp behind them: one flat and dark, one that glows near the lamp",
        "The same lamp, thickness, `power` and `scale` in the Unity ice lobe and in `lobe_normalized`.",
    ),
    "floor": Picture(
        (
            lambda: maps.floor("subsurface_parallax", {"eta": 1.5}, backends.get("gl")),
            lambda: maps.floor("parallax_refracted", {"ior": 1.5}, backends.get("gl")),
        ),
        "Two floors of wood with brass rings: one is magenta except for a distorted piece near the viewer, one is "
        "complete",
        "A floor with an inlay under resin of index 1.5. Subsurface Parallax with `eta` = 1.5 (magenta: NaN), and "
        "`parallax_refracted` with `ior` = 1.5.",
    ),
    "mirror": Picture(
        (
            lambda: maps.mirrored("subsurface_parallax", False, {"eta": 1.0 / 1.5}, backends.get("gl")),
            lambda: maps.mirrored("parallax_refracted", True, {"ior": 1.5}, backends.get("gl")),
        ),
        "Two panels of wood with brass rings: in one the rings are broken along the middle, in one they are unbroken",
        "The left half of the panel has mirrored texture coordinates, as many models have. Subsurface Parallax with B "
        "= cross(N, T), and `parallax_refracted` with the sign in the tangent's w.",
    ),
}

CHAPTER_TEXTS = {
    "Cheap SSS": Chapter(
        "Thinness from a distance field (Cheap SSS, XT95)",
        "The taps go straight inwards and measure the distance to the nearest face instead of the light's path: every "
        "face of a box shows a dark X with a black square in it, whatever the light does, and edges glow although "
        "nothing is behind them. The published remedy weakens the X by making all parts alike. For light through a "
        "body use `march_light`, which measures the matter towards the light. If a cheap glow at the rims is "
        "sufficient, `thinness_uniform` and `thinness_attenuated` have the published look with correct range and "
        "weights; the X remains.",
        ("cube",),
    ),
    "Alisavakis": Chapter(
        "The lobe with a thickness map (Alisavakis)",
        "With the default parameters the glow is undefined: black on one GPU, white on another. With `distortion` at 1 "
        "the lobe is discontinuous where the light is directly behind. Use `lobe_normalized` with `distortion` below 1 "
        "(at 1 it stays finite, but is discontinuous too), or `lobe_gdc2011`, which does not normalise and accepts "
        "every `distortion`.",
        ("wax", "half_vector"),
    ),
    "3D Distance Fields": Chapter(
        "Thickness through a distance texture (3D Distance Fields)",
        "Its sum is not a length: thick and thin parts look alike, the look changes with the number of steps and with "
        "the model's scale, and for a model above the origin the texture is read at the wrong place. Use "
        "`march_distance_texture`: it returns metres, from a box at any position.",
        ("wedge", "ring"),
    ),
    "Unity ice": Chapter(
        "Ice after Zucconi, and related lobes (Unity ice)",
        "One letter is wrong, L instead of V, and the lobe vanishes: only an even light remains that no lamp changes. "
        "Use `lobe_normalized`. The other errata are small: `lobe_gdc2011` is weaker where the surface faces the eye, "
        "`lobe_exp2` never becomes completely dark, and three.js normalises the half vector, unlike the talk that it "
        "cites.",
        ("ball",),
    ),
    "Subsurface Parallax": Chapter(
        "Parallax below the surface (Subsurface Parallax)",
        "The index must be given as its reciprocal, which the source does not state; with 1.5 the picture is NaN "
        "beyond 41.81 degrees, which bloom spreads into bright spots. Mirrored, sheared and scaled texture coordinates "
        "shift the picture in the wrong direction or too far. Use `parallax_refracted` (or `parallax_straight`) with "
        "`ior`, a `depth` in metres, and `uv_per_unit`.",
        ("floor", "mirror"),
    ),
    "absorption": Chapter(
        "Absorption (glTF, GPU Gems 16)",
        "Glass of a saturated colour is black where its thickness is 0, on some GPUs; a coarse depth map makes lit "
        "places brighter than their lamp. Use `absorption_tint` or `beer_lambert`, and `depth_map_thickness`.",
        (),
    ),
}


@cache
def present() -> tuple[Backend, ...]:
    """The back ends that the figures are from."""
    return tuple(backends.get(name) for name in BACKENDS)


def introduction() -> list[str]:
    """The head of the page."""
    return [
        "# Published shaders: errata, measured",
        "",
        *_paragraph(
            "Published shaders for translucency and parallax, exactly as in their sources, next to the techniques that "
            "`sssgen` offers in their place: what goes wrong, what it looks like, what to use, and the measured "
            "figures. In each row of pictures the published technique is on the left and the one of `sssgen` on the "
            "right."
        ),
        *_paragraph(
            "`make stability` writes this page (`qualification/pages/stability.py`). The emitted GLSL draws the "
            "pictures in OpenGL, unless stated otherwise; scenes and materials are in `docs/stability/`. The figures "
            "are those of `qualification.errata` on "
            + ", ".join(f"`{name}`" for name in BACKENDS)
            + "; if these differ, each is named. `tests/qualification/test_errata_shown.py` checks that the published "
            "techniques deviate as the theory predicts, and that those of `sssgen` are within their bounds on every "
            "back end. The published techniques are measured without the guards that `sssgen` adds to operations that "
            "can fail, those of `sssgen` with them. [errata.md](errata.md) describes the same errata in words."
        ),
    ]  # fmt: skip


def errata() -> list[str]:
    """A chapter for each source."""
    lines = []
    for name, chapter in CHAPTER_TEXTS.items():
        lines += [f"## {chapter.title}", "", *_paragraph(chapter.text)]
        for picture in chapter.pictures:
            picture_row = PICTURES[picture]
            lines += [
                f"![{picture_row.alternative_text}](stability/{picture}.png)",
                "",
                *_paragraph(picture_row.caption),
            ]
        lines += table(CHAPTERS[name])
    return lines


def without_figures() -> list[str]:
    """The errata that cannot be measured."""
    rows = (f"| {erratum.source} | {erratum.claim} | {erratum.reason} |" for erratum in TEXT_ERRATA)
    return ["## Errata without figures", "", "| Source | Erratum | Reason |", "|---|---|---|", *rows, ""]


def still_open() -> list[str]:
    """The errata that the library's techniques have, too."""
    text = "Here the technique of `sssgen` is not within its bound either."
    return ["## Still open", "", *_paragraph(text), *table(OPEN)]


def machines() -> list[str]:
    """The back ends and their devices."""
    items = (_item(f"`{backend.name}`: {backend.device()}") for backend in present())
    return ["## Measured on", "", *(line for item in items for line in item), ""]


SECTIONS: tuple[Callable[[], list[str]], ...] = (introduction, errata, without_figures, still_open, machines)
"""The page's sections, in order."""


def table(chapter: tuple[Erratum, ...]) -> list[str]:
    """The errata of a chapter with their figures."""
    head = [
        "| Erratum | Measurement | In theory | As published | In `sssgen` | Required |",
        "|---|---|---|---|---|---|",
    ]
    return [*head, *(row(erratum) for erratum in chapter), ""]


def row(erratum: Erratum) -> str:
    """One erratum with its figures on every back end of this machine."""
    cells = [
        f"{erratum.source}: {erratum.name}",
        erratum.demonstration,
        figures_text(erratum.theory) if erratum.theory else "undefined",
        _by_backend({backend.name: figures_text(as_published(erratum, backend)) for backend in present()}),
        _by_backend({backend.name: figures_text(as_corrected(erratum, backend)) for backend in present()}),
        _bounds(erratum.right),
    ]
    return f"| {' | '.join(cells)} |"


def figures_text(figures: tuple[float, ...]) -> str:
    """Figures with five digits."""
    return " · ".join(
        "NaN" if np.isnan(figure) else "∞" if np.isinf(figure) else _number(0.0 if abs(figure) < 1e-6 else figure)
        for figure in figures
    )


def _number(value: float) -> str:
    return f"{value:.5g}".replace("e-0", "e-")


def _by_backend(figures: dict[str, str]) -> str:
    """The figures, once if all back ends agree, otherwise with the names of the back ends."""
    groups: dict[str, list[str]] = {}
    for name, text in figures.items():
        groups.setdefault(text, []).append(f"`{name}`")
    if len(groups) == 1:
        return next(iter(groups))
    return "<br>".join(f"{', '.join(names)}: {text}" for text, names in groups.items())


def _bounds(right: tuple[Right, ...]) -> str:
    """The required figures: values with a tolerance, or ranges."""
    if any(limits.high - limits.low > 0.1 for limits in right):
        return " · ".join(f"{_number(limits.low)} to {_number(limits.high)}" for limits in right)
    tolerance = max(0.5 * (limits.high - limits.low) for limits in right)
    values = figures_text(tuple(0.5 * (limits.low + limits.high) for limits in right))
    return f"{values} (± {_number(tolerance)})" if tolerance else values


def _paragraph(text: str) -> list[str]:
    return [*wrap(text, 120, break_on_hyphens=False, break_long_words=False), ""]


def _item(text: str) -> list[str]:
    return wrap(f"- {text}", 120, subsequent_indent="  ", break_on_hyphens=False, break_long_words=False)


def page() -> str:
    """The page's text, with the figures of this machine."""
    lines = [line for section in SECTIONS for line in section()]
    return "\n".join(lines).rstrip("\n") + "\n"


def strip(name: str) -> npt.NDArray[np.uint8]:
    """The pictures of a row, side by side on white."""
    panels = [panel() for panel in PICTURES[name].panels]
    gap = np.ones((panels[0].shape[0], GAP, 3))
    parts = [part for panel in panels for part in (gap, panel)][1:]
    bytes_: npt.NDArray[np.uint8] = np.rint(255.0 * np.concatenate(parts, axis=1)).astype(np.uint8)
    return bytes_


def draw() -> dict[str, bytes]:
    """File name → PNG of every row of pictures."""
    files = {}
    for name in PICTURES:
        buffer = io.BytesIO()
        Image.fromarray(strip(name)).save(buffer, "PNG", optimize=True)
        files[f"{name}.png"] = buffer.getvalue()
    return files


def main() -> None:
    """Draws the pictures, measures the errata, and writes the page."""
    files = draw()
    write_files(str(FOLDER), files)
    PAGE.write_text(page(), encoding="utf-8")
    print(f"wrote {PAGE.name} and {len(files)} pictures, {sum(map(len, files.values())) / 1000:.0f} kB")


if __name__ == "__main__":
    main()
