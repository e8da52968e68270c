"""`sssgen export-gltf`: a material as glTF, with Khronos' extensions."""

from __future__ import annotations

import os
from argparse import ArgumentParser, Namespace

from sssgen.cli.options import add_output, nonempty
from sssgen.cli.output import OK, print_result
from sssgen.material.material_loading import load_material
from sssgen.support.diagnostics import failure
from sssgen.support.file_writer import write_files
from sssgen.support.paths import posix


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n"
        "  sssgen export-gltf paper_lantern -o lantern.glb\n"
        "  sssgen export-gltf amber/amber.toml --mesh bead.obj -o bead.gltf\n"
        "What is mapped to what: docs/import.md."
    )
    add = parser.add_argument
    add("MATERIAL", help="an example's name, or a material file")
    add("--mesh", type=nonempty, metavar="FILE", help="the mesh; by default that of the scene beside the material")
    add_output(parser, "FILE", "a .glb, or a .gltf with pictures beside it", required=True)


def run(arguments: Namespace) -> int:
    """Writes the glTF file, and prints what became of the material's parameters."""
    from sssgen.interchange.gltf_container import SUFFIXES
    from sssgen.interchange.gltf_writer import export
    from sssgen.interchange.mapping_report import Report
    from sssgen.scene import mesh_files
    from sssgen.scene.mesh import check_content
    from sssgen.scene.preview_scene import mesh_beside

    path = arguments.output
    if os.path.splitext(path)[1].lower() not in SUFFIXES:
        raise failure("a glTF file is written", f"end the name in {' or '.join(SUFFIXES)}", posix(path))
    material = load_material(arguments.MATERIAL)
    mesh = arguments.mesh or mesh_beside(material)
    report = Report(material.name)
    content = mesh_files.read(mesh) if mesh else None
    if content is not None:
        check_content(content, posix(mesh))
    if (
        content is not None
        and content.uv is None
        and (reading := [use.technique.name for use in material.stages if use.textures])
    ):
        reason = f"the mesh has none, and {', '.join(reading)} reads a picture: unwrap the mesh"
        report.add_omission("texture coordinates", None, reason)
    files = export(material, content, path, report)
    written = write_files(os.path.dirname(path) or ".", files)
    paths = [posix(file.path) for file in written]
    lines = [f"wrote {path}" for path in paths]
    if not mesh:
        lines.append("the file has the material alone: there is no mesh beside it; name one with --mesh")
    losses = [row for row in report.rows if row.outcome != "mapped"]
    lines += [report.summary(), *(f"  {row.outcome}: {row.element}: {row.error or row.became}" for row in losses)]
    facts = {"files": paths, "mesh": posix(mesh) if mesh else None, "report": report.as_json()}
    print_result(arguments.json, facts, "\n".join(lines))
    return OK
