"""Draws docs/stability/ and writes docs/stability.md: python -m qualification.pages.stability

The published techniques fail in the ways that docs/errata.md says, ours hold: in pictures drawn by what `sssgen` emits,
and in the figures of `qualification.errata`. A section of the page is a function in `SECTIONS`.
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

from qualification.errata import BACKENDS, CHAPTERS, OPEN, UNSHOWN, Erratum, Right, as_mended, as_published, maps
from sssgen.harness import backends
from sssgen.harness.backends import Backend
from sssgen.harness.render.scene_render import render
from sssgen.harness.scenes.scene_loading import load
from sssgen.support.file_writer import write_files

DOCS = Path(__file__).parents[2] / "docs"
PAGE = DOCS / "stability.md"
FOLDER = DOCS / "stability"

GAP = 8
"""Pixels between the pictures that stand side by side."""

Panel = Callable[[], npt.NDArray[np.float64]]
"""Draws an encoded picture, (height, width, 3), row 0 at the top."""


@dataclasses.dataclass(frozen=True)
class Shot:
    """A scene of docs/stability/, drawn with one of its materials."""

    scene: str
    material: str = "published"

    def __call__(self, size: tuple[int, int] | None = None) -> npt.NDArray[np.float64]:
        """The picture, of the scene's size where none is given."""
        folder = FOLDER / self.scene
        scene = dataclasses.replace(load(folder / "scene.toml"), material=str(folder / f"{self.material}.toml"))
        guards = "none" if self.material == "published" else "auto"
        return render(scene, backends.get("gl"), size, guards=guards).encoded


class Picture(NamedTuple):
    """Pictures side by side."""

    panels: tuple[Panel, ...]
    shown: str
    """What they show, for those who do not see them."""
    caption: str


class Chapter(NamedTuple):
    """One source: what goes wrong, what it looks like, what to use."""

    title: str
    text: str
    pictures: tuple[str, ...]
    """Their files' names."""


PICTURES = {
    "cube": Picture(
        (Shot("cube"), Shot("cube", "mended")),
        "Two cubes with the light behind: one with a dark X and a black square on each face, one lit smoothly from the "
        "edges that the light is near",
        "42yeah's thinness, and `march_light` with `beer_lambert`. The light is behind, above and to the left.",
    ),
    "wax": Picture(
        (
            lambda: maps.ball("alisavakis_lobe", 0.0, backends.get("gl")),
            lambda: maps.ball("alisavakis_lobe", 0.0, backends.get("browser")),
            lambda: maps.ball("lobe_normalized", 1.0, backends.get("gl")),
        ),
        "Three balls: one with a dark disc and a hard rim, one bright all over, one with a glow that fades smoothly",
        "Alisavakis with its own `concentration`, 0: one shader text, in OpenGL and in a browser. Where the lobe ends "
        "it computes pow(0, 0), which is 0 here and 1 there. Right: `lobe_normalized` at `power` 1.",
    ),
    "half_vector": Picture(
        (
            lambda: maps.half_vector("alisavakis_lobe", 1.0, backends.get("numpy-f32")),
            lambda: maps.half_vector("alisavakis_lobe", 1.0, backends.get("gl")),
            lambda: maps.half_vector("lobe_normalized", 0.9, backends.get("gl")),
        ),
        "Three gray maps: two are cut in the middle from bright to black, the first with a magenta square there; the "
        "third is smooth",
        "A map of the lobe over the light's direction, a tenth of a radian wide, the light straight behind in the "
        "middle. Alisavakis with `distortion` 1, in NumPy's float32 (magenta: NaN) and in OpenGL, where clamp() "
        "swallows the NaN and the tear remains; `lobe_normalized` with `distortion` .9.",
    ),
    "wedge": Picture(
        (Shot("wedge"), Shot("wedge", "mended")),
        "Two panels: one evenly bright with stripes, one that darkens evenly from left to right",
        "The face of a wedge, .2 m thick at the left and 1.2 m at the right. The article's sum, with 32 steps: the "
        "thick end is no darker, and the stripes are steps that meet the back. "
        "Right: `march_distance_texture`, with 16.",
    ),
    "ring": Picture(
        (Shot("ring"), Shot("ring", "mended")),
        "Two rings with the light behind: one blank above and black below, one shaded all round",
        "A ring of wax whose box begins above the origin. 3D Distance Fields looks for the matter beside where it is. "
        "Right: `march_distance_texture`.",
    ),
    "ball": Picture(
        (Shot("ball"), Shot("ball", "mended")),
        "Two balls with a lamp behind: one flat and dark, one that glows where the lamp is",
        "The same lamp, thickness, `power` and `scale` in the Unity ice lobe and in `lobe_normalized`.",
    ),
    "floor": Picture(
        (
            lambda: maps.floor("subsurface_parallax", {"eta": 1.5}, backends.get("gl")),
            lambda: maps.floor("parallax_refracted", {"ior": 1.5}, backends.get("gl")),
        ),
        "Two floors of wood with brass rings: one is magenta but for a bent piece at the viewer's feet, one is whole",
        "A floor with an inlay under resin of index 1.5. Subsurface Parallax with `eta` = 1.5 (magenta: NaN), and "
        "`parallax_refracted` with `ior` = 1.5.",
    ),
    "mirror": Picture(
        (
            lambda: maps.mirrored("subsurface_parallax", False, {"eta": 1.0 / 1.5}, backends.get("gl")),
            lambda: maps.mirrored("parallax_refracted", True, {"ior": 1.5}, backends.get("gl")),
        ),
        "Two panels of wood with brass rings: in one the rings are broken along the middle, in one they are whole",
        "The left half of the panel has mirrored texture coordinates, as many models have. Subsurface Parallax with B "
        "= cross(N, T), and `parallax_refracted` with the sign in the tangent's w.",
    ),
}

CHAPTER_TEXTS = {
    "Cheap SSS": Chapter(
        "Thinness from a distance field (Cheap SSS, XT95)",
        "The taps go straight inwards and see the nearest wall, not the way of the light: every face of a box shows a "
        "dark X with a black square in it, whatever the light does, and edges glow where nothing is behind them. The "
        "published cure weakens the X by making all parts alike. For light through a body use `march_light`, which "
        "measures the matter towards the light. Where a cheap glow at the rims is all that is wanted, "
        "`thinness_uniform` and `thinness_attenuated` have the published look with the range and the weights put "
        "right; the X stays.",
        ("cube",),
    ),
    "Alisavakis": Chapter(
        "The lobe with a thickness map (Alisavakis)",
        "With the parameters as they come the glow is undefined: black on one GPU, white on another. With `distortion` "
        "at 1 the lobe tears just where the light is behind. Use `lobe_normalized` with `distortion` below 1 (at 1 it "
        "stays a number, but tears as well), or `lobe_gdc2011`, which does not normalise and takes every `distortion`.",
        ("wax", "half_vector"),
    ),
    "3D Distance Fields": Chapter(
        "Thickness through a distance texture (3D Distance Fields)",
        "What it adds up is no length: thick and thin parts look alike, the look changes with the number of steps and "
        "with the model's scale, and a model that stands above the origin is read beside itself. Use "
        "`march_distance_texture`: it gives metres, from a box anywhere.",
        ("wedge", "ring"),
    ),
    "Unity ice": Chapter(
        "Ice after Zucconi, and its relatives (Unity ice)",
        "One letter is wrong, L for V, and the lobe is gone: what is left is an even light that no lamp changes. Use "
        "`lobe_normalized`. The others are small: `lobe_gdc2011` is duller where the surface faces the eye, "
        "`lobe_exp2` never gets quite dark, and three.js has a unit half vector unlike the talk that it names.",
        ("ball",),
    ),
    "Subsurface Parallax": Chapter(
        "Parallax below the surface (Subsurface Parallax)",
        "The index is to be given the other way round, which the source does not say; with 1.5 the picture breaks off "
        "beyond 41.81 degrees into NaN, which bloom makes into bright blots. Mirrored, sheared and scaled texture "
        "coordinates slide the wrong way or too far. Use `parallax_refracted` (or `parallax_straight`) with `ior`, a "
        "`depth` in metres, and `uv_per_unit`.",
        ("floor", "mirror"),
    ),
    "absorption": Chapter(
        "Absorption (glTF, GPU Gems 16)",
        "Glass of a pure colour is black where it has no thickness, on some GPUs; a coarse depth map makes lit places "
        "brighter than their lamp. Use `absorption_tint` or `beer_lambert`, and `depth_map_thickness`.",
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
        "# What fails, and what holds",
        "",
        *_paragraph(
            "Published shaders for translucency and parallax, as their sources have them, beside the techniques that "
            "`sssgen` has in their place: first what goes wrong, what it looks like and what to use, then the figures. "
            "In each row of pictures the published technique is at the left and ours at the right."
        ),
        *_paragraph(
            "Made by `make stability` (`qualification/pages/stability.py`). The pictures are drawn by the emitted GLSL "
            "in OpenGL where nothing else is said; scenes and materials are in `docs/stability/`. The figures are "
            "those of `qualification.errata`, on "
            + ", ".join(f"`{name}`" for name in BACKENDS)
            + "; where these differ, each is named. `tests/qualification/test_errata_shown.py` checks them: the "
            "published ones are off as theory says, ours are within their bounds on every back end. "
            "The published ones are measured without the guards that `sssgen` adds where an operation may go wrong, "
            "ours with them. "
            "[errata.md](errata.md) has the same errata in words."
        ),
    ]  # fmt: skip


def errata() -> list[str]:
    """A chapter for each source."""
    lines = []
    for name, chapter in CHAPTER_TEXTS.items():
        lines += [f"## {chapter.title}", "", *_paragraph(chapter.text)]
        for picture in chapter.pictures:
            picture_row = PICTURES[picture]
            lines += [f"![{picture_row.shown}](stability/{picture}.png)", "", *_paragraph(picture_row.caption)]
        lines += table(CHAPTERS[name])
    return lines


def unshown() -> list[str]:
    """What no number shows."""
    rows = (f"| {one.source} | {one.said} | {one.reason} |" for one in UNSHOWN)
    return ["## Errata that no number shows", "", "| Source | Erratum | Why not |", "|---|---|---|", *rows, ""]


def still_open() -> list[str]:
    """Where ours is not right either."""
    text = "Here ours does not keep the bound that it should."
    return ["## Still open", "", *_paragraph(text), *table(OPEN)]


def machines() -> list[str]:
    """Where it was measured."""
    items = (_item(f"`{one.name}`: {one.device()}") for one in present())
    return ["## Measured on", "", *(line for item in items for line in item), ""]


SECTIONS: tuple[Callable[[], list[str]], ...] = (introduction, errata, unshown, still_open, machines)
"""The page's sections, in their order."""


def table(chapter: tuple[Erratum, ...]) -> list[str]:
    """The errata of a chapter with their figures."""
    head = [
        "| Erratum | What is measured | By theory | As published | Ours | It must be |",
        "|---|---|---|---|---|---|",
    ]
    return [*head, *(row(one) for one in chapter), ""]


def row(erratum: Erratum) -> str:
    """One erratum with its figures on every back end that is here."""
    cells = [
        f"{erratum.source}: {erratum.name}",
        erratum.shown,
        told(erratum.theory) if erratum.theory else "undefined",
        _everywhere({one.name: told(as_published(erratum, one)) for one in present()}),
        _everywhere({one.name: told(as_mended(erratum, one)) for one in present()}),
        _bounds(erratum.right),
    ]
    return f"| {' | '.join(cells)} |"


def told(figures: tuple[float, ...]) -> str:
    """Figures, to five digits."""
    return " · ".join(
        "NaN" if np.isnan(figure) else "∞" if np.isinf(figure) else _number(0.0 if abs(figure) < 1e-6 else figure)
        for figure in figures
    )


def _number(value: float) -> str:
    return f"{value:.5g}".replace("e-0", "e-")


def _everywhere(figures: dict[str, str]) -> str:
    """The figures once where all back ends have the same, else with those that have them."""
    groups: dict[str, list[str]] = {}
    for name, one in figures.items():
        groups.setdefault(one, []).append(f"`{name}`")
    if len(groups) == 1:
        return next(iter(groups))
    return "<br>".join(f"{', '.join(names)}: {one}" for one, names in groups.items())


def _bounds(right: tuple[Right, ...]) -> str:
    """Where the figures must lie: values with a tolerance, or ranges."""
    if any(one.high - one.low > 0.1 for one in right):
        return " · ".join(f"{_number(one.low)} to {_number(one.high)}" for one in right)
    tolerance = max(0.5 * (one.high - one.low) for one in right)
    values = told(tuple(0.5 * (one.low + one.high) for one in right))
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
    """Draws, measures and writes."""
    files = draw()
    write_files(str(FOLDER), files)
    PAGE.write_text(page(), encoding="utf-8")
    print(f"wrote {PAGE.name} and {len(files)} pictures, {sum(map(len, files.values())) / 1000:.0f} kB")


if __name__ == "__main__":
    main()
