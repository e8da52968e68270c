"""Draws hero pictures, by the emitted shaders in three.js and path traced, into docs/heroes, and docs/heroes.md.

python docs/heroes.py [NAME...] [--only STEP] [--frames N] [--samples N] [--size W] [--traced-size W]: many minutes for
each on two cores. Light is kept in build/heroes/NAME: a larger number of samples continues what was traced.
"""

from __future__ import annotations

import argparse
import time

import numpy as np
from hero_stage import hero as hero_files
from hero_stage.developed import develop
from hero_stage.document import publish, publish_loop, write_document
from hero_stage.drawn import draw, draw_loop
from hero_stage.prepare import prepare
from hero_stage.traced import trace

STEPS = ("prepare", "draw", "trace", "publish")
LOOP = 16, (854, 480)
"""The pictures of a loop, and their size in pixels."""


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("names", nargs="*", metavar="NAME", help="heroes (default: all)")
    options.add_argument("--only", choices=(*STEPS, "loop"), help="one step (default: all but the loop)")
    options.add_argument("--frames", type=int, default=64, help="of a picture by three.js")
    options.add_argument("--samples", type=int, default=128, help="paths of a pixel")
    options.add_argument("--size", type=int, default=1920, help="the width in pixels")
    options.add_argument("--traced-size", type=int, default=960, help="the same of the path traced picture")
    arguments = options.parse_args()
    steps = [arguments.only] if arguments.only else STEPS
    for name in arguments.names or hero_files.heroes():
        hero = hero_files.load(name)
        if arguments.only != "publish":
            prepared = prepare(hero)
        if "draw" in steps:
            _keep(hero, "draw", lambda prepared=prepared: draw(prepared, _size(arguments.size), arguments.frames))
        if "trace" in steps and hero.traced:
            _keep(
                hero,
                "trace",
                lambda prepared=prepared: trace(prepared, _size(arguments.traced_size), arguments.samples),
            )
        if "loop" in steps:
            publish_loop(hero, draw_loop(prepared, LOOP[1], arguments.frames, LOOP[0]))
        if "publish" in steps:
            publish(hero)
    if "publish" in steps:
        write_document()


def _size(width: int) -> tuple[int, int]:
    return width, width * 9 // 16


def _keep(hero: hero_files.Hero, step: str, run: object) -> None:
    """Stores the light of a step, and a PNG to look at."""
    from hero_stage.assets import BUILD

    start = time.monotonic()
    linear = run()
    np.save(BUILD / hero.name / f"{step}.npy", linear.astype(np.float32))
    develop(linear, hero.camera).save(BUILD / hero.name / f"{step}.png")
    print(f"{hero.name}: {step}, {time.monotonic() - start:.0f} s", flush=True)


if __name__ == "__main__":
    main()
