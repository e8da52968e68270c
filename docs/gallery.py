"""Draws the example scenes into docs/gallery/ and writes docs/gallery.md: python docs/gallery.py [SCENE …]

The emitted GLSL draws the pictures. The page has the description, the techniques and the cost of each, and the
differences between the back ends. Where scenes or `loop` are named, only these are drawn.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from textwrap import wrap
from typing import Any

import gallery_loop
from gallery_items import PICTURED, pictured

import sssgen
from sssgen.cli.options import add_workers
from sssgen.jobs.executor import Item, failures, run
from sssgen.jobs.result_store import Store
from sssgen.material.material_loading import load_material
from sssgen.material.model import Material
from sssgen.material.requirements import describe
from sssgen.run import backends
from sssgen.run.backends import Backend
from sssgen.support.file_writer import write_files
from sssgen.support.progress import ProgressBar

PAGE = Path(__file__).with_name("gallery.md")
PICTURES = Path(__file__).with_name("gallery")

BACKENDS = tuple(name for name in backends.DEFAULT if backends.BACKENDS[name].driver)
SMALL = (160, 120)
"""The size in pixels of the pictures that are compared."""
MARCHED = ("candle", "skin_ear", "leaves", "jelly", "ice_body", "soap", "milk_glass")
"""The scenes whose shaders march through distance functions, which takes NumPy minutes in the full size."""

CAPTIONS = {
    "candle": "A point light above the wax: the flame. The lengths inside the wax, from the eye and to the flame, are "
    "marched through its distance function, so that the flame may move and the candle may burn down. The flame itself "
    "is a surface technique beside the material.",
    "skin_ear": "An ear with the low sun behind it. The medium is near that of measured skin: red light goes farther "
    "than green and blue. Nothing is baked, and nothing is drawn before the picture. `scene_relit.toml` in the same "
    "folder has the cast of an ear, with a baked response to light, under lamps that may move.",
    "leaves": "Sheets that are lit from both sides. The thickness technique of this example counts a leaf's veins, the "
    "net between them and all leaves between it and the sun, so that leaves show the shadows of others.",
    "jelly": "The length towards the light in place of the depth of the nearest face, which makes "
    "[the X](stability.md#thinness-from-a-distance-field-cheap-sss-xt95) of `jelly_cubes` below. The light that comes "
    "through the cubes falls on the plate; the shell's shadow map keeps the other light from there.",
    "ice_body": "Ice as a body: the eye's ray is refracted at its surface and mirrored at the faces behind, which "
    "show the surroundings; the ice absorbs red before blue and scatters little, and cracks inside it scatter the sun.",
    "soap": "A bar of glycerin soap with an engraved leaf. Both lengths inside it are marched through its distance "
    "function, so that the bar may be used up; the shadow on the slate is the shell's.",
    "milk_glass": "A lamp of milk glass. The bulb is a point light inside the dome, whose thin glass scatters its "
    "light; the stem is brass, and both mirror the lamps of a studio.",
    "paper_lantern": "Alisavakis's simple subsurface scattering, on paper and wood. The lamp is inside, so every side "
    "is lit from behind. A map holds the thickness of the paper fibres; the hoops are opaque.",
    "wax_mouse": "Subsurface scattering with 3-D distance fields, on a candle. The shader marches the light's path "
    "through the wax in a 3-D distance texture, which is computed from the geometry: the ears glow, the body stays "
    "dark. `scene_mesh.toml` in the same folder draws Blender's monkey, if you have its mesh.",
    "ice": "A cave in a glacier: ice after Zucconi's fast subsurface scattering. Voronoi facets give thickness and "
    "normals, the sun is behind them, and light moves in the veins below. The roof is thicker inside, so that light "
    "comes from the mouth; snow is a part of the body. The material `ice` has a cover of snow and holes that melt.",
    "resin_inlay": "Subsurface parallax: marquetry below clear resin. Refraction determines where the inlay appears: "
    "flat below the flat top, distorted below the round edges.",
    "ice_inlay": "Subsurface parallax and the lobe of GDC 2011 in one material: refracted parallax places the leaves "
    "below the surface of the ice, and the light of the low sun passes through around them.",
    "jade_ring": "Light that is scattered inside the body, on jade. The program draws the back faces from the eye and "
    "a depth map from the light for each frame: nothing is baked, and the bangles need no texture coordinates. Their "
    "diffuse reflection is small, because the scattered light contains the light that enters in front. Clouds and "
    "veins are noise at the place from which the light comes.",
    "marble_idol": "Baked light inside a body, on marble. `sssgen bake fluence` has traced light through the bust, for "
    "lights from everywhere: the sun may move. Two volumes of 8 bits and a table hold it, 90 kB together. What is "
    "scattered once is computed exactly, with the same two drawn textures as in `jade_ring`. `scene_relit.toml` in the "
    "same folder has the bust under several lamps that may move, near ones, too.",
    "jelly_cubes": "42yeah's raymarched scene as it was published, drawn by the shader alone: it marches rays through "
    "distance functions. Where a cube is thin, at its edges and corners, the light of the evening sky passes through. "
    "The X on the faces is the published technique's: see `jelly` above.",
}
"""A caption for the picture of each example, in the order of the page."""

ALTERNATIVE_TEXTS = {
    "loop": "Two cubes of red jelly on a plate; the light goes around them, and red light falls on the plate",
    "before and after": "An ear and a candle: an engine's default, sssgen, and path traced",
    "candle": "A burning candle in the dark: its upper half glows, its foot is dark",
    "skin_ear": "An ear beside a dark cheek, glowing red in the light behind it",
    "leaves": "A twig with five bright green leaves against the light in a wood, with dark and fine veins",
    "jelly": "Two cubes of red jelly with bright edges on a white plate, with red light in their shadows",
    "ice_body": "A block of clear dark blue ice with bright cracks inside and bright lower edges",
    "soap": "A bar of amber soap with an engraved leaf, on a slab of slate with the light behind it",
    "milk_glass": "A table lamp with a glowing dome of white glass on a brass stem",
    "jelly_cubes": "Two red cubes of jelly on a checkered floor, their edges lit by the evening sky behind them",
    "paper_lantern": "A round paper lantern with dark wooden hoops and a red tassel, lit from inside, at dusk",
    "wax_mouse": "A sitting mouse of amber wax with large round ears that glow in the light behind it",
    "ice": "A cave of blue ice, bright around its mouth, with snow on its floor and mountains outside",
    "resin_inlay": "A square tile of walnut with an inlaid compass rose, under glossy resin with round edges",
    "ice_inlay": "Autumn leaves in a round disc of ice, with the sun behind it",
    "jade_ring": "Two bangles of clouded green jade on dark slate: one leans on the other, with the light behind them",
    "marble_idol": "A smooth marble bust with folded arms, bright on the right where the sun is behind it",
}
"""The alternative text of each picture."""


def items(names: Sequence[str]) -> list[Item]:
    """For each scene: its picture, the differences of small pictures, and of large ones with one sample per pixel."""
    jobs = [Item("gallery_items:picture", (name,), name) for name in names]
    large = [name for name in names if name not in MARCHED]
    for title, size, samples, compared in (("small", SMALL, None, names), ("one sample", None, 1, large)):
        jobs += [
            Item("gallery_items:compare_backends", (name, BACKENDS, size, samples), f"{name}, {title}")
            for name in compared
        ]
    return jobs


def page(present: list[Backend], small: dict[str, list[str]], large: dict[str, list[str]]) -> str:
    """The page's text, with the figures of this machine."""
    lines = [
        "# Gallery",
        "",
        *_paragraph(
            "One scene for each example material, drawn by the emitted GLSL. `make gallery` (`docs/gallery.py`) writes "
            "this page; `examples/textures.py` draws the textures of the scenes. Costs are static, as in the "
            "reflection: the maximum for one evaluation, for each fragment and in addition for each light."
        ),
        f"![{ALTERNATIVE_TEXTS['loop']}](gallery/{gallery_loop.LOOP})",
        "",
        *_paragraph(
            f"The window goes around the scene of `{gallery_loop.SCENE}`: nothing is baked, so any light may move."
        ),
    ]
    lines += [
        f"![{ALTERNATIVE_TEXTS['before and after']}](accuracy/before_after.png)",
        "",
        *_paragraph(
            "The ear and the candle by the default shading of engines, by their material, and by path tracing of the "
            "medium that the material's numbers describe; the highlights are the same (`docs/before_after.py`). The "
            "ear's material is less red than its medium. [Jade, soap, milk glass and ice](accuracy/bodies.md"
            "#the-gallery-beside-path-tracing) are beside path tracing, too."
        ),
    ]
    for name, caption in CAPTIONS.items():
        lines += _entry(name, caption)
    lines += [
        "## The same picture everywhere",
        "",
        *_paragraph(
            f"Each scene at {SMALL[0]} × {SMALL[1]} on every back end: the largest difference of any channel of any "
            "pixel from NumPy's picture in float64, in 1/255 of the encoded sRGB value, before rounding to 8 bits. "
            "`tests/run/test_gallery.py` checks that it is below 1 at 64 × 48 with one sample per pixel."
        ),
        f"| Scene | {' | '.join(f'`{backend.name}`' for backend in present)} |",
        f"|---|{'---|' * len(present)}",
    ]
    lines += [_row(name, small[name]) for name in CAPTIONS]
    lines += [
        "",
        *_paragraph(
            "The number of pixels that differ by more than 1/255, out of 307,200 in the full size with one sample "
            "each. There float32 and float64 decide differently: `jelly_cubes` finds its surface itself, and a ray at "
            "the edge of a cube, a tile or a shadow can fall on either side. `jade_ring` and `marble_idol` read a "
            "depth map between two texels at the edge that the light sees, where drivers interpolate with different "
            "weights. Scenes whose shaders march through distance functions are compared in the small size only."
        ),
        f"| Scene | {' | '.join(f'`{backend.name}`' for backend in present)} |",
        f"|---|{'---|' * len(present)}",
    ]
    lines += [_row(name, large[name]) for name in CAPTIONS if name not in MARCHED]
    lines += [
        "",
        *(
            f"- `{backend.name}`: {backends.BACKENDS[backend.name].description}; {backend.device()}"
            for backend in present
        ),
    ]
    return "\n".join(lines) + "\n"


def stored_rows() -> tuple[dict[str, list[str]], dict[str, list[str]]]:
    """The rows of the page's two tables, by scene: the largest differences, and the numbers of pixels."""
    tables: tuple[dict[str, list[str]], dict[str, list[str]]] = ({}, {})
    for name, *cells in re.findall(r"^\| `(\w+)` \|" + r" ([\d.]+) \|" * len(BACKENDS), PAGE.read_text("utf-8"), re.M):
        tables[0 if "." in cells[0] else 1][name] = cells
    return tables


def _row(name: str, cells: list[str]) -> str:
    return f"| `{name}` | {' | '.join(cells)} |"


def _entry(name: str, caption: str) -> list[str]:
    path = pictured(name).material
    material = load_material(path)
    return [
        f"## {material.title}",
        "",
        f"![{ALTERNATIVE_TEXTS[name]}](gallery/{name}.png)",
        "",
        *_paragraph(caption),
        *_paragraph(_command(name)),
        *(line for stage in dict.fromkeys(_techniques(material)) for line in _item(stage)),
        "",
        *_paragraph(f"Requires: {', '.join(describe(material.stages)) or 'any mesh'}."),
        *_paragraph(f"Cost: {_cost(path)}."),
    ]


def _command(name: str) -> str:
    """The command that draws the picture, and the one that draws the example's own scene."""
    plain = f"`sssgen render {name} -o {name}.png`"
    if name not in PICTURED:
        return plain
    file = f"examples/{name}/{PICTURED[name]}"
    return f"`sssgen render {file} -o {name}.png`; {plain} draws the material `{name}` on a plain body."


def _techniques(material: Material) -> Iterator[str]:
    """The techniques of a material, each with its source."""
    for stage in material.stages:
        yield f"`{stage.technique.name}` ({stage.technique.role}): {stage.technique.doc['source']}"


def _cost(material: str) -> str:
    """The cost of a fragment, and of each light in addition."""
    entries = sssgen.compile(material, "glsl-330").reflection["entries"].values()
    lights = {"L", "L_object", "light_color", "light_nearness"}
    parts = {
        "a fragment": [entry for entry in entries if not lights & {*entry["inputs"]}],
        "each light": [entry for entry in entries if lights & {*entry["inputs"]}],
    }
    return "; ".join(f"{when} {_sum(of)}" for when, of in parts.items() if of)


def _sum(entries: list[dict[str, Any]]) -> str:
    counts = {kind: sum(entry["cost"][kind] for entry in entries) for kind in entries[0]["cost"]}
    words = {"operations": "operation", "transcendentals": "transcendental", "fetches": "texture fetch"}
    words |= {"volume_fetches": "volume fetch", "distance_evaluations": "distance evaluation"}
    return ", ".join(_counted(count, words[kind]) for kind, count in counts.items() if count)


def _counted(count: int, word: str) -> str:
    ending = "" if count == 1 else "es" if word.endswith("ch") else "s"
    return f"{count:,} {word}{ending}"


def _paragraph(text: str) -> list[str]:
    return [*wrap(text, 120, break_on_hyphens=False, break_long_words=False), ""]


def _item(text: str) -> list[str]:
    return wrap(f"- {text}", 120, subsequent_indent="  ", break_on_hyphens=False, break_long_words=False)


def main() -> None:
    """Draws the pictures, measures the differences, and writes the page."""
    parser = argparse.ArgumentParser(description="draws the gallery")
    parser.add_argument("SCENE", nargs="*", help=f"{', '.join(CAPTIONS)}, loop (default: all)")
    add_workers(parser)
    arguments = parser.parse_args()
    chosen = arguments.SCENE or [*CAPTIONS, "loop"]
    if unknown := set(chosen) - {*CAPTIONS, "loop"}:
        parser.error(f"not in the gallery: {', '.join(sorted(unknown))}")
    names = [name for name in CAPTIONS if name in chosen]
    processes = arguments.processes if arguments.scheduler or arguments.processes else 0
    with ProgressBar() as progress:
        results = run(items(names), arguments.scheduler, processes, Store(""), progress)
    if failed := failures(results):
        raise SystemExit("\n".join(f"{failure.name}: {failure.message}" for failure in failed))
    count = len(names)
    pictures, small = (dict(zip(names, results[start : start + count], strict=True)) for start in (0, count))
    large = dict(zip([name for name in names if name not in MARCHED], results[2 * count :], strict=True))
    rows = stored_rows() if PAGE.exists() else ({}, {})
    rows[0].update({name: [f"{difference.worst:.3f}" for difference in small[name]] for name in names})
    rows[1].update(
        {name: [f"{difference.differing}" for difference in differences] for name, differences in large.items()}
    )
    files = {f"{name}.png": data for name, data in pictures.items()}
    if "loop" in chosen:
        files[gallery_loop.LOOP] = gallery_loop.drawn()
    write_files(str(PICTURES), files)
    PAGE.write_text(page([backends.get(name) for name in BACKENDS], *rows), encoding="utf-8")
    print(f"wrote {PAGE.name} and {len(files)} pictures, {sum(map(len, files.values())) / 1000:.0f} kB")


if __name__ == "__main__":
    main()
