"""Compiles every shader under a folder with every compiler for its language, and prints a table of who took
what.

    python -m sssgen.harness.report out/

Exit status 1 where a shader does not compile, and, where the environment variable CI is set, where a
compiler is missing.
"""

from __future__ import annotations

import sys
from pathlib import Path

from sssgen.harness import compilers
from sssgen.harness.compilers import Message, Source
from sssgen.harness.sources import sources


def main(folder: str) -> int:
    """Report on `folder` to standard output; the exit status."""
    import os

    root = Path(folder)
    files = {}
    for path in sorted(p for p in root.rglob("*") if p.is_file() and p.suffix != ".json"):
        files[path.relative_to(root).as_posix()] = path.read_text(encoding="utf-8")
    found = sources(files)
    if not found:
        print(f"nothing to compile in {folder}")
        return 1
    results = {source: compilers.check(source) for source in found}
    names = [name for name in compilers.LANGUAGES if any(name in compilers.readers(s.language) for s in found)]
    _print_table(results, names)
    failures = sum(_print_failures(source, told) for source, told in results.items())
    lacking = [(name, how) for name, how in compilers.missing() if name in names]
    compiled = sum(map(len, results.values()))
    print(f"{len(files)} files, {len(found)} programs, {compiled} compilations, {failures} failed")
    for compiler in compilers.available():
        if compiler.name in names:
            print(f"  {compiler.name:8} {compiler.version()}")
    for name, how in lacking:
        print(f"  {name:8} MISSING: {how}")
    return 1 if failures or (lacking and os.environ.get("CI", "") not in ("", "0", "false")) else 0


def _print_table(results: dict[Source, dict[str, list[Message]]], names: list[str]) -> None:
    """One line a file; the cell of a file with several programs is the worst of them."""
    rows: dict[str, dict[str, str]] = {}
    for source, told in results.items():
        row = rows.setdefault(source.name, {})
        for name in compilers.readers(source.language):
            cell = "missing" if name not in told else "FAIL" if compilers.errors(told[name]) else "ok"
            if row.get(name) != "FAIL":
                row[name] = cell
    width = max(map(len, rows))
    print(f"{'':{width}}  " + "  ".join(f"{name:7}" for name in names).rstrip())
    for file, row in rows.items():
        print(f"{file:{width}}  " + "  ".join(f"{row.get(name, '-'):7}" for name in names).rstrip())
    print()


def _print_failures(source: Source, told: dict[str, list[Message]]) -> int:
    failures = 0
    for name, messages in told.items():
        wrong = compilers.errors(messages)
        failures += bool(wrong)
        for message in wrong[:8]:
            print(f"{name}: {source.name} ({source.stage}): {message}")
    return failures


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:2] or ["out"]))
