"""All files of a project that `sssgen use` writes, made before the first is written: what is refused leaves nothing."""

from __future__ import annotations

import os
import tempfile

from sssgen.bake import fluence, relit
from sssgen.bake.baked_files import response_files
from sssgen.lab.fluence.fluence_field import Settings
from sssgen.lab.fluence.traced_body import fitting_voxels
from sssgen.material.baked import sidecar
from sssgen.presets.engine_project import engine_files, material_files
from sssgen.presets.preset_stages import RESPONSE
from sssgen.presets.project_templates import Files
from sssgen.presets.request import RANK, Request
from sssgen.presets.written_project import WrittenProject, record
from sssgen.support.diagnostics import Diagnostic, SssgenError, failure
from sssgen.support.file_writer import check_unchanged, write_files
from sssgen.support.paths import posix
from sssgen.support.progress import Progress


def project_files(request: Request, folder: str, earlier: WrittenProject, force: bool, progress: Progress) -> Files:
    """The files by their names in `folder`, which is only read.

    Without `force` a file that is there with another content is an error, unless it is as the `earlier` call wrote it;
    a bake of another body or medium is replaced. Raises SssgenError also for a body that cannot be baked, and where the
    target cannot express the material.
    """
    files = material_files(request)
    if not force:
        earlier.check_edits(folder)
        check_unchanged(folder, _others(files, earlier))
    with tempfile.TemporaryDirectory() as draft:
        write_files(draft, files)
        if request.baked:
            baked = _baked_light(request, folder, draft, progress)
            write_files(draft, baked)
            files |= baked
        progress(0, 1, "emitting")
        emitted = engine_files(request, draft)
    if not force:
        check_unchanged(folder, _others(emitted, earlier))
    files |= emitted
    return files | record(request, files)


def _others(files: Files, earlier: WrittenProject) -> Files:
    """The files that the earlier call did not write."""
    return {name: content for name, content in files.items() if name not in earlier.files}


def _baked_light(request: Request, folder: str, draft: str, progress: Progress) -> Files:
    """The light inside the body of the scene in `draft`; that in `folder`, if it is of this body and medium."""
    scene = fluence.body(os.path.join(draft, request.folder, "scene.toml"), "", 10.0)
    name, files = f"{request.folder}{RESPONSE}", Files()
    if relit.is_current(os.path.join(folder, name), scene):
        for file in (name, sidecar(name)):
            with open(os.path.join(folder, file), "rb") as opened:
                files[file] = opened.read()
        return files
    try:
        data, facts = relit.bake(scene, RANK, Settings(fitting_voxels(scene)), progress=progress)
    except SssgenError as error:
        raise _refusal(error.diagnostics[0], request.mesh.path) from None
    return response_files(name, data, facts)


def _refusal(cause: Diagnostic, mesh: str) -> SssgenError:
    """The error for a body whose light cannot be baked, at the user's mesh: the draft's is gone."""
    hints = (cause.hint, "or choose --quality good, which needs no bake")
    return failure(f"the light inside cannot be baked: {cause.message}", "; ".join(filter(None, hints)), posix(mesh))
