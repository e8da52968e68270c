"""An entry point for text that has none, which calls every function once.

Compilers check unused functions less: GL drivers drop them, DXC makes no code for them, and
WGSL's uniformity analysis reports only what an entry point reaches. So a library is checked through
calls, with arguments that are not uniform, except the level of detail, which a material's functions branch
on. The entry is appended: the library's own line numbers stay true.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from sssgen.material.chain_assembly import DETAIL_LEVEL

_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*|^[ \t]*#(?:\\\n|[^\n])*", re.DOTALL | re.MULTILINE)
_C_FUNCTION = re.compile(r"([A-Za-z_]\w*)\s+([A-Za-z_]\w*)\s*\(([^()]*)\)\s*(?::\s*\w+\s*)?\{\}")
_WGSL_FUNCTION = re.compile(r"((?:@\w+(?:\([^()]*\))?\s*)*)\bfn\s+(\w+)\s*\(([^{}]*?)\)\s*(?:->\s*([^{}]+?))?\s*\{\}")
_OPAQUE = re.compile(r"[iu]?sampler|(?:RW)?Texture|Sampler|texture_")
Opaque = tuple[str, str]
"""For a type that has no local variables: a global declaration and an argument; `{0}` is the name in both."""

_QUALIFIERS = frozenset({"in", "out", "inout", "const", "uniform", "precise", "highp", "mediump", "lowp"})


@dataclass(frozen=True)
class Function:
    """A function's name and its parameters, each (type, name, array suffix)."""

    name: str
    parameters: tuple[tuple[str, str, str], ...]
    returns: str = "void"


def functions(text: str, wgsl: bool = False) -> list[Function]:
    """The functions that `text` defines at its top level; in WGSL without the entry points."""
    top = _top_level(text)
    if wgsl:
        matches = [m for m in _WGSL_FUNCTION.finditer(top) if "@" not in m[1]]
        return [Function(m[2], tuple(_wgsl_parameter(p) for p in _split(m[3])), m[4] or "void") for m in matches]
    return [Function(m[2], tuple(_c_parameter(p) for p in _split(m[3])), m[1]) for m in _C_FUNCTION.finditer(top)]


def glsl_entry(text: str) -> str:
    """`text` with a `main` that calls each of its functions, for a fragment stage."""
    body, opaque = _c_calls(functions(text), "uniform highp {1} {0};", {})
    entry = "out highp vec4 sssgen_check_color;"
    return _append(text, [*opaque, entry, "void main() {", *body, "    sssgen_check_color = vec4(0.0);", "}"])


def gdshader_entry(text: str) -> str:
    """`text` as a spatial shader of Godot whose `fragment` calls each of its functions."""
    body, uniforms = _c_calls(functions(text), "uniform {1} {0};", {})
    return f"shader_type spatial; {_append(text, [*uniforms, 'void fragment() {', *body, '}'])}"


def hlsl_entry(text: str, opaque: dict[str, Opaque] | None = None) -> str:
    """`text` with a fragment entry that calls each of its functions; `opaque` adds to the texture types."""
    body, globals_ = _c_calls(functions(text), "{1} {0};", opaque or {})
    head = "float4 sssgen_check_main(float4 sssgen_check_position : SV_Position) : SV_Target0 {"
    return _append(text, [*globals_, head, *body, "    return float4(0.0, 0.0, 0.0, 1.0);", "}"])


def wgsl_entry(text: str) -> str:
    """`text` with a fragment entry that calls each of its functions; unchanged where it has an entry."""
    if re.search(r"@(?:vertex|fragment|compute)\b", _COMMENT.sub("", text)):
        return text
    globals_: list[str] = []
    body: list[str] = []
    for i, function in enumerate(functions(text, wgsl=True)):
        arguments = []
        for j, (kind, parameter, _) in enumerate(function.parameters):
            name = f"sssgen_check_{i}_{j}"
            pointer = re.fullmatch(r"ptr<\s*\w+\s*,\s*(.+?)\s*>", kind)
            if _OPAQUE.match(kind):
                globals_.append(f"@group(3) @binding({len(globals_)}) var {name}: {kind};")
            elif parameter.endswith(DETAIL_LEVEL):
                globals_.append(f"@group(3) @binding({len(globals_)}) var<uniform> {name}: {kind};")
            else:
                globals_.append(f"var<private> {name}: {pointer[1] if pointer else kind};")
            if pointer:
                body.append(f"    var {name}_p = {name};")
            arguments.append(f"&{name}_p" if pointer else name)
        call = f"{function.name}({', '.join(arguments)});"
        body.append(f"    {call}" if function.returns == "void" else f"    _ = {call}")
    head = "@fragment fn sssgen_check_main() -> @location(0) vec4<f32> {"
    return _append(text, [*globals_, head, *body, "    return vec4<f32>(0.0);", "}"])


def _append(text: str, lines: list[str]) -> str:
    return text.rstrip("\n") + "\n\n" + "\n".join(lines) + "\n"


def _c_calls(library: list[Function], declare: str, opaque: dict[str, Opaque]) -> tuple[list[str], list[str]]:
    """(statements that call every function, global declarations for what cannot be local)."""
    body: list[str] = []
    globals_: list[str] = []
    for i, function in enumerate(library):
        arguments = []
        for j, (kind, _, array) in enumerate(function.parameters):
            name = f"sssgen_check_{i}_{j}"
            declaration, argument = opaque.get(kind, (declare, "{0}"))
            if kind in opaque or _OPAQUE.match(kind):
                globals_.append(declaration.format(name, kind))
            else:
                body.append(f"    {kind} {name}{array};")
            arguments.append(argument.format(name))
        body.append(f"    {function.name}({', '.join(arguments)});")
    return body, globals_


def _top_level(text: str) -> str:
    """`text` without comments, preprocessor lines, and the text between braces."""
    pieces: list[str] = []
    depth = 0
    for piece in re.split(r"([{}])", _COMMENT.sub(" ", text)):
        if piece == "{":
            depth += 1
            if depth == 1:
                pieces.append("{")
        elif piece == "}":
            depth -= 1
            if depth == 0:
                pieces.append("}")
        elif depth == 0:
            pieces.append(piece)
    return "".join(pieces)


def _split(parameters: str) -> list[str]:
    """At the commas that are not inside `<>` or `()`."""
    parts, depth, current = [], 0, ""
    for character in parameters:
        depth += (character in "<(") - (character in ">)")
        if character == "," and depth == 0:
            parts.append(current)
            current = ""
        else:
            current += character
    return [p.strip() for p in [*parts, current] if p.strip() not in ("", "void")]


def _c_parameter(text: str) -> tuple[str, str, str]:
    text = re.sub(r"\s*:\s*\w+\s*$", "", text)
    array = "".join(re.findall(r"\[[^\]]*\]", text))
    words = [w for w in re.sub(r"\[[^\]]*\]", " ", text).split() if w not in _QUALIFIERS]
    return " ".join(words[:-1]) or words[-1], words[-1], array


def _wgsl_parameter(text: str) -> tuple[str, str, str]:
    name, _, kind = " ".join(text.split()).partition(":")
    return kind.strip(), name.strip(), ""
