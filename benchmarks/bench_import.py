"""Imports a folder of glTF assets, and compares imported media with the definitions of their extensions.

    python benchmarks/bench_import.py assets FOLDER [--pictures DIR] [--all]
    python benchmarks/bench_import.py slabs

`assets`: for each asset its materials, the elements that were mapped, approximated and left out, and how many of its
materials compile (WGSL and GLSL, by the compilers of this machine). FOLDER is a checkout of KhronosGroup's
glTF-Sample-Assets, or another with an asset in each folder. `--all` takes assets without the extensions, too.
`--pictures` draws up to four materials of each asset into one sheet per asset.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from collections.abc import Iterator
from pathlib import Path

from sssgen.harness.check import compile_check, shader_files
from sssgen.interchange import format_readers
from sssgen.interchange.gltf_container import open_file
from sssgen.interchange.gltf_materials import READ
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.material_writer import WrittenMaterial, write_import
from sssgen.support.diagnostics import SssgenError

EXTENSIONS = {*READ, "KHR_texture_transform"}
TARGETS = ("wgsl", "glsl-330")
DRAWN = 4
"""Materials of an asset that are drawn."""
SIDE = 200


def assets(folder: Path) -> Iterator[Path]:
    """One file of each asset: binary before text."""
    for place in sorted(path for path in folder.iterdir() if path.is_dir()):
        for pattern in ("glTF-Binary/*.glb", "*.glb", "glTF/*.gltf", "*.gltf", "*/*.gltf"):
            if files := sorted(place.glob(pattern)):
                yield files[0]
                break


def used(path: Path) -> set[str]:
    """The extensions that a file names."""
    return {str(element.value) for element in open_file(str(path)).root.items("extensionsUsed")}


def compiled(materials: list[WrittenMaterial], folder: str) -> int:
    """How many materials are emitted and accepted by every compiler that is installed."""
    accepted = 0
    for material in materials:
        try:
            shaders = shader_files.of_material(str(Path(folder, material.material)), TARGETS)
            accepted += all(result.ok for result in compile_check.run(shaders).results)
        except SssgenError as error:
            print(error)
    return accepted


def draw(materials: list[WrittenMaterial], folder: str, sheet: Path) -> None:
    """A sheet with pictures of the materials that transmit light, or else of the first ones."""
    import dataclasses

    import numpy as np

    from sssgen.harness import backends
    from sssgen.harness.pictures import images
    from sssgen.harness.render.scene_render import render
    from sssgen.harness.scenes import scene_loading

    def transmits(material: WrittenMaterial) -> bool:
        return "[[translucency]]" in Path(folder, material.material).read_text(encoding="utf-8")

    chosen = sorted(materials, key=transmits, reverse=True)[:DRAWN]
    pictures = []
    for material in chosen:
        scene = scene_loading.load(str(Path(folder, material.scene)))
        small = dataclasses.replace(scene, size=(SIDE, SIDE), samples=1)
        pictures.append(render(small, backends.get("gl")).encoded[..., :3])
    images.write_png(sheet, np.concatenate(pictures, axis=1))


def run_assets(folder: Path, pictures: Path | None, every: bool) -> None:
    """Prints the table of a folder of assets."""
    print("| Asset | Materials | Mapped | Approximated | Left out | Compile |\n|---|---:|---:|---:|---:|---:|")
    totals, refused = [0, 0, 0, 0, 0], {}
    for path in assets(folder):
        name = path.relative_to(folder).parts[0]
        try:
            if not every and EXTENSIONS.isdisjoint(used(path)):
                continue
            with tempfile.TemporaryDirectory() as output:
                report = Report(path.name)
                written = write_import(output, format_readers.read(str(path), report), report)
                row = [len(written), *report.counts().values(), compiled(written, output)]
                print(f"| {name} | {' | '.join(map(str, row))} |", flush=True)
                totals = [total + part for total, part in zip(totals, row, strict=True)]
                if pictures is not None:
                    pictures.mkdir(parents=True, exist_ok=True)
                    draw(written, output, pictures / f"{name}.png")
        except SssgenError as error:
            refused[name] = error.diagnostics[0].message
            print(f"| {name} | {refused[name]} | | | | |", flush=True)
    print(f"| all | {' | '.join(map(str, totals))} |")
    print(f"{totals[-1]} of {totals[0]} materials compile for {', '.join(TARGETS)}; {len(refused)} assets are refused.")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    kinds = parser.add_subparsers(dest="kind", required=True)
    of_assets = kinds.add_parser("assets")
    of_assets.add_argument("folder", type=Path)
    of_assets.add_argument("--pictures", type=Path)
    of_assets.add_argument("--all", action="store_true")
    kinds.add_parser("slabs")
    arguments = parser.parse_args()
    if arguments.kind == "assets":
        run_assets(arguments.folder, arguments.pictures, arguments.all)
    else:
        from slab_check import run_slabs  # beside this file

        print(json.dumps(run_slabs(), indent=2))


if __name__ == "__main__":
    main()
