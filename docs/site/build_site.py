"""Builds the documents as a site of static pages: python docs/site/build_site.py FOLDER

A warning of Sphinx, such as a link or an anchor that leads nowhere, is an error.
"""

from __future__ import annotations

import sys
from pathlib import Path

from sphinx.cmd.build import build_main

import generated
from menu import ROOT, documents, problems
from sssgen.material import library
from staging import Staging


def main(folder: Path) -> int:
    """Writes the site into the folder, and returns the exit status."""
    sources = folder.with_name(f"{folder.name}-sources")
    texts = {page: (ROOT / page).read_text(encoding="utf-8") for page in documents()} | generated.pages()
    if found := problems(list(texts)):
        print("\n".join(found), file=sys.stderr)
        return 1
    staging = Staging(sources)
    texts |= dict(generated.technique_page(name) for name in library.index())
    for page, text in texts.items():
        staging.write(page, text)
    settings = ["-c", str(Path(__file__).parent), "-b", "html", "-q", "-W", "--keep-going", "-d", f"{sources}-cache"]
    status = build_main([*settings, str(sources), str(folder)])
    if not status:
        print(f"wrote {folder}/index.html: {len(texts)} pages")
    return status


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
