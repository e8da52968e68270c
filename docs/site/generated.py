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


def technique_picture(name: str) -> str:
    """The path of the picture on a technique's page."""
    return f"{technique_pages.FOLDER}/{name}.png"


def technique_page(name: str, caption: str = "") -> tuple[str, str]:
    """The path and the text of a technique's page; with a caption it has a picture."""
    picture = f"{name}.png" if caption else ""
    return f"{technique_pages.FOLDER}/{name}.md", technique_pages.page(library.load(name), picture, caption)
