"""The results of one stage of an engine's program, in a worker process: its translation, its verification."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from time import process_time
from typing import Any

from public_code import READ, reason_of
from sssgen.analyse.verify.machines import Machines, start_machines
from sssgen.analyse.verify.verification import verify
from sssgen.analyse.verify.verified_function import Options
from sssgen.lang.plain_glsl import load_glsl, preprocess_text
from sssgen.pipeline.compiler import transpile
from sssgen.run import compilers
from sssgen.run.check.handwritten import hand_written
from sssgen.run.compilers import errors
from sssgen.support.text_files import read_text

TARGET = "wgsl"
COMPILERS = ("naga", "tint")
Question = tuple[str, tuple[object, ...]]


def digest(path: Path) -> str:
    """The hash of the tokens after the preprocessor: stages that differ in comments or unused macros are equal."""
    tokens = preprocess_text(read_text(path, path.name), path.name).tokens
    words = [path.suffix, *(token.text for token in tokens)]
    return hashlib.sha256("\n".join(words).encode()).hexdigest()[:20]


def translation(path: Path) -> dict[str, Any]:
    """`kilobytes` of source, `seconds` of CPU from it to WGSL, and the `problem` of the translation or a compiler."""
    result: dict[str, Any] = {"kilobytes": path.stat().st_size / 1000.0}
    start = process_time()
    step = READ
    try:
        module = load_glsl(path, path.name).module
        step = TARGET
        files = transpile(module, TARGET, "stage", keep=True).files
    except Exception as error:
        return result | {"problem": f"{step}: {reason_of(error)}"}
    result["seconds"] = process_time() - start
    text = "\n".join(text for name, text in files.items() if not name.endswith(".json"))
    source = hand_written(text, TARGET, "stage")[0]
    for name in COMPILERS:
        for message in errors(compilers.get(name).check(source))[:1]:
            return result | {"problem": f"{name}: {message.text}"}
    return result


_machines: list[Machines] = []
"""The back ends of this process, once they were needed."""


def verification(path: Path, samples: int) -> dict[str, Any]:
    """The result of `--verify` for main(): `problem` where it does not run or does not agree; the largest deviation."""
    if not _machines:
        context = start_machines()
        _machines.append(context.__enter__())  # until the process ends
    try:
        text = read_text(path, path.name)
        (row,) = verify(text, path.name, Options(samples, function="main"), machines=_machines[0]).rows
    except Exception as error:
        return {"problem": f"not run: {reason_of(error)}"}
    if row.reason:
        return {"problem": f"not run: {row.reason}"}
    result: dict[str, Any] = {"lanes": row.lanes - row.undefined}
    for name, comparison in row.comparisons.items():
        if comparison.error:
            return result | {"problem": f"{name} does not run: {comparison.error}"}
        result[name] = comparison.deviation
        if not comparison.ok:
            result |= {"problem": f"{name} deviates", "at": comparison.at}
    return result


def serve(_: str) -> tuple[str, Callable[[Question], object]]:
    """The entry of a worker process."""

    def answer(question: Question) -> object:
        function, arguments = question
        return _FUNCTIONS[function](*arguments)

    return "ready", answer


_FUNCTIONS: dict[str, Callable[..., object]] = {
    function.__name__: function for function in (digest, translation, verification)
}
