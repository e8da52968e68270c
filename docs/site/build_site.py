"""Builds the documents as a site of static pages: python docs/site/build_site.py FOLDER [--without-pictures]

Drawing the pictures of the techniques takes most of the time.
A warning of Sphinx, such as a link or an anchor that leads nowhere, is an error.
"""

from __future__ import annotations

import sys
from pathlib import Path

from sphinx.cmd.build import build_main

import generated
from menu import ROOT, documents, problems
from sssgen.harness import backends
from sssgen.material import library
from staging import Staging
from technique_pictures import draw


def main(folder: Path, pictures: bool) -> int:
    """Writes the site into the folder, and returns the exit status."""
    sources = folder.with_name(f"{folder.name}-sources")
    texts = {page: (ROOT / page).read_text(encoding="utf-8") for page in documents()} | generated.pages()
    if found := problems(list(texts)):
        print("\n".join(found), file=sys.stderr)
        return 1
    staging = Staging(sources)
    backend = backends.get("gl") if pictures else None
    for technique in library.load_all():
        picture = draw(technique, backend) if backend is not None else None
        if picture is not None:
            staging.add_picture(generated.technique_picture(technique.name), picture.colors)
        page, text = generated.technique_page(technique.name, picture.caption if picture is not None else "")
        texts[page] = text
    for page, text in texts.items():
        staging.write(page, text)
    settings = ["-c", str(Path(__file__).parent), "-b", "html", "-q", "-W", "--keep-going", "-d", f"{sources}-cache"]
    status = build_main([*settings, str(sources), str(folder)])
    if not status:
        print(f"wrote {folder}/index.html: {len(texts)} pages")
    return status


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), "--without-pictures" not in sys.argv[2:]))
