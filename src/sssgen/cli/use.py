"""`sssgen use`: a ready material on a mesh, as a project that an engine opens."""

from __future__ import annotations

import contextlib
import os
import shlex
from argparse import ArgumentParser, Namespace
from collections.abc import Mapping

from sssgen.cli.options import add_output
from sssgen.cli.output import OK, print_result
from sssgen.presets.qualities import QUALITIES
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.file_writer import Written, check_folder, check_unchanged, write_files
from sssgen.support.paths import posix, shell_word
from sssgen.support.progress import ProgressBar


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n"
        "  sssgen use wax cow.obj --target threejs -o page --open\n"
        "  sssgen use jade ring.glb --size 35 -o ring\n"
        "  sssgen use skin_fair head.glb --quality best -o head\n"
        "Presets: sssgen list presets."
    )
    add = parser.add_argument
    add("PRESET", help="a ready material: a name of `sssgen list presets`")
    add("MESH", help="an .obj, .ply, .stl, .glb or .gltf file; closed, with its normals outwards")
    add("--target", "-t", metavar="T", default="threejs", help="the engine (default: threejs)")
    add_output(parser, "DIR", "the folder to write to", required=True)
    add(
        "--quality", choices=tuple(QUALITIES), default="good",
        help=f"{'; '.join(f'{name}: {needs}' for name, needs in QUALITIES.items())} (default: good)",
    )  # fmt: skip
    add("--size", type=float, metavar="MM", help="the mesh's longest side in millimetres (default: the preset's)")
    add("--open", action="store_true", help="show the page in a browser, until Ctrl+C")
    add("--force", action="store_true", help="replace files that were there before, also edited ones")


def run(arguments: Namespace) -> int:
    """Writes the project; with --open also serves and opens it."""
    from sssgen.presets.engine_project import ENGINES, Request, engine_files, material_files
    from sssgen.presets.preset import preset
    from sssgen.presets.used_mesh import used_mesh
    from sssgen.scene.mesh import Mesh
    from sssgen.scene.mesh_suitability import mesh_warnings

    chosen, target, folder = preset(arguments.PRESET), arguments.target, arguments.output
    if target not in ENGINES:
        hint = did_you_mean(target, ENGINES) or f"targets: {', '.join(ENGINES)}; `sssgen emit` writes shaders for all"
        raise failure(f"there is no project for the target '{target}'", hint)
    if arguments.open and not ENGINES[target].is_page:
        raise failure(f"--open shows pages, and {ENGINES[target].title} is none", "leave --open out")
    size = chosen.size_mm if arguments.size is None else arguments.size
    if not 1e-3 <= size <= 1e6:
        raise failure(f"a body cannot be {size:g} mm large", "--size is from 0.001 to 1000000")
    check_folder(folder)
    with ProgressBar() as bar:
        bar(0, 3, f"reading {os.path.basename(arguments.MESH)}")
        mesh = used_mesh(arguments.MESH, size)
        request = Request(chosen, mesh, target, arguments.quality, _command(arguments))
        written = _write(folder, material_files(request), arguments.force)
        if request.baked:
            written += _bake(folder, bar)
        bar(2, 3, "emitting")
        written += _write(folder, engine_files(request, folder), arguments.force)
    lines = [f"{'wrote' if file.changed else 'kept '} {posix(file.path)}" for file in written]
    warnings = mesh_warnings(Mesh(path=mesh.path), request.needs)
    lines += [f"warning: {warning}" for warning in warnings]
    lines.append(ENGINES[target].opened.replace("this folder", shell_word(posix(folder))))
    report = {"files": [posix(file.path) for file in written], "warnings": warnings}
    print_result(arguments.json, report, "\n".join(lines))
    if arguments.open:
        _show(folder)
    return OK


def _write(folder: str, files: Mapping[str, str | bytes], force: bool) -> list[Written]:
    """Writes files; without `force` one that is there with another content is an error, as it may have been edited."""
    if not force:
        check_unchanged(folder, files)
    return write_files(folder, files)


def _bake(folder: str, bar: ProgressBar) -> list[Written]:
    """Bakes the light inside the body of the scene in a folder; a bake of this body and medium is kept."""
    from sssgen.bake import baked_files, fluence, relit
    from sssgen.lab.fluence.fluence_field import Settings
    from sssgen.lab.fluence.traced_body import fitting_voxels
    from sssgen.presets.engine_project import RANK
    from sssgen.presets.preset_stages import RESPONSE

    scene, path = fluence.body(os.path.join(folder, "scene.toml"), "", 10.0), os.path.join(folder, RESPONSE)
    if relit.is_current(path, scene):
        return [Written(path, False)]
    data, facts = relit.bake(scene, RANK, Settings(fitting_voxels(scene)), progress=bar)
    return [Written(path, True) for path in baked_files.write_response(path, data, facts)]


def _command(arguments: Namespace) -> str:
    """The command line without what does not change the files."""
    words = ["sssgen", "use", arguments.PRESET, posix(arguments.MESH), "--target", arguments.target]
    words += ["--quality", arguments.quality] + (["--size", f"{arguments.size:g}"] if arguments.size else [])
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
