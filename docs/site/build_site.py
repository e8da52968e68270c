"""Builds the documents as a site of static pages: python docs/site/build_site.py FOLDER [--without-pictures]

Drawing the pictures of the techniques takes most of the time.
A warning of Sphinx, such as a link or an anchor that leads nowhere, is an error.
"""

from __future__ import annotations

import sys
from pathlib import Path

from sphinx.cmd.build import build_main

sys.path.append(str(Path(__file__).with_name("playground")))

import build_playground
import generated
import playground_links
import preset_pages
from chart_pictures import beside_path_tracing
from home_page import write_home
from llms import write_llms
from menu import ROOT, documents, problems
from picture import Picture
from records import best_point
from sssgen.material import library
from sssgen.material.library import Technique
from sssgen.run import backends
from sssgen.run.backends import Backend
from staging import Staging
from technique_curves import curves_at_the_ends
from technique_pictures import ball_at_the_ends, draw, why_none


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
        drawn = _pictures(technique, backend) if backend is not None else {}
        for kind, picture in drawn.items():
            staging.add_picture(generated.technique_picture(technique.name, kind), picture.colors)
        captions = {kind: picture.caption for kind, picture in drawn.items()}
        without = why_none(technique) if pictures and "picture" not in drawn else ""
        page, text = generated.technique_page(technique.name, captions, without)
        texts[page] = text
    texts |= preset_pages.pages()
    texts[preset_pages.LIST] += preset_pages.listed()
    playground_links.add_links(texts)
    for page, text in texts.items():
        staging.write(page, text)
    settings = ["-c", str(Path(__file__).parent), "-b", "html", "-q", "-W", "--keep-going", "-d", f"{sources}-cache"]
    status = build_main([*settings, str(sources), str(folder)])
    if not status:
        print(f"wrote {folder}/README.html: {len(texts)} pages")
        print(f"wrote {folder}/playground/index.html: {build_playground.build(folder / 'playground')} beginnings")
        write_home(folder)
        write_llms(folder, texts)
    return status


def _pictures(technique: Technique, backend: Backend) -> dict[str, Picture]:
    """By their kinds, as in `generated.PICTURES`."""
    point = best_point(technique.name)
    found = {
        "picture": draw(technique, backend),
        "traced": beside_path_tracing(point) if point is not None else None,
        "ends": curves_at_the_ends(technique) or ball_at_the_ends(technique, backend),
    }
    return {kind: picture for kind, picture in found.items() if picture is not None}


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), "--without-pictures" not in sys.argv[2:]))
