"""Finds the files of a Unity project by their GUID, which Unity keeps in a .meta file beside each."""

from __future__ import annotations

import os
import re
import struct
from collections.abc import Iterator

MAX_FILES = 200_000
"""The most .meta files that are searched."""
_GUID = re.compile(rb"^guid:\s*([0-9a-fA-F]{32})\s*$", re.MULTILINE)
_HEAD_BYTES = 512
_TOPS = ("Assets", "Packages")
"""Folders that contain all files of a project, or of its packages."""


class UnityProject:
    """The files around a file: those beside it first, then folder by folder up to `Assets` and what is beside that."""

    def __init__(self, path: str, root: str = "") -> None:
        """`root` is the folder where the search ends; by default the folder that contains `Assets`."""
        self.folder = os.path.dirname(os.path.realpath(path))
        self.root = os.path.realpath(root) if root else _project_of(self.folder)
        self._paths: dict[str, str] = {}
        self._files = self._search()

    def file(self, guid: str) -> str:
        """The path of the file with a GUID, or ''."""
        wanted = guid.lower()
        while wanted not in self._paths:
            following = next(self._files, None)
            if following is None:
                return ""
            name, path = following
            self._paths.setdefault(name, path)
        path = self._paths[wanted]
        return path if os.path.isfile(path) else ""

    def files(self, suffix: str) -> list[str]:
        """All files of the project that end in a suffix."""
        for name, path in self._files:
            self._paths.setdefault(name, path)
        return sorted(path for path in self._paths.values() if path.endswith(suffix))

    def _search(self) -> Iterator[tuple[str, str]]:
        """GUID and path of each file; a folder before those around it."""
        searched, count = "", 0
        folder = self.folder
        while True:
            for parent, folders, names in os.walk(folder):
                folders[:] = [name for name in sorted(folders) if os.path.join(parent, name) != searched]
                for name in sorted(names):
                    if name.endswith(".meta"):
                        count += 1
                        if count > MAX_FILES:
                            return
                        path = os.path.join(parent, name)
                        if guid := guid_of(path):
                            yield guid, path.removesuffix(".meta")
            searched = folder
            above = os.path.dirname(folder)
            if folder == self.root or above == folder:
                return
            folder = above


def guid_of(meta: str) -> str:
    """The GUID in a .meta file, or ''."""
    try:
        with open(meta, "rb") as file:
            match = _GUID.search(file.read(_HEAD_BYTES))
    except OSError:
        return ""
    return match[1].decode("ascii").lower() if match else ""


def guid_of_vector(numbers: tuple[float, ...]) -> str:
    """The GUID that HDRP stores in the bytes of a material's vector of four floats; '' where they are all 0."""
    try:
        content = struct.pack("<4f", *numbers)
    except (OverflowError, struct.error):
        return ""
    return content.hex() if any(content) else ""


def hash_of_number(number: float) -> int:
    """The hash of a diffusion profile that HDRP stores in the bits of a material's float."""
    try:
        return int(struct.unpack("<I", struct.pack("<f", number))[0])
    except (OverflowError, struct.error):
        return 0


def _project_of(folder: str) -> str:
    """The folder that contains `Assets` or `Packages`, or the package around a folder; else the folder itself."""
    current = folder
    while True:
        above, name = os.path.split(current)
        if name in _TOPS:
            return above
        if os.path.isfile(os.path.join(current, "package.json")):
            return current
        if above == current:
            return folder
        current = above
