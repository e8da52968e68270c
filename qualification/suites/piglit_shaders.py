"""Piglit's programs: files `*.shader_test`, which have the texts of stages, what a driver has to have, and drawings.

The texts are translated and compiled; the drawings are not made.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from qualification.suites.features import unsayable
from qualification.suites.text_cases import TextCase

_SECTION = re.compile(r"^\[([^\]\n]+)\][^\n]*$", re.MULTILINE)
_VERSION = re.compile(r"^GLSL( ES)?\s*>=\s*(\d)\.(\d+)", re.MULTILINE)
_STAGE = re.compile(r"(vertex|fragment|compute) shader")
_OTHER = re.compile(r"geometry|tessellation|spirv|program|include")
_LINK_ERROR = re.compile(r"^link error", re.MULTILINE)


def cases(root: Path) -> Iterator[TextCase]:
    """The programs of piglit in a folder that have shaders."""
    for path in sorted((root / "tests").rglob("*.shader_test")):
        case = read(path.read_text("utf-8", errors="replace"), path.relative_to(root / "tests").as_posix())
        if case is not None:
            yield case


def read(text: str, name: str) -> TextCase | None:
    """The case in a file's text; None where it has no shader of its own."""
    names = [section[1].strip().lower() for section in _SECTION.finditer(text)]
    bodies = _SECTION.split(text)[2::2]
    sections = dict(zip(names, bodies, strict=True))
    required = _VERSION.search(sections.get("require", ""))
    stages = {}
    for section, body in sections.items():
        if stage := _STAGE.fullmatch(section):
            stages[stage[1]] = _with_version(body.strip() + "\n", required)
    if not stages:
        return None
    other = next((section for section in sections if _OTHER.search(section)), "")
    twice = next((section for section in stages if names.count(f"{section} shader") > 1), "")
    skipped = f"it has the section {other}" if other else unsayable("".join(stages.values()))
    if twice:
        skipped = f"its {twice} shader has several texts, which a driver links"
    main = "fragment" if "fragment" in stages else next(iter(stages))
    vertex = stages.get("vertex", "") if main == "fragment" else ""
    label = f"{name.rpartition('/')[2].removesuffix('.shader_test')}.{main[:4]}"
    valid = not _LINK_ERROR.search(sections.get("test", ""))
    return TextCase(f"piglit/{name}", label, stages[main], vertex, valid=valid, skipped=skipped)


def _with_version(text: str, required: re.Match[str] | None) -> str:
    """The text with the version that piglit gives to a text without one."""
    if required is None or re.search(r"^\s*#\s*version\b", text, re.MULTILINE):
        return text
    version = f"{required[2]}{required[3]:0<2}"
    es = " es" if required[1] and version != "100" else ""
    return f"#version {version}{es}\n{text}"
