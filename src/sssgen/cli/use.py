"""`sssgen use`: a ready material on a mesh, as a project that an engine opens."""

from __future__ import annotations

import contextlib
import math
import os
import re
import shlex
from argparse import ArgumentParser, BooleanOptionalAction, Namespace
from typing import TYPE_CHECKING

from sssgen.cli.options import add_output
from sssgen.cli.output import OK, print_result
from sssgen.presets.qualities import QUALITIES
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.file_writer import check_folder, write_files
from sssgen.support.paths import posix, shell_word
from sssgen.support.progress import ProgressBar

if TYPE_CHECKING:
    from sssgen.interchange.mapping_report import Report
    from sssgen.presets.request import Request


_UNITS_MM = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}
"""A unit → its millimetres."""
_DARK = 0.01
"""The share of the light that passes a clear body, in its clearest channel, below which it looks dark."""


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n"
        "  sssgen use wax cow.obj --target threejs -o page --open\n"
        "  sssgen use jade ring.glb --size 35 -o ring\n"
        "  sssgen use skin_fair head.glb --material Skin --quality best -o head\n"
        "  sssgen use marble bust.glb --target unity-urp -o MyProject/Assets\n"
        "Presets: sssgen list presets."
    )
    add = parser.add_argument
    add("PRESET", help="a ready material: a name of `sssgen list presets`, in any case")
    add("MESH", help="an .obj, .ply, .stl, .glb or .gltf file; closed, with its normals outwards")
    add("--target", "-t", metavar="T", default="threejs", help="the engine (default: threejs)")
    add_output(parser, "DIR", "the folder to write to", required=True)
    add(
        "--quality", choices=tuple(QUALITIES), default="good",
        help=f"{'; '.join(f'{name}: {needs}' for name, needs in QUALITIES.items())} (default: good)",
    )  # fmt: skip
    add(
        "--size", metavar="MM", help="the mesh's longest side in millimetres (default: the preset's), or `file`: a "
        "unit of the mesh is a metre, as in glTF",
    )  # fmt: skip
    add(
        "--turn", type=float, metavar="DEGREES",
        help="turn the body about its vertical axis: 180 where the page shows its back (default: the view looks at its "
        "+z side, the front in glTF)",
    )  # fmt: skip
    add("--up", choices=("y", "z"), help="the axis of the file that points up (default: y); z: as in CAD")
    add(
        "--material",
        metavar="NAME",
        default="",
        help="of a glTF file: the part with this material, and its pictures; other parts keep their own materials",
    )
    add(
        "--keep-color", action=BooleanOptionalAction, default=None,
        help="keep the detail of a glTF file's colours (default: for skin, leaves and paper)",
    )  # fmt: skip
    add("--open", action="store_true", help="show the page in a browser, until Ctrl+C")
    add("--force", action="store_true", help="replace files that were edited, or that other commands wrote")


def run(arguments: Namespace) -> int:
    """Writes the project; with --open also serves and opens it."""
    from sssgen.presets.kept_material import report_kept
    from sssgen.presets.preset import preset
    from sssgen.presets.project_files import project_files
    from sssgen.presets.request import Request
    from sssgen.presets.used_mesh import Pose, used_mesh
    from sssgen.presets.written_project import written_before

    _order(arguments)
    _refuse_material(arguments)
    chosen, target, folder = preset(arguments.PRESET), arguments.target, arguments.output
    arguments.PRESET = chosen.name
    _check_target(target, arguments.open)
    if target == "gltf" and arguments.quality != "good":
        raise failure("a glTF file has neither lobes nor baked light", "leave --quality out")
    size = _size(arguments.size, chosen.size_mm)
    turn = arguments.turn or 0.0
    if not math.isfinite(turn):
        raise failure(f"a body cannot be turned by {turn:g} degrees", "--turn 180 shows the other side")
    check_folder(folder)
    with ProgressBar() as bar:
        bar(0, 3, f"reading {os.path.basename(arguments.MESH)}")
        mesh = used_mesh(arguments.MESH, size, arguments.material, Pose(arguments.up == "z", turn))
        keeps_color = chosen.keeps_color if arguments.keep_color is None else arguments.keep_color
        request = Request(chosen, mesh, target, arguments.quality, keeps_color, _command(arguments))
        warnings = _warnings(request, bool(arguments.keep_color))
        earlier = written_before(folder, request.folder)
        files = project_files(request, folder, earlier, arguments.force, bar)
        written = write_files(folder, files)
        removed = earlier.remove_others(folder, files)
    if mesh.part is not None:
        report_kept(mesh.part, request.shows_color, mesh.report)
    lines = [f"{'wrote' if file.changed else 'kept '} {posix(file.path)}" for file in written]
    lines += [
        *(f"removed {posix(path)}" for path in removed),
        *_kept_lines(mesh.report),
        *(f"warning: {warning}" for warning in warnings),
        _size_line(request, arguments.size),
        *_front_lines(arguments),
        *_next_lines(request, folder),
    ]
    report = {
        "files": [posix(file.path) for file in written], "removed": [posix(path) for path in removed],
        "size_mm": mesh.longest_mm, "unit_mm": mesh.size.unit_mm,
        "warnings": warnings, "report": mesh.report.as_json(),
    }  # fmt: skip
    print_result(arguments.json, report, "\n".join(lines))
    if arguments.open:
        _show(folder)
    return OK


def _order(arguments: Namespace) -> None:
    """Exchanges the preset and the mesh where they are given in the other order."""
    from sssgen.scene.mesh_files import SUFFIXES

    first, second = (word.lower().endswith(SUFFIXES) for word in (arguments.PRESET, arguments.MESH))
    if first and not second:
        arguments.PRESET, arguments.MESH = arguments.MESH, arguments.PRESET


def _refuse_material(arguments: Namespace) -> None:
    """Raises SssgenError for a material's or a scene's file in place of a preset."""
    file = posix(arguments.PRESET)
    if file.lower().endswith(".toml"):
        shown = f"sssgen preview {shell_word(file)} --mesh {shell_word(posix(arguments.MESH))}"
        hint = f"`{shown}` shows it on the mesh; `sssgen render` draws a scene whose [geometry] names the mesh"
        raise failure("this is a TOML file, and no preset", hint, file)


def _check_target(target: str, opens: bool) -> None:
    """Raises SssgenError for a target without a project, and where --open has nothing to open."""
    from sssgen.presets.engines import ENGINES
    from sssgen.targets import registry

    if target not in ENGINES:
        projects = f"projects: {', '.join(ENGINES)}"
        if target in registry.names():
            hint = (
                f"emit its shader: `sssgen new NAME --from PRESET`, then `sssgen emit NAME.toml -t {target} -o DIR`; "
            )
            raise failure(f"there is no project for the target '{target}' yet", hint + projects)
        raise failure(f"there is no project for the target '{target}'", did_you_mean(target, ENGINES) or projects)
    if opens and not ENGINES[target].is_page:
        raise failure(f"--open shows pages, and {ENGINES[target].title} is none", "leave --open out")


def _size(text: str | None, usual: float) -> float | None:
    """The longest side in millimetres, or None where the file says it. Raises SssgenError for another text."""
    if text is None or text == "file":
        return usual if text is None else None
    try:
        size = float(text)
    except ValueError:
        match = re.fullmatch(r"([\d.]+) *(mm|cm|m|in)", text.strip())
        example = f"--size {float(match[1]) * _UNITS_MM[match[2]]:g}" if match else "--size 35"
        raise failure(f"'{text}' is no size", f"a number of millimetres, as {example}, or `--size file`") from None
    if not 1e-3 <= size <= 1e6:
        raise failure(f"a body cannot be {size:g} mm large", "--size is from 0.001 to 1000000")
    return size


def _warnings(request: Request, keeps_color: bool) -> list[str]:
    """What is probably not as the user wants it. `keeps_color` is whether `--keep-color` was given."""
    from sssgen.scene.mesh_suitability import mesh_warnings

    mesh = request.mesh
    warnings, part = mesh_warnings(mesh.geometry, request.needs), mesh.part
    if request.same_as_good:
        warnings.append(request.same_as_good)
    if part is not None and part.imported is None:
        names = ", ".join(part.others)
        warnings.append(
            f"the file has several materials, whose pictures are left out: choose one with --material ({names})"
        )
    elif part is not None and part.others and not request.rest:
        warnings.append(f"left out are the parts with other materials: {', '.join(part.others)}")
    if keeps_color and (request.kept is None or request.kept.base_color.image is None):
        warnings.append("--keep-color keeps nothing: the mesh has no picture of its colours")
    if request.clear_share < _DARK:
        size = request.preset.size_mm
        warnings.append(
            f"the body is too large to be clear: {request.clear_share:.1g} of the light passes it, so that it is dark; "
            f"choose a smaller --size ({size:g} mm is usual)"
        )
    return warnings


def _kept_lines(report: Report) -> list[str]:
    """What became of the pictures of the file, and how many other elements were left out."""
    lines = [
        f"{row.outcome}: {row.element} ({row.value}){'' if row.outcome == 'mapped' else f': {row.became}'}"
        for row in report.rows
        if row.element.endswith("Texture") or row.outcome == "approximated"
    ]
    return [line.replace("mapped", "kept", 1) for line in lines]


def _size_line(request: Request, given: str | None) -> str:
    """How large the body is taken to be, and why."""
    mesh, preset = request.mesh, request.preset
    longest, unit = f"the longest side is {mesh.longest_mm:.4g} mm", f"a unit of the mesh is {mesh.size.unit_mm:.4g} mm"
    if given is None:
        return f"size: {longest}, assumed for {preset.name} (--size MM, or --size file for metres); {unit}"
    return f"size: {longest}; {unit}"


def _front_lines(arguments: Namespace) -> list[str]:
    """Which side the view shows, where neither the file nor the user says which one is in front."""
    from sssgen.presets.kept_material import is_gltf

    if is_gltf(arguments.MESH) or arguments.turn is not None or arguments.up is not None:
        return []
    return ["front: the view shows the side towards +z; --turn 180 shows the other one"]


def _next_lines(request: Request, folder: str) -> list[str]:
    """How the project is opened and changed."""
    from sssgen.support.extra_packages import is_installed
    from sssgen.support.installation import install_hint

    place = shell_word(posix(os.path.join(folder, request.folder)).rstrip("/"))
    preview = "" if is_installed("preview") else f" (which needs `{install_hint('preview')}`)"
    return [
        f"open it: {request.opened.replace('this folder', shell_word(posix(folder)))}",
        f"change it: `sssgen preview {place}/scene.toml`{preview}; then, in {place}: {request.change}",
    ]


def _command(arguments: Namespace) -> str:
    """The command line without what does not change the files."""
    words = ["sssgen", "use", arguments.PRESET, posix(arguments.MESH), "--target", arguments.target]
    words += ["--quality", arguments.quality]
    words += ["--size", arguments.size] if arguments.size else []
    words += ["--turn", f"{arguments.turn:g}"] if arguments.turn else []
    words += ["--up", arguments.up] if arguments.up == "z" else []
    words += ["--material", arguments.material] if arguments.material else []
    if arguments.keep_color is not None:
        words.append("--keep-color" if arguments.keep_color else "--no-keep-color")
    return shlex.join([*words, "-o", posix(arguments.output)])


def _show(folder: str) -> None:
    """Serves a folder on this machine alone and opens it in the browser, until Ctrl+C."""
    import threading
    import webbrowser

    from sssgen.support.folder_server import served

    with served(folder) as address, contextlib.suppress(KeyboardInterrupt):
        print(f"{address}  Ctrl+C ends", flush=True)
        webbrowser.open(address)
        threading.Event().wait()
