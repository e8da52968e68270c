"""The pages of the site that are not files of the repository."""

from __future__ import annotations

import commands_page
import python_page
import technique_pages
from sssgen.material import library


def names() -> list[str]:
    """The generated pages that the menu has."""
    return [technique_pages.OVERVIEW, commands_page.PAGE, python_page.PAGE]


def pages() -> dict[str, str]:
    """Path → text, but the pages of techniques."""
    return {
        technique_pages.OVERVIEW: technique_pages.overview(),
        commands_page.PAGE: commands_page.page(),
        python_page.PAGE: python_page.page(),
    }


def technique_page(name: str, picture: str = "", ends: str = "", without: str = "") -> tuple[str, str, tuple[str, str]]:
    """The path and the text of a technique's page, and the paths of its pictures.

    `picture` and `ends` are the captions of its picture and of that of the ends of its parameters' ranges; '' is none.
    """
    files = f"{name}.png", f"{name}_ends.png"
    shown = [technique_pages.Shown(file, caption) for file, caption in zip(files, (picture, ends), strict=True)]
    text = technique_pages.page(library.load(name), shown[0] if picture else None, shown[1] if ends else None, without)
    folder = technique_pages.FOLDER
    return f"{folder}/{name}.md", text, (f"{folder}/{files[0]}", f"{folder}/{files[1]}")
