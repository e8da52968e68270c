"""The menu of the site, and the documents of the repository."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
MENU = Path(__file__).with_name("menu.toml")
README = "README.md"
"""The overview: the first of the documents, which has their menu."""


class Section(NamedTuple):
    """A part of the menu."""

    title: str
    pages: list[str]


def sections() -> list[Section]:
    return [Section(**section) for section in tomllib.loads(MENU.read_text(encoding="utf-8"))["section"]]


def page_of(document: str) -> str:
    """The page of a document on the site, from the site's folder."""
    return f"{document.removesuffix('.md')}.html"


def documents() -> list[str]:
    """The Markdown files of the repository that are written for readers."""
    paths = [*ROOT.glob("*.md"), *(ROOT / "qualification").glob("*.md"), *(ROOT / "editors").glob("*/*.md")]
    paths += [path for folder in ("docs", "examples") for path in (ROOT / folder).rglob("*.md")]
    return sorted(path.relative_to(ROOT).as_posix() for path in paths)


def problems(pages: list[str]) -> list[str]:
    """What the menu lacks or has too much of, if these are all pages."""
    listed = [page for section in sections() for page in section.pages]
    add = f"add its path to a section of {MENU.relative_to(ROOT).as_posix()}"
    return [
        *(f"{page} is not in the menu: {add}" for page in pages if page not in listed),
        *(f"{page} is in the menu, but there is no such page: remove it there" for page in listed if page not in pages),
        *(f"{page} is in the menu more than once" for page in sorted(set(listed)) if listed.count(page) > 1),
    ]
