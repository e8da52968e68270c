"""Builds the playground, and the demo that the site's first page has of it: build_playground.py FOLDER [NAME …]

It is static: any host serves the folder. Where names of starts are given, only these are built, without the demo.
"""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Collection
from pathlib import Path

from demo import write_demo
from python_bundle import write_bundle
from sssgen.pipeline.compiler import all_targets
from sssgen.presets.preset import presets
from sssgen.presets.preset_list import preset_list
from sssgen.presets.preset_stages import two_units_text
from sssgen.run.web_library import library
from sssgen.support import paths
from starts import all_starts, write_start

PAGE = Path(__file__).with_name("page")
MODULES = Path(paths.PACKAGE, "preview", "page")
"""The modules of the live preview's page; this page uses its stage and its panel."""
IMPORT_MAP = '{"imports": {}}'
"""What the page has in place of its import map."""
FIRST = "skin_ear"
"""What the page shows at first."""


def build(folder: Path, names: Collection[str] = ()) -> int:
    """Writes the playground into an empty folder, and returns the number of its starts. Raises SssgenError."""
    starts = {name: start for name, start in all_starts().items() if not names or name in names}
    first = FIRST if FIRST in starts else next(iter(starts))
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(PAGE, folder)
    for module in (*MODULES.glob("*.js"), MODULES / "panel.css", MODULES / "menus.css"):
        _copy(module, folder / "preview" / module.name)
    libraries = library()
    for name, file in libraries.files.items():
        _copy(file, folder / "library" / name)
    index = (folder / "index.html").read_text(encoding="utf-8")
    (folder / "index.html").write_text(index.replace(IMPORT_MAP, libraries.import_map()), encoding="utf-8")
    write_bundle(folder / "python", starts, first)
    if not names:
        write_demo(folder, starts)
    for name, start in starts.items():
        if names or not start.preset:
            write_start(folder, name, start)
    listed = {
        "first": first,
        "starts": [
            {"name": name, "title": start.title, "preset": bool(start.preset)} for name, start in starts.items()
        ],
        "targets": [{"name": name, "title": target.title} for name, target in all_targets().items()],
    }
    texts = {name: two_units_text(preset, name) for name, preset in presets().items()}
    (folder / "presets.json").write_text(json.dumps({**preset_list(), "texts": texts}), encoding="utf-8")
    (folder / "starts.json").write_text(json.dumps(listed), encoding="utf-8")
    return len(starts)


def _copy(source: Path, target: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, target)


if __name__ == "__main__":
    count = build(Path(sys.argv[1]), sys.argv[2:])
    print(f"wrote {sys.argv[1]}/index.html: {count} starts")
