"""The record of a project that `sssgen use` wrote: by it the next call knows which files of the folder nobody edited.

Another preset, mesh or quality replaces those, and removes what it does not write itself. `sssgen emit` into the folder
replaces the shaders that nobody edited.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, NamedTuple

from sssgen.support.diagnostics import SssgenError, failure
from sssgen.support.file_writer import Written, as_bytes, check_names, write_files
from sssgen.support.paths import posix

if TYPE_CHECKING:
    from sssgen.presets.project_templates import Files
    from sssgen.presets.request import Request

RECORD = ".sssgen.json"
"""The name of the record. Engines do not import files that begin with a dot."""
_NAMED = 3
"""The largest number of edited files that an error names."""


class WrittenProject(NamedTuple):
    """What a record says; without one there is no title and no file."""

    title: str = ""
    """The preset, the mesh and the target"""
    files: Mapping[str, str] = {}
    """Name in the folder that was written to → the SHA-256 of its content"""

    def check_edits(self, folder: str) -> None:
        """Raises SssgenError if files were edited since they were written."""
        edited = [name for name in self.files if _hash_of(folder, name) not in ("", self.files[name])]
        if edited:
            names = ", ".join(edited[:_NAMED]) + (" and others" if len(edited) > _NAMED else "")
            raise failure(
                f"the folder holds {self.title}, and files of it were edited: {names}",
                "choose another folder with -o, or replace them with --force",
                posix(os.path.join(folder, edited[0])),
            )

    def remove_others(self, folder: str, written: Collection[str]) -> list[str]:
        """Removes the files that the new project lacks, but for edited ones; returns their paths."""
        removed = []
        for name in self.files:
            if name not in written and _hash_of(folder, name) == self.files[name]:
                path = os.path.join(folder, name)
                with contextlib.suppress(OSError):
                    os.unlink(path)
                    removed.append(path)
                    part = name
                    while part := os.path.dirname(part):
                        os.rmdir(os.path.join(folder, part))  # an error unless it is empty
        return removed

    def check_shaders(self, folder: str, texts: Mapping[str, str]) -> None:
        """Raises SssgenError if one of the texts would replace a file that was edited since it was written."""
        for name, text in texts.items():
            now = _hash_of(folder, name)
            if name in self.files and now not in ("", self.files[name], _hash(text)):
                raise failure(
                    "the file was edited since sssgen wrote it",
                    "choose another folder with -o, or replace it with --force",
                    posix(os.path.join(folder, name)),
                )

    def with_shaders(self, texts: Mapping[str, str]) -> WrittenProject:
        """The record after the texts were written: those of its files have other hashes."""
        return self._replace(
            files={name: _hash(texts[name]) if name in texts else old for name, old in self.files.items()}
        )

    @property
    def text(self) -> str:
        """The content of the record's file."""
        return json.dumps({"project": self.title, "files": self.files}, indent=2, ensure_ascii=False) + "\n"


def written_before(folder: str, part: str = "") -> WrittenProject:
    """What an earlier call wrote to the folder, where its record is in the sub-folder `part`."""
    try:
        with open(os.path.join(folder, part, RECORD), encoding="utf-8") as file:
            content = json.load(file)
        files = {str(name): str(value) for name, value in content["files"].items()}
        check_names(files)
        return WrittenProject(str(content["project"]), files)
    except (OSError, ValueError, TypeError, LookupError, AttributeError, SssgenError):
        return WrittenProject()  # without a record nothing is replaced


def record(request: Request, files: Files) -> Files:
    """The record of a project. What other presets share in the folder is not in it."""
    mesh = os.path.basename(request.mesh.path)
    hashes = {name: _hash(content) for name, content in files.items() if name.startswith(request.folder)}
    project = WrittenProject(f"{request.name} on {mesh} for {request.target}", hashes)
    return {request.folder + RECORD: project.text}


def write_shaders(folder: str, texts: Mapping[str, str], force: bool) -> list[Written]:
    """Writes shaders to a folder. Raises SssgenError, without `force`, where one of a project there was edited."""
    project = written_before(folder)
    if not force:
        project.check_shaders(folder, texts)
    written = write_files(folder, texts)
    if (after := project.with_shaders(texts)) != project:
        write_files(folder, {RECORD: after.text})
    return written


def _hash(content: str | bytes) -> str:
    return hashlib.sha256(as_bytes(content)).hexdigest()


def _hash_of(folder: str, name: str) -> str:
    """The SHA-256 of a file's content; '' where there is no such file."""
    try:
        with open(os.path.join(folder, name), "rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return ""
