"""One file of public shader code: whether it counts, and its result in every target and every compiler.

A file counts where glslang accepts it. One without `#version` is read as 4.50 of the compatibility profile, which
knows `varying`, `texture2D` and `gl_FragColor` too; one with a version as it is, or, where that fails, as 4.50. A file
of functions gets an empty `main`, a Shadertoy scene the uniforms and the `main` that the site gives it.
"""

from __future__ import annotations

import re
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from sssgen.harness import compilers
from sssgen.harness.check.handwritten import hand_written
from sssgen.harness.compilers import Source, errors
from sssgen.harness.compilers.calling_entry import glsl_entry
from sssgen.harness.compilers.gl_driver import with_version
from sssgen.harness.verify.inline_includes import expanded
from sssgen.harness.verify.stage_variables import without_interface
from sssgen.lang.plain_glsl import load_glsl
from sssgen.lang.shadertoy import UNIFORMS
from sssgen.pipeline.compiler import transpile
from sssgen.support.diagnostics import SssgenError
from sssgen.support.text_files import read_text

BATCH = 40
"""Texts to a process of glslang."""
SECONDS = 60.0
"""How long one process of glslang may take."""

COMPILERS = {
    "wgsl": ("naga", "tint"),
    "hlsl": ("glslang", "dxc"),
    "glsl-330": ("glslang",),
    "glsl-es-300": ("glslang",),
}
"""Target → the compilers that must take it."""
BATCHED = {("glslang", "glsl-330"), ("glslang", "glsl-es-300")}
"""What is asked for many texts at once."""

_STAGES = {"vertex": "vert", "fragment": "frag", "library": "frag"}
_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)
_VERSION = re.compile(r"^\s*#\s*version[^\n]*\n?", re.MULTILINE)
_SCENE_MAIN = "\nvoid main() { vec4 color; mainImage(color, gl_FragCoord.xy); gl_FragColor = color; }\n"


class Code(NamedTuple):
    """A file before transpilation."""

    path: Path
    text: str
    """With its includes in it."""

    @property
    def is_scene(self) -> bool:
        """Whether it is one of Shadertoy's: `mainImage` and no `main`."""
        bare = _COMMENT.sub(" ", self.text)
        return re.search(r"\bvoid\s+mainImage\s*\(", bare) is not None and not _has_main(bare)

    @property
    def stage(self) -> str:
        return "vert" if self.path.suffix in (".vert", ".vs") else "frag"


class Made(NamedTuple):
    """The result of one target for a file."""

    source: Source | None
    """The text, with the entry that it has; None where there is none."""
    problem: str
    """Why not, or what a compiler that is not asked in batches says, as `who: message`; '' where all is well."""


def read(path: Path, folders: Sequence[Path]) -> Code:
    """A file with its includes, which are also searched in `folders`; without one of them it does not compile."""
    try:
        return Code(path, expanded(read_text(path, path.as_posix()), path, folders))
    except SssgenError as error:
        return Code(path, f"#error {error.diagnostics[0].message}\n")


def accepted(codes: Sequence[Code]) -> list[str]:
    """glslang's error for each file: '' where it counts."""
    reported = _in_batches([(code.stage, _whole(code, own_version=True)) for code in codes])
    again = [index for index, message in enumerate(reported) if message and _VERSION.search(codes[index].text)]
    for index, message in zip(
        again, _in_batches([(codes[i].stage, _whole(codes[i], own_version=False)) for i in again]), strict=True
    ):
        reported[index] = message
    return reported


def glslang(sources: Sequence[Source]) -> list[str]:
    """glslang's error for each emitted GLSL text: '' where it is accepted."""
    return _in_batches([(_STAGES[source.stage], _with_entry(source)) for source in sources])


def _with_entry(source: Source) -> str:
    text = with_version(source.text, source.language)
    return glsl_entry(text) if source.stage == "library" else text


def preprocessed(code: Code) -> str:
    """The whole program without directives, as 4.50, for a front end of Vulkan's GLSL.

    What Vulkan wants of an interface is no part of the code: what a stage is given and gives, and uniforms but for
    textures, become variables.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"whole.{code.stage}"
        path.write_text(_whole(code, own_version=False), "utf-8")
        command = ["glslangValidator", "-E", str(path)]
        done = subprocess.run(command, capture_output=True, encoding="utf-8", errors="replace", timeout=SECONDS)
    body = "\n".join(line for line in done.stdout.splitlines() if not line.lstrip().startswith("#"))
    body = re.sub(r"\buniform\s+(?!(?:(?:low|medium|high)p\s+)?[iu]?sampler)", "", without_interface(body))
    color = "vec4 color_given;\n" if "gl_FragColor" in body else ""
    body = re.sub(r"\bgl_FragColor\b", "color_given", body)
    return f"#version 450\n{color}{body}\n"


def _whole(code: Code, own_version: bool) -> str:
    """The program that glslang is asked about."""
    version = _VERSION.search(code.text) if own_version else None
    head = version[0] if version else "#version 450 compatibility\n"
    text = _VERSION.sub("\n", code.text, count=1)
    scene = code.is_scene
    tail = _SCENE_MAIN if scene else "" if _has_main(_COMMENT.sub(" ", text)) else "\nvoid main() {}\n"
    return head + (_scene_uniforms(text) if scene else "") + text + tail


def _scene_uniforms(text: str) -> str:
    """Those that a scene names and does not declare."""
    named = [line for name, line in UNIFORMS.items() if re.search(rf"\b{name}\b", text)]
    lines = [line.split(";")[0] for line in named]
    return "".join(f"{line};\n" for line in lines if not re.search(rf"{re.escape(line)}\s*;", text))


def _has_main(bare: str) -> bool:
    return re.search(r"\bvoid\s+main\s*\(", bare) is not None


def _in_batches(programs: Sequence[tuple[str, str]]) -> list[str]:
    """The first complaint about each (stage, text)."""
    results: list[str] = []
    for start in range(0, len(programs), BATCH):
        results += _batch(programs[start : start + BATCH])
    return results


def _batch(programs: Sequence[tuple[str, str]]) -> list[str]:
    """One process; where it fails, one for each text, so that only one has no answer."""
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder) / f"{number}.{stage}" for number, (stage, _) in enumerate(programs)]
        for path, (_, text) in zip(paths, programs, strict=True):
            path.write_text(text, "utf-8")
        command = ["glslangValidator", *map(str, paths)]
        try:
            done = subprocess.run(command, capture_output=True, encoding="utf-8", errors="replace", timeout=SECONDS)
        except subprocess.TimeoutExpired:
            done = None
    if done is None or done.returncode < 0:
        if len(programs) == 1:
            return ["glslang crashed or did not end"]
        return [message for one in programs for message in _batch([one])]
    if done.returncode == 0:
        return [""] * len(programs)
    messages = ["glslang says nothing of it"] * len(programs)
    number = -1
    for line in done.stdout.splitlines():
        if number + 1 < len(paths) and line.strip() == str(paths[number + 1]):
            number += 1
            messages[number] = ""
        elif line.startswith("ERROR:") and number >= 0 and not messages[number]:
            messages[number] = re.sub(r"^ERROR: (?:[^:]*:\d+: )?", "", line).strip()
    return messages


Question = tuple[str, tuple[object, ...]]
"""What is asked, `made` or `naga_glsl`, and its arguments."""


def naga_glsl(text: str, stage: str) -> str:
    """The error of naga's own front end for GLSL; '' where it accepts the text."""
    import wgpu

    try:
        compilers.get("naga").gpu.create_shader_module(label=stage, code=text)  # type: ignore[attr-defined]
    except wgpu.GPUError as error:
        lines = [line.strip() for line in str(error).splitlines() if line.strip()]
        return next((line for line in reversed(lines) if "error" in line.lower() or ":" in line), lines[-1])
    return ""


def serve(_: str) -> tuple[str, Callable[[Question], object]]:
    """For `harness.process`: a process that transpiles files and has the compilers which stay started."""

    def answer(question: Question) -> object:
        what, given = question
        return _ANSWERS[what](*given)

    return "ready", answer


def made(code: Code, folders: Sequence[Path], targets: Sequence[str]) -> dict[str, Made]:
    """Each target's text and the messages of the compilers in this process; {"": …} where the file cannot be read."""
    try:
        entry = "shadertoy" if code.is_scene else ""
        module = load_glsl(code.path, code.path.name, tuple(folders), entry=entry).module
    except Exception as error:
        return {"": Made(None, _reason(error))}
    results = {}
    for target in targets:
        try:
            files = transpile(module, target, "file", keep=True).files
        except Exception as error:
            results[target] = Made(None, _reason(error))
            continue
        text = "\n".join(text for name, text in files.items() if not name.endswith(".json"))
        source = hand_written(text, target, "made")[0]
        results[target] = Made(source, next(_complaints(source), ""))
    return results


def _complaints(source: Source) -> Iterator[str]:
    for name in COMPILERS[source.language]:
        if (name, source.language) not in BATCHED:
            for message in errors(compilers.get(name).check(source))[:1]:
                yield f"{name}: {message.text}"


def _reason(error: Exception) -> str:
    """A readable message, or the exception where there is none."""
    if isinstance(error, SssgenError):
        return error.diagnostics[0].message
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    where = f" in {Path(trace.tb_frame.f_code.co_filename).name}" if trace is not None else ""
    return f"BROKEN: {type(error).__name__}{where}: {error}"


def blank(message: str) -> str:
    """A message without its names and numbers, so that equal reasons are counted together."""
    message = re.sub(r"'[^']*'|\"[^\"]*\"|`[^`]*`", "'…'", message.splitlines()[0] if message else "")
    return re.sub(r"\d+", "N", message)[:150]


_ANSWERS: dict[str, Callable[..., object]] = {"made": made, "naga_glsl": naga_glsl}
