"""The formats that `sssgen import` reads, by the suffixes of their files."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping

from sssgen.interchange import gltf_container, gltf_reader, gltf_view, materialx_reader, unity_reader
from sssgen.interchange.imported_material import ImportedMaterial
from sssgen.interchange.imported_view import ImportedView
from sssgen.interchange.mapping_report import Report
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.paths import posix
from sssgen.support.text_files import refuse_folder

READERS: Mapping[str, Callable[[str, Report, str, str], list[ImportedMaterial]]] = {
    ".glb": gltf_reader.read,
    ".gltf": gltf_reader.read,
    ".mtlx": materialx_reader.read,
    ".mat": unity_reader.read,
    ".asset": unity_reader.read,
}
"""Suffix → the reader: of a path, the report, the name of a material or '', and the folder of all files or ''."""


def read(path: str, report: Report, name: str = "", top: str = "") -> list[ImportedMaterial]:
    """The materials of a file; with `name`, that one alone. Adds to the report what is left out. Raises SssgenError.

    `top` is the folder that has all files of the material; by default that of the file or, for Unity, the project.
    """
    refuse_folder(path, tuple(READERS))
    suffix = os.path.splitext(path)[1].lower()
    if suffix not in READERS:
        hint = did_you_mean(suffix, READERS) or f"readable files end in {', '.join(READERS)}"
        raise failure(f"'{suffix}' is not the suffix of a file with materials", hint, posix(path))
    return READERS[suffix](path, report, name, top)


def read_view(path: str, report: Report, top: str = "") -> ImportedView:
    """The camera and the lights of a file that `read` accepts. Adds to the report what is left out. Raises
    SssgenError."""
    suffix = os.path.splitext(path)[1].lower()
    return gltf_view.read_view(path, report, top) if suffix in gltf_container.SUFFIXES else ImportedView()
