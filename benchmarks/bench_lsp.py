"""Measures the language server: `make bench`, or python benchmarks/bench_lsp.py [EDITS [KIND]].

For each kind of file: the time from a changed text to its problems, and that of an explanation, as a share of the goal
(50 ms and 10 ms). Every edit gives a text that was not read before. A row has the median and the largest of all files
of the kind, and the 99th percentile of the explanations of their names: the examples, techniques, and the shaders of
the examples as plain GLSL. The second table has the milliseconds of the costs and proofs above functions and stages,
which are computed once the text is left alone. The last rows change one file of each kind EDITS times (default: 1,000),
or one of a KIND (technique, material, scene, glsl), and show the memory of the process after the first and the second
half.
"""

from __future__ import annotations

import os
import re
import statistics
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from sssgen.editor.documents import GLSL, MATERIAL, SCENE, TECHNIQUE
from sssgen.editor.hover import hover_at
from sssgen.editor.lenses import lenses_of
from sssgen.editor.open_documents import OpenDocuments
from sssgen.editor.preparation import prepare
from sssgen.material import library
from sssgen.material.material_loading import examples
from sssgen.pipeline.compiler import compile

ROUNDS = 5
DIAGNOSTICS, HOVER = 0.050, 0.010
"""The goals in seconds."""

_NAME = re.compile(r"[A-Za-z_]\w+")


def texts(folder: Path) -> Iterator[tuple[str, str, str]]:
    """Kind, path and text of each file."""
    for path in library.index().values():
        yield TECHNIQUE, path, Path(path).read_text("utf-8")
    for name, path in examples().items():
        yield MATERIAL, path, Path(path).read_text("utf-8")
        scene = Path(path).with_name("scene.toml")
        if scene.is_file():
            yield SCENE, str(scene), scene.read_text("utf-8")
        for file, text in compile(name, "glsl-330").files.items():
            if file.endswith((".frag", ".vert")):
                yield GLSL, str(folder / file), text


def edited(path: str, text: str, number: int) -> str:
    """The text with another comment behind it."""
    mark = "#" if path.endswith(".toml") else "//"
    return f"{text.rstrip()} {mark} {number}\n"


def diagnosis(documents: OpenDocuments, path: str, text: str) -> float:
    """Seconds from a new text to its problems, the median of several."""
    times = []
    for number in range(ROUNDS):
        new = edited(path, text, number)
        start = time.perf_counter()
        documents.change(path, new)
        assert not documents.problems(path), path
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def hovers(documents: OpenDocuments, path: str) -> list[float]:
    """Seconds of the explanation of each name of a file, at most 40."""
    found = documents.get(path)
    assert found is not None
    times = []
    for number, line in enumerate(found[0].lines):
        for match in _NAME.finditer(line):
            start = time.perf_counter()
            hover_at(*found, number, match.start())
            times.append(time.perf_counter() - start)
    return times[:: max(1, len(times) // 40)]


def lens_time(documents: OpenDocuments, path: str) -> float:
    """Seconds of the costs and proofs of a file."""
    found = documents.get(path)
    assert found is not None
    start = time.perf_counter()
    lenses_of(*found)
    return time.perf_counter() - start


def resident() -> float:
    """Megabytes that the process has in memory."""
    status = Path("/proc/self/status")
    if not status.is_file():
        return float("nan")
    match = re.search(r"VmRSS:\s+(\d+)", status.read_text())
    return int(match.group(1)) / 1024 if match else float("nan")


def main() -> None:
    edits = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    documents = OpenDocuments()
    for _ in prepare():  # as the server does before the first request
        pass
    with tempfile.TemporaryDirectory() as folder:
        files = list(texts(Path(folder)))
        rows: dict[str, tuple[list[float], list[float]]] = {}
        slowest: dict[str, tuple[float, str]] = {}
        lenses: dict[str, list[float]] = {}
        for kind, path, text in files:
            first, second = rows.setdefault(kind, ([], []))
            first.append(diagnosis(documents, path, text))
            second += hovers(documents, path)
            lenses.setdefault(kind, []).append(lens_time(documents, path))
            slowest[kind] = max(slowest.get(kind, (0.0, "")), (first[-1], Path(path).name))
            documents.close(path)
        print(f"{'':10} {'files':>5}   problems, of 50 ms      explanation, of 10 ms")
        print(f"{'':10} {'':5}   {'median':>8} {'largest':>8}      {'median':>8} {'99 of 100':>8}  largest")
        for kind, (first, second) in rows.items():
            cells = [statistics.median(first) / DIAGNOSTICS, max(first) / DIAGNOSTICS]
            cells += [statistics.median(second) / HOVER, sorted(second)[len(second) * 99 // 100] / HOVER]
            shares = f"{cells[0]:8.0%} {cells[1]:8.0%}      {cells[2]:8.0%} {cells[3]:8.0%}"
            print(f"{kind:10} {len(first):5}   {shares}  {slowest[kind][1]}")
        print(f"\ncosts and proofs, in ms\n{'':10} {'median':>8} {'largest':>8}")
        for kind, times in lenses.items():
            print(f"{kind:10} {statistics.median(times) * 1e3:8.0f} {max(times) * 1e3:8.0f}")
        print(f"\nmemory in MB, at the start and after {edits // 2} and {edits} edits of one file")
        for kind in sys.argv[2:] or rows:
            path, text = next((path, text) for own, path, text in files if own == kind)
            sizes = [resident()]
            for number in range(edits):
                documents.change(path, edited(path, text, 10_000 + number))
                documents.problems(path)
                if number + 1 in (edits // 2, edits):
                    sizes.append(resident())
            documents.close(path)
            print(f"{kind:10} {'  '.join(f'{size:7.0f}' for size in sizes)}")


if __name__ == "__main__":
    os.environ.setdefault("SSSGEN_CACHE", "")
    main()
