"""`sssgen import`: materials of other formats as materials of sssgen, with textures, mesh, scene and a report."""

from __future__ import annotations

import os
import shlex
from argparse import ArgumentParser, Namespace

from sssgen.cli.options import add_output, nonempty
from sssgen.cli.output import OK, print_result
from sssgen.support.file_writer import check_folder
from sssgen.support.paths import posix
from sssgen.support.progress import ProgressBar


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n"
        "  sssgen import lantern.glb -o lantern\n"
        "  sssgen import lantern.glb -o lantern --material paper --bake --force\n"
        "  sssgen import library/soap/soap.mtlx -o soap --root library\n"
        "  sssgen import Assets/Materials/Skin.mat -o skin\n"
        "For each material: NAME/NAME.toml, its textures, mesh and scene. For the file: report.md and report.json.\n"
        "What is mapped to what: docs/import.md."
    )
    add = parser.add_argument
    add("FILE", help="a .gltf, .glb, .mtlx (MaterialX), .mat or .asset (Unity) file")
    add_output(parser, "DIR", "the folder to write to", required=True)
    add("--material", metavar="NAME", default="", help="import this material alone, by its name or number in the file")
    add(
        "--root", type=nonempty, metavar="DIR",
        help="the folder with all files of the material (default: that of FILE or, for Unity, the project)",
    )  # fmt: skip
    add(
        "--bake",
        action="store_true",
        help="compute the mesh's own thickness where the file has a constant or none: a texture of 256 texels a side",
    )
    add("--force", action="store_true", help="replace files of materials that were there before, also edited ones")


def run(arguments: Namespace) -> int:
    """Reads the file, writes its materials, and prints what became of its elements."""
    from sssgen.interchange import format_readers
    from sssgen.interchange.mapping_report import Report
    from sssgen.interchange.material_writer import WHOLE_SCENE, write_import
    from sssgen.interchange.thickness_bake import OPTION as BAKE_OPTION
    from sssgen.interchange.thickness_bake import bake_materials

    path = arguments.FILE
    check_folder(arguments.output)
    report = Report(os.path.basename(path))
    with ProgressBar() as bar:
        bar(0, 1, f"reading {report.source}")
        imports = format_readers.read(path, report, arguments.material, arguments.root or "")
        if arguments.bake:
            imports = bake_materials(imports, report, bar)
        view = format_readers.read_view(path, report, arguments.root or "")
        written = write_import(arguments.output, imports, report, view, force=arguments.force, progress=bar)
    folder = posix(arguments.output)
    materials = [
        {"name": part.name, "material": f"{folder}/{part.material}", "scene": f"{folder}/{part.scene}"}
        for part in written
    ]
    first = next((part for part in written if part.transmits), written[0])
    scene = shlex.quote(f"{folder}/{first.scene}")
    has_mesh = any(part.mesh is not None for part in imports)
    drawn = shlex.quote(f"{folder}/{WHOLE_SCENE}") if has_mesh else scene
    picture = os.path.splitext(report.source)[0] if has_mesh else first.name
    no_effect = [row for row in report.rows if row.value == BAKE_OPTION]
    lines = [
        *(f"wrote {part['material']} and its scene" for part in materials),
        *(f"{BAKE_OPTION} has no effect on {row.element}: {row.became}" for row in no_effect),
        f"{report.summary()}: {folder}/report.md",
        f"draw it: sssgen render {drawn} -o {shlex.quote(picture)}.png",
        f"change it: sssgen preview {scene}",
    ]
    print_result(arguments.json, {"materials": materials, "report": report.as_json()}, "\n".join(lines))
    return OK
