"""A material under another name, in a folder of its own: its file, its scene, and the files that these name."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator, Mapping
from typing import Any, NamedTuple

from sssgen.material.model import Material, wrong_name
from sssgen.preview.saved_values import parse_document
from sssgen.scene.bake_advice import is_scene
from sssgen.scene.scene import Scene
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.support.file_writer import as_bytes, check_names, has_content, write_files
from sssgen.support.paths import PACKAGE, place, posix, stem

SCENE = "scene.toml"
_SUFFIX = ".toml"


class Copy(NamedTuple):
    """The files of a copy, by their names in its folder."""

    files: Mapping[str, str | bytes]
    opened: str
    """The file that shows the copy: its scene, or its material where it has no scene"""


def copy_of(scene: Scene, material: Material, read: Collection[str], name: str) -> Copy:
    """The files of a material under another name. `read` are the files that its picture was made of.

    What is below the folder of the material or of the scene keeps its place; what these name elsewhere is put beside
    them. Raises SssgenError for a name that no material can have.
    """
    if problem := wrong_name(name):
        raise failure(*problem)
    main = os.path.abspath(material.file)
    documents = {main: f"{name}{_SUFFIX}"}
    if is_scene(scene, material):
        documents[os.path.abspath(scene.document.reporter.file)] = SCENE
    texts = {path: parse_document(path) for path in documents}
    others = [path for path in map(os.path.abspath, read) if path not in documents and _is_copied(path)]
    places = _places(texts, documents.values(), others)
    files: dict[str, str | bytes] = {}
    for path, inside in places.items():
        with open(path, "rb") as file:
            files[inside] = file.read()
    for path, document in texts.items():
        _rename(document, os.path.dirname(path), places)
        if path == main:
            _name(document["material"], name)
        else:
            document["material"] = documents[main]
        files[documents[path]] = document.as_string()
    return Copy(files, SCENE if len(documents) > 1 else documents[main])


def existing_files(top: str, folder: str, copy: Copy) -> list[str]:
    """The files in a folder below `top` that a copy would replace. Raises SssgenError for a folder elsewhere."""
    inside = _inside(folder, copy)
    paths = {name: os.path.join(top, folder, name) for name in copy.files}
    return [
        name
        for name, content in zip(copy.files, inside.values(), strict=True)
        if os.path.lexists(paths[name]) and not has_content(paths[name], as_bytes(content))
    ]


def write_copy(top: str, folder: str, copy: Copy, replaces: bool) -> str:
    """Writes a copy into a folder below `top`; returns the path of the file that shows it.

    Raises SssgenError where the folder is not below `top` or belongs to the installation, and, unless it `replaces`
    them, where a file is there already.
    """
    if not replaces and (there := existing_files(top, folder, copy)):
        hint = "choose another name, or confirm that the files are replaced"
        raise failure(f"the folder has {', '.join(there)} already", hint, folder)
    write_files(top, _inside(folder, copy))
    return os.path.join(top, folder, copy.opened)


def _inside(folder: str, copy: Copy) -> dict[str, str | bytes]:
    """The files by their names below the top. Raises SssgenError for names that leave it."""
    inside = {f"{folder}/{name}": content for name, content in copy.files.items()}
    try:
        check_names(inside)
    except SssgenError:
        message = f"'{folder}' is no folder below the one where the preview was started"
        raise failure(message, "write a name, such as my_jade, or looks/my_jade") from None
    return inside


def _is_copied(path: str) -> bool:
    """Whether a file belongs to the material; the library of techniques and the templates are there for all."""
    common = (*(place(name) for name in ("targets", "templates")), PACKAGE)
    shared = any(path.startswith(os.path.abspath(folder) + os.sep) for folder in common)
    return os.path.isfile(path) and (not shared or path.startswith(os.path.abspath(place("examples")) + os.sep))


def _places(texts: Mapping[str, Any], names: Collection[str], read: Collection[str]) -> dict[str, str]:
    """The place of each file in the copy, with `/`; the documents have `names` there."""
    folders = [os.path.dirname(path) for path in texts]
    named = {
        path for document, folder in zip(texts.values(), folders, strict=True) for path in _named(document, folder)
    }
    result: dict[str, str] = {}
    taken = {*names}
    for path in sorted(read, key=lambda path: path not in named):  # a file beside a named one follows it
        own = [folder for folder in folders if path.startswith(folder + os.sep)]
        beside = [other for other in result if os.path.splitext(other)[0] == os.path.splitext(path)[0]]
        if own:
            inside = posix(os.path.relpath(path, own[0]))
        elif path in named:
            inside = os.path.basename(path)
        elif beside:
            inside = os.path.splitext(result[beside[0]])[0] + os.path.splitext(path)[1]
        else:
            continue
        result[path] = _unused(inside, taken)
        taken.add(result[path])
    return result


def _unused(inside: str, taken: Collection[str]) -> str:
    base, suffix = os.path.splitext(inside)
    number = 1
    while inside in taken:
        number += 1
        inside = f"{base}_{number}{suffix}"
    return inside


def _named(document: Any, folder: str) -> Iterator[str]:
    """The paths of all texts of a document that could be names of files."""
    for table, key in _texts(document):
        yield _file_of(table[key], folder)[0]


def _rename(document: Any, folder: str, places: Mapping[str, str]) -> None:
    """Writes the new places of files into a document that is in `folder`."""
    for table, key in _texts(document):
        path, function = _file_of(table[key], folder)
        if path in places and places[path] + function != str(table[key]):
            table[key] = places[path] + function


def _file_of(text: str, folder: str) -> tuple[str, str]:
    """The path of the file that a text may name, and what follows it in `FILE:FUNCTION`."""
    path = os.path.normpath(os.path.join(folder, text))
    file, colon, function = text.rpartition(":")
    if os.path.isfile(path) or not file:
        return path, ""
    return os.path.normpath(os.path.join(folder, file)), colon + function


def _texts(content: Any) -> Iterator[tuple[Any, Any]]:
    """Each text of a document, as its table or list and its key in it."""
    for key, value in list(content.items() if isinstance(content, dict) else enumerate(content)):
        if isinstance(value, str):
            yield content, key
        elif isinstance(value, dict | list):
            yield from _texts(value)


def _name(table: Any, name: str) -> None:
    """Gives the material its name, and a title that follows from it."""
    table["name"] = name
    if "title" in table:
        table["title"] = stem(name).replace("_", " ").capitalize()
