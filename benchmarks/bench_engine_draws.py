"""Scenes of an engine, drawn by it in WebGL 2, and the same draws in WebGPU with the translated programs.

    python benchmarks/bench_engine_draws.py [SCENE...] [--engine three|babylon] [--pictures DIR]

A page records what the engine draws (`engine_draws/record.js`), `sssgen transpile --stages` translates the programs,
and the page draws it again in WebGPU with the loader (`engine_draws/replay.js`). Both pictures are made by one browser
on one CPU. For each scene: how many programs and draws it has, the largest difference of a pixel in steps of 1/255, the
share of pixels that differ by more than one step, and the mean difference.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.two_stages import Source, transpile_stages
from sssgen.run.backends.browser_page import START, WEBGL, WEBGPU, Page
from sssgen.run.machine_parts import all_lacks, chromium, node_modules
from sssgen.support.diagnostics import SssgenError
from sssgen.targets.javascript_runtime import FOLDER
from sssgen.targets.program_reflection import ROWS

HERE = Path(__file__).parent / "engine_draws"
ENGINES = {"three": "npm three", "babylon": "babylon bundle"}
"""Engine → what it needs."""
SECONDS = 120.0
RASTERISED = {"lines": 0.01}
"""Scene → the share of pixels that may differ: the browser's WebGL draws lines by another rule than its WebGPU."""


def open_page(engine: str = "three") -> tuple[Page, dict[str, Any]]:
    """The page, and its engine, its scenes and the size of its pictures."""
    modules = {
        "loader": Path(FOLDER) / "webgl_program.js",
        **{name: HERE / f"{name}.js" for name in ("record", "replay")},
    }
    script = (HERE / "page.js").read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as bundles:
        if engine == "three":
            build = node_modules() / "three" / "build"
            modules |= {"three": build / "three.module.js", "three core": build / "three.core.js"}
            modules["scenes"] = HERE / "three_scenes.js"
        else:
            modules["scenes"] = bundled(HERE / f"{engine}_scenes.js", Path(bundles))
        page = Page(chromium(), "swiftshader", script, (*WEBGPU, WEBGL[2]), modules)
        return page, page.receive(START)[0]


def bundled(file: Path, place: Path) -> Path:
    """A module and what it imports from npm's packages, as one file."""
    bundle = place / file.name
    command = [str(node_modules() / ".bin" / "esbuild"), str(file), "--bundle", "--format=esm", f"--outfile={bundle}"]
    environment = {**os.environ, "NODE_PATH": str(node_modules())}
    subprocess.run([*command, "--log-level=error"], env=environment, check=True)
    return bundle


def translated(programs: list[dict[str, str]], rows: str = ROWS[0]) -> list[dict[str, Any]]:
    """The programs in WGSL with their descriptions, as the loader takes them. Raises SssgenError."""
    results = []
    for number, program in enumerate(programs):
        loaded = [load_glsl_text(program[kind], f"{number}.{kind[:4]}") for kind in ("vertex", "fragment")]
        sources = [Source(each.module, each.head) for each in loaded]
        *texts, description = transpile_stages(*sources, "wgsl", f"program_{number}", rows=rows).files.values()
        results.append({"description": json.loads(description), "vertex": texts[0], "fragment": texts[1]})
    return results


def ask(page: Page, message: dict[str, Any]) -> tuple[dict[str, Any], bytes]:
    page.send(json.dumps(message), b"", SECONDS)
    answer, data = page.receive(SECONDS)
    return answer, data


def run(page: Page, scene: str, rows: str = ROWS[0]) -> tuple[dict[str, Any], Any, Any]:
    """The facts of a scene, and its pictures by WebGL and WebGPU, empty where they fail."""
    facts, original = ask(page, {"scene": scene})
    if "error" in facts:
        return facts, original, b""
    try:
        programs = translated(facts["programs"], rows)
    except SssgenError as error:
        return {**facts, "error": str(error)}, original, b""
    answer, copy = ask(page, {"programs": programs})
    return {**facts, "translated": programs, **answer}, original, copy


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("SCENE", nargs="*")
    parser.add_argument("--engine", choices=ENGINES, default="three")
    parser.add_argument("--pictures", metavar="DIR", help="write each pair of pictures, and their difference times 64")
    arguments = parser.parse_args()
    if lacking := all_lacks(["chromium", ENGINES[arguments.engine], "pip browser"]):
        print(f"not measured: {lacking}")
        return 0
    page, about = open_page(arguments.engine)
    print(f"{about['engine']}, {about['size'][0]} × {about['size'][1]} pixels; differences in steps of 1/255")
    print(f"{'scene':24} programs draws  largest  > 1 step     mean")
    width, height = about["size"]
    failed = 0
    for scene in arguments.SCENE or about["scenes"]:
        facts, *pictures = run(page, scene)
        complaints = facts.get("complaints", [])
        if "error" in facts or complaints:
            print(f"{scene:24} {facts.get('error', '')} {facts.get('stack', '')} {'; '.join(complaints)[:1500]}")
            failed += 1
        if not pictures[1]:
            continue
        first, second = (np.frombuffer(data, np.uint8).reshape(height, width, 4)[::-1] for data in pictures)
        difference = np.abs(first.astype(int) - second.astype(int)).max(axis=-1)
        failed += int(np.mean(difference > 1) > RASTERISED.get(scene, 0.0))
        print(
            f"{scene:24} {len(facts['programs']):8} {facts['draws']:5} {difference.max():8}"
            f" {np.mean(difference > 1):9.3%} {difference.mean():8.4f}"
        )
        if arguments.pictures:
            from PIL import Image

            place = Path(arguments.pictures)
            place.mkdir(parents=True, exist_ok=True)
            grey = np.repeat(np.minimum(255, difference * 64)[..., None], 3, axis=-1).astype(np.uint8)
            Image.fromarray(np.hstack([first[..., :3], second[..., :3], grey])).save(place / f"{scene}.png")
            for number, program in enumerate(facts["translated"]):
                for kind in ("vertex", "fragment"):
                    for suffix, text in (("wgsl", program[kind]), ("glsl", facts["programs"][number][kind])):
                        (place / f"{scene}.{number}.{kind}.{suffix}").write_text(text, encoding="utf-8")
    page.close()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
