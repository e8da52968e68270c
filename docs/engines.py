"""Draws one material in every engine that runs here into docs/engines/side_by_side.png: python docs/engines.py

The material and the scene are in docs/engines/side_by_side. A back end that this machine lacks has no picture, and the
table of docs/engines.md says so.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
from PIL import Image, ImageDraw

import sssgen
from sssgen.run import backends
from sssgen.run.backends import BACKENDS, Array, Bound, CompilerMissing, Drawing, DrawingBackend, Place, Stage, Text
from sssgen.run.compilers.shadertoy_page import program
from sssgen.run.evaluate.evaluation import default_texture
from sssgen.run.render.scene_render import render
from sssgen.scene import scene_loading
from sssgen.scene.pictures.images import decode_srgb, encode_srgb
from sssgen.support.file_writer import write_files

FOLDER = Path(__file__).with_name("engines") / "side_by_side"
PICTURE = FOLDER.with_suffix(".png")
PAGE = Path(__file__).with_name("engines.md")
START, END = "<!-- side by side: python docs/engines.py -->", "<!-- end -->"
TITLES = {
    "numpy": "NumPy, the reference", "gl": "GLSL 3.30", "gl-es": "GLSL ES 3.00", "webgpu": "WGSL, naga in wgpu",
    "browser": "WGSL, Tint in Chromium", "firefox": "WGSL, naga in Firefox", "hlsl": "HLSL, DXC",
    "hlsl-glslang": "HLSL, glslang", "unity": "Unity, built-in pipeline", "unity-urp": "Unity, URP",
    "metal": "Metal, g++", "shadertoy": "Shadertoy, Mesa",
}  # fmt: skip
"""The titles of those with a light of this project; an engine's is that of its record."""
STANDS_IN = {
    "unity": "stand-in for Unity's headers", "unity-urp": "stand-in for Unity's headers",
    "metal": "stand-in for Metal's library",
}  # fmt: skip
COLUMNS, EDGE, LINE = 5, 4, 13
PAPER, INK = (255, 255, 255), (30, 30, 30)


class Tile(NamedTuple):
    """One picture."""

    title: str
    light: str
    """Whose light it is."""
    picture: Array | None
    """(height, width, 3), sRGB from 0 to 1; None: nothing was run."""
    difference: float = 0.0
    """To the reference: that of 99 % of the pixels where the light is ours, else the mean difference."""


def main() -> int:
    """Draws the tiles, and writes the picture and the table."""
    drawn = list(tiles())
    pictures = [tile for tile in drawn if tile.picture is not None]
    write_files(str(PICTURE.parent), {PICTURE.name: _png(_sheet(pictures))})
    head, _, rest = PAGE.read_text(encoding="utf-8").partition(START)
    rows = "\n".join(map(_row, drawn))
    table = f"{START}\n| Picture | Light | Difference to the reference |\n|---|---|---|\n{rows}\n{END}"
    PAGE.write_text(f"{head}{table}{rest.partition(END)[2]}", encoding="utf-8")
    print(f"wrote {PICTURE} with {len(pictures)} of {len(drawn)} pictures")
    return 0


def tiles() -> Iterator[Tile]:
    """The reference first, then those with our light, then the engines with their own."""
    scene = scene_loading.load(str(FOLDER / "scene.toml"))
    reference = render(scene, backends.get("numpy")).encoded
    for name, record in BACKENDS.items():
        if name not in TITLES and not record.scenes_only:
            continue
        title = TITLES.get(name) or record.description.removesuffix(", in a headless Chromium")
        light = "the engine's" if record.scenes_only else f"ours{', ' if name in STANDS_IN else ''}"
        light += STANDS_IN.get(name, "")
        print(title, file=sys.stderr, flush=True)
        try:
            picture = reference if name == "numpy" else render(scene, backends.get(name)).encoded
        except CompilerMissing:
            yield Tile(title, light, None)
            continue
        yield _compared(title, light, picture, reference, record.scenes_only)
    yield _compared(TITLES["shadertoy"], "ours", _shadertoy(scene.size, scene.samples), reference, False)


def _compared(title: str, light: str, picture: Array, reference: Array, mean: bool) -> Tile:
    shown, expected = (np.clip(one, 0.0, 1.0) for one in (picture, reference))
    difference = np.abs(shown - expected).max(axis=-1)
    return Tile(title, light, shown, float(difference.mean() if mean else np.quantile(difference, 0.99)))


def _shadertoy(size: tuple[int, int], samples: int) -> Array:
    """The picture of Shadertoy's file in OpenGL, without its shell's ambient light."""
    compiled = sssgen.compile(str(FOLDER / "wax.toml"), "shadertoy")
    text, count = re.subn(r"(AMBIENT\w* = )vec3\([^)]*\)", r"\1vec3(0.0)", next(iter(compiled.files.values())))
    assert count == 1, "the shell of Shadertoy names its ambient light otherwise"
    width, height = size[0] * samples, size[1] * samples
    corner = (
        "#version 300 es\nvoid main() { gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0, 1); }"
    )
    values: Mapping[str, Array] = {
        "iResolution": np.array([width, height, 1.0]), "iTime": np.array(0.0), "iMouse": np.zeros(4),
    }  # fmt: skip
    gl = backends.get("gl")
    assert isinstance(gl, DrawingBackend)
    textures = {
        f"iChannel{index}": Bound(default_texture(entry["type"], entry["default"]), Place(0, 0))
        for index, entry in enumerate(compiled.reflection["textures"])
    }
    stages = Stage(Text(program(text))), Stage(Text(corner))
    drawing = Drawing((width, height), *stages, floats=True, values=values, textures=textures)
    light = decode_srgb(gl.draw(drawing)[::-1, :, :3].astype(np.float64))
    return encode_srgb(light.reshape(size[1], samples, size[0], samples, 3).mean(axis=(1, 3)))


def _sheet(drawn: list[Tile]) -> Image.Image:
    height, width = drawn[0].picture.shape[:2] if drawn[0].picture is not None else (0, 0)
    rows = -(-len(drawn) // COLUMNS)
    across, down = width + EDGE, height + 2 * LINE + EDGE
    sheet = Image.new("RGB", (COLUMNS * across + EDGE, rows * down + EDGE), PAPER)
    draw = ImageDraw.Draw(sheet)
    for index, tile in enumerate(drawn):
        assert tile.picture is not None
        left, top = EDGE + index % COLUMNS * across, EDGE + index // COLUMNS * down
        pixels = np.rint(255.0 * tile.picture).astype(np.uint8)
        sheet.paste(Image.fromarray(pixels), (left, top))
        draw.text((left, top + height), tile.title, INK)
        draw.text((left, top + height + LINE - 2), f"light: {tile.light}", INK)
    return sheet


def _png(sheet: Image.Image) -> bytes:
    from io import BytesIO

    buffer = BytesIO()
    sheet.save(buffer, "PNG", optimize=True)
    return buffer.getvalue()


def _row(tile: Tile) -> str:
    if tile.picture is None:
        return f"| {tile.title} | {tile.light} | not run: missing on the machine that drew the picture |"
    kind = "on average" if tile.light == "the engine's" else "at most, on 99 % of the pixels"
    value = "–" if tile.title.endswith("the reference") else f"{255.0 * tile.difference:.2g}/255 {kind}"
    return f"| {tile.title} | {tile.light} | {value} |"


if __name__ == "__main__":
    sys.exit(main())
