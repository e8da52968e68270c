"""Emits the same materials with two states of sssgen and shows every text that differs.

    python benchmarks/replay.py OLD [NEW]

OLD and NEW are folders of the project or git commits; NEW is this folder if it is not given. Both emit the examples of
OLD, for every target, in both forms, without a cache. Exit status: 0 the same, 1 something differs.
"""

from __future__ import annotations

import argparse
import difflib
import os
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SHOWN = 40
"""How many lines of each difference are printed."""


def checkout(state: str, place: Path) -> Path:
    """The folder that holds a state of the project: itself, or a commit's files in `place`."""
    if Path(state).is_dir():
        return Path(state).resolve()
    archive = place.with_suffix(".tar")
    subprocess.run(["git", "-C", str(ROOT), "archive", "--output", str(archive), state], check=True)
    with tarfile.open(archive) as files:
        files.extractall(place, filter="data")
    return place


def emitted(project: Path, materials: Path, out: Path) -> dict[str, str]:
    """The texts that a state of the project makes of the example materials in `materials`, by file name."""
    found = [path for path in sorted(materials.glob("examples/*/*.toml")) if path.stem == path.parent.name]
    names = [path.relative_to(materials).as_posix() for path in found]
    environment = {**os.environ, "PYTHONPATH": str(project / "src"), "SSSGEN_CACHE": ""}
    for form in ("shader", "functions"):
        command = [sys.executable, "-m", "sssgen", "emit", *names, "--target", "all", "--form", form, "-o", str(out)]
        subprocess.run(command, cwd=materials, env=environment, stdout=subprocess.DEVNULL, check=True)
    return {path.relative_to(out).as_posix(): path.read_text("utf-8") for path in sorted(out.rglob("*.*"))}


def main() -> int:
    """Compares; returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("OLD")
    parser.add_argument("NEW", nargs="?", default=str(ROOT))
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        old, new = checkout(arguments.OLD, work / "old"), checkout(arguments.NEW, work / "new")
        before, after = emitted(old, old, work / "before"), emitted(new, old, work / "after")
    differing = [name for name in sorted(before.keys() | after.keys()) if before.get(name) != after.get(name)]
    for name in differing:
        one, other = (texts.get(name, "").splitlines() for texts in (before, after))
        lines = list(difflib.unified_diff(one, other, f"old/{name}", f"new/{name}", lineterm="", n=1))
        print("\n".join(lines[:SHOWN]), f"\n… {len(lines) - SHOWN} more lines\n" if len(lines) > SHOWN else "\n")
    print(f"{len(differing)} of {len(before.keys() | after.keys())} texts differ")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
