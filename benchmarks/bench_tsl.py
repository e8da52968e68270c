"""Measures the target `tsl` on a library of GLSL functions, such as LYGIA: translation, and agreement in three.js.

    python benchmarks/bench_tsl.py FOLDER [--samples 64] [--jobs 2] [--again] [--reasons 30] [--only TEXT]

A file counts if glslang accepts it (see `public_code`). It is translated with its includes. Then each function of the
file itself runs as written in OpenGL, and as translated in three's WebGPURenderer, on WebGPU and on WebGL 2; included
functions run with their own files. A file agrees if one of its functions runs at least, and none that runs deviates by
more than 1e-5 (see `sssgen transpile --verify` for lanes that are excluded); a file without functions agrees if it is
translated. Each job keeps its Chromium for all of its files. Results are kept in FOLDER/tsl_results.json: a second run
continues, and with `--again` repeats what failed. The library is not part of this project.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from public_code import Code, Pool, file_errors, read, reason_of, without_names
from sssgen.analyse.verify.machines import Machines, start_machines
from sssgen.analyse.verify.verification import verify
from sssgen.analyse.verify.verification_report import Row
from sssgen.analyse.verify.verified_function import Options
from sssgen.lang.plain_glsl import load_glsl
from sssgen.pipeline.compiler import transpile
from sssgen.support.worker_process import LostError

SECONDS = 600.0
"""The time limit of a file."""
TARGET = "tsl"
RENDERERS = {"tsl": "WebGPU", "tsl-gl2": "WebGL 2"}
"""The translations of the verification, with what runs them."""
BACKENDS = ("gl", "tsl", "tsl-webgl2")
BATCH = 8
"""The files after which the results are stored."""
Question = tuple[str, tuple[object, ...]]

_machines: list[Machines] = []
"""The back ends of this process, once they were needed."""


def translation(code: Code, folders: Sequence[Path]) -> dict[str, Any]:
    """The names of the file's own functions, or why it has no translation: `refused`."""
    try:
        module = load_glsl(code.path, code.path.as_posix(), tuple(folders)).module
        transpile(module, TARGET, "file", keep=True)
    except Exception as error:
        return {"refused": reason_of(error)}
    own = [function.name for function in module.functions if function.span.file == code.path.as_posix()]
    return {"functions": list(dict.fromkeys(own))}


def verification(code: Code, functions: Sequence[str], samples: int) -> dict[str, Any]:
    """How each function of these names agrees: `agree`, `deviate` and `not_run`, by overload."""
    if not _machines:
        _machines.append(start_machines(BACKENDS).__enter__())  # until the process ends
    result: dict[str, dict[str, Any]] = {"agree": {}, "deviate": {}, "not_run": {}}
    for name in functions:
        try:
            rows = verify(code.text, code.path.name, Options(samples, function=name), machines=_machines[0]).rows
        except Exception as error:
            result["not_run"][name] = reason_of(error)
            continue
        for row in rows:
            kind, what = _outcome(row)
            result[kind][row.function] = what
    return result


def _outcome(row: Row) -> tuple[str, Any]:
    if row.reason:
        return "not_run", row.reason
    for name, renderer in RENDERERS.items():
        comparison = row.comparisons[name]
        if comparison.error:
            return "deviate", f"{renderer} does not run it: {comparison.error}"
        if not comparison.ok:
            return "deviate", f"{renderer} deviates: {comparison.at}"
    return "agree", [row.comparisons[name].deviation for name in RENDERERS]


def serve(_: str) -> tuple[str, Callable[[Question], object]]:
    """The entry of a worker process."""
    functions: dict[str, Callable[..., object]] = {one.__name__: one for one in (translation, verification)}
    return "ready", lambda question: functions[question[0]](*question[1])


def fill(known: dict[str, Any], step: str, codes: Sequence[Code], arguments: Callable[[Code], tuple[object, ...]],
         run: Run) -> None:  # fmt: skip
    """Adds the results of a step for the files that have none, in batches."""
    name = step
    done = known.setdefault(name, {})
    missing = [code for code in codes if run.key(code) not in done or (run.again and run.failed(done[run.key(code)]))]
    for start in range(0, len(missing), BATCH):
        part = missing[start : start + BATCH]
        for code, answer in zip(part, run.pool.ask(name, [(code, *arguments(code)) for code in part]), strict=True):
            done[run.key(code)] = {"refused": f"the process {answer}"} if isinstance(answer, LostError) else answer
        run.file.write_text(json.dumps(known, indent=1), "utf-8")
        print(f"{name}: {start + len(part)} of {len(missing)}", file=sys.stderr)


class Run:
    """What the steps share."""

    def __init__(self, folder: Path, pool: Pool, again: bool) -> None:
        self.folder, self.pool, self.again = folder, pool, again
        self.file = folder / "tsl_results.json"

    def key(self, code: Code) -> str:
        return code.path.relative_to(self.folder).as_posix()

    def failed(self, result: dict[str, Any]) -> bool:
        return bool("refused" in result or result.get("deviate") or (result.get("not_run") and not result.get("agree")))


def report(keys: Sequence[str], known: dict[str, Any], reasons: int) -> Iterator[str]:
    """The counts, and the most frequent reasons of each kind with a file."""
    translated = {key: known["translation"][key] for key in keys}
    refused = {key: result["refused"] for key, result in translated.items() if "refused" in result}
    verified = {key: known["verification"][key] for key in keys if key in known.get("verification", {})}
    empty = [key for key in keys if key not in refused and not translated[key]["functions"]]
    agree = [key for key, result in verified.items() if result.get("agree") and not result.get("deviate")]
    deviate = {key: next(iter(one["deviate"].values())) for key, one in verified.items() if one.get("deviate")}
    not_run = {
        key: next(iter(result.get("not_run", {"": result.get("refused", "")}).values()))
        for key, result in verified.items()
        if key not in deviate and not result.get("agree")
    }
    agreed, deviated, left = (
        sum(len(one.get(kind, ())) for one in verified.values()) for kind in ("agree", "deviate", "not_run")
    )
    yield f"files                 {len(keys)}"
    yield f"translated            {len(keys) - len(refused)}"
    yield f"verified and agreeing {len(agree) + len(empty)} (of these without functions of their own: {len(empty)})"
    yield f"deviating             {len(deviate)}"
    yield f"not run               {len(not_run)}"
    yield f"functions             {agreed} agree, {deviated} deviate, {left} not run"
    for title, problems in (("refused", refused), ("deviating", deviate), ("not run", not_run)):
        yield f"\n{title}: {len(problems)} files"
        groups = Counter(map(without_names, problems.values()))
        for reason, times in groups.most_common(reasons):
            key, problem = next((key, one) for key, one in problems.items() if without_names(one) == reason)
            yield f"{times:6}  {reason}\n        {key}: {problem.splitlines()[0][:300] if problem else ''}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("FOLDER", nargs="?", type=Path, help="without a folder, nothing is measured")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--reasons", type=int, default=30)
    parser.add_argument("--only", default="", help="the files whose path contains this text")
    options = parser.parse_args()
    if options.FOLDER is None:
        return
    pool = Pool(options.jobs, "bench_tsl", SECONDS)
    try:
        run = Run(options.FOLDER, pool, options.again)
        known: dict[str, Any] = json.loads(run.file.read_text("utf-8")) if run.file.is_file() else {}
        codes = [read(path, (options.FOLDER,)) for path in sorted(options.FOLDER.rglob("*.glsl"))]
        if "valid" not in known:
            errors = file_errors(codes)
            known["valid"] = [run.key(code) for code, error in zip(codes, errors, strict=True) if not error]
        valid = set(known["valid"])
        codes = [code for code in codes if run.key(code) in valid and options.only in run.key(code)]
        fill(known, translation.__name__, codes, lambda code: ((options.FOLDER,),), run)
        functions = {key: result.get("functions") for key, result in known["translation"].items()}
        runnable = [code for code in codes if functions[run.key(code)]]
        fill(known, verification.__name__, runnable, lambda code: (functions[run.key(code)], options.samples), run)
    finally:
        pool.close()
    for line in report([run.key(code) for code in codes], known, options.reasons):
        print(line)


if __name__ == "__main__":
    main()
