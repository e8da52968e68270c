"""The cases of WebGL's conformance tests: pages with shaders, and files beside them, as their owner publishes them.

- A page of `GLSLConformanceTester` lists programs with what has to compile and to link; what it renders has to be of
  one color. It has the shaders in elements `<script>`.
- Another page of WebGL 2 draws with pairs of shaders that are valid.
- A page of `ogles` lists pairs of programs that draw the same picture, and programs that build or do not.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

from qualification.suites.text_cases import TextCase

TESTS = "sdk/tests"
PAGES = ("conformance/glsl", "conformance2")
OGLES = "conformance/ogles"
_SCRIPT = re.compile(r"<script\b([^>]*)>(.*?)</script>", re.DOTALL)
_ID = re.compile(r"""\bid\s*=\s*["']?([\w-]+)""")
_SHADER = re.compile(r"x-shader|not-javascript")
_INFO = re.compile(r"\{(?:[^{}\[\]]|\[(?:[^{}\[\]]|\{[^{}]*\}|\[[^\[\]]*\])*\])*\}")
_CALL = re.compile(r"\brun(Render)?Tests?\s*\(")
_WORD = re.compile(r"""\b([vf])Shader(Id|Success)\s*:\s*(?:["']([^"']+)["']|(true|false))""")
_UNIFORM = re.compile(r"""name:\s*["']([^"']+)["'],\s*functionName:\s*["']\w+["'],\s*value:\s*(\[[^\]]*\]|[-\d.]+)""")
_PAIR = re.compile(r"""\[\s*["']([\w-]+)["']\s*,\s*["']([\w-]+)["']\s*\]""")
_RUN = re.compile(r"OpenGLESTestRunner\.run\((.*?)\);\s*var successfullyParsed", re.DOTALL)
_TAIL = re.compile(r",(\s*[}\]])")
GREEN = (0, 255, 0, 255)


class PictureCase(NamedTuple):
    """Programs with a picture."""

    name: str
    programs: tuple[tuple[str, str], ...]
    """Vertex and fragment shader: one program with a color, or the reference and the program that draws the same"""
    color: tuple[int, ...] = GREEN
    tolerance: float = 0.0
    """Of a channel from 0 to 255"""
    uniforms: Mapping[str, tuple[float, ...]] = {}
    model: str = ""
    """Of ogles: `square`, `grid` or `frontbacksquare`"""
    skipped: str = ""
    """Why it cannot be drawn here; '' where it can"""


WebglCase: TypeAlias = TextCase | PictureCase


def cases(root: Path) -> Iterator[WebglCase]:
    """The cases of the repository in a folder."""
    tests = root / TESTS
    for folder in PAGES:
        for path in sorted((tests / folder).rglob("*.html")):
            yield from page_cases(path.read_text("utf-8", errors="replace"), path.relative_to(tests).as_posix())
    for path in sorted((tests / OGLES).rglob("*.html")):
        yield from ogles_cases(path, path.relative_to(tests).with_suffix("").as_posix())


def page_cases(page: str, name: str) -> Iterator[WebglCase]:
    """The cases of a page."""
    scripts = _SCRIPT.findall(page)
    shaders = {id_[1]: text for head, text in scripts if _SHADER.search(head) and (id_ := _ID.search(head))}
    code = "\n".join(text for head, text in scripts if not _SHADER.search(head))
    if "GLSLConformanceTester" in page:
        yield from _tested(shaders, code, name)
        return
    seen = [pair for pair in _PAIR.findall(code) if all(id_ in shaders for id_ in pair)]
    for vertex, fragment in dict.fromkeys(seen):
        texts = shaders[vertex], shaders[fragment]
        if _version(texts[0]) == _version(texts[1]) == "300" and "$(" not in "".join(texts):
            case = f"{name}#{vertex},{fragment}"
            valid = "bad" not in fragment  # a page that expects an error calls it that
            yield TextCase(case, "shader.frag", texts[1].lstrip(), texts[0].lstrip(), valid=valid)


def _tested(shaders: Mapping[str, str], code: str, name: str) -> Iterator[WebglCase]:
    """The programs of a page of GLSLConformanceTester."""
    if re.search(r"GLSLConformanceTester\.run\w*Test\(\)", code):
        yield from _described(shaders, name)
    calls = [(match.start(), bool(match[1])) for match in _CALL.finditer(code)]
    for info in _INFO.finditer(code):
        words = {kind + key: text or flag for kind, key, text, flag in _WORD.findall(info[0])}
        ids = [words.get(f"{kind}Id", "") for kind in "vf"]
        if not any(ids) or any(id_ and id_ not in shaders for id_ in ids) or "Source" in info[0]:
            continue
        vertex, fragment = _with_default(*(shaders[id_] if id_ else "" for id_ in ids))
        case = f"{name}#{','.join(id_ for id_ in ids if id_)}"
        valid = [words.get(f"{kind}Success", "true") == "true" for kind in "vf"]
        links = not re.search(r"\blinkSuccess\s*:\s*false", info[0])
        rendered = next((render for start, render in reversed(calls) if start < info.start()), False)
        if not (all(valid) and links):
            text = TextCase(case, "shader.frag", fragment, vertex, valid=False)
            yield text if all(valid) else _one_of(text, valid)
        elif rendered or re.search(r"\brender\s*:\s*true", info[0]):
            yield _rendered(case, vertex, fragment, info[0])
        else:
            yield TextCase(case, "shader.frag", fragment, vertex)


def _rendered(name: str, vertex: str, fragment: str, info: str) -> PictureCase:
    """A program that renders one color."""
    color = re.search(r"renderColor\s*:\s*\[([^\]]*)\]", info)
    tolerance = re.search(r"renderTolerance\s*:\s*(\d+)", info)
    uniforms = {key: tuple(map(float, re.findall(r"[-\d.]+", value))) for key, value in _UNIFORM.findall(info)}
    return PictureCase(
        name,
        ((vertex, fragment),),
        tuple(map(int, color[1].split(","))) if color else GREEN,
        float(tolerance[1]) if tolerance else 0.0,
        uniforms,
        skipped="its uniform blocks come from a buffer" if "uniformBlocks" in info else "",
    )


def _described(shaders: Mapping[str, str], name: str) -> Iterator[TextCase]:
    """The program of a page with the ids `vertexShader` and `fragmentShader`: the first line says if it is valid."""
    given = [shaders.get(id_, "").strip() + "\n" for id_ in ("vertexShader", "fragmentShader")]
    valid = ["fail" not in text.partition("\n")[0] for text in given]
    vertex, fragment = _with_default(*(text if text.strip() else "" for text in given))
    faulty = all(valid) and re.search(r"\battribute\b", fragment)
    skipped = "the page's fragment shader has an attribute, which GLSL does not allow" if faulty else ""
    text = TextCase(name, "shader.frag", fragment, vertex, valid=all(valid), skipped=skipped)
    if any(word.strip() for word in given):
        yield text if all(valid) else _one_of(text, valid)


def _one_of(case: TextCase, valid: list[bool]) -> TextCase:
    """The stage of a program that must fail."""
    if valid[0]:
        return case._replace(vertex="")
    return case._replace(label="shader.vert", text=case.vertex, vertex="") if valid[1] else case


def _version(text: str) -> str:
    match = re.match(r"\s*#version (\d+)", text)
    return match[1] if match else ""


def _with_default(vertex: str, fragment: str) -> tuple[str, str]:
    """The stages of a program, of which one may be left out."""
    is_new = _version(vertex or fragment) == "300"
    head, word = ("#version 300 es\n", "in") if is_new else ("", "attribute")
    color = "out mediump vec4 shown;\n" if is_new else ""
    vertex = vertex or f"{head}{word} vec4 vPosition;\nvoid main() {{ gl_Position = vPosition; }}\n"
    shown = "shown" if is_new else "gl_FragColor"
    fragment = fragment or f"{head}{color}void main() {{ {shown} = vec4(1.0, 0.0, 0.0, 1.0); }}\n"
    return with_version(vertex), with_version(fragment)


_STATED = re.compile(r"\s*#\s*version|(?:\s|/\*.*?\*/|//[^\n]*)*#\s*version\s+100\b", re.DOTALL)
"""A version at the head of a text; that of GLSL ES 1.00 may be below comments."""


def with_version(text: str) -> str:
    """A text with its version, which is 1.00 in WebGL where it says nothing."""
    return text if _STATED.match(text) or not text.strip() else f"#version 100\n{text}"


def ogles_cases(path: Path, name: str) -> Iterator[WebglCase]:
    """The cases of a page of ogles."""
    run = _RUN.search(path.read_text("utf-8"))
    tests: list[dict[str, Any]] = json.loads(_TAIL.sub(r"\1", run[1]))["tests"] if run else []
    for test in tests:
        case = f"{name}/{test['name'].partition('.')[0]}"
        if test["pattern"] == "compare":
            programs = [test[key] for key in ("referenceProgram", "testProgram")]
            values = {
                key: tuple(value["value"]) for program in programs for key, value in program.get("uniforms", {}).items()
            }
            texts = tuple(_stages(path.parent, program) for program in programs)
            skipped = "it sets the range of depths" if test.get("state") else ""
            yield PictureCase(case, texts, (), _OGLES_TOLERANCE, values, test.get("model") or "square", skipped)
        else:
            vertex, fragment = _stages(path.parent, test["testProgram"])
            if vertex and fragment:
                valid = bool(test["compstat"] and test["linkstat"])
                yield TextCase(case, "shader.frag", fragment, vertex, valid=valid)


_OGLES_TOLERANCE = 24.0
"""The suite's own limit."""


def _stages(folder: Path, program: Mapping[str, str]) -> tuple[str, str]:
    """The texts of a program; '' for a stage without a file."""
    files = [folder / program[key] for key in ("vertexShader", "fragmentShader")]
    vertex, fragment = (with_version(file.read_text("utf-8")) if file.is_file() else "" for file in files)
    return vertex, fragment
