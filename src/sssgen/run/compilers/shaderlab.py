"""Reads Unity's ShaderLab as far as a check needs it: the properties, the passes, and the HLSL inside them.

Unity's own ShaderLab parser is not available outside of the editor, so this one refuses what the manual
rules out (docs.unity3d.com, "ShaderLab: defining material properties"): an unbalanced brace, a
block that does not end, a property of an unknown type, or one whose default does not fit its type.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from sssgen.ir.types import with_article
from sssgen.run.compilers.compiler_interface import Message

_BLOCK = re.compile(r"^[ \t]*(CG|HLSL)(PROGRAM|INCLUDE)\b[ \t]*\n(.*?)^[ \t]*END(CG|HLSL)\b", re.DOTALL | re.MULTILINE)
_STRAY = re.compile(r"^[ \t]*(?:CG|HLSL)(?:PROGRAM|INCLUDE)\b|^[ \t]*END(?:CG|HLSL)\b", re.MULTILINE)
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_NUMBERS = rf"\((?:\s*{_NUMBER}\s*,){{2,3}}\s*{_NUMBER}\s*\)"  # three or four
_PROPERTY = re.compile(
    r"\s*((?:\[[^\]]*\]\s*)*)(\w+)\s*\(\s*\"[^\"\n]*\"\s*,\s*(Range\s*\([^()]*\)|\w+)\s*\)\s*=\s*"
    rf"({_NUMBER}|\([^()]*\)|\"\w*\"\s*(?:\{{[^{{}}]*\}})?)"
)
_DIRECTIVE = re.compile(
    r"^[ \t]*#[ \t]*(pragma|if|ifdef|ifndef|elif|else|endif)\b[ \t]*(.*?)[ \t]*(?://.*)?$", re.MULTILINE
)
_VERSION = re.compile(r"UNITY_VERSION\s*>=\s*(\d+)")
_DEFAULTS = {
    "float": _NUMBER, "int": _NUMBER, "integer": _NUMBER, "range": _NUMBER,
    "color": _NUMBERS, "vector": _NUMBERS,
    "2d": r"\".*", "3d": r"\".*", "cube": r"\".*", "2darray": r"\".*", "cubearray": r"\".*",
}  # fmt: skip
_TEXTURES = frozenset({"2d", "3d", "cube", "2darray", "cubearray"})


class _Branch(NamedTuple):
    """A branch of a preprocessor's condition."""

    of_versions: bool
    """Whether its #if compares versions."""
    taken: bool
    before: bool
    """Whether a branch before it was taken."""


@dataclass(frozen=True)
class Program:
    """One CGPROGRAM or HLSLPROGRAM: its HLSL after the shared INCLUDE blocks, and its pragmas.

    `code` carries `#line` directives, so that compilers report the lines of the .shader file.
    """

    code: str
    dialect: str  # "CG" | "HLSL"; Unity includes its own headers into CG only
    name: str
    pragmas: tuple[tuple[str, str], ...]

    def pragma(self, key: str) -> str | None:
        """The text after the first `#pragma KEY`."""
        return next((value for k, value in self.pragmas if k == key), None)

    def keywords(self) -> list[str]:
        """Every keyword of the pragmas, in the order of the text."""
        lines = [_keywords(key, value, stage) for key, value in self.pragmas for stage in ("vertex", "fragment")]
        if self.pragma("multi_compile_fog") is not None:
            lines.append(["FOG_LINEAR", "FOG_EXP", "FOG_EXP2"])
        return list(dict.fromkeys(word for words in lines for word in words if word))

    def keyword_sets(self, stage: str) -> list[list[str]]:
        """Variants that contain every pair of choices of two `multi_compile` or `shader_feature` lines.

        The full product has thousands; most mistakes need two keywords at most.
        """
        lists = [choices for key, value in self.pragmas if (choices := _keywords(key, value, stage))]
        return [[word for word in row if word] for row in _pairwise(lists)]


@dataclass
class Shader:
    """A parsed .shader file."""

    properties: dict[str, str] = field(default_factory=dict)  # name → type in lower case
    programs: list[Program] = field(default_factory=list)
    messages: list[Message] = field(default_factory=list)

    def scalar_properties(self) -> list[str]:
        """The properties in a constant buffer: all but textures."""
        return [name for name, kind in self.properties.items() if kind not in _TEXTURES]


def parse(text: str, name: str, version: int) -> Shader:
    """The shader in `text` as UNITY_VERSION `version` reads it; errors of its ShaderLab are in `messages`."""
    shader = Shader()
    text = text.replace("\r\n", "\n")
    shell = _BLOCK.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), text)
    shell = re.sub(r"//[^\n]*|/\*.*?\*/", lambda m: re.sub(r"[^\n]", " ", m[0]), shell, flags=re.DOTALL)
    for stray in _STRAY.finditer(shell):
        shader.messages.append(_error(shell, stray.start(), f"{stray[0].strip()} without its other end"))
    _check_braces(shell, shader.messages)
    if not re.match(r'\s*Shader\s*"[^"\n]+"\s*\{', shell):
        shader.messages.append(Message("error", 1, 1, 'a shader begins with Shader "Path/Name" {'))
    _read_properties(shell, shader)
    shared = ""
    for block in _BLOCK.finditer(text):
        line = text.count("\n", 0, block.start(3)) + 1
        code = f'#line {line} "{name}"\n{block[3]}\n'
        if block[2] == "INCLUDE":
            shared += code
            continue
        names = re.findall(r'\bName\s*"([^"]*)"', shell[: block.start()])
        pragmas = tuple(_pragmas(shared + code, version))
        number = len(shader.programs) + 1
        pass_name = names[-1] if names else f"pass {number}"
        shader.programs.append(Program(shared + code, block[1], pass_name, pragmas))
    if not shader.programs:
        shader.messages.append(Message("error", 1, 1, "no CGPROGRAM or HLSLPROGRAM"))
    return shader


def _pragmas(code: str, version: int) -> Iterator[tuple[str, str]]:
    """The pragmas, each as its first word and the rest.

    Those in a branch for other versions are left out. Unity's preprocessor evaluates no other condition around a pragma
    that a shader may have; a branch of another condition counts as taken.
    """
    branches: list[_Branch] = []  # of each open #if
    for directive, value in _DIRECTIVE.findall(code):
        limit = _VERSION.fullmatch(value)
        if directive.startswith("if"):
            branches.append(_Branch(limit is not None, limit is None or version >= int(limit[1]), False))
        elif directive == "endif" and branches:
            branches.pop()
        elif directive in ("elif", "else") and branches:
            last = branches.pop()
            before = last.of_versions and (last.before or last.taken)
            holds = limit is None or version >= int(limit[1])
            branches.append(_Branch(last.of_versions, holds and not before, before))
        elif directive == "pragma" and all(branch.taken for branch in branches):
            word, _, rest = value.partition(" ")
            yield word, rest.strip()


def _pairwise(lists: list[list[str]]) -> list[list[str]]:
    """Rows, one choice from each list, that cover every pair of choices: greedy, and the same each time."""
    list_pairs = [(i, j) for j in range(len(lists)) for i in range(j)]
    uncovered = {(i, a, j, b) for i, j in list_pairs for a in lists[i] for b in lists[j]}
    rows = [[choices[0] for choices in lists]]
    if len(lists) == 1:
        return [[choice] for choice in lists[0]]
    while uncovered := {(i, a, j, b) for i, a, j, b in uncovered if not any(r[i] == a and r[j] == b for r in rows)}:
        i, a, j, b = min(uncovered)
        row = [choices[0] for choices in lists]
        row[i], row[j] = a, b
        chosen = {i, j}
        for k in (k for k in range(len(lists)) if k not in chosen):
            related = [pair for pair in uncovered if k in (pair[0], pair[2])]
            gains = [sum(_agrees(row, chosen, k, choice, pair) for pair in related) for choice in lists[k]]
            row[k] = lists[k][gains.index(max(gains))]
            chosen.add(k)
        rows.append(row)
    return rows


def _agrees(row: list[str], chosen: set[int], k: int, choice: str, pair: tuple[int, str, int, str]) -> bool:
    """Whether `choice` at place `k` completes `pair` with a place that is settled."""
    i, a, j, b = pair
    other, value, required = (j, b, a) if i == k else (i, a, b)
    return required == choice and other in chosen and row[other] == value


def _keywords(pragma: str, value: str, stage: str) -> list[str]:
    """The variants of one pragma line for a stage; Unity's shorthands are replaced by their usual keywords."""
    words = ["" if set(word) == {"_"} else word for word in value.split()]
    if pragma.endswith({"vertex": "_fragment", "fragment": "_vertex"}[stage]):
        return []
    kind = re.sub(r"_(?:local|vertex|fragment)", "", pragma)
    if kind == "multi_compile":
        return words
    if kind == "shader_feature":
        return ["", *words] if len(words) == 1 else words
    return {
        "multi_compile_fog": ["", "FOG_LINEAR"],
        "multi_compile_instancing": ["", "INSTANCING_ON"],
        "multi_compile_fwdbase": ["DIRECTIONAL"],
        "multi_compile_fwdadd": ["POINT", "DIRECTIONAL"],
        "multi_compile_fwdadd_fullshadows": ["POINT", "DIRECTIONAL"],
        "multi_compile_shadowcaster": ["SHADOWS_DEPTH"],
    }.get(pragma, [])


def _read_properties(shell: str, shader: Shader) -> None:
    block = re.search(r"\bProperties\s*\{", shell)
    if not block:
        return
    position = block.end()
    while True:
        while position < len(shell) and shell[position].isspace():
            position += 1
        if shell[position : position + 1] in ("}", ""):
            return
        match = _PROPERTY.match(shell, position)
        if not match:
            line = shell[position:].split("\n", 1)[0].strip()
            shader.messages.append(_error(shell, position, f"not a property: {line}"))
            return
        name, kind, default = match[2], re.sub(r"\s*\(.*", "", match[3]).lower(), match[4]
        if kind not in _DEFAULTS:
            shader.messages.append(_error(shell, match.start(3), f"unknown property type {match[3]}"))
        elif not re.fullmatch(_DEFAULTS[kind], default, re.DOTALL):
            message = f"{default} is not a default of {with_article(match[3])}"
            shader.messages.append(_error(shell, match.start(4), message))
        if name in shader.properties:
            shader.messages.append(_error(shell, match.start(2), f"property {name} is declared twice"))
        shader.properties[name] = kind
        position = match.end()


def _check_braces(shell: str, messages: list[Message]) -> None:
    depth = 0
    for match in re.finditer(r'[{}]|"[^"\n]*"', shell):
        depth += (match[0] == "{") - (match[0] == "}")
        if depth < 0:
            messages.append(_error(shell, match.start(), "} without {"))
            return
    if depth:
        messages.append(_error(shell, len(shell.rstrip()), f"{depth} brace(s) not closed"))


def _error(text: str, position: int, message: str) -> Message:
    line = text.count("\n", 0, position) + 1
    return Message("error", line, position - text.rfind("\n", 0, position), message)
