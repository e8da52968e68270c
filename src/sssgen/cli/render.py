"""`sssgen render`: the picture of a scene or a material, or how two pictures differ."""

from __future__ import annotations

import os
import re
import tempfile
from argparse import ArgumentParser, Namespace
from collections.abc import Sequence
from time import perf_counter
from typing import TYPE_CHECKING

from sssgen.cli.options import add_guards, add_output
from sssgen.cli.output import CHECK_FAILED, OK, print_result, print_warnings, report_errors
from sssgen.ir.spans import Span
from sssgen.run.backend_registry import PREFERRED, SCENES
from sssgen.support.diagnostics import Diagnostic, SssgenError, failure
from sssgen.support.file_writer import check_file
from sssgen.support.paths import posix
from sssgen.support.progress import ProgressBar

if TYPE_CHECKING:
    from sssgen.scene.scene import Scene


_GLTF = (".glb", ".gltf")


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n"
        "  sssgen render scenes/lantern.toml -o lantern.png\n"
        "  sssgen render wax.toml -o wax.png\n"
        "  sssgen render paper_lantern --size 1280x960 --samples 3 -o large.png\n"
        "  sssgen render --compare lantern.png golden.png -o difference.png\n"
        "  sssgen render lamp.glb -o lamp.png\n"
        "A material is drawn in the scene.toml beside it, or as a ball lit from behind;\n"
        "a glTF file as sssgen import reads it."
    )
    add = parser.add_argument
    add("SCENE", nargs="?", help="the .toml file of a scene or a material, an example, or a glTF file")
    add_output(parser, "FILE", "a .png or .exr file (default: SCENE's name with .png)")
    add("--backend", "-b", metavar="NAME", default=PREFERRED, help=f"{', '.join(SCENES)} (default: {PREFERRED})")
    add_guards(parser)
    add("--size", metavar="WxH", help="the size in pixels (default: the scene's size)")
    add("--samples", type=int, metavar="N", help="draw N × N samples per pixel (default: the scene's samples)")
    add("--time", type=float, metavar="T", help="the time in seconds (default: the scene's time)")
    add(
        "--compare",
        nargs=2,
        metavar=("A", "B"),
        help="print FLIP, relMSE, p99 and maximum of the difference of A and B",
    )


def run(arguments: Namespace) -> int:
    """Renders a scene, or compares two pictures."""
    if arguments.compare:
        return _compare(arguments)
    if not arguments.SCENE:
        raise failure("a scene is missing", "sssgen render scene.toml -o picture.png")
    return _render(arguments)


def _render(arguments: Namespace) -> int:
    from sssgen.run import backends
    from sssgen.scene.preview_scene import scene_of
    from sssgen.scene.scene_keys import MAX_SAMPLES
    from sssgen.scene.scene_loading import load

    size = _size(arguments.size) if arguments.size else None
    name, *more = backends.backend_names(arguments.backend, scenes=True)
    if more:
        raise failure(f"{arguments.backend} are several back ends", "name one")
    if arguments.time is not None and not abs(arguments.time) < 1e9:
        raise failure(f"--time {arguments.time:g} is not a time", "seconds, less than 1e9")
    if arguments.samples is not None and not 1 <= arguments.samples <= MAX_SAMPLES:
        raise failure(f"--samples {arguments.samples} is not a number of samples", f"from 1 to {MAX_SAMPLES}")
    if arguments.SCENE.lower().endswith(_GLTF):
        with tempfile.TemporaryDirectory() as folder:
            try:
                path, left_out = _imported(arguments.SCENE, folder)
                return _draw(arguments, load(path), name, size, folder, left_out)
            except SssgenError as error:
                raise SssgenError(_at_source(error.diagnostics, folder, arguments.SCENE)) from None
    return _draw(arguments, scene_of(arguments.SCENE), name, size)


def _imported(path: str, folder: str) -> tuple[str, list[Diagnostic]]:
    """The scene of a glTF file, written to a folder, and warnings of the pictures that are left out."""
    from sssgen.interchange import format_readers
    from sssgen.interchange.mapping_report import Report
    from sssgen.interchange.material_writer import WHOLE_SCENE, write_import

    report = Report(os.path.basename(path))
    with ProgressBar() as bar:
        bar(0, 1, f"reading {report.source}")
        materials = format_readers.read(path, report)
        if not any(part.mesh is not None for part in materials):
            raise failure("the file has no triangles to draw", "sssgen import writes its materials", posix(path))
        write_import(folder, materials, report, format_readers.read_view(path, report), progress=bar)
    left_out = [
        Diagnostic("warning", f"left out: {row.element}: {row.became}", Span(posix(path), 0, 0, 0, 0))
        for row in report.rows
        if row.outcome == "left out" and row.element.endswith("Texture")
    ]
    return os.path.join(folder, WHOLE_SCENE), left_out


def _at_source(diagnostics: Sequence[Diagnostic], folder: str, path: str) -> list[Diagnostic]:
    """The diagnostics, where those of files that were written to `folder` are of the file that they were made of."""
    place = Span(posix(path), 0, 0, 0, 0)
    return [
        part._replace(span=place, source_line="") if folder and part.span.file.startswith(posix(folder)) else part
        for part in diagnostics
    ]


def _draw(
    arguments: Namespace, scene: Scene, name: str, size: tuple[int, int] | None, folder: str = "",
    left_out: Sequence[Diagnostic] = (),
) -> int:  # fmt: skip
    """Draws a scene; it is in `folder` where it was made of another file, of which `left_out` warns."""
    from sssgen.run import backends
    from sssgen.run.render.missing_textures import MissingTextures
    from sssgen.run.render.scene_render import render, with_samples
    from sssgen.scene.pictures import images

    scene = with_samples(scene, arguments.samples or scene.samples)
    output = arguments.output or f"{os.path.splitext(os.path.basename(arguments.SCENE))[0]}.png"
    if images.check_suffix(output) == ".npy":
        raise failure("a picture is written as .png or .exr", "", output)
    check_file(output)
    backend = backends.require(name)
    start = perf_counter()
    try:
        with ProgressBar() as progress:
            picture = render(scene, backend, size, arguments.time, arguments.guards, progress)
    except MissingTextures as error:
        report_errors(_at_source(error.diagnostics, folder, arguments.SCENE), arguments.json)
        return CHECK_FAILED
    seconds = perf_counter() - start
    warnings = [*left_out, *_at_source(picture.warnings, folder, arguments.SCENE)]
    print_warnings(warnings)
    write = {
        ".png": lambda: images.write_png(output, picture.encoded),
        ".exr": lambda: images.write_exr(output, picture.linear),
    }
    write[images.check_suffix(output)]()
    height, width = picture.linear.shape[:2]
    facts = {"file": output, "size": [width, height], "backend": backend.name, "device": backend.device()}
    text = f"wrote {output}: {width} × {height} on {backend.name} ({backend.device()}) in {seconds:.2f} s"
    diagnostics = [warning.as_json() for warning in warnings]
    print_result(arguments.json, {**facts, "seconds": round(seconds, 3), "diagnostics": diagnostics}, text)
    return OK


def _size(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"(\d{1,5})[x×](\d{1,5})", text)
    if not match or not all(1 <= int(side) <= 8192 for side in match.groups()):
        raise failure(f"'{text}' is not a size", "WIDTHxHEIGHT in pixels, as in 640x480, each from 1 to 8192")
    return int(match[1]), int(match[2])


def _compare(arguments: Namespace) -> int:
    from sssgen.scene.pictures import images
    from sssgen.scene.pictures.picture_difference import compare

    if arguments.SCENE:
        raise failure(
            "--compare takes two pictures and no scene", "sssgen render --compare a.png b.png -o difference.png"
        )
    a, b = map(images.encoded, arguments.compare)
    difference = compare(a, b)
    if arguments.output:
        images.write_png(arguments.output, difference.picture)
    facts = {"flip": difference.flip, "relmse": difference.relmse, "p99": difference.p99, "max": difference.max}
    lines = [
        f"FLIP   {difference.flip:.6f}  (mean; 0 is the same)",
        f"relMSE {difference.relmse:.3e}",
        f"p99    {difference.p99:.3f}/255",
        f"max    {difference.max:.3f}/255",
        *([f"wrote {arguments.output}: FLIP's map"] if arguments.output else []),
    ]
    print_result(arguments.json, facts, "\n".join(lines))
    return OK
