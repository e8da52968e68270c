"""Compiles files of public shader code: whether a file counts, and its result for every target and compiler.

A file counts if glslang accepts it. A file without `#version` is read as version 4.50 of the compatibility profile,
which also has `varying`, `texture2D` and `gl_FragColor`. A file with a version is read as that version and, if that
fails, as 4.50. A file without `main` gets an empty `main`; a Shadertoy scene gets the uniforms and the `main` of the
site.
"""

from __future__ import annotations

import re
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import Queue
from typing import Any, NamedTuple

from sssgen.analyse.verify.inline_includes import expand
from sssgen.analyse.verify.stage_variables import without_interface
from sssgen.lang.plain_glsl import load_glsl
from sssgen.lang.shadertoy import UNIFORMS
from sssgen.pipeline.compiler import transpile
from sssgen.run import compilers
from sssgen.run.check.handwritten import hand_written
from sssgen.run.compilers import Source, errors
from sssgen.run.compilers.calling_entry import glsl_entry
from sssgen.run.compilers.gl_driver import with_version
from sssgen.support.diagnostics import SssgenError
from sssgen.support.text_files import read_code
from sssgen.support.worker_process import LostError, Process

READ = "read"
"""The name of the step before the targets."""
BATCH = 40
"""The number of texts that a process of glslang compiles."""
SECONDS = 60.0
"""The time limit of a glslang process."""

COMPILERS = {
    "wgsl": ("naga", "tint"),
    "hlsl": ("glslang", "dxc"),
    "glsl-330": ("glslang",),
    "glsl-es-300": ("glslang",),
}
"""Target → the compilers that must accept it."""
BATCHED = {("glslang", "glsl-330"), ("glslang", "glsl-es-300")}
"""(compiler, target) pairs that are checked in batches, outside of the worker processes."""

_STAGES = {"vertex": "vert", "fragment": "frag", "library": "frag"}
_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)
_VERSION = re.compile(r"^\s*#\s*version[^\n]*\n?", re.MULTILINE)
_SCENE_MAIN = "\nvoid main() { vec4 color; mainImage(color, gl_FragCoord.xy); gl_FragColor = color; }\n"


class Code(NamedTuple):
    """A file before transpilation."""

    path: Path
    text: str
    """The text, with its includes expanded."""

    @property
    def is_scene(self) -> bool:
        """Whether it is a Shadertoy scene: it has `mainImage` and no `main`."""
        bare = _COMMENT.sub(" ", self.text)
        return re.search(r"\bvoid\s+mainImage\s*\(", bare) is not None and not _has_main(bare)

    @property
    def stage(self) -> str:
        return "vert" if self.path.suffix in (".vert", ".vs") else "frag"


class TargetResult(NamedTuple):
    """The result of one target for a file."""

    source: Source | None
    """The emitted text with its entry; None if there is none."""
    problem: str
    """Why there is no text, or the error of a compiler outside of the batches (`compiler: message`); '' if none."""


def read(path: Path, folders: Sequence[Path]) -> Code:
    """A file with its includes, which are also searched in `folders`. A file with a missing include cannot compile."""
    try:
        return Code(path, expand(read_code(path, path.as_posix()), path, folders))
    except SssgenError as error:
        return Code(path, f"#error {error.diagnostics[0].message}\n")


def file_errors(codes: Sequence[Code]) -> list[str]:
    """The error of glslang for each file; '' if the file counts."""
    reported = _in_batches([(code.stage, _whole(code, own_version=True)) for code in codes])
    again = [index for index, message in enumerate(reported) if message and _VERSION.search(codes[index].text)]
    for index, message in zip(
        again, _in_batches([(codes[i].stage, _whole(codes[i], own_version=False)) for i in again]), strict=True
    ):
        reported[index] = message
    return reported


def glslang(sources: Sequence[Source]) -> list[str]:
    """The error of glslang for each emitted GLSL text; '' if glslang accepts it."""
    return _in_batches([(_STAGES[source.stage], _with_entry(source)) for source in sources])


def _with_entry(source: Source) -> str:
    text = with_version(source.text, source.language)
    return glsl_entry(text) if source.stage == "library" else text


def preprocessed(code: Code) -> str:
    """The whole program without directives, as version 4.50, for a front end that reads Vulkan's GLSL.

    Inputs, outputs, and uniforms other than textures become variables, because Vulkan requires layouts that the code
    does not have.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"whole.{code.stage}"
        path.write_text(_whole(code, own_version=False), "utf-8")
        command = ["glslangValidator", "-E", str(path)]
        process = subprocess.run(command, capture_output=True, encoding="utf-8", errors="replace", timeout=SECONDS)
    body = "\n".join(line for line in process.stdout.splitlines() if not line.lstrip().startswith("#"))
    body = re.sub(r"\buniform\s+(?!(?:(?:low|medium|high)p\s+)?[iu]?sampler)", "", without_interface(body))
    color = "vec4 pixel_color;\n" if "gl_FragColor" in body else ""
    body = re.sub(r"\bgl_FragColor\b", "pixel_color", body)
    return f"#version 450\n{color}{body}\n"


def _whole(code: Code, own_version: bool) -> str:
    """The whole program that glslang compiles."""
    version = _VERSION.search(code.text) if own_version else None
    head = version[0] if version else "#version 450 compatibility\n"
    text = _VERSION.sub("\n", code.text, count=1)
    scene = code.is_scene
    tail = _SCENE_MAIN if scene else "" if _has_main(_COMMENT.sub(" ", text)) else "\nvoid main() {}\n"
    return head + (_scene_uniforms(text) if scene else "") + text + tail


def _scene_uniforms(text: str) -> str:
    """Declarations of the uniforms that a scene uses and does not declare."""
    named = [line for name, line in UNIFORMS.items() if re.search(rf"\b{name}\b", text)]
    lines = [line.split(";")[0] for line in named]
    return "".join(f"{line};\n" for line in lines if not re.search(rf"{re.escape(line)}\s*;", text))


def _has_main(bare: str) -> bool:
    return re.search(r"\bvoid\s+main\s*\(", bare) is not None


def _in_batches(programs: Sequence[tuple[str, str]]) -> list[str]:
    """The first error of each (stage, text); '' if there is none."""
    results: list[str] = []
    for start in range(0, len(programs), BATCH):
        results += _batch(programs[start : start + BATCH])
    return results


def _batch(programs: Sequence[tuple[str, str]]) -> list[str]:
    """The errors from one process. If it crashes, each text gets its own process."""
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder) / f"{number}.{stage}" for number, (stage, _) in enumerate(programs)]
        for path, (_, text) in zip(paths, programs, strict=True):
            path.write_text(text, "utf-8")
        command = ["glslangValidator", *map(str, paths)]
        try:
            process = subprocess.run(command, capture_output=True, encoding="utf-8", errors="replace", timeout=SECONDS)
        except subprocess.TimeoutExpired:
            process = None
    if process is None or process.returncode < 0:
        if len(programs) == 1:
            return ["glslang crashed or exceeded its time"]
        return [message for program in programs for message in _batch([program])]
    if process.returncode == 0:
        return [""] * len(programs)
    messages = ["glslang reported nothing"] * len(programs)
    number = -1
    for line in process.stdout.splitlines():
        if number + 1 < len(paths) and line.strip() == str(paths[number + 1]):
            number += 1
            messages[number] = ""
        elif line.startswith("ERROR:") and number >= 0 and not messages[number]:
            messages[number] = re.sub(r"^ERROR: (?:[^:]*:\d+: )?", "", line).strip()
    return messages


Question = tuple[str, tuple[object, ...]]
"""The name of a function, `target_results` or `naga_glsl`, and its arguments."""


def naga_glsl(text: str, stage: str) -> str:
    """The error of naga's own front end for GLSL; '' where it accepts the text."""
    import wgpu

    try:
        compilers.get("naga").gpu.create_shader_module(label=stage, code=text)  # type: ignore[attr-defined]
    except wgpu.GPUError as error:
        lines = [line.strip() for line in str(error).splitlines() if line.strip()]
        return next((line for line in reversed(lines) if "error" in line.lower() or ":" in line), lines[-1])
    return ""


class Pool:
    """Worker processes. If one crashes or hangs, only the result of its file is lost."""

    def __init__(self, jobs: int, module: str, seconds: float) -> None:
        self.free: Queue[Process] = Queue()
        self.processes = [Process(module, "", seconds=seconds) for _ in range(jobs)]
        for process in self.processes:
            self.free.put(process)
        self.threads = ThreadPoolExecutor(jobs)

    def ask(self, function: str, inputs: Sequence[tuple[object, ...]]) -> list[Any]:
        """The results of a function of the module, in order; a LostError where the process was lost."""
        return list(self.threads.map(lambda arguments: self._ask((function, arguments)), inputs))

    def _ask(self, question: object) -> Any:
        process = self.free.get()
        try:
            return process.ask(question)
        except LostError as lost:
            return lost
        finally:
            self.free.put(process)

    def close(self) -> None:
        """Ends the processes."""
        for process in self.processes:
            process.close()
        self.threads.shutdown()


def serve(_: str) -> tuple[str, Callable[[Question], object]]:
    """The entry of a worker process. It transpiles files and keeps the compilers loaded."""

    def answer(question: Question) -> object:
        function, arguments = question
        return _FUNCTIONS[function](*arguments)

    return "ready", answer


def target_results(code: Code, folders: Sequence[Path], targets: Sequence[str]) -> dict[str, TargetResult]:
    """Target → its text, and the errors of the compilers in this process; {"": …} if the file cannot be read."""
    try:
        entry = "shadertoy" if code.is_scene else ""
        module = load_glsl(code.path, code.path.name, tuple(folders), entry=entry).module
    except Exception as error:
        return {"": TargetResult(None, reason_of(error))}
    results = {}
    for target in targets:
        try:
            files = transpile(module, target, "file", keep=True).files
        except Exception as error:
            results[target] = TargetResult(None, reason_of(error))
            continue
        text = "\n".join(text for name, text in files.items() if not name.endswith(".json"))
        source = hand_written(text, target, "file")[0]
        results[target] = TargetResult(source, next(_complaints(source), ""))
    return results


def _complaints(source: Source) -> Iterator[str]:
    for name in COMPILERS[source.language]:
        if (name, source.language) not in BATCHED:
            for message in errors(compilers.get(name).check(source))[:1]:
                yield f"{name}: {message.text}"


def reason_of(error: Exception) -> str:
    """The message of an error that sssgen reports, or a description of any other exception."""
    if isinstance(error, SssgenError):
        return error.diagnostics[0].message
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    place = f" in {Path(trace.tb_frame.f_code.co_filename).name}" if trace is not None else ""
    return f"BROKEN: {type(error).__name__}{place}: {error}"


def without_names(message: str) -> str:
    """A message without its names and numbers, so that equal problems are counted together."""
    message = re.sub(r"'[^']*'|\"[^\"]*\"|`[^`]*`", "'…'", message.splitlines()[0] if message else "")
    return re.sub(r"\d+", "N", message)[:150]


_FUNCTIONS: dict[str, Callable[..., object]] = {function.__name__: function for function in (target_results, naga_glsl)}
