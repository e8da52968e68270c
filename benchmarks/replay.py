"""Emits the same materials and techniques with two states of sssgen and shows every text that differs.

    python benchmarks/replay.py OLD [NEW]

OLD and NEW are folders of the project or git commits; the default of NEW is this folder. Both states emit, for every
target and without a cache, the examples of OLD in both forms, and each technique of their own library, with and
without guards. Exit status: 0 if all texts are equal, 1 if a text differs.
"""

from __future__ import annotations

import argparse
import difflib
import json
import os
import re
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path
from typing import Any

EXTRACTION: dict[str, Any] = {"filter": "data"} if hasattr(tarfile, "data_filter") else {}
"""Python before 3.11.4 has no extraction filters."""

ROOT = Path(__file__).resolve().parent.parent
FORMS = ("shader", "functions")
GUARDS = ("auto", "none")
DIFFERENCE_LINES = 40
"""The number of lines that are printed of each difference."""


def checkout(state: str, place: Path) -> Path:
    """The folder of a state of the project. The files of a commit are extracted to `place`."""
    if Path(state).is_dir():
        return Path(state).resolve()
    archive = place.with_suffix(".tar")
    subprocess.run(["git", "-C", str(ROOT), "archive", "--output", str(archive), state], check=True)
    with tarfile.open(archive) as files:
        files.extractall(place, **EXTRACTION)
    return place


def emitted(project: Path, materials: Path, out: Path) -> dict[str, str]:
    """The texts that a state of the project emits for the example materials in `materials` and for its techniques."""
    environment = {**os.environ, "PYTHONPATH": str(project / "src"), "SSSGEN_CACHE": "", "PYTHONUTF8": "1"}
    command = [sys.executable, __file__, "--emit", str(out)]
    subprocess.run(command, cwd=materials, env=environment, check=True)
    texts: dict[str, str] = json.loads(out.read_text(encoding="utf-8"))
    return texts


def texts_of_this_state() -> dict[str, str]:
    """The texts of the sssgen that is imported, for the examples of the current folder and for all techniques."""
    import sssgen
    from sssgen.material import library
    from sssgen.pipeline import compiler

    try:
        from sssgen.run.evaluate import probes
    except ImportError:  # the folders of earlier states
        from sssgen.harness.evaluate import probes

    texts: dict[str, str] = {}
    materials = [path for path in sorted(Path().glob("examples/*/*.toml")) if path.stem == path.parent.name]
    for path in materials:
        for target in sssgen.all_targets():
            for form in FORMS:
                try:
                    files = sssgen.compile(path.as_posix(), target, form).files
                except sssgen.SssgenError as error:
                    files = {"error": str(error)}
                for file, text in files.items():
                    texts[f"{path.stem}/{form}/{file}"] = text
    for name in library.index():
        subject = probes.subject(name)
        for target in sssgen.all_targets():
            for guards in GUARDS:
                try:
                    files = compiler.transpile(
                        subject.module, target, name, guards, subject.called, chained=subject.chained
                    ).files
                except sssgen.SssgenError as error:
                    files = {"error": str(error)}
                for file, text in files.items():
                    texts[f"{name}/guards {guards}/{target}/{file}"] = text
    return texts


def renamed(text: str, old: str, new: str) -> str:
    """A text with a name replaced in the spellings of all targets."""
    for spelled in (str, str.upper, lambda name: "".join(part.capitalize() for part in name.split("_"))):
        text = text.replace(spelled(old), spelled(new))
    return text


def code(name: str, text: str) -> str:
    """A text without comments and spaces, a reflection without documentation and places in sources."""
    if name.endswith(".json"):
        return json.dumps(_without_places(json.loads(text)), indent=1)
    text = re.sub(r"/\*.*?\*/|//[^\n]*", "", text, flags=re.DOTALL)
    if name.endswith(".py"):
        text = re.sub(r'""".*?"""|#[^\n]*', "", text, flags=re.DOTALL)
    return re.sub(r"([;{}])", "\\1\n", "".join(text.split()))


def _without_places(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_places(item) for key, item in value.items() if key not in ("doc", "source_map", "at")}
    return [_without_places(item) for item in value] if isinstance(value, list) else value


def main() -> int:
    """Compares the two states; returns the exit status."""
    if sys.argv[1:2] == ["--emit"]:  # in the process of one state
        Path(sys.argv[2]).write_text(json.dumps(texts_of_this_state()), encoding="utf-8")
        return 0
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("OLD")
    parser.add_argument("NEW", nargs="?", default=str(ROOT))
    parser.add_argument("--code", action="store_true", help="ignore comments, documentation, spaces and source places")
    parser.add_argument("--rename", metavar="OLD=NEW", action="append", default=[], help="a name that NEW renamed")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        old, new = checkout(arguments.OLD, work / "old"), checkout(arguments.NEW, work / "new")
        before, after = emitted(old, old, work / "before.json"), emitted(new, old, work / "after.json")
    for old_name, _, new_name in (rename.partition("=") for rename in arguments.rename):
        before = {renamed(name, old_name, new_name): renamed(text, old_name, new_name) for name, text in before.items()}
    if arguments.code:
        before, after = ({name: code(name, text) for name, text in texts.items()} for texts in (before, after))
    names = sorted(before.keys() | after.keys())
    differing = [name for name in names if before.get(name) != after.get(name)]
    for name in differing:
        texts = [result.get(name, "").splitlines() for result in (before, after)]
        lines = list(difflib.unified_diff(*texts, f"old/{name}", f"new/{name}", lineterm="", n=1))
        more = len(lines) - DIFFERENCE_LINES
        print("\n".join(lines[:DIFFERENCE_LINES]), f"\n… {more} more lines\n" if more > 0 else "\n")
    print(f"{len(differing)} of {len(names)} texts differ")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
