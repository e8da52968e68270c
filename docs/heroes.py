"""Draws hero pictures: docs/heroes/NAME.webp by the emitted shader in three.js, NAME_traced.webp path traced, and docs/heroes.md.

python docs/heroes.py [NAME...] [--draft] [--frames N] [--samples N] [--only draw|trace]: minutes for each. Pictures in linear light
are kept in build/heroes/NAME, so that what was drawn is not drawn again.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from hero_stage import hero as hero_files
from hero_stage.developed import develop
from hero_stage.drawn import draw
from hero_stage.prepare import prepare
from hero_stage.traced import trace


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("names", nargs="*", metavar="NAME")
    options.add_argument("--draft", action="store_true", help="a quarter of the pixels and few frames, in the build folder alone")
    options.add_argument("--frames", type=int)
    options.add_argument("--samples", type=int)
    options.add_argument("--only", choices=("prepare", "draw", "trace"))
    arguments = options.parse_args()
    size = (960, 540) if arguments.draft else (1920, 1080)
    for name in arguments.names or hero_files.heroes():
        hero = hero_files.load(name)
        prepared = prepare(hero)
        steps = {"draw": lambda: draw(prepared, size, arguments.frames or (10 if arguments.draft else 96))}
        if hero.traced:
            steps["trace"] = lambda: trace(prepared, size, arguments.samples or (32 if arguments.draft else 256))
        for step, run in steps.items():
            if arguments.only not in (None, step):
                continue
            start = time.monotonic()
            linear = run()
            suffix = f"{step}{'_draft' if arguments.draft else ''}"
            np.save(prepared.folder / f"{suffix}.npy", linear)
            develop(linear, hero.camera).save(prepared.folder / f"{suffix}.png")
            print(f"{name}: {step} {time.monotonic() - start:.0f} s", flush=True)


if __name__ == "__main__":
    main()
