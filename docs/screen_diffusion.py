"""Draws a head of skin without and with light that spreads on the screen: python docs/screen_diffusion.py.

The picture is docs/screen_diffusion/picture.png, for docs/materials.md.
"""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np

from sssgen.run import backends
from sssgen.run.render.scene_render import render
from sssgen.scene import scene_loading
from sssgen.scene.pictures.images import write_png

FOLDER = Path(__file__).parent / "screen_diffusion"
MATERIALS = ("matt.toml", "spread.toml")


def main() -> None:
    scene = scene_loading.load(str(FOLDER / "scene.toml"))
    backend = backends.require("gl")
    pictures = [
        render(dataclasses.replace(scene, material=str(FOLDER / material)), backend).encoded for material in MATERIALS
    ]
    write_png(FOLDER / "picture.png", np.concatenate(pictures, axis=1))


if __name__ == "__main__":
    main()
