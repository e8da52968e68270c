"""The pages of the site that are not files of the repository."""

from __future__ import annotations

from collections.abc import Mapping

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


PICTURES = {"picture": ".png", "traced": "_traced.png", "ends": "_ends.png"}
"""The pictures of a technique's page: its picture, one beside path tracing, one of the ends of ranges."""


def technique_picture(name: str, kind: str) -> str:
    """The path of a picture on a technique's page."""
    return f"{technique_pages.FOLDER}/{name}{PICTURES[kind]}"


def technique_page(name: str, captions: Mapping[str, str] | None = None, without: str = "") -> tuple[str, str]:
    """The path and the text of a technique's page; it has the pictures that have a caption."""
    shown = {kind: technique_pages.Shown(name + PICTURES[kind], text) for kind, text in (captions or {}).items()}
    limits = [shown[kind] for kind in ("traced", "ends") if kind in shown]
    text = technique_pages.page(library.load(name), shown.get("picture"), limits, without)
    return f"{technique_pages.FOLDER}/{name}.md", text
