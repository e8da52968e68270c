"""A whole shader's text as functions and variables: the inputs and outputs of the stage become variables of the file.

A program around the text can then set what a function reads, call any function, even `main`, and read what it wrote.
Only tokens at file scope change, so that a driver and our own front end accept the text: `in`, `out`, `varying`,
`attribute`, `layout(…)` and interpolation qualifiers are removed; macros rename the stage's own variables
(`gl_FragCoord`, …). Uniforms that are numbers, vectors, matrices or textures stay; arrays, structs and blocks of
uniforms become variables.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection
from typing import NamedTuple

from sssgen.ir.old_names import OLD_NAMES
from sssgen.ir.out_builtins import OUT_BUILTINS
from sssgen.lang.check.uniform_hints import HINTS

MAIN = "sssgen_written_main"
"""The new name of `main`."""

STAGE = {
    "gl_FragCoord": ("vec4", "sssgen_coordinates"),
    "gl_FrontFacing": ("bool", "sssgen_facing"),
    "gl_PointCoord": ("vec2", "sssgen_point"),
    "gl_FragColor": ("vec4", "sssgen_color"),
    "gl_FragData": ("vec4", "sssgen_colors"),
    "gl_FragDepth": ("float", "sssgen_depth"),
    "gl_FragDepthEXT": ("float", "sssgen_depth_ext"),
    "gl_Position": ("vec4", "sssgen_position"),
    "gl_PointSize": ("float", "sssgen_point_size"),
    "gl_SampleID": ("int", "sssgen_sample"),
    "gl_VertexID": ("int", "sssgen_vertex"),
    "gl_InstanceID": ("int", "sssgen_instance"),
    "gl_ViewID_OVR": ("uint", "sssgen_view"),
    "gl_DrawID": ("int", "sssgen_draw"),
    "gl_BaseVertex": ("int", "sssgen_base_vertex"),
    "gl_BaseInstance": ("int", "sssgen_base_instance"),
}
"""The variables of the stages: their types and new names."""

_PART = re.compile(
    r"(?P<skip>//[^\n]*|/\*.*?\*/|^[ \t]*\#(?:\\\n|[^\n])*)|(?P<name>[A-Za-z_]\w*)|(?P<mark>[{}();])",
    re.DOTALL | re.MULTILINE,
)
_CONDITION = re.compile(r"[ \t]*#[ \t]*(if|ifdef|ifndef|elif|else|endif)\b")
_VERSION = re.compile(r"^[ \t]*#[ \t]*version[ \t]+(\d+)[ \t]*(\w*)[^\n]*$", re.MULTILINE)
_EXTENSION = re.compile(r"^[ \t]*#[ \t]*extension\b[^\n]*$", re.MULTILINE)
_CALL = re.compile(r"\s*\(")
_COLOR_INDEX = re.compile(r"\bgl_FragData\s*\[\s*(\w*)")
_LAYOUT = re.compile(r"layout\s*\([^()]*\)")
_DEFAULTS = re.compile(r"(?:layout\s*\([^()]*\)\s*)?(?:uniform|in|out)\s*;")
"""The defaults of a shader, such as `layout(std140) uniform;`."""
_REQUALIFIED = re.compile(r"(?:invariant|precise)\s+\w+(?:\s*,\s*\w+)*\s*;")
_UNIFORM = re.compile(r"uniform\s+(?:(?:lowp|mediump|highp)\s+)?(\w+)\s+\w+\s*(\[?)")
_BLOCK = re.compile(r"uniform\s+(?!struct\b)(\w+)\s*\{([^{}]*)\}\s*(\w*)\s*;")
_STRUCT = re.compile(r"uniform\s+struct\b")
_HINT = rf"(?:{'|'.join(HINTS)})\b\s*" + r"""(?:\((?:"[^"\n]*"|[^()"])*\))?"""
_HINTS = re.compile(rf":\s*{_HINT}(?:\s*,\s*{_HINT})*")
_DEFAULT = re.compile(r"=(?:\((?:[^()]|\([^()]*\))*\)|[^;,()])*")
_DECLARATION = re.compile(r"uniform\b(?://[^\n]*|/\*.*?\*/|[^;{}])*;", re.DOTALL)
_BASIC = re.compile(r"float|u?int|bool|[iub]?vec[234]|mat[234](?:x[234])?|[iu]?sampler\w*")
_DROPPED = frozenset(
    {"in", "out", "varying", "attribute", "flat", "smooth", "noperspective", "centroid", "sample", "invariant"}
)

_SHADOW_READS = ("shadow2D", "shadow2DLod", "shadow2DProj")
"""Builtins of GLSL 1.20 that later versions lack: they return a vec4, so that a new name is not enough."""


class Plain(NamedTuple):
    """A text without a stage."""

    version: str
    """Its `#version`, such as `300 es`; '' without one."""
    text: str
    """The text without `#version`, for our front end."""

    @property
    def is_es(self) -> bool:
        """Whether it is written for OpenGL ES 3."""
        return self.version.endswith("es")

    def for_driver(self, version: str) -> str:
        """The text with this `#version`, without the hints of uniforms, which are no GLSL, and in GLSL ES without their
        default values; old functions get their new names, by macros, or are defined.
        """
        renames = [f"#define {old} {new}" for old, (new, _) in OLD_NAMES.items() if _uses(self.text, old)]
        # what an extension of ES has, drivers of other versions have without it
        extensions = [line.replace("require", "enable") for line in _EXTENSION.findall(self.text)]
        text = _replace(_EXTENSION.sub("", self.text), _without_default if version.endswith("es") else _without_hints)
        precision = _ES_PRECISION if version.endswith("es") else []
        definitions = [OUT_BUILTINS[name].strip() for name in _SHADOW_READS if _uses(self.text, name)]
        return "\n".join([f"#version {version}", *extensions, *precision, *definitions, *renames, text])


_ES_PRECISION = [
    # drivers compute some of these in 16 bits, which no other language has to
    *("#define lowp highp", "#define mediump highp"),
    *(
        f"precision highp {type_};"
        for type_ in ("float", "int", "sampler2D", "sampler3D", "samplerCube", "sampler2DArray", "sampler2DShadow")
    ),
]


def plain(text: str) -> Plain:
    """The text as functions and variables."""
    version = _VERSION.search(text)
    body = without_interface(_VERSION.sub("", text, count=1))
    renamed = {name: new for name, (_, new) in STAGE.items() if _uses(body, name)}
    head = [f"{STAGE[name][0]} {new}{_length(name, body)};" for name, new in renamed.items()]
    renamed |= {"main": MAIN} if _uses(body, "main") else {}
    head += [f"#define {name} {new}" for name, new in renamed.items()]
    tail = [f"#undef {name}" for name in renamed]  # the text that follows has its own main
    return Plain(f"{version[1]} {version[2]}".strip() if version else "", "\n".join([*head, body, *tail, ""]))


def _length(name: str, text: str) -> str:
    """The length of `gl_FragData` as far as a text uses it: drivers have no value in what is not written."""
    if name != "gl_FragData":
        return ""
    indices = [index[1] for index in _COLOR_INDEX.finditer(text)]
    constant = indices and all(index.isdigit() for index in indices)
    return f"[{1 + max(map(int, indices))}]" if constant else "[8]"


def _uses(text: str, name: str) -> bool:
    """Whether a name occurs in a text that does not define it as a macro."""
    defined = re.search(rf"^[ \t]*#[ \t]*define[ \t]+{name}\b", text, re.MULTILINE)
    return defined is None and re.search(rf"\b{name}\b", text) is not None


def without_interface(text: str) -> str:
    """A text without the qualifiers that connect declarations at file scope with a stage."""
    return _replace(text, _replacement)


def without_functions(text: str, names: Collection[str]) -> str:
    """A text in which the definitions and declarations of these functions are blank lines."""
    parts: list[str] = []
    done = start = 0  # the end of the last kept part, and of the last declaration at file scope
    depth, called = 0, ""
    for match in _PART.finditer(text):
        mark = match["mark"]
        if match["skip"] and match["skip"].lstrip().startswith("#") and depth == 0:
            start, called = match.end(), ""
        elif match["name"] and depth == 0:
            is_function = _CALL.match(text, match.end()) and "=" not in text[start : match.start()]
            called = called or (match[0] if is_function else "")
        elif mark in ("{", "("):
            depth += 1
        elif mark in ("}", ")"):
            depth -= 1
        if depth == 0 and mark in ("}", ";"):
            if called in names:
                parts += [text[done:start], "\n" * text.count("\n", start, match.end())]
                done = match.end()
            start, called = match.end(), ""
    return "".join([*parts, text[done:]])


def _replace(text: str, replacement: Callable[[str, re.Match[str]], tuple[str, int] | None]) -> str:
    """A text with what `replacement` gives for the names at file scope: a text and the end of what it replaces."""
    parts: list[str] = []
    depth = done = 0
    branches: list[int] = []  # the depth at each #if that is open: a bracket may be open in each of its branches
    for match in _PART.finditer(text):
        if match.start() < done:
            continue
        if directive := _CONDITION.match(match[0]):
            if directive[1].startswith("if"):
                branches.append(depth)
            elif branches and directive[1] == "endif":
                branches.pop()
            elif branches:
                depth = branches[-1]
        elif match["mark"]:
            depth += {"{": 1, "(": 1, "}": -1, ")": -1}.get(match["mark"], 0)
        elif match["name"] and depth == 0:
            replaced = replacement(text, match)
            if replaced is not None:
                parts += [text[done : match.start()], replaced[0]]
                done = replaced[1]
    parts.append(text[done:])
    return "".join(parts)


def _without_hints(text: str, name: re.Match[str]) -> tuple[str, int] | None:
    """The declaration of uniforms at a name without their hints; None where there is none."""
    declaration = _DECLARATION.match(text, name.start())
    return (_HINTS.sub("", declaration[0]), declaration.end()) if declaration else None


def _without_default(text: str, name: re.Match[str]) -> tuple[str, int] | None:
    """The declaration of uniforms at a name without their hints and default values; None where there is none."""
    hintless = _without_hints(text, name)
    return (_DEFAULT.sub("", hintless[0]), hintless[1]) if hintless else None


def _replacement(text: str, name: re.Match[str]) -> tuple[str, int] | None:
    """The replacement of the declaration or qualifier at a name, and where that ends; None to keep it."""
    if defaults := _DEFAULTS.match(text, name.start()):
        return "", defaults.end()
    if layout := _LAYOUT.match(text, name.start()):
        return "", layout.end()
    if again := _REQUALIFIED.match(text, name.start()):
        return "", again.end()
    if name[0] in _DROPPED or _STRUCT.match(text, name.start()):
        return "", name.end()
    if block := _BLOCK.match(text, name.start()):
        members = _LAYOUT.sub("", block[2])
        return (f"struct {block[1]} {{{members}}} {block[3]};" if block[3] else members), block.end()
    uniform = _UNIFORM.match(text, name.start())
    if uniform and (not _BASIC.fullmatch(uniform[1]) or (uniform[2] and "sampler" not in uniform[1])):
        return "", name.end()
    return None
