"""The runtime of an engine: what its materials share, as one file beside them, the same for every material.

For the web its sources are plain ES modules in `javascript/`, which import each other and are joined into one text. For
Godot they are scripts in `gdscript/`, for Unity in `csharp/`, where each namespace has its own `using`.
"""

from __future__ import annotations

import functools
import os
import re

from sssgen.support.diagnostics import failure

FOLDER = os.path.join(os.path.dirname(__file__), "javascript")
"""The folder of the project's own modules."""
SCRIPTS = {".gd": "gdscript", ".cs": "csharp"}
"""The folders of its scripts beside it, by the endings of their files."""
_IMPORT = re.compile(r"^import [^;]*;\n", re.MULTILINE)
_TYPE = re.compile(r"import\('\./[^']*'\)\.")
_EXPORT = re.compile(r"^export (?!default|\{|\*)", re.MULTILINE)


@functools.cache
def runtime_text(sources: tuple[str, ...], folder: str) -> str:
    """The module, or script, of these files; the exports are the first one's.

    A file is in `folder`, or else in the project's own.
    Imports of packages are written once, at the top; those of other files of the runtime and their types are left out.
    Raises SssgenError for a file that there is not.
    """
    first, *others = [_read(name, folder) for name in sources]
    imports = [line for text in (first, *others) for line in _IMPORT.findall(text) if "'./" not in line]
    head, _, body = _IMPORT.sub("", first).partition("\n\n")
    parts = [body, *(_EXPORT.sub("", _IMPORT.sub("", text)) for text in others)]
    pieces = [head, "".join(dict.fromkeys(imports)).rstrip(), *map(str.strip, parts)]
    text = "\n\n".join(piece for piece in pieces if piece)
    return _TYPE.sub("", text) + "\n"


def is_module(sources: tuple[str, ...]) -> bool:
    """Whether these files make a module of JavaScript, which can stand in another one."""
    return bool(sources) and sources[0].endswith(".js")


def inlined_text(sources: tuple[str, ...], folder: str) -> str:
    """The same without exports and without the comment at its head, to stand in another module."""
    return _EXPORT.sub("", runtime_text(sources, folder)).partition("\n\n")[2].rstrip()


def _read(name: str, folder: str) -> str:
    own = os.path.join(folder, name)
    project = os.path.join(FOLDER, "..", SCRIPTS.get(os.path.splitext(name)[1], "javascript"), name)
    try:
        with open(own if os.path.isfile(own) else project, encoding="utf-8") as file:
            return file.read()
    except (OSError, ValueError) as error:
        raise failure(f"cannot read '{name}', a source of a target's descriptor: {error}") from None
