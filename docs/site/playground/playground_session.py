"""What the page of the playground asks of Python, which runs in the browser: texts and the head of a picture.

`precompile.mjs` compiles this module into the page's bundle. It needs no NumPy and runs no compiler.
"""

from __future__ import annotations

import json
import os
import re
from typing import Any

from sssgen.material.material_loading import load_material
from sssgen.material.model import Material
from sssgen.pipeline.compiler import Compiled, compile, transpile
from sssgen.preview import flat_head
from sssgen.preview.emitted_head import TARGET, emitted_head
from sssgen.support.diagnostics import Diagnostic, SssgenError, failure
from sssgen.support.paths import place, stem

PLAIN = (".glsl", ".frag", ".vert")
"""The suffixes of plain GLSL."""
TIME = 0
"""The time of all files in the bundle, in ns, so that the caches which it has are valid in every browser."""
_NAME = re.compile(r"[A-Za-z0-9_]{1,64}\.(toml|sss|json|glsl|frag|vert)")

_written: dict[str, dict[str, str | None]] = {}
"""Example → file → its text before the page wrote it; None for a new file."""


def age(*folders: str) -> None:
    """Gives all files and folders the same time: the keys of cached results have it."""
    for top in folders:
        for folder, _, names in os.walk(top):
            for path in (folder, *(os.path.join(folder, name) for name in names)):
                os.utime(path, ns=(TIME, TIME))


def answer(request: str) -> str:
    """The answer to a request of the page, both JSON.

    A request has `part`, which is `picture` or `text`, `example` (the folder), `files` (name → text) and `main` (the
    material's or the GLSL file). For a text it has `target` and `form`, for a picture `values` (parameter → numbers of
    the scene) and `in_scene`. The picture is apart, as it is what a person waits for.

    The answer has `errors`, as the command line prints them, `diagnostics` with their places, and `warnings`; the text
    has `texts`, the picture `head`, or None and a `note` for plain GLSL that cannot be drawn.
    """
    asked = json.loads(request)
    result: dict[str, Any] = {"errors": "", "diagnostics": [], "warnings": ""}
    try:
        _write(asked["example"], asked["files"])
        answers = _of_plain(asked) if asked["main"].endswith(PLAIN) else _of_material(asked)
        return json.dumps(result | answers)
    except SssgenError as error:
        diagnostics = [diagnostic.as_json() for diagnostic in error.diagnostics]
        return json.dumps({**result, "errors": str(error), "diagnostics": diagnostics})


def _path(asked: dict[str, Any]) -> str:
    return os.path.join(place("examples"), asked["example"], asked["main"])


def _of_material(asked: dict[str, Any]) -> dict[str, Any]:
    example, main = asked["example"], asked["main"]
    material = load_material(example if main == f"{example}.toml" else _path(asked))
    if asked["part"] == "text":
        return _texts(compile(material, asked["target"], asked["form"]), [])
    flat = material.makes_rays
    compiled = compile(material, flat_head.TARGET if flat else TARGET, standalone=True)
    head = (flat_head.raymarched_head if flat else emitted_head)(material, compiled, asked["values"], asked["in_scene"])
    return {"head": {**head, "texture_files": texture_files(material, compiled)}}


def _of_plain(asked: dict[str, Any]) -> dict[str, Any]:
    """Plain GLSL is translated as `sssgen transpile` does; its picture is that of the live preview."""
    from sssgen.lang.plain_glsl import load_glsl

    path = _path(asked)
    with open(path, encoding="utf-8") as file:
        entry = "shadertoy" if re.search(r"\bvoid\s+mainImage\s*\(", file.read()) else ""
    loaded = load_glsl(path, asked["main"], entry=entry)
    title = re.sub(r"\W", "_", stem(path), flags=re.ASCII)
    name = title if title[:1].isalpha() else f"file_{title}"
    if asked["part"] == "text":
        return _texts(transpile(loaded.module, asked["target"], name, keep=True, head=loaded.head), loaded.warnings)
    try:
        return {"head": flat_head.plain_head(path, "auto")}
    except SssgenError as error:  # the text is right: it is only no picture
        return {"head": None, "note": error.diagnostics[0].message}


def _texts(compiled: Compiled, warnings: list[Diagnostic]) -> dict[str, Any]:
    every = [*warnings, *compiled.warnings]
    return {"texts": compiled.files, "warnings": "\n".join(warning.render() for warning in every)}


def texture_files(material: Material, compiled: Compiled) -> dict[str, str]:
    """The texture's name in the source → the file that the material suggests for it."""
    files: dict[str, str] = {}
    for texture in compiled.reflection["textures"]:
        for stage in material.stages:
            file = stage.textures.get(texture["technique_name"])
            if stage.technique.name == texture["technique"] and file:
                files.setdefault(texture["source_name"], file)
    return files


def _write(example: str, files: dict[str, str]) -> None:
    """Makes the files of an example's folder those of the page: others that the page wrote before get their old text.

    Raises SssgenError for a name that is no file's.
    """
    for name in files:
        if not _NAME.fullmatch(name):
            raise failure(f"'{name}' cannot be a file here", "letters, digits and _, then .toml, .sss or .glsl")
    folder = os.path.join(place("examples"), example)
    os.makedirs(folder, exist_ok=True)
    before = _written.setdefault(example, {})
    for name in [name for name in before if name not in files]:
        text = before.pop(name)
        if text is None:
            os.unlink(os.path.join(folder, name))
        else:
            _put(os.path.join(folder, name), text)
    for name, text in files.items():
        path = os.path.join(folder, name)
        now = _text(path)
        if now != text:
            before.setdefault(name, now)
            _put(path, text)


def _text(path: str) -> str | None:
    try:
        with open(path, encoding="utf-8", newline="") as file:
            return file.read()
    except FileNotFoundError:
        return None


def _put(path: str, text: str) -> None:
    with open(path, "w", encoding="utf-8", newline="") as file:
        file.write(text)


def warm() -> None:
    """Imports what the first edit of a technique needs, and what an edit of plain GLSL needs."""
    import sssgen.lang.check.module_checker
    import sssgen.lang.plain_glsl
    import sssgen.pipeline.programs
    import sssgen.pipeline.steps  # noqa: F401  # loaded for later
