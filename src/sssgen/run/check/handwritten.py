"""The sources in a file that no target wrote: its language and stages follow from its extension and text."""

from __future__ import annotations

import re
from collections.abc import Sequence

from sssgen.run.compilers import Source, Stage
from sssgen.run.compilers.calling_entry import functions

_GLSL = ("glsl-330", "glsl-es-300")
LANGUAGES_OF: dict[str, tuple[str, ...]] = {
    ".vert": _GLSL,
    ".frag": _GLSL,
    ".glsl": _GLSL,
    ".wgsl": ("wgsl",),
    ".wesl": ("bevy",),
    ".hlsl": ("hlsl", "unity-urp", "unity-builtin", "unity-shadergraph"),
    ".cginc": ("unity-builtin",),
    ".ush": ("unreal",),
    ".shader": ("unity-builtin", "unity-urp"),
    ".gdshader": ("godot",),
    ".gdshaderinc": ("godot",),
    ".py": ("numpy",),
}
"""Extension → possible languages; the first is the default where the text does not decide."""

_SIGNS = {
    "glsl-es-300": r"^\s*#\s*version\s+\d+\s+es\b",
    "unity-urp": r"Packages/com\.unity\.render-pipelines|\"RenderPipeline\"\s*=\s*\"UniversalPipeline\"",
}
_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


def language_of(extension: str, text: str, allowed: Sequence[str]) -> str:
    """The language among those `allowed` (empty: all); '' where it is none of them, or unknown."""
    possible = [name for name in LANGUAGES_OF.get(extension, ()) if not allowed or name in allowed]
    marked = [name for name in possible if name in _SIGNS and re.search(_SIGNS[name], text, re.MULTILINE)]
    return next(iter([*marked, *possible]), "")


def hand_written(text: str, language: str, name: str) -> list[Source]:
    """The sources in a text: one for each entry point that HLSL has, else one; without an entry, a library."""
    bare = _COMMENT.sub("", text)
    if language == "hlsl":
        return [Source(text, language, stage, entry, name) for stage, entry in _hlsl_entries(bare)]
    return [Source(text, language, _stage(bare, language, name), name=name)]


def _stage(text: str, language: str, name: str) -> Stage:
    if language in _GLSL:
        if name.endswith(".vert") or re.search(r"\bgl_Position\b", text):
            return "vertex"
        return "fragment" if name.endswith(".frag") or re.search(r"\bvoid\s+main\s*\(", text) else "library"
    if language == "wgsl":
        stage = re.search(r"@(vertex|fragment)\b", text)
        return "library" if stage is None else "vertex" if stage[1] == "vertex" else "fragment"
    return "fragment" if name.endswith((".shader", ".gdshader")) else "library"


def _hlsl_entries(text: str) -> list[tuple[Stage, str]]:
    """The functions that are not called and that return SV_Target or SV_Position, directly or in a struct."""
    entries: list[tuple[Stage, str]] = []
    for function in functions(text):
        semantic = re.search(rf"\b{function.name}\s*\([^()]*\)\s*:\s*(\w+)", text)
        struct = re.search(rf"\bstruct\s+{function.returns}\s*\{{([^{{}}]*)\}}", text)
        semantics = (semantic[1] if semantic else struct[1] if struct else "").upper()
        if len(re.findall(rf"\b{function.name}\s*\(", text)) > 1:
            continue
        if "SV_TARGET" in semantics:
            entries.append(("fragment", function.name))
        elif "SV_POSITION" in semantics:
            entries.append(("vertex", function.name))
    return entries or [("library", "main")]
