"""The lines that each target consists of: its descriptor and its own templates; and those of the whole project.

    python benchmarks/target_sizes.py [OLD]

OLD, a folder of the project or a git commit, adds the lines of that state. What several targets share is counted in
the last rows alone: `targets/shared/`, `templates/common/`, lists of reserved words, runtimes in JavaScript, printers.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path

from replay import ROOT, checkout


def lines(paths: Iterable[Path]) -> int:
    return sum(len(path.read_text(encoding="utf-8").splitlines()) for path in paths if path.is_file())


def sizes(project: Path) -> dict[str, int]:
    """A row's name → its number of lines in a state of the project."""
    names = [path.stem for path in (project / "targets").glob("*.toml")]
    rows = {}
    for name in sorted(names):
        rows[name] = lines([project / "targets" / f"{name}.toml", *(project / "templates" / name).rglob("*")])
    rows["all templates"] = lines((project / "templates").rglob("*"))
    rows["all descriptors, with lists of words"] = lines((project / "targets").rglob("*"))
    rows["runtimes in JavaScript"] = lines((project / "src" / "sssgen" / "targets" / "javascript").glob("*.js"))
    rows["shells, in the project's language"] = lines((project / "src" / "sssgen" / "shells").rglob("*.sss"))
    rows["Python of src/sssgen"] = lines((project / "src" / "sssgen").rglob("*.py"))
    return rows


def main() -> None:
    with tempfile.TemporaryDirectory() as temporary:
        states = [checkout(state, Path(temporary) / "old") for state in sys.argv[1:2]]
        columns = [sizes(state) for state in [*states, ROOT]]
    print(f"{'':38}" + "".join(f"{title:>8}" for title in ["before", "now"][-len(columns) :]))
    for name in columns[-1]:
        print(f"{name:38}" + "".join(f"{column.get(name, 0):>8}" for column in columns))


if __name__ == "__main__":
    main()
