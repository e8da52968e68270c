"""Coverage-guided bytes for the front ends: atheris, https://github.com/google/atheris, where it is installed.

    python tests/fuzz/atheris_front_ends.py source CORPUS -max_total_time=60

CORPUS is a folder, which is made and filled with good files; atheris adds to it. A crash is written to `crash-…`.
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import atheris

sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))

with atheris.instrument_imports(include=["sssgen"]):
    from front_ends import FRONT_ENDS, survives
    from sssgen.support import cache


def main() -> None:
    name, corpus, *options = sys.argv[1:]
    front_end, folder = FRONT_ENDS[name], Path(corpus)
    folder.mkdir(parents=True, exist_ok=True)
    for number, seed in enumerate(front_end.seeds()):
        (folder / f"seed{number}").write_bytes(seed)
    cache.folder = lambda: ""  # each file is another
    with TemporaryDirectory() as work:
        atheris.Setup([sys.argv[0], corpus, *options], lambda content: survives(front_end, content, Path(work)))
        atheris.Fuzz()


if __name__ == "__main__":
    main()
