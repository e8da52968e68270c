"""A whole shader's text as functions and variables: what a stage is given and gives becomes variables of the file.

A program around the text can then set what a function reads, call any function, `main` too, and read what it wrote.
Only words at file scope change, so that the text may be given to a driver and to our own front end alike: `in`, `out`,
`varying` and `attribute` go, and with them `layout(…)` and the words of interpolation; the stage's own variables
(`gl_FragCoord`, …) get other names by macros. Uniforms that are numbers, vectors, matrices or textures stay; arrays,
structs and blocks of them become variables.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from sssgen.ir.old_names import OLD_NAMES

MAIN = "sssgen_written_main"
"""What `main` is called."""

STAGE = {
    "gl_FragCoord": ("vec4", "sssgen_coordinates"),
    "gl_FrontFacing": ("bool", "sssgen_facing"),
    "gl_PointCoord": ("vec2", "sssgen_point"),
    "gl_FragColor": ("vec4", "sssgen_color"),
    "gl_FragDepth": ("float", "sssgen_depth"),
    "gl_FragDepthEXT": ("float", "sssgen_depth_ext"),
    "gl_Position": ("vec4", "sssgen_position"),
    "gl_PointSize": ("float", "sssgen_point_size"),
    "gl_VertexID": ("int", "sssgen_vertex"),
    "gl_InstanceID": ("int", "sssgen_instance"),
}
"""The variables of the stages: their types, and their names here."""

_PART = re.compile(
    r"(?P<skip>//[^\n]*|/\*.*?\*/|^[ \t]*\#(?:\\\n|[^\n])*)|(?P<name>[A-Za-z_]\w*)|(?P<mark>[{}()])",
    re.DOTALL | re.MULTILINE,
)
_VERSION = re.compile(r"^[ \t]*#[ \t]*version[ \t]+(\d+)[ \t]*(\w*)[^\n]*$", re.MULTILINE)
_EXTENSION = re.compile(r"^[ \t]*#[ \t]*extension\b[^\n]*$", re.MULTILINE)
_LAYOUT = re.compile(r"layout\s*\([^()]*\)")
_REQUALIFIED = re.compile(r"(?:invariant|precise)\s+\w+(?:\s*,\s*\w+)*\s*;")
_UNIFORM = re.compile(r"uniform\s+(?:(?:lowp|mediump|highp)\s+)?(\w+)\s+\w+\s*(\[?)")
_BLOCK = re.compile(r"uniform\s+(\w+)\s*\{([^{}]*)\}\s*(\w*)\s*;")
_BASIC = re.compile(r"float|u?int|bool|[iub]?vec[234]|mat[234](?:x[234])?|[iu]?sampler\w*")
_DROPPED = frozenset(
    {"in", "out", "varying", "attribute", "flat", "smooth", "noperspective", "centroid", "sample", "invariant"}
)


class Plain(NamedTuple):
    """A text without a stage."""

    version: str
    """What its `#version` says, as in `300 es`; '' where it has none."""
    text: str
    """Without `#version`; for our front end."""

    @property
    def is_es(self) -> bool:
        """Whether it is written for OpenGL ES 3."""
        return self.version.endswith("es")

    def for_driver(self, version: str) -> str:
        """The text with this `#version`, and with new names for what that version knows by other names."""
        named = [f"#define {old} {new}" for old, (new, _) in OLD_NAMES.items() if _uses(self.text, old)]
        extensions = _EXTENSION.findall(self.text)
        text = _EXTENSION.sub("", self.text)
        precision = _ES_PRECISION if version.endswith("es") else []
        return "\n".join([f"#version {version}", *extensions, *precision, *named, text])


_ES_PRECISION = [
    f"precision highp {type_};" for type_ in ("float", "int", "sampler2D", "sampler3D", "samplerCube", "sampler2DArray")
]


def plain(text: str) -> Plain:
    """The text as functions and variables."""
    version = _VERSION.search(text)
    body = without_interface(_VERSION.sub("", text, count=1))
    renamed = {name: new for name, (_, new) in STAGE.items() if _uses(body, name)}
    head = [f"{STAGE[name][0]} {new};" for name, new in renamed.items()]
    renamed |= {"main": MAIN} if _uses(body, "main") else {}
    head += [f"#define {name} {new}" for name, new in renamed.items()]
    tail = [f"#undef {name}" for name in renamed]  # what stands behind the text has a main of its own
    return Plain(f"{version[1]} {version[2]}".strip() if version else "", "\n".join([*head, body, *tail, ""]))


def _uses(text: str, name: str) -> bool:
    """Whether a name stands in a text that does not define it as a macro."""
    defined = re.search(rf"^[ \t]*#[ \t]*define[ \t]+{name}\b", text, re.MULTILINE)
    return defined is None and re.search(rf"\b{name}\b", text) is not None


def without_interface(text: str) -> str:
    """A text without the words that tie declarations at file scope to a stage."""
    kept: list[str] = []
    depth = done = 0
    for match in _PART.finditer(text):
        if match.start() < done:
            continue
        if match["mark"]:
            depth += 1 if match["mark"] in "{(" else -1
        elif match["name"] and depth == 0:
            found = _replaced(text, match)
            if found is not None:
                kept += [text[done : match.start()], found[0]]
                done = found[1]
    kept.append(text[done:])
    return "".join(kept)


def _replaced(text: str, name: re.Match[str]) -> tuple[str, int] | None:
    """What stands instead of what begins with a name, and where that ends; None where it stays."""
    if layout := _LAYOUT.match(text, name.start()):
        return "", layout.end()
    if again := _REQUALIFIED.match(text, name.start()):
        return "", again.end()
    if name[0] in _DROPPED:
        return "", name.end()
    if block := _BLOCK.match(text, name.start()):
        members = _LAYOUT.sub("", block[2])
        return (f"struct {block[1]} {{{members}}} {block[3]};" if block[3] else members), block.end()
    uniform = _UNIFORM.match(text, name.start())
    if uniform and (not _BASIC.fullmatch(uniform[1]) or (uniform[2] and "sampler" not in uniform[1])):
        return "", name.end()
    return None
