"""Links to the playground, which the site has and the repository's own pages do not."""

from __future__ import annotations

import re

_COMMAND = re.compile(r"^`sssgen render (\w+) -o \1\.png`$", re.MULTILINE)
_HEADING = re.compile(r"\A# Playground\n")


def add_links(texts: dict[str, str]) -> None:
    """Changes pages: the gallery links to each example, the page on the playground to the playground."""
    for page, pattern, with_link in (
        ("docs/gallery.md", _COMMAND, lambda match: f"{match[0]} · {_link(match[1], 'Open it in the playground')}"),
        ("docs/playground.md", _HEADING, lambda match: f"{match[0]}\n{_link('', 'Open the playground')}\n"),
    ):
        texts[page], count = pattern.subn(with_link, texts[page])
        assert count, f"{page} has no place for its links"


def _link(name: str, words: str) -> str:
    """A link from a page in docs/ to an example."""
    return f'<a href="../playground/index.html{"#" + name if name else ""}">{words}</a>'
