"""Links to the playground, which the site has and the repository's own pages do not."""

from __future__ import annotations

import re

OPEN = "Open it in the playground"
_COMMAND = re.compile(r"^`sssgen render (\w+) -o \1\.png`$", re.MULTILINE)
_HEADING = re.compile(r"\A# Playground\n")


def add_links(texts: dict[str, str]) -> None:
    """Changes pages: the gallery links to each example, the page on the playground to the playground."""
    for page, pattern, with_link in (
        (
            "docs/gallery.md",
            _COMMAND,
            lambda match: f"{match[0]} · {playground_link(match[1], 'Open it in the playground')}",
        ),
        ("docs/playground.md", _HEADING, lambda match: f"{match[0]}\n{playground_link('', 'Open the playground')}\n"),
    ):
        texts[page], count = pattern.subn(with_link, texts[page])
        assert count, f"{page} has no place for its links"


def playground_link(name: str, words: str, folder: str = "docs") -> str:
    """A link from a page in a folder of the site to a start of the playground."""
    up = "../" * (folder.count("/") + 1)
    return f'<a href="{up}playground/index.html{"#" + name if name else ""}">{words}</a>'
