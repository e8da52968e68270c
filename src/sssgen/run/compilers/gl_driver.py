"""GLSL in the OpenGL driver, through moderngl: on a machine without a GPU that is Mesa's llvmpipe."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any, NamedTuple

from sssgen.ir.intrinsics import BUILTINS
from sssgen.run.compilers.calling_entry import glsl_entry
from sssgen.run.compilers.compiler_interface import Compiler, CompilerMissing, Message, Severity, Source
from sssgen.run.compilers.shadertoy_page import as_program
from sssgen.support.installation import install_hint

_ES = "#version 300 es\nprecision highp float;\nprecision highp sampler3D;\n"
_HEADERS = {
    "glsl-330": "#version 330\n",
    "glsl-es-300": _ES,
    "shadertoy": _ES,
}
_LATER_FUNCTIONS = "|".join(name for name, row in BUILTINS.items() if row.later_glsl)
_LATER = re.compile(rf"\b(?:{_LATER_FUNCTIONS})\(|\bbuffer\s+\w+\s*\{{|\buniform\s+[iu]?image")
"""What functions have of GLSL 4.30; whole shaders state their version."""
_DIRECTIVE = re.compile(r"^[ \t]*#[ \t]*(?:version|extension)\b[^\n]*", re.MULTILINE)
_STRUCT = re.compile(r"^[ \t]*struct \w+\s*\{[^{}]*\};", re.MULTILINE)
_BASIC = re.compile(r"float|u?int|[iu]?vec[234]|mat[234](?:x[234])?")
_EGL: Any = {"backend": "egl"}
_SEVERITY: dict[str, Severity] = {"error": "error", "warning": "warning"}


def with_version(text: str, language: str) -> str:
    """`text` with the language's `#version` in front where it has none; line numbers stay as they were."""
    if re.search(r"^\s*#\s*version\b", text, re.MULTILINE):
        return text
    return later_version(f"{_HEADERS[language]}#line 1\n", text) + text


def later_version(head: str, text: str) -> str:
    """A head with #version 330 as one with 430 where the functions below it need that."""
    return head.replace("#version 330", "#version 430") if _LATER.search(text) else head


class DriverGL(Compiler):
    """Compiles and links with the system's OpenGL driver."""

    name = "gl"

    def __init__(self, context: Any) -> None:
        self.context = context
        self._version = f"OpenGL {context.info['GL_VERSION']} on {context.info['GL_RENDERER']}"

    def version(self) -> str:
        return self._version

    def check(self, source: Source) -> list[Message]:
        text = with_version(as_program(source), source.language)
        if source.stage == "library":
            text = glsl_entry(text)
        if source.stage == "compute":
            return _in_text(messages(log), source.text) if (log := self._compute(text)) else []
        if source.stage == "vertex":
            vertex, fragment = text, source.companion or _empty_fragment(source.language)
        else:
            vertex, fragment = source.companion or _matching_vertex(text, source.language), text
        log = self._link(vertex, fragment)
        if log and source.companion:
            own_messages = self.check(replace(source, companion=""))
            # messages about the other stage are reported with that stage
            return own_messages or ([] if "Compiler failed" in log else messages(log))
        if log:
            return _in_text(messages(log), source.text)
        return _missing_outputs(vertex, fragment) if source.companion else []

    def _compute(self, text: str) -> str:
        """The driver's messages about a compute shader; '' where it compiles."""
        try:
            with self.context:
                self.context.compute_shader(text).release()
        except Exception as error:
            return str(error) or type(error).__name__
        return ""

    def _link(self, vertex: str, fragment: str) -> str:
        """The driver's messages about two stages that do not compile or link; '' where they do."""
        try:
            with self.context:  # other libraries (wgpu) make contexts of their own current
                self.context.program(vertex_shader=vertex, fragment_shader=fragment).release()
        except Exception as error:
            return str(error) or type(error).__name__
        return ""


def find() -> Compiler:
    """The driver behind an off-screen context.

    Raises CompilerMissing where moderngl or a driver for it is lacking.
    """
    try:
        import moderngl
    except ImportError:
        raise CompilerMissing(install_hint("gl")) from None
    try:
        return DriverGL(moderngl.create_context(standalone=True, **_EGL))
    except Exception as egl:
        try:
            return DriverGL(moderngl.create_context(standalone=True))  # Windows and macOS have no EGL
        except Exception:
            packages = "libegl1 libgl1 libgl1-mesa-dri"
            raise CompilerMissing(f"an OpenGL driver (Debian: {packages}): {egl}") from None


def _empty_fragment(language: str) -> str:
    return f"{_HEADERS[language]}out vec4 sssgen_check;\nvoid main() {{ sssgen_check = vec4(0.0); }}\n"


class _Passed(NamedTuple):
    """An `in` or `out` variable of a stage, in the parts of its declaration."""

    layout: str
    flat: str
    precision: str
    type: str
    name: str
    lengths: str

    @property
    def key(self) -> str:
        """What the other stage has to declare, too: its location where it states one, else its name."""
        return re.sub(r"\s", "", self.layout) or self.name


def _interface(text: str, direction: str) -> list[_Passed]:
    """The stage's `in` or `out` variables."""
    pattern = rf"(?:^|;)[ \t]*(layout\s*\([^)]*\)\s*)?((?:flat|smooth|centroid)\s+)?{direction}\s+"
    pattern += r"((?:highp|mediump|lowp)\s+)?(\w+)\s+(\w+)\s*((?:\[\w+\]\s*)*);"
    return [_Passed(*parts) for parts in re.findall(pattern, text, re.MULTILINE)]


def _missing_outputs(vertex: str, fragment: str) -> list[Message]:
    """Fragment inputs that the vertex stage does not write: undefined, and no error in desktop OpenGL."""
    written = {variable.key for variable in _interface(vertex, "out")}
    names = [variable.name for variable in _interface(fragment, "in") if variable.key not in written]
    return [Message("error", 0, 0, f"the vertex stage does not write the fragment's {name}") for name in names]


def _matching_vertex(fragment: str, language: str) -> str:
    """A vertex stage that feeds the `in` variables of `fragment`, so that it links on its own."""
    inputs = _interface(fragment, "in")
    lines = _DIRECTIVE.findall(fragment) or [_HEADERS[language].rstrip("\n")]
    lines += [f"precision highp {kind};" for kind in ("float", "int") if language in ("glsl-es-300", "shadertoy")]
    types = {variable.type for variable in inputs}
    lines += _STRUCT.findall(fragment) if any(re.search(rf"struct {name}\b", fragment) for name in types) else []
    lines += [f"{each.layout}{each.flat}out {each.precision}{each.type} {each.name}{each.lengths};" for each in inputs]
    written = [each for each in inputs if not each.lengths and _BASIC.fullmatch(each.type)]
    lines += ["void main() {", *(f"    {each.name} = {each.type}(0);" for each in written)]
    return "\n".join([*lines, "    gl_Position = vec4(0.0);", "}", ""])


def _in_text(parsed: list[Message], text: str) -> list[Message]:
    """Messages with columns of the text: Mesa's preprocessor joins spaces before it counts columns."""
    lines = text.split("\n")
    return [
        replace(m, column=_column(lines[m.line - 1], m.column)) if m.column and 0 < m.line <= len(lines) else m
        for m in parsed
    ]


def _column(line: str, reported: int) -> int:
    starts = [piece.start() for piece in re.finditer(r"\s+|\S", line)]
    return starts[reported - 1] + 1 if 0 < reported <= len(starts) else 0


def messages(log: str) -> list[Message]:
    """The messages in a log. Mesa has `0:4(18): error: …`, NVIDIA `0(4) : error C1008: …`, the linker `error: …`."""
    all_messages = []
    for line in log.splitlines():
        if match := re.match(r"\d+:(\d+)\((\d+)\): (error|warning): (.*)", line):
            all_messages.append(Message(_SEVERITY[match[3]], int(match[1]), int(match[2]), match[4]))
        elif match := re.match(r"\d+\((\d+)\) : (error|warning) (.*)", line):
            all_messages.append(Message(_SEVERITY[match[2]], int(match[1]), 0, match[3]))
        elif match := re.match(r"(?:ERROR: \d+:(\d+): |error: )(.*)", line):
            all_messages.append(Message("error", int(match[1] or 0), 0, match[2]))
    # Mesa lists every overload of the function that did not fit; the first line names it
    relevant = [m for m in all_messages if not m.text.startswith("   ") and "sssgen_check" not in m.text]
    return relevant or all_messages or [Message("error", 0, 0, log.strip())]
