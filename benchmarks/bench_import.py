"""Imports folders of assets and materials, and compares imported media with the definitions of their formats.

    python benchmarks/bench_import.py assets FOLDER [--pictures DIR] [--all]
    python benchmarks/bench_import.py files FOLDER [--pictures DIR] [--root DIR]
    python benchmarks/bench_import.py slabs

`assets`: for each asset its materials, the elements that were mapped, approximated and left out, and how many of its
materials compile (WGSL and GLSL, by the compilers of this machine). FOLDER is a checkout of KhronosGroup's
glTF-Sample-Assets, or another with an asset in each folder. `--all` takes assets without the extensions, too.
`--pictures` draws up to four materials of each asset into one sheet per asset. `files`: the same for all MaterialX
documents, Unity materials and diffusion profiles below a folder.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path

from sssgen.interchange import format_readers
from sssgen.interchange.gltf_container import open_file
from sssgen.interchange.gltf_materials import EXTENSIONS
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.material_writer import WrittenMaterial, write_import
from sssgen.run.check import compile_check, shader_files
from sssgen.support.diagnostics import SssgenError

READ_EXTENSIONS = {*EXTENSIONS, "KHR_texture_transform"}
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

    from sssgen.run import backends
    from sssgen.run.render.scene_render import render
    from sssgen.scene import scene_loading
    from sssgen.scene.pictures import images

    chosen = sorted(materials, key=lambda material: material.transmits, reverse=True)[:DRAWN]
    pictures = []
    for material in chosen:
        scene = scene_loading.load(str(Path(folder, material.scene)))
        small = dataclasses.replace(scene, size=(SIDE, SIDE), samples=1)
        pictures.append(render(small, backends.get("gl")).encoded[..., :3])
    images.write_png(sheet, np.concatenate(pictures, axis=1))


def files(folder: Path) -> Iterator[Path]:
    """The MaterialX documents, Unity materials and diffusion profiles below a folder."""
    for path in sorted(folder.rglob("*")):
        profile = path.suffix == ".asset" and b"scatteringDistance:" in path.read_bytes()
        if path.suffix in (".mtlx", ".mat") or profile:
            yield path


def run_imports(paths: Iterable[tuple[str, Path]], pictures: Path | None, root: str = "") -> None:
    """Prints the table of some files with their names."""
    print("| File | Materials | Mapped | Approximated | Left out | Compile |\n|---|---:|---:|---:|---:|---:|")
    totals, refused = [0, 0, 0, 0, 0], {}
    for name, path in paths:
        try:
            with tempfile.TemporaryDirectory() as output:
                report = Report(path.name)
                written = write_import(output, format_readers.read(str(path), report, top=root), report)
                row = [len(written), *report.counts().values(), compiled(written, output)]
                print(f"| {name} | {' | '.join(map(str, row))} |", flush=True)
                totals = [total + part for total, part in zip(totals, row, strict=True)]
                if pictures is not None:
                    pictures.mkdir(parents=True, exist_ok=True)
                    draw(written, output, pictures / f"{name.replace('/', '_')}.png")
        except SssgenError as error:
            refused[name] = error.diagnostics[0].message
            print(f"| {name} | {refused[name]} | | | | |", flush=True)
    print(f"| all | {' | '.join(map(str, totals))} |")
    print(f"{totals[-1]} of {totals[0]} materials compile for {', '.join(TARGETS)}; {len(refused)} files are refused.")


def chosen_assets(folder: Path, every: bool) -> Iterator[tuple[str, Path]]:
    """The assets of a folder that use the extensions."""
    for path in assets(folder):
        if every or not READ_EXTENSIONS.isdisjoint(used(path)):
            yield path.relative_to(folder).parts[0], path


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    kinds = parser.add_subparsers(dest="kind", required=True)
    of_assets = kinds.add_parser("assets")
    of_assets.add_argument("folder", type=Path)
    of_assets.add_argument("--pictures", type=Path)
    of_assets.add_argument("--all", action="store_true")
    of_files = kinds.add_parser("files")
    of_files.add_argument("folder", type=Path)
    of_files.add_argument("--pictures", type=Path)
    of_files.add_argument("--root", default="")
    kinds.add_parser("slabs")
    arguments = parser.parse_args()
    if arguments.kind == "assets":
        run_imports(chosen_assets(arguments.folder, arguments.all), arguments.pictures)
    elif arguments.kind == "files":
        named = ((str(path.relative_to(arguments.folder)), path) for path in files(arguments.folder))
        run_imports(named, arguments.pictures, arguments.root)
    else:
        from materialx_slabs import run_materialx  # beside this file
        from slab_check import run_slabs

        print(json.dumps({"glTF": run_slabs(), "MaterialX": run_materialx()}, indent=2))


if __name__ == "__main__":
    main()
