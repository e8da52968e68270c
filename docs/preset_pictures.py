"""Draws every preset on the mouse of the examples, as `sssgen use` writes its page of three.js: docs/presets/*.png, and
of these the small pictures in the package, for menus.

Chromium draws the pages without a GPU; all take some minutes. The projects of other engines are not drawn here.
"""

from __future__ import annotations

import argparse
import contextlib
import tempfile
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from sssgen.cli.main import main as sssgen
from sssgen.presets.preset import presets
from sssgen.presets.preset_list import SHEET
from sssgen.run.machine_parts import chromium
from sssgen.scene.geometry_mesh import mesh_of
from sssgen.scene.measured import measured_scene
from sssgen.support.folder_server import served

PICTURES = Path(__file__).parent / "presets"
SIZE, SHOWN = (640, 480), (400, 300)
"""Of the page, and of a picture in the documents, in pixels."""
COLUMNS = 4
SIDE = 88
"""Of a small picture, in pixels."""
SWITCHES = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


def write_mouse(path: Path) -> None:
    """The mouse as an .obj file."""
    vertices, faces = mesh_of(measured_scene.load("mouse").geometry)
    lines = [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in vertices]
    lines += ["f {} {} {}".format(*face) for face in np.asarray(faces) + 1]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def shot(browser: Any, folder: Path) -> Image.Image:
    """The page of a folder, without its panel. Raises RuntimeError where the page has a message."""
    page = browser.new_page(viewport={"width": SIZE[0], "height": SIZE[1]})
    page.set_default_timeout(120_000)
    with contextlib.closing(page), served(str(folder)) as address:
        page.goto(address)
        page.wait_for_function("document.querySelector('#panel') || document.querySelector('#message').textContent")
        page.wait_for_timeout(4000)
        if message := page.inner_text("#message"):
            raise RuntimeError(f"{folder.name}: {message}")
        page.evaluate("document.querySelector('#panel').remove()")
        return Image.open(BytesIO(page.screenshot())).convert("RGB")


def write_thumbnails() -> None:
    """The mouse of each picture as a square, in a row."""
    names = list(presets())
    sheet = Image.new("RGB", (SIDE * len(names), SIDE))
    for index, name in enumerate(names):
        picture = Image.open(PICTURES / f"{name}.png").convert("RGB")
        x, y, half = 0.5 * picture.width, 0.52 * picture.height, 0.38 * picture.height
        square = picture.crop((round(x - half), round(y - half), round(x + half), round(y + half)))
        sheet.paste(square.resize((SIDE, SIDE), Image.Resampling.LANCZOS), (SIDE * index, 0))
    sheet.save(SHEET, quality=85, optimize=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("NAME", nargs="*", help="presets (default: all, and the sheet of all)")
    parser.add_argument("--quality", default="good", choices=("fast", "good", "best"))
    arguments = parser.parse_args()
    names = arguments.NAME or list(presets())
    from playwright.sync_api import sync_playwright

    PICTURES.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as driver:
        write_mouse(Path(folder, "mouse.obj"))
        browser = driver.chromium.launch(executable_path=chromium(), args=SWITCHES)
        for name in names:
            output = Path(folder, name)
            command = ["use", name, f"{folder}/mouse.obj", "-o", str(output), "--quality", arguments.quality, "--json"]
            if sssgen(command):
                raise SystemExit(f"{name} was not written")
            shot(browser, output).resize(SHOWN, Image.Resampling.LANCZOS).save(PICTURES / f"{name}.png", optimize=True)
    if not arguments.NAME:
        sheet = Image.new("RGB", (COLUMNS * SHOWN[0], -(-len(names) // COLUMNS) * SHOWN[1]))
        for index, name in enumerate(names):
            place = index % COLUMNS * SHOWN[0], index // COLUMNS * SHOWN[1]
            sheet.paste(Image.open(PICTURES / f"{name}.png"), place)
        sheet.save(PICTURES / "all.png", optimize=True)
    write_thumbnails()


if __name__ == "__main__":
    main()
